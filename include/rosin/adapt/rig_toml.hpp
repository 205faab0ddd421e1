// tier: hosted
// SPDX-License-Identifier: MIT
//
// rig.toml (schema 1) to struct rig, or a failure that lists everything that is wrong with it, one problem a line with
// file, line, key and reason. Needs toml++ 3.
//
// parse_rig looks at the text alone; load_rig reads it from the folder, with the admittance tables that it names, and
// checks that the recordings are there. What is in the recordings is looked at by rig_folder.hpp.
//
#pragma once

#include <rosin/acquire/magnitudes.hpp>
#include <rosin/adapt/rig_sections.hpp>
#include <rosin/adapt/rig_sensors.hpp>
#include <rosin/adapt/rig_takes.hpp>
#include <rosin/adapt/toml_guard.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/report/csv.hpp>

#include <filesystem>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The text parsed, or a failure with the line; never an exception, whichever way toml++ was built.
inline outcome<toml::table> parse_toml(std::string_view text, const std::string& file) {
  if (const auto fault = find_toml_fault(text)) {
    problem_log log{file};
    log.add(fault->line, "", fault->reason);
    return log.to_failure();
  }
  const auto explain = [&](const toml::parse_error& error) {
    problem_log log{file};
    log.add(static_cast<int>(error.source().begin.line), "", std::string{error.description()});
    return log.to_failure();
  };
#if TOML_EXCEPTIONS
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    return explain(error);
  }
#else
  auto result = toml::parse(text, file);
  if (!result) return explain(result.error());
  return std::move(result).table();
#endif
}

/// near and far on both ends need length and tension; impedance must not contradict them, if all are sound.
inline void check_string(toml_fields fields, const rig& r, bool sound) {
  const string_section& s = r.string;
  if (r.has_both_forces())
    for (const char* key : {"length_m", "tension_N"})
      if (!fields.has(key)) fields.missing(key);
  if (!sound || !s.impedance_Ns_m || !s.tension_N || !s.length_m) return;
  const double expected = *s.tension_N / (2 * *s.length_m * s.fundamental_Hz);
  const double limit =
      s.tension_tolerance.value_or(0.02) + s.fundamental_tolerance.value_or(0.003) + s.impedance_tolerance.value_or(0.01);
  if (std::abs(*s.impedance_Ns_m / expected - 1) <= limit) return;
  std::string which = "; one of the four is wrong";
  for (const auto& slip : find_magnitude_slips(r)) which += "; " + likely_text(slip);
  fields.refuse("impedance_Ns_m", "is " + value_range::number(*s.impedance_Ns_m) + ", but tension / (2 length fundamental) is " +
                                      value_range::number(expected) + which);
}

inline void read_contact(toml_fields fields, rig& r) {
  r.contact_position = fields.required_number("position", inside_unit);
  r.position_tolerance = fields.number("position_tolerance", zero_to(0.5));
  fields.unknown();
}

inline void read_schema(toml_fields& root) {
  if (!root.has("schema")) return root.missing("schema");
  const auto schema = root.integer("schema", 0, 1000000);
  if (schema && *schema != 1) root.refuse("schema", "is " + std::to_string(*schema) + "; this version reads schema 1");
}

/// Each table that is there, through its reader.
inline void read_tables(toml_fields& root, rig& r, bool tables) {
  const auto under = [&](const char* key) {
    const toml::table* table = root.table(key);
    return table != nullptr ? std::optional<toml_fields>{toml_fields{*table, key, root.log()}} : std::nullopt;
  };
  for (const char* key : {"string", "channels"})
    if (!root.has(key)) root.missing(key);
  const std::size_t before = root.log().size();
  if (auto t = under("string")) r.string = read_string(*t);
  const bool sound = root.log().size() == before;
  if (auto t = under("channels")) r.channels = read_channels(*t, *root.table("channels"), tables);
  if (auto t = under("string")) check_string(*t, r, sound);
  if (auto t = under("contact")) read_contact(*t, r);
  if (auto t = under("torsion")) r.torsion = read_torsion(*t);
  if (auto t = under("terminations")) {
    r.near = read_termination(*t, "near");
    r.far = read_termination(*t, "far");
    t->unknown();
  }
  if (auto t = under("model")) r.model = read_model(*t);
  if (auto t = under("friction")) r.friction = read_friction(*t);
  if (auto t = under("bow")) r.bow = read_bow_section(*t);
  if (auto t = under("files")) r.files = read_files(*t);
  if (auto t = under("simulate")) r.simulate = read_simulate(*t);
}

