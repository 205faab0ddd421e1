// SPDX-License-Identifier: MIT
#include "take_plan.hpp"
#include "rig_leftovers.hpp"
#include "simulate_declaration.hpp"

#include <rosin/adapt/rig_edit.hpp>
#include <rosin/hardware/durable_text.hpp>

#include <algorithm>
#include <locale>
#include <sstream>

namespace tool {

namespace {

namespace fs = std::filesystem;

/// Without [[take]] tables; what is indented or commented between them goes too. Takes that stand there in another way go all the
/// same, but then the text is written anew from what it means.
std::string without_takes(const std::string& text) {
  std::istringstream lines{text};
  std::string out;
  bool in_take = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[take]]")) in_take = true;
    else if (line.starts_with('[')) in_take = false;
    if (!in_take) out += line + '\n';
  }
  while (out.ends_with("\n\n")) out.pop_back();
  auto wanted = rosin::detail::parse_toml(text, "");
  if (!wanted) return out;
  wanted->erase("take");
  if (rosin::detail::means(out, *wanted)) return out;
  std::ostringstream anew;
  anew.imbue(std::locale::classic());
  anew << *wanted << '\n';
  return anew.str();
}

std::string figure(double x) {
  std::string out = rosin::number_text(x, "%.9g");
  if (out.find_first_of(".en") == std::string::npos) out += ".0";
  return out;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) {
      constexpr std::string_view digits = "0123456789abcdef";
      out += std::string{"\\u00"} + digits[code >> 4U] + digits[code & 15U];
    } else {
      out += (c == '"' || c == '\\' ? "\\" : "") + std::string{c};
    }
  }
  return out + '"';
}

std::string block(const take_plan& t) {
  std::string out = "\n[[take]]\nname = " + quoted(t.name) + "\nkind = " + quoted(t.kind) + "\nfile = " + quoted(t.file()) + '\n';
  const auto value = [&](const char* key, const std::optional<double>& x) {
    if (x) out += std::string{key} + " = " + figure(*x) + '\n';
  };
  value("force_N", t.force_N);
  value("force_tolerance", t.force_tolerance);
  value("contact_position", t.position);
  value("speed_m_s", t.speed_m_s);
  value("normal_force_N", t.normal_force_N);
  if (t.hold_out) out += "hold_out = true\n";
  return out;
}

}  // namespace

void add_take_options(CLI::App& command, take_plan& given) {
  command.add_option("--take", given.name, "Name of the take; KIND-1, KIND-2, ... if left out")->type_name("NAME");
  command.add_option("--kind", given.kind, "pluck, bow or quiet")
      ->check(CLI::IsMember({"pluck", "bow", "quiet"}))
      ->capture_default_str();
  command.add_option("--wire", given.force_N, "Of a pluck: nominal breaking force of the wire")
      ->type_name("N")
      ->check(positive());
  command.add_option("--wire-tolerance", given.force_tolerance, "Its relative tolerance")->check(between(0.0, 1.0));
  command.add_option("--position", given.position, "Of bow or pluck, where it is not the rig's [contact]")
      ->check(between(0.0, 1.0));
  command.add_option("--speed", given.speed_m_s, "Of a bow: the sled's speed once it is steady")
      ->type_name("M/S")
      ->check(positive());
  command.add_option("--normal-force", given.normal_force_N, "Of a bow: force of the rod on the string")
      ->type_name("N")
      ->check(positive());
  command.add_flag("--hold-out", given.hold_out, "Never fitted, only predicted");
}

class rig_file_writer::reservation {
public:
  reservation(rosin::detail::owned_fd fd, std::string folder, std::string recording, std::string note, std::string block,
              bool folder_is_new)
      : fd_{std::move(fd)}, folder_{std::move(folder)},
        recording_{std::move(recording)}, note_{std::move(note)}, block_{std::move(block)}, folder_is_new_{folder_is_new} {}
  reservation(const reservation&) = delete;
  reservation& operator=(const reservation&) = delete;
  ~reservation() {
    if (begun) return;
    std::error_code ignored;
    fs::remove(note_, ignored);
    if (folder_is_new_) fs::remove(folder_, ignored);  // only if nothing is in it
  }
  [[nodiscard]] const std::string& recording() const noexcept { return recording_; }
  [[nodiscard]] const std::string& note() const noexcept { return note_; }
  [[nodiscard]] const std::string& block() const noexcept { return block_; }

  bool begun = false;

private:
  rosin::detail::owned_fd fd_;  ///< of the note, locked
  std::string folder_, recording_, note_, block_;
  bool folder_is_new_;
};
void rig_file_writer::reservation_end::operator()(reservation* r) const noexcept { delete r; }

rosin::outcome<rig_file_writer> rig_file_writer::open(const std::string& folder, const std::string& like) {
  rig_file_writer out;
  out.folder_ = folder;
  std::error_code error;
  if (fs::is_directory(folder, error)) {
    const auto lock = lock_folder(folder);
    if (!lock) return rosin::failure{lock.error()};
    out.repaired_ = repair_folder(folder);
  }
  const bool there = fs::exists(out.path(), error);
  if (!there && like.empty())
    return rosin::failure{out.path() + ": is not there; --like names a rig file that describes string and channels"};
  if (!like.empty()) {
    const std::string from = fs::is_directory(like, error) ? like + "/rig.toml" : like;
    if (there) return rosin::failure{out.path() + ": exists already; --like is for a new rig"};
    auto text = rosin::read_file(from);
    if (!text) return rosin::failure{text.error()};
    auto declared = declaration(*text, from);
    if (!declared) return rosin::failure{declared.error()};
    out.described_ = without_takes(*declared);
  }
  if (const auto bad = out.read_again()) return *bad;
  return out;
}

