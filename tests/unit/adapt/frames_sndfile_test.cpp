// SPDX-License-Identifier: MIT
#include <rosin/adapt/frames_sndfile.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <fcntl.h>
#include <unistd.h>
#include <thread>

namespace {

std::string make(const test::temporary_folder& folder, const char* name, int format, int frames) {
  SF_INFO info{};
  info.samplerate = 96000;
  info.channels = 3;
  info.format = format;
  const rosin::detail::sndfile_handle file{sf_open((folder / name).c_str(), SFM_WRITE, &info)};
  REQUIRE(file);
  for (int i = 0; i < frames; ++i) {
    const std::array<int, 3> frame{i % 32000 << 16, -(i % 32000 << 16), 12345 << 16};
    REQUIRE(sf_writef_int(file.get(), frame.data(), 1) == 1);
  }
  return folder / name;
}

/// All frames of make(), each as it was written.
template <class Source>
std::size_t count_right(Source& from, std::string* problem = nullptr) {
  std::vector<double> block(3 * 700);
  std::size_t at = 0;
  for (bool over = false; !over;) {
    const auto got = from.read(block, std::chrono::seconds{2});
    for (std::size_t i = 0; i < got.frames; ++i, ++at)
      if (block[3 * i] * 32768 != static_cast<double>(at % 32000) || block[3 * i + 1] != -block[3 * i] ||
          block[3 * i + 2] * 32768 != 12345)
        return 0;
    over = got.ended;
    if (problem != nullptr) *problem += got.problem;
  }
  return at;
}

}  // namespace

TEST_CASE("WAV, RF64 and FLAC files, frame by frame") {
  const test::temporary_folder folder;
  for (const int format : {SF_FORMAT_WAV | SF_FORMAT_PCM_16, SF_FORMAT_WAVEX | SF_FORMAT_PCM_24,
                           SF_FORMAT_RF64 | SF_FORMAT_PCM_32, SF_FORMAT_FLAC | SF_FORMAT_PCM_24}) {
    CAPTURE(format);
    auto from = rosin::sndfile_source::open(make(folder, "a", format, 5003));
    REQUIRE(from.has_value());
    CHECK(from->format().sample_rate_Hz == 96000);
    CHECK(from->format().channels == 3);
    CHECK_FALSE(from->format().live);
    std::string problem;
    CHECK(count_right(*from, &problem) == 5003);
    CHECK(problem.empty());
  }
  CHECK(rosin::sndfile_source::open(folder / "none").error().find("no such file") != std::string::npos);
}

TEST_CASE("a WAV file through a pipe, in dribs and drabs, and bare samples") {
  const test::temporary_folder folder;
  make(folder, "a", SF_FORMAT_WAV | SF_FORMAT_PCM_16, 5003);
  make(folder, "b", SF_FORMAT_RAW | SF_ENDIAN_LITTLE | SF_FORMAT_PCM_24, 5003);
  for (const char* name : {"a", "b"}) {
    CAPTURE(name);
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    const std::string bytes = folder.read(name);
    std::jthread writer{[&] {
      for (std::size_t at = 0; at < bytes.size();) {
        const ssize_t done = ::write(ends[1], bytes.data() + at, std::min<std::size_t>(3001, bytes.size() - at));
        if (done < 0) break;
        at += static_cast<std::size_t>(done);
      }
      ::close(ends[1]);
    }};
    const std::optional<rosin::frame_format> bare =
        name[0] == 'b' ? std::optional{rosin::frame_format{96000, 3, 24}} : std::nullopt;
    auto from = rosin::sndfile_source::open_pipe(ends[0], bare);
    REQUIRE(from.has_value());
    CHECK(from->format().bits == (bare ? 24 : 16));
    CHECK(count_right(*from) == 5003);
    writer.join();
    ::close(ends[0]);
  }
}

TEST_CASE("a stream that does not tell its length is read to its end; one that ends before its length says so") {
  const test::temporary_folder folder;
  make(folder, "a", SF_FORMAT_WAV | SF_FORMAT_PCM_16, 5003);
  const std::string whole = folder.read("a");
  const std::size_t size_at = whole.find("data") + 4;
  for (const char* size : {"\0\0\0\0", "\0\xf0\xff\x7f", "\0\0\0\x80", "\xff\xff\xff\xff", "as it was"}) {
    const bool told = *size == 'a';
    CAPTURE(told);
    std::string bytes = whole.substr(0, whole.size() - 6);
    if (!told) bytes.replace(size_at, 4, std::string{size, 4});
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    std::jthread writer{[&] {
      CHECK(::write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
      ::close(ends[1]);
    }};
    auto from = rosin::sndfile_source::open_pipe(ends[0]);
    REQUIRE(from.has_value());
    std::string problem;
    CHECK(count_right(*from, &problem) == 5002);
    CHECK((problem.find("ended early") != std::string::npos) == told);
    writer.join();
    ::close(ends[0]);
  }
}

TEST_CASE("a stream that is none, or of no rate, is refused in words") {
  for (const std::string& bytes : {std::string{}, std::string{"RIFF"}, std::string{"RIFF\0\0\0\0WAVEfmt ", 16}}) {
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    REQUIRE(::write(ends[1], bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
    ::close(ends[1]);
    const auto from = rosin::sndfile_source::open_pipe(ends[0]);
    REQUIRE_FALSE(from.has_value());
    CHECK(from.error().find(bytes.empty() ? "nothing came" : "ended before its samples") != std::string::npos);
    ::close(ends[0]);
  }
}

TEST_CASE("a file that is damaged inside ends with a reason") {
  const test::temporary_folder folder;
  make(folder, "a.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16, 50000);
  std::string bytes = folder.read("a.flac");
  bytes.resize(bytes.size() / 2);
  folder.write("a.flac", bytes);
  auto from = rosin::sndfile_source::open(folder / "a.flac");
  REQUIRE(from.has_value());
  std::string problem;
  CHECK(count_right(*from, &problem) < 50000);
  CHECK_FALSE(problem.empty());
}
