// SPDX-License-Identifier: MIT
//
// rosin diagnose: where simulation and recordings differ, and which physics was left out.
//
#include "calibration_file.hpp"
#include "commands.hpp"
#include "diagnose_rig.hpp"
#include "digits.hpp"
#include "progress.hpp"
#include "report_figure.hpp"

#include <rosin/acquire/effect_names.hpp>

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct options {
  std::string rig, json_file, report;
  std::vector<std::string> without;
  int threads = 0;
  bool force = false, isolability = false;
  double rate_Hz = 128000, noise_N = 3e-4;
};

void print_text(const rig_diagnosis& d) {
  std::cout << d.title << ": " << d.verdict << '\n' << sentence(d) << '\n';
  for (const auto& m : d.missing) {
    std::cout << m.effect << (m.end.empty() ? "" : ", " + m.end + " end") << (m.channel.empty() ? "" : ", channel " + m.channel)
              << '\n';
    for (const auto& p : m.parameters)
      std::cout << "  " << p.name << " = " << in_digits(p.value, "%.6g") << " +- " << in_digits(p.sd, "%.2g") << '\n';
    for (const auto& other : m.indistinguishable_from) std::cout << "  cannot be told from " << other << '\n';
  }
  if (!d.kind.empty()) std::cout << kind_in_words(d.kind) << '\n';
  if (d.time_s) {
    std::cout << "largest in " << d.take << (d.channel.empty() ? "" : ", channel " + d.channel) << ", "
              << in_digits(1e3 * (*d.time_s)[0], "%.2f") << " to " << in_digits(1e3 * (*d.time_s)[1], "%.2f") << " ms";
    if (d.echo) std::cout << (*d.echo == 0 ? ", before any wave" : ", behind wave " + std::to_string(*d.echo));
    if (d.band_Hz)
      std::cout << ", " << in_digits((*d.band_Hz)[0], "%.0f") << " to " << in_digits((*d.band_Hz)[1], "%.0f") << " Hz";
    std::cout << '\n';
  }
  std::cout << d.metric << ": " << in_digits(d.before, "%.4g") << " before";
  if (d.after) std::cout << ", " << in_digits(*d.after, "%.4g") << " after";
  std::cout << ", " << in_digits(d.noise_floor, "%.4g") << " from noise alone\n";
  std::size_t shown = 0;
  for (const auto& r : d.ranking) {
    if (++shown > 6 && !r.left) continue;
    std::string names;
    for (const auto& e : r.effects) names += (names.empty() ? "" : " + ") + e;
    std::cout << "  " << (names.empty() ? "as declared" : names) << ": log10 of the evidence "
              << in_digits(r.log10_evidence, "%.4g") << (r.left ? ", leaves " + in_digits(*r.left, "%.4g") : "") << '\n';
  }
  for (const auto& line : d.assumed) std::cout << "assumed: " << line << '\n';
}

exit_code tell_isolability(const options& given, provenance from) {
  const bool as_json = given.json_file == "-";
  const auto rig = rosin::load_rig(given.rig, rosin::take_files::to_be_made);
  if (!rig) return fail(rig.error(), as_json);
  if (const auto why = from.add_input(rig->file)) return fail(why->message, as_json);
  auto found = isolability_of(*rig, given.rate_Hz, given.noise_N);
  if (!found) return fail(found.error(), as_json);
  (*found)["provenance"] = from.to_json();
  if (!given.json_file.empty())
    if (const auto why = save_json(given.json_file, *found, given.force)) return fail(why->message);
  if (!as_json) std::cout << isolability_text(*found);
  return exit_code::ok;
}

rosin::outcome<rig_diagnosis> diagnosis_of(const rosin::rig& rig, provenance& from, const options& given) {
  if (!rig.has_both_forces()) return diagnose_pickups_of(rig, from, given.without);
  progress bar{"diagnosing", diagnosis_steps};
  return diagnose(rig, from, given.without, given.threads, [&] { bar.step(); });
}

exit_code run(const options& given, provenance from) {
  if (given.isolability) return tell_isolability(given, std::move(from));
  const bool as_json = given.json_file == "-";
  for (const auto* file : {&given.json_file, &given.report})
    if (!file->empty())
      if (const auto why = may_write_file(*file, given.force, file == &given.json_file)) return fail(why->message, as_json);
  if (!given.report.empty())
    if (const auto why = cannot_draw()) return fail(why->message, as_json);
  const auto folder = open_rig(given.rig, from);
  if (!folder) return fail(folder.error(), as_json);
  auto found = diagnosis_of(folder->rig, from, given);
  const auto doubts = doubts_of(*folder);
  if (!found) return fail(failed(found.error(), doubts).message, as_json);
  found->warnings.insert(found->warnings.begin(), doubts.begin(), doubts.end());
  auto done = rosin::has_error(folder->doubts) ? exit_code::finding : exit_code::ok;
  if (!given.json_file.empty())
    if (const auto why = save_json(given.json_file, to_json(*found, from), given.force)) done = fail(why->message);
  for (const auto& line : found->warnings) std::cerr << "rosin: warning: " << line << '\n';
  if (!as_json) print_text(*found);
  if (given.report.empty()) return done;
  return worse(done, write_diagnosis_report(given.report, given.force, *found, from));
}

}  // namespace

void add_diagnose(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<options>();
  CLI::App* command = app.add_subcommand("diagnose", "Say what physics the declared model leaves out");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds rig.toml")->required();
  command->add_option("--json", given->json_file, "Write the diagnosis to FILE; without one, or with -, to standard output")
      ->expected(0, 1)
      ->default_str("-")
      ->type_name("FILE");
  command->add_option("--report", given->report, "Write a page with figures (needs gnuplot)")->type_name("FILE.html");
  command
      ->add_option("--without", given->without,
                   "An effect that the catalogue is not to know (any number): what would be said then?")
      ->check(CLI::IsMember(std::vector<std::string>(rosin::effect_names.begin(), rosin::effect_names.end())).description(""))
      ->type_name("EFFECT");
  command->add_option("--threads", given->threads, "0: all cores; the diagnosis is the same, only sooner")
      ->check(between(0, 1024, "INT").description(""))
      ->capture_default_str();
  auto* isolability =
      command->add_flag("--isolability", given->isolability, "What the plucks of the rig file can tell apart, recorded or not")
          ->excludes("--report");
  command->add_option("--rate", given->rate_Hz, "With --isolability: sampling rate, Hz")
      ->needs(isolability)
      ->check(between(8000.0, 1e6))
      ->capture_default_str();
  command->add_option("--noise", given->noise_N, "With --isolability: noise of a channel, rms, N")
      ->needs(isolability)
      ->check(positive())
      ->capture_default_str();
  add_force_option(*command, given->force);
  command->footer(
      "The model that [model] declares is fitted to the plucks; what is left is set against every effect of the catalogue,\n"
      "alone and together, and judged on takes that were not fitted. Then the strokes are reconstructed with what was found,\n"
      "and tension and contact examined. A rig without two force channels is judged by its partials. Verdicts: no-mismatch, "
      "explained, unexplained.\n"
      "Exit status: 0 done, 1 done but values of the rig file contradict one another or figures are missing, 2 nothing\n"
      "could be done, or a file not be written.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
