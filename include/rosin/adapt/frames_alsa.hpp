// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames from a sound card or any other digitiser that Linux knows as an ALSA capture device. What is asked for is what has to
// come: no resampling, no other number of channels, no fewer bits. After an overrun the device is started again; how long
// it stood still is taken from the clock, so the length of that gap is right to some milliseconds, and said to be an estimate.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <alsa/asoundlib.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

struct close_alsa {
  void operator()(snd_pcm_t* pcm) const noexcept { snd_pcm_close(pcm); }
};

/// Formats that hold so many bits, the narrowest first.
[[nodiscard]] inline std::vector<snd_pcm_format_t> alsa_formats(const frame_format& f) {
  if (f.float_format) return {SND_PCM_FORMAT_FLOAT_LE};
  if (f.bits <= 16) return {SND_PCM_FORMAT_S16_LE};
  if (f.bits <= 24) return {SND_PCM_FORMAT_S24_3LE, SND_PCM_FORMAT_S24_LE, SND_PCM_FORMAT_S32_LE};
  return {SND_PCM_FORMAT_S32_LE};
}

/// One sample, little endian, as a fraction of full scale.
[[nodiscard]] inline double alsa_sample(const std::uint8_t* at, snd_pcm_format_t format) noexcept {
  const auto number = [&](int bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value |= std::uint32_t{at[i]} << (8 * i);
    return value;
  };
  const auto left_aligned = [](std::uint32_t bits) { return static_cast<double>(static_cast<std::int32_t>(bits)) * 0x1p-31; };
  switch (format) {
    case SND_PCM_FORMAT_S16_LE:
      return left_aligned(number(2) << 16U);
    case SND_PCM_FORMAT_S24_3LE:
      return left_aligned(number(3) << 8U);
    case SND_PCM_FORMAT_S24_LE:
      return left_aligned(number(4) << 8U);
    case SND_PCM_FORMAT_S32_LE:
      return left_aligned(number(4));
    default:
      break;
  }
  const std::uint32_t bits = number(4);
  float value = 0;
  std::copy_n(reinterpret_cast<const char*>(&bits), sizeof value, reinterpret_cast<char*>(&value));
  return static_cast<double>(value);
}

}  // namespace detail

/// A FrameSource.
class alsa_source {
public:
  /// device: "hw:1,0", or any name of the ALSA configuration.
  [[nodiscard]] static outcome<alsa_source> open(const std::string& device, const frame_format& wanted) {
    snd_pcm_t* raw = nullptr;
    if (const int error = snd_pcm_open(&raw, device.c_str(), SND_PCM_STREAM_CAPTURE, 0); error < 0)
      return failure{"alsa " + device + ": " + snd_strerror(error)};
    alsa_source out{raw, device, wanted};
    if (auto bad = out.configure()) return *bad;
    if (const int error = snd_pcm_start(raw); error < 0) return out.failed("start", error);
    return out;
  }

  [[nodiscard]] frame_format format() const noexcept { return format_; }

  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    const auto width = static_cast<std::size_t>(format_.channels), wanted = interleaved.size() / width;
    if (const int ready = snd_pcm_wait(pcm_.get(), static_cast<int>(patience.count())); ready == 0) return {};
    else if (ready < 0) return recover(ready);
    bytes_.resize(wanted * width * stride_);
    const auto there = snd_pcm_avail_update(pcm_.get());
    if (there < 0) return recover(static_cast<int>(there));
    const auto most = std::min<std::size_t>(wanted, std::max<std::size_t>(1, static_cast<std::size_t>(there)));
    const auto got = snd_pcm_readi(pcm_.get(), bytes_.data(), most);
    if (got == -EAGAIN) return {};
    if (got < 0) return recover(static_cast<int>(got));
    const auto frames = static_cast<std::size_t>(got);
    for (std::size_t i = 0; i < frames * width; ++i) interleaved[i] = detail::alsa_sample(&bytes_[i * stride_], sample_);
    last_ = std::chrono::steady_clock::now();
    return {frames, std::exchange(lost_, 0), false, std::exchange(problem_, {})};
  }

