// tier: hosted
// SPDX-License-Identifier: MIT
//
// Plucks of a string whose ends give way, as a least-squares problem along a line of complex frequencies (damped_spectrum.hpp). A
// pluck of F newtons that is let go at t0 leaves in channel j
//
//     gain_j [ F A_j(0) / s  -  F exp(-s t0) A_j(s) / s ]  +  offset_j / s,      A_j: moving_string.hpp,
//
// the parameters are those of pluck_layout and, for each mode of an end, ln f, ln Q, ln(Z / M). Everything is in closed form with
// its derivatives; no poles are followed, so that a mode may cross any partial. White noise of the recording is weighed by exp(-2
// sigma t).
//
#pragma once

#include <rosin/calibrate/damped_spectrum.hpp>
#include <rosin/calibrate/moving_string.hpp>
#include <rosin/calibrate/pluck_layout.hpp>
#include <rosin/math/levenberg_marquardt.hpp>
#include <rosin/propagate/termination.hpp>

#include <Eigen/Dense>

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Relative admittance of an end that is known, at any s with a real part >= 0; empty: rigid.
using known_admittance = std::function<std::complex<double>(std::complex<double>)>;

/// The same, asked once at each s: a fit's frequencies stay where they are, and a table takes its time. Not for several threads.
[[nodiscard]] inline known_admittance remembered(known_admittance end) {
  if (!end) return end;
  return [end, seen = std::make_shared<std::map<std::pair<double, double>, std::complex<double>>>()](std::complex<double> s) {
    const auto [at, fresh] = seen->try_emplace({s.real(), s.imag()});
    if (fresh) at->second = end(s);
    return at->second;
  };
}

/// What is fitted: the layout of the plucks, and one mode after the other with the end that it belongs to.
struct end_model {
  pluck_layout layout;
  std::array<double, 2> ac_coupled_Hz{};
  std::array<known_admittance, 2> known;
  std::vector<std::size_t> mode_end;  ///< 0 near, 1 far, mode by mode

  static constexpr Eigen::Index per_mode = 3;
  [[nodiscard]] Eigen::Index mode_at(std::size_t mode) const {
    return layout.size() + per_mode * static_cast<Eigen::Index>(mode);
  }
  [[nodiscard]] Eigen::Index size() const { return mode_at(mode_end.size()); }
  [[nodiscard]] bool is_free(Eigen::Index p) const { return p >= layout.size() || layout.is_free(p); }
  [[nodiscard]] admittance_mode mode(const Eigen::VectorXd& v, std::size_t i) const {
    const Eigen::Index p = mode_at(i);
    return {std::exp(v[p]), std::exp(v[p + 1]), std::exp(v[p + 2])};
  }
  template <class = void>
  [[nodiscard]] std::vector<admittance_mode> modes(const Eigen::VectorXd& v) const {
    std::vector<admittance_mode> all;
    for (std::size_t i = 0; i < mode_end.size(); ++i) all.push_back(mode(v, i));
    return all;
  }
  [[nodiscard]] std::array<std::complex<double>, 2> admittance(const std::vector<admittance_mode>& modes,
                                                               std::complex<double> s) const {
    std::array<std::complex<double>, 2> z{known[0] ? known[0](s) : 0.0, known[1] ? known[1](s) : 0.0};
    for (std::size_t i = 0; i < modes.size(); ++i) z[mode_end[i]] += modes[i](s);
    return z;
  }
};

class end_problem {
public:
  using complex = std::complex<double>;
  struct spectrum {
    double begin_s = 0;  ///< of the recording that is used
    std::array<std::vector<complex>, 2> x;
  };
  /// Residual and Jacobian of one channel of a take, weighted: real parts over imaginary parts.
  struct rows {
    Eigen::VectorXd residual;
    Eigen::MatrixXd jacobian;
    std::array<std::vector<complex>, 2> by_admittance;  ///< weighted, for each end
    Eigen::VectorXd model_power;                        ///< of the ringing, for each bin
  };

