// tier: hosted
// SPDX-License-Identifier: MIT
//
// A small file that several change: programs, and people with editors that know nothing of locks. It is read, changed and replaced
// in one step; after a crash or a power cut there is the old text or the new one, never a part. The new text is on the disk before
// it takes the name, and the name before this returns. Mode and owner stay, and a link stays a link.
//
// In one step: the new file and the old one exchange their names (renameat2), and what came out is held against what was read. If
// an editor has put another file there in between, that one goes back at once, and the change is made anew on it. So no text is ever
// overwritten that the change has not seen; where the file system cannot exchange, the file is compared right before it is replaced.
//
//     path.part   being written; never was the file          path.swap   complete, on its way in or out
//
// are what a kill may leave. Programs that change the same file hold a lock (file_lock.hpp), so nobody else uses these names; and
// the next one to hold it clears them away, but for lines that stand nowhere else.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a kill may leave beside a file that is being changed.
inline constexpr std::array<const char*, 2> text_remnants{".part", ".swap"};

/// Names in a folder (of a file that was just made) put on the disk.
[[nodiscard]] inline std::optional<failure> sync_folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path{path}.parent_path();
  const std::string folder = (parent / ".").string();
  const detail::owned_fd fd{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (fd.get() >= 0 && (::fsync(fd.get()) == 0 || errno == EINVAL)) return std::nullopt;
  return failure{folder + ": " + std::strerror(errno)};
}

/// What is asked of the system; the tests ask others.
struct posix_calls {
  static int sync(int fd) noexcept { return ::fsync(fd); }
  static int rename(const std::string& from, const std::string& to) noexcept { return std::rename(from.c_str(), to.c_str()); }
  /// Both have to be there.
  static int exchange(const std::string& a, const std::string& b) noexcept {
#ifdef RENAME_EXCHANGE
    return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE);
#else
    errno = ENOSYS;
    return -1;
#endif
  }
  /// Fails where `to` is there.
  static int rename_new(const std::string& from, const std::string& to) noexcept {
    if (::link(from.c_str(), to.c_str()) != 0) return errno == EEXIST || ::access(to.c_str(), F_OK) == 0 ? -1 : rename(from, to);
    ::unlink(from.c_str());
    return 0;
  }
};

/// A whole file; empty where there is none.
[[nodiscard]] inline outcome<std::optional<std::string>> read_whole_text(const std::string& path) {
  const detail::owned_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (fd.get() < 0 && errno == ENOENT) return std::optional<std::string>{};
  std::string out;
  std::array<char, 65536> block{};
  for (ssize_t got = 1; fd.get() >= 0 && got != 0;) {
    got = ::read(fd.get(), block.data(), block.size());
    if (got > 0) out.append(block.data(), static_cast<std::size_t>(got));
    else if (got < 0 && errno != EINTR) return failure{path + ": " + std::strerror(errno)};
  }
  if (fd.get() < 0) return failure{path + ": " + std::strerror(errno)};
  return std::optional<std::string>{std::move(out)};
}

/// Waits, for a second at most, until nobody has written the file for a twentieth of one: an editor that writes in place may be in
/// the middle of it.
inline void wait_until_settled(const std::string& path) {
  using namespace std::chrono;
  for (const deadline patience{seconds{1}}; !patience.over(); std::this_thread::sleep_for(milliseconds{10})) {
    struct stat is {};
    if (::stat(path.c_str(), &is) != 0) return;
    const auto age = system_clock::now().time_since_epoch() - seconds{is.st_mtim.tv_sec} - nanoseconds{is.st_mtim.tv_nsec};
    if (age < seconds{0} || age > milliseconds{50}) return;
  }
}

namespace detail {

/// The file itself, where the name is a link.
[[nodiscard]] inline std::string end_of_links(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const auto out = std::filesystem::weakly_canonical(path, error);
  return error ? path : out.string();
}

/// `part` complete and on the disk, with mode and owner of `like`, if that is there.
template <class Calls>
[[nodiscard]] std::optional<failure> write_part(const std::string& part, const std::string& like, std::string_view text) {
  const auto why = [&](const char* what) {
    failure out{like + ": cannot be " + what + ": " + std::strerror(errno)};
    ::unlink(part.c_str());
    return out;
  };
  const owned_fd file{::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666)};
  if (file.get() < 0) return why("replaced");
  struct stat is {};
  if (::stat(like.c_str(), &is) == 0) {
    if (::fchown(file.get(), is.st_uid, is.st_gid) != 0) errno = 0;  // only root may
    if (::fchmod(file.get(), is.st_mode & 07777U) != 0) return why("replaced");
  }
  while (!text.empty()) {
    const ssize_t done = ::write(file.get(), text.data(), text.size());
    if (done > 0) text.remove_prefix(static_cast<std::size_t>(done));
    else if (errno != EINTR) return why("written");
  }
  if (Calls::sync(file.get()) != 0 && errno != EINVAL) return why("put on the disk");
  return std::nullopt;
}

