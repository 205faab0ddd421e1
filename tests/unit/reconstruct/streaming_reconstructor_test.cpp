// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include <rosin/core/stage.hpp>
#include <rosin/reconstruct/streaming_design.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace reconstruct_streaming_reconstructor {

namespace {

constexpr double rate_Hz = 128e3;
const rosin::band limits{30e3, 52e3};

rosin::bow_point contact() { return rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {1000, 1e-9, 0}}, 0.3); }

/// Two noisy forces, reproducible without a generator.
std::vector<double> forces(int seed, std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::sin(1.7 * static_cast<double>(i * i % 1013) + seed);
  return x;
}

}  // namespace

static_assert(rosin::Stage<rosin::streaming_reconstructor<float, 64, 128>>);

TEST_CASE_TEMPLATE("sample by sample it is the whole-record result, late by the stated latency", T, float, double) {
  constexpr std::size_t n = 3000;
  const std::vector<double> near = forces(1, n), far = forces(2, n);
  const double error = 1e-4;
  const auto designed = rosin::design_streaming<T, 512, 1024>(contact(), {1.02, 0.97}, limits, rate_Hz, error);
  REQUIRE(designed);
  rosin::streaming_reconstructor<T, 512, 1024> stream{*designed};

  std::vector<double> near_N = near, far_N = far;
  for (double& x : near_N) x /= 1.02;
  for (double& x : far_N) x /= 0.97;
  rosin::reconstructor<double> whole(contact(), limits, rate_Hz, error);
  const rosin::bow_motion<double> motion = whole(near_N, far_N);

  const auto late = static_cast<std::size_t>(stream.latency());
  CHECK(late >= static_cast<std::size_t>(contact().delay_s[1] * rate_Hz));  // no look-ahead below the longer passage
  const double tolerance = 400 * static_cast<double>(std::numeric_limits<T>::epsilon());
  for (std::size_t i = 0; i < n; ++i) {
    const auto out = stream({static_cast<T>(near[i]), static_cast<T>(far[i])});
    if (i < motion.known.begin + late || i - late >= motion.known.end) continue;
    const std::size_t at = i - late;
    CHECK(std::abs(static_cast<double>(out.force_near_N) - motion.force_near_N[at]) < tolerance);
    CHECK(std::abs(static_cast<double>(out.force_far_N) - motion.force_far_N[at]) < tolerance);
    CHECK(std::abs(static_cast<double>(out.velocity_near_m_s) - motion.velocity_near_m_s[at]) < tolerance * 10);
    CHECK(std::abs(static_cast<double>(out.velocity_m_s()) - motion.velocity_m_s(at)) < tolerance * 10);
  }
}

TEST_CASE("reset brings back the beginning, and a NaN leaves when it has left the line") {
  const auto designed = rosin::design_streaming<float, 512, 1024>(contact(), {1, 1}, limits, rate_Hz, 1e-3);
  REQUIRE(designed);
  rosin::streaming_reconstructor<float, 512, 1024> a{*designed}, b{*designed};
  a({std::numeric_limits<float>::quiet_NaN(), 1.0F});
  bool seen = false;
  for (int i = 0; i < 200; ++i) seen = seen || std::isnan(a({0.0F, 0.0F}).force_N());
  CHECK(seen);
  a.reset();
  b.reset();
  for (int i = 0; i < 700; ++i) {
    const rosin::termination_frame<float> in{static_cast<float>(i % 7), static_cast<float>(i % 5)};
    CHECK(a(in).force_far_N == b(in).force_far_N);
  }
  a({std::numeric_limits<float>::quiet_NaN(), 0.0F});
  rosin::bow_frame<float> last{};
  for (int i = 0; i < 1024; ++i) last = a({0.0F, 0.0F});
  CHECK(std::isfinite(last.force_N()));
}

}  // namespace reconstruct_streaming_reconstructor
