// SPDX-License-Identifier: MIT
#include <rosin/condition/overlap_save.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "support/approx.hpp"

namespace condition_overlap_save {

namespace {

struct kernel {
  int first;
  std::vector<double> taps;
};

/// inputs x outputs kernels of various spans, some of them looking ahead; one is empty.
std::vector<kernel> kernels_for(std::size_t inputs, std::size_t outputs) {
  std::vector<kernel> kernels;
  for (std::size_t i = 0; i < inputs * outputs; ++i) {
    const int number = static_cast<int>(i);
    kernels.push_back(
        {(number % 3 - 1) * 20 - number, laws::noise<double>(i == 1 ? 0 : 7 + 5 * i, 100 + static_cast<unsigned>(i))});
  }
  return kernels;
}

template <class T>
double by_definition(const std::vector<kernel>& kernels, const std::vector<std::vector<T>>& in, std::size_t output,
                     std::size_t n) {
  double sum = 0;
  for (std::size_t m = 0; m < in.size(); ++m) {
    const kernel& h = kernels[output * in.size() + m];
    for (std::size_t j = 0; j < h.taps.size(); ++j) {
      const auto at = static_cast<std::int64_t>(n) - h.first - static_cast<std::int64_t>(j);
      if (at >= 0 && at < static_cast<std::int64_t>(in[m].size()))
        sum += h.taps[j] * static_cast<double>(in[m][static_cast<std::size_t>(at)]);
    }
  }
  return sum;
}

template <class T>
std::vector<std::vector<T>> run(auto& convolver, const std::vector<std::vector<T>>& in) {
  std::vector<std::vector<T>> out(convolver.outputs(), std::vector<T>(in[0].size(), T(99)));
  const std::vector<std::span<const T>> from(in.begin(), in.end());
  const std::vector<std::span<T>> to(out.begin(), out.end());
  convolver.process(from, to);
  return out;
}

template <class T, class Fft>
void is_the_direct_sum(std::size_t inputs, std::size_t outputs, std::size_t length, std::size_t block) {
  CAPTURE(inputs);
  CAPTURE(outputs);
  CAPTURE(length);
  CAPTURE(block);
  const std::vector<kernel> kernels = kernels_for(inputs, outputs);
  rosin::block_convolver<T, Fft> convolver(inputs, kernels, block);
  std::vector<std::vector<T>> in;
  for (std::size_t m = 0; m < inputs; ++m) in.push_back(laws::noise<T>(length, static_cast<unsigned>(m)));
  const std::vector<std::vector<T>> out = run<T>(convolver, in);
  double worst = 0;
  for (std::size_t p = 0; p < outputs; ++p)
    for (std::size_t n = 0; n < length; ++n)
      worst = std::max(worst, std::abs(static_cast<double>(out[p][n]) - by_definition(kernels, in, p, n)));
  CHECK(worst < 100 * static_cast<double>(std::numeric_limits<T>::epsilon()));
}

}  // namespace

TEST_CASE_TEMPLATE("it is the direct sum to rounding, for any number of channels and any length", T, float, double) {
  using side_by_side = rosin::lane_fft<T>;
  using one_by_one = rosin::eigen_fft<std::complex<T>>;
  for (const std::size_t channels : {1u, 2u, 3u})
    for (const std::size_t length : {1u, 40u, 300u, 4001u}) {
      is_the_direct_sum<T, side_by_side>(channels, 2, length, 0);
      is_the_direct_sum<T, side_by_side>(channels, 1, length, 0);
      is_the_direct_sum<T, one_by_one>(1, channels, length, 64);
      is_the_direct_sum<T, side_by_side>(2, channels, length, 256);
      is_the_direct_sum<T, one_by_one>(channels, 5 - channels, length, 256);
    }
}

TEST_CASE("kernels may lie far from lag zero, beyond the record even") {
  for (const int first : {-5000, -4001, -3000, -300, 300, 3000, 4001, 5000}) {
    CAPTURE(first);
    const std::vector<kernel> shifted{{first, laws::noise<double>(9, 1)}};
    rosin::block_convolver<double> convolver(1, shifted, 64);
    const std::vector<std::vector<double>> in{laws::noise<double>(4001, 2)};
    const std::vector<std::vector<double>> out = run<double>(convolver, in);
    double worst = 0;
    for (std::size_t n = 0; n < in[0].size(); ++n)
      worst = std::max(worst, std::abs(out[0][n] - by_definition(shifted, in, 0, n)));
    CHECK(worst < 1e-14);
    const rosin::sample_range valid = convolver.valid(4001);
    CHECK(valid.begin <= valid.end);
    CHECK(valid.end <= 4001);
  }
}

TEST_CASE("a plan is used again for records of other lengths") {
  const std::vector<kernel> kernels = kernels_for(2, 2);
  rosin::block_convolver<double> convolver(2, kernels);
  const std::vector<std::vector<double>> longer{laws::noise<double>(9000, 1), laws::noise<double>(9000, 2)};
  const std::vector<std::vector<double>> shorter{{longer[0].begin(), longer[0].begin() + 700},
                                                 {longer[1].begin(), longer[1].begin() + 700}};
  const auto before = run<double>(convolver, shorter);
  run<double>(convolver, longer);
  CHECK(run<double>(convolver, shorter) == before);
}

TEST_CASE("valid() counts out what reaches beyond the record") {
  const std::vector<kernel> kernels{{-3, {1, 1, 1, 1, 1, 1}}, {2, {1, 1, 1}}};  // lags -3 ... 4
  rosin::block_convolver<double> convolver(1, kernels);
  CHECK(convolver.valid(100).begin == 4);
  CHECK(convolver.valid(100).end == 97);
  CHECK(convolver.valid(5).begin == convolver.valid(5).end);

  const std::vector<std::vector<double>> ones{std::vector<double>(100, 1.0)};
  const auto out = run<double>(convolver, ones);
  CHECK(out[0][96] == test::approx(6));
  CHECK(out[0][97] == test::approx(5));
  CHECK(out[1][3] == test::approx(2));
  CHECK(out[1][4] == test::approx(3));
}

TEST_CASE("long kernels get long blocks") {
  const std::vector<kernel> kernels{{0, laws::noise<double>(5000, 1)}};
  rosin::block_convolver<double> convolver(1, kernels);
  CHECK(convolver.block_size() >= 10000);
  std::vector<std::vector<double>> click{std::vector<double>(20000)};
  click[0][12345] = 1;
  const auto out = run<double>(convolver, click);
  for (std::size_t j = 0; j < 5000; j += 7) CHECK(out[0][12345 + j] == test::approx(kernels[0].taps[j]).scale(1).epsilon(1e-13));
}

}  // namespace condition_overlap_save
