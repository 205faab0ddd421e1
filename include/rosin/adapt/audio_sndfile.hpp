// tier: hosted
// SPDX-License-Identifier: MIT
//
// Recordings from and to files through libsndfile: WAV, RF64, FLAC, AIFF, W64, CAF with 8 to 32 bit PCM or floating point.
// Lossy encodings are refused: what they throw away is what is measured here. A file whose header promises more samples
// than are there is refused too; one whose header does not tell how many there are is read to its end (riff_layout.hpp).
//
#pragma once

#include <rosin/acquire/recording.hpp>
#include <rosin/adapt/wav_samples.hpp>
#include <rosin/report/output_file.hpp>

#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace rosin {

/// What the header of a recording says.
struct audio_format {
  double sample_rate_Hz = 0;
  int channels = 0, bits = 0;
  bool float_format = false;
  std::uint64_t frames = 0;          ///< 0: of a table, which has to be read to tell it
  bool length_told = true;           ///< by the header; if not, all was read that is there
  std::vector<std::string> columns;  ///< names of a table's columns, where it has them
};

namespace detail {

/// Bits of a sample: negative for floating point, 0 for an encoding that is not exact.
[[nodiscard]] inline int sample_bits(int format) noexcept {
  switch (format & SF_FORMAT_SUBMASK) {
    case SF_FORMAT_PCM_S8:
    case SF_FORMAT_PCM_U8:
      return 8;
    case SF_FORMAT_PCM_16:
    case SF_FORMAT_ALAC_16:
      return 16;
    case SF_FORMAT_PCM_24:
    case SF_FORMAT_ALAC_24:
      return 24;
    case SF_FORMAT_PCM_32:
    case SF_FORMAT_ALAC_32:
      return 32;
    case SF_FORMAT_FLOAT:
      return -32;
    case SF_FORMAT_DOUBLE:
      return -64;
    default:
      return 0;
  }
}

[[nodiscard]] inline std::string format_problem(const SF_INFO& info) {
  if (sample_bits(info.format) == 0) return "is neither PCM nor floating point: a lossy encoding is no measurement";
  if (info.frames <= 0) return "holds no samples";
  if (info.channels <= 0 || info.channels > 1024) return "has an impossible number of channels";
  if (info.samplerate <= 0) return "has an impossible sample rate";
  return {};
}

/// A file of another kind whose head promises more than the file holds, in words: libsndfile takes what is there, and notes
/// "SSND : 4008 (should be 1981)".
[[nodiscard]] inline std::string missing_end(SNDFILE* file) {
  std::array<char, 16384> notes{};
  sf_command(file, SFC_GET_LOG_INFO, notes.data(), static_cast<int>(notes.size()) - 1);
  const std::string text = notes.data();
  constexpr std::string_view should = " (should be ";
  for (std::size_t at = text.find(should); at != std::string::npos; at = text.find(should, at + 1)) {
    const std::size_t begin = text.rfind(' ', at - 1) + 1;
    const auto promised = std::strtoull(text.c_str() + begin, nullptr, 10),
               present = std::strtoull(text.c_str() + at + should.size(), nullptr, 10);
    if (promised > present && !is_no_size(promised))
      return "truncated: the header promises " + std::to_string(promised) + " bytes where the file holds " +
             std::to_string(present);
  }
  return {};
}

/// A file that can be read, with what libsndfile is shown of it.
struct opened_audio {
  std::unique_ptr<shown_wav> shown;  ///< empty: the file itself
  sndfile_handle file;
  SF_INFO info{};
  bool length_told = true;
};

[[nodiscard]] inline std::string unreadable(const std::string& name) {
  return name + ": is no recording that can be read, or it is damaged (libsndfile: " + sf_strerror(nullptr) + ")";
}

/// Opened and found sound, or why not.
[[nodiscard]] inline outcome<opened_audio> open_audio(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return failure{path + ": no such file"};
  if (std::filesystem::is_directory(path, ignored)) return failure{path + ": is a folder"};
  if (std::filesystem::file_size(path, ignored) == 0) return failure{path + ": is empty"};
  opened_audio out;
  auto bytes = std::make_unique<file_bytes>(path);
  if (const auto layout = read_riff_layout(bytes->stream())) {
    if (const auto why = wav_problem(*layout); !why.empty()) return failure{path + ": " + why};
    const std::uint64_t size = layout->data_promised.value_or(layout->data_present());
    out.shown = std::make_unique<shown_wav>(std::move(bytes), plain_wav_head(*layout, size), *layout->data_offset, size);
    out.length_told = layout->data_promised.has_value();
  }
  out.file = out.shown ? out.shown->open(out.info) : sndfile_handle{sf_open(path.c_str(), SFM_READ, &out.info)};
  if (!out.file) return failure{unreadable(path)};
  auto why = format_problem(out.info);
  if (why.empty() && !out.shown) why = missing_end(out.file.get());
  if (!why.empty()) return failure{path + ": " + why};
  return out;
}

/// Frame by frame into separate channels; the number of frames that could be read.
inline std::size_t read_frames(SNDFILE* file, const SF_INFO& info, std::vector<std::vector<double>>& channels) {
  const auto width = static_cast<std::size_t>(info.channels);
  constexpr std::size_t block = 4096;
  std::vector<double> interleaved(block * width);
  channels.assign(width, {});
  for (;;) {
    const sf_count_t got = sf_readf_double(file, interleaved.data(), block);
    if (got <= 0) break;
    for (std::size_t c = 0; c < width; ++c)
      for (std::size_t i = 0; i < static_cast<std::size_t>(got); ++i) channels[c].push_back(interleaved[i * width + c]);
  }
  return channels.front().size();
}

}  // namespace detail

