// tier: hosted
// SPDX-License-Identifier: MIT
//
// The bench on which laws of friction are set against the slips of all takes: coefficients of friction, what noise and imperfect
// models leave of them, the law as declared, and a ripple of the normal force beside any law.
//
#pragma once

#include <rosin/diagnose/contact_ripple.hpp>
#include <rosin/diagnose/friction_laws.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A law and the tone of the normal force that goes with it: N (1 + Im(relative exp(2 pi i f t))), size and phase of each take.
struct law_under_tone {
  law_fit law{};
  std::vector<std::complex<double>> relative{};

  [[nodiscard]] double size() const {
    double sum = 0;
    for (const auto& r : relative) sum += std::abs(r);
    return relative.empty() ? 0 : sum / static_cast<double>(relative.size());
  }
};

/// Slips of all takes, and the law as declared fitted to them.
class slip_bench {
public:
  template <class = void>
  slip_bench(stick_bench& sticks, const std::vector<contact_take>& takes)
      : records_{slip_records(sticks, takes)}, pitches_{pitches_of(sticks)} {
    std::size_t samples = 0;
    for (std::size_t t = 0; t < records_.size(); ++t) {
      samples += records_[t].slips.sample.size();
      noise_ = std::max(noise_, 0.6 * takes[t].force_sd_N / takes[t].normal_force_N);
      level_sd_ = std::max(level_sd_, takes[t].level_sd_N / takes[t].normal_force_N);
    }
    usable_ = samples > 400 && std::all_of(records_.begin(), records_.end(),
                                           [](const auto& r) { return r.slips.sample.size() > 100 && r.normal_N > 0; });
    if (!usable_) return;
    ripple_Hz_ = sticks.model().normal_ripple_Hz;
    if (const auto& known = sticks.model().heat) heat_ = {.layer_m = (*known)[0], .area_per_newton_m2 = (*known)[1]};
    declared_ = fit(sticks.model().law == contact_law::thermal);
  }

  [[nodiscard]] bool usable() const noexcept { return usable_; }
  /// What imperfect models leave of a coefficient of friction, or noise does; and what of it two laws may be told apart by.
  [[nodiscard]] double floor() const noexcept { return std::max(0.003, noise_); }
  [[nodiscard]] double least_floor() const noexcept { return std::max(0.001, noise_); }
  [[nodiscard]] const std::vector<slip_record>& records() const noexcept { return records_; }
  [[nodiscard]] const law_fit& declared() const noexcept { return declared_; }
  [[nodiscard]] const std::vector<stroke_pitch>& pitches() const noexcept { return pitches_; }
  /// Of the mean friction coefficient, where sensors lost the force's mean.
  [[nodiscard]] double level_sd() const noexcept { return level_sd_; }
  /// The thermal law or the curve along the motion, a known ripple of the normal force besides.
  template <class = void>
  [[nodiscard]] law_fit fit(bool thermal) const {
    return ripple_Hz_ ? fit_under(*ripple_Hz_, thermal).law : fit_to(records_, thermal);
  }
  /// A law and a tone of the normal force, found in turn: the tone in what the law leaves, the law in what the force is of
  /// the normal force then. Heat is sought once the curve has taken the most of the tone out.
  template <class = void>
  [[nodiscard]] law_under_tone fit_under(double f_Hz, bool thermal) const {
    law_under_tone out{fit_to(records_, false), std::vector<std::complex<double>>(records_.size())};
    const auto settle = [&](const auto& refit) {
      constexpr int most = 12;
      constexpr double settled = 1e-4;
      for (int round = 0; round < most && take_up_tone(f_Hz, out) > settled; ++round) out.law = refit(under(f_Hz, out.relative));
    };
    settle([&](const auto& loaded) { return fit_to(loaded, false); });
    for (int search = 0; thermal && search < (heat_ ? 1 : 2); ++search) {
      out.law = fit_to(under(f_Hz, out.relative), true);
      settle([&](const auto& loaded) { return with_levels(fit_again(loaded, floor(), out.law)); });
    }
    return out;
  }

