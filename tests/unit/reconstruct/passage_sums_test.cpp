// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/passage_sums.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace reconstruct_passage_sums {

namespace {

template <class T>
T number(std::size_t i) {
  return static_cast<T>(std::sin(1.3 * static_cast<double>(i * i % 511)));
}

}  // namespace

TEST_CASE("a doubled line holds the latest frames in a row, however they were pushed") {
  rosin::doubled_lines<double, 2, 11> line;
  double next = 1;
  for (int round = 0; round < 40; ++round) {
    if (round % 3 == 0) {
      line.push(std::array<std::array<double, 1>, 2>{{{next}, {-next}}});
      next += 1;
    } else {
      std::array<std::array<double, 4>, 2> block{};
      for (std::size_t i = 0; i < 4; ++i) {
        block[0][i] = next;
        block[1][i] = -next;
        next += 1;
      }
      line.push(block);
    }
    if (next < 12) continue;
    const double *a = line.at(0, 10), *b = line.at(1, 10);
    for (std::size_t i = 0; i < 11; ++i) {
      CHECK(a[i] == next - 11 + static_cast<double>(i));
      CHECK(b[i] == -a[i]);
    }
  }
}

TEST_CASE_TEMPLATE("sums in registers are the plain sums", T, float, double) {
  constexpr std::size_t lanes = rosin::register_lanes<T>, chunk = rosin::detail::passage_chunk<T>,
                        quantum = rosin::detail::passage_quantum<T>;
  std::vector<T> taps(6 * quantum), x(6 * quantum + chunk);
  for (std::size_t i = 0; i < taps.size(); ++i) taps[i] = number<T>(i);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = number<T>(i + 77);
  const T tolerance = 100 * std::numeric_limits<T>::epsilon();
  for (std::size_t count = 0; count <= taps.size(); count += quantum) {
    std::array<T, chunk> out;
    rosin::detail::passage_fir(taps.data(), x.data(), count, out.data());
    std::array<typename rosin::lanes_of<T, lanes>::type, 4> spread;
    for (std::size_t p = 0; p < 4; ++p) spread[p] = rosin::detail::passage_dot(taps.data(), x.data() + p, count);
    const std::array<T, 4> four = rosin::detail::four_sums_of_lanes<T, lanes>(spread);
    for (std::size_t i = 0; i < chunk; ++i) {
      T plain = 0;
      for (std::size_t j = 0; j < count; ++j) plain += taps[j] * x[i + j];
      CHECK(std::abs(out[i] - plain) <= tolerance);
      if (i >= 4) continue;
      CHECK(std::abs(four[i] - plain) <= tolerance);
      CHECK(std::abs(rosin::detail::sum_of_lanes<T, lanes>(spread[i]) - plain) <= tolerance);
    }
  }
}

TEST_CASE_TEMPLATE("a window moves on by one", T, float, double) {
  constexpr std::size_t count = 2 * rosin::detail::passage_quantum<T>;
  using vector = typename rosin::lanes_of<T, rosin::register_lanes<T>>::type;
  std::array<T, count> window{}, taps;
  for (std::size_t j = 0; j < count; ++j) taps[j] = static_cast<T>(j % 7) - T(3);
  vector before{};
  if constexpr (rosin::register_lanes<T> == 1) before = T(5);
  else before[0] = T(5);
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const vector spread = rosin::detail::shift_dot(window.data(), taps.data(), count, static_cast<T>(i + 1), before);
    const T sum = rosin::detail::sum_of_lanes<T, rosin::register_lanes<T>>(spread);
    T plain = 5;
    for (std::size_t j = 0; j < count; ++j) {
      CHECK(window[j] == (i + j + 2 > count ? static_cast<T>(i + j + 2 - count) : T(0)));
      plain += taps[j] * window[j];
    }
    CHECK(sum == plain);
  }
}

}  // namespace reconstruct_passage_sums
