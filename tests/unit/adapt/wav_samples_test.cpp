// SPDX-License-Identifier: MIT
#include <rosin/adapt/wav_samples.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <array>
#include <sstream>
#include <vector>

namespace {

/// A chunk "fmt " of PCM.
rosin::riff_layout pcm(int channels, int rate, int frame, int bits, bool big_endian = false) {
  rosin::riff_layout out;
  out.big_endian = big_endian;
  const auto put = [&](int value, int bytes) {
    for (int i = 0; i < bytes; ++i) out.format += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - i : i) & 0xff);
  };
  put(1, 2), put(channels, 2), put(rate, 4), put(rate * frame, 4), put(frame, 2), put(bits, 2);
  return out;
}

std::vector<double> shown(const rosin::riff_layout& is, std::unique_ptr<rosin::detail::byte_source> from, std::uint64_t offset,
                          std::uint64_t bytes) {
  rosin::detail::shown_wav wav{std::move(from), rosin::detail::plain_wav_head(is, bytes), offset, bytes};
  SF_INFO info{};
  const auto file = wav.open(info);
  REQUIRE(file);
  CHECK(info.samplerate == 48000);
  std::vector<double> out(16);
  out.resize(static_cast<std::size_t>(sf_read_double(file.get(), out.data(), 16)));
  return out;
}

}  // namespace

TEST_CASE("libsndfile is shown format and samples, whatever stands around them, in either order of bytes") {
  const test::temporary_folder folder;
  const std::string bytes{"nonsense\x00\x40\x40\x00\x00\xc0\xc0\x00more of it", 26};
  const auto path = folder.write("a", bytes);
  const auto from_file = [&] { return std::make_unique<rosin::detail::file_bytes>(path); };
  CHECK(shown(pcm(2, 48000, 4, 16), from_file(), 8, 8) == std::vector<double>{0.5, 0x40 * 0x1p-15, -0.5, 0xc0 * 0x1p-15});
  CHECK(shown(pcm(2, 48000, 4, 16, true), from_file(), 8, 8) == std::vector<double>{0x40 * 0x1p-15, 0.5, 0xc0 * 0x1p-15, -0.5});
}

TEST_CASE("a pipe is as long as it turns out to be; its first bytes can be read again") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  REQUIRE(::write(ends[1], "head\x00\x40\x00\xc0", 8) == 8);
  ::close(ends[1]);
  auto from = std::make_unique<rosin::detail::pipe_bytes>(ends[0]);
  CHECK(from->first(4) == "head");
  CHECK_FALSE(from->waits(3));
  CHECK(from->waits(4));
  std::string again(3, ' ');
  CHECK(from->read(1, again.data(), 3) == 3);
  CHECK(again == "ead");
  CHECK(shown(pcm(1, 48000, 2, 16), std::move(from), 4, 1ULL << 60U) == std::vector<double>{0.5, -0.5});
  ::close(ends[0]);
}

TEST_CASE("more than four gigabytes are RF64") {
  std::istringstream in{rosin::detail::plain_wav_head(pcm(1, 48000, 2, 16), 5000000000)};
  CHECK(rosin::read_riff_layout(in)->data_promised == 5000000000);
}

TEST_CASE("a format that cannot be is refused in words") {
  using rosin::detail::format_chunk_problem;
  CHECK(format_chunk_problem(pcm(2, 48000, 4, 16)).empty());
  CHECK(format_chunk_problem(pcm(2, 0, 4, 16)).find("0 samples a second") != std::string::npos);
  CHECK(format_chunk_problem(pcm(0, 48000, 4, 16)).find("0 channels") != std::string::npos);
  CHECK(format_chunk_problem(pcm(2, 48000, 4, 0)).find("0 bits") != std::string::npos);
  CHECK(format_chunk_problem(pcm(2, 48000, 2, 16)).find("contradicts") != std::string::npos);
  CHECK(format_chunk_problem({}).find("no chunk \"fmt \"") != std::string::npos);
}
