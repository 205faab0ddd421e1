// SPDX-License-Identifier: MIT
// On strings in the frequency domain and sums of modes, which share nothing with the model that is fitted.
#include <rosin/diagnose/loosened_plucks.hpp>

#include <rosin/diagnose/pluck_diagnosis.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"
#include "support/causal_string.hpp"

namespace {

std::vector<rosin::pluck_take> three_at_one_place() {
  std::vector<rosin::pluck_take> takes(3);
  for (std::size_t t = 0; t < 3; ++t) takes[t].name = std::to_string(t), takes[t].rate_Hz = 96e3, takes[t].position = 0.3;
  return takes;
}

/// Plucks of a string whose loss comes of relaxations a factor apart, each a little beside the others.
std::vector<rosin::pluck_take> plucks_of_relaxing_string(double apart, double leaks) {
  const test::causal_string string{.fundamental_Hz = 660, .quality = 700, .relaxations_apart = 5.5};
  std::mt19937_64 random{7};
  std::normal_distribution<double> noise{0, 2e-4};
  constexpr std::size_t samples = 7000;
  auto takes = three_at_one_place();
  for (std::size_t t = 0; t < 3; ++t) {
    const double force_N = t == 1 ? 0.5 : 1.0;
    takes[t].strength_N = force_N;
    takes[t].force_N = string.pluck(0.3 + apart * (static_cast<double>(t) - 1), 0.004, 96e3, samples, {44e3, 47e3});
    for (std::size_t i = 0; i < samples; ++i) {
      const double near = force_N * takes[t].force_N[0][i], far = force_N * takes[t].force_N[1][i];
      takes[t].force_N[0][i] = near + leaks * far + noise(random), takes[t].force_N[1][i] = far + leaks * near + noise(random);
    }
  }
  return takes;
}

rosin::outcome<rosin::pluck_diagnosis> diagnosis_of(const std::vector<rosin::pluck_take>& takes) {
  return rosin::diagnose_plucks({takes[0], takes[1]}, {takes[2]}, {.fundamental_Hz = 660}, {.internal_loss = false},
                                [&](const rosin::pluck_fit_result& fit) {
                                  const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175,
                                                                  0.314,        takes.size()};
                                  auto all = rosin::catalogue_without({"bending-stiffness"}, facts, fit.limits);
                                  std::erase_if(all, [](const rosin::pluck_effect& e) {  // scans take long
                                    return e.starts.size() > 20 || e.at_end || e.strength < -1;
                                  });
                                  return all;
                                });
}

}  // namespace

TEST_CASE("loosened plucks: values keep their meaning from one layout to another") {
  const auto takes = three_at_one_place();
  std::array<rosin::modal_termination, 2> ends;
  ends[1].modes = {{900, 10, 20}};
  const rosin::pluck_layout from(takes, {}, ends), to(takes, {.uneven_loss = true, .own_places = true}, ends);
  REQUIRE(to.size() == from.size() + 8 + 2);
  Eigen::VectorXd v(from.size() + 2);  // and an effect of two parameters
  for (Eigen::Index p = 0; p < v.size(); ++p) v[p] = static_cast<double>(p + 1);
  const Eigen::VectorXd moved = rosin::detail::carried_over(to, from, v);
  REQUIRE(moved.size() == to.size() + 2);
  CHECK(moved[rosin::pluck_layout::convention] == v[rosin::pluck_layout::convention]);
  for (std::size_t t = 0; t < 3; ++t) {
    CHECK(moved[to.position(t)] == v[from.position(0)]);
    CHECK(moved[to.at(t, rosin::pluck_layout::offset_far)] == v[from.at(t, rosin::pluck_layout::offset_far)]);
  }
  CHECK(moved.segment(to.first_of_uneven(), 8).norm() == 0);
  CHECK(moved[to.first_of_ends() + 2] == v[from.first_of_ends() + 2]);
  CHECK(moved.tail(2) == v.tail(2));
  CHECK(rosin::detail::carried_over(from, to, moved) == v);
}

TEST_CASE("loosened plucks: what is freed has to be slight") {
  rosin::scene_data data{three_at_one_place(), {.fundamental_Hz = 600}, {.uneven_loss = true, .own_places = true}, {}};
  data = rosin::detail::with_options(data, data.options);
  Eigen::VectorXd v = data.layout.initial(data.takes, data.guess, 600, {0.004, 0.004, 0.004}, {0.3, 0.3, 0.3});
  CHECK(rosin::detail::is_slight(data, v));
  v[data.layout.position(1)] = 0.3015, v[data.layout.first_of_uneven()] = 0.04;
  CHECK(rosin::detail::is_slight(data, v));
  v[data.layout.position(0)] = 0.2992;
  CHECK_FALSE(rosin::detail::is_slight(data, v));
  v[data.layout.position(0)] = 0.3, v[data.layout.first_of_uneven() + 2] = 0.04;  // 8 % together at some partial
  CHECK_FALSE(rosin::detail::is_slight(data, v));
}

TEST_CASE("loosened plucks: a loss of a few relaxations and places that differ are no mismatch, and hide none" *
          doctest::test_suite("long")) {
  for (const bool is_hidden : {true, false}) {
    const double apart = is_hidden ? 0 : 2e-4, leaks = is_hidden ? 0.004 : 0;
    CAPTURE(apart);
    CAPTURE(leaks);
    const auto d = diagnosis_of(plucks_of_relaxing_string(apart, leaks));
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->data.options.uneven_loss);
    CHECK(d->data.options.own_places == (apart > 0));
    CHECK(d->explained);
    CHECK(d->mismatched == (leaks > 0));
    CHECK(d->after < 1.2 * d->floor);
    REQUIRE(d->best.effects.size() == (leaks > 0 ? 1 : 0));
    if (leaks == 0) continue;
    CHECK(d->best.effects[0].id() == "channel-crosstalk");
    CHECK(d->best.value[d->data.layout.size()] == test::approx(leaks).epsilon(0.05));
  }
}
