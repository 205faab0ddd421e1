// SPDX-License-Identifier: MIT
#include <rosin/torsion/torsion_pair.hpp>

#include <doctest/doctest.h>

#include <initializer_list>

namespace torsion_torsion_pair {

namespace {

constexpr double pair_impedance = 0.6, pair_q = 15;
constexpr std::array<double, 3> pair_delay{2e-5, 3e-6, 6e-5};

bool alike(std::complex<double> a, std::complex<double> b, double relative) { return std::abs(a - b) < relative * std::abs(b); }

}  // namespace

TEST_CASE("torsion pair: both places at one are the torsion of a single contact") {
  for (const auto damping : {rosin::torsion_damping::constant_q, rosin::torsion_damping::viscous_modes}) {
    const rosin::torsion_pair pair({pair_delay[0], 0, pair_delay[2]}, pair_impedance, pair_q, damping, 40);
    const rosin::torsion_waveguide guide{{pair_delay[0], pair_delay[2]}, pair_impedance, pair_q};
    const rosin::torsion_modes modes{guide.delay_s, pair_impedance, pair_q, 40};
    for (const double f : {300.0, 2e3, 6.1e3, 2e4}) {
      const auto h = pair(f);
      const auto one = damping == rosin::torsion_damping::constant_q
                           ? guide(f)
                           : modes(f) + std::complex<double>(0, 6.283185307179586 * f * modes.rest_m_N());
      CHECK(alike(h.aa, one, 1e-9));
      CHECK(alike(h.bb, one, 1e-9));
      CHECK(alike(h.across, one, 1e-9));
    }
  }
}

TEST_CASE("torsion pair: forces and rotations between the two places obey the wave equation") {
  const rosin::torsion_pair pair(pair_delay, pair_impedance, pair_q, rosin::torsion_damping::constant_q, 0);
  for (const double f : {500.0, 4e3, 1.5e4}) {
    const double w = 6.283185307179586 * f;
    const std::complex<double> g(0.5 * w / pair_q, w);
    const auto h = pair(f);
    // A newton at a: towards the far end the motion goes as sinh(g distance to that end), and at a the two sides' forces add up
    // to it.
    CHECK(alike(h.across / h.aa, std::sinh(g * pair_delay[2]) / std::sinh(g * (pair_delay[1] + pair_delay[2])), 1e-9));
    const auto force = h.aa * pair_impedance *
                       (std::cosh(g * pair_delay[0]) / std::sinh(g * pair_delay[0]) +
                        std::cosh(g * (pair_delay[1] + pair_delay[2])) / std::sinh(g * (pair_delay[1] + pair_delay[2])));
    CHECK(alike(force, 1.0, 1e-9));
  }
}

TEST_CASE("torsion pair: viscous modes and a constant Q agree where the Q does not matter") {
  const rosin::torsion_pair waves(pair_delay, pair_impedance, 4000, rosin::torsion_damping::constant_q, 0),
      modes(pair_delay, pair_impedance, 4000, rosin::torsion_damping::viscous_modes, 40);
  for (const double f : {200.0, 1.3e3, 9e3}) {
    const auto a = waves(f), b = modes(f);
    CHECK(alike(b.aa, a.aa, 2e-3));
    CHECK(alike(b.bb, a.bb, 2e-3));
    CHECK(alike(b.across, a.across, 2e-3));
  }
}

}  // namespace torsion_torsion_pair