/// The header alone.
[[nodiscard]] inline outcome<audio_format> read_audio_format(const std::string& path) {
  const auto opened = detail::open_audio(path);
  if (!opened) return failure{opened.error()};
  const SF_INFO& info = opened->info;
  const int bits = detail::sample_bits(info.format);
  return audio_format{static_cast<double>(info.samplerate),
                      info.channels,
                      std::abs(bits),
                      bits < 0,
                      static_cast<std::uint64_t>(info.frames),
                      opened->length_told,
                      {}};
}

/// The whole recording.
[[nodiscard]] inline outcome<recording> read_audio(const std::string& path) {
  const auto opened = detail::open_audio(path);
  if (!opened) return failure{opened.error()};
  const SF_INFO& info = opened->info;
  const int bits = detail::sample_bits(info.format);
  recording out{path, static_cast<double>(info.samplerate), {}, std::abs(bits), bits < 0, {}, false};
  const std::size_t frames = detail::read_frames(opened->file.get(), info, out.channels);
  const auto promised = static_cast<std::size_t>(info.frames);
  if (frames == 0) return failure{path + ": holds no samples that can be read"};
  if (frames < promised && info.frames != SF_COUNT_MAX)
    return failure{path + ": truncated or damaged: " + std::to_string(promised) + " frames promised, " + std::to_string(frames) +
                   " could be read"};
  return out;
}

namespace detail {

[[nodiscard]] inline int wav_format(const recording& from) noexcept {
  const bool large = from.frames() * from.channels.size() * 8 > 0xf0000000U;
  const int container = large ? SF_FORMAT_RF64 : from.channels.size() > 2 || from.bits > 16 ? SF_FORMAT_WAVEX : SF_FORMAT_WAV;
  if (from.float_format) return container | (from.bits > 32 ? SF_FORMAT_DOUBLE : SF_FORMAT_FLOAT);
  return container | (from.bits > 24 ? SF_FORMAT_PCM_32 : from.bits > 16 ? SF_FORMAT_PCM_24 : SF_FORMAT_PCM_16);
}

/// The nearest step of a converter, in the upper bits of 32. libsndfile itself would scale by one step less than it
/// divides by on the way back.
[[nodiscard]] inline int pcm_code(double x, int bits) noexcept {
  const double half = std::ldexp(1.0, bits - 1);
  const double code = std::clamp(std::nearbyint(x * half), -half, half - 1);
  return static_cast<int>(std::ldexp(code, 32 - bits));
}

[[nodiscard]] inline std::string write_frames(SNDFILE* file, const recording& from) {
  const std::size_t width = from.channels.size();
  const int bits = from.bits > 24 ? 32 : from.bits > 16 ? 24 : 16;
  std::vector<double> reals(from.float_format ? width : 0);
  std::vector<int> codes(width);
  for (std::size_t i = 0; i < from.frames(); ++i) {
    for (std::size_t c = 0; c < width; ++c) {
      if (from.float_format) reals[c] = from.channels[c][i];
      else codes[c] = pcm_code(from.channels[c][i], bits);
    }
    const sf_count_t written = from.float_format ? sf_writef_double(file, reals.data(), 1) : sf_writef_int(file, codes.data(), 1);
    if (written != 1) return sf_strerror(file);
  }
  return {};
}

}  // namespace detail

/// A WAV file (RF64 where it is too large for one) of from.bits: 16, 24 or 32 PCM, or 32 or 64 floating point. What lies
/// beyond full scale is clipped in PCM. Empty: it is there.
[[nodiscard]] inline std::optional<failure> write_audio(const std::string& path, const recording& from, overwrite existing) {
  for (const auto& channel : from.channels)
    if (channel.size() != from.frames()) return failure{path + ": the channels are not of one length"};
  if (from.frames() == 0) return failure{path + ": there are no samples to write"};
  SF_INFO info{};
  info.samplerate = static_cast<int>(std::lround(from.sample_rate_Hz));
  info.channels = static_cast<int>(from.channels.size());
  info.format = detail::wav_format(from);
  return replace_file(path, existing, [&](const std::string& part) {
    const detail::sndfile_handle file{sf_open(part.c_str(), SFM_WRITE, &info)};
    if (!file) return std::string{"cannot be written: "} + sf_strerror(nullptr);
    sf_command(file.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);  // holds the time: the same samples, another file
    return detail::write_frames(file.get(), from);
  });
}

}  // namespace rosin
