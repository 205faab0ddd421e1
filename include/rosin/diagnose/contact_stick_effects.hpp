// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects that show while the string sticks, each as columns in the equation of contact_stick.hpp. With eps = velocity of the
// surface less that of the rod as declared, and f the force (docs/explain/catalogue.md):
//
//     torsion                  eps = -(h_T - h_declared) * f
//     rod-resonance            eps = -Y * f,    Y = (s / m) / (s^2 + s w0 / q + w0^2): fixed in frequency whatever the string does
//     creep                    eps = -sgn(f) v_N exp((|f| / N - 1) / a)
//     speed-ripple             eps = v relative sin(2 pi frequency t + phase), whatever the force
//
// What is not linear is searched for on a grid, with a quick measure (how much of the weighted residual a column explains
// besides the columns there are), then settled by Gauss-Newton steps.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_stick.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// How much of the residual of a design further columns would explain, in units of its variance.
class explained {
public:
  template <class = void>
  explicit explained(const stick_design& design, const stick_solution& solution)
      : explained(design, solution.residual, solution.scale) {}

  /// With the weights that another fit of the same rows leaves them. Coefficients are held about zero as loosely as their bounds
  /// are wide.
  template <class Real = double>
  explained(const stick_design& design, const std::vector<Eigen::VectorXd>& residual, double scale)
      : design_{&design}, scale_{scale} {
    const stacked s = stack(design.rows);
    Eigen::VectorX<Real> left(s.y.size());
    for (std::size_t t = 0; t < design.rows.size(); ++t) left.segment(s.first[t], s.first[t + 1] - s.first[t]) = residual[t];
    weight_ = student_row_factors(left, scale_);
    first_ = s.first;
    basis_ = weight_.asDiagonal() * s.x;
    Eigen::VectorX<Real> hold = Eigen::VectorX<Real>::Constant(s.x.cols(), 1e-12);
    for (std::size_t i = 0; i < design.bounds.size(); ++i)
      hold[static_cast<Eigen::Index>(i)] += std::pow(2 * scale_ / std::max(1e-9, design.bounds[i][1] - design.bounds[i][0]), 2);
    inverse_ = (Eigen::MatrixX<Real>(basis_.transpose() * basis_) + Eigen::MatrixX<Real>(hold.asDiagonal())).inverse();
    residual_ = weight_.cwiseProduct(s.y);
    residual_ -= basis_ * (inverse_ * (basis_.transpose() * residual_));
  }

  /// One column, given for all samples of each take; `size` is its coefficient.
  template <class Real = double>
  [[nodiscard]] double by(const std::vector<std::vector<double>>& samples, double& size) const {
    Eigen::VectorX<Real> c(residual_.size());
    for (std::size_t t = 0; t < samples.size(); ++t) {
      const auto& at = design_->rows[t].sample;
      for (std::size_t i = 0; i < at.size(); ++i) c[first_[t] + static_cast<Eigen::Index>(i)] = samples[t][at[i]];
    }
    c = weight_.cwiseProduct(c);
    const Eigen::VectorX<Real> along = basis_.transpose() * c;
    const double left = c.squaredNorm() - along.dot(inverse_ * along);
    if (!(left > 1e-9 * c.squaredNorm())) return size = 0;
    const double dot = c.dot(residual_);
    size = dot / left;
    return dot * dot / left / (scale_ * scale_);
  }

  [[nodiscard]] const Eigen::VectorXd& weighted_residual() const noexcept { return residual_; }
  [[nodiscard]] const std::vector<Eigen::Index>& first() const noexcept { return first_; }

private:
  const stick_design* design_;
  double scale_;
  Eigen::VectorXd residual_, weight_;
  std::vector<Eigen::Index> first_;
  Eigen::MatrixXd basis_, inverse_;
};

/// Fills in what all hypotheses of sticking have in common.
inline void settle_hypothesis(stick_bench& bench, const design_fit& fit, contact_hypothesis& h) {
  const auto [all, held_out] = bench.gains(fit);
  h.gain = all;
  h.held_out_gain = held_out;
  h.share = fit.share;
  h.density = fit.density - bench.fit().density;
  h.held_out_density = fit.held_out - bench.fit().held_out;
  h.fluctuation = fit.solution.scale / bench.speed_m_s();
  h.statistic = "stick-fluctuation";
}

