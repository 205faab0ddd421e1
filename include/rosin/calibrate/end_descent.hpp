// tier: hosted
// SPDX-License-Identifier: MIT
//
// Plucks and modes of the ends on their way to the least squares (end_problem.hpp) at one length of the record: Levenberg and
// Marquardt, with weights from what lies between the partials and with what is known beforehand. What the first echoes cannot
// tell is kept by wide priors: 1/Q within 3e-3, internal loss within 3e-7 s, a mode's Q within a factor of 4.5 of 15.
//
#pragma once

#include <rosin/calibrate/end_search.hpp>
#include <rosin/calibrate/pluck_fit.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class end_descent {
public:
  /// Modes, values and normal equations: what a trial has to be able to go back to.
  struct state {
    std::vector<std::size_t> ends;
    Eigen::VectorXd v;
    normal_equations<> now;
  };

  template <class = void>
  end_descent(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& options,
              const std::array<known_admittance, 2>& known, const pluck_start& start)
      : takes_{takes}, guess_{guess}, model_{pluck_layout(takes, options), guess.ac_coupled_Hz, known, {}},
        limits_{options.limits_for(takes.front().rate_Hz)},
        v_{model_.layout.initial(takes, guess, start.fundamental_Hz, start.release_s, start.position)}, start_{v_} {
    for (const double t0 : start.release_s) begin_s_.push_back(std::max(0.0, t0 - 0.002));
    set_offsets();
  }

  [[nodiscard]] const end_model& model() const { return model_; }
  [[nodiscard]] const Eigen::VectorXd& value() const { return v_; }
  [[nodiscard]] const normal_equations<>& now() const { return now_; }
  [[nodiscard]] const end_problem& problem() const { return *problem_; }
  [[nodiscard]] const band& limits() const { return limits_; }
  [[nodiscard]] const std::vector<double>& begins_s() const { return begin_s_; }
  [[nodiscard]] std::array<double, 2> noise() const { return noise_; }
  [[nodiscard]] int iterations() const { return iterations_; }
  [[nodiscard]] bool converged() const { return converged_; }

  /// How long every take rings on after its release.
  [[nodiscard]] double shortest_s() const {
    double s = 1e9;
    for (std::size_t t = 0; t < takes_.size(); ++t)
      s = std::min(s, static_cast<double>(takes_[t].force_N[0].size()) / takes_[t].rate_Hz - begin_s_[t]);
    return s;
  }

  /// Settles with the first `periods` periods in view, and weighs.
  template <class = void>
  void look(double periods, double highest_Hz, int most) {
    problem_ = end_problem(takes_, begin_s_, v_[0] / periods, std::min(highest_Hz, limits_.pass_Hz));
    problem_->set_noise(noise_);
    settle(most);
    weigh();
    settle(most);
  }

  [[nodiscard]] state keep() const { return {model_.mode_end, v_, now_}; }
  template <class = void>
  void restore(const state& s) {
    model_.mode_end = s.ends, v_ = s.v, now_ = s.now;
  }

  template <class = void>
  void insert(const mode_candidate& c) {
    model_.mode_end.push_back(c.end);
    v_.conservativeResize(model_.size());
    v_.tail<end_model::per_mode>() << std::log(c.mode.frequency_Hz), std::log(c.mode.q),
        std::log(std::clamp(c.mode.per_mass_per_s, 1e-6, 1e5));
  }
  template <class Real = double>
  void erase(std::size_t mode) {
    const Eigen::Index at = model_.mode_at(mode), rest = v_.size() - at - end_model::per_mode;
    const Eigen::VectorX<Real> tail = v_.tail(rest);
    v_.conservativeResize(v_.size() - end_model::per_mode);
    v_.tail(rest) = tail;
    model_.mode_end.erase(model_.mode_end.begin() + static_cast<std::ptrdiff_t>(mode));
  }
  /// Moves a mode to the other end.
  void swap_end(std::size_t mode) { model_.mode_end[mode] = 1 - model_.mode_end[mode]; }

  template <class = void>
  void settle(int most) {
    auto found = levenberg_marquardt(*this, v_,
                                     {.first = 1e-4,
                                      .less = 1.0 / 8,
                                      .more = 20,
                                      .floor = 1e-10,
                                      .iterations = most,
                                      .enough = 0.02,
                                      .enough_relative = 1e-6});
    v_ = std::move(found.at), now_ = std::move(found.equations);
    iterations_ += found.iterations, converged_ = found.converged();
  }

  /// What the residual's power at the partials is times the noise's; 1: nothing is left.
  template <class = void>
  [[nodiscard]] double misfit() const {
    double above = 0, below = 0;
    for (std::size_t t = 0; t < takes_.size(); ++t)
      for (std::size_t c = 0; c < 2; ++c) {
        const auto r = problem_->at(model_, v_, t, c);
        const Eigen::Index n = r.model_power.size();
        const auto& line = problem_->line(t);
        for (Eigen::Index i = 0; i < n; ++i) {
          const double weight = r.model_power[i] * r.model_power[i] > 0 ? std::sqrt(r.model_power[i]) : 0.0;
          above += weight * (r.residual[i] * r.residual[i] + r.residual[n + i] * r.residual[n + i]);
          below += weight * 2 * line.weighted_samples() / static_cast<double>(line.samples);
        }
      }
    return std::max(1.0, above / std::max(1e-300, below));
  }

  /// What is known beforehand, and what keeps a parameter that the first echoes cannot tell from running away.
  [[nodiscard]] pluck_layout::knowledge prior(Eigen::Index p) const {
    using layout = pluck_layout;
    if (p >= model_.layout.size())
      return (p - model_.layout.size()) % end_model::per_mode == 1 ? layout::knowledge{std::log(15.0), 1.5}
                                                                   : layout::knowledge{0, 0};
    if (p == layout::inverse_quality) return {1 / guess_.quality, 3e-3};
    if (p == layout::internal_loss) return {0, 3e-7};
    if (p == layout::inharmonicity && guess_.inharmonicity > 0) return {guess_.inharmonicity, guess_.inharmonicity};
    return model_.layout.prior(p, takes_, guess_);
  }

  /// A problem of least squares (math/levenberg_marquardt.hpp) with what is known beforehand, and the points that make sense.
  template <class = void>
  [[nodiscard]] normal_equations<> linearise(const Eigen::VectorXd& v) const {
    normal_equations<> eq = problem_->linearise(model_, v);
    for (Eigen::Index p = 0; p < model_.size(); ++p) {
      if (!model_.is_free(p)) eq.hessian(p, p) = 1;
      const auto [known, sd] = prior(p);
      if (sd <= 0 || !model_.is_free(p)) continue;
      eq.hessian(p, p) += 1 / (sd * sd);
      eq.gradient[p] += (known - v[p]) / (sd * sd);
      eq.cost += (known - v[p]) * (known - v[p]) / (sd * sd);
    }
    return eq;
  }

  template <class = void>
  [[nodiscard]] bool plausible(const Eigen::VectorXd& v) const {
    const auto n = model_.layout.size();
    bool ok = model_.layout.plausible(v.head(n), start_, limits_.pass_Hz);
    for (std::size_t i = 0; i < model_.mode_end.size(); ++i) {
      const admittance_mode m = model_.mode(v, i);
      ok = ok && m.frequency_Hz > 20 && m.frequency_Hz < 1.3 * limits_.pass_Hz && m.q > 0.3 && m.q < 5000 &&
           m.per_mass_per_s > 1e-7 && m.per_mass_per_s < 1e6;
    }
    return ok;
  }

