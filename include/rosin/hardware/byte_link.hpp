// tier: hosted
// SPDX-License-Identifier: MIT
//
// A serial line, or whatever a file descriptor of a POSIX system can be (a pseudo-terminal, a pipe): opened raw, so that no byte
// is changed on its way, and by this program alone; read with patience, written completely or not at all. No wait is longer than
// it was asked to be, whatever the other end does.
//
#pragma once

#include <rosin/core/outcome.hpp>
#include <rosin/hardware/deadline.hpp>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Closes what it owns.
class owned_fd {
public:
  explicit owned_fd(int fd = -1) noexcept : fd_{fd} {}
  owned_fd(owned_fd&& other) noexcept : fd_{std::exchange(other.fd_, -1)} {}
  owned_fd& operator=(owned_fd&& other) noexcept {
    if (this != &other) reset(std::exchange(other.fd_, -1));
    return *this;
  }
  ~owned_fd() { reset(-1); }
  [[nodiscard]] int get() const noexcept { return fd_; }

private:
  void reset(int fd) noexcept {
    if (fd_ >= 0) ::close(fd_);
    fd_ = fd;
  }
  int fd_;
};

/// Speeds that termios knows by name; nothing for others (USB devices do not care).
[[nodiscard]] inline std::optional<speed_t> line_speed(int baud) noexcept {
  constexpr std::array<std::pair<int, speed_t>, 12> known{{{9600, B9600},
                                                           {19200, B19200},
                                                           {38400, B38400},
                                                           {57600, B57600},
                                                           {115200, B115200},
                                                           {230400, B230400},
                                                           {460800, B460800},
                                                           {921600, B921600},
                                                           {1000000, B1000000},
                                                           {2000000, B2000000},
                                                           {3000000, B3000000},
                                                           {4000000, B4000000}}};
  for (const auto& [rate, code] : known)
    if (rate == baud) return code;
  return std::nullopt;
}

}  // namespace detail

/// What a read of the line gave.
struct link_read {
  std::size_t bytes = 0;
  bool gone = false;  ///< the other end has closed, or the device was pulled
  std::string problem;
};

class byte_link {
public:
  /// Takes over a descriptor that is open already.
  explicit byte_link(int fd, std::string name) noexcept : fd_{fd}, name_{std::move(name)} {}

  /// A device file; what is no terminal (a pipe, a file) is taken as it is. Nothing waits for a modem's carrier.
  [[nodiscard]] static outcome<byte_link> open(const std::string& path, int baud) {
    byte_link out{::open(path.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK), path};
    if (out.fd_.get() < 0) return failure{path + ": " + std::strerror(errno)};
    if (::isatty(out.fd_.get()) == 0) return out;
    if (::flock(out.fd_.get(), LOCK_EX | LOCK_NB) != 0)  // two readers would take the bytes from each other
      return failure{path + ": is in use already, by another program or twice by this one"};
    const auto speed = detail::line_speed(baud);
    if (!speed) return failure{path + ": " + std::to_string(baud) + " baud: no serial line has this speed"};
    termios settings{};
    if (::tcgetattr(out.fd_.get(), &settings) != 0) return failure{path + ": " + std::strerror(errno)};
    ::cfmakeraw(&settings);
    settings.c_cflag |= static_cast<tcflag_t>(CLOCAL | CREAD);
    settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);  // whatever the last program left
    settings.c_iflag &= ~static_cast<tcflag_t>(IXOFF | IXANY);
    if (::cfsetspeed(&settings, *speed) != 0 || ::tcsetattr(out.fd_.get(), TCSANOW, &settings) != 0)
      return failure{path + ": " + std::strerror(errno)};
    ::tcflush(out.fd_.get(), TCIFLUSH);  // what came before anybody asked is old
    return out;
  }

  /// What is there, or what comes within `patience`.
  [[nodiscard]] link_read read(std::span<std::uint8_t> into, std::chrono::milliseconds patience) const {
    pollfd wait{fd_.get(), POLLIN, 0};
    const int ready = ::poll(&wait, 1, static_cast<int>(patience.count()));
    if (ready == 0 || (ready < 0 && errno == EINTR)) return {};
    if (ready < 0) return {0, true, name_ + ": " + std::strerror(errno)};
    const ssize_t got = ::read(fd_.get(), into.data(), into.size());
    if (got > 0) return {static_cast<std::size_t>(got), false, {}};
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) return {};
    return {0, true, name_ + ": the device is gone" + (got < 0 && errno != EIO ? std::string{": "} + std::strerror(errno) : "")};
  }

  /// All of it; waits where the other end is slow, for at most `patience`.
  [[nodiscard]] std::optional<failure> write(std::string_view bytes,
                                             std::chrono::milliseconds patience = std::chrono::seconds{2}) const {
    return write(bytes, deadline{patience});
  }
  [[nodiscard]] std::optional<failure> write(std::string_view bytes, const deadline& until) const {
    for (auto slice = until.slice(); !bytes.empty(); slice = until.slice()) {
      pollfd wait{fd_.get(), POLLOUT, 0};
      if (::poll(&wait, 1, static_cast<int>(slice.count())) <= 0) {
        if (until.over()) return failure{name_ + ": takes no bytes"};
        continue;
      }
      // A descriptor that blocks (standard output) takes as many without blocking, once it is ready.
      const ssize_t done = ::write(fd_.get(), bytes.data(), std::min<std::size_t>(bytes.size(), PIPE_BUF));
      if (done > 0) bytes.remove_prefix(static_cast<std::size_t>(done));
      else if (errno != EINTR && errno != EAGAIN) return failure{name_ + ": " + std::strerror(errno)};
    }
    return std::nullopt;
  }

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

private:
  detail::owned_fd fd_;
  std::string name_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
