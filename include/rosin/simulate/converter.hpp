// tier: hosted
// SPDX-License-Identifier: MIT
//
// From newtons at a termination to the numbers in a recording:
//
//     force -> sensor's gain -> high-pass of an AC-coupled amplifier -> + hum + white noise -> converter
//
// The high-pass y' = x' - w y is exact for a force that runs straight from sample to sample, and has settled before the
// first one. Codes are rounded to the nearest and stop at the ends of the range. Noise is made by Box and Muller's
// formula from a 64-bit Mersenne twister, so that a seed means the same recording with every standard library.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Standard normal deviates, the same on every platform.
class gaussian_source {
public:
  explicit gaussian_source(std::uint64_t seed) : twister_{seed} {}

  /// Uniform in (0, 1).
  double uniform() { return (static_cast<double>(twister_() >> 11) + 0.5) * 0x1p-53; }
  /// Uniform in (low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double operator()() {
    constexpr double pi = 3.14159265358979323846;
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return radius * std::cos(2 * pi * uniform());
  }

private:
  std::mt19937_64 twister_;
};

/// One line of the mains' spectrum.
struct hum_line {
  double frequency_Hz = 50;
  double amplitude_N = 0;
  double phase_rad = 0;
};

/// A force sensor with its amplifier and converter.
struct converter {
  double gain = 1;                    ///< true over declared sensitivity
  double newtons_per_full_scale = 2;  ///< as declared: what the largest code is said to mean
  double noise_N = 0;                 ///< standard deviation of the white noise, at the converter
  double ac_coupled_Hz = 0;           ///< corner of the high-pass; 0: none
  std::vector<hum_line> hum{};
  int bits = 16;  ///< 2 to 32
};

/// A recorded channel.
struct converted_channel {
  std::vector<std::int32_t> codes{};
  double newtons_per_full_scale = 1;
  int bits = 16;
  std::size_t clipped = 0;  ///< samples that would not fit

  [[nodiscard]] std::size_t size() const noexcept { return codes.size(); }
  /// Sample as a share of full scale, in [-1, 1).
  [[nodiscard]] double share(std::size_t n) const noexcept { return std::ldexp(static_cast<double>(codes[n]), 1 - bits); }
  /// All samples in newtons, by the declared sensitivity.
  [[nodiscard]] std::vector<double> newtons() const {
    std::vector<double> forces(codes.size());
    for (std::size_t n = 0; n < codes.size(); ++n) forces[n] = share(n) * newtons_per_full_scale;
    return forces;
  }
};

namespace detail {

/// s / (s + w) for an input that is straight between samples; at rest before the first sample.
class settled_high_pass {
public:
  settled_high_pass(double corner_Hz, double sample_rate_Hz, double at_rest) : last_{at_rest} {
    constexpr double pi = 3.14159265358979323846;
    const double x = 2 * pi * corner_Hz / sample_rate_Hz;
    decay_ = std::exp(-x);
    slope_ = x > 0 ? -std::expm1(-x) / x : 1;
    through_ = !(x > 0);
  }
  double operator()(double x) noexcept {
    if (through_) return x;
    state_ = decay_ * state_ + slope_ * (x - last_);
    last_ = x;
    return state_;
  }

private:
  double decay_, slope_, last_, state_ = 0;
  bool through_;
};

}  // namespace detail

/// Records a force. Needs 2 <= bits <= 32 and a positive sensitivity.
[[nodiscard]] inline converted_channel convert(std::span<const double> force_N, double sample_rate_Hz, const converter& with,
                                               std::uint64_t seed) {
  constexpr double pi = 3.14159265358979323846;
  converted_channel out{{}, with.newtons_per_full_scale, with.bits, 0};
  out.codes.reserve(force_N.size());
  gaussian_source noise{seed};
  detail::settled_high_pass couple{with.ac_coupled_Hz, sample_rate_Hz, force_N.empty() ? 0 : with.gain * force_N[0]};
  const double codes_per_newton = std::ldexp(1.0, with.bits - 1) / with.newtons_per_full_scale;
  const double lowest = -std::ldexp(1.0, with.bits - 1), highest = -lowest - 1;
  for (std::size_t n = 0; n < force_N.size(); ++n) {
    double newtons = couple(with.gain * force_N[n]) + with.noise_N * noise();
    for (const auto& line : with.hum)
      newtons +=
          line.amplitude_N * std::cos(2 * pi * line.frequency_Hz * static_cast<double>(n) / sample_rate_Hz + line.phase_rad);
    const double code = std::nearbyint(newtons * codes_per_newton);
    out.clipped += code >= lowest && code <= highest ? 0 : 1;
    out.codes.push_back(static_cast<std::int32_t>(code >= lowest ? std::min(code, highest) : lowest));
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
