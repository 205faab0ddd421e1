// SPDX-License-Identifier: MIT
#include "provenance.hpp"

#include <rosin/version.hpp>

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>

namespace tool {

namespace {

struct free_digest {
  void operator()(EVP_MD_CTX* context) const noexcept { EVP_MD_CTX_free(context); }
};

std::string hexadecimal(const unsigned char* bytes, std::size_t count) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < count; ++i) {
    out += digits[bytes[i] >> 4U];
    out += digits[bytes[i] & 15U];
  }
  return out;
}

}  // namespace

rosin::outcome<input_file> fingerprint(const std::string& path) {
  errno = 0;
  std::ifstream in{path, std::ios::binary};
  if (!in) return rosin::failure{path + ": cannot be read" + rosin::detail::system_reason()};
  const std::unique_ptr<EVP_MD_CTX, free_digest> digest{EVP_MD_CTX_new()};
  if (!digest || EVP_DigestInit_ex(digest.get(), EVP_sha256(), nullptr) != 1)
    return rosin::failure{path + ": no checksum can be had of it"};
  input_file out{path, "", 0};
  std::vector<char> block(1U << 16U);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())) || in.gcount() > 0) {
    const auto got = static_cast<std::size_t>(in.gcount());
    EVP_DigestUpdate(digest.get(), block.data(), got);
    out.bytes += got;
  }
  if (in.bad()) return rosin::failure{path + ": cannot be read" + rosin::detail::system_reason()};
  std::array<unsigned char, EVP_MAX_MD_SIZE> sum{};
  unsigned int size = 0;
  EVP_DigestFinal_ex(digest.get(), sum.data(), &size);
  out.sha256 = hexadecimal(sum.data(), size);
  return out;
}

provenance::provenance(const CLI::App& used) : command{used.get_name()} {
  for (const CLI::Option* option : used.get_options()) {
    if (option->count() == 0) continue;
    std::string values;
    for (const auto& value : option->results()) values += (values.empty() ? "" : " ") + value;
    options.emplace_back(option->get_name(), values);
  }
}

std::optional<rosin::failure> provenance::add_input(const std::string& path) {
  auto file = fingerprint(path);
  if (!file) return rosin::failure{file.error()};
  const bool known = std::any_of(inputs.begin(), inputs.end(),
                                 [&](const input_file& f) { return f.path == file->path && f.sha256 == file->sha256; });
  if (!known) inputs.push_back(*std::move(file));
  return std::nullopt;
}

json provenance::to_json() const {
  json out{{"tool", "rosin"}, {"version", ROSIN_VERSION_STRING}, {"command", command}};
  out["options"] = json::object();
  for (const auto& [name, value] : options) out["options"][name] = value;
  out["inputs"] = json::array();
  for (const auto& file : inputs) out["inputs"].push_back({{"file", file.path}, {"sha256", file.sha256}, {"bytes", file.bytes}});
  return out;
}

std::vector<std::string> provenance::comment_lines() const {
  std::vector<std::string> out{"rosin " ROSIN_VERSION_STRING " " + command};
  for (const auto& [name, value] : options) out.push_back("option " + name + " " + value);
  for (const auto& file : inputs) out.push_back("input " + file.path + " sha256 " + file.sha256);
  return out;
}

}  // namespace tool