/// The first line, which is taken off the text.
[[nodiscard]] inline std::string_view take_line(std::string_view& text) noexcept {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  return line;
}
/// Whether each line of `part` stands in `whole`, in this order.
[[nodiscard]] inline bool says_all_of(std::string_view whole, std::string_view part) noexcept {
  while (!part.empty()) {
    const std::string_view wanted = take_line(part);
    for (bool found = false; !found;) {
      if (whole.empty()) return false;
      found = take_line(whole) == wanted;
    }
  }
  return true;
}

/// One file in the course of being changed.
template <class Calls>
class text_exchange {
public:
  explicit text_exchange(std::string path) : path_{std::move(path)} {}

  /// Puts change(text) in the place of the text, however often somebody else replaces it meanwhile.
  template <class Change>
  [[nodiscard]] std::optional<failure> apply(Change change) {
    (void)clear();
    for (int turn = 0; turn < 1000; ++turn) {
      auto now = read_whole_text(path_);
      if (!now) return failure{now.error()};
      text_ = *std::move(now);
      const outcome<std::string> next = change(std::as_const(text_));
      if (!next) return failure{next.error()};
      if (text_ == *next) return std::nullopt;
      if (auto bad = write_part<Calls>(part(), path_, *next)) return bad;
      const auto done = text_ ? exchange(*next) : make();
      if (!done) return failure{done.error()};
      ::unlink(part().c_str()), ::unlink(swap().c_str());
      if (*done) return sync_folder_of(path_);
    }
    return failure{path_ + ": is changed by others all the time"};
  }

  /// What a kill has left goes, or is kept under a name that is given back.
  [[nodiscard]] std::vector<std::string> clear() const {
    ::unlink(part().c_str());
    const auto text = read_whole_text(swap()), now = read_whole_text(path_);
    if (!text || !*text || !now) return {};
    if (*now && says_all_of(**now, **text)) return ::unlink(swap().c_str()), std::vector<std::string>{};
    int free = 1;
    const auto saved = [&] { return path_ + ".saved-" + std::to_string(free); };
    while (Calls::rename_new(swap(), saved()) != 0)
      if (errno != EEXIST || ++free > 1000) return {};
    return {saved()};
  }

private:
  [[nodiscard]] std::string part() const { return path_ + text_remnants[0]; }
  [[nodiscard]] std::string swap() const { return path_ + text_remnants[1]; }
  [[nodiscard]] failure why() const { return failure{path_ + ": cannot be replaced: " + std::strerror(errno)}; }
  [[nodiscard]] failure given_up() const {
    failure out = why();
    ::unlink(part().c_str()), ::unlink(swap().c_str());
    return out;
  }
  [[nodiscard]] bool is(const std::string& path, const std::string& wanted) const {
    const auto text = read_whole_text(path);
    return text && *text && **text == wanted;
  }

  /// A file that was not there. False: it is there now, somebody else's.
  [[nodiscard]] outcome<bool> make() const {
    if (Calls::rename_new(part(), path_) == 0) return true;
    if (errno == EEXIST) return false;
    return given_up();
  }
  /// False: what came out is not what was read, and is in its place again; or nothing was there.
  [[nodiscard]] outcome<bool> exchange(const std::string& next) const {
    if (Calls::rename(part(), swap()) != 0) return given_up();
    if (Calls::exchange(swap(), path_) == 0) {
      if (is(swap(), *text_)) {
        if (auto bad = sync_folder_of(path_)) {
          ::unlink(swap().c_str());
          return *bad;
        }
        if (is(swap(), *text_)) return true;  // nor has somebody who had opened it before written into it since
      }
      if (Calls::exchange(swap(), path_) != 0) return why();
      if (!is(swap(), next)) (void)Calls::exchange(swap(), path_);  // somebody was there in between: his is the newer one
      return false;
    }
    if (errno == ENOENT) return false;
    if (errno != ENOSYS && errno != EINVAL && errno != EOPNOTSUPP) return given_up();
    if (!is(path_, *text_)) return false;
    if (Calls::rename(swap(), path_) == 0) return true;
    return given_up();
  }

  std::string path_;
  std::optional<std::string> text_;  ///< what the change is made on
};

}  // namespace detail

/// Replaces the file by change(text), an outcome<std::string>; its argument is empty where there is no such file. `change` may be
/// called several times, and nothing happens where it gives back what it got.
template <class Calls = posix_calls, class Change>
[[nodiscard]] std::optional<failure> change_durably(const std::string& path, Change change) {
  return detail::text_exchange<Calls>{detail::end_of_links(path)}.apply(std::move(change));
}

/// Clears away what a killed program has left beside the file; the names of what is kept, since the file does not say it.
[[nodiscard]] inline std::vector<std::string> clear_remnants(const std::string& path) {
  return detail::text_exchange<posix_calls>{detail::end_of_links(path)}.clear();
}

/// Whatever was there before.
template <class Calls = posix_calls>
[[nodiscard]] std::optional<failure> replace_durably(const std::string& path, std::string_view text) {
  return change_durably<Calls>(path, [&](const std::optional<std::string>&) { return outcome<std::string>{std::string{text}}; });
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
