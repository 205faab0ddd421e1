// SPDX-License-Identifier: MIT
#include <rosin/calibrate/plain_plucks.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace calibrate_plain_plucks {

TEST_CASE("before the release a channel holds its share of the wire's force, after it the partials ring about the offset") {
  const std::vector<rosin::pluck_take> takes{{"one", 50e3, {}, 0.8}};
  const rosin::pluck_layout layout(takes, {});
  const rosin::plain_plucks plucks{layout, {0, 0}};
  Eigen::VectorXd v = layout.initial(takes, {.fundamental_Hz = 500}, 500.0, {0.002}, {0.3});
  v[layout.at(0, rosin::pluck_layout::offset_far)] = 0.05;
  const auto before = plucks.lines(v, 0, 0, 0, {21e3, 21e3}, 10), after = plucks.lines(v, 0, 1, 0.003, {21e3, 21e3}, 10);
  REQUIRE(before.size() == 2);
  REQUIRE(after.size() == 12);
  CHECK(before[0].residue[0].real() == test::approx(0.8 * 0.7));
  CHECK(before[1].residue[1].real() == test::approx(0.8 * 0.3 + 0.05));
  CHECK(after[11].residue[1].real() == test::approx(0.05));
}

TEST_CASE("a mode with twice the loss rings down twice as fast") {
  const std::vector<rosin::pluck_take> takes{{"one", 50e3, {}, 0.8}};
  const rosin::pluck_layout layout(takes, {.own_losses = 3});
  const rosin::plain_plucks plucks{layout, {0, 0}};
  Eigen::VectorXd v = layout.initial(takes, {.fundamental_Hz = 500, .quality = 1000}, 500.0, {0.002}, {0.3});
  const auto even = plucks.lines(v, 0, 1, 0.002, {21e3, 21e3}, 10);
  v[layout.loss_scatter()] = 0.5, v[layout.first_of_own() + 1] = std::log(2);
  const auto uneven = plucks.lines(v, 0, 1, 0.002, {21e3, 21e3}, 10);
  CHECK(uneven[0].pole.real() == test::approx(even[0].pole.real()).epsilon(1e-12));
  CHECK(uneven[1].pole.real() == test::approx(2 * even[1].pole.real()).epsilon(1e-12));
  CHECK(std::abs(uneven[1].pole) == test::approx(std::abs(even[1].pole)).epsilon(1e-12));
  CHECK(uneven[5].pole.real() == test::approx(even[5].pole.real()).epsilon(1e-12));  // has none of its own
}

}  // namespace calibrate_plain_plucks
