// tier: hosted
// SPDX-License-Identifier: MIT
//
// A serial line without a cable: what one program writes to the pair's one side, another that has opened path() reads. So a
// device can be played by a program, and the rest does not know.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>

#include <stdlib.h>

namespace rosin {

class pseudo_terminal {
public:
  [[nodiscard]] static outcome<pseudo_terminal> open() {
    byte_link device{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK), "pseudo-terminal"};
    const auto failed = [] { return failure{std::string{"pseudo-terminal: "} + std::strerror(errno)}; };
    if (device.fd() < 0 || ::grantpt(device.fd()) != 0 || ::unlockpt(device.fd()) != 0) return failed();
    std::array<char, 128> name{};
    if (::ptsname_r(device.fd(), name.data(), name.size()) != 0) return failed();
    // Raw from the beginning: nothing is echoed, even before the other side has set its end up. It stays open on this side
    // too, so that the other side may come and go.
    {
      const auto set_up = byte_link::open(name.data(), 115200);
      if (!set_up) return failure{set_up.error()};
      byte_link kept{::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC), name.data()};
      if (kept.fd() < 0) return failed();
      return pseudo_terminal{std::move(device), std::move(kept), name.data()};
    }
  }

  /// The device file for the other program.
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// This side of the line.
  [[nodiscard]] const byte_link& device() const noexcept { return device_; }

private:
  pseudo_terminal(byte_link device, byte_link kept, std::string path)
      : device_{std::move(device)}, kept_{std::move(kept)}, path_{std::move(path)} {}

  byte_link device_, kept_;
  std::string path_;
};

}  // namespace rosin
