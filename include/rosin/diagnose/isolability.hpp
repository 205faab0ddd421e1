// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the plucks of a rig can tell apart, before any of them is made. Every effect, at typical places and frequencies, changes
// the recordings that the declared string would give by d; what the nuisances (pitch, stiffness, loss, position, gains, release,
// strength, offsets) can imitate is projected out,
//
//     d' = d - J (J'J)^-1 J'd,        cos(A, B) = max over B's starting points of |d'_A . d'_B| / (|d'_A| |d'_B|),
//
// and |d'| against the noise says how strong the effect must be to be seen at five standard deviations (Fisher's
// analysis). Effects whose cosine is above 0.95 are one class: these plucks cannot tell them apart.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/scene_plucks.hpp>

namespace rosin {

struct isolability {
  std::vector<std::string> ids;       ///< effects, with their place
  std::vector<std::string> strength;  ///< name of the parameter that the effect vanishes with; empty: none does
  Eigen::VectorXd detectable;         ///< its value at five standard deviations; NaN where there is none, or none is enough
  Eigen::VectorXd surviving;          ///< |d'| / |d|
  Eigen::MatrixXd cosine;             ///< symmetric, 1 on the diagonal
  [[nodiscard]] std::vector<std::vector<std::size_t>> classes(double above = 0.95) const {
    std::vector<std::vector<std::size_t>> out;
    std::vector<bool> seen(ids.size(), false);
    for (std::size_t first = 0; first < ids.size(); ++first) {
      if (seen[first]) continue;
      std::vector<std::size_t> members{first};
      seen[first] = true;
      for (std::size_t k = 0; k < members.size(); ++k)
        for (std::size_t j = 0; j < ids.size(); ++j)
          if (!seen[j] && cosine(static_cast<Eigen::Index>(members[k]), static_cast<Eigen::Index>(j)) > above)
            seen[j] = true, members.push_back(j);
      out.push_back(std::move(members));
    }
    return out;
  }
};

struct planned_plucks {
  std::vector<pluck_take> takes;  ///< recordings are not needed
  pluck_guess guess;
  pluck_options options;
  double noise_N = 3e-4, duration_s = 0.032;
};

namespace detail {

/// Recordings that a scene gives, all takes and channels in one column, from the release on.
class planned_recordings {
public:
  template <class = void>
  explicit planned_recordings(const planned_plucks& plan) : plan_{plan}, layout_{plan.takes, plan.options, plan.guess.ends} {
    std::vector<double> release, position;
    for (const auto& t : plan.takes) release.push_back(release_s), position.push_back(t.position);
    value_ = layout_.initial(plan.takes, plan.guess, plan.guess.fundamental_Hz, release, position);
    if (plan.options.convention) value_[pluck_layout::convention] = 0;
    plain_ = of({}, value_);
  }

