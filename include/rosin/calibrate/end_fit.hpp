// tier: hosted
// SPDX-License-Identifier: MIT
//
// How the terminations give way, from plucks alone: the admittances of the ends as sums of modes, as many as the recordings ask
// for, fitted jointly with pitch, place, stiffness, loss, gains and releases (end_problem.hpp).
//
// The fit begins with the first echoes, which tell one end from the other, and follows them to the whole record, which is what
// tells small motion; at every length modes are added while one more is worth it (end_search.hpp) and taken out again where they
// are not. A gain in ln L has to be `least_gain` times what the misfit that is left would give by chance. Errors are those of the
// joint fit, widened by that misfit and by what conventions of damping differ in: next to a string of quality Q they move a
// mode's ln(Z/M) by 1/(2Q), its pitch by half of that and its own loss by 1/(2Q).
//
#pragma once

#include <rosin/calibrate/end_descent.hpp>
#include <rosin/core/instantiate.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct end_options {
  std::array<bool, 2> free_ends{true, true};  ///< which ends are fitted
  std::array<known_admittance, 2> known{};    ///< what is declared of them besides; empty: what the guess says
  std::size_t most_modes = 24;
  double least_gain = 14;      ///< of ln L, for a further mode: as in the search for missing physics
  double most_residual = 0.6;  ///< of the signal (rms); more is no string of this kind
};

/// One mode that was found.
struct fitted_mode {
  std::size_t end = 0;
  admittance_mode mode;
  double frequency_sd_Hz = 0, q_sd = 0, per_mass_relative_sd = 0;
  bool end_uncertain = false;  ///< the other end would do as well, within 5 units of ln L
};

struct end_fit_result {
  pluck_fit_result plucks;  ///< value, sd and covariance of the layout's parameters
  std::vector<fitted_mode> modes;
  std::array<modal_termination, 2> ends;
  Eigen::MatrixXd covariance;  ///< of the layout's parameters, then ln f, ln q, ln(Z / M) of each mode; the last counts as
                               ///< unknown by a factor of e where the end is uncertain: it may be none of this end's
};

namespace detail {

/// Empty for a rigid end.
[[nodiscard]] inline known_admittance admittance_of(const modal_termination& end) {
  if (end.modes.empty()) return {};
  return [end](std::complex<double> s) { return end.at(s); };
}

class end_fitter {
public:
  template <class = void>
  end_fitter(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& options, const end_options& how,
             const pluck_start& start)
      : takes_{takes}, how_{how}, d_{takes, guess, options, {known(0, guess), known(1, guess)}, start} {}

  /// From a rough start to the whole record.
  template <class = void>
  [[nodiscard]] outcome<end_fit_result> run() {
    const double f0 = d_.value()[0], most = d_.shortest_s() * f0 / 12;
    for (const auto& [periods, partials] : {std::pair{1.5, 8.0}, {1.5, 24.0}}) d_.look(periods, partials * f0, 30);
    std::vector<double> lengths{1.5};
    while (lengths.back() * 2.5 < most) lengths.push_back(lengths.back() * 2.5);
    if (most > lengths.back()) lengths.push_back(most);
    for (const double periods : lengths) {
      d_.look(periods, d_.limits().pass_Hz, 30);
      if (periods > clear_periods && d_.misfit() < 2) continue;
      while (d_.model().mode_end.size() < how_.most_modes && add_mode()) {
      }
      remove_idle_modes();
    }
    return conclude();
  }

private:
  [[nodiscard]] known_admittance known(std::size_t end, const pluck_guess& guess) const {
    return remembered(how_.known[end] ? how_.known[end] : admittance_of(guess.ends[end]));
  }

  /// A mode that matters shows within so many periods; looking for it in more of them takes long.
  static constexpr double clear_periods = 12;

  /// Tries the best candidates; keeps the one that gains most, if it is worth it.
  template <class = void>
  [[nodiscard]] bool add_mode() {
    if (!how_.free_ends[0] && !how_.free_ends[1]) return false;
    const auto all = search_modes(d_.problem(), d_.model(), d_.value(), d_.now().hessian, d_.now().gradient, how_.free_ends,
                                  std::min(100.0, 0.3 * d_.value()[0]), 0.95 * d_.limits().pass_Hz);
    const end_descent::state before = d_.keep();
    std::optional<end_descent::state> best;
    for (const mode_candidate& c : peaks(all)) {
      d_.restore(before);
      d_.insert(c);
      d_.settle(25);
      if (!best || d_.now().cost < best->now.cost) best = d_.keep();
    }
    if (best) d_.restore(*best);
    if (best && 0.5 * (before.now.cost - d_.now().cost) > how_.least_gain * d_.misfit()) return true;
    d_.restore(before);
    return false;
  }

  /// The best at each end, and the best that is another resonance.
  [[nodiscard]] static std::vector<mode_candidate> peaks(const std::vector<mode_candidate>& all) {
    std::vector<mode_candidate> out;
    for (const mode_candidate& c : all) {
      const bool new_one = std::none_of(out.begin(), out.end(), [&](const mode_candidate& o) {
        return o.end == c.end && std::abs(std::log(o.mode.frequency_Hz / c.mode.frequency_Hz)) < 0.2;
      });
      if (c.gain > 3 && new_one) out.push_back(c);
      if (out.size() == 2 || c.gain < 3) break;
    }
    return out;
  }

