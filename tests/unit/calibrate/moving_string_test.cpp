// SPDX-License-Identifier: MIT
#include <rosin/calibrate/moving_string.hpp>
#include <rosin/propagate/transmission.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace {

using complex = std::complex<double>;
constexpr double epsilon = 3.8e-12;
const rosin::loss_law loss{800, 1e-9, 0};
const std::array<complex, 2> z{complex(0.3, -0.2), complex(0.05, 0.1)};

}  // namespace

TEST_CASE("an ideal string under a force at s: sinh over sinh") {
  const complex s(200, 2 * std::numbers::pi * 1300);
  const rosin::passage_at p(s, 0, {});
  const double near = 0.4e-3, far = 1.1e-3;
  const auto r = rosin::moving_string(p, {near * p.gamma_per_s, far * p.gamma_per_s}, {0, 0});
  CHECK(std::abs(p.gamma_per_s - s) < 1e-9 * std::abs(s));
  CHECK(std::abs(r.force[0] - std::sinh(s * far) / std::sinh(s * (near + far))) < 1e-12);
  CHECK(std::abs(r.force[1] - std::sinh(s * near) / std::sinh(s * (near + far))) < 1e-12);
}

TEST_CASE("a spring under the end of an ideal string is so much more string, at low frequencies") {
  const complex s(20, 100);
  const rosin::passage_at p(s, 0, {});
  const double near = 0.4e-3, far = 1.1e-3, more = 2e-5;
  const auto spring = rosin::moving_string(p, {near * p.gamma_per_s, far * p.gamma_per_s}, {more * s, 0.0});
  const auto longer = rosin::moving_string(p, {(near + more) * p.gamma_per_s, far * p.gamma_per_s}, {0, 0});
  CHECK(std::abs(spring.force[0] - longer.force[0]) < 1e-5);
  CHECK(std::abs(spring.force[1] - longer.force[1]) < 1e-5);
}

TEST_CASE("the derivatives are those of the forces") {
  const complex s(300, 2 * std::numbers::pi * 5200);
  const rosin::passage_at p(s, epsilon, loss);
  const std::array<complex, 2> theta{0.3e-3 * p.gamma_per_s, 0.5e-3 * p.gamma_per_s};
  const auto r = rosin::moving_string(p, theta, z);
  const double h = 1e-6;
  for (std::size_t by = 0; by < 2; ++by) {
    auto t1 = theta, t2 = theta, z1 = z, z2 = z;
    t1[by] += h, t2[by] -= h, z1[by] += h, z2[by] -= h;
    const auto a = rosin::moving_string(p, t1, z), b = rosin::moving_string(p, t2, z), c = rosin::moving_string(p, theta, z1),
               d = rosin::moving_string(p, theta, z2);
    for (std::size_t j = 0; j < 2; ++j) {
      CHECK(std::abs((a.force[j] - b.force[j]) / (2 * h) - r.by_phase[j][by]) < 1e-7);
      CHECK(std::abs((c.force[j] - d.force[j]) / (2 * h) - r.by_admittance[j][by]) < 1e-7);
    }
  }
}

TEST_CASE("at real frequencies a passage is that of the reconstruction, causal loss included") {
  const rosin::loss_law causal{.quality = 300, .causality = 1, .drag_Hz = 0.1, .reference_Hz = 440};
  for (const double f : {300.0, 5200.0, -5200.0}) {
    const rosin::passage_at p({0, 2 * std::numbers::pi * f}, epsilon, causal);
    const complex there = rosin::propagation_rate(std::abs(f), epsilon, causal);
    CHECK(std::abs(p.gamma_per_s - (f > 0 ? there : std::conj(there))) < 1e-9 * std::abs(there));
  }
}