struct rod_fit {
  Eigen::VectorXd theta;
  double size = 0;
  design_fit fit{};
  Eigen::MatrixXd covariance;  ///< of size, then of theta
};

/// Gauss-Newton on rods of unit mass added to the declared equation; theta = ln(frequency), ln(q) stays between `low` and `high`.
/// Where it would still go after the last step is part of the doubt.
template <class Real = double>
[[nodiscard]] rod_fit fit_rod(stick_bench& bench, Eigen::VectorXd theta, double size, const Eigen::VectorXd& low,
                              const Eigen::VectorXd& high, int steps) {
  const auto rod = [](const Eigen::VectorX<Real>& at) { return rod_mobility{std::exp(at[0]), std::exp(at[1])}; };
  rod_fit out{.theta = theta, .size = size, .covariance = {}};
  constexpr double farthest = 0.3;
  Eigen::VectorX<Real> reach = Eigen::VectorX<Real>::Constant(theta.size(), farthest),
                       last = Eigen::VectorX<Real>::Zero(theta.size());
  for (int step = 0; step <= steps; ++step) {
    if (step == steps) reach.setConstant(farthest);
    stick_design d = bench.declared();
    for (std::size_t t = 0; t < d.rows.size(); ++t) {
      auto& record = bench.records()[t];
      d.add_shared(t, record.force_through(rod(out.theta)));
      for (Eigen::Index k = 0; k < theta.size(); ++k) {
        Eigen::VectorX<Real> up = out.theta, down = out.theta;
        up[k] += 2e-3, down[k] -= 2e-3;
        d.add_shared(t, record.force_through(transfer_slope<rod_mobility>{rod(up), rod(down), out.size / 4e-3}));
      }
    }
    d.add_bound(0, 1e30);
    for (Eigen::Index k = 0; k < theta.size(); ++k) d.add_bound(-reach[k], reach[k]);
    const Eigen::Index first = d.rows.front().shared.cols() - theta.size() - 1;
    stick_prior held;
    if (step == steps) out.fit = fit_design(d, bench.floor_m_s());
    else out.fit.solution = bounded_regression(d, bench.floor_m_s(), held);
    out.size = out.fit.solution.shared[first];
    out.covariance = out.fit.solution.covariance.bottomRightCorner(theta.size() + 1, theta.size() + 1);
    const Eigen::VectorX<Real> move = out.fit.solution.shared.tail(theta.size());
    if (step == steps) out.covariance.diagonal().tail(theta.size()) += move.cwiseAbs2();
    if (step == steps || !(out.size > 0)) break;
    for (Eigen::Index k = 0; k < theta.size(); ++k)
      if (move[k] * last[k] < 0) reach[k] *= 0.4;  // to and fro
    out.theta = (out.theta + move).cwiseMax(low).cwiseMin(high);
    last = move;
  }
  if (!(out.fit.density != 0)) out.fit = bench.fit();
  return out;
}

/// A rod of unit mass as a recursion on a force's samples, for some q at a time: quick, exact enough for a grid. [q][sample]
template <std::size_t N>
[[nodiscard]] std::array<std::vector<double>, N> ring(const std::vector<double>& force, double f0, const std::array<double, N>& q,
                                                      double rate) {
  const double g = std::tan(std::numbers::pi * std::min(f0 / rate, 0.49));
  std::array<std::vector<double>, N> out;
  std::array<double, N> low{}, band{}, back, gain;  // state-variable filters: trapezoidal rule, resonance where it belongs
  for (std::size_t k = 0; k < N; ++k) back[k] = 1 / q[k] + g, gain[k] = g / (1 + g / q[k] + g * g), out[k].resize(force.size());
  for (std::size_t i = 0; i < force.size(); ++i)
    for (std::size_t k = 0; k < N; ++k) {
      const double high = force[i] - back[k] * band[k] - low[k];
      const double b = gain[k] * high + band[k], l = g * b + low[k];
      out[k][i] = -b;
      band[k] = 2 * b - band[k], low[k] = 2 * l - low[k];
    }
  return out;
}

