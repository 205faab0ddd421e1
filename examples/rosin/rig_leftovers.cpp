// SPDX-License-Identifier: MIT
#include "rig_leftovers.hpp"
#include "recorder.hpp"
#include "simulate_declaration.hpp"

#include <rosin/adapt/rig_edit.hpp>
#include <rosin/hardware/durable_text.hpp>
#include <rosin/hardware/take_file.hpp>

#include <algorithm>
#include <filesystem>

namespace tool {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view note_end = ".recording.toml", block_begin = "\n[[take]]\n";

std::string rig_file(const std::string& folder) { return folder + "/rig.toml"; }

/// Names of the files in a folder that end so.
std::vector<std::string> files_in(const std::string& folder, std::string_view end) {
  std::vector<std::string> out;
  std::error_code error;
  for (fs::directory_iterator at{folder.empty() ? "." : folder, error}, none; !error && at != none; at.increment(error))
    if (auto name = at->path().filename().string(); name.ends_with(end)) out.push_back(std::move(name));
  std::sort(out.begin(), out.end());
  return out;
}

/// What a note says; empty where it was not written to its end.
struct note {
  std::string take, described, block;
  [[nodiscard]] std::string recording() const { return take + ".wav"; }
};
std::optional<note> read_note(const std::string& folder, const std::string& name) {
  const auto text = rosin::read_whole_text(folder + "/" + name);
  if (!text || !*text) return std::nullopt;
  const std::string& all = **text;
  const auto at = all.rfind(block_begin);
  const auto first = all.find('\n');
  if (at == std::string::npos || first > at || !all.ends_with('\n')) return std::nullopt;
  return note{name.substr(0, name.size() - note_end.size()), all.substr(first + 1, at - first - 1), all.substr(at)};
}

/// Whether there are samples in a take's file.
bool has_frames(const std::string& path) {
  const auto found = rosin::find_take_remains(path);
  return found && found->bytes > 0;
}

/// The head of a take's file and nothing behind it, or less than that.
bool is_empty_take(const std::string& path) {
  const auto text = rosin::read_whole_text(path);
  if (!text || !*text) return false;
  const auto& bytes = **text;
  return bytes.empty() || (bytes.size() < rosin::wav_head_bytes && bytes.starts_with("RIFF\xff\xff\xff\xff"));
}

/// The block with another name for the take.
std::string renamed(const std::string& block, const std::string& name) {
  const auto at = block.find("name = "), end = block.find('\n', at);
  return block.substr(0, at) + "name = \"" + name + '"' + block.substr(end);
}

bool is_named(const std::vector<rosin::named_take>& takes, const std::string& recording) {
  return std::any_of(takes.begin(), takes.end(), [&](const auto& t) { return t.file == recording; });
}

/// The rig file with this take in it; `patient`: only if it is a sound rig then.
rosin::outcome<std::string> joined(const std::string& text, const std::string& recording, std::string block,
                                   const std::vector<std::string>& remarks, const std::string& file, bool patient) {
  auto takes = rosin::find_named_takes(text, file);
  if (!takes) return rosin::failure{takes.error()};
  std::string out = text;
  if (!is_named(*takes, recording)) {
    const auto own = rosin::find_named_takes(block, file);
    const std::string name = own && !own->empty() ? own->front().name : recording;
    const auto taken = [&](const std::string& n) {
      return std::any_of(takes->begin(), takes->end(), [&](const auto& t) { return t.name == n; });
    };
    for (int i = 2; taken(name) && i < 10000; ++i)
      if (const std::string other = name + "-" + std::to_string(i); !taken(other)) {
        block = renamed(block, other);
        break;
      }
    auto with = rosin::with_take(text, block, file);
    if (!with) return with;
    out = *std::move(with);
    const auto rig = rosin::parse_rig(out, file);
    const bool described = text.find("[channels") != std::string::npos && text.find("[string") != std::string::npos;
    if (!rig && (patient || !described)) return rosin::failure{rig.error()};
  }
  if (remarks.empty()) return out;
  return rosin::with_remarks(out, recording, remarks, file);
}

}  // namespace

std::string note_path(const std::string& folder, const std::string& take) { return folder + "/" + take + std::string{note_end}; }
std::string note_text(const std::string& take, const std::string& described, const std::string& block) {
  return "# " + take + ".wav is being recorded. This note goes when the take is in rig.toml.\n" + described + block;
}

rosin::outcome<rosin::file_lock> lock_folder(const std::string& folder) {
  return rosin::file_lock::take(folder, std::chrono::seconds{10}, stop_flag());
}

