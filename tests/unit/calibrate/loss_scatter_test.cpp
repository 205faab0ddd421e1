// SPDX-License-Identifier: MIT
#include <rosin/calibrate/loss_scatter.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace calibrate_loss_scatter {

TEST_CASE("modes are heard up to the band's edge") {
  const rosin::ringing_string string{.fundamental_Hz = 500};
  CHECK(rosin::detail::modes_heard(string, {8e3, 10.25e3}, 160) == 20);
  CHECK(rosin::detail::modes_heard(string, {8e3, 10.25e3}, 12) == 12);
}

TEST_CASE("losses scatter from mode to mode: neighbours know nothing of one another, a trend is none") {
  std::mt19937_64 random{7};
  std::normal_distribution<double> gauss{0, 0.15};
  int taken_for_trends = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<double> d(40);
    for (double& x : d) x = gauss(random);
    taken_for_trends += !rosin::detail::scatters_from_mode_to_mode(d);
  }
  CHECK(taken_for_trends < 8);
  std::vector<double> slow_release;
  for (int n = 0; n < 40; ++n) slow_release.push_back(0.15 * (1 - n * n / 400.0) + 0.2 * gauss(random));
  CHECK_FALSE(rosin::detail::scatters_from_mode_to_mode(slow_release));
  CHECK(rosin::detail::scatters_from_mode_to_mode({}));
}

TEST_CASE("the scatter that the evidence asks for is that of what was drawn; none is asked for by modes that follow the law") {
  std::mt19937_64 random{4};
  std::normal_distribution<double> gauss;
  std::vector<rosin::pluck_take> takes{{"one", 50e3, {}, 1}};
  const rosin::pluck_guess guess{.fundamental_Hz = 500, .quality = 400};
  const rosin::pluck_options options{.own_losses = 40};
  const rosin::pluck_layout layout(takes, options);
  const rosin::plain_plucks plucks{layout, {0, 0}};
  const Eigen::VectorXd law = layout.initial(takes, guess, 500.0, {0.002}, {0.23});
  for (const double drawn : {0.2, 0.0}) {
    Eigen::VectorXd truth = law;
    truth[layout.loss_scatter()] = 1;
    double squares = 0;
    for (Eigen::Index p = layout.first_of_own(); p < layout.first_of_ends(); ++p)
      truth[p] = drawn * gauss(random), squares += truth[p] * truth[p] / 40;
    const auto lines = plucks.lines(truth, 0, 1, 0.002, {1e9, 1e9}, 40), held = plucks.lines(truth, 0, 0, 0, {1e9, 1e9}, 40);
    for (std::size_t c = 0; c < 2; ++c) {
      takes[0].force_N[c].clear();
      for (int i = 0; i < 6000; ++i) {
        double sum = 1e-3 * gauss(random);
        if (i < 100)
          for (const auto& l : held) sum += l.residue[c].real();
        else
          for (const auto& l : lines) sum += (l.residue[c] * std::exp(l.pole * ((i - 100) / 50e3))).real();
        takes[0].force_N[c].push_back(sum);
      }
    }
    Eigen::VectorXd v = law;
    v[layout.loss_scatter()] = rosin::detail::usual_loss_scatter;
    const rosin::pluck_problem problem(takes, plucks, options, guess, v, 40, 1e9, false, {1e-3, 1e-3});
    rosin::detail::settle_scatter(
        problem, v,
        [&](Eigen::VectorXd& at) {
          for (int i = 0; i < 4; ++i) {
            const auto eq = problem.linearise(at);
            at += eq.hessian.ldlt().solve(eq.gradient);
          }
        },
        12);
    CAPTURE(drawn);
    if (drawn > 0) CHECK(v[layout.loss_scatter()] == test::approx(std::sqrt(squares)).epsilon(0.05));
    else CHECK(v[layout.loss_scatter()] < 0.01);
    CHECK(rosin::detail::scatter_of(problem, v).price > 0);
  }
}

}  // namespace calibrate_loss_scatter
