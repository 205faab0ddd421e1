// tier: hosted
// SPDX-License-Identifier: MIT
//
// The contact while the string sticks. The declared model says: centre + torsion under the reconstructed force = the rod's speed.
// Every hypothesis adds columns to that equation (what is linear in the force, or a function of time), and is measured by how
// much likelier the takes become. All hypotheses are tried on the same samples, those that stick when torsion is fitted
// freely; and none can gain by what the reconstruction itself does not know (noise, disagreement of its two versions).
//
#pragma once

#include <rosin/diagnose/contact_take.hpp>

namespace rosin {

/// The equation's rows, ready for more columns.
struct stick_design {
  std::vector<stick_rows> rows;
  std::vector<std::array<double, 2>> bounds;  ///< of the shared coefficients

  void add_shared(std::size_t take, const std::vector<double>& samples) { append(rows[take].shared, rows[take].sample, samples); }
  void add_own(std::size_t take, const std::vector<double>& samples) { append(rows[take].own, rows[take].sample, samples); }
  void add_bound(double low, double high) { bounds.push_back({low, high}); }

private:
  static void append(Eigen::MatrixXd& to, const std::vector<std::size_t>& at, const std::vector<double>& samples) {
    const Eigen::Index c = to.cols();
    to.conservativeResize(static_cast<Eigen::Index>(at.size()), c + 1);
    for (std::size_t i = 0; i < at.size(); ++i) to(static_cast<Eigen::Index>(i), c) = samples[at[i]];
  }
};

/// A regression with its likelihoods: of everything, and of each part as predicted from the others.
struct design_fit {
  stick_solution solution{};
  double density = 0, held_out = 0;  ///< sums of log densities over all rows, as if these were independent
  double share = 1;                  ///< independent rows / rows
};

namespace detail {

/// Takes cut in halves if there is only one.
[[nodiscard]] inline std::vector<stick_rows> at_least_two(const std::vector<stick_rows>& rows) {
  if (rows.size() != 1) return rows;
  const auto& r = rows.front();
  const Eigen::Index half = r.target.size() / 2, rest = r.target.size() - half;
  const auto middle = r.sample.begin() + half;
  return {{r.target.head(half), r.shared.topRows(half), r.own.topRows(half), {r.sample.begin(), middle}},
          {r.target.tail(rest), r.shared.bottomRows(rest), r.own.bottomRows(rest), {middle, r.sample.end()}}};
}

/// Log density of one part under the shared coefficients of the others; its own coefficients and the size of what is left are its own.
[[nodiscard]] inline double predict_part(const std::vector<stick_rows>& parts, std::size_t which, double floor, const stick_prior& prior) {
  std::vector<stick_rows> others;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i != which && parts[i].target.size() > parts[i].own.cols() + parts[i].shared.cols()) others.push_back(parts[i]);
  stick_rows left = parts[which];
  if (others.empty() || left.target.size() <= left.own.cols()) return 0;
  const auto trained = stick_regression(others, floor, prior);
  left.target -= left.shared * trained.shared;
  left.shared.resize(left.target.size(), 0);
  const auto seen = stick_regression({left}, floor);
  double sum = 0;
  for (const double r : seen.residual.front()) sum += student_log_density(r, seen.scale);
  return sum;
}

}  // namespace detail

/// The regression with coefficients that would leave their bounds held there.
[[nodiscard]] inline stick_solution bounded_regression(const stick_design& design, double floor, stick_prior& held) {
  const auto n = static_cast<Eigen::Index>(design.bounds.size());
  held = {Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  stick_solution s = stick_regression(design.rows, floor);
  for (int pass = 0; pass < 4; ++pass) {
    bool inside = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto [low, high] = design.bounds[static_cast<std::size_t>(i)];
      const double slack = 1e-6 * (1 + std::abs(low) + std::abs(high));
      if (held.precision[i] > 0 || (s.shared[i] >= low - slack && s.shared[i] <= high + slack)) continue;
      held.centre[i] = s.shared[i] < low ? low : high;
      held.precision[i] = 1e14;
      inside = false;
    }
    if (inside) break;
    s = stick_regression(design.rows, floor, held);
  }
  return s;
}

[[nodiscard]] inline design_fit fit_design(const stick_design& design, double floor) {
  stick_prior held;
  design_fit fit{};
  fit.solution = bounded_regression(design, floor, held);
  fit.share = fit.solution.effective / std::max(1.0, fit.solution.rows);
  fit.density = fit.solution.log_likelihood / fit.share;
  const auto parts = detail::at_least_two(design.rows);
  for (std::size_t i = 0; i < parts.size(); ++i) fit.held_out += detail::predict_part(parts, i, floor, held);
  return fit;
}

