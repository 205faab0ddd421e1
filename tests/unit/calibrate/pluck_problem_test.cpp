// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pluck_problem.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "support/approx.hpp"

namespace {

constexpr double problem_rate_Hz = 96e3;

/// Two short noisy takes; what they contain does not matter, only that sums over them are right.
std::vector<rosin::pluck_take> takes() {
  std::mt19937_64 random{9};
  std::normal_distribution<double> gauss{0, 0.2};
  std::vector<rosin::pluck_take> out(2);
  for (std::size_t i = 0; i < 2; ++i) {
    out[i].name = "take";
    out[i].rate_Hz = problem_rate_Hz;
    out[i].position = 0.3;
    for (auto& c : out[i].force_N) {
      c.resize(1500);
      for (double& x : c) x = gauss(random);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("gradient and Hessian are the derivatives of the cost, AC-coupled sensors included") {
  for (const double corner_Hz : {0.0, 5.0}) {
    const auto data = takes();
    const rosin::pluck_guess guess{.fundamental_Hz = 500, .ac_coupled_Hz = {corner_Hz, corner_Hz}};
    const rosin::pluck_options options{.air_loss = true, .causality = true};
    const rosin::pluck_layout layout(data, options);
    Eigen::VectorXd v = layout.initial(data, guess, 503.0, {0.003, 0.0031}, {0.31, 0.31});
    v[rosin::pluck_layout::inharmonicity] = 7e-5;
    v[rosin::pluck_layout::internal_loss] = 1e-8;
    v[rosin::pluck_layout::convention] = -0.5;
    v[rosin::pluck_layout::causality] = 0.8, v[rosin::pluck_layout::loss_drag] = 0.01;
    const rosin::pluck_problem problem(data, {layout, guess.ac_coupled_Hz}, options, guess, v, 12, 1e9, false, {0.1, 0.3});
    const auto at = problem.linearise(v);
    CHECK((at.hessian - at.hessian.transpose()).norm() < 1e-9 * at.hessian.norm());
    for (Eigen::Index p = 0; p < layout.size(); ++p) {
      CAPTURE(layout.name(p));
      const double h = 2e-3 / std::sqrt(std::max(1e-12, at.hessian(p, p)));
      Eigen::VectorXd up = v, down = v;
      up[p] += h;
      down[p] -= h;
      const auto above = problem.linearise(up), below = problem.linearise(down);
      const double slope = -(above.cost - below.cost) / (4 * h);  // cost is twice the log likelihood
      const double scale = std::sqrt(at.hessian(p, p)) * std::sqrt(at.cost);
      CHECK(std::abs(slope - at.gradient[p]) < 2e-4 * scale);
    }
  }
}

TEST_CASE("the assessment knows noise from misfit") {
  const auto data = takes();
  const rosin::pluck_guess guess{.fundamental_Hz = 500};
  const rosin::pluck_layout layout(data, {});
  Eigen::VectorXd v = layout.initial(data, guess, 503.0, {0.003, 0.003}, {0.31, 0.31});
  for (std::size_t t = 0; t < 2; ++t) v[layout.at(t, rosin::pluck_layout::strength)] = std::log(1e-9);  // pure noise was recorded
  const rosin::pluck_problem problem(data, {layout, guess.ac_coupled_Hz}, {}, guess, v, 160, 1e9, true, {0.1, 0.1});
  const rosin::assessment found = problem.assess(v);
  CHECK(found.noise[0] == test::approx(0.2).epsilon(0.06));
  CHECK(found.misfit == test::approx(1).epsilon(0.15));
  CHECK(found.inflation() == 1);
  rosin::assessment bad = found;
  bad.misfit = 3;
  CHECK(bad.inflation() == 3);
}
