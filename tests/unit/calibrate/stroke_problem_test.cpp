// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_problem.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/uneven_strokes.hpp"

namespace {

using problem_layout = rosin::stroke_layout;

/// A machine, two short strokes, and its true parameters.
struct known_strokes {
  test::drawn_strokes drawn = test::draw_strokes(5, 2, 0.35);
  std::vector<rosin::stroke_take> takes;
  problem_layout layout{2, 16};
  Eigen::VectorXd truth;

  known_strokes() {
    drawn.machine.noise_N = {1e-4, 1e-4};
    takes = test::recorded(drawn);
    truth = Eigen::VectorXd::Zero(layout.size());
    const auto& s = drawn.machine.rig.string;
    truth[problem_layout::fundamental] = s.fundamental_Hz, truth[problem_layout::inharmonicity] = s.inharmonicity();
    truth[problem_layout::ln_inverse_quality] = -std::log(s.loss.quality),
    truth[problem_layout::internal_loss] = s.loss.internal_s;
    truth[problem_layout::ln_gain_ratio] = std::log(drawn.machine.gain[0] / drawn.machine.gain[1]);
    for (std::size_t t = 0; t < 2; ++t) truth[layout.position(t)] = drawn.strokes[t].position;
    for (std::size_t m = 0; m < 16; ++m) truth[layout.own_q(m)] = drawn.machine.ln_own_q(static_cast<int>(m) + 1);
  }
  [[nodiscard]] std::vector<rosin::stroke_spectra> spectra(double edge_Hz) const {
    std::vector<rosin::stroke_spectra> out;
    for (const auto& t : takes) out.emplace_back(t, 0.5 * truth[0], edge_Hz, 0.5 / truth[0]);
    return out;
  }
};

}  // namespace

TEST_CASE("With the true string both ends tell of one force, whatever the friction does; and the cost's slope is its slope") {
  const known_strokes known;
  const auto spectra = known.spectra(14 * known.truth[0]);
  const Eigen::VectorXd wide = Eigen::VectorXd::Constant(known.layout.size(), 1e3);
  rosin::stroke_problem problem(known.layout, spectra, {known.truth, wide}, {{1e-4, 1e-4}, 1e-4});
  for (std::size_t t = 0; t < 2; ++t) {
    const auto left = problem.left(known.truth, t);
    double of_noise = 0;
    for (const double p : left.power) of_noise += p;
    double signal = 0;
    for (const double s : left.signal) signal += s;
    CHECK(of_noise < 1e-5 * signal);
    CHECK(left.misfit(problem.noise()) < 30);  // noise, but for what the loss between the modes is
  }
  auto off = known.truth;
  off[problem_layout::fundamental] *= 1 + 1e-5, off[known.layout.position(0)] += 1e-5, off[problem_layout::ln_gain_ratio] += 1e-3;
  off[problem_layout::skew] = 2e-8, off[known.layout.drift(1)] = 1e-5, off[known.layout.own_q(4)] += 0.2;
  off[problem_layout::inharmonicity] *= 1.01, off[problem_layout::ln_inverse_quality] += 0.1,
      off[problem_layout::internal_loss] *= 2;
  const auto here = problem.linearise(off);
  for (Eigen::Index p = 0; p < known.layout.own_q(6); ++p) {
    const double step = 1e-3 / std::sqrt(here.hessian(p, p));
    auto up = off, down = off;
    up[p] += step, down[p] -= step;
    const double slope = (problem.linearise(up).cost - problem.linearise(down).cost) / (2 * step);
    CAPTURE(known.layout.name(p));
    // the window is not turned like the signal: to a few hundredths of the most that the slope could be
    CHECK(std::abs(slope + 2 * here.gradient[p]) < 0.05 * std::sqrt(here.hessian(p, p) * here.cost));
  }
}

TEST_CASE("What no string can be is not plausible") {
  const known_strokes known;
  const auto spectra = known.spectra(10 * known.truth[0]);
  const rosin::stroke_problem problem(known.layout, spectra, {known.truth, Eigen::VectorXd::Ones(known.layout.size())}, {});
  CHECK(problem.plausible(known.truth));
  for (const auto& [p, value] : {std::pair<Eigen::Index, double>{problem_layout::fundamental, 2 * known.truth[0]},
                                 {problem_layout::internal_loss, -1e-3},
                                 {known.layout.position(0), -0.1},
                                 {known.layout.drift(1), 0.2}}) {
    auto odd = known.truth;
    odd[p] = value;
    CHECK_FALSE(problem.plausible(odd));
  }
}
