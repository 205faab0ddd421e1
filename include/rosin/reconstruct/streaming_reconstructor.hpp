// tier: freestanding
// SPDX-License-Identifier: MIT
//
// The time-domain reconstruction sample by sample, for live use and firmware: eight short FIR filters over two delay lines of
// fixed length, nothing else. What the filters are is decided beforehand (streaming_design.hpp), so that this part needs no
// heap, no libm and no design code; it gives what reconstructor.hpp gives, later by latency() frames and to rounding.
//
//     {near, far} in newtons  -->  delay lines  -->  8 dot products  -->  {f_near, f_far, v_near, v_far}
//
// Each line is kept twice in a row, so that a dot product never wraps.
//
#pragma once

#include <array>
#include <cstddef>

namespace rosin {

/// Forces on the terminations at one instant, N.
template <class T>
struct termination_frame {
  T near_N{}, far_N{};
};

/// Force and velocity under the bow at one instant: two versions of Eq. (3) in N, two of Eq. (1) in m/s.
template <class T>
struct bow_frame {
  T force_near_N{}, force_far_N{}, velocity_near_m_s{}, velocity_far_m_s{};

  [[nodiscard]] constexpr T force_N() const noexcept { return (force_near_N + force_far_N) / T(2); }
  [[nodiscard]] constexpr T velocity_m_s() const noexcept { return (velocity_near_m_s + velocity_far_m_s) / T(2); }
};

/// One filter: taps in order of arrival (oldest sample first), and the age of the newest sample they touch.
template <class T, std::size_t Taps>
struct streaming_kernel {
  std::array<T, Taps> taps{};
  std::size_t count = 0;
  std::size_t newest_age = 0;
};

/// Everything the run-time part has to be given: filters row by row (output, then near and far), and their look-ahead.
template <class T, std::size_t Taps>
struct streaming_coefficients {
  std::array<streaming_kernel<T, Taps>, 8> kernel{};
  std::size_t latency = 0;  ///< frames
};

/// T: float or double. Taps: longest filter. Line: length of the delay lines, at least the oldest age + 1 (checked in the
/// design).
template <class T, std::size_t Taps, std::size_t Line>
class streaming_reconstructor {
public:
  using input_type = termination_frame<T>;
  using output_type = bow_frame<T>;
  using coefficients_type = streaming_coefficients<T, Taps>;

  constexpr explicit streaming_reconstructor(const coefficients_type& coefficients) noexcept : coefficients_{coefficients} {}

  /// Total on any input; NaN in, NaN out for as long as it stays in a line.
  constexpr output_type operator()(const input_type& frame) noexcept {
    head_ = head_ + 1 == Line ? 0 : head_ + 1;
    line_[0][head_] = line_[0][head_ + Line] = frame.near_N;
    line_[1][head_] = line_[1][head_ + Line] = frame.far_N;
    return {output(0), output(1), output(2), output(3)};
  }

  constexpr void reset() noexcept {
    line_ = {};
    head_ = 0;
  }

  /// Frames by which the output lags: the look-ahead of the longest filter.
  [[nodiscard]] constexpr T latency() const noexcept { return static_cast<T>(coefficients_.latency); }

private:
  [[nodiscard]] constexpr T dot(const streaming_kernel<T, Taps>& k, const std::array<T, 2 * Line>& line) const noexcept {
    const std::size_t oldest = head_ + Line + 1 - k.newest_age - k.count;
    std::array<T, 4> sum{};  // four partial sums: independent, so that the vector unit can have them
    std::size_t j = 0;
    for (; j + 4 <= k.count; j += 4)
      for (std::size_t lane = 0; lane < 4; ++lane) sum[lane] += k.taps[j + lane] * line[oldest + j + lane];
    for (; j < k.count; ++j) sum[0] += k.taps[j] * line[oldest + j];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  [[nodiscard]] constexpr T output(std::size_t which) const noexcept {
    return dot(coefficients_.kernel[2 * which], line_[0]) + dot(coefficients_.kernel[2 * which + 1], line_[1]);
  }

  coefficients_type coefficients_;
  std::array<std::array<T, 2 * Line>, 2> line_{};
  std::size_t head_ = 0;
};

}  // namespace rosin
