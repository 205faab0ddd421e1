// tier: hosted
// SPDX-License-Identifier: MIT
//
// The contact while the string sticks. The declared model says: centre + torsion under the reconstructed force = the rod's speed.
// Every hypothesis adds columns to that equation (linear in the force, or functions of time) and is measured by how much likelier the
// takes become. All are tried on the same samples, those that stick when torsion is fitted freely; none can gain by what the
// reconstruction itself does not know (noise, disagreement of its two versions).
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/diagnose/contact_take.hpp>
#include <rosin/diagnose/stick_columns.hpp>
#include <rosin/diagnose/stick_design.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Records, the samples that stick, and the equation as declared.
class stick_bench {
public:
  static constexpr double passed_noise = 0.35;  ///< share of white noise's power that the window passes
  static constexpr double least_share = 0.6;    ///< of what the reconstruction does not know, the least that a fit may see
  static constexpr double most_trend = 2;       ///< of torsion's loss, in those of a flat spectrum of relaxations

  [[nodiscard]] static std::vector<stick_take> stick_takes(const std::vector<contact_take>& takes) {
    std::vector<stick_take> out;
    for (const auto& t : takes)
      out.push_back({t.force_N, t.velocity_m_s, t.rate_Hz, t.rod_speed_m_s, t.rest_delay_s(), t.rest_impedance_Ns_m(),
                     t.velocity_sd_m_s, t.edge_Hz, t.start_s, t.approach});
    return out;
  }

  template <class = void>
  stick_bench(const std::vector<contact_take>& takes, const contact_model& model)
      : records_{detail::records_of(stick_takes(takes))}, model_{model} {
    if (records_.empty()) return;
    for (const auto& t : takes)
      doubt_ = std::max(doubt_, doubt(t)), normal_force_N_.push_back(t.normal_force_N), noise_N_.push_back(t.noise_N),
      beside_waves_ = std::max(beside_waves_, beside_waves(t));
    doubt_ = std::hypot(doubt_, bristle_noise_m_s());
    free_ = fit_torsion(stick_takes(takes), model.torsion);
    mark();
    declare();
    if (usable()) follow_rod();
  }

  /// Makes the declared equation anew with this convention of damping.
  template <class = void>
  void use_damping(torsion_damping damping) {
    damping_ = damping;
    declared_ = equation(model_.torsion, damping, false);
    fit_ = fit_design(declared_, floor_m_s());
  }
  [[nodiscard]] torsion_damping damping() const noexcept { return damping_; }
  [[nodiscard]] bool usable() const noexcept { return rows_ > 600; }
  /// How well the velocity of what sticks is known; and the least scale that a fit may see in it.
  [[nodiscard]] double doubt_m_s() const noexcept { return doubt_; }
  [[nodiscard]] double floor_m_s() const noexcept { return least_share * doubt_; }
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
  /// Surface velocity less the rod's, as best known (free torsion, compliance, the model's ripple of the rod): for the slips.
  [[nodiscard]] const std::vector<std::vector<double>>& relative_m_s() const noexcept { return relative_; }

  /// The equation for another torsion; without one, for a string that does not turn. `loose`: parameters free, not declared.
  template <class = void>
  [[nodiscard]] stick_design equation(const std::optional<torsion_values>& torsion, torsion_damping damping, bool loose) {
    stick_design d;
    for (auto& record : records_) {
      std::vector<std::vector<double>> shared = record.compliance();
      auto target = record.relative_m_s();
      if (torsion) detail::add_to(target, record.force_through(torsion_at_contact(record.take(), *torsion, damping)));
      for (int k = 0; torsion && k < 3; ++k) shared.push_back(slope(record, *torsion, damping, k));
      if (torsion) shared.push_back(trend(record, *torsion));
      shared.push_back(record.force_N());
      for (auto& column : shared)
        for (double& v : column) v = -v;
      const auto which = d.rows.size();
      d.rows.push_back(pick(marked_[which], target, shared, record.rod_columns()));
    }
    d.add_bound(-4, 1.5);
    d.add_bound(-1.5, 1.5);
    for (int k = 0; torsion && k < 3; ++k)
      d.add_bound(loose ? -1.0 : -2 * model_.torsion_tolerance[k], loose ? 1.0 : 2 * model_.torsion_tolerance[k]);
    if (torsion) d.add_bound(-most_trend, most_trend);
    d.add_bound(-1.2 * beside_waves_, 0.2 * beside_waves_);
    include_found(d);
    return d;
  }

  /// Each take's own tone of the rod's speed: two more columns of its own.
  void add_rod_tone(stick_design& d, double frequency_Hz) const {
    for (std::size_t t = 0; t < records_.size(); ++t)
      for (const double turn : quarter_turns) d.add_own(t, rod_wave(records_[t], frequency_Hz, turn));
  }