/// Within the width of a torsional mode, whose model is never exact.
[[nodiscard]] inline bool is_at_torsion(stick_bench& bench, double frequency_Hz) {
  if (!bench.model().torsion) return false;
  const stick_take& take = bench.records().front().take();
  const double first_Hz = 0.5 * bench.model().torsion->speed_ratio / (take.delay_s[0] + take.delay_s[1]),
               n = std::max(1.0, std::round(frequency_Hz / first_Hz));
  return std::abs(frequency_Hz / (n * first_Hz) - 1) < std::max(0.01, 0.5 / bench.model().torsion->q);
}

}  // namespace detail

/// Torsion is not as declared: its parameters free.
template <class = void>
[[nodiscard]] contact_hypothesis torsion_hypothesis(stick_bench& bench) {
  contact_hypothesis h{.effect = "torsion"};
  h.free_parameters = 3;
  const auto& free = bench.free_torsion();
  if (!free) return detail::nothing(bench, h);
  const auto design = bench.equation(free->value, free->damping, true);
  const auto fit = fit_design(design, bench.floor_m_s());
  detail::settle_hypothesis(bench, fit, h);
  h.parameters = {{"speed_ratio", free->value.speed_ratio, free->sd.speed_ratio},
                  {"impedance_ratio", free->value.impedance_ratio, free->sd.impedance_ratio},
                  {"q", free->value.q, free->sd.q}};
  h.decided = free->decided();
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis torsion_hypothesis(stick_bench&))

/// The rod gives way along its motion.
template <class Real = double>
[[nodiscard]] contact_hypothesis rod_hypothesis(stick_bench& bench) {
  contact_hypothesis h{.effect = "rod-resonance"};
  h.free_parameters = 3;
  const detail::explained quick(bench.declared(), bench.fit().solution);
  std::vector<std::vector<double>> force;
  for (auto& r : bench.records()) force.push_back(r.force_N());
  const double rate = bench.records().front().take().rate_Hz;
  constexpr double lowest_Hz = 80, lowest_q = 3.9, highest_q = 300;
  const double highest_Hz = std::min(0.16 * rate, 0.5 * bench.records().front().window().edge_Hz);
  double best = 0, f_best = 1000, q_best = 10;
  const auto attempt = [&]<std::size_t N>(double f0, const std::array<double, N>& qs) {
    std::array<std::vector<std::vector<double>>, N> columns;
    for (const auto& f : force) {
      auto rung = detail::ring(f, f0, qs, rate);
      for (std::size_t k = 0; k < N; ++k) columns[k].push_back(std::move(rung[k]));
    }
    for (std::size_t k = 0; k < N; ++k) {
      double size = 0;
      const double gain = quick.by(columns[k], size);
      if (size > 0 && gain > best) best = gain, f_best = f0, q_best = qs[k];
    }
  };
  for (double f0 = 120; f0 < highest_Hz; f0 *= 1.03) attempt(f0, std::array{4.0, 12.0, 40.0});
  for (double step = 0.02; step > 2e-4; step /= 2)
    for (const auto& [i, j] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}) {
      const double f0 = f_best * std::exp(i * step), q = q_best * std::exp(15 * j * step);
      if (f0 > lowest_Hz && f0 < highest_Hz && q > lowest_q && q < highest_q) attempt(f0, std::array{q});
    }
  if (!(best > 0)) return detail::nothing(bench, h);
  const Eigen::Vector2d start(std::log(f_best), std::log(q_best));
  const auto found = detail::fit_rod(bench, start, 1 / 5e-3, Eigen::Vector2d(std::log(lowest_Hz), std::log(lowest_q)),
                                     Eigen::Vector2d(std::log(highest_Hz), std::log(highest_q)), 5);
  detail::settle_hypothesis(bench, found.fit, h);
  const double f0 = std::exp(found.theta[0]), q = std::exp(found.theta[1]), mass = found.size > 0 ? 1 / found.size : 1e9;
  const Eigen::VectorX<Real> sd = contact_faults::rod_scatter * found.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  if (sd.size() == 3)
    h.parameters = {{"frequency_Hz", f0, f0 * std::hypot(sd[1], contact_faults::rod_frequency)},
                    {"q", q, q * std::hypot(sd[2], contact_faults::rod_q)},
                    {"mass_kg", mass, mass * std::hypot(mass * sd[0], contact_faults::rod_mass)}};
  constexpr double heaviest_kg = 0.15;  // modes of rods have grams
  // inside the range that was searched
  h.decided =
      found.size > 0 && mass < heaviest_kg && sd.size() == 3 && sd[1] < 0.3 && sd[2] < 1.5 && q > 4 && q < 0.98 * highest_q;
  constexpr double light = 250;  // m w_0 / Z; in two hundred rigs with rigid rods the lightest one seen has 816
  const stick_take& take = bench.records().front().take();
  const double weight = mass * 2 * std::numbers::pi * f0 / take.impedance_Ns_m,
               pitch_Hz = 0.5 / (take.delay_s[0] + take.delay_s[1]);
  const double heavy = q < 40 ? 2000 : 500;                           // those of rods ring shorter
  if (weight > heavy && f0 / q < 0.12 * pitch_Hz) h.decided = false;  // one harmonic alone may be a fault of the string's model
  h.peculiar = h.decided && weight < light && !detail::is_at_torsion(bench, f0);
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis rod_hypothesis(stick_bench&))