/// What others have made of the file since.
std::optional<rosin::failure> rig_file_writer::read_again() {
  rosin::wait_until_settled(path());
  auto now = rosin::read_whole_text(path());
  if (!now) return rosin::failure{now.error()};
  if (!*now && described_.empty()) return rosin::failure{path() + ": is not there any more"};
  text_ = std::move(*now).value_or(described_);
  return std::nullopt;
}

std::string rig_file_writer::free_name(const std::string& kind) const {
  const auto takes = rosin::find_named_takes(text_, path());
  for (int i = 1;; ++i) {
    take_plan with;
    with.name = kind + "-" + std::to_string(i);
    const bool named = takes && std::any_of(takes->begin(), takes->end(), [&](const rosin::named_take& t) {
                         return t.name == with.name || t.file == with.file();
                       });
    if (!named && why_taken(with).empty()) return with.name;
  }
}

std::string rig_file_writer::why_taken(const take_plan& take) const {
  std::error_code ignored;
  const std::string note = note_path(folder_, take.name), recording = folder_ + "/" + take.file();
  if (rosin::file_lock::held(note)) return note + ": another program is recording a take of this name";
  if (fs::exists(recording, ignored)) return recording + ": exists already";
  if (fs::exists(note, ignored)) return note + ": was left by a recording that was broken off, and cannot be put in order";
  return {};
}

rosin::outcome<rosin::rig> rig_file_writer::plan(take_plan& take) {
  if (const auto bad = read_again()) return *bad;
  if (take.name.empty()) take.name = free_name(take.kind);
  const bool unfinished = take.kind == "bow"     ? !take.speed_m_s || !take.normal_force_N
                          : take.kind == "pluck" ? !take.force_N
                                                 : false;
  const std::string added = block(take);
  const auto text = rosin::with_take(text_, added, path());
  if (!text) return rosin::failure{text.error()};
  auto rig = rosin::parse_rig(*text, path());
  take_plan quiet;
  quiet.name = take.name, quiet.kind = "quiet";
  if (const auto without = rosin::with_take(text_, block(quiet), path()); !rig && unfinished && without)
    if (rosin::parse_rig(*without, path()))
      return rosin::failure{take.kind == "bow" ? "a bowed take needs --speed and --normal-force"
                                               : "a pluck needs --wire, its nominal force"};
  if (!rig) return rig;
  if (const auto why = why_taken(take); !why.empty()) return rosin::failure{why};
  return rig;
}

rosin::outcome<rosin::rig> rig_file_writer::reserve(take_plan& take) {
  reserved_.reset();
  std::error_code error;
  const bool is_new = !fs::exists(folder_, error);
  if (is_new) fs::create_directories(folder_, error);
  if (error) return rosin::failure{folder_ + ": " + error.message()};
  const auto lock = lock_folder(folder_);
  if (!lock) return rosin::failure{lock.error()};
  for (auto& line : repair_folder(folder_)) repaired_.push_back(std::move(line));
  auto rig = plan(take);
  if (!rig && is_new) fs::remove(folder_, error);
  if (!rig) return rig;
  const std::string note = note_path(folder_, take.name), added = block(take);
  const auto why = [&] { return rosin::failure{note + ": " + std::strerror(errno)}; };
  rosin::detail::owned_fd fd{::open(note.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
  if (fd.get() < 0) return why();
  const int file = fd.get();
  reserved_.reset(new reservation{std::move(fd), folder_, take.file(), note, added, is_new});
  (void)rosin::file_lock::lock(file, rosin::deadline{std::chrono::seconds{2}});
  const std::string text = note_text(take.name, described_, added);
  for (std::string_view left = text; !left.empty();) {
    const ssize_t done = ::write(file, left.data(), left.size());
    if (done > 0) left.remove_prefix(static_cast<std::size_t>(done));
    else if (errno != EINTR) return why();
  }
  if (::fsync(file) != 0 && errno != EINVAL) return why();
  if (const auto bad = rosin::sync_folder_of(note)) return *bad;
  return rig;
}

std::optional<rosin::failure> rig_file_writer::put() {
  reserved_->begun = true;
  const auto lock = lock_folder(folder_);
  if (!lock) return rosin::failure{lock.error()};
  return join_rig_file(folder_, reserved_->recording(), described_, reserved_->block(), {});
}

std::optional<rosin::failure> rig_file_writer::finish(const std::vector<std::string>& remarks, bool sound) {
  const auto ended = std::exchange(reserved_, nullptr);
  ended->begun = true;
  const auto said = [&](const std::string& why) {
    return rosin::failure{why + "; " + ended->recording() + " is kept, and the next `rosin record` into this folder puts it in"};
  };
  const auto lock = lock_folder(folder_);
  if (!lock) return said(lock.error());
  if (const auto bad = join_rig_file(folder_, ended->recording(), described_, ended->block(), remarks)) return said(bad->message);
  std::error_code error;
  if (sound) fs::remove(ended->note(), error);
  if (error) return rosin::failure{ended->note() + ": cannot be removed: " + error.message()};
  return std::nullopt;
}

}  // namespace tool
