// SPDX-License-Identifier: MIT
//
// rosin simulate: the recordings that a rig file names, made by a simulation, with the truth in another place.
//
#include "commands.hpp"
#include "digits.hpp"
#include "progress.hpp"
#include "rig_input.hpp"
#include "rig_leftovers.hpp"
#include "simulate_declaration.hpp"
#include "simulate_model.hpp"
#include "simulate_truth.hpp"

#include <iostream>
#include <memory>
#include <sstream>

namespace tool {

namespace {

namespace fs = std::filesystem;

struct simulate_options {
  std::string rig, out, truth, model, format = "csv";
  std::optional<std::uint64_t> seed;
  bool force = false, json = false;

  [[nodiscard]] rosin::overwrite existing() const noexcept { return force ? rosin::overwrite::allow : rosin::overwrite::refuse; }
};

/// Where everything goes. Truth: a file of its own name (its tables beside it), or a folder.
struct places {
  fs::path folder, rig, truth;
  std::vector<fs::path> recordings, tables;  ///< by take; tables: empty where a take has none
};

fs::path whole_path(const fs::path& path) {
  std::error_code ignored;
  const auto out = fs::weakly_canonical(fs::absolute(path, ignored), ignored).lexically_normal();
  return out.has_filename() ? out : out.parent_path();
}

bool lies_in(const fs::path& inner, const fs::path& outer) {
  const auto way = whole_path(inner).lexically_relative(whole_path(outer));
  return !way.empty() && *way.begin() != "..";
}

places find_places(const simulate_options& given, const rosin::rig& rig) {
  places out{given.out, fs::path{given.out} / "rig.toml", {}, {}, {}};
  fs::path truth = given.truth;
  if (truth.empty()) {
    const auto folder = whole_path(given.out);
    truth = folder.parent_path() / (folder.filename().string() + "-truth");
    if (fs::path{given.out}.is_relative()) truth = truth.lexically_proximate(whole_path("."));
  }
  const bool one_file = truth.extension() == ".json";
  out.truth = one_file ? truth : truth / "truth.json";
  const std::string prefix = one_file ? truth.stem().string() + "-" : "";
  for (const auto& take : rig.takes) {
    out.recordings.push_back(out.folder / take.file);
    out.tables.push_back(take.kind == rosin::take_kind::bow ? out.truth.parent_path() / (prefix + take.name + "." + given.format)
                                                            : fs::path{});
  }
  return out;
}

/// Why nothing can be written there, found before the long work.
std::string problem_with(const places& to, const simulate_options& given, const rosin::rig& rig) {
  if (whole_path(given.out) == whole_path(rig.folder.empty() ? "." : rig.folder))
    return given.out + ": is the folder of the rig file itself, which would be overwritten";
  if (const auto why = recording_in(to.folder.string())) return why->message;
  if (lies_in(to.truth, to.folder)) return to.truth.string() + ": the truth must not lie in the folder of the recordings";
  std::vector<fs::path> all{to.rig, to.truth};
  all.insert(all.end(), to.recordings.begin(), to.recordings.end());
  for (const auto* end : {&rig.near, &rig.far})
    if (*end && (*end)->kind == rosin::termination::form::table) all.push_back(to.folder / (*end)->file);
  std::copy_if(to.tables.begin(), to.tables.end(), std::back_inserter(all), [](const auto& p) { return !p.empty(); });
  for (const auto& path : all) {
    std::error_code ignored;
    if (!given.force && fs::exists(path, ignored)) return path.string() + ": exists already; --force overwrites it";
    if (fs::is_directory(path, ignored)) return path.string() + ": is a folder";
  }
  return {};
}

std::optional<rosin::failure> make_folder_for(const fs::path& file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error) return rosin::failure{file.parent_path().string() + ": cannot be made: " + error.message()};
  return std::nullopt;
}

std::optional<rosin::failure> write_text(const fs::path& file, const std::string& text, rosin::overwrite existing) {
  if (auto why = make_folder_for(file)) return why;
  return rosin::write_file(file.string(), existing, [&](std::ostream& out) { out << text; });
}

std::optional<rosin::failure> write_takes(const simulate_options& given, const provenance& from, const simulation_plan& plan,
                                          const std::vector<simulated_take>& takes, const places& to) {
  for (std::size_t i = 0; i < takes.size(); ++i) {
    if (auto why = make_folder_for(to.recordings[i])) return why;
    if (auto why = rosin::write_audio(to.recordings[i].string(), takes[i].recording, given.existing())) return why;
    if (to.tables[i].empty()) continue;
    auto comments = from.comment_lines();
    comments.push_back("truth of take " + plan.takes[i].declared.name);
    if (auto why = make_folder_for(to.tables[i])) return why;
    if (auto why =
            save({to.tables[i].string(), given.format, given.force}, truth_table(plan, takes[i].truth, std::move(comments))))
      return why;
  }
  return std::nullopt;
}

/// Tables of admittance that the rig file names.
std::optional<rosin::failure> write_tables_of_ends(const simulate_options& given, const rosin::rig& rig, const places& to) {
  for (const auto* end : {&rig.near, &rig.far}) {
    if (!*end || (*end)->kind != rosin::termination::form::table) continue;
    const auto text = rosin::read_file(rig.path_of((*end)->file));
    if (!text) return rosin::failure{text.error()};
    if (end == &rig.far && rig.near && rig.near->file == rig.far->file) continue;  // one file for both
    if (auto why = write_text(to.folder / (*end)->file, *text, given.existing())) return why;
  }
  return std::nullopt;
}

/// The rig file last: whoever finds it finds all that it names.
std::optional<rosin::failure> write_all(const simulate_options& given, const provenance& from, const rosin::rig& rig,
                                        const simulation_plan& plan, const std::vector<simulated_take>& takes, const places& to,
                                        const std::string& declared) {
  std::error_code error;
  fs::create_directories(to.folder, error);
  if (error) return rosin::failure{to.folder.string() + ": cannot be made: " + error.message()};
  const auto lock = lock_folder(to.folder.string());
  if (!lock) return rosin::failure{lock.error()};
  if (auto why = recording_in(to.folder.string())) return why;
  if (auto why = write_tables_of_ends(given, rig, to)) return why;
  if (auto why = write_takes(given, from, plan, takes, to)) return why;
  std::vector<std::string> tables;
  for (const auto& table : to.tables) tables.push_back(table.filename().string());
  if (auto why = write_text(to.truth, truth_document(plan, takes, tables, from).dump(2) + "\n", given.existing())) return why;
  return write_text(to.rig, declared, given.existing());
}

/// What a reader should know before he uses the takes.
std::vector<std::string> warnings(const simulation_plan& plan, const std::vector<simulated_take>& takes) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const auto& name = plan.takes[i].declared.name;
    for (std::size_t c = 0; c < plan.channels.size(); ++c)
      if (takes[i].clipped[c] > 0)
        out.push_back("take " + name + ", channel " + plan.channels[c].declared.name + ": " +
                      std::to_string(takes[i].clipped[c]) + " samples beyond full scale; raise the scale in [channels]");
    if (takes[i].truth.unconverged > 0)
      out.push_back("take " + name + ": the contact's equation was not solved to tolerance in " +
                    std::to_string(takes[i].truth.unconverged) + " steps");
    if (plan.takes[i].declared.kind != rosin::take_kind::bow) continue;
    const auto motion = motion_of(takes[i].truth);
    if (motion != rosin::bowed_motion::stick_slip)
      out.push_back("take " + name + ": the string is " + name_of(motion) +
                    " in the second half, no stick-slip motion; try another speed or normal force");
  }
  return out;
}

