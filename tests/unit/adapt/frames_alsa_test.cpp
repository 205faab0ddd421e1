// SPDX-License-Identifier: MIT
#include <rosin/adapt/frames_alsa.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <cstdlib>

namespace {

void silent(const char*, int, const char*, int, const char*, ...) {}

/// ALSA's own devices in user space, with a configuration of their own: `take` plays a file of bare samples.
struct alsa_world {
  explicit alsa_world(std::string_view samples) {
    folder.write("samples", samples);
    folder.write("asound.conf",
                 "pcm.null { type null }\nctl.null { type null }\n"
                 "pcm.take { type file slave.pcm { type null } file \"/dev/null\" infile \"" +
                     folder / "samples" +
                     "\" format \"raw\" }\n"
                     "pcm.fixed { type hw card 77 }\n");
    ::setenv("ALSA_CONFIG_PATH", (folder / "asound.conf").c_str(), 1);
    snd_lib_error_set_handler(&silent);
  }
  ~alsa_world() {
    snd_config_update_free_global();
    ::unsetenv("ALSA_CONFIG_PATH");
  }
  test::temporary_folder folder;
};

}  // namespace

TEST_CASE("capture through ALSA: the samples of the device, in every width") {
  for (const int bits : {16, 24, 32}) {
    CAPTURE(bits);
    const int bytes = bits / 8;
    std::string raw;
    for (int i = 0; i < 20000; ++i)
      for (const int x : {i % 30000, -(i % 30000)})
        for (int b = 0; b < bytes; ++b) raw.push_back(static_cast<char>((x >> (8 * b)) & 0xff));
    const alsa_world world{raw};
    auto from = rosin::alsa_source::open("take", {96000, 2, bits});
    REQUIRE_MESSAGE(from.has_value(), from.error());
    CHECK(from->format().live);
    std::vector<double> block(2 * 333);
    int at = 0;
    bool right = true;
    while (at < 19000 && right) {
      const auto got = from->read(block, std::chrono::seconds{2});
      REQUIRE(got.frames > 0);
      CHECK(got.lost == 0);
      for (std::size_t i = 0; i < got.frames && at < 19000; ++i, ++at)
        right = right && std::ldexp(block[2 * i], bits - 1) == at % 30000 && block[2 * i + 1] == -block[2 * i];
    }
    CHECK(right);
  }
}

TEST_CASE("a device that is not there is named") {
  const alsa_world world{"x"};
  const auto none = rosin::alsa_source::open("nothing", {48000, 2});
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().find("alsa nothing: ") == 0);
  CHECK_FALSE(rosin::alsa_source::open("fixed", {48000, 2}).has_value());
}

TEST_CASE("samples in ALSA's formats") {
  const std::array<std::uint8_t, 4> bytes{0x00, 0x00, 0x80, 0xff};
  CHECK(rosin::detail::alsa_sample(bytes.data() + 1, SND_PCM_FORMAT_S16_LE) == -1);
  CHECK(rosin::detail::alsa_sample(bytes.data(), SND_PCM_FORMAT_S24_3LE) == -1);
  CHECK(rosin::detail::alsa_sample(bytes.data(), SND_PCM_FORMAT_S24_LE) == -1);
  CHECK(rosin::detail::alsa_sample(bytes.data(), SND_PCM_FORMAT_S32_LE) == -0x1p-8);
  const std::array<std::uint8_t, 4> half{0x00, 0x00, 0x00, 0x3f};
  CHECK(rosin::detail::alsa_sample(half.data(), SND_PCM_FORMAT_FLOAT_LE) == 0.5);
}
