// SPDX-License-Identifier: MIT
#include <rosin/math/lanes.hpp>

#include <doctest/doctest.h>

#include <array>
#include <complex>
#include <cstddef>
#include <limits>

static_assert(sizeof(rosin::lane_complex<float, 1>) == 2 * sizeof(float));
static_assert(sizeof(rosin::lane_complex<double, rosin::register_lanes<double>>) ==
              2 * rosin::register_lanes<double> * sizeof(double));

namespace {

template <class T, std::size_t Count>
void arithmetic_is_that_of_complex_numbers() {
  using lanes = rosin::lane_complex<T, Count>;
  std::array<T, 2 * Count> a{}, b{}, out{};
  for (std::size_t i = 0; i < 2 * Count; ++i) {
    a[i] = static_cast<T>(i) + T(0.5);
    b[i] = T(3) - static_cast<T>(i * i);
  }
  const T w[2] = {T(0.25), T(-2)};
  const std::complex<T> factor{w[0], w[1]}, i{T(0), T(1)};
  const lanes x = lanes::load(a.data()), y = lanes::load(b.data());
  const auto check = [&](const lanes& z, auto expected) {
    z.store(out.data());
    for (std::size_t lane = 0; lane < Count; ++lane) {
      const std::complex<T> p{a[lane], a[Count + lane]}, q{b[lane], b[Count + lane]};
      CHECK(std::abs(std::complex<T>{out[lane], out[Count + lane]} - expected(p, q)) <=
            T(400) * std::numeric_limits<T>::epsilon());
    }
  };
  check(x + y, [](auto p, auto q) { return p + q; });
  check(x - y, [](auto p, auto q) { return p - q; });
  check(plus_i(x, y), [&](auto p, auto q) { return p + i * q; });
  check(minus_i(x, y), [&](auto p, auto q) { return p - i * q; });
  check(x.times(w), [&](auto p, auto) { return p * factor; });
  check(x.times_conj(w), [&](auto p, auto) { return p * std::conj(factor); });
  check(x.conj(), [](auto p, auto) { return std::conj(p); });
}

}  // namespace

TEST_CASE_TEMPLATE("a register computes with complex numbers side by side", T, float, double) {
  arithmetic_is_that_of_complex_numbers<T, 1>();
  arithmetic_is_that_of_complex_numbers<T, rosin::register_lanes<T>>();
}

namespace {

template <class T, std::size_t Count>
void a_tile_is_transposed() {
  constexpr std::size_t from_stride = 2 * Count + 1, to_stride = Count + 3;
  std::array<T, from_stride * Count> from{};
  std::array<T, to_stride * Count> to{};
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<T>(i);
  rosin::transpose<T, Count>(from.data(), from_stride, to.data(), to_stride);
  for (std::size_t r = 0; r < Count; ++r)
    for (std::size_t c = 0; c < to_stride; ++c) CHECK(to[r * to_stride + c] == (c < Count ? from[c * from_stride + r] : T(0)));
}

}  // namespace

TEST_CASE_TEMPLATE("a tile is transposed", T, float, double) {
  a_tile_is_transposed<T, 1>();
  a_tile_is_transposed<T, rosin::register_lanes<T>>();
}
