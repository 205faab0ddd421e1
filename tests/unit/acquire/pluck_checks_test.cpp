// SPDX-License-Identifier: MIT
#include <rosin/acquire/pluck_checks.hpp>

#include <doctest/doctest.h>

#include <support/synthetic_take.hpp>

#include "support/approx.hpp"

namespace acquire_pluck_checks {

namespace {

struct result {
  bool released;
  rosin::detail::pluck_steps steps;
  rosin::take_check check;
};

result steps_of(const rosin::rig& r, const rosin::take_signals& s) {
  result out{};
  out.check.duration_s = s.time_s(s.frames());
  const rosin::detail::pluck_view view{&r, &r.takes[0], &s, r.string.fundamental_Hz, 0};
  out.released = rosin::detail::check_steps(out.check, view, out.steps);
  return out;
}

}  // namespace

TEST_CASE("levels before the release and its time at the string") {
  test::pluck p;
  const auto r = test::two_force_rig(p);
  const auto s = test::pluck_signals(r, p);
  const auto found = steps_of(r, s);
  REQUIRE(found.released);
  CHECK(found.steps.near_level == test::approx(0.7).epsilon(1e-3));
  CHECK(found.steps.far_level == test::approx(0.3).epsilon(1e-3));
  const rosin::detail::pluck_view view{&r, &r.takes[0], &s, p.fundamental_Hz, 0};
  CHECK(rosin::detail::release_time(view, found.steps) == test::approx(p.release_s).epsilon(2e-3));
}

TEST_CASE("a stretch without a step that is longer than a period proves a release") {
  const test::pluck p;
  const auto r = test::two_force_rig(p);
  const auto s = test::pluck_signals(r, p);
  auto steps = steps_of(r, s).steps;
  const rosin::detail::pluck_view view{&r, &r.takes[0], &s, p.fundamental_Hz, 0};
  CHECK(lead_of(view, steps) == rosin::detail::lead_in::enough);
  const std::size_t cut = steps.near.frame - 100;  // of 145 samples in a period
  steps.near.frame -= cut, steps.far.frame -= cut;
  CHECK(lead_of(view, steps) == rosin::detail::lead_in::short_one);
  steps.far.height = -steps.far.height;
  CHECK(lead_of(view, steps) == rosin::detail::lead_in::none);
}

TEST_CASE("a channel that does not step by a fifth of the force holds no release") {
  test::pluck p;
  p.far_gain = 0.05;
  const auto r = test::two_force_rig(p);
  const auto found = steps_of(r, test::pluck_signals(r, p));
  CHECK_FALSE(found.released);
  REQUIRE(found.check.findings.size() == 1);
  CHECK(found.check.findings[0].kind == "no-release");
  CHECK(found.check.findings[0].channel == "far");
}

TEST_CASE("the scale is compared with the wire's strength, tolerances allowed for") {
  for (const auto& [gain, wrong] : {std::pair{1.0, false}, {1.1, false}, {0.9, false}, {0.5, true}, {2.0, true}}) {
    test::pluck p;
    p.near_gain = gain;
    CAPTURE(p.near_gain);
    const auto r = test::two_force_rig(p);
    const auto s = test::pluck_signals(r, p);
    auto found = steps_of(r, s);
    rosin::detail::check_step(found.check, {&r, &r.takes[0], &s, p.fundamental_Hz, 0}, "near", found.steps.near);
    CHECK(found.check.found("wrong-scale") == wrong);
  }
}

}  // namespace acquire_pluck_checks
