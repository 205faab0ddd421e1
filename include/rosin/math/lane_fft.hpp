// tier: hosted
// SPDX-License-Identifier: MIT
//
// Several complex transforms of one power-of-two length at once, one in each lane of the vector registers. No
// shuffling is ever needed, so plain source code runs at the speed of the vector unit. Forward is decimation in
// frequency, inverse is decimation in time, both radix 4 and in place (W. M. Gentleman and G. Sande, Proc. AFIPS 29,
// 1966, 563): the bins stay in the order in which the first leaves and the second takes them, and nothing is ever
// sorted. That is all a convolution needs, and a convolution is what this transform is for; spectra to be looked at are
// the business of fft.hpp. The recursion goes depth first, so that every part fits the cache before it is done.
//
#pragma once

#include <rosin/math/lanes.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace rosin {

/// `lanes` transforms of n points, n a power of two >= 2. Point j: `lanes` real parts at data[2 j lanes], then the imaginary
/// parts.
template <class T, std::size_t Lanes = register_lanes<T>>
class lane_fft {
public:
  static constexpr std::size_t lanes = Lanes;

  explicit lane_fft(std::size_t n) : size_{n} {
    for (std::size_t m = n; m > 4; m /= 4) {
      std::vector<T>& level = twiddles_.emplace_back();
      for (std::size_t p = 0; p < m / 4; ++p)
        for (std::size_t r = 1; r < 4; ++r) {
          const double angle = -2 * std::numbers::pi * static_cast<double>(r * p) / static_cast<double>(m);
          level.push_back(static_cast<T>(std::cos(angle)));
          level.push_back(static_cast<T>(std::sin(angle)));
        }
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// Where bin k stands: the digits of k (radix 4, the last one perhaps radix 2) in reverse.
  [[nodiscard]] std::size_t position(std::size_t k) const noexcept {
    std::size_t at = 0;
    for (std::size_t m = size_; m > 1;) {
      const std::size_t radix = m == 2 ? 2 : 4;
      m /= radix;
      at += k % radix * m;
      k /= radix;
    }
    return at;
  }

  /// In place; bin k at position(k).
  void forward(T* data) const noexcept { forward(data, size_, 0); }
  /// In place, takes what forward leaves; not scaled: n times the data that were transformed.
  void inverse(T* data) const noexcept { inverse(data, size_, 0); }

private:
  using complex = lane_complex<T, Lanes>;
  static constexpr std::size_t step = 2 * Lanes;

  void forward(T* x, std::size_t n, std::size_t level) const noexcept {
    if (n == 2) return butterfly2(x);
    const std::size_t quarter = n / 4 * step;
    if (n == 4) {
      const sums s{x, quarter};
      s.even.store(x), s.minus_even.store(x + 2 * quarter);
      minus_i(s.odd, s.cross).store(x + quarter), plus_i(s.odd, s.cross).store(x + 3 * quarter);
      return;
    }
    const T* w = twiddles_[level].data();
    for (T* q = x; q != x + quarter; q += step, w += 6) {
      const sums s{q, quarter};
      s.even.store(q);
      minus_i(s.odd, s.cross).times(w).store(q + quarter);
      s.minus_even.times(w + 2).store(q + 2 * quarter);
      plus_i(s.odd, s.cross).times(w + 4).store(q + 3 * quarter);
    }
    for (std::size_t r = 0; r < 4; ++r) forward(x + r * quarter, n / 4, level + 1);
  }

  void inverse(T* x, std::size_t n, std::size_t level) const noexcept {
    if (n == 2) return butterfly2(x);
    const std::size_t quarter = n / 4 * step;
    if (n > 4)
      for (std::size_t r = 0; r < 4; ++r) inverse(x + r * quarter, n / 4, level + 1);
    static constexpr T one[6] = {1, 0, 1, 0, 1, 0};
    const T* w = n > 4 ? twiddles_[level].data() : one;
    for (T* q = x; q != x + quarter; q += step, w += 6) {
      const sums s{complex::load(q), complex::load(q + quarter).times_conj(w), complex::load(q + 2 * quarter).times_conj(w + 2),
                   complex::load(q + 3 * quarter).times_conj(w + 4)};
      s.even.store(q), s.minus_even.store(q + 2 * quarter);
      plus_i(s.odd, s.cross).store(q + quarter), minus_i(s.odd, s.cross).store(q + 3 * quarter);
    }
  }

  /// What a butterfly of four shares: (a + c) +- (b + d), a - c, b - d.
  struct sums {
    [[gnu::always_inline]] sums(const T* x, std::size_t quarter) noexcept
        : sums{complex::load(x), complex::load(x + quarter), complex::load(x + 2 * quarter), complex::load(x + 3 * quarter)} {}
    [[gnu::always_inline]] sums(const complex& a, const complex& b, const complex& c, const complex& d) noexcept
        : even{(a + c) + (b + d)}, minus_even{(a + c) - (b + d)}, odd{a - c}, cross{b - d} {}
    complex even, minus_even, odd, cross;
  };

  static void butterfly2(T* x) noexcept {
    const complex a = complex::load(x), b = complex::load(x + step);
    (a + b).store(x), (a - b).store(x + step);
  }

  std::size_t size_;
  std::vector<std::vector<T>> twiddles_;  // per level m = n, n/4, ...: w^p, w^2p, w^3p with w = exp(-2 pi i / m)
};

}  // namespace rosin