  /// `begin_s`: where each take's record begins to count, a little before its release.
  template <class = void>
  end_problem(const std::vector<pluck_take>& takes, const std::vector<double>& begin_s, double sigma_per_s, double highest_Hz) {
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const auto first = static_cast<std::size_t>(std::max(0.0, std::floor(begin_s[t] * takes[t].rate_Hz)));
      const std::size_t left = takes[t].force_N[0].size() - std::min(first, takes[t].force_N[0].size());
      lines_.emplace_back(takes[t].rate_Hz, sigma_per_s, left, highest_Hz);
      spectrum one{static_cast<double>(first) / takes[t].rate_Hz, {}};
      for (std::size_t c = 0; c < 2; ++c)
        one.x[c] = damped_spectrum(lines_.back(), std::span(takes[t].force_N[c]).subspan(first));
      spectra_.push_back(std::move(one));
    }
  }

  [[nodiscard]] std::size_t takes() const { return spectra_.size(); }
  [[nodiscard]] const damped_line_of_frequencies& line(std::size_t take) const { return lines_[take]; }
  /// rms of the white noise of either channel, over the whole band to half the sampling rate.
  void set_noise(std::array<double, 2> noise_N) { noise_ = noise_N; }
  [[nodiscard]] std::array<double, 2> noise() const { return noise_; }

  template <class Real = double>
  [[nodiscard]] rows at(const end_model& m, const Eigen::VectorXd& v, std::size_t take, std::size_t channel,
                        bool for_search = false) const;
  /// Of the data alone.
  template <class Real = double>
  [[nodiscard]] normal_equations<> linearise(const end_model& m, const Eigen::VectorXd& v) const {
    normal_equations<> eq = normal_equations<Real>::zero(m.size());
    for (std::size_t t = 0; t < takes(); ++t)
      for (std::size_t c = 0; c < 2; ++c) {
        const rows r = at(m, v, t, c);
        eq.hessian.selfadjointView<Eigen::Lower>().rankUpdate(r.jacobian.transpose());
        eq.gradient += r.jacobian.transpose() * r.residual;
        eq.cost += r.residual.squaredNorm();
      }
    eq.hessian = Eigen::MatrixX<Real>(eq.hessian.selfadjointView<Eigen::Lower>());
    return eq;
  }
  /// What white noise alone would leave of the cost.
  [[nodiscard]] double expected_cost() const {
    double sum = 0;
    for (const auto& line : lines_)
      sum += 2 * line.weighted_samples() * 2 * static_cast<double>(line.bins()) / static_cast<double>(line.samples);
    return sum;
  }

private:
  std::vector<damped_line_of_frequencies> lines_;
  std::vector<spectrum> spectra_;
  std::array<double, 2> noise_{1, 1};
};

namespace detail {

/// Forces on the ends for 1 N that stays, ends that give way being so much more string: A_j(0), and the derivatives by the ends'
/// compliances (s, as travel times).
struct held_string {
  std::array<double, 2> force{}, yields_s{};
  double length_s = 0;

