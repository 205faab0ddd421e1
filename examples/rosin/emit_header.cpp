// SPDX-License-Identifier: MIT
#include "emit_header.hpp"

#include "digits.hpp"

#include <rosin/reconstruct/passage_design.hpp>
#include <rosin/version.hpp>

#include <map>

namespace tool {

namespace {

using rosin::bow_version;

std::string nine_digits(double x) { return in_digits(x, "%.9g"); }

/// All bits of a number, as a literal of its type.
std::string literal(double x, bool in_double) {
  return in_double ? in_digits(x, "%a") : in_digits(static_cast<double>(static_cast<float>(x)), "%a") + "F";
}

std::string list(const std::vector<double>& numbers, bool in_double) {
  std::string out, line = "\n     ";
  for (const double x : numbers) {
    const std::string next = std::string{" "}.append(literal(x, in_double)) + ",";
    if (line.size() + next.size() > 120) out += std::exchange(line, "\n     ");
    line += next;
  }
  return out + line;
}

/// A comment stays one, whatever stands in it.
std::string comment(std::string text) {
  for (char& c : text)
    if (c == '\\' || c == '\n' || c == '\r') c = '/';
  return "// " + text + '\n';
}

struct header_design {
  rosin::calibration at;
  double declared = 0, rate_Hz = 0, error = 0;
  rosin::band limits{0, 0};
  std::array<double, 2> offset_N{};
  rosin::passage_plan plan;
};

rosin::outcome<std::size_t> position_of(const header_options& given, const calibration_set& set) {
  std::string known;
  for (std::size_t i = 0; i < set.declared.size(); ++i) {
    known += (i == 0 ? "" : ", ") + nine_digits(set.declared[i]);
    if (std::abs(set.declared[i] - given.position) < 1e-9 || (given.position < 0 && set.declared.size() == 1)) return i;
  }
  if (given.position < 0)
    return rosin::failure{"--emit-header: the plucks are at " + known + "; --emit-position says which is meant"};
  return rosin::failure{"--emit-position " + nine_digits(given.position) + ": no pluck there; the plucks are at " + known};
}

/// As `rosin reconstruct` does: no string stiffens below zero, and none loses most of a wave on its way.
void set_right(rosin::bow_point& at, const rosin::band& limits, std::vector<std::string>& said) {
  if (at.stiffness_s2 < 0) {
    at.stiffness_s2 = 0;
    said.emplace_back("header: the fitted bending stiffness is negative, taken as 0");
  }
  const double longest = std::max(at.delay_s[0], at.delay_s[1]);
  const double gain = std::exp(std::numbers::pi * limits.stop_Hz * longest * at.loss.inverse_q(limits.stop_Hz));
  if (gain > 0.5 && gain < 5) return;
  at.loss = {rosin::detail::default_quality, 0, 0};
  said.push_back("header: the fitted loss would change the band's end by a factor of " + in_digits(gain, "%.2g") +
                 ", taken as Q = 1000");
}

rosin::outcome<header_design> design(const header_options& given, const calibration_set& set, std::vector<std::string>& said) {
  header_design d;
  const auto which = position_of(given, set);
  if (!which) return rosin::failure{which.error()};
  d.at = set.at[*which], d.declared = set.declared[*which], d.error = given.error;
  d.rate_Hz = given.rate_Hz > 0 ? given.rate_Hz : set.rate_Hz;
  d.limits = {given.pass_Hz > 0 ? given.pass_Hz : 0.30 * d.rate_Hz, given.stop_Hz > 0 ? given.stop_Hz : 0.45 * d.rate_Hz};
  const std::string band =
      "--emit-pass " + nine_digits(d.limits.pass_Hz) + " --emit-stop " + nine_digits(d.limits.stop_Hz) + ": ";
  if (!(d.limits.pass_Hz >= set.fundamental_Hz && d.limits.stop_Hz - d.limits.pass_Hz >= set.fundamental_Hz &&
        2 * d.limits.stop_Hz <= d.rate_Hz))
    return rosin::failure{
        band + "at least the fundamental for the first and for the way from it to the second, which ends at half the rate of " +
        nine_digits(d.rate_Hz) + " Hz"};
  if (!std::isfinite(d.at.at.impedance_Ns_m))
    return rosin::failure{
        "--emit-header: length_m and tension_N (or impedance_Ns_m) are needed: without the wave impedance there is no velocity "
        "in m/s"};
  set_right(d.at.at, d.limits, said);
  for (std::size_t c = 0; c < 2; ++c) {
    if (std::abs(set.offset_N[c].value) > 5 * set.offset_N[c].sd && std::abs(set.offset_N[c].value) > 1e-4)
      d.offset_N[c] = set.offset_N[c].value;
    if (d.at.ac_coupled_Hz[c] > 0)
      said.push_back(std::string("header: channel ") + (c == 0 ? "near" : "far") + " is AC coupled at " +
                     nine_digits(d.at.ac_coupled_Hz[c]) + " Hz; that is not undone there");
  }
  d.plan = rosin::plan_passages(d.at.at, d.at.gain, d.limits, d.rate_Hz, given.error, given.version);
  return d;
}

const char* name_of(bow_version version) {
  return version == bow_version::near ? "near" : version == bow_version::far ? "far" : "both";
}

std::string story(const header_design& d, const header_options& given, const calibration_set& set, const provenance& from) {
  std::string out =
      comment("Coefficients of rosin's streaming reconstruction, written by rosin " ROSIN_VERSION_STRING ". Not to be edited.");
  out += "//\n" + comment("contact at " + nine_digits(d.declared) + " of the length, " + set.from);
  out += comment("version: " + std::string(name_of(given.version)) + ", band: flat to " + nine_digits(d.limits.pass_Hz) +
                 " Hz, nothing from " + nine_digits(d.limits.stop_Hz) + " Hz, error in the band: " + nine_digits(d.error));
  for (const auto& line : from.comment_lines()) out += comment(line);
  return out + "//\n";
}

std::string coefficients(const rosin::passage_plan& plan, bool in_double) {
  std::string out = "    .passage = {{\n";
  for (std::size_t p = 0; p < 4; ++p) {
    const auto taps = plan.arrival_taps(p);
    if (taps.empty()) out += "      {},\n";
    else
      out += "      {.taps = {" + list(taps, in_double) + "},\n       .count = " + std::to_string(taps.size()) +
             ", .newest_age = " + std::to_string(plan.newest_age(p)) + "},\n";
  }
  out += "    }},\n    .admittance = {" + list(plan.arrival_admittance(), in_double) + "},\n    .near_field = {" +
         list(plan.arrival_near_field(), in_double) + "},\n";
  out += "    .latency = " + std::to_string(plan.reach_ahead()) + ",\n    .reach = " + std::to_string(plan.span());
  return out + ",\n    .version = rosin::bow_version::" + name_of(plan.version) + ",\n";
}

std::string text_of(const header_design& d, const header_options& given, const calibration_set& set, const provenance& from) {
  const std::string type = given.in_double ? "double" : "float";
  const std::size_t line = (d.plan.span() + 3 + 16 + 3) / 4 * 4;  // and a chunk, on whatever machine
  std::string out = story(d, given, set, from);
  out += "#pragma once\n\n#include <rosin/reconstruct/passage_reconstructor.hpp>\n\nnamespace " + given.space + " {\n\n";
  out += "using sample = " + type + ";\n";
  out += "using reconstructor = rosin::passage_reconstructor<sample, " + std::to_string(d.plan.longest()) + ", " +
         std::to_string(line) + ", " + std::to_string(d.plan.half_length()) + ">;\n\n";
  out += "inline constexpr sample sample_rate_Hz = " + literal(d.rate_Hz, given.in_double) + ";  // " + nine_digits(d.rate_Hz) +
         "\n";
  out += "/// To be taken from the recorded forces first: what the sensors said at rest.\n";
  out += "inline constexpr rosin::termination_frame<sample> offset{" + literal(d.offset_N[0], given.in_double) + ", " +
         literal(d.offset_N[1], given.in_double) + "};\n";
  out += "/// From newtons as recorded, gains and all.\ninline constexpr reconstructor::coefficients_type coefficients{\n" +
         coefficients(d.plan, given.in_double) + "};\n\n";
  return out + "}  // namespace " + given.space + "\n";
}

}  // namespace

void add_header_options(CLI::App& command, header_options& given) {
  static const std::map<std::string, bow_version> versions{
      {"both", bow_version::both}, {"near", bow_version::near}, {"far", bow_version::far}};
  const std::string group = "Header for firmware";
  const auto add = [&](const char* name, auto& into, const char* what, const char* type) {
    return command.add_option(name, into, what)->type_name(type)->group(group);
  };
  add("--emit-header", given.path, "Write the coefficients of a streaming reconstruction as constants of C++", "FILE.hpp");
  command.add_flag("--emit-double", given.in_double, "In double instead of single precision")->group(group);
  command
      .add_option("--emit-version", given.version,
                  "both versions, or the near or far one alone, which is late by its own transit only")
      ->transform(CLI::CheckedTransformer(versions, CLI::ignore_case))
      ->type_name("both|near|far")
      ->group(group);
  add("--emit-position", given.position, "Declared position of the contact, where plucks were made at several", "FRACTION")
      ->check(between(0.0, 1.0));
  add("--emit-rate", given.rate_Hz, "Sampling rate; that of the plucks if not given", "HZ")->check(positive());
  add("--emit-pass", given.pass_Hz, "End of the pass band; 0.30 of the rate", "HZ")->check(positive());
  add("--emit-stop", given.stop_Hz, "Nothing is left from here on; 0.45 of the rate", "HZ")->check(positive());
  add("--emit-error", given.error, "Largest error in the pass band; 0.001 if not given", "RATIO")->check(between(1e-6, 0.1));
  add("--emit-namespace", given.space, "Namespace of the constants; rig if not given", "NAME")
      ->check([](const std::string& name) {
        const bool good =
            !name.empty() &&
            name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") == std::string::npos &&
            !(name[0] >= '0' && name[0] <= '9');
        return good ? std::string{} : name + " is no name for a namespace";
      });
}

std::optional<rosin::failure> write_header(const header_options& given, bool force, const calibration_set& calibration,
                                           const provenance& from, std::vector<std::string>& said) {
  if (given.path == "-") return rosin::failure{"--emit-header -: a header goes to a file"};
  const auto d = design(given, calibration, said);
  if (!d) return rosin::failure{d.error()};
  if (auto why = rosin::write_file(given.path, force ? rosin::overwrite::allow : rosin::overwrite::refuse,
                                   [&](std::ostream& out) { out << text_of(*d, given, calibration, from); }))
    return why;
  std::size_t taps = 0;
  for (std::size_t p = 0; p < 4; ++p) taps += d->plan.arrival_taps(p).size();
  said.push_back("header " + given.path + ": " + std::to_string(taps) + " taps, late by " +
                 std::to_string(d->plan.reach_ahead()) + " frames (" +
                 in_digits(1e3 * d->plan.reach_ahead() / d->rate_Hz, "%.3g") + " ms) at " + nine_digits(d->rate_Hz) + " Hz");
  return std::nullopt;
}

}  // namespace tool
