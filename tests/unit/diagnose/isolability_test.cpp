// SPDX-License-Identifier: MIT
#include <rosin/diagnose/isolability.hpp>

#include <rosin/diagnose/hum_effect.hpp>
#include <rosin/diagnose/sympathetic_effect.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

rosin::planned_plucks plan(double seconds) {
  rosin::planned_plucks p;
  p.takes = {{"pluck-1", 128000, {}, 1.0, 0.03, 0.3}};
  p.guess = {.fundamental_Hz = 660, .inharmonicity = 6.5e-5};
  p.duration_s = seconds;
  p.noise_N = 1e-3;
  return p;
}

}  // namespace

// An independent Fisher analysis: a 1 N pluck at 0.3 of a violin's E string, 1 mN noise; nuisances projected out.
TEST_CASE("what a pluck can tell apart is what another Fisher analysis says, and so is what it takes to be seen") {
  const rosin::string_facts facts{660, 128000, 54e3, 0.175, 0.314, 1};
  const std::vector<rosin::pluck_effect> effects{rosin::slow_release_effect(facts), rosin::pluck_width_effect(facts),
                                                 rosin::skew_effect(facts), rosin::crosstalk_effect(facts),
                                                 rosin::point_mass_effect(facts)};
  const auto long_look = rosin::isolability_of(plan(0.064), effects);
  CHECK(long_look.ids[0] == "slow-release");
  CHECK(long_look.cosine(0, 1) > 0.97);  // release and width: .998 there
  CHECK(long_look.cosine(2, 3) < 0.5);
  const auto classes = long_look.classes();
  CHECK(classes.front().size() == 2);
  CHECK(long_look.detectable[2] * 1e9 == test::approx(17).epsilon(0.5));   // skew: 17 ns
  CHECK(long_look.detectable[3] * 1e4 == test::approx(1.6).epsilon(0.6));  // crosstalk: 1.6e-4
  CHECK(long_look.detectable[4] * 1e9 < 3);                                // point mass: 0.09 ug at the middle of the string
  CHECK(long_look.surviving[0] < long_look.surviving[3]);                  // nuisances imitate a slow release best
  CHECK(long_look.surviving[3] > 0.45);
  const auto short_look = rosin::isolability_of(plan(0.0031), effects);
  CHECK(short_look.detectable[3] / long_look.detectable[3] > 2);  // 6e-4 after two periods
}

TEST_CASE("what shrinks with a parameter, though not in proportion, is followed down to where it is seen no more") {
  const rosin::string_facts facts{660, 128000, 54e3, 0.175, 0.314, 1};
  const rosin::pluck_effect damped = rosin::resistive_end_effect(facts, 0);
  rosin::pluck_effect in_proportion = damped;
  in_proportion.strength = 0, in_proportion.parameters[0].logarithmic = false, in_proportion.starts = {{1e-5 / 0.175, 66, 0}};
  const auto seen = rosin::isolability_of(
      plan(0.032), {damped, in_proportion, rosin::slow_release_effect(facts), rosin::ac_coupling_effect(facts)});
  CHECK(seen.strength[0] == "conductance_m_sN");
  CHECK(seen.detectable[0] == test::approx(seen.detectable[1]).epsilon(0.4));
  auto noisy = plan(0.032);
  noisy.noise_N *= 4;
  const auto hardly =
      rosin::isolability_of(noisy, {damped, in_proportion, rosin::slow_release_effect(facts), rosin::ac_coupling_effect(facts)});
  CHECK(hardly.detectable[0] / seen.detectable[0] == test::approx(4).epsilon(0.1));
  CHECK(hardly.detectable[2] / seen.detectable[2] < 3);  // what a wire that lets go slowly makes goes as a power of its time
  CHECK(hardly.detectable[3] > seen.detectable[3]);
  CHECK(rosin::isolability_of(noisy, {rosin::hum_effect(facts, 50)}).ids.empty());  // is there without a pluck
  noisy.noise_N = 1e3;
  CHECK(std::isnan(rosin::isolability_of(noisy, {rosin::slow_release_effect(facts)}).detectable[0]));
}

TEST_CASE("at its threshold every effect changes the recordings by five standard deviations") {
  const rosin::string_facts facts{660, 128000, 54e3, 0.175, 0.314, 1};
  const auto pluck = plan(0.032);
  const rosin::detail::planned_recordings recordings(pluck);
  const Eigen::MatrixXd nuisances = recordings.nuisances();
  for (auto e :
       {rosin::clamped_end_effect(facts, 0), rosin::internal_loss_effect(facts), rosin::support_resonance_effect(facts, 0),
        rosin::sympathetic_string_effect(facts, 1), rosin::ac_coupling_effect(facts)}) {
    CAPTURE(e.id());
    e.starts = rosin::detail::spread_starts(e, 12);
    const double threshold = rosin::isolability_of(pluck, {e}).detectable[0];
    double nearest = 1e300;  // of all places: which of them is told least of need not be known
    for (auto values : e.starts) {
      values[static_cast<std::size_t>(std::max(e.strength, e.shrinks_with))] = threshold;
      const Eigen::VectorXd d = recordings.change(e, values);
      const double times = (d - nuisances * (nuisances.transpose() * d)).norm() / (5 * pluck.noise_N);
      if (std::abs(std::log(times)) < std::abs(std::log(nearest))) nearest = times;
    }
    CHECK(nearest == test::approx(1).epsilon(0.03));
  }
}