/// The columns frequency_Hz, admittance_re, admittance_im of a table, in order.
inline outcome<std::vector<admittance_point>> read_admittance(const std::string& path) {
  const auto table = read_csv(path);
  if (!table) return failure{table.error()};
  const auto* f = table->find("frequency_Hz");
  const auto* re = table->find("admittance_re");
  const auto* im = table->find("admittance_im");
  if (f == nullptr || re == nullptr || im == nullptr)
    return failure{path + ": must have the columns frequency_Hz, admittance_re, admittance_im"};
  std::vector<admittance_point> out;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    const admittance_point p{f->values[i], re->values[i], im->values[i]};
    const std::string row = path + ": row " + std::to_string(i + 1) + ": ";
    if (!std::isfinite(p.frequency_Hz + p.re_m_sN + p.im_m_sN)) return failure{row + "must hold three numbers"};
    if (p.frequency_Hz < 0 || (!out.empty() && p.frequency_Hz <= out.back().frequency_Hz))
      return failure{row + "frequency_Hz must ascend and not be negative"};
    out.push_back(p);
  }
  if (out.size() < 2) return failure{path + ": needs at least two rows"};
  return out;
}

inline void load_terminations(rig& r, const toml::table& table, problem_log& log) {
  const auto ends = {std::pair{"near", &r.near}, std::pair{"far", &r.far}};
  for (const auto& [name, end] : ends) {
    if (!*end || (*end)->kind != termination::form::table) continue;
    const int line = toml_fields::line_of(*table["terminations"][name].node());
    auto points = read_admittance(r.path_of((*end)->file));
    const std::string place = std::string{"terminations."} + name;
    if (points) (*end)->admittance = *std::move(points);
    else log.add(line, place, points.error() + " (neither \"rigid\" nor \"fit\", so taken as the name of a file)");
  }
}

inline rig read_root(const toml::table& table, const std::string& file, problem_log& log) {
  rig r;
  r.file = file;
  r.folder = std::filesystem::path{file}.parent_path().string();
  toml_fields root{table, "", log};
  read_schema(root);
  r.title = root.text("title");
  read_tables(root, r, are_tables(table));
  r.takes = read_takes(root, r);
  root.unknown();
  return r;
}

}  // namespace detail

/// The rig that a text describes; `file` stands in the messages, its folder is the rig's.
[[nodiscard]] inline outcome<rig> parse_rig(std::string_view text, const std::string& file) {
  const auto table = detail::parse_toml(text, file);
  if (!table) return failure{table.error()};
  problem_log log{file};
  rig r = detail::read_root(*table, file, log);
  if (!log.empty()) return log.to_failure();
  return r;
}

/// Whether the recordings have to be there already: not when they are to be simulated.
enum class take_files { required, to_be_made };

/// The rig in a file, or in the rig.toml of a folder.
[[nodiscard]] inline outcome<rig> load_rig(const std::string& path, take_files wanted = take_files::required) {
  std::error_code ignored;
  const std::string file = std::filesystem::is_directory(path, ignored) ? path + "/rig.toml" : path;
  const auto text = read_file(file);
  if (!text) return failure{text.error()};
  const auto table = detail::parse_toml(*text, file);
  if (!table) return failure{table.error()};
  problem_log log{file};
  rig r = detail::read_root(*table, file, log);
  detail::load_terminations(r, *table, log);
  for (const take& t : r.takes) {
    if (wanted != take_files::required || t.file.empty()) continue;
    const auto recording = r.path_of(t.file), key = "take \"" + t.name + "\".file";
    if (std::filesystem::is_directory(recording, ignored)) log.add(t.line, key, recording + ": is a folder");
    else if (!std::filesystem::is_regular_file(recording, ignored)) log.add(t.line, key, recording + ": no such file");
  }
  if (!log.empty()) return log.to_failure();
  return r;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
