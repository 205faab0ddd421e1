// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pluck_layout.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "support/approx.hpp"

namespace {

using layout = rosin::pluck_layout;

std::vector<rosin::pluck_take> three_takes() {
  std::vector<rosin::pluck_take> takes(3);
  const double positions[] = {0.3, 0.2, 0.3};
  for (std::size_t i = 0; i < 3; ++i) {
    takes[i].name = "p" + std::to_string(i + 1);
    takes[i].position = positions[i];
    takes[i].strength_N = 0.5;
    takes[i].strength_tolerance = 0.04;
  }
  return takes;
}

}  // namespace

TEST_CASE("every parameter has a place and a name of its own; equal positions share one") {
  const layout l(three_takes(), {});
  CHECK(l.size() == 10 + 2 + 3 * 4);
  CHECK(l.position(0) == l.position(2));
  CHECK(l.position(0) != l.position(1));
  std::set<std::string> names;
  for (Eigen::Index p = 0; p < l.size(); ++p) names.insert(l.name(p));
  CHECK(static_cast<Eigen::Index>(names.size()) == l.size());
  CHECK(l.name(l.at(1, layout::release)) == "release_s of p2");
  CHECK(l.name(layout::gain_far) == "ln_gain_far");
}

TEST_CASE("tolerances are limits: two standard deviations") {
  const layout l(three_takes(), {});
  const rosin::pluck_guess guess{.fundamental_Hz = 600, .gain_tolerance = {0.05, 0.02}};
  CHECK(l.prior(layout::gain_far, three_takes(), guess).sd == test::approx(0.01));
  CHECK(l.prior(l.at(2, layout::strength), three_takes(), guess).sd == test::approx(0.02));
  CHECK(l.prior(l.at(2, layout::strength), three_takes(), guess).value == test::approx(std::log(0.5)));
  CHECK(l.prior(layout::fundamental, three_takes(), guess).sd == 0);
}

TEST_CASE("a declared stiffness holds the inharmonicity loosely, as long as that is free") {
  const rosin::pluck_guess guess{.fundamental_Hz = 600, .inharmonicity = 6e-5};
  CHECK(layout(three_takes(), {}).prior(layout::inharmonicity, three_takes(), guess).value == 6e-5);
  CHECK(layout(three_takes(), {}).prior(layout::inharmonicity, three_takes(), guess).sd == test::approx(1.8e-5));
  CHECK(layout(three_takes(), {}).prior(layout::inharmonicity, three_takes(), {.fundamental_Hz = 600}).sd == 0);
  CHECK(layout(three_takes(), {.stiffness = false}).prior(layout::inharmonicity, three_takes(), guess).sd == 0);
}

TEST_CASE("options fix parameters; the inverse leaves them out") {
  const layout l(three_takes(), {.stiffness = false, .internal_loss = false});
  CHECK_FALSE(l.is_free(layout::inharmonicity));
  CHECK_FALSE(l.is_free(layout::internal_loss));
  CHECK_FALSE(l.is_free(layout::air_loss));
  CHECK(l.is_free(layout::convention));
  CHECK_FALSE(l.is_free(layout::causality));
  CHECK_FALSE(l.is_free(layout::loss_drag));
  CHECK(layout(three_takes(), {.causality = true}).is_free(layout::causality));
  Eigen::MatrixXd h = Eigen::MatrixXd::Identity(l.size(), l.size()) * 4;
  h(0, 2) = h(2, 0) = 1;
  const Eigen::MatrixXd inverse = rosin::invert_free(l, h);
  CHECK(inverse(0, 0) == test::approx(4.0 / 15));
  CHECK(inverse(layout::inharmonicity, layout::inharmonicity) == 0);
}

