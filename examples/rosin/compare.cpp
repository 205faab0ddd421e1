// SPDX-License-Identifier: MIT
//
// rosin compare: how far a reconstruction is from the truth of a simulation, or from another reconstruction, both through
// one and the same low-pass.
//
#include "commands.hpp"
#include "compare_columns.hpp"
#include "digits.hpp"
#include "provenance.hpp"

#include <rosin/report/csv.hpp>

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct compare_options {
  std::string result, truth;
  std::optional<double> pass_Hz, stop_Hz, at_most;
  bool json = false;
};

/// The take that the comments of a table name; empty if none.
std::string take_of(const rosin::table& t) {
  for (const std::string& line : t.comments)
    for (const std::string_view start : {"truth of take ", "take "})
      if (line.starts_with(start)) return line.substr(start.size(), line.rfind(", ") - start.size());
  return {};
}

/// The sampling rate, if both tables go through the same instants of one take.
rosin::outcome<double> common_rate(const compare_options& given, const rosin::table& result, const rosin::table& truth) {
  const std::string one = take_of(result), other = take_of(truth);
  if (!one.empty() && !other.empty() && one != other)
    return rosin::failure{given.result + " is of take " + one + ", " + given.truth + " of take " + other + ": not the same take"};
  const auto* a = result.find("time_s");
  const auto* b = truth.find("time_s");
  if (a == nullptr) return rosin::failure{given.result + ": has no column time_s"};
  if (b == nullptr) return rosin::failure{given.truth + ": has no column time_s"};
  if (a->values.size() != b->values.size())
    return rosin::failure{given.result + " has " + std::to_string(a->values.size()) + " rows, " + given.truth + " has " +
                          std::to_string(b->values.size()) + ": not the same take"};
  if (a->values.size() < 2) return rosin::failure{given.result + ": too few rows to compare"};
  const double step = (a->values.back() - a->values.front()) / static_cast<double>(a->values.size() - 1);
  for (std::size_t i = 0; i < a->values.size(); ++i)
    if (!(std::abs(a->values[i] - b->values[i]) < 0.01 * step))
      return rosin::failure{given.result + " and " + given.truth + ": row " + std::to_string(i + 1) +
                            " belongs to different instants"};
  return 1 / step;
}

rosin::outcome<std::vector<compared>> compare(const compare_options& given, const rosin::table& result, const rosin::table& truth,
                                              double rate_Hz, const rosin::band& window) {
  std::vector<compared> out;
  for (const char* name : {"force_N", "velocity_m_s", "torsion_velocity_m_s"}) {
    const auto* r = result.find(name);
    const auto* t = truth.find(name);
    if (r == nullptr || t == nullptr) continue;
    if (const auto gap = gap_between(r->values, t->values))
      return rosin::failure{(std::isfinite(r->values[*gap]) ? given.truth : given.result) + ": " + name + ": no value in row " +
                            std::to_string(*gap + 1) + ", between rows that have one"};
    auto one = compare_columns(name, r->values, t->values, rate_Hz, window);
    if (one.rms_truth > 0) out.push_back(std::move(one));
  }
  if (out.empty())
    return rosin::failure{given.result + " and " + given.truth +
                          ": no column that both have and that holds a long enough stretch of values"};
  return out;
}

void print_text(const std::vector<compared>& columns, const rosin::band& window) {
  std::cout << "both through one low-pass, " << in_digits(window.pass_Hz, "%.0f") << " to " << in_digits(window.stop_Hz, "%.0f")
            << " Hz\n";
  for (const auto& c : columns)
    std::cout << c.name << ": Delta " << in_digits(c.delta, "%.5f") << "; scale " << in_digits(c.scale, "%.5f")
              << ", and after division by it Delta " << in_digits(c.delta_scaled, "%.5f") << ", error "
              << in_digits(c.rms_error, "%.3g") << " rms and " << in_digits(c.worst, "%.3g") << " at worst, of "
              << in_digits(c.rms_truth, "%.3g") << " rms\n";
}

void print_json(const std::vector<compared>& columns, const rosin::band& window, const provenance& from) {
  json out{
      {"schema", 1}, {"provenance", from.to_json()}, {"low_pass", {{"pass_Hz", window.pass_Hz}, {"stop_Hz", window.stop_Hz}}}};
  for (const auto& c : columns)
    out["columns"][c.name] = {{"delta", c.delta},
                              {"scale", c.scale},
                              {"delta_after_scale", c.delta_scaled},
                              {"rms_error_after_scale", c.rms_error},
                              {"worst_error_after_scale", c.worst},
                              {"rms_truth", c.rms_truth}};
  print(out);
}

exit_code run(const compare_options& given, provenance from) {
  const auto result = rosin::read_csv(given.result);
  if (!result) return fail(result.error(), given.json);
  const auto truth = rosin::read_csv(given.truth);
  if (!truth) return fail(truth.error(), given.json);
  for (const auto* file : {&given.result, &given.truth})
    if (const auto why = from.add_input(*file)) return fail(why->message, given.json);
  const auto rate = common_rate(given, *result, *truth);
  if (!rate) return fail(rate.error(), given.json);
  const rosin::band window = compared_band(*rate, given.pass_Hz, given.stop_Hz);
  if (!(window.stop_Hz > window.pass_Hz)) return fail("--stop must be above --pass", given.json);
  const auto columns = compare(given, *result, *truth, *rate, window);
  if (!columns) return fail(columns.error(), given.json);
  if (given.json) print_json(*columns, window, from);
  else print_text(*columns, window);
  const auto too_far = [&](const compared& c) { return c.name != "torsion_velocity_m_s" && c.delta_scaled > *given.at_most; };
  return given.at_most && std::any_of(columns->begin(), columns->end(), too_far) ? exit_code::finding : exit_code::ok;
}

}  // namespace

void add_compare(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<compare_options>();
  CLI::App* command = app.add_subcommand("compare", "How far a reconstruction is from the truth of a simulation");
  command->add_option("RESULT", given->result, "Table of `rosin reconstruct`, as CSV")->required()->type_name("FILE.csv");
  command->add_option("TRUTH", given->truth, "Table of `rosin simulate`, or another reconstruction of the same take")
      ->required()
      ->type_name("FILE.csv");
  command
      ->add_option("--pass", given->pass_Hz,
                   "Both are low-passed: end of the pass band; left out: 20000, at most 0.3 of the rate")
      ->check(positive())
      ->type_name("HZ");
  command
      ->add_option("--stop", given->stop_Hz,
                   "Nothing is left from here on; left out: 1.5 times the pass band, at most half-way to half the rate")
      ->check(positive())
      ->type_name("HZ");
  command->add_option("--at-most", given->at_most, "Exit with 1 if force or velocity differs by more, after the common scale")
      ->check(not_negative())
      ->type_name("DELTA");
  add_json_option(*command, given->json);
  command->footer(
      "Delta is Eq. (12) of Woodhouse, Schumacher & Garoff (2000): sqrt(sum (a - b)^2 / (sum a^2 + sum b^2)), means taken out.\n"
      "A common scale (the wires' strength, which no recording tells) is stated apart. Empty fields at the beginning and at\n"
      "the end are left out, and so is the response time of the low-pass at either end; one in between is an error.\n"
      "Exit status: 0 done, 1 more than --at-most, 2 nothing could be compared.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
