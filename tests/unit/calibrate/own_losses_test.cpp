// SPDX-License-Identifier: MIT
#include <rosin/calibrate/own_losses.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace calibrate_own_losses {

const rosin::ringing_string steel{
    .fundamental_Hz = 660, .inharmonicity = 6.5e-5, .loss = {.quality = 900, .internal_s = 1e-8}, .convention = 0.4};

TEST_CASE("a line belongs to the mode whose frequency is next to it") {
  const rosin::own_losses own(steel, Eigen::VectorXd::Zero(60));
  for (const int n : {1, 2, 17, 60}) {
    const double w = 2 * std::numbers::pi * steel.partial_Hz(n), fifth = 0.2 * 2 * std::numbers::pi * 660;
    for (const double off : {-fifth, 0.0, fifth}) CHECK(own.mode_of({-5, w + off}) == n);
  }
  CHECK(own.mode_of({-5, 2 * std::numbers::pi * steel.partial_Hz(61)}) == 0);
  CHECK(own.mode_of({-5, 0}) == 0);
  CHECK(own.mode_of({-5, 100}) == 0);
}

TEST_CASE("partials with losses of their own are those of strings with these losses") {
  Eigen::VectorXd d(40);
  for (Eigen::Index n = 0; n < d.size(); ++n) d[n] = 0.3 * std::sin(2.0 * static_cast<double>(n));
  const rosin::band limits{10e3, 24e3};
  const auto lines = rosin::pluck_lines(steel, {steel, d}, 0.23, 1e-3, limits, 40);
  for (std::size_t n = 0; n < lines.size(); ++n) {
    CAPTURE(n);
    rosin::ringing_string other = steel;  // all of its modes lose as this one does
    other.loss = {.quality = std::exp(-d[static_cast<Eigen::Index>(n)]) /
                             steel.loss.inverse_q(steel.partial_Hz(static_cast<int>(n) + 1))};
    const auto expected = rosin::pluck_lines(other, 0.23, 1e-3, limits, 40);
    CHECK(std::abs(lines[n].pole - expected[n].pole) < 1e-9 * std::abs(expected[n].pole));
    CHECK(std::abs(lines[n].residue[1] - expected[n].residue[1]) < 1e-6 * std::abs(expected[n].residue[1]) + 1e-12);
  }
}

TEST_CASE("the derivatives of a line by its own loss are those of differences") {
  const rosin::band limits{10e3, 24e3};
  Eigen::VectorXd d = Eigen::VectorXd::Constant(34, 0.2);
  const double h = 1e-4;
  const auto at = [&](double more) {
    return rosin::pluck_lines(steel, {steel, (d.array() + more).matrix()}, 0.23, 1e-3, limits, 34);
  };
  const auto above = at(h), now = at(0), below = at(-h);
  for (std::size_t n = 0; n < now.size(); ++n) {
    CAPTURE(n);
    const auto slope = rosin::own_losses(steel, d).slope_of(now[n], 1e-3, limits);
    CHECK(slope.mode == static_cast<int>(n) + 1);
    const auto pole = (above[n].pole - below[n].pole) / (2 * h);
    CHECK(std::abs(slope.pole - pole) < 1e-5 * std::abs(pole));
    const auto residue = (above[n].residue[0] - below[n].residue[0]) / (2 * h) / now[n].residue[0];
    CHECK(std::abs(slope.ln_residue - residue) < 1e-4 * std::abs(residue));
  }
}

TEST_CASE(
    "where something else moves the lines, each still has a mode of its own; what is damped by more than the string has none") {
  rosin::own_losses own(steel, Eigen::VectorXd::Zero(5));
  const double w = 2 * std::numbers::pi * 660;
  std::vector<rosin::damped_line> lines{{{-3, 1.1 * w}, {}}, {{-3, 1.7 * w}, {}}, {{-3, 2.2 * w}, {}}, {{-40, 0}, {}}};
  own.follow(lines);
  CHECK(own.mode_of(lines[0].pole) == 1);
  CHECK(own.mode_of(lines[1].pole) == 2);  // 2.2 is next to the second partial as well
  CHECK(own.mode_of(lines[2].pole) == 3);
  CHECK(own.mode_of(lines[3].pole) == 0);
  CHECK(own.mode_of({-3, 2.5 * w}) == 3);
  CHECK(own.mode_of({-3, 3.2 * w}) == 0);
  CHECK(own.mode_of({-w / 10, 1.7 * w}) == 0);
}

}  // namespace calibrate_own_losses