  /// How a take's surface moves over bristles that flow as well as bend, at the samples that count. `bends`: their column in the
  /// equation, for a micrometre a newton; `compliance`: what they have.
  [[nodiscard]] std::vector<double> flowing(std::size_t take, const bristle_yield& yields, std::vector<double> bends,
                                            double compliance) {
    const auto& force = records_[take].force_N();
    for (std::size_t i = 0; i < bends.size(); ++i)
      if (marked_[take][i]) bends[i] *= yields.faster(force[i], normal_force_N_[take], -compliance * bends[i]);
    return bends;
  }

  /// What the sensors' noise is in a column, a take's force through a transfer function, rms: it reaches the force as
  /// f = F_1 cos(w tau_1) + F_2 cos(w tau_2).
  template <class Transfer>
  [[nodiscard]] double noise_through(std::size_t take, const Transfer& transfer) const {
    const stick_take& r = records_[take].take();
    const auto row = [&](double f) {
      const std::complex<double> through = transfer(f);
      return std::array{through * std::cos(2 * std::numbers::pi * f * r.delay_s[0]),
                        through * std::cos(2 * std::numbers::pi * f * r.delay_s[1])};
    };
    return detail::noise_of_ends(row, noise_N_[take], r.rate_Hz, records_[take].window());
  }

  /// Gains of an equation over the declared one; the same independence is granted to both.
  [[nodiscard]] std::array<double, 2> gains(const design_fit& with) const noexcept {
    return {with.share * (with.density - fit_.density), with.share * (with.held_out - fit_.held_out)};
  }

private:
  /// Half the disagreement of the two versions and the noise, through the window.
  [[nodiscard]] static double doubt(const contact_take& t) {
    double square = passed_noise * t.velocity_sd_m_s * t.velocity_sd_m_s;
    if (t.velocity_near_m_s.size() == t.velocity_m_s.size() && t.velocity_far_m_s.size() == t.velocity_m_s.size()) {
      double sum = 0, count = 1;
      for (std::size_t i = 0; i < t.velocity_m_s.size(); ++i)
        if (const double d = t.velocity_near_m_s[i] - t.velocity_far_m_s[i]; std::isfinite(d)) sum += d * d / 4, count += 1;
      square = std::max(square, sum / count);
    }
    return std::sqrt(square);
  }

  /// What the force's noise bends the model's bristles by, if it has any.
  [[nodiscard]] double bristle_noise_m_s() const {
    double most = 0;
    for (std::size_t t = 0; model_.bristle_stiffness_N_m && t < records_.size(); ++t)
      most = std::max(most, noise_through(t, [&](double f) {
                        return bristle_bending(f, model_.bristle_delay_s.value_or(0)) * (1e6 / *model_.bristle_stiffness_N_m);
                      }));
    return most;
  }

  template <class = void>
  [[nodiscard]] static std::vector<double> slope(stick_record& record, const torsion_values& at, torsion_damping damping, int k) {
    Eigen::Vector3d up = at.logs(), down = up;
    const double step = k == 0 ? 2e-4 : 2e-3;
    up[k] += step, down[k] -= step;
    const auto with = [&](const Eigen::Vector3d& logs) {
      return torsion_at_contact(record.take(), torsion_values::from_logs(logs), damping);
    };
    return record.force_through(transfer_slope<torsion_at_contact>{with(up), with(down), 1 / (2 * step)});
  }

  /// 1 / (2 pi Z Q), m/s per N: by so much of the force is the velocity too high that waves tell of a string that is damped mode by
  /// mode (string_response.hpp: what its modes lose at a load itself).
  [[nodiscard]] static double beside_waves(const contact_take& t) {
    return t.loss.inverse_q(0.5 / (t.delay_s[0] + t.delay_s[1])) / (2 * std::numbers::pi * t.impedance_Ns_m);
  }
  /// The loss of torsion is not the same at all frequencies: of a trend as large as a flat spectrum of relaxations has it.
  [[nodiscard]] static std::vector<double> trend(stick_record& record, const torsion_values& at) {
    constexpr double step = 0.01;
    torsion_waveguide up =
        torsion_of(record.take().delay_s, record.take().impedance_Ns_m, at.speed_ratio, at.impedance_ratio, at.q);
    up.causal = true;
    torsion_waveguide down = up;
    up.trend = step, down.trend = -step;
    return record.force_through(transfer_slope<torsion_waveguide>{up, down, 1 / (std::numbers::pi * at.q * step)});
  }