std::optional<rosin::failure> join_rig_file(const std::string& folder, const std::string& recording, const std::string& described,
                                            const std::string& block, const std::vector<std::string>& remarks,
                                            std::chrono::milliseconds patience) {
  const std::string file = rig_file(folder);
  const rosin::deadline until{patience};
  for (;;) {
    const bool patient = !until.over();
    rosin::wait_until_settled(file);
    auto bad = rosin::change_durably(file, [&](const std::optional<std::string>& now) -> rosin::outcome<std::string> {
      if (!now && described.empty()) return rosin::failure{file + ": is not there any more"};
      return joined(now.value_or(described), recording, block, remarks, file, patient);
    });
    if (!bad || !patient) return bad;
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
}

std::vector<std::string> leftovers_in(const std::string& folder, const std::optional<std::vector<std::string>>& named) {
  const std::string repairs = "; the next `rosin record` into this folder puts it in order",
                    to = folder.empty() ? "" : folder + "/";
  const auto in_rig = [&](const std::string& file) {
    return !named || std::find(named->begin(), named->end(), file) != named->end();
  };
  std::vector<std::string> out, told;
  for (const auto& name : files_in(folder, note_end)) {
    const std::string take = name.substr(0, name.size() - note_end.size()), file = take + ".wav";
    if (!fs::is_regular_file(to + name)) continue;
    told.push_back(file);
    if (rosin::file_lock::held(to + name)) out.push_back(to + file + ": is being recorded");
    else if (!has_frames(to + file))
      out.push_back(to + name + ": was left by a recording that ended before its first sample" + repairs);
    else
      out.push_back(to + name + ": was left by a recording that was broken off; its samples are in " + file +
                    (in_rig(file) ? "" : ", which is not in rig.toml yet") + repairs);
  }
  for (const auto& file : files_in(folder, ".wav")) {
    if (std::find(told.begin(), told.end(), file) != told.end()) continue;
    const auto found = rosin::find_take_remains(to + file);
    if (rosin::file_lock::held(to + file)) out.push_back(to + file + ": is being written");
    else if (found && found->head_is_due)
      out.push_back(to + file + ": was broken off; its header does not tell of all samples that are in it" + repairs);
    else if (found && !in_rig(file)) out.push_back(to + file + ": is a recording that no take in rig.toml names");
  }
  for (const auto& name : files_in(folder, ".part"))
    out.push_back(to + name + ": is being written, or was left where that was broken off" +
                  (name == "rig.toml.part" ? repairs : "; if nothing is running, it can be deleted"));
  for (const auto& name : files_in(folder, ".toml.swap"))
    out.push_back(to + name + ": was left where the change of rig.toml was broken off" + repairs);
  std::error_code error;
  for (fs::directory_iterator at{folder.empty() ? "." : folder, error}, none; !error && at != none; at.increment(error))
    if (const auto name = at->path().filename().string(); name.starts_with("rig.toml.saved-"))
      out.push_back(to + name + ": has lines that rig.toml has not: a change of both was broken off; look at it, and delete it");
  return out;
}

std::vector<std::string> repair_folder(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& kept : rosin::clear_remnants(rig_file(folder)))
    out.push_back(kept + ": is what an editor had written while a recording was killed; rig.toml does not say all of it");
  for (const auto& name : files_in(folder, note_end)) {
    const std::string path = folder + "/" + name, take = name.substr(0, name.size() - note_end.size()),
                      file = folder + "/" + take + ".wav";
    if (!fs::is_regular_file(path) || rosin::file_lock::held(path) || rosin::file_lock::held(file)) continue;
    if (!has_frames(file)) {
      std::error_code ignored;
      if (rosin::find_take_remains(file) || is_empty_take(file)) fs::remove(file, ignored);
      if (!fs::exists(file, ignored)) {
        fs::remove(path, ignored);
        out.push_back(path + ": nothing had been recorded; it is gone now");
        continue;
      }
    }
    const auto said = read_note(folder, name);
    const auto mended = rosin::mend_take(file);
    if (!mended) {
      out.push_back(mended.error());
      continue;
    }
    if (*mended) out.push_back(file + ": was broken off; its header is in order now");
    if (!said) {
      out.push_back(path + ": cannot be understood; it stays");
      continue;
    }
    if (const auto bad =
            join_rig_file(folder, said->recording(), said->described, said->block, {}, std::chrono::milliseconds{200})) {
      out.push_back(file + ": was broken off, and cannot be put into rig.toml: " + bad->message);
      continue;
    }
    std::error_code ignored;
    fs::remove(path, ignored);
    out.push_back(file + ": is in rig.toml now, as take " + take);
  }
  for (const auto& name : files_in(folder, ".wav")) {
    const auto mended = rosin::mend_take(folder + "/" + name);
    if (mended && *mended) out.push_back(folder + "/" + name + ": was broken off; its header is in order now");
  }
  return out;
}

std::optional<rosin::failure> recording_in(const std::string& folder) {
  for (const auto end : {note_end, std::string_view{".wav"}})
    for (const auto& name : files_in(folder, end))
      if (rosin::file_lock::held(folder + "/" + name))
        return rosin::failure{folder + ": something is being recorded there (" + name + ")"};
  return std::nullopt;
}

std::optional<rosin::failure> being_written(const std::string& path) {
  if (!rosin::file_lock::held(path)) return std::nullopt;
  return rosin::failure{path + ": is being written by another program, as a take that is recorded is"};
}

}  // namespace tool
