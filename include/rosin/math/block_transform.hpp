// tier: hosted
// SPDX-License-Identifier: MIT
//
// One face for the two kinds of transform that a block convolution can run on: lane_fft, which transforms several blocks
// side by side and keeps its own order of bins, and any ComplexFft, which transforms one and keeps the natural order.
//
#pragma once

#include <rosin/math/fft_policy.hpp>

#include <Eigen/Core>

#include <complex>
#include <concepts>
#include <cstddef>
#include <vector>

namespace rosin {

/// F transforms F::lanes blocks in place, bin k at position(k); inverse(forward(x)) = size() x.
template <class F, class T>
concept LaneFft = std::movable<F> && std::constructible_from<F, std::size_t> && requires(const F& fft, T* data, std::size_t bin) {
  { F::lanes } -> std::convertible_to<std::size_t>;
  { fft.size() }
  noexcept->std::same_as<std::size_t>;
  { fft.position(bin) }
  noexcept->std::same_as<std::size_t>;
  { fft.forward(data) }
  noexcept;
  { fft.inverse(data) }
  noexcept;
};

/// Point j of the blocks: `lanes` real parts at [2 j lanes], then as many imaginary parts.
template <class T, class Fft>
requires LaneFft<Fft, T> || ComplexFft<Fft, T>
class block_transform {
  static constexpr bool side_by_side = LaneFft<Fft, T>;
  static constexpr std::size_t count_lanes() noexcept {
    if constexpr (side_by_side) return Fft::lanes;
    else return 1;
  }

public:
  static constexpr std::size_t lanes = count_lanes();
  using buffer = std::vector<T, Eigen::aligned_allocator<T>>;

  explicit block_transform(std::size_t n) : fft_(n), scratch_(side_by_side ? 0 : 2 * n) {}

  [[nodiscard]] std::size_t size() const noexcept { return fft_.size(); }
  [[nodiscard]] buffer make_buffer() const { return buffer(2 * lanes * size()); }

  /// inverse(forward(x)) = gain() x.
  [[nodiscard]] double gain() const noexcept { return side_by_side ? static_cast<double>(size()) : 1.0; }

  [[nodiscard]] std::size_t position(std::size_t bin) const noexcept {
    if constexpr (side_by_side) return fft_.position(bin);
    else return bin;
  }

  void forward(buffer& data) noexcept {
    if constexpr (side_by_side) {
      fft_.forward(data.data());
    } else {
      fft_.forward(complex(data), complex(scratch_));
      data.swap(scratch_);
    }
  }

  void inverse(buffer& data) noexcept {
    if constexpr (side_by_side) {
      fft_.inverse(data.data());
    } else {
      fft_.inverse(complex(data), complex(scratch_));
      data.swap(scratch_);
    }
  }

private:
  static std::complex<T>* complex(buffer& x) noexcept { return reinterpret_cast<std::complex<T>*>(x.data()); }

  Fft fft_;
  buffer scratch_;
};

}  // namespace rosin