  [[nodiscard]] const pluck_layout& layout() const { return layout_; }
  [[nodiscard]] const Eigen::VectorXd& value() const { return value_; }
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd of(const std::vector<pluck_effect>& effects, const Eigen::VectorXd& v) const {
    const scene_plucks model(layout_, plan_.guess.ac_coupled_Hz, effects);
    Eigen::VectorX<Real> out(rows());
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < plan_.takes.size(); ++t) {
      const double rate = plan_.takes[t].rate_Hz;
      const band limits = plan_.options.limits_for(rate, layout_.string(value_));
      const auto lines = model.lines(v, t, 1, release_s, limits, plan_.options.most_partials);
      const Eigen::Index n = samples(t);
      out.segment(at, 2 * n) = line_runner(lines, 1 / rate).sum(lines, static_cast<std::size_t>(n)).reshaped();
      at += 2 * n;
    }
    return out;
  }
  /// By how much an effect of these values changes them.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd change(const pluck_effect& e, const std::vector<double>& values) const {
    if (e.undo) return undone(e, values[0]);
    const Eigen::Index plain = value_.size();
    Eigen::VectorX<Real> v(plain + static_cast<Eigen::Index>(values.size()));
    v.head(plain) = value_;
    for (std::size_t q = 0; q < values.size(); ++q)
      v[plain + static_cast<Eigen::Index>(q)] = to_fitted(e.parameters[q], values[q]);
    if (e.rebase) e.rebase(layout_, v);
    return of({e}, v) - plain_;
  }
  /// Orthonormal basis of all that the nuisances can do.
  template <class Real = double>
  [[nodiscard]] Eigen::MatrixXd nuisances() const {
    std::vector<Eigen::VectorX<Real>> columns;
    for (Eigen::Index p = 0; p < layout_.first_of_ends(); ++p) {  // declared ends are taken for true
      if (!layout_.is_free(p)) continue;
      Eigen::VectorX<Real> up = value_, down = value_;
      const double step = layout_.step(p, value_);
      up[p] += step, down[p] -= step;
      const Eigen::VectorX<Real> d = of({}, up) - of({}, down);
      if (const double length = d.norm(); length > 0) columns.push_back(d / length);
    }
    Eigen::MatrixX<Real> J(rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) J.col(static_cast<Eigen::Index>(i)) = columns[i];
    Eigen::ColPivHouseholderQR<Eigen::MatrixX<Real>> qr(J);
    qr.setThreshold(1e-9);
    return qr.householderQ() * Eigen::MatrixX<Real>::Identity(rows(), qr.rank());
  }

private:
  static constexpr double release_s = 0.004;
  /// What an effect that works on recordings takes out of them.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd undone(const pluck_effect& e, double value) const {
    std::vector<pluck_take> takes = plan_.takes;
    const pluck_scene scene = scene_plucks(layout_, plan_.guess.ac_coupled_Hz, {}).scene(value_, 0);  // the same for all takes
    Eigen::VectorX<Real> out(rows());
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const auto before = static_cast<Eigen::Index>(std::lround(release_s * takes[t].rate_Hz)), n = samples(t);
      const auto held = held_forces(scene, takes[t].position);
      for (std::size_t c = 0; c < 2; ++c) {
        takes[t].force_N[c].assign(static_cast<std::size_t>(before), takes[t].strength_N * held[c]);
        const auto* from = plain_.data() + at + static_cast<Eigen::Index>(c) * n;
        takes[t].force_N[c].insert(takes[t].force_N[c].end(), from, from + n);
      }
      at += 2 * n;
    }
    const auto original = takes;
    e.undo(takes, scene, layout_, value_, value);
    at = 0;
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const auto before = static_cast<std::size_t>(std::lround(release_s * takes[t].rate_Hz));
      const Eigen::Index n = samples(t);
      for (std::size_t c = 0; c < 2; ++c)
        for (Eigen::Index i = 0; i < n; ++i) {
          const std::size_t k = before + static_cast<std::size_t>(i);
          out[at + static_cast<Eigen::Index>(c) * n + i] = original[t].force_N[c][k] - takes[t].force_N[c][k];
        }
      at += 2 * n;
    }
    return out;
  }
  [[nodiscard]] Eigen::Index samples(std::size_t t) const {
    return static_cast<Eigen::Index>(std::lround(plan_.duration_s * plan_.takes[t].rate_Hz));
  }
  [[nodiscard]] Eigen::Index rows() const {
    Eigen::Index n = 0;
    for (std::size_t t = 0; t < plan_.takes.size(); ++t) n += 2 * samples(t);
    return n;
  }

  planned_plucks plan_;
  pluck_layout layout_;
  Eigen::VectorXd value_, plain_;
};

/// At most so many of an effect's starting points, spread over all of them.
[[nodiscard]] inline std::vector<std::vector<double>> spread_starts(const pluck_effect& e, std::size_t most) {
  if (e.starts.size() <= most) return e.starts;
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < most; ++i) out.push_back(e.starts[(2 * i + 1) * e.starts.size() / (2 * most)]);
  return out;
}

