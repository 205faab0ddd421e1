// SPDX-License-Identifier: MIT
//
// What all subcommands share on the command line: exit codes, messages, --json and where results may be written.
//
#pragma once

#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>

namespace tool {

/// 0: done, nothing wrong. 1: done, and something was found or a check failed. 2: bad input or usage, nothing done.
enum class exit_code { ok = 0, finding = 1, bad_input = 2 };

using json = nlohmann::ordered_json;

/// What an option takes: a finite number, with a point as decimal mark, above zero; zero or larger; or between two ends.
[[nodiscard]] CLI::Validator positive();
[[nodiscard]] CLI::Validator not_negative();
[[nodiscard]] CLI::Validator between(double low, double high, const char* type = "FLOAT");

/// A number, or null where it is not known.
inline json number_or_null(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }
/// A value and its standard deviation.
inline json with_sd(double value, double sd) { return {{"value", number_or_null(value)}, {"sd", number_or_null(sd)}}; }

/// That of two outputs of one command which tells more.
inline exit_code worse(exit_code a, exit_code b) { return std::max(a, b); }

/// Why nothing was done: each line of the message to standard error; as JSON on standard output if asked for.
exit_code fail(const std::string& message, bool as_json = false);

/// To standard output, numbers in full, text that is not UTF-8 replaced.
void print(const json& document);

/// --json: the same result for a program.
void add_json_option(CLI::App& command, bool& as_json);

/// --out FILE, --format csv|npy|mat, --force: a table that goes to a file.
struct table_output {
  std::string path, format = "csv";
  bool force = false;

  [[nodiscard]] rosin::overwrite existing() const noexcept { return force ? rosin::overwrite::allow : rosin::overwrite::refuse; }
};
void add_table_options(CLI::App& command, table_output& output);
void add_force_option(CLI::App& command, bool& force);

/// Writes the table the way the options say; the reason if it could not. To be asked before long work: may_write.
[[nodiscard]] std::optional<rosin::failure> save(const table_output& output, const rosin::table& data);
[[nodiscard]] std::optional<rosin::failure> may_write(const table_output& output);
/// "-": standard output, where `dash` says that it can go there.
[[nodiscard]] std::optional<rosin::failure> may_write_file(const std::string& path, bool force, bool dash = false);

}  // namespace tool
