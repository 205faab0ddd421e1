// SPDX-License-Identifier: MIT
//
// rosin reconstruct: a bowed take turned into friction force and string velocity under the bow.
//
#include "commands.hpp"
#include "progress.hpp"
#include "reconstruct_report.hpp"
#include "reconstruct_slips.hpp"

#include <rosin/report/csv.hpp>

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct reconstruct_options {
  std::string rig, take, calibration, model, report, json_file, slips;
  table_output output;
  take_options how;
  bool no_fine_tune = false, strict = false;
};

/// What can be refused before any work.
std::optional<rosin::failure> cannot_deliver(const reconstruct_options& given) {
  if (!given.report.empty())
    if (auto why = cannot_draw()) return why;
  for (const auto* file : {&given.report, &given.json_file, &given.slips})
    if (!file->empty())
      if (auto why = may_write_file(*file, given.output.force, file == &given.json_file)) return why;
  if (given.output.path.empty()) return std::nullopt;
  if (given.output.path != "-") return may_write(given.output);
  if (given.output.format != "csv") return rosin::failure{"--out -: only csv goes to standard output"};
  if (given.json_file == "-") return rosin::failure{"--out - and --json -: only one of them can have standard output"};
  return std::nullopt;
}

std::string names_of(const rosin::rig& rig) {
  std::string out;
  for (const auto& t : rig.takes)
    if (t.kind == rosin::take_kind::bow) out += (out.empty() ? "" : ", ") + t.name;
  return out.empty() ? "there is none" : out;
}

rosin::outcome<const rosin::take*> bowed_take(const rosin::rig& rig, const std::string& name) {
  const rosin::take* take = rig.find_take(name);
  if (!rig.has_both_forces())
    return rosin::failure{
        rig.file + ": channels near and far (forces on both terminations) are needed to reconstruct what happens between them"};
  if (take == nullptr) return rosin::failure{rig.file + ": no take \"" + name + "\"; bowed takes: " + names_of(rig)};
  if (take->kind != rosin::take_kind::bow)
    return rosin::failure{rig.file + ":" + std::to_string(take->line) + ": take \"" + name + "\" is of kind " +
                          name_of(take->kind) + "; bowed takes: " + names_of(rig)};
  return take;
}

/// From the plucks of the rig, or from a file.
rosin::outcome<calibration_set> calibration_of(const reconstruct_options& given, const rosin::rig& rig, provenance& from,
                                               std::optional<rig_calibration>& fitted) {
  if (!given.calibration.empty()) {
    if (const auto why = from.add_input(given.calibration)) return *why;
    return read_calibration(given.calibration);
  }
  // with --model, too: what the declared model makes of the plucks stands beside it
  auto made = calibrate(rig, from, !given.report.empty());
  if (!made) return rosin::failure{made.error()};
  fitted = *std::move(made);
  return set_of(*fitted);
}

std::string said_of(const corrected_model& m) {
  const auto list = [](const std::vector<std::string>& names) {
    std::string out;
    for (const auto& n : names) out += (out.empty() ? "" : ", ") + n;
    return out.empty() ? std::string{"nothing"} : out;
  };
  return m.file + ": taken into account: " + list(m.effects) +
         (m.passed_over.empty() ? "" : "; of the contact, hence not needed: " + list(m.passed_over));
}

void print_text(std::ostream& out, const take_reconstruction& r) {
  out << r.title << ", " << summary_of(r) << '\n';
  for (const auto& [what, value] : facts_of(r)) out << "  " << what << ": " << value << '\n';
  for (const auto& line : r.assumed) out << "assumed: " << line << '\n';
}

/// Every output that can be written is, the text after them, the page last: it may lack figures.
exit_code deliver(const reconstruct_options& given, const take_reconstruction& r, const std::optional<rig_calibration>& fitted,
                  const provenance& from) {
  auto done = exit_code::ok;
  const auto put = [&](const std::optional<rosin::failure>& why) {
    if (why) done = worse(done, fail(why->message));
  };
  if (given.output.path == "-") rosin::write_csv(std::cout, table_of(r, from));
  else if (!given.output.path.empty()) put(save(given.output, table_of(r, from)));
  if (!given.slips.empty()) put(save({given.slips, "csv", given.output.force}, table_of(slips_of(r), r, from)));
  if (!given.json_file.empty()) put(save_json(given.json_file, to_json(r, from), given.output.force));
  for (const auto& line : r.warnings) std::cerr << "rosin: warning: " << line << '\n';
  if (given.json_file != "-") print_text(given.output.path == "-" ? std::cerr : std::cout, r);
  if (given.report.empty()) return done;
  return worse(done, write_reconstruction_report(given.report, given.output.force, r, fitted, from));
}

