// SPDX-License-Identifier: MIT
#include <rosin/adapt/audio_sndfile.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <array>
#include <random>

namespace {

rosin::recording noise(std::size_t channels, std::size_t frames, int bits, bool float_format) {
  std::mt19937_64 random{11};
  std::uniform_real_distribution<double> value{-1, 1};
  rosin::recording out;
  out.sample_rate_Hz = 128000;
  out.bits = bits;
  out.float_format = float_format;
  out.channels.resize(channels);
  for (auto& c : out.channels)
    for (std::size_t i = 0; i < frames; ++i) c.push_back(value(random));
  return out;
}

/// As another program would write it: through libsndfile, in the format asked for.
void write_as(const std::string& path, int format, const std::vector<short>& samples, int channels) {
  SF_INFO info{};
  info.samplerate = 44100;
  info.channels = channels;
  info.format = format;
  const rosin::detail::sndfile_handle file{sf_open(path.c_str(), SFM_WRITE, &info)};
  REQUIRE(file);
  sf_write_short(file.get(), samples.data(), static_cast<sf_count_t>(samples.size()));
}

}  // namespace

TEST_CASE("what was written is read back to half a step, in every format") {
  const test::temporary_folder folder;
  for (const auto& format : {std::pair{16, false}, {24, false}, {32, false}, {32, true}, {64, true}})
    for (const std::size_t channels : {1U, 2U, 5U}) {
      const int bits = format.first;
      const bool is_float = format.second;
      CAPTURE(bits);
      CAPTURE(is_float);
      CAPTURE(channels);
      const auto written = noise(channels, 5001, bits, is_float);
      REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", written, rosin::overwrite::allow));
      const auto read = rosin::read_audio(folder / "a.wav");
      REQUIRE(read);
      CHECK(read->bits == bits);
      CHECK(read->float_format == is_float);
      CHECK(read->sample_rate_Hz == 128000);
      REQUIRE(read->channels.size() == channels);
      REQUIRE(read->frames() == 5001);
      double worst = 0;
      for (std::size_t c = 0; c < channels; ++c)
        for (std::size_t i = 0; i < 5001; ++i) worst = std::max(worst, std::abs(read->channels[c][i] - written.channels[c][i]));
      CHECK(worst <= (is_float ? (bits == 64 ? 0.0 : 3e-8) : 0.5001 * written.step()));
    }
}

TEST_CASE("full scale: -1 is reached, +1 is one step less; beyond it PCM clips") {
  const test::temporary_folder folder;
  rosin::recording r = noise(1, 1, 16, false);
  r.channels = {{1.0, -1.0, 1.7, -1.7, 0.5}};
  REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", r, rosin::overwrite::refuse));
  const double top = 1 - std::ldexp(1.0, -15);
  CHECK(rosin::read_audio(folder / "a.wav")->channels[0] == std::vector<double>{top, -1, top, -1, 0.5});
}

