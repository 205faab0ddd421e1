// SPDX-License-Identifier: MIT
// A lighter form of the statistics in tests/proof: what the fit finds on modal plucks, and what it says where it cannot.
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/approx.hpp"
#include "support/causal_string.hpp"

namespace {

using layout = rosin::pluck_layout;
const rosin::modal_rig guitar_rig{.string = {.length_m = 0.314,
                                             .tension_N = 72.5,
                                             .fundamental_Hz = 659.69,
                                             .bending_stiffness_Nm2 = 4.7e-5,
                                             .loss = {.quality = 1000}}};

rosin::pluck_take pluck(double position, double force_N, std::uint64_t seed, double duration_s = 0.14, double ac_Hz = 0,
                        rosin::damping_convention damping = rosin::damping_convention::viscous,
                        rosin::modal_rig with = guitar_rig) {
  with.damping = damping;
  const auto made =
      rosin::simulate_pluck(with, {.position = position, .force_N = force_N, .release_s = 0.004, .duration_s = duration_s});
  REQUIRE(made);
  rosin::pluck_take take;
  take.name = "pluck-" + std::to_string(seed);
  take.rate_Hz = made->sample_rate_Hz;
  take.strength_N = 1;
  take.position = position + 0.004;  // as declared: not quite right
  const rosin::converter near{
      .gain = 1.02, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .ac_coupled_Hz = ac_Hz, .bits = 16};
  const rosin::converter far{.gain = 0.97, .newtons_per_full_scale = 1.65, .noise_N = 0.4e-3, .ac_coupled_Hz = ac_Hz, .bits = 16};
  take.force_N = {rosin::convert(made->force_near_N, take.rate_Hz, near, 2 * seed).newtons(),
                  rosin::convert(made->force_far_N, take.rate_Hz, far, 2 * seed + 1).newtons()};
  return take;
}

/// Distance from the truth in stated standard deviations.
double sigmas(const rosin::pluck_fit_result& fit, Eigen::Index p, double truth) {
  return std::abs(fit.value[p] - truth) / fit.sd[p];
}

}  // namespace

TEST_CASE("one pluck gives string, position, release, ratio of gains and noise, within its error bars") {
  const auto fit = rosin::fit_plucks({pluck(0.3, 1, 1)}, {.fundamental_Hz = 660});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->converged);
  CHECK(sigmas(*fit, layout::fundamental, 659.69) < 4);
  CHECK(sigmas(*fit, layout::inharmonicity, guitar_rig.string.inharmonicity()) < 4);
  CHECK(sigmas(*fit, layout::inverse_quality, 1e-3) < 4);
  CHECK(sigmas(*fit, layout::convention, -1) < 4);
  CHECK(sigmas(*fit, layout::first_position, 0.3) < 4);
  CHECK(sigmas(*fit, fit->layout.at(0, layout::release), 0.004) < 4);
  CHECK(fit->value[layout::gain_near] - fit->value[layout::gain_far] == test::approx(std::log(1.02 / 0.97)).epsilon(1e-3));
  CHECK(fit->sd[layout::fundamental] / 659.69 < 1e-7);
  CHECK(fit->noise_N[0] == test::approx(0.3e-3).epsilon(0.05));
  CHECK(fit->noise_N[1] == test::approx(0.4e-3).epsilon(0.05));
  CHECK(fit->misfit < 1.4);
  CHECK(fit->residual_ratio[0] < 2e-3);
  CHECK(fit->unidentified.empty());
  // The common scale is the wires' and the converters' tolerance: 3 % and 5 % as limits, on two gains.
  CHECK(fit->sd[layout::gain_near] == test::approx(1 / std::sqrt(std::pow(0.015, -2) + 2 * std::pow(0.025, -2))).epsilon(0.02));
}