void print_text(const simulation_plan& plan, const std::vector<simulated_take>& takes, const places& to,
                const std::vector<std::string>& warned) {
  for (std::size_t i = 0; i < takes.size(); ++i) {
    const auto& take = plan.takes[i].declared;
    std::cout << take.name << " (" << name_of(take.kind) << ", " << to.recordings[i].string()
              << "): " << in_digits(plan.duration_s) << " s at " << in_digits(plan.settings.sample_rate_Hz, "%.0f") << " Hz";
    for (std::size_t c = 0; c < plan.channels.size(); ++c)
      std::cout << ", " << plan.channels[c].declared.name << " up to " << in_digits(100 * takes[i].peak_share[c], "%.0f") << " %";
    if (take.kind == rosin::take_kind::bow)
      std::cout << ", " << name_of(motion_of(takes[i].truth)) << ", " << takes[i].truth.slips << " slips";
    std::cout << '\n';
  }
  for (const auto& effect : plan.effects) std::cout << "with: " << effect << '\n';
  for (const auto& line : warned) std::cout << "warning: " << line << '\n';
  for (const auto& line : plan.notes) std::cout << "note: " << line << '\n';
  for (const auto& line : plan.assumed) std::cout << "assumed: " << line << '\n';
  std::cout << "rig: " << to.rig.string() << "\ntruth: " << to.truth.string() << '\n';
}

