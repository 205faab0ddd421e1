// SPDX-License-Identifier: MIT
//
// rosin record: takes from a digitiser into a rig folder.
//
#include "commands.hpp"
#include "digits.hpp"
#include "recorder.hpp"
#include "sled.hpp"

#include <algorithm>
#include <iostream>
#include <memory>

namespace tool {

namespace {

struct options {
  std::string rig, like;
  input_options input;
  recorder_options how;
  sled_options stroke;
  take_plan take;
  int count = 1;
  bool json = false;
};

/// Says what was put in order since the last call.
void tell_repairs(const rig_file_writer& files, std::size_t& told) {
  for (; told < files.repaired().size(); ++told) std::cerr << "rosin: " << files.repaired()[told] << std::endl;
}

bool channels_fit(const rosin::rig& rig, const rosin::frame_format& format, std::string& why) {
  for (const auto& c : rig.channels)
    if (!c.column.empty()) {
      why = rig.file + ": channels." + c.name + ".column: a source has no named columns: index is needed";
      return false;
    } else if (c.index >= format.channels) {
      why = rig.file + ": channels." + c.name + ".index is " + std::to_string(c.index) + ", the source has " +
            std::to_string(format.channels) + " channel(s)";
      return false;
    }
  return true;
}

/// One take after the other; the first entry of `out` that is over is the last.
std::optional<rosin::failure> record_all(const options& given, rig_file_writer& files, recorder& from,
                                         std::vector<take_report>& out) {
  std::size_t told = files.repaired().size();
  for (int i = 0; i < given.count && !stopped() && (out.empty() || !out.back().over); ++i) {
    take_plan take = given.take;
    const auto reserved = files.reserve(take);
    tell_repairs(files, told);
    if (!reserved) return rosin::failure{reserved.error()};
    std::optional<sled> moves;
    recorder_hooks hooks;
    if (!given.stroke.device.empty()) {
      auto opened = sled::open(given.stroke, take.speed_m_s.value_or(0));
      if (!opened) return rosin::failure{opened.error()};
      moves.emplace(*std::move(opened));
      hooks.begun = [&] { moves->begin(); };
      hooks.over = [&](double) { return moves->over(); };
      hooks.shows = [&] { return moves->shows(); };
    }
    if (moves) from.skip();  // what came while the sled was made ready
    out.push_back(from.record(take, &files, hooks));
    if (const std::string bad = moves ? moves->stop() : ""; !bad.empty()) {
      std::cerr << "rosin: " << bad << '\n';
      out.back().problems.push_back(bad);
    }
    if (!given.json) std::cout << summary_of(out.back()) << std::endl;
  }
  return std::nullopt;
}

exit_code tell(const options& given, const rig_file_writer& files, const recorder& from, const std::vector<take_report>& reports,
               const std::optional<rosin::failure>& why) {
  if (why) std::cerr << "rosin: " << why->message << '\n';
  json takes = json::array();
  for (const auto& r : reports) takes.push_back(to_json(r));
  if (given.json)
    print({{"schema", 1},
           {"rig", files.path()},
           {"takes", takes},
           {"mended", files.repaired()},
           {"fullest_buffer", from.fullest_buffer()}});
  const bool sound =
      std::all_of(reports.begin(), reports.end(), [](const auto& r) { return r.problems.empty() && r.frames > 0; });
  return sound && !why && !reports.empty() ? exit_code::ok : exit_code::finding;
}

/// A folder that was made for a take which then is refused goes again, with those above it that were made for it: all that is empty.
class new_folder {
public:
  explicit new_folder(const std::string& path) {
    std::error_code ignored;
    for (std::filesystem::path p = path; !p.empty() && !std::filesystem::exists(p, ignored); p = p.parent_path())
      made_.push_back(p);
  }
  new_folder(const new_folder&) = delete;
  new_folder& operator=(const new_folder&) = delete;
  ~new_folder() {
    std::error_code error;
    for (const auto& p : made_)
      if (std::filesystem::remove(p, error); error) break;
  }

private:
  std::vector<std::filesystem::path> made_;  ///< the innermost first
};

exit_code run(const options& given) {
  stop_on_signals();
  const new_folder gone_if_unused{given.rig};
  auto files = rig_file_writer::open(given.rig, given.like);
  if (!files) return fail(files.error(), given.json);
  if (given.count > 1 && !given.take.name.empty()) return fail("--count: --take names one take only", given.json);
  std::size_t told = 0;
  tell_repairs(*files, told);
  take_plan first = given.take;
  const auto rig = files->plan(first);
  if (!rig) return fail(rig.error(), given.json);
  auto input = open_input(given.input);
  if (!input) return fail(input.error(), given.json);
  recorder from{*std::move(input), given.how};
  if (std::string why; !channels_fit(*rig, from.format(), why)) return fail(why, given.json);
  const double period_s = 1 / rig->string.fundamental_Hz;
  if (first.kind == "pluck" && given.how.trigger.threshold > 0 && given.how.trigger.before_s < 2 * period_s)
    std::cerr << "rosin: --before " << in_digits(given.how.trigger.before_s) << " s is less than two periods of the string ("
              << in_digits(2 * period_s) << " s): a pluck without its release cannot be calibrated from\n";
  std::vector<take_report> reports;
  const auto why = record_all(given, *files, from, reports);
  if (why && reports.empty()) return fail(why->message, given.json);
  return tell(given, *files, from, reports, why);
}

}  // namespace

void add_record(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<options>();
  given->how.trigger.before_s = 0.1;
  CLI::App* command = app.add_subcommand("record", "Takes from a digitiser into a rig folder");
  command->add_option("RIG", given->rig, "Folder of the rig; takes join its rig.toml")->required();
  command
      ->add_option("--like", given->like,
                   "For a new folder: the rig file whose string, channels and so on are taken over, without its takes")
      ->type_name("RIG");
  add_input_options(*command, given->input);
  add_take_options(*command, given->take);
  add_recorder_options(*command, given->how);
  add_sled_options(*command, given->stroke);
  command->add_option("--count", given->count, "So many takes, one after the other")
      ->check(between(1, 1000, "INT"))
      ->capture_default_str();
  add_json_option(*command, given->json);
  command->footer(
      "Samples are in the file at once and on the disk within a second; whatever happens, the take can be read.\n"
      "Others may record into the folder and change rig.toml meanwhile; what a killed recording has left is put in order.\n"
      "Ctrl-C ends the take. Exit status: 0 recorded; 1 recorded, but frames are missing or it broke off; 2 nothing was done.");
  command->callback([given, &result] { result = run(*given); });
}

}  // namespace tool