TEST_CASE("modes that lose each in its own way: the fit says how far they scatter, and all else within its error bars") {
  rosin::modal_rig uneven = guitar_rig;
  uneven.uneven = {0.15, 7};
  const auto fit =
      rosin::fit_plucks({pluck(0.3, 1, 3, 0.14, 0, rosin::damping_convention::viscous, uneven)}, {.fundamental_Hz = 660});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->loss_scatter == test::approx(0.15).epsilon(0.3));
  CHECK_FALSE(fit->more_than_noise);
  CHECK(sigmas(*fit, layout::fundamental, 659.69) < 4);
  CHECK(sigmas(*fit, layout::inharmonicity, guitar_rig.string.inharmonicity()) < 4);
  CHECK(sigmas(*fit, layout::inverse_quality, 1e-3) < 4);
  CHECK(fit->sd[layout::inverse_quality] > 1e-5);  // a law is known to no more than what is off it
  CHECK(sigmas(*fit, layout::first_position, 0.3) < 4);
  CHECK(sigmas(*fit, fit->layout.at(0, layout::release), 0.004) < 4);
  REQUIRE(fit->own_losses.size() > 60);
  for (int n = 1; n <= 20; ++n)
    CHECK(std::abs(fit->own_losses[static_cast<std::size_t>(n - 1)] - std::log(uneven.uneven.factor(n))) < 0.1);
  const auto even = rosin::fit_plucks({pluck(0.3, 1, 3)}, {.fundamental_Hz = 660});
  REQUIRE(even);
  CHECK(even->loss_scatter == 0);
  CHECK(even->own_losses.empty());
}

TEST_CASE("it starts from 2 % off in pitch and 0.02 in position") {
  for (const double pitch : {0.98, 1.02})
    for (const double place : {-0.02, 0.02}) {
      rosin::pluck_take take = pluck(0.3, 1, 2, 0.07);
      take.position = 0.3 + place;
      const auto fit = rosin::fit_plucks({take}, {.fundamental_Hz = pitch * 659.69});
      REQUIRE_MESSAGE(fit, fit.error());
      CHECK(fit->value[layout::fundamental] == test::approx(659.69).epsilon(1e-6));
      CHECK(fit->value[layout::first_position] == test::approx(0.3).epsilon(1e-4));
    }
}

TEST_CASE("plucks at two positions share the string and keep their places apart") {
  const auto fit = rosin::fit_plucks({pluck(0.3, 1, 3, 0.05), pluck(0.21, 0.5, 4, 0.05)}, {.fundamental_Hz = 660});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(sigmas(*fit, fit->layout.position(0), 0.3) < 4);
  CHECK(sigmas(*fit, fit->layout.position(1), 0.21) < 4);
  CHECK(std::exp(fit->value[fit->layout.at(1, layout::strength)] - fit->value[fit->layout.at(0, layout::strength)]) ==
        test::approx(0.5).epsilon(1e-3));
}

TEST_CASE("AC-coupled sensors are part of the model") {
  const auto fit = rosin::fit_plucks({pluck(0.3, 1, 5, 0.07, 2.0)}, {.fundamental_Hz = 660, .ac_coupled_Hz = {2.0, 2.0}});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->misfit < 1.6);
  CHECK(sigmas(*fit, layout::fundamental, 659.69) < 4);
  CHECK(sigmas(*fit, layout::first_position, 0.3) < 4);
}

TEST_CASE("a low string, of which more partials lie in the band than are fitted") {
  rosin::modal_rig low = guitar_rig;
  low.string = {
      .length_m = 0.65, .tension_N = 70, .fundamental_Hz = 82.41, .bending_stiffness_Nm2 = 6e-5, .loss = {.quality = 800}};
  std::vector<rosin::pluck_take> takes;
  for (const double force_N : {1.0, 0.5})
    takes.push_back(pluck(0.3, force_N, takes.size() + 40, 0.14, 0, rosin::damping_convention::viscous, low));
  const auto fit = rosin::fit_plucks(takes, {.fundamental_Hz = 82.6});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->converged);
  CHECK(fit->unidentified.empty());
  CHECK(fit->misfit < 1.3);
  CHECK(sigmas(*fit, layout::fundamental, 82.41) < 4);
  CHECK(fit->sd[layout::fundamental] / 82.41 < 1e-6);
  CHECK(sigmas(*fit, layout::inharmonicity, low.string.inharmonicity()) < 4);
}

