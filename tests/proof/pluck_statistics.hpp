// SPDX-License-Identifier: MIT
// Do the errors of fitted plucks have the size that the fit says, and is that the smallest possible? Plucks come from the modal
// simulator, and so does the Cramer-Rao bound: numerical derivatives of its noise-free recording over the whole recorded band.
#pragma once

#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <array>
#include <future>
#include <string>
#include <vector>

namespace proof {

/// What is judged, in the order of all arrays below.
inline constexpr std::array<const char*, 6> judged_names{"f0", "position", "ln gain ratio", "inharmonicity", "1/Q", "release"};
using judged = std::array<double, 6>;

struct pluck_errors {
  std::vector<judged> error, sd, bound;  ///< one a pluck; `bound`: Cramer-Rao
  std::vector<double> misfit;
  int failed = 0;
};

/// rms over the plucks of error / size.
inline double rms_ratio(const std::vector<judged>& error, const std::vector<judged>& size, std::size_t which) {
  double sum = 0;
  for (std::size_t i = 0; i < error.size(); ++i) sum += std::pow(error[i][which] / size[i][which], 2);
  return std::sqrt(sum / static_cast<double>(error.size()));
}

/// Share of the plucks whose error is below 1.96 sd.
inline double coverage(const pluck_errors& e, std::size_t which) {
  double inside = 0;
  for (std::size_t i = 0; i < e.error.size(); ++i) inside += std::abs(e.error[i][which]) < 1.96 * e.sd[i][which] ? 1 : 0;
  return inside / static_cast<double>(e.error.size());
}

/// One string, position and noise of many, and what its plucks are recorded with.
struct pluck_case {
  rosin::modal_rig rig{};
  rosin::modal_pluck pluck{};
  std::array<double, 2> gain{1, 1};
  double noise_N = 0;
  int bits = 16;
  rosin::modal_settings settings{};
};

inline pluck_case draw_pluck_case(std::uint64_t seed, rosin::damping_convention damping, double duration_s) {
  const rosin::random_rig r = rosin::draw_rig(seed);
  pluck_case c{r.rig, r.plucks[0], r.gain, r.noise_N, r.bits};
  c.rig.damping = damping;
  c.pluck.duration_s = duration_s;
  c.settings.mode_limit_Hz = 70e3;
  return c;
}

/// Noise-free recordings of both channels, one below the other.
inline Eigen::VectorXd recorded(const pluck_case& c) {
  const auto take = rosin::simulate_pluck(c.rig, c.pluck, c.settings);
  const auto n = static_cast<Eigen::Index>(take->size());
  Eigen::VectorXd both(2 * n);
  both << c.gain[0] * Eigen::VectorXd::Map(take->force_near_N.data(), n),
      c.gain[1] * Eigen::VectorXd::Map(take->force_far_N.data(), n);
  return both;
}

/// Cramer-Rao bounds with all nuisances free: pitch, stiffness, two laws of loss, convention of damping, two gains, position,
/// release, two offsets. White noise.
inline judged cramer_rao(const pluck_case& at) {
  constexpr Eigen::Index parameters = 11;
  const auto moved = [&](Eigen::Index p, double by) {
    pluck_case c = at;
    auto& s = c.rig.string;
    if (p == 0) s.fundamental_Hz += by;  // leaves b = pi^2 B / (T L^2) as it is
    if (p == 1) s.bending_stiffness_Nm2 += by * s.tension_N * s.length_m * s.length_m / (M_PI * M_PI);
    if (p == 2) s.loss.quality = 1 / (1 / s.loss.quality + by);
    if (p == 3) s.loss.internal_s += by;
    if (p == 5) c.gain[0] *= std::exp(by);
    if (p == 6) c.gain[1] *= std::exp(by);
    if (p == 7) c.pluck.position += by;
    if (p == 8) c.pluck.release_s += by;
    return recorded(c);
  };
  const std::array<double, 9> step{1e-5, 1e-9, 1e-7, 1e-12, 0, 1e-5, 1e-5, 1e-6, 1e-9};
  const Eigen::Index half = std::lround(at.pluck.duration_s * at.settings.sample_rate_Hz);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(2 * half, parameters);
  for (Eigen::Index p = 0; p < 9; ++p)
    if (const double h = step[static_cast<std::size_t>(p)]; h > 0) J.col(p) = (moved(p, h) - moved(p, -h)) / (2 * h);
  pluck_case viscous = at, in_stress = at;  // the two conventions are psi = -1 and +1, and all is linear in psi
  viscous.rig.damping = rosin::damping_convention::viscous;
  in_stress.rig.damping = rosin::damping_convention::kelvin_voigt;
  J.col(4) = (recorded(in_stress) - recorded(viscous)) / 2;
  J.col(9).head(half).setOnes();
  J.col(10).tail(half).setOnes();
  const double code = std::ldexp(2.0, 1 - at.bits), variance = at.noise_N * at.noise_N + code * code / 12;
  Eigen::MatrixXd information = J.transpose() * J / variance;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd covariance = scale.asDiagonal() *
                                     Eigen::MatrixXd((scale.asDiagonal() * information * scale.asDiagonal()).eval().inverse()) *
                                     scale.asDiagonal();
  const auto sd = [&](Eigen::Index p) { return std::sqrt(covariance(p, p)); };
  const double ratio = std::sqrt(covariance(5, 5) + covariance(6, 6) - 2 * covariance(5, 6));
  return {sd(0), sd(7), ratio, sd(1), sd(2), sd(8)};
}

/// Records, fits and judges one pluck; `error` and `sd` are appended.
inline void judge_pluck(const pluck_case& c, std::uint64_t seed, pluck_errors& out) {
  const auto truth = rosin::simulate_pluck(c.rig, c.pluck, c.settings);
  rosin::pluck_take take{"pluck", c.settings.sample_rate_Hz, {}, 1.0, 0.06, c.pluck.position};
  for (std::size_t channel = 0; channel < 2; ++channel)
    take.force_N[channel] = rosin::convert(channel == 0 ? truth->force_near_N : truth->force_far_N, take.rate_Hz,
                                           {.gain = c.gain[channel], .noise_N = c.noise_N, .bits = c.bits}, 2 * seed + channel)
                                .newtons();
  const rosin::pluck_guess guess{.fundamental_Hz = c.rig.string.fundamental_Hz * (seed % 2 ? 1.004 : 0.996),
                                 .inharmonicity = c.rig.string.inharmonicity()};
  const auto fit = rosin::fit_plucks({take}, guess);
  if (!fit || !fit->converged) {
    ++out.failed;
    return;
  }
  using layout = rosin::pluck_layout;
  const auto& v = fit->value;
  const Eigen::Index position = fit->layout.position(0), release = fit->layout.at(0, layout::release);
  const auto& C = fit->covariance;
  const double ratio_sd = std::sqrt(C(layout::gain_near, layout::gain_near) + C(layout::gain_far, layout::gain_far) -
                                    2 * C(layout::gain_near, layout::gain_far));
  const auto& s = c.rig.string;
  out.error.push_back({v[layout::fundamental] - s.fundamental_Hz, v[position] - c.pluck.position,
                       v[layout::gain_near] - v[layout::gain_far] - std::log(c.gain[0] / c.gain[1]),
                       v[layout::inharmonicity] - s.inharmonicity(), v[layout::inverse_quality] - 1 / s.loss.quality,
                       v[release] - c.pluck.release_s});
  out.sd.push_back({fit->sd[layout::fundamental], fit->sd[position], ratio_sd, fit->sd[layout::inharmonicity],
                    fit->sd[layout::inverse_quality], fit->sd[release]});
  out.misfit.push_back(fit->misfit);
}

/// `rigs` strings and positions with `each` plucks of different release and noise; the bound is computed once a rig.
inline pluck_errors judge_plucks(std::uint64_t first_seed, int rigs, int each, rosin::damping_convention damping,
                                 double duration_s, bool with_bound) {
  const auto one_rig = [=](std::uint64_t seed) {
    pluck_errors out;
    pluck_case c = draw_pluck_case(seed, damping, duration_s);
    const judged bound = with_bound ? cramer_rao(c) : judged{};
    for (int i = 0; i < each; ++i) {
      c.pluck.release_s += 1.37e-6;
      judge_pluck(c, 1000 * seed + static_cast<std::uint64_t>(i), out);
    }
    out.bound.assign(out.error.size(), bound);
    return out;
  };
  const auto some = [=](int begin) {
    std::vector<pluck_errors> parts;
    for (int i = begin; i < rigs; i += 2) parts.push_back(one_rig(first_seed + static_cast<std::uint64_t>(i)));
    return parts;
  };
  auto odd = std::async(std::launch::async, some, 1);
  std::vector<pluck_errors> parts = some(0);
  for (pluck_errors& p : odd.get()) parts.push_back(std::move(p));
  pluck_errors all;
  for (const pluck_errors& p : parts) {
    all.error.insert(all.error.end(), p.error.begin(), p.error.end());
    all.sd.insert(all.sd.end(), p.sd.begin(), p.sd.end());
    all.bound.insert(all.bound.end(), p.bound.begin(), p.bound.end());
    all.misfit.insert(all.misfit.end(), p.misfit.begin(), p.misfit.end());
    all.failed += p.failed;
  }
  return all;
}

}  // namespace proof
