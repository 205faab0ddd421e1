// SPDX-License-Identifier: MIT
#include <rosin/torsion/torsion_pair.hpp>

#include <doctest/doctest.h>

#include <initializer_list>

namespace {

constexpr double Z = 0.6, q = 15;
constexpr std::array<double, 3> delay{2e-5, 3e-6, 6e-5};

bool close(std::complex<double> a, std::complex<double> b, double relative) { return std::abs(a - b) < relative * std::abs(b); }

}  // namespace

TEST_CASE("torsion pair: both places at one are the torsion of a single contact") {
  for (const auto damping : {rosin::torsion_damping::constant_q, rosin::torsion_damping::viscous_modes}) {
    const rosin::torsion_pair pair({delay[0], 0, delay[2]}, Z, q, damping);
    const rosin::torsion_waveguide guide{{delay[0], delay[2]}, Z, q};
    const rosin::torsion_modes modes{guide.delay_s, Z, q, 40};
    for (const double f : {300.0, 2e3, 6.1e3, 2e4}) {
      const auto h = pair(f);
      const auto one = damping == rosin::torsion_damping::constant_q ? guide(f) : modes(f) + std::complex<double>(0, 6.283185307179586 * f * modes.rest_m_N());
      CHECK(close(h.aa, one, 1e-9));
      CHECK(close(h.bb, one, 1e-9));
      CHECK(close(h.across, one, 1e-9));
    }
  }
}

TEST_CASE("torsion pair: forces and rotations between the two places obey the wave equation") {
  const rosin::torsion_pair pair(delay, Z, q, rosin::torsion_damping::constant_q);
  for (const double f : {500.0, 4e3, 1.5e4}) {
    const double w = 6.283185307179586 * f;
    const std::complex<double> g(0.5 * w / q, w);
    const auto h = pair(f);
    // A newton at a: towards the far end the motion goes as sinh(g distance to that end), and at a the two sides' forces add up to it.
    CHECK(close(h.across / h.aa, std::sinh(g * delay[2]) / std::sinh(g * (delay[1] + delay[2])), 1e-9));
    const auto force = h.aa * Z * (std::cosh(g * delay[0]) / std::sinh(g * delay[0]) + std::cosh(g * (delay[1] + delay[2])) / std::sinh(g * (delay[1] + delay[2])));
    CHECK(close(force, 1.0, 1e-9));
  }
}

TEST_CASE("torsion pair: viscous modes and a constant Q agree where the Q does not matter") {
  const rosin::torsion_pair waves(delay, Z, 4000, rosin::torsion_damping::constant_q), modes(delay, Z, 4000, rosin::torsion_damping::viscous_modes);
  for (const double f : {200.0, 1.3e3, 9e3}) {
    const auto a = waves(f), b = modes(f);
    CHECK(close(b.aa, a.aa, 2e-3));
    CHECK(close(b.bb, a.bb, 2e-3));
    CHECK(close(b.across, a.across, 2e-3));
  }
}