  void mark() {
    rows_ = 0;
    for (auto& record : records_) {
      auto surface = record.relative_m_s();
      if (free_ || model_.torsion) {
        const auto torsion = free_ ? free_->value : *model_.torsion;
        detail::add_to(surface, record.force_through(torsion_at_contact(record.take(), torsion,
                                                                        free_ ? free_->damping : torsion_damping::constant_q)));
      }
      if (free_) {
        const auto& slow = record.compliance();
        detail::add_to(surface, slow[0], free_->rest[0] / stick_record::compliance_unit);
        detail::add_to(surface, slow[1],
                       -free_->rest[1] * std::pow(2 * std::numbers::pi * stick_record::compliance_corner_Hz, 2) /
                           stick_record::compliance_unit);
      }
      marked_.push_back(sticking_samples(record, surface, {.least = 0.1, .most = 0.5, .fluctuations = 5}));
      for (const char m : marked_.back()) rows_ += m ? 1U : 0U;
      relative_.push_back(std::move(surface));
    }
  }

  template <class = void>
  void declare() {
    if (!usable()) return;
    use_damping(torsion_damping::constant_q);
    if (!model_.torsion) return;
    for (const auto other : {torsion_damping::viscous_modes, torsion_damping::causal_q, torsion_damping::causal_modes}) {
      const torsion_damping damping = damping_;
      const stick_design design = declared_;
      const design_fit fit = fit_;
      use_damping(other);
      if (!(fit_.density > fit.density)) damping_ = damping, declared_ = design, fit_ = fit;
    }
  }

  void include_found(stick_design& d) {
    if (model_.rod) {
      const auto [frequency_Hz, q, mass_kg] = *model_.rod;
      for (std::size_t t = 0; t < records_.size(); ++t)
        d.add_shared(t, records_[t].force_through(rod_mobility{frequency_Hz, q, mass_kg}));
      d.add_bound(0, 1e9);
    }
    if (model_.bristle_stiffness_N_m) {
      const double delay = model_.bristle_delay_s.value_or(0);
      for (std::size_t t = 0; t < records_.size(); ++t)
        d.add_shared(t, flowing(t, model_.yields, records_[t].force_through([=](double f) { return bristle_bending(f, delay); }),
                                1e6 / *model_.bristle_stiffness_N_m));
      d.add_bound(0, 1e9);
    }
    if (model_.creep_sharpness) {
      for (std::size_t t = 0; t < records_.size(); ++t)
        d.add_shared(t, creep_column(records_[t].force_N(), normal_force_N_[t], *model_.creep_sharpness));
      d.add_bound(0, 1e9);
    }
    if (model_.speed_ripple_Hz) add_rod_tone(d, *model_.speed_ripple_Hz);
  }

  /// What was found of the rod's motion - its approach, its ripple - is the rod's, while the string slips as well.
  void follow_rod() {
    for (std::size_t t = 0; t < records_.size(); ++t) {
      auto columns = records_[t].rod_columns();
      if (model_.speed_ripple_Hz)
        for (const double turn : quarter_turns) columns.push_back(rod_wave(records_[t], *model_.speed_ripple_Hz, turn));
      for (std::size_t k = 1; k < columns.size(); ++k)
        detail::add_to(relative_[t], columns[k], -fit_.solution.own[t][static_cast<Eigen::Index>(k)]);
    }
  }

  static constexpr std::array<double, 2> quarter_turns{0, 0.5 * std::numbers::pi};

  std::vector<stick_record> records_;
  std::vector<double> normal_force_N_;
  std::vector<std::array<double, 2>> noise_N_;
  contact_model model_;
  outcome<torsion_fit_result> free_ = failure{"not fitted"};
  double doubt_ = 0;
  double beside_waves_ = 0;
  std::size_t rows_ = 0;
  std::vector<std::vector<char>> marked_;
  std::vector<std::vector<double>> relative_;
  torsion_damping damping_ = torsion_damping::constant_q;
  stick_design declared_{};
  design_fit fit_;
};

namespace detail {

/// The hypothesis found nothing: it is the model as declared.
[[nodiscard]] inline contact_hypothesis nothing(const stick_bench& bench, contact_hypothesis h) {
  h.decided = false;
  h.share = bench.fit().share;
  h.fluctuation = bench.fit().solution.scale / bench.speed_m_s();
  h.statistic = "stick-fluctuation";
  return h;
}

/// `origin`: where in the take the samples count from; `unit`: what the residual is shown in.
[[nodiscard]] inline contact_trace trace_of(const std::vector<std::size_t>& samples, const Eigen::VectorXd& residual,
                                            std::size_t origin, double rate_Hz, double unit, const std::string& take) {
  contact_trace out{take, {}, {}};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    out.time_s.push_back(static_cast<double>(origin + samples[i]) / rate_Hz);
    out.left.push_back(residual[static_cast<Eigen::Index>(i)] / unit);
  }
  return out;
}

[[nodiscard]] inline contact_trace sticking_trace(stick_bench& bench, const stick_rows& rows, const Eigen::VectorXd& residual,
                                                  std::size_t take, const std::string& name) {
  const auto& record = bench.records()[take];
  return trace_of(rows.sample, residual, record.origin(), record.take().rate_Hz, bench.speed_m_s(), name);
}

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