  held_string(const end_model& m, const std::vector<admittance_mode>& modes, double position, double one_way_s) {
    for (std::size_t e = 0; e < 2; ++e)
      if (m.known[e]) yields_s[e] = (m.known[e](1e-2) / 1e-2).real();
    for (std::size_t k = 0; k < modes.size(); ++k) yields_s[m.mode_end[k]] += modes[k].compliance_s();
    length_s = one_way_s + yields_s[0] + yields_s[1];
    force = static_forces(position, {yields_s[0] / one_way_s, yields_s[1] / one_way_s});
  }
  [[nodiscard]] double by_compliance(std::size_t channel, std::size_t end) const {
    return (channel == end ? -force[channel] : 1 - force[channel]) / length_s;
  }
};

/// How a loss depends on the parameters of the fit.
struct loss_slope {
  Eigen::Index of;            ///< in the layout
  std::complex<double> rate;  ///< of the rate of propagation
  double inverse_q;           ///< of 1/Q
};

template <class Real = double>
[[nodiscard]] std::vector<loss_slope> loss_slopes(const pluck_layout& layout, const Eigen::VectorXd& v, const loss_law& was,
                                                  std::complex<double> s, double slow) {
  using l = pluck_layout;
  const double f = std::abs(s.imag()) / (2 * std::numbers::pi);
  std::vector<std::pair<Eigen::Index, double>> steps{
      {l::inverse_quality, 1e-6}, {l::internal_loss, 1e-10}, {l::air_loss, 1e-4}, {l::causality, 1e-3}, {l::loss_drag, 1e-3}};
  for (Eigen::Index p = layout.first_of_uneven(); p < layout.loss_scatter(); ++p) steps.emplace_back(p, 1e-3);
  std::vector<loss_slope> out;
  Eigen::VectorX<Real> more = v;
  for (const auto& [of, step] : steps) {
    more[of] += step;
    const loss_law changed = layout.string(more).loss;
    const double lost = (changed.inverse_q(f) - was.inverse_q(f)) / step;
    out.push_back(
        {of, slow * std::complex<double>(std::numbers::pi * f * lost, s.imag() * (changed.lead(f) - was.lead(f)) / step), lost});
    more[of] = v[of];
  }
  return out;
}

/// Everything at one frequency that the rows of a take share.
struct end_bin {
  std::complex<double> s, slope_stiffness;
  std::vector<loss_slope> slope_loss;
  moving_response a;
  passage_at passage;
  double frequency_Hz, stiffness_s2;
};

template <class = void>
end_bin bin_of(const end_model& m, const std::vector<admittance_mode>& modes, const Eigen::VectorXd& v, std::complex<double> s,
               std::size_t take) {
  using layout = pluck_layout;
  const ringing_string string = m.layout.string(v);
  const double epsilon = string.stiffness_s2(), step = std::max(1e-3 * std::abs(epsilon), 1e-16),
               f = std::abs(s.imag()) / (2 * std::numbers::pi);
  const passage_at now(s, epsilon, string.loss), stiffer(s, epsilon + step, string.loss);
  const double p = v[m.layout.position(take)], one_way = 0.5 / v[layout::fundamental],
               slow = slowness_ratio(2 * std::numbers::pi * f, epsilon);
  return {s,
          (stiffer.gamma_per_s - now.gamma_per_s) / step,
          loss_slopes(m.layout, v, string.loss, s, slow),
          moving_string(now, {p * one_way * now.gamma_per_s, (1 - p) * one_way * now.gamma_per_s}, m.admittance(modes, s)),
          now,
          f,
          epsilon};
}

}  // namespace detail

