// SPDX-License-Identifier: MIT
#include <rosin/hardware/wav_header.hpp>

#include <doctest/doctest.h>

#include <rosin/adapt/audio_sndfile.hpp>
#include <support/temporary_folder.hpp>

namespace {

/// A file as it lies on the disk while it is being written, or at its end.
std::string written(const test::temporary_folder& folder, const rosin::frame_format& f, const std::vector<double>& samples,
                    bool done, std::size_t cut = 0) {
  std::string bytes;
  std::array<std::uint8_t, 4> one{};
  for (const double x : samples) {
    rosin::put_sample(one.data(), x, f);
    bytes.append(reinterpret_cast<const char*>(one.data()), rosin::sample_bytes(f));
  }
  bytes.resize(bytes.size() - cut);
  const auto head = rosin::make_wav_head(f, done ? std::optional{std::uint64_t{bytes.size()}} : std::nullopt);
  return folder.write("a.wav", std::string{reinterpret_cast<const char*>(head.data()), head.size()} + bytes);
}

}  // namespace

TEST_CASE("finished or not, libsndfile reads every format back to half a step") {
  const test::temporary_folder folder;
  for (const auto& form : {std::pair{16, false}, {24, false}, {32, false}, {32, true}})
    for (const bool done : {false, true}) {
      const auto bits = form.first;
      const auto is_float = form.second;
      CAPTURE(bits);
      CAPTURE(done);
      const rosin::frame_format f{128000, 2, bits, is_float};
      std::vector<double> samples;
      for (int i = 0; i < 600; ++i) samples.push_back(0.999 * std::sin(0.37 * i));
      const auto read = rosin::read_audio(written(folder, f, samples, done));
      REQUIRE(read.has_value());
      CHECK(read->sample_rate_Hz == 128000);
      CHECK(read->bits == bits);
      CHECK(read->float_format == is_float);
      REQUIRE(read->frames() == 300);
      double worst = 0;
      for (std::size_t i = 0; i < 600; ++i) worst = std::max(worst, std::abs(read->channels[i % 2][i / 2] - samples[i]));
      CHECK(worst <= (is_float ? 3e-8 : 0.5001 * read->step()));
    }
}

TEST_CASE("an unfinished file that ends within a frame has all whole frames; full scale is clipped, NaN is silent") {
  const test::temporary_folder folder;
  const rosin::frame_format f{48000, 2, 24};
  const auto read = rosin::read_audio(written(folder, f, {1.5, -1.5, std::nan(""), 0.25, 0.5, 0.5}, false, 4));
  REQUIRE(read.has_value());
  REQUIRE(read->frames() == 2);
  CHECK(read->channels[0][0] == 1 - 0x1p-23);
  CHECK(read->channels[1][0] == -1);
  CHECK(read->channels[0][1] == 0);
}

TEST_CASE("beyond 4 GB the head is RF64 with sizes of 64 bits, found by the walk over its chunks") {
  const test::temporary_folder folder;
  const rosin::frame_format f{128000, 2, 24};
  const std::uint64_t data = 6 * 1000000000ULL;
  const auto head = rosin::make_wav_head(f, data);
  const auto path = folder.write("a.wav", std::string{reinterpret_cast<const char*>(head.data()), head.size()});
  std::filesystem::resize_file(path, head.size() + data);  // a hole: it takes no room
  std::ifstream in{path, std::ios::binary};
  const auto layout = rosin::read_riff_layout(in);
  REQUIRE(layout);
  CHECK(layout->data_offset == head.size());
  CHECK(layout->data_promised == data);
  const auto format = rosin::read_audio_format(path);
  REQUIRE(format.has_value());
  CHECK(format->frames == 1000000000ULL);
  CHECK(format->bits == 24);
}
