// SPDX-License-Identifier: MIT
//
// rosin check: what is wrong with the recordings of a rig, before anything is calculated from them.
//
#include "commands.hpp"
#include "digits.hpp"
#include "progress.hpp"
#include "rig_input.hpp"
#include "rig_leftovers.hpp"

#include <filesystem>
#include <iostream>
#include <memory>

namespace tool {

namespace {

struct check_options {
  std::string rig;
  bool json = false, strict = false;
};

json to_json(const rosin::channel_check& c) {
  json out{{"channel", c.channel},
           {"unit", c.unit},
           {"lowest", c.lowest},
           {"highest", c.highest},
           {"mean", c.mean},
           {"rms", c.rms},
           {"of_full_scale", c.of_full_scale}};
  out["noise_rms"] = c.noise_rms ? json(*c.noise_rms) : json(nullptr);
  out["hum"] = nullptr;
  if (!c.hum) return out;
  out["hum"] = {{"frequency_Hz", c.hum->frequency_Hz}, {"amplitude", c.hum->amplitude}, {"lines", json::array()}};
  for (const auto& line : c.hum->lines)
    out["hum"]["lines"].push_back({{"frequency_Hz", line.frequency_Hz}, {"amplitude", line.amplitude}});
  return out;
}

json to_json(const rosin::stroke_motion& m, double rate_Hz) {
  const auto or_null = [](const std::optional<double>& x) { return x ? json(*x) : json(nullptr); };
  json out{{"steady_s", {static_cast<double>(m.steady_begin) / rate_Hz, static_cast<double>(m.steady_end) / rate_Hz}},
           {"speed_m_s", or_null(m.steady_speed_m_s)},
           {"normal_force_N", or_null(m.steady_normal_force_N)},
           {"normal_offset_N", nullptr}};
  if (m.normal_offset_N) out["normal_offset_N"] = with_sd(m.normal_offset_N->value, m.normal_offset_N->sd);
  return out;
}

json to_json(const rosin::take_check& take, const rosin::rig& rig) {
  const auto or_null = [](const std::optional<double>& x) { return x ? json(*x) : json(nullptr); };
  const auto* declared = rig.find_take(take.take);
  json out{{"name", take.take},
           {"kind", name_of(declared->kind)},
           {"file", declared->file},
           {"sample_rate_Hz", take.sample_rate_Hz},
           {"duration_s", take.duration_s},
           {"release_s", or_null(take.release_s)},
           {"pitch_Hz", or_null(take.pitch_Hz)},
           {"quality", or_null(take.quality)}};
  if (take.motion) out["motion"] = to_json(*take.motion, take.sample_rate_Hz);
  out["channels"] = json::array();
  for (const auto& c : take.channels) out["channels"].push_back(to_json(c));
  out["findings"] = json::array();
  for (const auto& f : take.findings) out["findings"].push_back(tool::to_json(f));
  return out;
}

void print_text(const rosin::take_check& take, const rosin::rig& rig) {
  const auto* declared = rig.find_take(take.take);
  std::cout << take.take << " (" << name_of(declared->kind) << ", " << declared->file << "): " << in_digits(take.duration_s)
            << " s at " << in_digits(take.sample_rate_Hz, "%.0f") << " Hz";
  if (take.release_s) std::cout << ", released at " << in_digits(*take.release_s, "%.5f") << " s";
  if (take.pitch_Hz) std::cout << ", rings at " << in_digits(*take.pitch_Hz, "%.2f") << " Hz";
  std::cout << '\n';
  const bool table = !rosin::table_ending(declared->file).empty();
  if (const auto& m = take.motion; m && m->steady_end > m->steady_begin) {
    std::cout << "  steady from " << in_digits(static_cast<double>(m->steady_begin) / take.sample_rate_Hz, "%.3f") << " to "
              << in_digits(static_cast<double>(m->steady_end) / take.sample_rate_Hz, "%.3f") << " s:";
    if (m->steady_speed_m_s) std::cout << " bow speed " << in_digits(*m->steady_speed_m_s, "%.4g") << " m/s";
    if (m->steady_normal_force_N)
      std::cout << (m->steady_speed_m_s ? "," : "") << " normal force " << in_digits(*m->steady_normal_force_N, "%.4g") << " N";
    std::cout << '\n';
  }
  for (const auto& c : take.channels) {
    std::cout << "  " << c.channel << ": " << in_digits(c.lowest) << " ... " << in_digits(c.highest) << " " << c.unit
              << (table ? std::string{} : ", " + in_digits(100 * c.of_full_scale, "%.0f") + " % of full scale");
    if (c.noise_rms) std::cout << ", noise " << in_digits(*c.noise_rms) << " " << c.unit << " rms";
    std::cout << '\n';
  }
  for (const auto& f : take.findings) std::cout << "  " << sentence(rig, f) << '\n';
}

struct tally {
  std::size_t errors = 0, warnings = 0;
};

tally count(const rosin::rig_folder& folder, const std::vector<rosin::take_check>& takes) {
  tally out;
  const auto add = [&](const std::vector<rosin::finding>& findings) {
    for (const auto& f : findings) {
      out.errors += f.level == rosin::severity::error ? 1 : 0;
      out.warnings += f.level == rosin::severity::warning ? 1 : 0;
    }
  };
  add(folder.doubts);
  for (const auto& take : takes) add(take.findings);
  return out;
}

void print_result(const check_options& given, const provenance& from, const rosin::rig_folder& folder,
                  const std::vector<rosin::take_check>& takes, const tally& found) {
  const auto assumed = rosin::values_of(folder.rig).assumed;
  if (given.json) {
    json out{{"schema", 1},
             {"provenance", from.to_json()},
             {"rig", folder.rig.title.value_or(folder.rig.file)},
             {"errors", found.errors},
             {"warnings", found.warnings}};
    out["findings"] = json::array();
    for (const auto& f : folder.doubts) out["findings"].push_back(tool::to_json(f));
    out["takes"] = json::array();
    for (const auto& take : takes) out["takes"].push_back(to_json(take, folder.rig));
    out["notes"] = folder.notes;
    out["assumed"] = assumed;
    return print(out);
  }
  for (const auto& take : takes) print_text(take, folder.rig);
  for (const auto& line : doubts_of(folder)) std::cout << line << '\n';
  for (const auto& note : folder.notes) std::cout << "note: " << note << '\n';
  for (const auto& line : assumed) std::cout << "assumed: " << line << '\n';
  std::cout << found.errors << " error(s), " << found.warnings << " warning(s)\n";
}

std::vector<std::string> find_leftovers(const std::string& path, const rosin::outcome<rosin::rig_folder>& rig) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string folder = fs::is_directory(path, ignored) ? path : fs::path{path}.parent_path().string();
  std::optional<std::vector<std::string>> named;
  if (rig) named.emplace();
  for (std::size_t i = 0; rig && i < rig->rig.takes.size(); ++i)
    named->push_back(fs::path{rig->rig.takes[i].file}.lexically_normal().string());
  return leftovers_in(folder, named);
}

exit_code run(const check_options& given, provenance from) {
  auto folder = open_rig(given.rig, from);
  const auto left = find_leftovers(given.rig, folder);
  if (!folder) {
    std::string all = folder.error();
    for (const auto& line : left) all += '\n' + line;
    return fail(all, given.json);
  }
  folder->notes.insert(folder->notes.end(), left.begin(), left.end());
  std::vector<rosin::take_check> takes;
  std::string unreadable;
  {
    progress bar{"checking", folder->rig.takes.size()};
    for (const auto& take : folder->rig.takes) {
      auto one = read_take(folder->rig, take, from);
      if (one) takes.push_back(std::move(one->check));
      else unreadable += (unreadable.empty() ? "" : "\n") + one.error();
      bar.step();
    }
  }
  if (!unreadable.empty()) return fail(unreadable, given.json);
  const tally found = count(*folder, takes);
  print_result(given, from, *folder, takes, found);
  return found.errors > 0 || (given.strict && found.warnings > 0) ? exit_code::finding : exit_code::ok;
}

}  // namespace

void add_check(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<check_options>();
  CLI::App* command = app.add_subcommand("check", "Find what is wrong with the recordings of a rig");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds rig.toml")->required();
  command->add_flag("--strict", given->strict, "Exit with 1 on warnings as well");
  add_json_option(*command, given->json);
  command->footer(
      "Reads every take and looks for clipping, lost samples, silence, offset, noise, mains hum, swapped or inverted\n"
      "channels, a wrong sample rate or pitch, plucks that do not ring, and values off by a power of ten. Each finding\n"
      "names file, channel and time, and says what to do. Defaults that a calculation would use are listed too, and what\n"
      "is being recorded or was left by a recording that was killed.\n"
      "Exit status: 0 nothing wrong, 1 errors were found (with --strict warnings, too), 2 nothing could be read.");
  command->callback([given, command, &result] { result = run(*given, provenance{*command}); });
}

}  // namespace tool