template <class Real>
end_problem::rows end_problem::at(const end_model& m, const Eigen::VectorXd& v, std::size_t take, std::size_t c,
                                  bool for_search) const {
  using layout = pluck_layout;
  const auto& line = lines_[take];
  const auto bins = static_cast<Eigen::Index>(line.bins());
  const auto& L = m.layout;
  const std::vector<admittance_mode> modes = m.modes(v);
  const ringing_string string = L.string(v);
  const double f0 = v[layout::fundamental], p = v[L.position(take)], one_way = 0.5 / f0;
  const detail::held_string held(m, modes, p, one_way);
  const double still = held.force[c], turn = (c == 0 ? -1.0 : 1.0) * one_way / held.length_s;
  const double newtons = std::exp(v[L.at(take, layout::strength)]) * layout::gain(v, c),
               corner = 2 * std::numbers::pi * m.ac_coupled_Hz[c];
  const double begin = spectra_[take].begin_s, released = v[L.at(take, layout::release)] - begin, h = 1 / line.rate_Hz;
  const double weight = std::sqrt(2.0 / static_cast<double>(line.samples)) * line.rate_Hz / noise_[c];
  const double offset = v[L.at(take, layout::offset_near + static_cast<int>(c))], fades = std::exp(-corner * begin);
  rows out{Eigen::VectorX<Real>(2 * bins), Eigen::MatrixX<Real>::Zero(2 * bins, m.size()), {}, Eigen::VectorX<Real>(bins)};
  for (Eigen::Index i = 0; i < bins; ++i) {
    const detail::end_bin b = detail::bin_of(m, modes, v, line.at(static_cast<std::size_t>(i)), take);
    const complex s = b.s, A = b.a.force[c], level = corner > 0 ? 0.0 : h / (1.0 - std::exp(-s * h)),
                  slow = fades * h / (1.0 - std::exp(-(s + corner) * h));
    const complex turned(0, 0.5 * string.loss.inverse_q(b.frequency_Hz)), kappa = (1 + v[layout::convention]) * turned;
    const complex gone = newtons * std::exp(-s * released) / (s + corner), ring = gone * (A + kappa * (A - still)),
                  by_A = -gone * (1.0 + kappa), by_still = newtons * level + gone * kappa;
    const complex signal = newtons * still * level - ring, model = signal + offset * slow;
    const auto put = [&](Eigen::Index q, complex d) {
      out.jacobian(i, q) = weight * d.real(), out.jacobian(bins + i, q) = weight * d.imag();
    };
    const complex r = weight * (spectra_[take].x[c][static_cast<std::size_t>(i)] - model);
    out.residual[i] = r.real(), out.residual[bins + i] = r.imag();
    out.model_power[i] = std::norm(ring);
    const complex by_gamma = by_A * one_way * (b.a.by_phase[c][0] * p + b.a.by_phase[c][1] * (1 - p)),
                  by_stiffness = by_gamma * b.slope_stiffness;
    put(layout::fundamental, -by_gamma * b.passage.gamma_per_s / f0 - 2 * b.stiffness_s2 / f0 * by_stiffness);
    put(layout::inharmonicity, by_stiffness * std::pow(2 * std::numbers::pi * f0, -2));
    for (const detail::loss_slope& d : b.slope_loss)
      put(d.of, by_gamma * d.rate - gone * (1 + v[layout::convention]) * (A - still) * complex(0, 0.5 * d.inverse_q));
    put(layout::convention, -gone * turned * (A - still));
    put(layout::gain_near + static_cast<Eigen::Index>(c), signal);
    put(L.position(take), by_A * one_way * b.passage.gamma_per_s * (b.a.by_phase[c][0] - b.a.by_phase[c][1]) + turn * by_still);
    put(L.at(take, layout::release), s * ring);
    put(L.at(take, layout::strength), signal);
    put(L.at(take, layout::offset_near + static_cast<int>(c)), slow);
    for (std::size_t k = 0; k < m.mode_end.size(); ++k) {
      const admittance_mode& mode = modes[k];
      const double w = 2 * std::numbers::pi * mode.frequency_Hz;
      const complex z = by_A * b.a.by_admittance[c][m.mode_end[k]] * mode(s), per = z / (s * s + s * w / mode.q + w * w);
      const complex softer = held.by_compliance(c, m.mode_end[k]) * mode.compliance_s() * by_still;
      put(m.mode_at(k), -per * (s * w / mode.q + 2 * w * w) - 2.0 * softer);
      put(m.mode_at(k) + 1, per * s * w / mode.q);
      put(m.mode_at(k) + 2, z + softer);
    }
    if (for_search)
      for (std::size_t e = 0; e < 2; ++e) out.by_admittance[e].push_back(weight * by_A * b.a.by_admittance[c][e]);
  }
  for (Eigen::Index q = 0; q < L.size(); ++q)
    if (!L.is_free(q)) out.jacobian.col(q).setZero();
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
