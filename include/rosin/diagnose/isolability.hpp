// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the plucks of a rig can tell apart, before any of them is made. Every effect, at typical places and frequencies, changes the
// recordings that the declared string would give by d; what the nuisances (pitch, stiffness, loss, position, gains, release, strength, offsets)
// can imitate is projected out,
//
//     d' = d - J (J'J)^-1 J'd,        cos(A, B) = max over B's starting points of |d'_A . d'_B| / (|d'_A| |d'_B|),
//
// and |d'| against the noise says how strong the effect must be to be seen at five standard deviations (Fisher's
// analysis). Effects whose cosine is above 0.95 are one class: these plucks cannot tell them apart.
//
#pragma once

#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/scene_plucks.hpp>

namespace rosin {

struct isolability {
  std::vector<std::string> ids;            ///< effects, with their place
  std::vector<std::string> strength;       ///< name of the parameter that the effect vanishes with; empty: none does
  Eigen::VectorXd detectable;              ///< its value at five standard deviations; NaN where there is none
  Eigen::VectorXd surviving;               ///< |d'| / |d|
  Eigen::MatrixXd cosine;                  ///< symmetric, 1 on the diagonal
  [[nodiscard]] std::vector<std::vector<std::size_t>> classes(double above = 0.95) const {
    std::vector<std::vector<std::size_t>> out;
    std::vector<bool> seen(ids.size(), false);
    for (std::size_t first = 0; first < ids.size(); ++first) {
      if (seen[first]) continue;
      std::vector<std::size_t> members{first};
      seen[first] = true;
      for (std::size_t k = 0; k < members.size(); ++k)
        for (std::size_t j = 0; j < ids.size(); ++j)
          if (!seen[j] && cosine(static_cast<Eigen::Index>(members[k]), static_cast<Eigen::Index>(j)) > above) seen[j] = true, members.push_back(j);
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
  explicit planned_recordings(const planned_plucks& plan) : plan_{plan}, layout_{plan.takes, plan.options, plan.guess.ends} {
    std::vector<double> release, position;
    for (const auto& t : plan.takes) release.push_back(release_s), position.push_back(t.position);
    value_ = layout_.initial(plan.takes, plan.guess, plan.guess.fundamental_Hz, release, position);
    if (plan.options.convention) value_[pluck_layout::convention] = 0;
  }

  [[nodiscard]] const pluck_layout& layout() const { return layout_; }
  [[nodiscard]] const Eigen::VectorXd& value() const { return value_; }
  [[nodiscard]] Eigen::VectorXd of(const std::vector<pluck_effect>& effects, const Eigen::VectorXd& v) const {
    const scene_plucks model(layout_, plan_.guess.ac_coupled_Hz, effects);
    Eigen::VectorXd out(rows());
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < plan_.takes.size(); ++t) {
      const double rate = plan_.takes[t].rate_Hz;
      const band limits = plan_.options.limits_for(rate, plan_.options.most_partials * value_[0]);
      const auto lines = model.lines(v, t, 1, release_s, limits, plan_.options.most_partials);
      const Eigen::Index n = samples(t);
      out.segment(at, 2 * n) = line_runner(lines, 1 / rate).sum(lines, static_cast<std::size_t>(n)).reshaped();
      at += 2 * n;
    }
    return out;
  }
  /// What an effect that works on recordings takes out of them.
  [[nodiscard]] Eigen::VectorXd undone(const pluck_effect& e, double value) const {
    const Eigen::VectorXd plain = of({}, value_);
    std::vector<pluck_take> takes = plan_.takes;
    Eigen::VectorXd out(rows());
    Eigen::Index at = 0;
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const auto before = static_cast<Eigen::Index>(std::lround(release_s * takes[t].rate_Hz)), n = samples(t);
      const auto held = static_forces(takes[t].position);
      for (std::size_t c = 0; c < 2; ++c) {
        takes[t].force_N[c].assign(static_cast<std::size_t>(before), takes[t].strength_N * held[c]);
        const auto* from = plain.data() + at + static_cast<Eigen::Index>(c) * n;
        takes[t].force_N[c].insert(takes[t].force_N[c].end(), from, from + n);
      }
      at += 2 * n;
    }
    const auto original = takes;
    e.undo(takes, scene_plucks(layout_, plan_.guess.ac_coupled_Hz, {}).scene(value_, 0), layout_, value_, value);
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
  /// Orthonormal basis of all that the nuisances can do.
  [[nodiscard]] Eigen::MatrixXd nuisances() const {
    std::vector<Eigen::VectorXd> columns;
    for (Eigen::Index p = 0; p < layout_.first_of_ends(); ++p) {  // declared ends are taken for true
      if (!layout_.is_free(p)) continue;
      Eigen::VectorXd up = value_, down = value_;
      const double step = layout_.step(p, value_);
      up[p] += step, down[p] -= step;
      const Eigen::VectorXd d = of({}, up) - of({}, down);
      if (const double length = d.norm(); length > 0) columns.push_back(d / length);
    }
    Eigen::MatrixXd J(rows(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i) J.col(static_cast<Eigen::Index>(i)) = columns[i];
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J);
    qr.setThreshold(1e-9);
    return qr.householderQ() * Eigen::MatrixXd::Identity(rows(), qr.rank());
  }

private:
  static constexpr double release_s = 0.004;
  [[nodiscard]] Eigen::Index samples(std::size_t t) const { return static_cast<Eigen::Index>(std::lround(plan_.duration_s * plan_.takes[t].rate_Hz)); }
  [[nodiscard]] Eigen::Index rows() const {
    Eigen::Index n = 0;
    for (std::size_t t = 0; t < plan_.takes.size(); ++t) n += 2 * samples(t);
    return n;
  }

  planned_plucks plan_;
  pluck_layout layout_;
  Eigen::VectorXd value_;
};

/// At most so many of an effect's starting points, spread over all of them.
[[nodiscard]] inline std::vector<std::vector<double>> spread_starts(const pluck_effect& e, std::size_t most) {
  if (e.starts.size() <= most) return e.starts;
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < most; ++i) out.push_back(e.starts[(2 * i + 1) * e.starts.size() / (2 * most)]);
  return out;
}

}  // namespace detail

