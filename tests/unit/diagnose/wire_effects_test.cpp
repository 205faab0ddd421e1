// SPDX-License-Identifier: MIT
#include <rosin/diagnose/wire_effects.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("wire effects: a release over some microseconds is what any wire does, a width has a name by itself") {
  const rosin::string_facts violin{.fundamental_Hz = 660, .length_m = 0.33};
  const auto release = rosin::slow_release_effect(violin);
  REQUIRE(release.is_ordinary);
  CHECK(release.is_ordinary({2.5e-6}));
  CHECK_FALSE(release.is_ordinary({6e-6}));
  CHECK_FALSE(rosin::pluck_width_effect(violin).is_ordinary);
}

TEST_CASE("wire effects: the instant of release is the middle of what it takes") {
  std::vector<rosin::pluck_take> takes(2);
  for (auto& take : takes) take.rate_Hz = 96e3, take.position = 0.3;
  const rosin::pluck_layout layout(takes, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size() + 1);
  for (std::size_t t = 0; t < 2; ++t) v[layout.at(t, rosin::pluck_layout::release)] = 0.004;
  v[layout.size()] = 2e-5;
  rosin::slow_release_effect({}).rebase(layout, v);
  for (std::size_t t = 0; t < 2; ++t) CHECK(v[layout.at(t, rosin::pluck_layout::release)] == test::approx(0.00399));
  v.conservativeResize(layout.size() + 2);
  v.tail(2) << 1e-5, 4e-5;
  rosin::slow_release_effect({.takes = 2}, true).rebase(layout, v);
  CHECK(v[layout.at(0, rosin::pluck_layout::release)] == test::approx(0.003985));
  CHECK(v[layout.at(1, rosin::pluck_layout::release)] == test::approx(0.00397));
}

TEST_CASE("wire effects: a width counts in lengths of the string, known or not") {
  rosin::pluck_scene scene;
  const double width_m = 2e-3, width = 0.01;
  rosin::pluck_width_effect({.length_m = 0.4}).apply(scene, &width_m, 0);
  CHECK(scene.width == test::approx(0.005));
  rosin::pluck_width_effect({}).apply(scene, &width, 0);
  CHECK(scene.width == test::approx(0.01));
}
