// tier: hosted
// SPDX-License-Identifier: MIT
//
// Score test of a fit of plucks: by how much would one more effect raise the likelihood, to first order, everything else
// readjusted? With the residual r, the Jacobian J of what is fitted already and the change d that the effect makes,
//
//     mix = (d'r - d'J H^-1 J'r) / (d'd - d'J H^-1 J'd),      gain of ln L = mix^2 (...) / 2
//
// (Rao 1948). All products are sums over damped lines in closed form, so that a starting point costs about a millisecond and a
// catalogue can be scanned over position and frequency.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/diagnose/scene_plucks.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct score_result {
  double mix = 0;   ///< how many times the effect's starting strength
  double gain = 0;  ///< of the log-likelihood
};

class pluck_score {
public:
  using problem = line_problem<scene_plucks>;

  template <class = void>
  pluck_score(const problem& fitted, const Eigen::VectorXd& value) : problem_{fitted}, value_{value} {
    const pluck_equations eq = fitted.linearise(value);
    for (Eigen::Index p = 0; p < value.size(); ++p)
      if (fitted.model().is_free(p)) free_.push_back(p);
    solver_.compute(eq.hessian(free_, free_));
    step_ = solver_.solve(eq.gradient(free_));
    for (std::size_t t = 0; t < fitted.takes(); ++t) views_.push_back(view_of(t));
  }

  /// The effect at one of its starting points (physical values).
  template <class Real = double>
  [[nodiscard]] score_result operator()(const scene_plucks& with, const std::vector<double>& start) const {
    Eigen::VectorX<Real> v(with.size());
    v.head(value_.size()) = value_;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Eigen::Index p = value_.size() + static_cast<Eigen::Index>(i);
      v[p] = to_fitted(with.added(p), start[i]);
    }
    if (const auto& rebase = with.effects().back().rebase) rebase(with, v);
    double dr = 0, dd = 0;
    Eigen::VectorX<Real> dJ = Eigen::VectorX<Real>::Zero(step_.size());
    for (std::size_t t = 0; t < views_.size(); ++t) {
      const auto& s = problem_.part(t, 1);
      if (s.count() == 0) continue;
      add(views_[t], with.lines(v, t, 1, s.begin_s, problem_.limits(), problem_.partials()), t, dr, dd, dJ);
    }
    const double free = dd - dJ.dot(solver_.solve(dJ)), excess = dr - dJ.dot(step_);
    if (!(free > 1e-9 * dd) || !std::isfinite(excess)) return {};
    return {excess / free, 0.5 * excess * excess / free};
  }

  /// The same for a change of the recordings themselves: `columns` holds, take by take, what the filtered recording after the
  /// release loses for one unit of it. Returns mix, gain and the standard deviation of mix.
  struct column_score : score_result {
    double sd = 0;
  };
  template <class Real = double>
  [[nodiscard]] column_score of_columns(const std::vector<std::array<Eigen::VectorXd, 2>>& columns) const {
    double dr = 0, dd = 0;
    Eigen::VectorX<Real> dJ = Eigen::VectorX<Real>::Zero(step_.size());
    for (std::size_t t = 0; t < views_.size(); ++t)
      for (std::size_t c = 0; c < 2; ++c) {
        const Eigen::VectorX<Real>& d = columns[t][c];
        if (d.size() == 0) continue;
        const double sure = 1 / std::pow(problem_.noise()[c], 2), step_s = 1 / problem_.rate_Hz(t);
        dr += sure * d.dot(views_[t].residual[c]);
        dd += sure * d.squaredNorm();
        dJ += sure * (views_[t].to[c] * onto(views_[t].lines, d, step_s));
      }
    const double free = dd - dJ.dot(solver_.solve(dJ)), excess = dr - dJ.dot(step_);
    if (!(free > 1e-9 * dd) || !std::isfinite(excess)) return {};
    return {{excess / free, 0.5 * excess * excess / free}, 1 / std::sqrt(free)};
  }

