// SPDX-License-Identifier: MIT
#include "json_image.hpp"

#include <rosin/adapt/rig_toml.hpp>
#include <rosin/report/csv.hpp>

#include <fstream>
#include <memory>
#include <sstream>

namespace tool {

namespace {

json from_toml(const toml::node& node) {
  if (const auto* table = node.as_table()) {
    json out = json::object();
    for (const auto& [key, value] : *table) out[std::string{key.str()}] = from_toml(value);
    return out;
  }
  if (const auto* array = node.as_array()) {
    json out = json::array();
    for (const auto& value : *array) out.push_back(from_toml(value));
    return out;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* number = node.as_integer()) return number->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* flag = node.as_boolean()) return flag->get();
  std::ostringstream date;  // no format here has dates: as text they fail where they stand
  node.visit([&](const auto& value) {
    if constexpr (toml::is_chronological<decltype(value)>) date << value;
  });
  return date.str();
}

/// Beyond any array where it is too large.
std::size_t index_from(const std::string& digits) {
  std::size_t out = std::numeric_limits<std::size_t>::max();
  std::from_chars(digits.data(), digits.data() + digits.size(), out);
  return out;
}

/// The node that a JSON pointer leads to, or the last one on the way that exists.
const toml::node* follow(const toml::node& root, const std::string& pointer) {
  const toml::node* at = &root;
  std::istringstream parts{pointer};
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty()) continue;
    const toml::node* next = nullptr;
    if (const auto* table = at->as_table()) next = table->get(part);
    else if (const auto* array = at->as_array(); array != nullptr && part.find_first_not_of("0123456789") == std::string::npos)
      next = array->get(index_from(part));
    if (next == nullptr) break;
    at = next;
  }
  return at;
}

rosin::outcome<json_image> rig_image(const std::string& path, const std::string& text) {
  auto parsed = rosin::detail::parse_toml(text, path);
  if (!parsed) return rosin::failure{parsed.error()};
  const auto root = std::make_shared<toml::table>(*std::move(parsed));
  return json_image{format::rig, from_toml(*root), [root, path](const std::string& pointer) {
                      return path + ":" + std::to_string(std::max(1, rosin::toml_fields::line_of(*follow(*root, pointer))));
                    }};
}

json column_image(const rosin::table_column& column) {
  std::uint64_t empty = 0;
  double low = std::numeric_limits<double>::infinity(), high = -low, last = -low;
  bool ascending = true;
  for (const double x : column.values) {
    if (std::isnan(x)) {
      ++empty;
      continue;
    }
    ascending = ascending && x > last;
    last = x;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  const std::uint64_t values = column.values.size() - empty;
  return {{"values", values},
          {"empty", empty},
          {"minimum", values > 0 ? json(low) : json(nullptr)},
          {"maximum", values > 0 ? json(high) : json(nullptr)},
          {"ascending", ascending}};
}

rosin::outcome<json_image> table_image(const std::string& path, const std::string& text) {
  std::istringstream in{text};
  const auto table = rosin::read_csv(in, path);
  if (!table) return rosin::failure{table.error()};
  json out{{"comments", table->comments}, {"columns", json::array()}, {"rows", table->rows()}, {"data", json::object()}};
  for (const auto& column : table->columns) {
    out["columns"].push_back(column.name);
    out["data"][column.name] = column_image(column);
  }
  return json_image{format::reconstruction, std::move(out), [path](const std::string&) { return path; }};
}

rosin::outcome<json_image> plain_image(const std::string& path, const std::string& text) {
  try {
    json document = json::parse(text);
    const bool calibration = document.is_object() && document.value("format", json{}) == "calibration";
    return json_image{calibration ? format::calibration : format::diagnosis, std::move(document),
                      [path](const std::string&) { return path; }};
  } catch (const json::exception& error) {
    return rosin::failure{path + ": " + error.what()};
  }
}

}  // namespace

std::string name_of(format what) {
  switch (what) {
    case format::rig:
      return "rig";
    case format::reconstruction:
      return "reconstruction";
    case format::calibration:
      return "calibration";
    case format::diagnosis:
      break;
  }
  return "diagnosis";
}

rosin::outcome<json_image> read_json_image(const std::string& path) {
  const auto text = rosin::read_file(path);
  if (!text) return rosin::failure{text.error()};
  const auto extension = std::filesystem::path{path}.extension();
  if (extension == ".toml") return rig_image(path, *text);
  if (extension == ".csv") return table_image(path, *text);
  if (extension == ".json") return plain_image(path, *text);
  return rosin::failure{
      path + ": the name says no format; a rig ends in .toml, a reconstruction in .csv, a diagnosis or a calibration in .json"};
}

}  // namespace tool
