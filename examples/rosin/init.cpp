// SPDX-License-Identifier: MIT
//
// rosin init: a rig file to be completed, from a folder of recordings.
//
#include "commands.hpp"
#include "digits.hpp"
#include "init_folder.hpp"
#include "progress.hpp"
#include "provenance.hpp"

#include <rosin/math/at_once.hpp>
#include <rosin/version.hpp>

#include <charconv>
#include <iostream>
#include <mutex>

namespace tool {

namespace {

/// "0.08..0.12"
std::optional<std::pair<double, double>> range_from(const std::string& text) {
  const auto dots = text.find("..");
  if (dots == std::string::npos) return std::nullopt;
  const auto value = [&](std::size_t begin, std::size_t end, double& to) {
    const auto got = std::from_chars(text.data() + begin, text.data() + end, to);
    return got.ec == std::errc{} && got.ptr == text.data() + end && std::isfinite(to);
  };
  std::pair<double, double> out;
  if (!value(0, dots, out.first) || !value(dots + 2, text.size(), out.second) || out.second < out.first) return std::nullopt;
  return out;
}

/// Takes of one rig have one map of channels: what most files look like.
std::string signature(const found_take& t) {
  std::string out = t.is_table ? t.machine_layout ? "machine " : "table " : "sound ";
  out += std::to_string(t.columns.size());
  for (const auto& c : t.columns) out += "," + c.name;
  return out;
}

void keep_alike(std::vector<found_take>& takes, std::vector<std::string>& notes) {
  std::map<std::string, std::size_t> count;
  for (const auto& t : takes) ++count[signature(t)];
  std::string most;
  for (const auto& [what, n] : count)
    if (most.empty() || n > count[most]) most = what;
  for (const auto& t : takes)
    if (signature(t) != most) notes.push_back(t.path + ": left out: its channels are not those of the others");
  std::erase_if(takes, [&](const found_take& t) { return signature(t) != most; });
}

void examine_all(std::vector<found_take>& takes, const init_request& given) {
  progress bar{"reading", takes.size()};
  std::mutex one_at_a_time;
  rosin::at_once(takes.size(), given.threads, [&](std::size_t i) {
    examine(takes[i], given);
    const std::lock_guard hold{one_at_a_time};
    bar.step();
  });
}

json to_json(const found_take& t) {
  const auto or_null = [](const std::optional<double>& x) { return x ? json(*x) : json(nullptr); };
  return {{"name", t.name},
          {"file", t.file},
          {"kind", t.kind.empty() ? json(nullptr) : json(t.kind)},
          {"contact_position", or_null(t.beta)},
          {"speed_m_s", or_null(t.motion.steady_speed_m_s)},
          {"normal_force_N", or_null(t.motion.steady_normal_force_N)},
          {"duration_s", t.rate_Hz > 0 ? json(static_cast<double>(t.frames) / t.rate_Hz) : json(nullptr)},
          {"remarks", t.remarks}};
}

void print_result(const init_request& given, const provenance& from, const std::string& file,
                  const std::vector<found_take>& takes, const std::vector<std::string>& problems,
                  const std::vector<std::string>& notes) {
  if (given.json) {
    json out{{"schema", 1}, {"provenance", from.to_json()}, {"rig", file}};
    out["takes"] = json::array();
    for (const auto& t : takes) out["takes"].push_back(to_json(t));
    out["left_out"] = problems;
    out["notes"] = notes;
    return print(out);
  }
  for (const auto& line : problems) std::cout << "left out: " << line << '\n';
  for (const auto& line : notes) std::cout << "note: " << line << '\n';
  for (const auto& t : takes)
    for (const auto& line : t.remarks) std::cout << "take " << t.name << ": " << line << '\n';
  std::cout << file << ": " << takes.size() << " take(s)";
  if (takes.front().machine_layout) std::cout << " in the public layout of bowed strokes, taken as 50000 samples a second";
  std::cout << "; complete what is \"to be filled in\", then: rosin check " << file << '\n';
}

exit_code run(const init_request& given, const provenance& from) {
  const std::string file = given.rig_folder() + "/rig.toml";
  const auto existing = given.force ? rosin::overwrite::allow : rosin::overwrite::refuse;
  std::error_code error;
  if (!std::filesystem::is_directory(given.folder, error)) return fail(given.folder + ": no such folder", given.json);
  if (!given.out.empty()) std::filesystem::create_directories(given.out, error);
  if (auto why = rosin::cannot_write(file, existing))
    return fail(why->message + (given.force                            ? ""
                                : std::filesystem::exists(file, error) ? "; --force overwrites it"
                                                                       : ""),
                given.json);
  std::vector<std::string> notes, problems;
  auto takes = find_recordings(given, notes);
  if (!takes) return fail(takes.error(), given.json);
  examine_all(*takes, given);
  for (const auto& t : *takes)
    if (!t.problem.empty()) problems.push_back(t.problem);
  std::erase_if(*takes, [](const found_take& t) { return !t.problem.empty(); });
  if (takes->empty()) {
    std::string all = given.folder + ": none of its recordings can be used";
    for (const auto& line : problems) all += "\n" + line;
    return fail(all, given.json);
  }
  keep_alike(*takes, notes);
  const std::string text = rig_text(*takes, given, "Begun by rosin " ROSIN_VERSION_STRING " init, from " + given.folder);
  if (const auto why = rosin::write_file(file, existing, [&](std::ostream& out) { out << text; }))
    return fail(why->message, given.json);
  print_result(given, from, file, *takes, problems, notes);
  return problems.empty() ? exit_code::ok : exit_code::finding;
}

}  // namespace

void add_init(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<init_request>();
  auto beta = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("init", "Begin a rig file from a folder of recordings");
  command->add_option("FOLDER", given->folder, "Folder that holds the recordings, itself or in folders of its own")->required();
  command->add_option("--out", given->out, "Folder that gets rig.toml; FOLDER if left out")->type_name("DIR");
  command->add_option("--take", given->takes, "Only takes of this name; * and ? stand for anything; may be repeated")
      ->type_name("PATTERN");
  command->add_option("--beta", *beta, "Only strokes whose beta_N.csv is in this range, as 0.08..0.12")
      ->type_name("FROM..TO")
      ->check([](const std::string& text) { return range_from(text) ? std::string{} : text + " is no range, as 0.08..0.12"; });
  command->add_option("--every", given->every, "Of what is left, every so many-th")
      ->type_name("N")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}));
  command->add_flag("--binary", given->binary,
                    "Keep each table in a binary form (.npy) beside it, or beside rig.toml with --out");
  command->add_option("--threads", given->threads, "Files read at once; 0: as many as there are cores")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  add_force_option(*command, given->force);
  add_json_option(*command, given->json);
  command->footer(
      "Looks at sound files and tables (CSV, TSV, NPY, MAT, HDF5) and writes a commented rig.toml. What recordings cannot tell\n"
      "(the string, sensors, wires) is left to be filled in, with its unit and an example. The layout of the public recordings\n"
      "of a bowing machine is recognised by its names: whole_N.csv, beta_N.csv, timestamp_N.csv. Nothing that was recorded is\n"
      "altered. A file that cannot be used is left out and named, with line, column and reason.\n"
      "Exit status: 0 written, 1 written, but something had to be left out, 2 nothing was written.");
  command->callback([given, beta, command, &result] {
    if (!beta->empty()) given->beta = range_from(*beta);
    result = run(*given, provenance{*command});
  });
}

}  // namespace tool