/// Needs at least one take with rate, strength and position, and a pitch.
[[nodiscard]] inline isolability isolability_of(const planned_plucks& plan, const std::vector<pluck_effect>& effects) {
  const detail::planned_recordings recordings(plan);
  const Eigen::VectorXd plain = recordings.of({}, recordings.value());
  const Eigen::MatrixXd basis = recordings.nuisances();
  const auto count = static_cast<Eigen::Index>(effects.size());
  isolability out{{}, {}, Eigen::VectorXd::Constant(count, std::numeric_limits<double>::quiet_NaN()), Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Identity(count, count)};
  std::vector<Eigen::MatrixXd> seen;  // unit vectors, one column a start
  for (Eigen::Index i = 0; i < count; ++i) {
    const pluck_effect& e = effects[static_cast<std::size_t>(i)];
    const auto starts = e.undo ? std::vector<std::vector<double>>{{e.parameters[0].step}} : detail::spread_starts(e, 12);
    Eigen::MatrixXd columns(plain.size(), static_cast<Eigen::Index>(starts.size()));
    double best = 0;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      Eigen::VectorXd v(recordings.value().size() + static_cast<Eigen::Index>(starts[k].size()));
      v.head(recordings.value().size()) = recordings.value();
      for (std::size_t q = 0; q < starts[k].size(); ++q) v[recordings.value().size() + static_cast<Eigen::Index>(q)] = to_fitted(e.parameters[q], starts[k][q]);
      if (e.rebase && !e.undo) e.rebase(recordings.layout(), v);
      Eigen::VectorXd d = e.undo ? recordings.undone(e, starts[k][0]) : Eigen::VectorXd(recordings.of({e}, v) - plain);
      const double whole = d.norm();
      d -= basis * (basis.transpose() * d);
      const double left = d.norm();
      columns.col(static_cast<Eigen::Index>(k)) = left > 1e-12 ? Eigen::VectorXd(d / left) : Eigen::VectorXd::Zero(d.size());
      if (left <= best) continue;
      best = left;
      out.surviving[i] = left / whole;
      if (e.undo || e.strength >= 0) out.detectable[i] = starts[k][e.undo ? 0 : static_cast<std::size_t>(e.strength)] * 5 * plan.noise_N / left;
    }
    out.ids.push_back(e.id());
    out.strength.push_back(e.undo ? e.parameters[0].name : e.strength >= 0 ? e.parameters[static_cast<std::size_t>(e.strength)].name : std::string{});
    seen.push_back(std::move(columns));
  }
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      out.cosine(i, j) = out.cosine(j, i) = (seen[static_cast<std::size_t>(i)].transpose() * seen[static_cast<std::size_t>(j)]).cwiseAbs().maxCoeff();
  return out;
}

}  // namespace rosin