private:
  /// From the mean before the release; the static force is taken as declared.
  void set_offsets() {
    const auto& L = model_.layout;
    for (std::size_t t = 0; t < takes_.size(); ++t)
      for (std::size_t c = 0; c < 2; ++c) {
        if (guess_.ac_coupled_Hz[c] > 0) continue;
        const auto count = std::max<std::size_t>(1, static_cast<std::size_t>(begin_s_[t] * takes_[t].rate_Hz));
        double mean = 0;
        for (std::size_t i = 0; i < count; ++i) mean += takes_[t].force_N[c][i] / static_cast<double>(count);
        v_[L.at(t, pluck_layout::offset_near + static_cast<int>(c))] =
            mean - takes_[t].strength_N * static_forces(v_[L.position(t)])[c];
      }
  }

  /// The noise between the partials: what it is at half of all frequencies.
  template <class = void>
  void weigh() {
    for (std::size_t c = 0; c < 2; ++c) {
      std::vector<double> power;
      double expected = 0;
      for (std::size_t t = 0; t < takes_.size(); ++t) {
        const auto r = problem_->at(model_, v_, t, c);
        const Eigen::Index n = r.model_power.size();
        const auto& line = problem_->line(t);
        const double one = 2 * line.weighted_samples() / static_cast<double>(line.samples);
        expected += one / static_cast<double>(takes_.size());
        for (Eigen::Index i = 0; i < n; ++i)
          power.push_back(r.residual[i] * r.residual[i] + r.residual[n + i] * r.residual[n + i]);
      }
      const auto middle = power.begin() + static_cast<std::ptrdiff_t>(power.size() / 2);
      std::nth_element(power.begin(), middle, power.end());
      noise_[c] = std::max(1e-9, problem_->noise()[c] * std::sqrt(*middle / (std::numbers::ln2 * expected)));
    }
    problem_->set_noise(noise_);
  }

  const std::vector<pluck_take>& takes_;
  pluck_guess guess_;
  end_model model_;
  band limits_;
  Eigen::VectorXd v_, start_;
  std::vector<double> begin_s_;
  normal_equations<> now_;
  std::optional<end_problem> problem_;
  std::array<double, 2> noise_{1e-2, 1e-2};
  int iterations_ = 0;
  bool converged_ = false;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
