// SPDX-License-Identifier: MIT
#include <rosin/calibrate/end_problem.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/plucked_ends.hpp"

namespace {

const test::moving_end_rig rig{test::steel_e,
                               {std::vector<test::end_mode>{{900, 40, 4e-3}}, std::vector<test::end_mode>{{2500, 15, 8e-3}}}};

/// The truth as values of the fit; the release is halfway into the step in which the force goes.
Eigen::VectorXd truth(const rosin::end_model& m, const std::vector<rosin::pluck_take>& takes) {
  Eigen::VectorXd v(m.size());
  const double Z = test::steel_e.impedance_Ns_m(), t0 = 0.008 - 0.5 / (8 * takes[0].rate_Hz);
  v.head(m.layout.size()) = m.layout.initial(takes, {.inharmonicity = test::steel_e.inharmonicity()},
                                             test::steel_e.fundamental_Hz, std::vector<double>(takes.size(), t0), {0.3, 0.2});
  v.tail<6>() << std::log(900), std::log(40), std::log(Z / 4e-3), std::log(2500), std::log(15), std::log(Z / 8e-3);
  return v;
}

}  // namespace

TEST_CASE("with the true values next to nothing of a simulated pluck is left") {
  const auto takes = test::pluck_at(rig, {0.3, 0.2}, 0.1, 0);
  const rosin::end_model m{rosin::pluck_layout(takes, {}), {}, {}, {0, 1}};
  const rosin::end_problem problem(takes, {0.006, 0.006}, 300, 12e3);
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t c = 0; c < 2; ++c) {
      const auto r = problem.at(m, truth(m, takes), t, c);
      const double all =
          r.model_power.sum() * 2 / static_cast<double>(problem.line(t).samples) * std::pow(problem.line(t).rate_Hz, 2);
      CHECK(r.residual.norm() < 2e-3 * std::sqrt(all));
    }
}

TEST_CASE("the Jacobian is that of the residual") {
  const auto takes = test::pluck_at(rig, {0.3, 0.2}, 0.03, 0);
  const rosin::end_model m{
      rosin::pluck_layout(takes, {.air_loss = true, .causality = true, .uneven_loss = true}), {0, 2.0}, {}, {0, 1}};
  const rosin::end_problem problem(takes, {0.006, 0.006}, 600, 8e3);
  Eigen::VectorXd v = truth(m, takes);
  v[rosin::pluck_layout::internal_loss] = 1e-8, v[rosin::pluck_layout::air_loss] = 1e-3, v[rosin::pluck_layout::convention] = 0.3;
  v[rosin::pluck_layout::causality] = 0.8, v[rosin::pluck_layout::loss_drag] = 0.01;
  for (Eigen::Index p = m.layout.first_of_uneven(); p < m.layout.size(); ++p) v[p] = p % 2 == 0 ? 0.02 : -0.01;
  for (Eigen::Index p = 0; p < m.size(); ++p) {
    const double h = p == rosin::pluck_layout::air_loss ? 1e-5 : p < m.layout.size() ? 10 * m.layout.step(p, v) : 1e-5;
    Eigen::VectorXd up = v, down = v;
    up[p] += h, down[p] -= h;
    for (std::size_t c = 0; c < 2; ++c) {
      const Eigen::VectorXd by = (problem.at(m, down, 1, c).residual - problem.at(m, up, 1, c).residual) / (2 * h);
      const Eigen::VectorXd exact = problem.at(m, v, 1, c).jacobian.col(p);
      CHECK((by - exact).norm() <= 0.2 * by.norm() + 1e-9);  // roughly: stiffness also turns what the ends feel
      if (p != rosin::pluck_layout::inharmonicity) CHECK((by - exact).norm() <= 2e-3 * by.norm() + 1e-9);
    }
  }
}

TEST_CASE("under a force that stays, an end that gives way is so much more string") {
  const rosin::end_model m{{}, {}, {}, {0}};
  const rosin::admittance_mode spring{500, 10, 3};
  const rosin::detail::held_string held(m, {spring}, 0.25, 1e-3);
  const double more = 3 / std::pow(2 * std::numbers::pi * 500, 2);
  CHECK(held.force[0] == test::approx(0.75e-3 / (1e-3 + more)));
  CHECK(held.force[1] == test::approx((0.25e-3 + more) / (1e-3 + more)));
}

TEST_CASE("end_problem: an end that is remembered is asked once at each s, by copies too") {
  int asked = 0;
  const rosin::known_admittance end = rosin::remembered([&](std::complex<double> s) { return ++asked, 2.0 * s; });
  const rosin::known_admittance copy = end;
  for (int i = 0; i < 3; ++i)
    for (const std::complex<double> s : {std::complex<double>(1, 5), std::complex<double>(1, -5)}) {
      CHECK(end(s) == 2.0 * s);
      CHECK(copy(s) == 2.0 * s);
    }
  CHECK(asked == 2);
  CHECK_FALSE(rosin::remembered({}));
}
