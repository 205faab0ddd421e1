// tier: freestanding
// SPDX-License-Identifier: MIT
//
// A delay by any number of samples, sample by sample, in fixed memory:
//
//     y[n] = sum_j weights[j] x[n - whole - j],   j = 0 ... taps - 1
//
// The weights come from an interpolator, a policy that knows how many it needs and computes them from the fraction of a
// sample; the whole samples are the delay line's business. An even number of taps has the wanted instant between its two
// middle ones, where every interpolator is best; so the shortest delay is taps / 2 - 1. Errors by bandwidth are tabled in
// docs/reference/condition/fractional_delay.md.
//
#pragma once

#include <array>
#include <concepts>
#include <cstddef>

namespace rosin {

/// Weights for the value `fraction` (0 ... 1) of a sample before the middle: taps / 2 samples on either side.
template <class I, class T>
concept Interpolator = (I::taps >= 2) && (I::taps % 2 == 0) && requires(T fraction) {
  { I::weights(fraction) }
  noexcept->std::same_as<std::array<T, I::taps>>;
};

/// The polynomial of degree Taps - 1 through the samples: maximally flat at 0 Hz, and nothing but arithmetic.
template <std::size_t Taps>
struct lagrange {
  static constexpr std::size_t taps = Taps;

  template <std::floating_point T>
  [[nodiscard]] static constexpr std::array<T, Taps> weights(T fraction) noexcept {
    std::array<T, Taps> w{};
    const T delay = T(Taps / 2 - 1) + fraction;
    for (std::size_t j = 0; j < Taps; ++j) {
      w[j] = T(1);
      for (std::size_t i = 0; i < Taps; ++i)
        if (i != j) w[j] *= (delay - T(i)) / (T(j) - T(i));
    }
    return w;
  }
};

/// What a delay line has to hold to be late by `delay` samples.
template <class T, std::size_t Taps>
struct delay_taps {
  std::size_t whole;
  std::array<T, Taps> weights;
  T delay;
};

/// The taps in T for a delay in samples, computed in the precision that the delay is given in. Below the
/// interpolator's shortest delay: that one.
template <class T, class I, std::floating_point Delay>
requires Interpolator<I, Delay>
[[nodiscard]] constexpr delay_taps<T, I::taps> design_delay(Delay delay_samples) noexcept {
  constexpr std::size_t least = I::taps / 2 - 1;
  if (!(delay_samples > Delay(least))) delay_samples = Delay(least);
  const std::size_t whole = static_cast<std::size_t>(delay_samples) - least;
  const std::array<Delay, I::taps> weights = I::weights(delay_samples - Delay(whole + least));
  delay_taps<T, I::taps> taps{whole, {}, static_cast<T>(delay_samples)};
  for (std::size_t j = 0; j < I::taps; ++j) taps.weights[j] = static_cast<T>(weights[j]);
  return taps;
}

/// A stage. Holds Capacity samples twice over, so that the taps always lie in one piece: delays below Capacity - taps / 2.
template <class T, class I, std::size_t Capacity>
requires(Capacity >= I::taps) class fractional_delay {
public:
  using input_type = T;
  using output_type = T;
  using taps_type = delay_taps<T, I::taps>;

  static constexpr T least_delay = T(I::taps / 2 - 1);

  constexpr explicit fractional_delay(const taps_type& taps) noexcept : taps_{fitted(taps)} {}
  template <std::floating_point Delay>
  constexpr explicit fractional_delay(Delay delay_samples) noexcept : fractional_delay{design_delay<T, I>(delay_samples)} {}

  constexpr T operator()(const T& x) noexcept {
    head_ = (head_ == 0 ? Capacity : head_) - 1;
    line_[head_] = line_[head_ + Capacity] = x;
    T sum{};
    for (std::size_t j = 0; j < I::taps; ++j) sum += taps_.weights[j] * line_[head_ + taps_.whole + j];
    return sum;
  }

  /// Another delay from the next sample on; the line keeps what it holds.
  constexpr void set(const taps_type& taps) noexcept { taps_ = fitted(taps); }

  constexpr void reset() noexcept {
    line_ = {};
    head_ = 0;
  }

  /// Samples, exact at low frequency.
  [[nodiscard]] constexpr T latency() const noexcept { return taps_.delay; }

private:
  /// Too long a delay becomes the longest one that fits.
  static constexpr taps_type fitted(taps_type taps) noexcept {
    constexpr std::size_t most = Capacity - I::taps;
    if (taps.whole > most) {
      taps.delay -= T(taps.whole - most);
      taps.whole = most;
    }
    return taps;
  }

  taps_type taps_;
  std::array<T, 2 * Capacity> line_{};  // newest first, from head_
  std::size_t head_ = 0;
};

}  // namespace rosin
