// SPDX-License-Identifier: MIT
#include <rosin/diagnose/corrected_take.hpp>

#include "plucked.hpp"

#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_effects.hpp>

#include <doctest/doctest.h>

namespace {

constexpr double take_rate_Hz = 128e3;

/// Twelve harmonics of a bowed string, none of them near the record's ends' step.
double harmonic_force(double t, std::size_t c) {
  double sum = 0;
  for (int n = 1; n <= 12; ++n)
    sum += 0.2 / n * std::cos(2 * std::numbers::pi * 660 * n * t + static_cast<double>(c) + 0.3 * n * n);
  return sum;
}

constexpr std::array<double, 2> delay_s{0.27 / 1320, 0.73 / 1320};

/// What friction that sways in time with the mains does: at both ends in the proportion of a string.
double swaying_force(double t, std::size_t c) {
  constexpr double w = 2 * std::numbers::pi * 50;
  return 0.05 * std::cos(w * t + 2) * std::sin(w * delay_s[1 - c]) / std::sin(w * delay_s[0]);
}

}  // namespace

TEST_CASE("a resonance, a skew, crosstalk and hum are taken out of a stroke") {
  const rosin::string_facts facts{.fundamental_Hz = 659.69,
                                  .rate_Hz = take_rate_Hz,
                                  .highest_Hz = 53e3,
                                  .impedance_Ns_m = 0.175,
                                  .length_m = 0.314,
                                  .takes = 2};
  const auto layout = test::two_plucks({});
  const rosin::scene_data data{{}, {}, {}, layout};
  rosin::scene_fit fit;
  fit.effects = {rosin::sensor_resonance_effect(facts, 0), rosin::skew_effect(facts), rosin::crosstalk_effect(facts),
                 rosin::hum_effect(facts, 50)};
  fit.value = test::values_of(layout, std::vector<double>(4 + fit.effects[3].parameters.size(), 0.0));
  const Eigen::Index at = layout.size();
  fit.value[at] = std::log(15e3), fit.value[at + 1] = std::log(9.0), fit.value[at + 2] = 2e-6, fit.value[at + 3] = 0.03,
  fit.value[at + 4] = std::log(50.0);
  for (int take = 0; take < 2; ++take) {  // every pluck has its own phase of it
    const Eigen::Index first = at + 5 + take * static_cast<Eigen::Index>((fit.effects[3].parameters.size() - 1) / 2);
    const auto near = std::polar(0.02, 0.4 + take), far = 0.5 * near;
    fit.value.segment(first, 4) << near.real(), near.imag(), far.real(), far.imag();
  }

  const rosin::sensor_response near{.resonance_Hz = 15e3, .q = 9}, far{.delay_s = 2e-6};
  std::array<std::vector<double>, 2> seen{std::vector<double>(20000), std::vector<double>(20000)};
  for (std::size_t i = 0; i < 20000; ++i) {
    const double t = static_cast<double>(i) / take_rate_Hz;
    std::array<double, 2> y{};
    for (std::size_t c = 0; c < 2; ++c)
      for (int n = 1; n <= 12; ++n) {
        const double w = 2 * std::numbers::pi * 660 * n;
        const auto h = (c == 0 ? near : far)({0, w});
        y[c] += 0.2 / n * std::abs(h) * std::cos(w * t + static_cast<double>(c) + 0.3 * n * n + std::arg(h));
      }
    for (std::size_t c = 0; c < 2; ++c) y[c] += swaying_force(t, c);
    const double hum = 0.02 * std::cos(2 * std::numbers::pi * 50 * t + 1);
    seen[0][i] = y[0] + 0.03 * y[1] + hum;
    seen[1][i] = y[1] + 0.03 * y[0] + 0.5 * hum;
  }
  rosin::undo_sensors(data, fit, seen, delay_s, take_rate_Hz, 40e3);
  double worst = 0;
  for (std::size_t i = 3000; i < 17000; ++i)
    for (std::size_t c = 0; c < 2; ++c) {
      const double t = static_cast<double>(i) / take_rate_Hz;
      worst = std::max(worst, std::abs(seen[c][i] - harmonic_force(t, c) - swaying_force(t, c)));
    }
  CHECK(worst < 2e-3);  // what the record's ends and the hum's fit leave of 0.6 N
  CHECK(rosin::string_is_plain({}, fit.effects));
  CHECK_FALSE(rosin::string_is_plain({}, {rosin::point_mass_effect(facts)}));
}
