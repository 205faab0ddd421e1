// SPDX-License-Identifier: MIT
//
// rosin live: records, and shows what happens under the bow while it happens.
//
#include "commands.hpp"
#include "live_chain.hpp"
#include "recorder.hpp"
#include "sled.hpp"

#include <rosin/adapt/rig_toml.hpp>

#include <iostream>
#include <memory>

namespace tool {

namespace {

struct live_request {
  std::string rig, calibration, json_file;
  input_options input;
  recorder_options how;
  sled_options stroke;
  take_plan take;
  live_options live;
  bool no_take = false;
};

/// The take as it will be, and the rig with it; without a take, the rig as it is.
rosin::outcome<rosin::rig> rig_of(const live_request& given, take_plan& take, std::optional<rig_file_writer>& files) {
  if (given.no_take) return rosin::load_rig(given.rig, rosin::take_files::to_be_made);
  auto opened = rig_file_writer::open(given.rig, "");
  if (!opened) return rosin::failure{opened.error()};
  files.emplace(*std::move(opened));
  auto rig = files->reserve(take);
  for (const auto& line : files->repaired()) std::cerr << "rosin: " << line << '\n';
  return rig;
}

json memory_json(std::uint64_t before, std::uint64_t after) {
  return {{"resident_bytes_early", before}, {"resident_bytes_late", after}};
}

struct live_state {
  std::optional<rosin::failure> bad;  ///< an output that broke
  std::uint64_t early_bytes = 0;
};

/// What both the recorder and the sled have to be told. A take goes on where only an output breaks.
recorder_hooks hooks_of(live_chain& chain, std::optional<sled>& moves, bool recorded, live_state& state) {
  recorder_hooks hooks;
  hooks.frames = [&, recorded](std::span<const double> frames) -> std::optional<rosin::failure> {
    auto bad = chain.push(frames);
    if (!bad || !recorded) return bad;
    std::cerr << "rosin: " << bad->message << "; the take goes on" << std::endl;
    state.bad = bad;
    return std::nullopt;
  };
  if (moves) hooks.begun = [&] { moves->begin(); };
  hooks.over = [&](double time_s) -> std::optional<std::string> {
    if (state.early_bytes == 0 && time_s > 1) state.early_bytes = resident_bytes();
    return moves ? moves->over() : std::nullopt;
  };
  hooks.shows = [&] { return chain.shows() + (moves ? "  " + moves->shows() : ""); };
  return hooks;
}

rosin::outcome<live_chain> chain_for(const live_request& given, const rosin::rig& rig, const take_plan& take,
                                     const rosin::frame_format& format) {
  for (const auto& c : rig.channels) {
    if (!c.column.empty())
      return rosin::failure{rig.file + ": channels." + c.name + ".column: a source has no named columns: index is needed"};
    if (c.index >= format.channels)
      return rosin::failure{rig.file + ": channels." + c.name + ".index: the source has no such channel"};
  }
  const auto calibration = read_calibration(given.calibration);
  if (!calibration) return rosin::failure{calibration.error()};
  return live_chain::design(rig, take, *calibration, format, given.live);
}

rosin::outcome<std::optional<sled>> sled_for(const live_request& given, const take_plan& take) {
  if (given.stroke.device.empty()) return std::optional<sled>{};
  auto opened = sled::open(given.stroke, take.speed_m_s.value_or(0));
  if (!opened) return rosin::failure{opened.error()};
  return std::optional<sled>{*std::move(opened)};
}

exit_code tell(const live_request& given, const recorder& from, const take_report& report, live_chain& chain,
               const live_state& state) {
  const std::uint64_t late_bytes = resident_bytes();
  auto bad = chain.finish();
  if (bad) std::cerr << "rosin: " << bad->message << '\n';
  const json out{{"schema", 1},
                 {"recording", to_json(report)},
                 {"reconstruction", chain.to_json()},
                 {"fullest_buffer", from.fullest_buffer()},
                 {"memory", memory_json(state.early_bytes, late_bytes)}};
  if (!given.json_file.empty())
    if (const auto why = save_json(given.json_file, out, given.live.force)) {
      std::cerr << "rosin: " << why->message << '\n';
      bad = why;
    }
  const bool lines_on_out = std::find(given.live.out.begin(), given.live.out.end(), "-") != given.live.out.end();
  if (given.json_file != "-")
    (lines_on_out ? std::cerr : std::cout) << summary_of(report) << "\n  " << chain.summary() << std::endl;
  return !bad && !state.bad && report.problems.empty() && report.frames > 0 ? exit_code::ok : exit_code::finding;
}

exit_code run(const live_request& given) {
  stop_on_signals();
  const bool as_json = given.json_file == "-";
  take_plan take = given.take;
  std::optional<rig_file_writer> files;
  const auto rig = rig_of(given, take, files);
  if (!rig) return fail(rig.error(), as_json);
  if (!given.json_file.empty())
    if (const auto why = may_write_file(given.json_file, given.live.force, true)) return fail(why->message, as_json);
  auto input = open_input(given.input);
  if (!input) return fail(input.error(), as_json);
  recorder from{*std::move(input), given.how};  // from here on it is listened to, whatever else takes its time
  auto chain = chain_for(given, *rig, take, from.format());
  if (!chain) return fail(chain.error(), as_json);
  auto moves = sled_for(given, take);
  if (!moves) return fail(moves.error(), as_json);
  for (const auto& line : chain->remarks()) std::cerr << "rosin: " << line << '\n';
  live_state state;
  if (*moves) from.skip();  // what came while the sled was made ready
  take_report report = from.record(take, files ? &*files : nullptr, hooks_of(*chain, *moves, files.has_value(), state));
  if (const std::string problem = *moves ? (*moves)->stop() : ""; !problem.empty()) {
    std::cerr << "rosin: " << problem << '\n';
    report.problems.push_back(problem);
  }
  return tell(given, from, report, *chain, state);
}

}  // namespace

void add_live(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<live_request>();
  CLI::App* command = app.add_subcommand("live", "Force and velocity under the bow while it moves, and the take besides");
  command->add_option("RIG", given->rig, "Folder of the rig; the take joins its rig.toml")->required();
  command->add_option("--calibration", given->calibration, "What `rosin fit --json` made of the plucks")
      ->required()
      ->type_name("FILE");
  command->add_flag("--no-take", given->no_take, "Nothing is recorded");
  add_input_options(*command, given->input);
  add_live_options(*command, given->live);
  add_take_options(*command, given->take);
  add_recorder_options(*command, given->how);
  add_sled_options(*command, given->stroke);
  command->add_option("--json", given->json_file, "What was found, for a program; - for standard output")->type_name("FILE");
  command->footer(
      "Without a terminal nothing is shown. Exit status: 0 done; 1 done, but frames are missing or it broke off; 2 nothing was "
      "done.");
  command->callback([given, &result] { result = run(*given); });
}

}  // namespace tool
