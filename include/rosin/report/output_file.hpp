// tier: hosted
// SPDX-License-Identifier: MIT
//
// A result goes to a file next to its place and takes that place only when it is complete: whoever finds the file finds
// all of it. Nothing is overwritten unless the caller says so. A symbolic link is followed: what it leads to is replaced, the link
// stays. What is no file of its own (a terminal, /dev/null, a named pipe, a shell's >(...)) is written to as it is, and standard
// output by its names, /dev/stdout and the like, is this program's.
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <locale>
#include <optional>
#include <system_error>

namespace rosin {

enum class overwrite { refuse, allow };

namespace detail {

/// What the system says of the last call that failed; nothing where it says nothing.
[[nodiscard]] inline std::string system_reason(int error = errno) {
  return error != 0 ? ": " + std::generic_category().message(error) : std::string{};
}

/// Of this program: /dev/fd/1, /proc/self/fd/1.
[[nodiscard]] inline bool is_descriptor(const std::filesystem::path& place, const char* number) {
  std::error_code ignored;
  const auto folder = std::filesystem::canonical("/dev/fd", ignored);
  return !folder.empty() && place.filename() == number && std::filesystem::canonical(place.parent_path(), ignored) == folder;
}

/// Where the links lead, to a file or to what is not there yet; a descriptor of this program stays what it is.
[[nodiscard]] inline std::filesystem::path followed(std::filesystem::path place) {
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(place, error) && !is_descriptor(place, "1"); ++links) {
    const auto next = std::filesystem::read_symlink(place, error);
    if (error) break;
    place = next.is_absolute() ? next : place.parent_path() / next;
  }
  return place;
}

/// Devices and pipes: nothing in them can be lost, and nothing can take their place.
[[nodiscard]] inline bool takes_text_as_it_comes(const std::filesystem::path& place) {
  std::error_code ignored;
  const auto kind = std::filesystem::status(place, ignored).type();
  return kind == std::filesystem::file_type::character || kind == std::filesystem::file_type::fifo;
}

}  // namespace detail

/// A name of this program's standard output, as /dev/stdout.
[[nodiscard]] inline bool is_standard_output(const std::string& path) {
  return detail::is_descriptor(detail::followed(path), "1");
}

/// The reason why nothing may be written there, if there is one.
[[nodiscard]] inline std::optional<failure> cannot_write(const std::string& path, overwrite existing) {
  std::error_code ignored;
  if (is_standard_output(path) || detail::takes_text_as_it_comes(path)) return std::nullopt;
  const std::filesystem::path place = detail::followed(path);
  if (path.empty()) return failure{"the name of the file to write is empty"};
  if (std::filesystem::is_directory(place, ignored)) return failure{path + ": is a folder"};
  if (std::filesystem::is_symlink(place, ignored)) return failure{path + ": is a link that leads nowhere"};
  if (std::filesystem::exists(place, ignored) && !std::filesystem::is_regular_file(place, ignored))
    return failure{path + ": is neither a file nor a pipe nor a device that takes text"};
  if (existing == overwrite::refuse && std::filesystem::exists(place, ignored)) return failure{path + ": exists already"};
  const auto folder = place.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    return failure{path + ": the folder " + folder.string() + " does not exist"};
  return std::nullopt;
}

/// Calls make(name) for a file next to the place, then puts that in its place; make returns why it could not, or an empty text.
/// Empty: it is there; otherwise what went wrong.
template <class Make>
[[nodiscard]] std::optional<failure> replace_file(const std::string& path, overwrite existing, Make make) {
  if (auto why = cannot_write(path, existing)) return why;
  if (is_standard_output(path) || detail::takes_text_as_it_comes(path))
    return failure{path + ": is no file; this format goes to a file only"};
  const std::filesystem::path place = detail::followed(path);
  const std::string part = place.string() + ".part";
  std::error_code error;
  std::string why = make(part);
  if (why.empty()) {
    const auto before = std::filesystem::status(place, error);
    if (std::filesystem::exists(before)) std::filesystem::permissions(part, before.permissions(), error);
    std::filesystem::rename(part, place, error);
    if (!error) return std::nullopt;
    why = "cannot be written: " + error.message();
  }
  std::filesystem::remove(part, error);
  return failure{path + ": " + why};
}

/// Calls write(stream), then puts the file in its place. Empty: it is there; otherwise what went wrong.
template <class Write>
[[nodiscard]] std::optional<failure> write_file(const std::string& path, overwrite existing, Write write) {
  const auto put = [&](std::ostream& stream) -> std::string {
    if (stream) write(stream);
    stream.flush();
    return stream ? std::string{} : "cannot be written" + detail::system_reason();
  };
  const auto into = [&](const std::string& name, std::ios::openmode mode) {
    errno = 0;
    std::ofstream stream{name, std::ios::binary | mode};
    stream.imbue(std::locale::classic());  // numbers in files are the same everywhere
    return put(stream);
  };
  std::string why;
  if (is_standard_output(path)) {
    errno = 0;
    why = put(std::cout);
  } else if (detail::takes_text_as_it_comes(path)) {
    why = into(path, std::ios::out);
  } else {
    return replace_file(path, existing, [&](const std::string& part) { return into(part, std::ios::trunc); });
  }
  return why.empty() ? std::nullopt : std::optional{failure{path + ": " + why}};
}

}  // namespace rosin
