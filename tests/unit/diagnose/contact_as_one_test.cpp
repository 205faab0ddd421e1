// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_as_one.hpp>
#include <rosin/diagnose/contact_effects.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "two_places.hpp"

namespace {

double off_within_30_kHz(const std::vector<double>& found, const std::vector<double>& truth) {
  return contact_rigs::off(contact_rigs::within_30_kHz(found), contact_rigs::within_30_kHz(truth));
}

/// Two strokes under a contact of 5 mm.
std::array<contact_rigs::stroke, 2> wide_strokes(double speed_ripple) {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.speed_Hz = fast.speed_Hz = 140, slow.speed_relative = fast.speed_relative = speed_ripple;
  return {contact_rigs::play(contact_rigs::curve(), slow, contact_rigs::rolls, 61, 0.27, 0.1, 0.3e-3, 0.005),
          contact_rigs::play(contact_rigs::curve(), fast, contact_rigs::rolls, 63, 0.27, 0.1, 0.3e-3, 0.005)};
}

}  // namespace

TEST_CASE("contact as one: the force of both places, and their mean velocity") {
  constexpr double width = 0.005, position = 0.27;
  const auto truth = contact_rigs::drive(position, width);
  rosin::contact_model model;
  model.width_s = width / contact_rigs::e_string.wave_speed_m_s();
  const auto one = rosin::as_one_contact({contact_rigs::take_of(truth, position)}, model);
  REQUIRE(one);
  auto mean = truth.v_near;
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5 * (mean[i] + truth.v_far[i]);
  CHECK(off_within_30_kHz(one->force_N[0], truth.force) < 0.01);
  CHECK(off_within_30_kHz(one->velocity_m_s[0], mean) < 0.03);
  model.width_s = 1e-12;  // as a point
  const auto point = rosin::as_one_contact({contact_rigs::take_of(truth, position)}, model);
  REQUIRE(point);
  CHECK(off_within_30_kHz(point->velocity_m_s[0], mean) > 3 * off_within_30_kHz(one->velocity_m_s[0], mean));
}

TEST_CASE("contact as one: nothing where no width is known, or the ends' forces are not given") {
  const auto truth = contact_rigs::drive(0.27, 0.005);
  auto take = contact_rigs::take_of(truth, 0.27);
  CHECK_FALSE(rosin::as_one_contact({take}, {}));
  rosin::contact_model model;
  model.width_s = 1e-5;
  take.far_N = {};
  CHECK_FALSE(rosin::as_one_contact({take}, model));
}

TEST_CASE("contact as one: beside a width a ripple of the speed is found, and nothing where there is none" *
          doctest::test_suite("long")) {
  for (const double ripple : {0.0, 0.03}) {
    CAPTURE(ripple);
    const auto strokes = wide_strokes(ripple);
    const std::vector<rosin::contact_take> takes{strokes[0].take(), strokes[1].take()};
    const auto found = rosin::contact_hypotheses(takes, contact_rigs::declared());
    REQUIRE_FALSE(found.as_declared);
    REQUIRE(found.hypotheses.front().effect == "finite-contact-width");
    const auto model = rosin::include(contact_rigs::declared(), found.hypotheses.front());
    CHECK(model.width_s * contact_rigs::e_string.wave_speed_m_s() == test::approx(0.005).epsilon(0.05));
    const auto then = rosin::contact_hypotheses(takes, model);
    CHECK(then.as_declared == (ripple == 0));
    if (ripple == 0) continue;
    const auto& second = then.hypotheses.front();
    CHECK(second.effect == "speed-ripple");
    CHECK(second.parameters[0].value == test::approx(140).epsilon(0.002));
    CHECK(second.parameters[1].value == test::approx(ripple).epsilon(0.05));
    CHECK(then.stick_fluctuation > 3 * rosin::contact_hypotheses(takes, rosin::include(model, second)).stick_fluctuation);
  }
}