private:
  struct view {  // of the ringing part of a take
    std::vector<damped_line> lines;
    std::vector<line_steps> steps;  // of these lines
    Eigen::MatrixXd gram;           // 4N x 4N
    std::array<Eigen::VectorXd, 2> residual, onto;
    std::array<Eigen::MatrixXd, 2> to, to_gram;  // P x 4N
  };

  template <class Real = double>
  [[nodiscard]] view view_of(std::size_t t) const {
    const auto& s = problem_.part(t, 1);
    view w;
    w.lines = problem_.lines(value_, t, 1);
    const double step_s = 1 / problem_.rate_Hz(t);
    for (const damped_line& line : w.lines) w.steps.emplace_back(line.pole, step_s, s.count());
    w.gram = line_gram(w.lines, step_s, s.count());
    const auto to = problem_.sensitivities(value_, t, 1, w.lines);
    for (std::size_t c = 0; c < 2; ++c) w.to[c] = to[c](free_, Eigen::all);
    const auto p = problem_.project(s, problem_.rate_Hz(t), w.lines);
    for (std::size_t c = 0; c < 2; ++c) {
      const Eigen::MatrixX<Real> flat = p.onto_lines[c].transpose();
      w.onto[c] = Eigen::Map<const Eigen::VectorX<Real>>(flat.data(), flat.size());
      w.residual[c] = p.residual.col(static_cast<Eigen::Index>(c));
      w.to_gram[c] = w.to[c] * w.gram;
    }
    return w;
  }

  /// d' gram d of both channels' changes in one pass over half of the matrix, which does not stay in the cache.
  template <class = void>
  [[nodiscard]] static Eigen::Array2d power_of(const Eigen::MatrixXd& gram, const Eigen::MatrixX2d& d) {
    Eigen::Array2d power = Eigen::Array2d::Zero();
    for (Eigen::Index k = 0; k < d.rows(); ++k)
      for (Eigen::Index c = 0; c < 2; ++c)
        if (const double own = d(k, c); own != 0)
          power[c] += own * (2 * gram.col(k).head(k).dot(d.col(c).head(k)) + gram(k, k) * own);
    return power;
  }

  /// sum_k z^k r_k by Horner's rule, for every eighth sample at a time.
  template <class = void>
  [[nodiscard]] static std::complex<double> against(const Eigen::VectorXd& r, std::complex<double> one_step) {
    constexpr Eigen::Index lanes = 8;
    using lane_array = Eigen::Array<double, lanes, 1>;
    std::complex<double> jump = 1, sum = 0, z = 1;
    for (Eigen::Index i = 0; i < lanes; ++i) jump *= one_step;
    const Eigen::Index whole = r.size() / lanes;
    lane_array re = lane_array::Zero(), im = lane_array::Zero();
    re.head(r.size() - lanes * whole) = r.tail(r.size() - lanes * whole).array();
    for (Eigen::Index m = whole; m-- > 0;) {
      const lane_array turned = re * jump.real() - im * jump.imag() + r.segment<lanes>(lanes * m).array();
      im = re * jump.imag() + im * jump.real();
      re = turned;
    }
    for (Eigen::Index i = 0; i < lanes; ++i, z *= one_step) sum += z * std::complex<double>(re[i], im[i]);
    return sum;
  }

  /// Products of a series with the basis of damped_lines.hpp.
  template <class = void>
  [[nodiscard]] static Eigen::VectorXd onto(const std::vector<damped_line>& lines, const Eigen::VectorXd& x, double step_s) {
    return line_runner(lines, step_s).products(x).front().transpose().reshaped();
  }

  template <class Real = double>
  void add(const view& w, const std::vector<damped_line>& changed, std::size_t take, double& dr, double& dd,
           Eigen::VectorXd& dJ) const {
    const double step_s = 1 / problem_.rate_Hz(take),
                 near = 0.05 * 2 * std::numbers::pi * problem_.model().string(value_).fundamental_Hz;
    const auto N = static_cast<Eigen::Index>(w.lines.size());
    Eigen::MatrixX2d d = Eigen::MatrixX2d::Zero(4 * N, 2);
    std::vector<bool> met(w.lines.size(), false);
    std::vector<damped_line> fresh;
    std::size_t from = 0;
    for (const damped_line& line : changed) {
      std::size_t best = w.lines.size();
      double apart = near;
      for (std::size_t k = 0; k < w.lines.size(); ++k) {  // most lines stand in the same order
        const std::size_t j = (from + k) % w.lines.size();
        if (met[j] || std::abs(w.lines[j].pole.imag() - line.pole.imag()) > apart) continue;
        const double dist = plain::abs(w.lines[j].pole - line.pole);
        if (line.pole.imag() == 0 && dist > 0)
          continue;  // what is slow may die away within the record: exactly, then, as a line of its own
        const bool same_channel = (line.residue[0] != 0.0) == (w.lines[j].residue[0] != 0.0) || dist > 0 || line.pole.imag() != 0;
        if (dist < apart && same_channel) apart = dist, best = j;
        if (dist < 1e-3 * near && same_channel) break;
      }
      const auto is_closer = [&](const damped_line& other) {
        return &other != &line && std::abs(other.pole.imag() - w.lines[best].pole.imag()) < apart &&
               std::abs(other.pole - w.lines[best].pole) < apart;
      };
      if (apart > 1e-3 * near && best < w.lines.size() && std::any_of(changed.begin(), changed.end(), is_closer))
        best = w.lines.size();  // a new line beside an old one
      if (best == w.lines.size()) {
        fresh.push_back(line);
        continue;
      }
      from = best + 1;
      met[best] = true;
      for (std::size_t c = 0; c < 2; ++c) {
        const auto was = w.lines[best].residue[c];
        const auto more = line.residue[c] - was, drift = was * (line.pole - w.lines[best].pole);
        d.col(static_cast<Eigen::Index>(c)).segment<4>(4 * static_cast<Eigen::Index>(best)) << more.real(), -more.imag(),
            drift.real(), -drift.imag();
      }
    }
    for (std::size_t j = 0; j < w.lines.size(); ++j)
      if (!met[j])
        for (Eigen::Index c = 0; c < 2; ++c)
          d.col(c).segment<2>(4 * static_cast<Eigen::Index>(j)) << -w.lines[j].residue[static_cast<std::size_t>(c)].real(),
              w.lines[j].residue[static_cast<std::size_t>(c)].imag();
    keep_strongest(fresh);
    const std::size_t count = problem_.part(take, 1).count();
    std::vector<line_steps> steps;
    for (const damped_line& line : fresh) steps.emplace_back(line.pole, step_s, count);
    const Eigen::MatrixX2d crosses = cross_gram(w, fresh, steps, step_s, count);
    const Eigen::Array2d power = power_of(w.gram, d);
    for (std::size_t c = 0; c < 2; ++c) {
      const Eigen::VectorX<Real> own = d.col(static_cast<Eigen::Index>(c)), cross = crosses.col(static_cast<Eigen::Index>(c));
      const double sure = 1 / std::pow(problem_.noise()[c], 2);
      dr += sure * own.dot(w.onto[c]);
      dd += sure * (power[static_cast<Eigen::Index>(c)] + 2 * own.dot(cross));
      dJ += sure * (w.to_gram[c] * own);
      if (!fresh.empty()) dJ += sure * (w.to[c] * cross);
      for (std::size_t i = 0; i < fresh.size(); ++i)
        if (const auto a = fresh[i].residue[c]; a != 0.0) dr += sure * (a * against(w.residual[c], steps[i].one)).real();
    }
    for (std::size_t i = 0; i < fresh.size(); ++i)
      for (std::size_t k = 0; k < fresh.size(); ++k) {
        const auto same = power_sums(steps[i] * steps[k], step_s, count)[0],
                   other = power_sums(steps[i] * conj(steps[k]), step_s, count)[0];
        for (std::size_t c = 0; c < 2; ++c) {
          const auto a = fresh[i].residue[c], b = fresh[k].residue[c];
          dd += 0.5 * (a * b * same + a * std::conj(b) * other).real() / std::pow(problem_.noise()[c], 2);
        }
      }
  }

  /// Of many new lines (a second polarisation doubles them all) the strongest tell enough.
  static void keep_strongest(std::vector<damped_line>& lines) {
    constexpr std::size_t most = 10;
    if (lines.size() <= most) return;
    const auto power = [](const damped_line& l) {
      return (std::norm(l.residue[0]) + std::norm(l.residue[1])) / std::max(1e-9, -l.pole.real());
    };
    std::nth_element(lines.begin(), lines.begin() + most, lines.end(),
                     [&](const auto& a, const auto& b) { return power(a) > power(b); });
    lines.resize(most);
  }

  /// Products of new lines with the basis of the view, channel by channel.
  template <class = void>
  [[nodiscard]] static Eigen::MatrixX2d cross_gram(const view& w, const std::vector<damped_line>& fresh,
                                                   const std::vector<line_steps>& steps, double step_s, std::size_t count) {
    Eigen::MatrixX2d out = Eigen::MatrixX2d::Zero(4 * static_cast<Eigen::Index>(w.lines.size()), 2);
    for (std::size_t i = 0; i < fresh.size(); ++i)
      for (std::size_t j = 0; j < w.lines.size(); ++j) {
        const auto same = power_sums(steps[i] * w.steps[j], step_s, count),
                   other = power_sums(conj(steps[i]) * w.steps[j], step_s, count);
        for (std::size_t k = 0; k < 2; ++k)  // Re{a z} against Re{z_j}, Im{z_j}, without and with t
          for (std::size_t c = 0; c < 2; ++c) {
            const auto a = fresh[i].residue[c];
            const std::complex<double> sum = 0.5 * (a * same[k] + std::conj(a) * other[k]);
            const auto at = 4 * static_cast<Eigen::Index>(j) + 2 * static_cast<Eigen::Index>(k),
                       column = static_cast<Eigen::Index>(c);
            out(at, column) += sum.real(), out(at + 1, column) += sum.imag();
          }
      }
    return out;
  }

  const problem& problem_;
  Eigen::VectorXd value_, step_;
  std::vector<Eigen::Index> free_;  // parameters that the fit moves
  Eigen::LDLT<Eigen::MatrixXd> solver_;
  std::vector<view> views_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