TEST_CASE("another convention of damping is taken up by psi") {
  const auto fit =
      rosin::fit_plucks({pluck(0.3, 1, 6, 0.07, 0, rosin::damping_convention::kelvin_voigt)}, {.fundamental_Hz = 660});
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->value[layout::convention] == test::approx(1).epsilon(0.3));
  CHECK(fit->misfit < 2);
  CHECK(sigmas(*fit, layout::fundamental, 659.69) < 5);
}

TEST_CASE("what cannot be fitted is said by take and reason") {
  const rosin::pluck_guess guess{.fundamental_Hz = 660};
  const auto message = [&](rosin::pluck_take take) { return rosin::fit_plucks({std::move(take)}, guess).error(); };
  const rosin::pluck_take good = pluck(0.3, 1, 7, 0.05);

  rosin::pluck_take broken = good;
  broken.force_N[1][321] = std::numeric_limits<double>::quiet_NaN();
  CHECK(message(broken) == "pluck-7: far, sample 321 is not a number");
  rosin::pluck_take silent = good;
  for (double& x : silent.force_N[0]) x = 0;
  CHECK(message(silent).find("no release found in channel near") != std::string::npos);
  rosin::pluck_take brief = good;
  for (auto& c : brief.force_N) c.resize(600);
  CHECK(message(brief).find("shorter than eight periods") != std::string::npos);
  rosin::pluck_take swapped = good;
  std::swap(swapped.force_N[0], swapped.force_N[1]);
  CHECK(message(swapped).find("do not ring as the declared string") != std::string::npos);
  CHECK(rosin::fit_plucks({}, guess).error() == "no pluck to fit");
}

TEST_CASE("a string whose loss is causal is fitted as one, to the noise; one whose modes lose one by one is not") {
  const test::causal_string causal{.fundamental_Hz = 440, .quality = 400};
  const double rate = 96e3;
  std::mt19937_64 random{77};
  std::normal_distribution<double> noise{0, 3e-4};
  std::vector<rosin::pluck_take> takes;
  for (const double position : {0.3, 0.17}) {
    rosin::pluck_take take{.name = "causal", .rate_Hz = rate, .position = position + 0.002};
    take.force_N = causal.pluck(position, 0.004, rate, 20000, {44e3, 47e3});
    for (auto& channel : take.force_N)
      for (double& x : channel) x += noise(random);
    takes.push_back(take);
  }
  const auto fit = rosin::fit_plucks(takes, {.fundamental_Hz = 441});
  REQUIRE_MESSAGE(fit, fit.error());
  MESSAGE(fit->misfit);
  CHECK_FALSE(fit->more_than_noise);
  CHECK(fit->layout.is_free(layout::causality));
  CHECK(fit->value[layout::causality] == test::approx(1).epsilon(0.01));
  CHECK(fit->value[layout::fundamental] == test::approx(440).epsilon(2e-6));  // 1 / (pi Q)^2: what "at the pitch" means
  CHECK(std::abs(fit->value[layout::inharmonicity]) < 1e-7);
  CHECK(1 / fit->value[layout::inverse_quality] == test::approx(400).epsilon(0.01));
  CHECK(fit->noise_N[0] == test::approx(3e-4).epsilon(0.03));

  const auto plain = rosin::fit_plucks({pluck(0.3, 1, 1)}, {.fundamental_Hz = 660});
  REQUIRE_MESSAGE(plain, plain.error());
  CHECK_FALSE(plain->layout.is_free(layout::causality));
  CHECK(plain->value[layout::causality] == 0);
}