json result_json(const simulation_plan& plan, const std::vector<simulated_take>& takes, const places& to,
                 const std::vector<std::string>& warned, const provenance& from) {
  json out{
      {"schema", 1}, {"provenance", from.to_json()}, {"rig", to.rig.string()}, {"truth", to.truth.string()}, {"seed", plan.seed}};
  out["takes"] = json::array();
  for (std::size_t i = 0; i < takes.size(); ++i) {
    json one{{"name", plan.takes[i].declared.name},
             {"kind", name_of(plan.takes[i].declared.kind)},
             {"file", to.recordings[i].string()}};
    one["of_full_scale"] = json::object();
    for (std::size_t c = 0; c < plan.channels.size(); ++c)
      one["of_full_scale"][plan.channels[c].declared.name] = takes[i].peak_share[c];
    if (!to.tables[i].empty())
      one.update(
          {{"truth", to.tables[i].string()}, {"motion", name_of(motion_of(takes[i].truth))}, {"slips", takes[i].truth.slips}});
    out["takes"].push_back(std::move(one));
  }
  if (!plan.effects.empty()) out["effects"] = plan.effects;
  out["warnings"] = warned;
  out["notes"] = plan.notes;
  out["assumed"] = plan.assumed;
  return out;
}

rosin::outcome<std::string> declared_text(const std::string& file) {
  auto text = rosin::read_file(file);
  return text ? declaration(*text, file) : text;
}

/// From the rig file alone, or with the corrected model of a diagnosis.
rosin::outcome<simulation_plan> make_plan(const simulate_options& given, const rosin::rig& rig, provenance& from) {
  if (given.model.empty()) return plan_simulation(rig, given.seed);
  if (const auto why = from.add_input(given.model)) return *why;
  const auto model = read_diagnosed_model(given.model);
  if (!model) return rosin::failure{model.error()};
  const auto corrected = with_model(rig, *model);
  auto plan = plan_simulation(corrected, given.seed);
  if (!plan) return plan;
  if (const auto why = apply_model(*model, corrected, *plan)) return *why;
  return plan;
}

exit_code run(const simulate_options& given, provenance from) {
  const auto rig = rosin::load_rig(given.rig, rosin::take_files::to_be_made);
  if (!rig) return fail(rig.error(), given.json);
  if (const auto why = from.add_input(rig->file)) return fail(why->message, given.json);
  const auto declared = declared_text(rig->file);
  if (!declared) return fail(declared.error(), given.json);
  auto plan = make_plan(given, *rig, from);
  if (!plan) return fail(plan.error(), given.json);
  const auto to = find_places(given, *rig);
  if (const auto why = problem_with(to, given, *rig); !why.empty()) return fail(why, given.json);
  const auto takes = [&] {
    progress bar{"simulating", plan->takes.size()};
    return simulate_takes(*plan, bar);
  }();
  if (!takes) return fail(rig->file + ": " + takes.error(), given.json);
  if (const auto why = write_all(given, from, *rig, *plan, *takes, to, *declared)) return fail(why->message, given.json);
  const auto warned = warnings(*plan, *takes);
  if (given.json) print(result_json(*plan, *takes, to, warned, from));
  else print_text(*plan, *takes, to, warned);
  return exit_code::ok;
}

}  // namespace

void add_simulate(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<simulate_options>();
  CLI::App* command = app.add_subcommand("simulate", "Make the recordings that a rig file names, and the truth behind them");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds rig.toml")->required();
  command->add_option("--out", given->out, "Folder for the recordings and their rig.toml")->required()->type_name("FOLDER");
  command
      ->add_option("--truth", given->truth,
                   "Where the truth goes: a folder, or a file that ends in .json; FOLDER-truth if left out")
      ->type_name("FOLDER|FILE");
  command->add_option("--model", given->model, "With the corrected model of this diagnosis (rosin diagnose --json)")
      ->type_name("FILE");
  command->add_option("--seed", given->seed, "Everything drawn at random follows from it; overrides the rig file's")
      ->check(not_negative())
      ->type_name("NUMBER");
  command->add_option("--format", given->format, "Of the truth's tables: csv, npy (NumPy structured array) or mat (MATLAB)")
      ->check(CLI::IsMember({"csv", "npy", "mat"}))
      ->capture_default_str();
  add_force_option(*command, given->force);
  add_json_option(*command, given->json);
  command->footer(
      "Plucks, quiet and bowed takes of a stiff string between ends that are rigid or move as [terminations] says (modes, or a "
      "file of admittance), with\n"
      "torsion and the law of friction that [model] and [friction] name; sensors whose gains are off within their tolerances, "
      "noise, AC coupling and converters.\n"
      "[simulate] sets rate, duration, bits, noise, seed, and with nominal_scatter = true lets the string differ from what the\n"
      "file declares. The rig.toml beside the recordings tells none of that; the truth goes to another folder.\n"
      "Exit status: 0 done, 2 bad input or usage, or a file that could not be written.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
