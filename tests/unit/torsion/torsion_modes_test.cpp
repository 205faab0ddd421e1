// SPDX-License-Identifier: MIT
#include <rosin/torsion/torsion_modes.hpp>

#include <doctest/doctest.h>

#include <rosin/simulate/modal_bank.hpp>
#include <rosin/torsion/torsion_response.hpp>

namespace torsion_torsion_modes {

namespace {

constexpr double one_way = 0.5 / 660.0 / 7;
const rosin::torsion_modes at(double q, int modes = 60) { return {{0.3 * one_way, 0.7 * one_way}, 0.6125, q, modes}; }

}  // namespace

TEST_CASE("torsion modes: with little loss it is the waveguide, but for a compliance") {
  const rosin::torsion_waveguide guide{at(1000).delay_s, 0.6125, 1000};
  const auto modes = at(1000);
  const double rest = modes.rest_m_N();
  CHECK(rest > 0);
  for (const double f : {700.0, 3000.0, 6200.0, 11000.0, 30000.0}) {
    const auto sum = modes(f) + std::complex<double>(0, 2 * std::numbers::pi * f * rest);
    CHECK(std::abs(sum - guide(f)) < 0.01 * std::abs(guide(f)) + 1e-4);
  }
}

TEST_CASE("torsion modes: at Q = 15 the conventions agree at the first resonance and differ off it") {
  const auto modes = at(15, 400);
  const rosin::torsion_waveguide guide{modes.delay_s, 0.6125, 15};
  const double f1 = 0.5 / one_way;
  CHECK(std::abs(modes(f1) - guide(f1)) < 0.08 * std::abs(guide(f1)));
  CHECK(std::arg(modes(0.5 * f1)) - std::arg(guide(0.5 * f1)) > 0.2 / 15);
}

TEST_CASE("torsion modes: wider than harmonics they are the waves that disperse") {
  auto modes = at(120, 400);
  modes.causal = true;
  rosin::torsion_waveguide guide{modes.delay_s, 0.6125, 120};
  const auto apart = [&](double f) {
    return std::abs(modes(f) + std::complex<double>(0, 2 * std::numbers::pi * f * modes.rest_m_N()) - guide(f)) /
           std::abs(guide(f));
  };
  const double third = rosin::torsion_modes::ratio(3, 120, true) * 0.5 / one_way;
  CHECK(apart(third) > 0.15);
  guide.causal = true;
  CHECK(apart(third) < 0.03);
  CHECK(rosin::torsion_modes::ratio(1, 15, true) == 1);
  CHECK(rosin::torsion_modes::ratio(7, 15, false) == 7);
}

TEST_CASE("torsion modes: the oscillators that the simulation steps") {
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
  const rosin::modal_rig rig{.string = string, .torsion = {7, 3.5, 15}};
  const auto list = rosin::torsional_modes(rig, 60 * 660 * 7.0 + 1);
  REQUIRE(list.size() == 60);
  const double f = 5600, w = 2 * std::numbers::pi * f;
  std::complex<double> sum = 0;
  for (const auto& m : list)
    sum += std::pow(m.shape(0.3), 2) / m.mass_kg * std::complex<double>(0, w) /
           std::complex<double>(m.omega_rad_s * m.omega_rad_s - w * w, w * m.omega_rad_s * m.inverse_quality);
  auto mine = at(15);
  mine.impedance_Ns_m = 3.5 * string.impedance_Ns_m();
  CHECK(std::abs(mine(f) - sum) < 1e-9 * std::abs(sum));
}

TEST_CASE("torsion modes: on a grid of frequencies they are what they are at each of them") {
  const auto modes = at(15);
  const auto grid = modes.on_grid(0.7, 90000);
  for (std::size_t k = 0; k < grid.size(); k += 97)
    CHECK(std::abs(grid[k] - modes(0.7 * static_cast<double>(k))) <= 1e-11 * std::abs(grid[k]));
}

TEST_CASE("torsion modes: as many are summed as are seen, however low the string; what is left is a compliance") {
  constexpr double edge_Hz = 57600;
  for (const double pitch_Hz : {40.0, 80.0, 660.0}) {
    const double low = 0.5 / pitch_Hz / 6.9;
    const rosin::torsion_modes all{{0.3 * low, 0.7 * low}, 0.6125, 15, 4000};
    auto seen = all;
    seen.modes = rosin::torsion_modes::seen_below(edge_Hz, low);
    for (const double f : {0.2, 0.4, 0.6}) {
      const auto rest = std::complex<double>(0, 2 * std::numbers::pi * f * edge_Hz * (seen.rest_m_N() - all.rest_m_N()));
      const auto exact = all(f * edge_Hz);
      CHECK(std::abs(seen(f * edge_Hz) + rest - exact) < 0.03 * std::abs(exact));
    }
  }
}

TEST_CASE("torsion modes: each convention has one other way about in either respect") {
  using enum rosin::torsion_damping;
  static_assert(rosin::otherwise_shared(constant_q) == viscous_modes && rosin::otherwise_shared(causal_modes) == causal_q);
  static_assert(rosin::otherwise_dispersed(constant_q) == causal_q && rosin::otherwise_dispersed(causal_modes) == viscous_modes);
  for (const auto d : {constant_q, viscous_modes, causal_q, causal_modes}) {
    CHECK(rosin::otherwise_shared(rosin::otherwise_shared(d)) == d);
    CHECK(rosin::torsion_convention(rosin::in_modes(d), rosin::is_causal(d)) == d);
  }
}

}  // namespace torsion_torsion_modes