/// It creeps while it sticks, the faster the nearer to the limit of friction (creep.hpp):  v = -sgn(f) v_N exp((|f|/N - 1) / a),
/// v_N as fast as it would be under a force as large as the normal force.
template <class = void>
[[nodiscard]] contact_hypothesis creep_hypothesis(stick_bench& bench, const std::vector<contact_take>& takes) {
  contact_hypothesis h{.effect = "creep"};
  h.free_parameters = 2;
  const detail::explained quick(bench.declared(), bench.fit().solution);
  std::vector<std::vector<double>> force;
  for (auto& record : bench.records()) force.push_back(record.force_N());
  const auto columns = [&](double sharp) {
    std::vector<std::vector<double>> out;
    for (std::size_t t = 0; t < force.size(); ++t) out.push_back(creep_column(force[t], takes[t].normal_force_N, sharp));
    return out;
  };
  double best = 0, sharp = 0.1;
  const auto attempt = [&](double a) {
    double size = 0;
    const double gain = quick.by(columns(a), size);
    if (size > 0 && gain > best) best = gain, sharp = a;
  };
  constexpr double sharpest = 0.02, dullest = 2;
  for (double a = sharpest; a < dullest; a *= 1.5) attempt(a);
  if (!(best > 0)) return detail::nothing(bench, h);
  for (double reach = 0.2; reach > 2e-3; reach /= 2) {
    const double middle = sharp;
    for (const double a : {middle * std::exp(-reach), middle * std::exp(reach)})
      if (a > sharpest && a < dullest) attempt(a);
  }
  const auto fitted = [&](double a) {
    stick_design d = bench.declared();
    const auto column = columns(a);
    for (std::size_t t = 0; t < d.rows.size(); ++t) d.add_shared(t, column[t]);
    d.add_bound(0, 1e9);
    return fit_design(d, bench.floor_m_s());
  };
  const auto fit = fitted(sharp);
  detail::settle_hypothesis(bench, fit, h);
  // How sharp it is, is as sure as the gain is bent there; and with it goes the speed.
  constexpr double apart = 0.05;
  double below = 0, above = 0;
  const double bend =
      (2 * best - quick.by(columns(sharp * std::exp(-apart)), below) - quick.by(columns(sharp * std::exp(apart)), above)) /
      (apart * apart);
  const double of_log = bend > 2 ? std::sqrt(2 / bend) : 1;
  const Eigen::Index last = fit.solution.shared.size() - 1;
  const double speed = fit.solution.shared[last],
               of_speed = std::hypot(std::sqrt(std::max(0.0, fit.solution.covariance(last, last))),
                                     of_log * (above - below) / (2 * apart));
  h.parameters = {{"speed_at_normal_force_m_s", speed, std::hypot(of_speed, contact_faults::creep * speed)},
                  {"sharpness", sharp, sharp * std::hypot(of_log, contact_faults::creep)}};
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis creep_hypothesis(stick_bench&, const std::vector<contact_take>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
