// tier: hosted
// SPDX-License-Identifier: MIT
//
// A small file that is replaced whole: after a crash or a power cut there is the old one or the new one, never a part. The new
// text is on the disk before it takes the name, and the name before this returns.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>

#include <cstdio>
#include <filesystem>

namespace rosin {

/// Names in a folder (of a file that was just made) put on the disk.
[[nodiscard]] inline std::optional<failure> sync_folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path{path}.parent_path();
  const std::string folder = (parent / ".").string();
  const detail::owned_fd fd{::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  if (fd.get() >= 0 && (::fsync(fd.get()) == 0 || errno == EINVAL)) return std::nullopt;
  return failure{folder + ": " + std::strerror(errno)};
}

[[nodiscard]] inline std::optional<failure> replace_durably(const std::string& path, std::string_view text) {
  const std::string part = path + ".part";
  const auto why = [&] { return failure{path + ": " + std::strerror(errno)}; };
  {
    const byte_link file{::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666), path};
    if (file.fd() < 0) return why();
    if (auto bad = file.write(text)) {
      ::unlink(part.c_str());
      return bad;
    }
    if (::fsync(file.fd()) != 0) return why();
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) return why();
  return sync_folder_of(path);
}

}  // namespace rosin
