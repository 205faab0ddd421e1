// SPDX-License-Identifier: MIT
#include <rosin/math/lane_fft.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

namespace {

template <class T, std::size_t Lanes>
void each_lane_is_a_transform(std::size_t n) {
  CAPTURE(n);
  const rosin::lane_fft<T, Lanes> fft(n);
  rosin::eigen_fft<std::complex<T>> reference(n);
  const std::vector<T> x = laws::noise<T>(2 * n * Lanes, static_cast<unsigned>(n));
  std::vector<T> bins = x;
  fft.forward(bins.data());
  double worst = 0;
  for (std::size_t lane = 0; lane < Lanes; ++lane) {
    std::vector<std::complex<T>> in(n), out(n);
    for (std::size_t j = 0; j < n; ++j) in[j] = {x[2 * j * Lanes + lane], x[(2 * j + 1) * Lanes + lane]};
    reference.forward(in.data(), out.data());
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t at = 2 * fft.position(k) * Lanes + lane;
      worst = std::max(worst, static_cast<double>(std::abs(std::complex<T>{bins[at], bins[at + Lanes]} - out[k])));
    }
  }
  CHECK(worst / std::sqrt(static_cast<double>(n)) < 2 * laws::allowed<T>(n));

  fft.inverse(bins.data());
  worst = 0;
  for (std::size_t j = 0; j < x.size(); ++j)
    worst = std::max(worst, static_cast<double>(std::abs(bins[j] / static_cast<T>(n) - x[j])));
  CHECK(worst < 4 * laws::allowed<T>(n));
}

}  // namespace

TEST_CASE_TEMPLATE("every lane is the transform of its own block", T, float, double) {
  for (std::size_t n = 2; n <= 4096; n *= 2) {
    each_lane_is_a_transform<T, 1>(n);
    each_lane_is_a_transform<T, rosin::register_lanes<T>>(n);
  }
}

TEST_CASE("each bin has a place of its own") {
  const rosin::lane_fft<double, 1> fft(512);
  std::vector<int> taken(512);
  for (std::size_t k = 0; k < 512; ++k) ++taken[fft.position(k)];
  CHECK(taken == std::vector<int>(512, 1));
}