private:
  alsa_source(snd_pcm_t* pcm, std::string device, const frame_format& format)
      : pcm_{pcm}, device_{std::move(device)}, format_{format} {
    format_.live = true;
  }

  [[nodiscard]] failure failed(const std::string& what, int error) const {
    return failure{"alsa " + device_ + ": " + what + ": " + snd_strerror(error)};
  }

  [[nodiscard]] std::optional<failure> configure() {
    snd_pcm_hw_params_t* hw = nullptr;
    snd_pcm_hw_params_alloca(&hw);
    snd_pcm_t* pcm = pcm_.get();
    if (const int error = snd_pcm_hw_params_any(pcm, hw); error < 0) return failed("has no configuration", error);
    snd_pcm_hw_params_set_rate_resample(pcm, hw, 0);
    if (const int error = snd_pcm_hw_params_set_access(pcm, hw, SND_PCM_ACCESS_RW_INTERLEAVED); error < 0)
      return failed("interleaved frames", error);
    if (const int error = snd_pcm_hw_params_set_channels(pcm, hw, static_cast<unsigned>(format_.channels)); error < 0)
      return failed(std::to_string(format_.channels) + " channels", error);
    const auto rate = static_cast<unsigned>(std::lround(format_.sample_rate_Hz));
    if (const int error = snd_pcm_hw_params_set_rate(pcm, hw, rate, 0); error < 0)
      return failed(std::to_string(rate) + " Hz", error);
    const auto formats = detail::alsa_formats(format_);
    const auto one =
        std::find_if(formats.begin(), formats.end(), [&](auto f) { return snd_pcm_hw_params_set_format(pcm, hw, f) == 0; });
    if (one == formats.end())
      return failed(std::to_string(format_.bits) + (format_.float_format ? " bits, floating point" : " bits"), -EINVAL);
    sample_ = *one;
    stride_ = static_cast<std::size_t>(snd_pcm_format_physical_width(sample_)) / 8;
    snd_pcm_uframes_t buffer = rate / 2, period = rate / 100;
    snd_pcm_hw_params_set_period_size_near(pcm, hw, &period, nullptr);
    snd_pcm_hw_params_set_buffer_size_near(pcm, hw, &buffer);
    if (const int error = snd_pcm_hw_params(pcm, hw); error < 0) return failed("cannot be set up", error);
    last_ = std::chrono::steady_clock::now();
    return std::nullopt;
  }

  /// After an overrun (or a suspended machine) it goes on, with a gap; a device that was pulled is over.
  [[nodiscard]] frame_read recover(int error) {
    if (error != -EPIPE && error != -ESTRPIPE) return {0, 0, true, failed("the device is gone", error).message};
    if (const int again = snd_pcm_recover(pcm_.get(), error, 1); again < 0) return {0, 0, true, failed("overrun", again).message};
    if (const int again = snd_pcm_start(pcm_.get()); again < 0) return {0, 0, true, failed("overrun", again).message};
    const std::chrono::duration<double> still = std::chrono::steady_clock::now() - last_;
    lost_ += static_cast<std::uint64_t>(std::llround(still.count() * format_.sample_rate_Hz));
    problem_ = failed("overrun, length of the gap estimated", error).message;
    last_ = std::chrono::steady_clock::now();
    return {};
  }

  std::unique_ptr<snd_pcm_t, detail::close_alsa> pcm_;
  std::string device_;
  frame_format format_;
  snd_pcm_format_t sample_ = SND_PCM_FORMAT_S16_LE;
  std::size_t stride_ = 2;
  std::vector<std::uint8_t> bytes_;
  std::chrono::steady_clock::time_point last_;
  std::uint64_t lost_ = 0;
  std::string problem_;
};

static_assert(FrameSource<alsa_source>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