/// Records, the samples that stick, and the equation as declared.
class stick_bench {
public:
  [[nodiscard]] static std::vector<stick_take> stick_takes(const std::vector<contact_take>& takes) {
    std::vector<stick_take> out;
    for (const auto& t : takes)
      out.push_back({t.force_N, t.velocity_m_s, t.rate_Hz, t.rod_speed_m_s, t.delay_s, t.impedance_Ns_m, t.velocity_sd_m_s, t.edge_Hz, t.start_s});
    return out;
  }

  stick_bench(const std::vector<contact_take>& takes, const contact_model& model)
      : records_{detail::records_of(stick_takes(takes))}, model_{model} {
    if (records_.empty()) return;
    for (const auto& t : takes) doubt_ = std::max(doubt_, doubt(t));
    free_ = fit_torsion(stick_takes(takes), model.torsion);
    mark();
    declare();
  }

  /// Makes the declared equation anew with this convention of damping.
  void use_damping(torsion_damping damping) {
    damping_ = damping;
    declared_ = equation(model_.torsion, damping, false);
    fit_ = fit_design(declared_, floor_m_s());
  }
  [[nodiscard]] torsion_damping damping() const noexcept { return damping_; }
  [[nodiscard]] bool usable() const noexcept { return rows_ > 600; }
  /// How well the velocity of what sticks is known; and the least scale that a fit may see in it.
  [[nodiscard]] double doubt_m_s() const noexcept { return doubt_; }
  [[nodiscard]] double floor_m_s() const noexcept { return 0.6 * doubt_; }
  [[nodiscard]] const contact_model& model() const noexcept { return model_; }
  [[nodiscard]] const stick_design& declared() const noexcept { return declared_; }
  [[nodiscard]] const design_fit& fit() const noexcept { return fit_; }
  [[nodiscard]] const outcome<torsion_fit_result>& free_torsion() const noexcept { return free_; }
  [[nodiscard]] std::vector<stick_record>& records() noexcept { return records_; }
  [[nodiscard]] double independent() const noexcept { return fit_.solution.effective; }
  /// Mean speed of the rod, by which fluctuations are measured.
  [[nodiscard]] double speed_m_s() const noexcept {
    double sum = 0;
    for (const auto& r : records_) sum += std::abs(r.take().rod_speed_m_s);
    return sum / static_cast<double>(std::max<std::size_t>(1, records_.size()));
  }
  /// Surface velocity less the rod's, as best known (free torsion and compliance), for whoever needs the slips.
  [[nodiscard]] const std::vector<std::vector<double>>& relative_m_s() const noexcept { return relative_; }

  /// The equation for another torsion; without one, for a string that does not turn. `loose`: parameters free, not declared.
  [[nodiscard]] stick_design equation(const std::optional<torsion_values>& torsion, torsion_damping damping, bool loose) {
    stick_design d;
    for (auto& record : records_) {
      std::vector<std::vector<double>> shared = record.compliance();
      auto target = record.relative_m_s();
      if (torsion) detail::add_to(target, record.force_through(torsion_at_contact(record.take(), *torsion, damping)));
      for (int k = 0; torsion && k < 3; ++k) shared.push_back(slope(record, *torsion, damping, k));
      for (auto& column : shared)
        for (double& v : column) v = -v;
      const auto which = d.rows.size();
      d.rows.push_back(pick(marked_[which], target, shared, {std::vector<double>(target.size(), 1.0)}));
    }
    d.add_bound(-4, 1.5);
    d.add_bound(-1.5, 1.5);
    for (int k = 0; torsion && k < 3; ++k) d.add_bound(loose ? -1.0 : -2 * model_.torsion_tolerance[k], loose ? 1.0 : 2 * model_.torsion_tolerance[k]);
    include_found(d);
    return d;
  }