TEST_CASE("what no string could be is not plausible") {
  const layout l(three_takes(), {});
  const Eigen::VectorXd start = l.initial(three_takes(), {.fundamental_Hz = 600}, 600, {0.004, 0.004, 0.004}, {0.3, 0.2, 0.3});
  CHECK(l.plausible(start, start, 50e3));
  const auto changed = [&](Eigen::Index p, double value) {
    Eigen::VectorXd v = start;
    v[p] = value;
    return l.plausible(v, start, 50e3);
  };
  CHECK_FALSE(changed(layout::fundamental, 700));
  CHECK_FALSE(changed(layout::inverse_quality, -1e-4));
  CHECK_FALSE(changed(layout::internal_loss, -1e-7));  // a partial at 50 kHz would grow
  CHECK_FALSE(changed(l.position(1), 0.3));
  CHECK_FALSE(changed(l.at(0, layout::release), 0.005));
  CHECK_FALSE(changed(layout::inharmonicity, std::nan("")));
  CHECK(changed(layout::internal_loss, 1e-7));
}

TEST_CASE("a loss that may be uneven has its series after the takes, by some hundredths") {
  std::array<rosin::modal_termination, 2> ends;
  ends[0].modes = {{900, 10, 20}};
  const layout l(three_takes(), {.uneven_loss = true}, ends), plain(three_takes(), {}, ends);
  REQUIRE(l.size() == plain.size() + 8);
  CHECK(plain.first_of_uneven() == plain.first_of_ends());
  const Eigen::Index first = l.first_of_uneven();
  CHECK(l.name(first) == "loss_cosine_1");
  CHECK(l.name(first + 7) == "loss_sine_4");
  CHECK(l.name(first + 8) == "ln_frequency of near end's mode 1");
  CHECK(l.is_free(first));
  CHECK_FALSE(l.is_scale(first + 1));
  CHECK(l.concerns(first, 2));
  CHECK(l.prior(first, three_takes(), {}).sd == test::approx(0.01));
  Eigen::VectorXd v = l.initial(three_takes(), {.fundamental_Hz = 600}, 600, {0.004, 0.004, 0.004}, {0.3, 0.2, 0.3});
  const Eigen::VectorXd start = v;
  v[first + 1] = 0.02, v[first + 6] = 0.01;
  CHECK(l.plausible(v, start, 50e3));
  CHECK(l.string(v).loss.uneven.sine[0] == 0.02);
  CHECK(l.string(v).loss.uneven.cosine[3] == 0.01);
  CHECK_FALSE(plain.string(plain.initial(three_takes(), {.fundamental_Hz = 600}, 600, {0.004, 0.004, 0.004}, {0.3, 0.2, 0.3}))
                  .loss.uneven.is_there());
  v[first] = 0.11;
  CHECK_FALSE(l.plausible(v, start, 50e3));
}

TEST_CASE("terminations that are known to move stand at the end: how far each mode is off, about nothing, within limits") {
  std::array<rosin::modal_termination, 2> ends;
  ends[0].modes = {{900, 10, 20}}, ends[1].modes = {{2400, 12, 40}, {470, 30, 4}};
  const layout l(three_takes(), {}, ends), plain(three_takes(), {});
  CHECK(l.has_ends());
  CHECK_FALSE(plain.has_ends());
  REQUIRE(l.size() == plain.size() + 9);
  CHECK(l.name(l.first_of_ends()) == "ln_frequency of near end's mode 1");
  CHECK(l.name(l.first_of_ends() + 8) == "ln_per_mass of far end's mode 2");
  const Eigen::Index q = l.first_of_ends() + 4;
  CHECK(l.is_free(q));
  CHECK_FALSE(l.is_scale(l.first_of_ends() + 1));
  CHECK(l.concerns(q, 2));
  CHECK(l.prior(q, three_takes(), {}).sd == test::approx(0.1));
  Eigen::VectorXd v = Eigen::VectorXd::Zero(l.size());
  v[q] = std::log(1.1);
  CHECK(l.ends(v)[1].modes[0].q == test::approx(13.2));
  CHECK(l.ends(v)[1].modes[1].frequency_Hz == 470);
  CHECK(l.ends_within_doubt(v));
  v[q] = 0.3;
  CHECK_FALSE(l.ends_within_doubt(v));
  CHECK(l.ends_within_doubt(v, 2));
  v[q] = -0.35, ends[1].modes[0].q = 0.6;  // would not ring
  CHECK_FALSE(layout(three_takes(), {}, ends).ends_within_doubt(v, 2));
}
