// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_string.hpp>

#include <doctest/doctest.h>

#include <rosin/propagate/dispersion.hpp>

#include "support/approx.hpp"

namespace simulate_modal_string {

namespace {

constexpr double pi = 3.14159265358979323846;
const rosin::string_parameters e_string{.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 1000, .internal_s = 1e-8}};

}  // namespace

TEST_CASE("mode n lies where the wave on the stiff string fits n half waves in") {
  const auto modes = rosin::transverse_modes(e_string, 250e3);
  REQUIRE(modes.size() > 150);
  CHECK(modes.back().omega_rad_s < 2 * pi * 250e3);
  for (const auto& m : modes) {
    const double k = rosin::phase_rate(m.omega_rad_s, e_string.stiffness_s2()) / e_string.wave_speed_m_s();
    CHECK(k * e_string.length_m == test::approx(m.number * pi).epsilon(1e-10));
    CHECK(m.inverse_quality == test::approx(1e-3 + 1e-8 * m.omega_rad_s / (2 * pi)));
  }
  CHECK(modes[0].omega_rad_s == test::approx(2 * pi * 660 * std::sqrt(1 + e_string.inharmonicity())));
}

TEST_CASE("the pole solves the oscillator's equation") {
  const rosin::string_mode mode{.number = 3, .omega_rad_s = 1000, .inverse_quality = 0.2, .mass_kg = 1, .end_stiffness_N_m = 0};
  const auto p = mode.pole();
  CHECK(std::abs(p * p + 200.0 * p + 1e6) < 1e-9);
  CHECK(p.imag() > 0);
}

TEST_CASE("shape and parity, also of high modes") {
  rosin::string_mode mode{.number = 2};
  CHECK(mode.shape(0.25) == test::approx(1.0));
  CHECK(mode.parity() == -1);
  mode.number = 100001;
  CHECK(mode.shape(0.5) == test::approx(1.0));
  CHECK(mode.parity() == 1);
}

TEST_CASE("statics: the modes' sums are the deflected string's shape and forces") {
  for (const double B : {4.7e-5, 0.0}) {
    auto string = e_string;
    string.bending_stiffness_Nm2 = B;
    for (const double beta : {0.1, 0.3, 0.77}) {
      double deflection = 0, near = 0, far = 0;
      for (const auto& m : rosin::transverse_modes(string, B > 0 ? 1e9 : 4e7)) {
        const double yields = m.shape(beta) / (m.mass_kg * m.omega_rad_s * m.omega_rad_s);
        deflection += m.shape(beta) * yields;
        near += m.end_stiffness_N_m * yields;
        far += m.end_stiffness_N_m * yields * m.parity();
      }
      CAPTURE(B);
      CAPTURE(beta);
      CHECK(rosin::static_compliance_m_N(string, beta) == test::approx(deflection).epsilon(2e-5));
      CHECK(near == test::approx(1 - beta).epsilon(2e-4));
      CHECK(far == test::approx(beta).epsilon(2e-3));
    }
  }
}

TEST_CASE("the compliance left out falls as the cube of the number of modes or faster") {
  const double few = rosin::residual_compliance_m_N(e_string, 0.3, 100e3),
               many = rosin::residual_compliance_m_N(e_string, 0.3, 1e6);
  CHECK(few > 0);
  CHECK(many > 0);
  CHECK(many < few / 8);  // twice as many modes and more, in the range where bending rules
}

TEST_CASE("torsion: harmonic, one Q, and as stiff as the surface against both ends") {
  const rosin::modal_rig rig{.string = e_string, .torsion = {7, 3.5, 15}};
  const auto modes = rosin::torsional_modes(rig, 4e7);
  CHECK(modes[2].omega_rad_s == test::approx(2 * pi * 3 * 7 * 660));
  CHECK(modes[0].inverse_quality == test::approx(1.0 / 15));
  double deflection = 0;
  for (const auto& m : modes) deflection += std::pow(m.shape(0.3) / m.omega_rad_s, 2) / m.mass_kg;
  const double Z = e_string.impedance_Ns_m() * 3.5, c = e_string.wave_speed_m_s() * 7;  // stiffness Z c per length
  CHECK(deflection == test::approx(0.3 * 0.7 * 0.314 / (Z * c)).epsilon(1e-3));
  CHECK(rosin::torsional_modes({.string = e_string}, 4e7).empty());
}

TEST_CASE("uneven losses are normal deviates of the modes' own, the same for a seed") {
  rosin::modal_rig rig{.string = e_string};
  const auto even = rosin::transverse_modes(rig, 1e6);
  rig.uneven = {0.15, 3};
  const auto once = rosin::transverse_modes(rig, 1e6), again = rosin::transverse_modes(rig, 1e6);
  rig.uneven.seed = 4;
  const auto other = rosin::transverse_modes(rig, 1e6);
  double sum = 0, squares = 0, together = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    const double d = std::log(once[i].inverse_quality / even[i].inverse_quality) / 0.15;
    CHECK(once[i].inverse_quality == again[i].inverse_quality);
    CHECK(once[i].omega_rad_s == even[i].omega_rad_s);
    sum += d, squares += d * d, together += d * std::log(other[i].inverse_quality / even[i].inverse_quality) / 0.15;
  }
  const auto n = static_cast<double>(once.size());
  CHECK(n > 200);
  CHECK(std::abs(sum / n) < 3 / std::sqrt(n));
  CHECK(std::abs(squares / n - 1) < 3 * std::sqrt(2 / n));
  CHECK(std::abs(together / n) < 3 / std::sqrt(n));
}

}  // namespace simulate_modal_string