  /// Gains of an equation over the declared one; the same independence is granted to both.
  [[nodiscard]] std::array<double, 2> gains(const design_fit& with) const noexcept {
    return {with.share * (with.density - fit_.density), with.share * (with.held_out - fit_.held_out)};
  }

private:
  /// Half the disagreement of the two versions and the noise, through the window.
  [[nodiscard]] static double doubt(const contact_take& t) {
    double square = 0.35 * t.velocity_sd_m_s * t.velocity_sd_m_s;  // share of white noise that the window passes
    if (t.velocity_near_m_s.size() == t.velocity_m_s.size() && t.velocity_far_m_s.size() == t.velocity_m_s.size()) {
      double sum = 0, count = 1;
      for (std::size_t i = 0; i < t.velocity_m_s.size(); ++i)
        if (const double d = t.velocity_near_m_s[i] - t.velocity_far_m_s[i]; std::isfinite(d)) sum += d * d / 4, count += 1;
      square = std::max(square, sum / count);
    }
    return std::sqrt(square);
  }

  [[nodiscard]] static std::vector<double> slope(stick_record& record, const torsion_values& at, torsion_damping damping, int k) {
    Eigen::Vector3d up = at.logs(), down = up;
    const double step = k == 0 ? 2e-4 : 2e-3;
    up[k] += step, down[k] -= step;
    auto column = record.force_through(torsion_at_contact(record.take(), torsion_values::from_logs(up), damping));
    detail::add_to(column, record.force_through(torsion_at_contact(record.take(), torsion_values::from_logs(down), damping)), -1);
    for (double& v : column) v /= 2 * step;
    return column;
  }

  void mark() {
    rows_ = 0;
    for (auto& record : records_) {
      auto surface = record.relative_m_s();
      if (free_ || model_.torsion) {
        const auto torsion = free_ ? free_->value : *model_.torsion;
        detail::add_to(surface, record.force_through(torsion_at_contact(record.take(), torsion, free_ ? free_->damping : torsion_damping::constant_q)));
      }
      if (free_) {
        const auto& slow = record.compliance();
        detail::add_to(surface, slow[0], free_->rest[0] / stick_record::compliance_unit);
        detail::add_to(surface, slow[1], -free_->rest[1] * std::pow(2 * std::numbers::pi * stick_record::compliance_corner_Hz, 2) / stick_record::compliance_unit);
      }
      marked_.push_back(sticking_samples(record, surface, {.least = 0.1, .most = 0.5, .fluctuations = 5}));
      for (const char m : marked_.back()) rows_ += m ? 1U : 0U;
      relative_.push_back(std::move(surface));
    }
  }

  void declare() {
    if (!usable()) return;
    use_damping(torsion_damping::constant_q);
    if (!model_.torsion) return;
    const stick_design design = declared_;
    const design_fit fit = fit_;
    use_damping(torsion_damping::viscous_modes);
    if (fit_.density > fit.density) return;
    damping_ = torsion_damping::constant_q;
    declared_ = design;
    fit_ = fit;
  }

  void include_found(stick_design& d) {
    if (model_.rod) {
      const double f0 = (*model_.rod)[0], q = (*model_.rod)[1], mass = (*model_.rod)[2];
      for (std::size_t t = 0; t < records_.size(); ++t)
        d.add_shared(t, records_[t].force_through([=](double f) { return -std::complex<double>(0, f / (2 * std::numbers::pi * mass)) / std::complex<double>(f0 * f0 - f * f, f * f0 / q); }));
      d.add_bound(0, 1e9);
    }
    if (model_.bristle_stiffness_N_m) {
      const double delay = model_.bristle_delay_s.value_or(0);
      for (std::size_t t = 0; t < records_.size(); ++t)
        d.add_shared(t, records_[t].force_through([=](double f) { const std::complex<double> s(0, 2 * std::numbers::pi * f); return -1e-6 * s / (1.0 + s * delay); }));
      d.add_bound(0, 1e9);
    }
    if (model_.speed_ripple_Hz)
      for (std::size_t t = 0; t < records_.size(); ++t)
        for (const double turn : {0.0, 0.5 * std::numbers::pi}) {
          std::vector<double> wave(records_[t].size());
          for (std::size_t i = 0; i < wave.size(); ++i)
            wave[i] = records_[t].take().rod_speed_m_s * std::sin(2 * std::numbers::pi * *model_.speed_ripple_Hz * static_cast<double>(i) / records_[t].take().rate_Hz + turn);
          d.add_own(t, wave);
        }
  }

  std::vector<stick_record> records_;
  contact_model model_;
  outcome<torsion_fit_result> free_ = failure{"not fitted"};
  double doubt_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::vector<char>> marked_;
  std::vector<std::vector<double>> relative_;
  torsion_damping damping_ = torsion_damping::constant_q;
  stick_design declared_{};
  design_fit fit_;
};

}  // namespace rosin
