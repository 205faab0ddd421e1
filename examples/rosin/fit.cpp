// SPDX-License-Identifier: MIT
//
// rosin fit: what the plucks of a rig say of string, contact and sensors.
//
#include "commands.hpp"
#include "emit_header.hpp"
#include "fit_pickup_rig.hpp"
#include "fit_report.hpp"
#include "pluck_input.hpp"

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct fit_options {
  std::string rig, json_file, report;
  bool force = false, strict = false, pickup = false;
  header_options header;
};

std::size_t width_of(const std::string& text) {  // of UTF-8
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blank(width - std::min(width, width_of(text)), ' ');
  return right ? blank + text : text + blank;
}

void print_rows(const std::vector<calibration_row>& rows) {
  std::array<std::size_t, 5> width{};
  for (const auto& r : rows) {
    const std::array cells{&r.name, &r.value, &r.random, &r.systematic, &r.unit};
    for (std::size_t i = 0; i < cells.size(); ++i) width[i] = std::max(width[i], width_of(*cells[i]));
  }
  width[2] = std::max<std::size_t>(width[2], 6);
  width[3] = std::max<std::size_t>(width[3], 10);
  std::string group;
  std::cout << padded("", width[0] + 2, false) << "  " << padded("value", width[1], true) << "  "
            << padded("random", width[2] + 3, true) << "  " << padded("systematic", width[3] + 3, true)
            << "   (one standard deviation each)\n";
  for (const auto& r : rows) {
    if (r.group != group) std::cout << (group = r.group) << '\n';
    const auto deviation = [](const std::string& sd) { return sd.empty() ? sd : "+- " + sd; };
    std::string line = "  " + padded(r.name, width[0], false) + "  " + padded(r.value, width[1], true) + "  " +
                       padded(deviation(r.random), width[2] + 3, true) + "  " +
                       padded(deviation(r.systematic), width[3] + 3, true) + "  " + r.unit;
    line.erase(line.find_last_not_of(' ') + 1);
    std::cout << line << '\n';
  }
}

void print_remarks(const std::vector<std::string>& warnings, const std::vector<std::string>& assumed, bool warnings_too) {
  if (warnings_too)
    for (const auto& line : warnings) std::cout << "warning: " << line << '\n';
  for (const auto& line : assumed) std::cout << "assumed: " << line << '\n';
}

void print_fit(const rig_calibration& c) {
  std::cout << c.title << ": " << set_of(c).from;
  if (!c.predicted.empty()) std::cout << "; " << c.predicted.size() << " held out and predicted";
  std::cout << '\n';
  print_rows(rows_of(c));
  for (const auto& name : c.fit.unidentified) std::cout << "not identifiable from these plucks: " << name << '\n';
  std::cout
      << "random: changes from fit to fit; systematic: common to all, from the declared forces, gains, tension and length\n";
  print_remarks(c.warnings, c.assumed, true);
}

exit_code outcome_of(bool incomplete, bool warnings, const fit_options& given) {
  return incomplete || (warnings && given.strict) ? exit_code::finding : exit_code::ok;
}

/// Whatever the kind of calibration, where it goes.
template <class Calibration, class Print>
exit_code deliver(Calibration& c, const rosin::rig_folder& folder, const fit_options& given, const provenance& from,
                  Print print_it) {
  const auto doubts = doubts_of(folder);
  c.warnings.insert(c.warnings.begin(), doubts.begin(), doubts.end());
  c.incomplete = c.incomplete || rosin::has_error(folder.doubts);
  exit_code done = outcome_of(c.incomplete, !c.warnings.empty(), given);
  if (!given.json_file.empty())
    if (const auto why = save_json(given.json_file, to_json(c, from), given.force)) done = worse(done, fail(why->message));
  if (given.json_file == "-")
    for (const auto& line : c.warnings) std::cerr << "rosin: warning: " << line << '\n';
  else print_it(c);
  if (!given.report.empty())
    done = worse(done, write_fit_report(given.report, given.force, c, from));  // last: it may lack figures
  return done;
}