exit_code run(const reconstruct_options& given, provenance from) {
  const bool as_json = given.json_file == "-";
  if (const auto why = cannot_deliver(given)) return fail(why->message, as_json);
  const auto folder = open_rig(given.rig, from);
  if (!folder) return fail(folder.error(), as_json);
  const rosin::rig& rig = folder->rig;
  const auto take = bowed_take(rig, given.take);
  if (!take) return fail(take.error(), as_json);
  const auto read = read_sound_take(rig, **take, from);
  if (!read) return fail(failed(read.error(), doubts_of(*folder)).message, as_json);
  std::optional<rig_calibration> fitted;
  const auto calibration = calibration_of(given, rig, from, fitted);
  if (!calibration) return fail(failed(calibration.error(), doubts_of(*folder)).message, as_json);
  take_options how = given.how;
  if (!given.model.empty()) {
    auto model = read_model(given.model, rig, from);
    if (!model) return fail(model.error(), as_json);
    how.model = *std::move(model), how.fine_tune = false;
  }
  auto made = reconstruct_take(rig, **take, *read, *calibration, how);
  if (!made) return fail(failed(made.error(), doubts_of(*folder)).message, as_json);
  std::vector<std::string> warnings = doubts_of(*folder), assumed = fitted ? fitted->assumed : rosin::values_of(rig).assumed;
  warnings.insert(warnings.end(), folder->notes.begin(), folder->notes.end());
  for (const auto& f : read->check.findings)
    if (f.level != rosin::severity::note) warnings.push_back(warning_of(rig, f));
  if (how.model && !how.model->doubt.empty()) warnings.push_back(how.model->file + ": " + how.model->doubt);
  if (fitted)
    for (const auto& line : fitted->warnings) warnings.push_back((how.model ? "with the declared model: " : "") + line);
  made->warnings.insert(made->warnings.begin(), warnings.begin(), warnings.end());
  made->assumed.insert(made->assumed.begin(), assumed.begin(), assumed.end());
  if (how.model) made->assumed.push_back(said_of(*how.model));
  const bool found = (fitted && fitted->incomplete) || made->contradicts_itself || rosin::has_error(folder->doubts) ||
                     (given.strict && !made->warnings.empty());
  return worse(found ? exit_code::finding : exit_code::ok, deliver(given, *made, fitted, from));
}

}  // namespace

void add_reconstruct(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<reconstruct_options>();
  CLI::App* command = app.add_subcommand("reconstruct", "Friction force and velocity under the bow, sample by sample");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds rig.toml")->required();
  command->add_option("--take", given->take, "Name of the bowed take")->required()->type_name("NAME");
  add_table_options(*command, given->output);
  command->get_option("--out")->required(false)->description("Table to write, one row a sample; - for standard output");
  command
      ->add_option("--pass", given->how.pass_Hz,
                   "End of the pass band; 0.30 of the sampling rate, or two thirds of --stop, if not given")
      ->type_name("HZ")
      ->check(positive());
  command
      ->add_option("--stop", given->how.stop_Hz,
                   "Nothing is left from here on; 0.45 of the sampling rate, or 1.5 times --pass, if not given")
      ->type_name("HZ")
      ->check(positive());
  command->add_flag("--no-fine-tune", given->no_fine_tune, "Leave delays and gains as the plucks gave them");
  command->add_flag("--paper", given->how.paper, "The processing of Woodhouse, Schumacher & Garoff (2000), for comparison");
  command->add_flag("--frequency-domain", given->how.frequency_domain,
                    "Eqs. (10): the most nearly periodic stretch only, terminations as declared");
  command->add_option("--calibration", given->calibration, "Take the calibration from a file of `rosin fit --json`")
      ->type_name("FILE.json");
  command->add_option("--model", given->model, "Reconstruct with the corrected model of `rosin diagnose --json`")
      ->type_name("FILE.json")
      ->excludes("--calibration")
      ->excludes("--paper")
      ->excludes("--frequency-domain");
  command
      ->add_option("--slips", given->slips,
                   "Write a table of the slips, one row each: loops of force against velocity, track along the rod")
      ->type_name("FILE.csv");
  command->add_option("--report", given->report, "Write a page with figures (needs gnuplot)")->type_name("FILE.html");
  command->add_option("--json", given->json_file, "Write a summary to FILE; without one, or with -, to standard output")
      ->expected(0, 1)
      ->default_str("-")
      ->type_name("FILE");
  command->add_flag("--strict", given->strict, "Exit with 1 on warnings as well");
  command->footer(
      "Calibrates from the plucks of the rig, tunes delays and relative gain to the take within what the plucks allow,\n"
      "and reconstructs the whole take, transient included. What cannot be known (the first and last transit times) is\n"
      "left empty. Standard deviations are random; those of the common scale stand in columns of their own.\n"
      "Exit status: 0 done, 1 done but plucks had to be left out, the fit did not settle, figures are missing, or something\n"
      "contradicts itself (no slip, friction that the normal force does not allow, a level that drifts, values off by a power\n"
      "of ten), 2 nothing could be done, or a file not be written.");
  command->callback([given, command, &result] {
    given->how.fine_tune = !given->no_fine_tune;
    result = run(*given, provenance{*command});
  });
}

}  // namespace tool