/// How small an effect may be to change the recordings by `target` of what it changes at `values`; `change(values)`: by how much,
/// relative to that. What works on recordings does so in proportion, all else as a power that is found on the way.
template <class Change>
[[nodiscard]] double least_seen(const pluck_effect& e, int size, std::vector<double> values, double target,
                                const Change& change) {
  const auto i = static_cast<std::size_t>(size);
  if (e.undo) return values[i] * target;
  double power = 1, now = 1;
  for (int turn = 0; turn < 8 && now > 0 && std::abs(std::log(now / target)) > 0.01; ++turn) {
    const double before = values[i], was = now;
    values[i] = std::clamp(before * std::pow(target / now, 1 / power), e.parameters[i].low, e.parameters[i].high);
    if (values[i] == before) break;
    now = change(values);
    power = std::clamp(std::log(now / was) / std::log(values[i] / before), 0.2, 5.0);
  }
  const bool vanishes = power > 0.3;  // not where a weak mode stands upon a partial and the lines of the two cannot be told apart
  return now < 0.9 * target || !vanishes ? std::numeric_limits<double>::quiet_NaN()
                                         : values[i];  // nor if not seen even at its largest
}

}  // namespace detail

/// Needs at least one take with rate, strength and position, and a pitch. Effects that no planned pluck shows (hum, which is
/// there without one) are left out.
template <class Real = double>
[[nodiscard]] isolability isolability_of(const planned_plucks& plan, const std::vector<pluck_effect>& effects) {
  const detail::planned_recordings recordings(plan);
  const Eigen::MatrixX<Real> basis = recordings.nuisances();
  const auto beyond_nuisances = [&](const Eigen::VectorX<Real>& d) {
    return Eigen::VectorX<Real>(d - basis * (basis.transpose() * d));
  };
  isolability out;
  std::vector<double> detectable, surviving;
  std::vector<Eigen::MatrixX<Real>> seen;  // unit vectors, one column a start
  for (const pluck_effect& e : effects) {
    const auto starts = e.undo ? std::vector<std::vector<double>>{{e.parameters[0].step}} : detail::spread_starts(e, 12);
    Eigen::MatrixX<Real> columns(basis.rows(), static_cast<Eigen::Index>(starts.size()));
    double most = 0, share = 0;
    std::size_t best = 0;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const Eigen::VectorX<Real> whole = recordings.change(e, starts[k]), left = beyond_nuisances(whole);
      columns.col(static_cast<Eigen::Index>(k)) =
          left.norm() > 1e-12 ? Eigen::VectorX<Real>(left / left.norm()) : Eigen::VectorX<Real>::Zero(left.size());
      if (left.norm() > most) most = left.norm(), best = k, share = most / whole.norm();
    }
    if (!(most > 0)) continue;
    const int size = e.undo ? 0 : e.strength >= 0 ? e.strength : e.shrinks_with;
    const auto relative = [&](const std::vector<double>& values) {
      return beyond_nuisances(recordings.change(e, values)).norm() / most;
    };
    detectable.push_back(size < 0 ? std::numeric_limits<double>::quiet_NaN()
                                  : detail::least_seen(e, size, starts[best], 5 * plan.noise_N / most, relative));
    surviving.push_back(share);
    out.ids.push_back(e.id());
    out.strength.push_back(size >= 0 ? e.parameters[static_cast<std::size_t>(size)].name : std::string{});
    seen.push_back(std::move(columns));
  }
  const auto count = static_cast<Eigen::Index>(seen.size());
  out.detectable = Eigen::Map<Eigen::VectorX<Real>>(detectable.data(), count);
  out.surviving = Eigen::Map<Eigen::VectorX<Real>>(surviving.data(), count);
  out.cosine = Eigen::MatrixX<Real>::Identity(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      out.cosine(i, j) = out.cosine(j, i) =
          (seen[static_cast<std::size_t>(i)].transpose() * seen[static_cast<std::size_t>(j)]).cwiseAbs().maxCoeff();
  return out;
}
ROSIN_INSTANTIATE(isolability isolability_of(const planned_plucks&, const std::vector<pluck_effect>&))

}  // namespace rosin