  /// Modes whose mass the data leave open are taken out one by one, where that costs next to nothing.
  template <class Real = double>
  void remove_idle_modes() {
    for (std::size_t i = d_.model().mode_end.size(); i-- > 0;) {
      const Eigen::MatrixX<Real> inverse = invert_free(d_.model(), d_.now().hessian);
      if (inverse(d_.model().mode_at(i) + 2, d_.model().mode_at(i) + 2) * d_.misfit() < 0.1) continue;
      const end_descent::state before = d_.keep();
      d_.erase(i);
      d_.settle(25);
      if (0.5 * (d_.now().cost - before.now.cost) > how_.least_gain * d_.misfit()) d_.restore(before);
    }
  }

  /// Whether a mode would do as well at the other end.
  template <class = void>
  [[nodiscard]] bool end_uncertain(std::size_t mode) {
    if (!how_.free_ends[0] || !how_.free_ends[1]) return false;
    const Eigen::Index at = d_.model().mode_at(mode) + 2;
    if (invert_free(d_.model(), d_.now().hessian)(at, at) < 1e-5 / d_.misfit())
      return false;  // so well known that the ends' likeness cannot hide it
    const end_descent::state before = d_.keep();
    d_.swap_end(mode);
    d_.settle(6);
    const bool as_well = 0.5 * (d_.now().cost - before.now.cost) < 5 * d_.misfit();
    d_.restore(before);
    return as_well;
  }

  template <class = void>
  [[nodiscard]] double residual_ratio(std::size_t take) const {
    double left = 0, all = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const auto r = d_.problem().at(d_.model(), d_.value(), take, c);
      const double weight = 2.0 / static_cast<double>(d_.problem().line(take).samples) *
                            std::pow(d_.problem().line(take).rate_Hz / d_.problem().noise()[c], 2);
      left += r.residual.squaredNorm(), all += weight * r.model_power.sum();
    }
    return std::sqrt(left / std::max(1e-300, all));
  }

  /// By the conventions of damping.
  template <class = void>
  void widen(std::size_t mode, Eigen::MatrixXd& covariance) const {
    const admittance_mode m = d_.model().mode(d_.value(), mode);
    const double turn = 0.5 * d_.model().layout.string(d_.value()).loss.inverse_q(m.frequency_Hz);
    const Eigen::Index at = d_.model().mode_at(mode);
    for (const auto& [k, sd] : {std::pair{0, turn / 2}, {1, turn * m.q}, {2, turn}}) covariance(at + k, at + k) += sd * sd;
  }

  template <class Real = double>
  [[nodiscard]] outcome<end_fit_result> conclude() {
    end_fit_result out;
    const double inflation = d_.misfit();
    const Eigen::MatrixX<Real> inverse = invert_free(d_.model(), d_.now().hessian);
    end_problem twice(takes_, d_.begins_s(), 2 * d_.problem().line(0).sigma_per_s, d_.limits().pass_Hz);  // the weights' square
    twice.set_noise(d_.noise());
    Eigen::MatrixX<Real> known = Eigen::MatrixX<Real>::Zero(d_.model().size(), d_.model().size());
    for (Eigen::Index p = 0; p < d_.model().size(); ++p)
      if (const auto k = d_.prior(p); k.sd > 0 && d_.model().is_free(p)) known(p, p) = 1 / (k.sd * k.sd);
    out.covariance = inverse * (known + inflation * twice.linearise(d_.model(), d_.value()).hessian) * inverse;
    for (std::size_t i = 0; i < d_.model().mode_end.size(); ++i) widen(i, out.covariance);
    const Eigen::Index n = d_.model().layout.size();
    pluck_fit_result& f = out.plucks;
    f.layout = d_.model().layout, f.value = d_.value().head(n), f.covariance = out.covariance.topLeftCorner(n, n);
    f.sd = f.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    f.noise_N = d_.noise(), f.misfit = inflation, f.limits = d_.limits(), f.iterations = d_.iterations(),
    f.converged = d_.converged();
    f.horizon_periods = 1e9;
    for (std::size_t t = 0; t < takes_.size(); ++t) f.residual_ratio.push_back(residual_ratio(t));
    f.unidentified = unidentified(d_.now().hessian.topLeftCorner(n, n) - known.topLeftCorner(n, n), d_.model().layout);
    for (std::size_t i = 0; i < d_.model().mode_end.size(); ++i) {
      const Eigen::Index at = d_.model().mode_at(i);
      const auto sd = [&](Eigen::Index k) { return std::sqrt(std::max(0.0, out.covariance(at + k, at + k))); };
      const admittance_mode m = d_.model().mode(d_.value(), i);
      const bool uncertain = end_uncertain(i);
      out.modes.push_back({d_.model().mode_end[i], m, m.frequency_Hz * sd(0), m.q * sd(1), sd(2), uncertain});
      if (uncertain) out.covariance(at + 2, at + 2) += 1;
      out.ends[d_.model().mode_end[i]].modes.push_back(m);
    }
    if (!out.plucks.value.allFinite() || worst(f) > how_.most_residual)
      return failure{takes_.front().name + ": the plucks do not ring as the declared string should, nor " +
                     (how_.free_ends[0] || how_.free_ends[1] ? "with ends that give way" : "between the declared ends")};
    return out;
  }

  const std::vector<pluck_take>& takes_;
  end_options how_;
  end_descent d_;
};

}  // namespace detail

/// Fits plucks and ends together. Fails as fit_plucks does.
template <class = void>
[[nodiscard]] outcome<end_fit_result> fit_ends(const std::vector<pluck_take>& takes, const pluck_guess& guess,
                                               const pluck_options& options = {}, const end_options& how = {}) {
  const outcome<pluck_start> start = find_start(takes, guess);
  if (!start) return failure{start.error()};
  return detail::end_fitter(takes, guess, options, how, *start).run();
}
ROSIN_INSTANTIATE(outcome<end_fit_result> fit_ends(const std::vector<pluck_take>&, const pluck_guess&, const pluck_options&,
                                                   const end_options&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
