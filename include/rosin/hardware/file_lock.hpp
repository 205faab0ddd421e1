// tier: hosted
// SPDX-License-Identifier: MIT
//
// Whoever writes a file, or changes what is in a folder, holds its lock meanwhile; whoever comes second waits, or leaves it alone.
// The lock is flock(2)'s: it ends with the program, however that ends, so that a kill leaves none behind, and needs no file of its
// own. It belongs to the open file, so two threads exclude each other as two programs do. (Locks of POSIX, of which
// boost::interprocess::file_lock is made, are lost when any descriptor of the file is closed, and threads do not see them.)
//
// A file system that knows no locks is no reason not to record: there a file is as if nobody held it. Over a network the lock of a
// folder holds within one machine, that of a file between machines where the server keeps locks.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>

#include <sys/stat.h>

#include <thread>

namespace rosin {

class file_lock {
public:
  /// Of a file or a folder that is there; waits for `patience` at most. A stop shortens the wait, to a tenth of a second.
  [[nodiscard]] static outcome<file_lock> take(const std::string& path, std::chrono::milliseconds patience,
                                               const std::atomic<bool>* stop = nullptr) {
    detail::owned_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (fd.get() < 0) return failure{path + ": " + std::strerror(errno)};
    if (!lock(fd.get(), deadline{patience, stop}) && !lock(fd.get(), deadline{std::chrono::milliseconds{100}}))
      return failure{path + ": another program is changing it, for longer than can be waited for"};
    return file_lock{std::move(fd)};
  }

  /// Locks an open file. False: somebody else had it until the deadline.
  [[nodiscard]] static bool lock(int fd, const deadline& until) {
    for (;;) {
      if (::flock(fd, LOCK_EX | LOCK_NB) == 0 || (errno != EWOULDBLOCK && errno != EINTR)) return true;
      if (until.over()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
  }

  /// Whether somebody holds the lock of a file or a folder. Of devices and pipes nobody does.
  [[nodiscard]] static bool held(const std::string& path) {
    struct stat is {};
    if (::stat(path.c_str(), &is) != 0 || !(S_ISREG(is.st_mode) || S_ISDIR(is.st_mode))) return false;
    const detail::owned_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    return fd.get() >= 0 && ::flock(fd.get(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  }

private:
  explicit file_lock(detail::owned_fd fd) noexcept : fd_{std::move(fd)} {}

  detail::owned_fd fd_;
};

}  // namespace rosin