/// From single channels; `instead` says why, where both ends have a force transducer and nobody asked for it.
exit_code fit_pickups(const fit_options& given, const rosin::rig_folder& folder, provenance from, const std::string& instead) {
  const bool as_json = given.json_file == "-";
  const rosin::rig& rig = folder.rig;
  if (!given.header.path.empty()) return fail(rig.file + ": --emit-header: force transducers at both ends are needed", as_json);
  auto fitted = calibrate_pickups(rig, from);
  if (!fitted) return fail(failed(fitted.error(), doubts_of(folder)).message, as_json);
  if (!instead.empty()) fitted->warnings.push_back(instead), fitted->incomplete = true;
  return deliver(*fitted, folder, given, from, [](const pickup_calibration& c) {
    std::cout << c.title << ": pitch, stiffness and loss from single channels\n";
    std::vector<calibration_row> rows;
    for (const auto& one : c.results)
      for (auto& row : rows_of(one)) rows.push_back(std::move(row));
    print_rows(rows);
    print_remarks(c.warnings, c.assumed, true);
  });
}

exit_code run(const fit_options& given, provenance from) {
  const bool as_json = given.json_file == "-";
  for (const auto* file : {&given.json_file, &given.report, &given.header.path})
    if (!file->empty())
      if (const auto why = may_write_file(*file, given.force, file == &given.json_file)) return fail(why->message, as_json);
  if (!given.report.empty())
    if (const auto why = cannot_draw()) return fail(why->message, as_json);
  const auto folder = open_rig(given.rig, from);
  if (!folder) return fail(folder.error(), as_json);
  if (given.pickup || !folder->rig.has_both_forces()) return fit_pickups(given, *folder, from, {});
  auto fitted = calibrate(folder->rig, from, !given.report.empty());
  if (!fitted && given.header.path.empty() && all_begin_late(folder->rig, from))
    return fit_pickups(given, *folder, from,
                       "no pluck holds its release: gains, polarity, order of the channels, place of the contact and the wire's "
                       "force cannot be known; pitch, stiffness and loss are from what rings in each channel");
  if (!fitted) return fail(failed(fitted.error(), doubts_of(*folder)).message, as_json);
  exit_code done = deliver(*fitted, *folder, given, from, print_fit);
  if (given.header.path.empty()) return done;
  std::vector<std::string> said;
  if (any_end_moves(folder->rig))
    said.emplace_back("header: the streaming reconstruction takes both ends for rigid; [terminations] is not in it");
  if (const auto why = write_header(given.header, given.force, set_of(*fitted), from, said))
    done = worse(done, fail(why->message));
  for (const auto& line : said) (as_json ? std::cerr : std::cout) << line << '\n';
  return done;
}

}  // namespace

void add_fit(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<fit_options>();
  CLI::App* command = app.add_subcommand("fit", "Calibrate string, contact and sensors from the plucks of a rig");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds rig.toml")->required();
  command
      ->add_option("--json", given->json_file,
                   "Write everything, with the covariance, to FILE; without one, or with -, to standard output")
      ->expected(0, 1)
      ->default_str("-")
      ->type_name("FILE");
  command->add_option("--report", given->report, "Write a page with figures (needs gnuplot)")->type_name("FILE.html");
  command->add_flag("--pickup", given->pickup, "Fit each channel by itself even where both ends have a force transducer");
  command->add_flag("--strict", given->strict, "Exit with 1 on warnings as well");
  add_force_option(*command, given->force);
  add_header_options(*command, given->header);
  command->footer(
      "All plucks that are not marked hold_out are fitted together: pitch, place of the contact, delays to both ends,\n"
      "bending stiffness, loss, gains and noise of the channels, instant and force of each release. Each value comes with\n"
      "one standard deviation, random and systematic apart. Plucks marked hold_out are predicted, not fitted.\n"
      "Without force transducers at both ends, or where no pluck holds its release: partials, inharmonicity, bending\n"
      "stiffness and loss from each channel.\n"
      "Exit status: 0 done, 1 done but plucks had to be left out, the fit did not settle, values of the rig file contradict\n"
      "one another or figures are missing, 2 nothing could be fitted, or a file not be written.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