  /// Friction as the declared law has it, at the rows of a take.
  template <class = void>
  [[nodiscard]] Eigen::VectorXd predicted(std::size_t take) const {
    return declared_.design.rows[take].target - declared_.fit.solution.residual[take];
  }
  /// Adds a tone of N to a design of the declared law.
  template <class Real = double>
  void add_tone(stick_design& d, double f) const {
    for (std::size_t t = 0; t < records_.size(); ++t)
      for (const double turn : {0.0, 0.5 * std::numbers::pi}) {
        auto& rows = d.rows[t];
        const Eigen::VectorX<Real> mu = predicted(t);
        const Eigen::Index c = rows.own.cols();
        rows.own.conservativeResize(rows.target.size(), c + 1);
        for (Eigen::Index i = 0; i < mu.size(); ++i)
          rows.own(i, c) =
              mu[i] * std::sin(2 * std::numbers::pi * f * static_cast<double>(rows.sample[static_cast<std::size_t>(i)]) /
                                   records_[t].rate_Hz +
                               turn);
      }
  }

private:
  template <class = void>
  [[nodiscard]] law_fit fit_to(const std::vector<slip_record>& records, bool thermal) const {
    return with_levels(!thermal ? fit_velocity_curve(records, floor())
                       : heat_  ? fit_memory(records, floor(), *heat_)
                                : fit_thermal(records, floor()));
  }
  /// Where the mean force was lost, strokes may be off against the first by a constant.
  template <class = void>
  [[nodiscard]] law_fit with_levels(law_fit law) const {
    if (!(level_sd_ > 0)) return law;
    detail::free_levels(law.design);
    law.fit = fit_design(law.design, floor());
    return law;
  }
  /// The tone in what the law leaves of the force as it is; by how much it moved.
  template <class Real = double>
  [[nodiscard]] double take_up_tone(double f_Hz, law_under_tone& found) const {
    double moved = 0;
    for (std::size_t t = 0; t < records_.size(); ++t) {
      const auto& rows = found.law.design.rows[t];
      const auto& left = found.law.fit.solution.residual[t];
      const auto n = static_cast<std::size_t>(rows.target.size() - (rows.shared.cols() - 2));
      const Eigen::VectorX<Real> mu = rows.target - left;
      Eigen::VectorX<Real> beyond = left;
      for (std::size_t i = 0; i < n; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        beyond[k] += rows.target[k] * tone_at(found.relative[t], f_Hz, rows.sample[i], records_[t].rate_Hz);
      }
      const tone_rows take{beyond, mu, detail::student_row_factors(left, found.law.residual()), rows.sample, records_[t].rate_Hz};
      std::complex<double> relative = detail::sums_at(take, f_Hz, 0, n).solve();
      if (constexpr double most = 0.8; std::abs(relative) > most) relative *= most / std::abs(relative);
      moved = std::max(moved, std::abs(relative - found.relative[t]));
      found.relative[t] = relative;
    }
    return moved;
  }
  [[nodiscard]] static double tone_at(std::complex<double> relative, double f_Hz, std::size_t i, double rate_Hz) {
    return (relative * std::polar(1.0, 2 * std::numbers::pi * f_Hz * static_cast<double>(i) / rate_Hz)).imag();
  }
  /// The same motions under a normal force that carries the tone.
  [[nodiscard]] std::vector<slip_record> under(double f_Hz, const std::vector<std::complex<double>>& relative) const {
    std::vector<slip_record> out = records_;
    for (std::size_t t = 0; t < out.size(); ++t) {
      auto& r = out[t];
      r.load.resize(r.force_N.size());
      for (std::size_t i = 0; i < r.load.size(); ++i) r.load[i] = 1 + tone_at(relative[t], f_Hz, i, r.rate_Hz);
      for (Eigen::Index k = 0; k < r.slips.friction.size(); ++k)
        r.slips.friction[k] /= r.load[r.slips.sample[static_cast<std::size_t>(k)]];
    }
    return out;
  }

  std::vector<slip_record> records_;
  std::vector<stroke_pitch> pitches_;
  double noise_ = 0, level_sd_ = 0;
  bool usable_ = false;
  std::optional<double> ripple_Hz_;
  std::optional<contact_heat_parameters<double>> heat_;
  law_fit declared_{};
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
