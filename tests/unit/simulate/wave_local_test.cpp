// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_local.hpp>

#include <doctest/doctest.h>

#include <numeric>

#include <rosin/simulate/modal_contact.hpp>

#include "support/approx.hpp"

namespace simulate_wave_local {

namespace {

const rosin::string_parameters e_string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5};

}  // namespace

TEST_CASE("an ideal string answers at once with half its admittance") {
  auto string = e_string;
  string.bending_stiffness_Nm2 = 0;
  const auto taps = rosin::local_response(string, 1e-6);
  REQUIRE(taps.size() == 1);
  CHECK(taps[0] == test::approx(1 / (2 * string.impedance_Ns_m())));
}

TEST_CASE("at 0 Hz the stiff string answers as an ideal one, and nothing comes before the force") {
  for (const double rate : {128e3, 1.024e6}) {
    const auto taps = rosin::local_response(e_string, 1 / rate);
    CHECK(std::accumulate(taps.begin(), taps.end(), 0.0) * 2 * e_string.impedance_Ns_m() == test::approx(1).epsilon(1e-6));
    CHECK(taps.front() > taps.back());
    CHECK(std::abs(taps.back()) < 1e-6 * taps.front());
  }
}

TEST_CASE("the modes of a bounded string begin in the same way, before any echo") {
  const double step_s = 1 / 1.024e6;
  const auto taps = rosin::local_response(e_string, step_s);
  rosin::modal_contact modes{{.string = e_string}, 0.5, 480e3, step_s};
  double modal = 0, local = 0;  // displacement by a force of 1 N over one step: the modes' ripple at their limit averages out
  for (int n = 0; n < 60; ++n) {
    const auto line = modes.line({});
    const double force = n == 0 ? 1 : 0;
    modal += line.free_velocity_m_s + line.mobility_m_Ns * force;
    modes.apply(force);
    if (n < static_cast<int>(taps.size())) local += taps[static_cast<std::size_t>(n)];
  }
  CHECK(local == test::approx(modal).epsilon(5e-3));
}

TEST_CASE("a line through samples weighs a frequency by sinc squared") {
  CHECK(rosin::straight_line_weight(0, 1e-3) == 1);
  const double w = 1200, h = 1e-3, x = w * h / 2;
  CHECK(rosin::straight_line_weight(w, h) == test::approx(std::pow(std::sin(x) / x, 2)));
}

}  // namespace simulate_wave_local
