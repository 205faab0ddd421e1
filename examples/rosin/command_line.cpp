// SPDX-License-Identifier: MIT
#include "command_line.hpp"

#include "rig_leftovers.hpp"

#include <rosin/adapt/mat_matio.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/report/csv.hpp>
#include <rosin/report/npy.hpp>

#include <iostream>
#include <sstream>

namespace tool {

exit_code fail(const std::string& message, bool as_json) {
  json lines = json::array();
  std::istringstream text{message};
  for (std::string line; std::getline(text, line);) {
    if (!as_json) std::cerr << "rosin: " << line << '\n';
    lines.push_back(line);
  }
  if (as_json) print({{"schema", 1}, {"errors", lines}});
  return exit_code::bad_input;
}

void print(const json& document) { std::cout << document.dump(2, ' ', false, json::error_handler_t::replace) << '\n'; }

namespace {

/// Finite, and whatever `holds` asks for.
template <class Holds>
CLI::Validator number_that(Holds holds, const std::string& wanted, const std::string& description) {
  return {[=](const std::string& text) {
            const auto value = rosin::number_from(text);
            if (!value || !std::isfinite(*value)) {
              const bool comma = text.find(',') != std::string::npos;
              return text + " is no finite number" + (comma ? "; the decimal mark is a point" : "");
            }
            return holds(*value) ? std::string{} : "must be " + wanted + ", is " + text;
          },
          description};
}

}  // namespace

CLI::Validator positive() {
  return number_that([](double x) { return x > 0; }, "larger than 0", "POSITIVE");
}
CLI::Validator not_negative() {
  return number_that([](double x) { return x >= 0; }, "0 or larger", "NONNEGATIVE");
}
CLI::Validator between(double low, double high, const char* type) {
  const std::string ends = rosin::number_text(low) + " to " + rosin::number_text(high);
  return number_that([=](double x) { return x >= low && x <= high; }, ends,
                     type + (" in [" + rosin::number_text(low) + " - " + rosin::number_text(high) + "]"));
}

void add_json_option(CLI::App& command, bool& as_json) {
  command.add_flag("--json", as_json, "Print the result as JSON, for a program to read");
}

void add_force_option(CLI::App& command, bool& force) { command.add_flag("--force", force, "Overwrite files that exist"); }

void add_table_options(CLI::App& command, table_output& output) {
  command.add_option("--out", output.path, "File to write")->required()->type_name("FILE");
  command.add_option("--format", output.format, "csv, npy (NumPy structured array) or mat (MATLAB)")
      ->check(CLI::IsMember({"csv", "npy", "mat"}))
      ->capture_default_str();
  add_force_option(command, output.force);
}

std::optional<rosin::failure> may_write(const table_output& output) { return may_write_file(output.path, output.force); }

std::optional<rosin::failure> may_write_file(const std::string& path, bool force, bool dash) {
  if (path == "-" && dash) return std::nullopt;
  if (path == "-") return rosin::failure{"-: standard output; this goes to a file only"};
  if (const auto why = rosin::cannot_write(path, rosin::overwrite::allow)) return why;
  if (!force && rosin::cannot_write(path, rosin::overwrite::refuse))
    return rosin::failure{path + ": exists already; --force overwrites it"};
  return being_written(path);
}

std::optional<rosin::failure> save(const table_output& output, const rosin::table& data) {
  if (auto why = may_write(output)) return why;
  if (output.format == "npy") return rosin::save_npy(output.path, data, output.existing());
  if (output.format == "mat") return rosin::save_mat(output.path, data, output.existing());
  return rosin::save_csv(output.path, data, output.existing());
}

}  // namespace tool
