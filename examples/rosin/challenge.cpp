// SPDX-License-Identifier: MIT
//
// rosin challenge: rigs in which physics is hidden, diagnosed from their folders alone, and scored.
//
#include "calibration_file.hpp"
#include "challenge_forces.hpp"
#include "challenge_rig.hpp"
#include "challenge_score.hpp"
#include "commands.hpp"
#include "diagnose_rig.hpp"
#include "digits.hpp"
#include "progress.hpp"

#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <numeric>
#include <sstream>

namespace tool {

namespace {

namespace fs = std::filesystem;

struct challenge_options {
  std::string out, shard = "1/1";
  std::vector<std::string> hidden;
  std::uint64_t seed = 1;
  int count = 0, effects = 1;
  double strength = 1, noise_dB = 0, loss_scatter = 0;
  std::vector<double> pitch_Hz;
  bool only_make = false, leave_out = false, forces = false, json = false;
};

struct challenge_folders {
  fs::path rigs, truth, diagnoses, forces;
  challenge_folders(const fs::path& root, bool leave_out)
      : rigs{root / "rigs"}, truth{root / "truth"}, diagnoses{root / (leave_out ? "diagnoses-left-out" : "diagnoses")},
        forces{root / "forces"} {}
};

std::string describe(const challenge_options& o) {
  std::string out = "`rosin challenge --seed " + std::to_string(o.seed) + " --count " + std::to_string(o.count) + " --effects " +
                    std::to_string(o.effects);
  if (o.strength != 1) out += " --strength " + in_digits(o.strength);
  if (o.noise_dB > 0) out += " --noise-db " + in_digits(o.noise_dB);
  if (o.loss_scatter > 0) out += " --loss-scatter " + in_digits(o.loss_scatter);
  if (!o.pitch_Hz.empty()) out += " --pitch " + in_digits(o.pitch_Hz[0]) + " " + in_digits(o.pitch_Hz[1]);
  if (o.leave_out) out += " --leave-out";
  for (const auto& name : o.hidden) out += " --effect " + name;
  return out + "`";
}

/// A rig belongs to the same part on every machine, whatever else is in the folder: by the number that its name ends with, or by
/// its letters.
std::size_t part_of(const std::string& name, std::size_t parts) {
  const std::string digits = name.substr(name.find_last_not_of("0123456789") + 1);
  if (!digits.empty() && digits.size() < 19) return static_cast<std::size_t>(std::stoull(digits) % parts);
  return std::accumulate(name.begin(), name.end(), std::size_t{0},
                         [](std::size_t sum, char c) { return sum + static_cast<unsigned char>(c); }) %
         parts;
}

/// Writes what is not there yet; a rig is complete once its truth is.
std::optional<rosin::failure> make(const challenge_options& given, const challenge_folders& to, std::size_t shard,
                                   std::size_t shards) {
  std::error_code error;
  for (const auto& folder : {to.rigs, to.truth, to.diagnoses})
    if (!fs::create_directories(folder, error) && error)
      return rosin::failure{folder.string() + ": cannot be made: " + error.message()};
  progress bar{"hiding", static_cast<std::size_t>(given.count)};
  for (int i = 0; i < given.count; ++i, bar.step()) {
    const std::uint64_t seed = given.seed * 100000 + static_cast<std::uint64_t>(i);
    if (seed % shards != shard) continue;
    const auto rig =
        draw_challenge({seed, given.effects, given.strength, given.noise_dB, given.hidden, given.pitch_Hz, given.loss_scatter});
    const auto truth = to.truth / (rig.name + ".json");
    if (fs::exists(truth) && (!given.forces || fs::exists(true_forces(to.truth, rig.name, "bow-1")))) continue;
    if (auto why = write_challenge(rig, to.rigs / rig.name, true, given.forces ? to.truth : fs::path{})) return why;
    if (auto why = save_json(truth.string(), truth_of(rig), false)) return why;
  }
  return std::nullopt;
}

/// Names of what is hidden in a rig, for a diagnosis that does not know it; empty where there is no truth.
std::vector<std::string> hidden_in(const fs::path& truth) {
  std::ifstream in{truth};
  const json t = in ? json::parse(in, nullptr, false) : json{};
  std::vector<std::string> out;
  if (t.is_object() && t.contains("effects"))
    for (const auto& e : t.at("effects")) out.push_back(e.at("effect"));
  return out;
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::directory_iterator(folder)) out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// Diagnoses every rig of the folder that has no diagnosis yet; a rig that cannot be diagnosed is named and counts as wrong.
void diagnose_all(const challenge_folders& at, bool leave_out, const provenance& from, std::size_t shard, std::size_t shards) {
  auto rigs = sorted_entries(at.rigs);
  std::erase_if(rigs, [](const fs::path& rig) { return !fs::exists(rig / "rig.toml"); });
  progress bar{"diagnosing", rigs.size()};
  for (std::size_t i = 0; i < rigs.size(); ++i, bar.step()) {
    const std::string name = rigs[i].filename().string();
    const auto file = at.diagnoses / (name + ".json");
    if (part_of(name, shards) != shard || fs::exists(file)) continue;
    const auto start = std::chrono::steady_clock::now();
    auto own = from;
    json out{
        {"verdict", "failed"}, {"missing", json::array()}, {"fit", {{"metric", ""}, {"after", nullptr}, {"noise_floor", 0}}}};
    const auto rig = open_rig(rigs[i].string(), own);
    if (!rig) out["error"] = rig.error();
    else if (const auto found =
                 diagnose(rig->rig, own, leave_out ? hidden_in(at.truth / file.filename()) : std::vector<std::string>{}))
      out = to_json(*found, own);
    else out["error"] = found.error();
    if (out.contains("error")) std::cerr << "rosin: " << rigs[i].string() << ": " << out["error"].get<std::string>() << '\n';
    out["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (const auto why = save_json(file.string(), out, false)) std::cerr << "rosin: " << why->message << '\n';
  }
}

/// Reconstructs the strokes of every rig that has a diagnosis and whose true forces are there, as declared and as diagnosed.
void reconstruct_all(const challenge_folders& at, const provenance& from, std::size_t shard, std::size_t shards) {
  std::error_code error;
  fs::create_directories(at.forces, error);
  const auto diagnoses = sorted_entries(at.diagnoses);
  progress bar{"reconstructing", diagnoses.size()};
  for (std::size_t i = 0; i < diagnoses.size(); ++i, bar.step()) {
    const std::string name = diagnoses[i].stem().string();
    const auto file = at.forces / diagnoses[i].filename();
    if (part_of(name, shards) != shard || fs::exists(file)) continue;
    const auto errors = force_errors(at.rigs / name, at.truth, diagnoses[i].string(), from);
    if (errors.empty()) continue;
    if (const auto why = save_json(file.string(), errors, false)) std::cerr << "rosin: " << why->message << '\n';
  }
}

std::vector<rig_score> score_all(const challenge_folders& at) {
  std::vector<rig_score> out;
  for (const auto& file : sorted_entries(at.diagnoses)) {
    std::ifstream truth{at.truth / file.filename()}, said{file};
    if (!truth || !said) continue;
    const json diagnosis = json::parse(said, nullptr, false), hidden = json::parse(truth, nullptr, false);
    if (diagnosis.is_discarded() || hidden.is_discarded()) continue;
    out.push_back(score(hidden, diagnosis));
    out.back().seconds = diagnosis.value("seconds", 0.0);
    if (std::ifstream forces{at.forces / file.filename()}) add_forces(json::parse(forces, nullptr, false), out.back());
  }
  return out;
}

/// Why these cannot be hidden together, if they cannot.
std::optional<rosin::failure> not_hideable(const std::vector<std::string>& names) {
  const auto knows = [](const std::vector<std::string>& all, const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
  };
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (!knows(hideable(), *name) && !knows(hideable_on_request(), *name)) return rosin::failure{*name + ": cannot be hidden"};
    for (auto other = names.begin(); other != name; ++other)
      if (exclude_each_other(*other, *name)) return rosin::failure{*other + " and " + *name + ": a rig has one of them"};
  }
  return std::nullopt;
}

exit_code run(const challenge_options& given, const provenance& from) {
  std::size_t shard = 0, shards = 1;
  if (char slash = 0;
      !(std::istringstream{given.shard} >> shard >> slash >> shards) || slash != '/' || shard == 0 || shard > shards)
    return fail("--shard " + given.shard + ": K/N with K from 1 to N is needed", given.json);
  --shard;
  if (const auto why = not_hideable(given.hidden)) return fail("--effect " + why->message, given.json);
  const challenge_folders at{given.out, given.leave_out};
  if (const auto why = make(given, at, shard, shards)) return fail(why->message, given.json);
  if (given.only_make) return exit_code::ok;
  diagnose_all(at, given.leave_out, from, shard, shards);
  if (given.forces) reconstruct_all(at, from, shard, shards);
  const auto scores = score_all(at);
  const auto page = given.leave_out ? left_out_to_markdown(scores, describe(given))
                                    : to_markdown(scores, describe(given)) + forces_to_markdown(scores);
  if (const auto why = rosin::write_file((fs::path{given.out} / (given.leave_out ? "left-out.md" : "challenge.md")).string(),
                                         rosin::overwrite::allow, [&](std::ostream& o) { o << page; }))
    return fail(why->message, given.json);
  if (given.json) print(to_json(scores));
  else std::cout << page;
  return exit_code::ok;
}

}  // namespace

void add_challenge(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<challenge_options>();
  CLI::App* command = app.add_subcommand("challenge", "Hide physics in simulated rigs, diagnose them blind, and score");
  command->add_option("--out", given->out, "Folder: rigs/, truth/, diagnoses/ and the page challenge.md; what is there is used")
      ->required()
      ->type_name("FOLDER");
  command->add_option("--seed", given->seed, "Of the first rig")->check(not_negative())->capture_default_str();
  command->add_option("--count", given->count, "Rigs to make; 0: only what the folder holds")
      ->check(not_negative())
      ->capture_default_str();
  command->add_option("--effects", given->effects, "Hidden in each rig")->check(between(0, 2, "INT"))->capture_default_str();
  command
      ->add_option("--effect", given->hidden,
                   "This one and no other, or, given twice, these two; besides those that are drawn: " +
                       CLI::detail::join(hideable_on_request(), ", "))
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--strength", given->strength, "1: as in a laboratory in which one thing went wrong")
      ->check(between(0.001, 10.0))
      ->capture_default_str();
  command->add_option("--noise-db", given->noise_dB, "Peak of the first pluck over the noise; 0: drawn, 0.3 to 0.5 mN")
      ->check(between(0.0, 120.0))
      ->capture_default_str();
  command
      ->add_option("--loss-scatter", given->loss_scatter,
                   "Of ln 1/Q of the strings' modes, each off its law by itself; measured strings: 0.09 to 0.38")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  command->add_option("--pitch", given->pitch_Hz, "Strings between these; without it 280 to 870")
      ->expected(2)
      ->check(between(20.0, 5000.0))
      ->type_name("HZ HZ");
  command->add_option("--shard", given->shard, "The K-th of N parts: every N-th rig")->type_name("K/N")->capture_default_str();
  command->add_flag("--leave-out", given->leave_out,
                    "Diagnosed by a catalogue that does not know what is hidden: it should say so (left-out.md)");
  command->add_flag("--only-make", given->only_make, "Make the rigs, diagnose nothing");
  command
      ->add_flag("--forces", given->forces,
                 "Keep the strokes' true forces, and reconstruct them as declared and as diagnosed (forces/)")
      ->excludes("--leave-out");
  add_json_option(*command, given->json);
  command->footer(
      "The rigs are stepped mode by mode, with beads, fingers, supports and the contact solved for in every step; nothing of\n"
      "that is shared with the closed forms that a diagnosis fits. A folder rigs/ with truth/NAME.json beside it is scored "
      "likewise.\n"
      "Exit status: 0 done, whatever the score, 2 bad input or usage, or a rig that could not be made.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