TEST_CASE("files of other programs: FLAC, AIFF, 8 bit; codes as fractions of full scale") {
  const test::temporary_folder folder;
  const std::vector<short> codes{-32768, 0, 16384, 32767, 1, -1};
  for (const int format : {SF_FORMAT_FLAC | SF_FORMAT_PCM_16, SF_FORMAT_AIFF | SF_FORMAT_PCM_16,
                           SF_FORMAT_RF64 | SF_FORMAT_PCM_16, SF_FORMAT_CAF | SF_FORMAT_PCM_16}) {
    CAPTURE(format);
    write_as(folder / "a", format, codes, 2);
    const auto r = rosin::read_audio(folder / "a");
    REQUIRE(r);
    CHECK(r->channels[0] == std::vector<double>{-1, 0.5, std::ldexp(1.0, -15)});
    CHECK(r->channels[1] == std::vector<double>{0, 1 - std::ldexp(1.0, -15), -std::ldexp(1.0, -15)});
  }
  write_as(folder / "u8.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_U8, codes, 1);
  CHECK(rosin::read_audio(folder / "u8.wav")->bits == 8);
}

TEST_CASE("the header alone") {
  const test::temporary_folder folder;
  REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", noise(3, 777, 24, false), rosin::overwrite::refuse));
  const auto f = rosin::read_audio_format(folder / "a.wav");
  REQUIRE(f);
  CHECK(f->frames == 777);
  CHECK(f->channels == 3);
  CHECK(f->bits == 24);
}

TEST_CASE("a file that lost its end is refused, wherever it was cut") {
  const test::temporary_folder folder;
  REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", noise(2, 1000, 16, false), rosin::overwrite::refuse));
  const std::string bytes = folder.read("a.wav");
  for (const std::size_t kept : {0U, 3U, 11U, 20U, 43U, 44U, 45U, 2000U, 4043U}) {
    CAPTURE(kept);
    folder.write("cut.wav", bytes.substr(0, kept));
    const auto r = rosin::read_audio(folder / "cut.wav");
    CHECK_FALSE(r);
    CHECK(r.error().find("cut.wav: ") != std::string::npos);
    if (kept >= 12) CHECK(r.error().find("truncated") != std::string::npos);
  }
  write_as(folder / "a.flac", SF_FORMAT_FLAC | SF_FORMAT_PCM_16, std::vector<short>(60000, 5), 1);
  const std::string flac = folder.read("a.flac");
  folder.write("cut.flac", flac.substr(0, flac.size() / 2));
  CHECK_FALSE(rosin::read_audio(folder / "cut.flac"));
  for (const int format : {SF_FORMAT_AIFF, SF_FORMAT_AU, SF_FORMAT_W64, SF_FORMAT_CAF}) {
    CAPTURE(format);
    write_as(folder / "a", format | SF_FORMAT_PCM_16, std::vector<short>(6000, 5), 1);
    const std::string bytes_of_it = folder.read("a");
    folder.write("cut", bytes_of_it.substr(0, bytes_of_it.size() / 2));
    CHECK(rosin::read_audio(folder / "a"));
    CHECK_FALSE(rosin::read_audio(folder / "cut"));
  }
}

TEST_CASE("a head that does not tell the length, in all its ways, is read to the end; chunks of any version beside it") {
  const test::temporary_folder folder;
  const auto written = noise(2, 1000, 16, false);
  REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", written, rosin::overwrite::refuse));
  const std::string whole = folder.read("a.wav"), head = whole.substr(12, 24), samples = whole.substr(44);
  REQUIRE(whole.substr(36, 4) == "data");
  const auto number = [](std::uint64_t value, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(i < 8 ? value >> 8 * i & 0xffU : 0U);
    return out;
  };
  const auto same = [&](const std::string& bytes, bool told) {
    folder.write("b.wav", bytes);
    const auto format = rosin::read_audio_format(folder / "b.wav");
    const auto read = rosin::read_audio(folder / "b.wav");
    REQUIRE(read);
    CHECK(format->length_told == told);
    CHECK(format->frames == 1000);
    CHECK(read->channels == rosin::read_audio(folder / "a.wav")->channels);
  };
  for (const std::uint64_t size : {0U, 0x7ffff000U, 0x80000000U, 0xffffffffU}) {
    CAPTURE(size);
    same("RIFF" + number(size, 4) + "WAVE" + head + "data" + number(size, 4) + samples, false);
    same("RIFF" + number(size, 4) + "WAVE" + head + "data" + number(size, 4) + samples + "x", false);  // half a sample more
  }
  for (const char* form : {"RF64", "BW64"})
    same(form + number(0xffffffffU, 4) + "WAVEds64" + number(28, 4) + number(0, 28) + head + "data" + number(0xffffffffU, 4) +
             samples,
         false);
  const std::string data = "data" + number(samples.size(), 4) + samples;
  for (const std::string& before :
       {"bext" + number(3, 4) + "abc", "PEAK" + number(24, 4) + number(77, 24), "PEAK" + number(2, 4) + "xy"})
    same("RIFF" + number(0, 4) + "WAVE" + before + head + before + data + before, true);
  folder.write("two.wav", "RIFF" + number(0, 4) + "WAVE" + head + data + data);
  CHECK(rosin::read_audio(folder / "two.wav").error().find("two chunks of samples") != std::string::npos);
  std::string no_rate = whole;
  no_rate.replace(24, 4, 4, '\0');
  folder.write("rate.wav", no_rate);
  CHECK(rosin::read_audio(folder / "rate.wav").error().find("0 samples a second") != std::string::npos);
}

TEST_CASE("what is no recording") {
  const test::temporary_folder folder;
  CHECK(rosin::read_audio(folder / "none.wav").error() == folder / "none.wav" + ": no such file");
  CHECK(rosin::read_audio(folder.str()).error() == folder.str() + ": is a folder");
  CHECK(rosin::read_audio(folder.write("empty.wav", "")).error() == folder / "empty.wav" + ": is empty");
  CHECK_FALSE(rosin::read_audio(folder.write("text.wav", "schema = 1")));
  write_as(folder / "none.wav", SF_FORMAT_WAV | SF_FORMAT_PCM_16, {}, 1);
  CHECK(rosin::read_audio(folder / "none.wav").error() == folder / "none.wav" + ": holds no samples");
  write_as(folder / "law.wav", SF_FORMAT_WAV | SF_FORMAT_ULAW, std::vector<short>(100, 5), 1);
  CHECK(rosin::read_audio(folder / "law.wav").error().find("lossy") != std::string::npos);
}

TEST_CASE("nothing is overwritten, ragged and empty recordings are refused, nothing half-made stays") {
  const test::temporary_folder folder;
  const auto r = noise(2, 10, 16, false);
  REQUIRE_FALSE(rosin::write_audio(folder / "a.wav", r, rosin::overwrite::refuse));
  CHECK(rosin::write_audio(folder / "a.wav", r, rosin::overwrite::refuse));
  auto ragged = r;
  ragged.channels[1].pop_back();
  CHECK(rosin::write_audio(folder / "b.wav", ragged, rosin::overwrite::refuse));
  CHECK(rosin::write_audio(folder / "b.wav", rosin::recording{}, rosin::overwrite::refuse));
  CHECK(rosin::write_audio(folder / "no/b.wav", r, rosin::overwrite::refuse));
  CHECK(std::distance(std::filesystem::directory_iterator{folder.str()}, {}) == 1);
}
