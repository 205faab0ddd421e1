// SPDX-License-Identifier: MIT
//
// What the declared model and the corrected one leave of a fitted pluck, for the pictures of a report.
//
#include "diagnose_rig.hpp"

#include <rosin/diagnose/mismatch_class.hpp>
#include <rosin/diagnose/rattle_effect.hpp>

namespace tool {

namespace {

constexpr double shown_periods = 40;

struct residual_left {
  residual_series series;
  rosin::band limits;
};

residual_left left_by(const rosin::scene_data& data, const rosin::scene_fit& fit, std::size_t take) {
  const double periods = std::min(shown_periods, fit.horizon_periods > 0 ? fit.horizon_periods : shown_periods);
  const auto problem = data.problem(fit.effects, fit.value, {1000, periods, true, rosin::freedom::all}, {1, 1});
  residual_left out{{problem.part(take, 1).begin_s, {}}, problem.limits()};
  const auto residual = rosin::detail::residual_of(problem, fit.value, take);
  for (std::size_t c = 0; c < 2; ++c) out.series.force_N[c].assign(residual[c].begin(), residual[c].end());
  return out;
}

void add_noise(const rosin::scene_fit& fit, residual_picture& out) {
  for (std::size_t c = 0; c < 2; ++c) {
    const double noise = fit.quality.noise[c];
    out.noise_N_per_root_Hz[c] = noise / std::sqrt(0.5 * out.rate_Hz);
    out.noise_N[c] = noise * std::sqrt((out.limits.pass_Hz + out.limits.stop_Hz) / out.rate_Hz);
  }
}

/// What the picture of a pluck that contradicts the others begins with.
residual_picture picture_of(const rosin::odd_pluck& odd) {
  residual_picture out;
  out.take = odd.take.name, out.rate_Hz = odd.take.rate_Hz, out.limits = odd.others.declared.limits;
  out.fundamental_Hz = odd.others.best.value[rosin::pluck_layout::fundamental];
  add_noise(odd.others.best, out);
  return out;
}

/// Where in time and frequency what the declared model leaves stands out, and whether the force's two versions agree on it.
void locate(const rosin::pluck_diagnosis& p, residual_picture& out) {
  const std::size_t take = p.mismatch.take;
  const auto& layout = p.data.layout;
  const double release_s = p.base.value[layout.at(take, rosin::pluck_layout::release)],
               place = p.base.value[layout.position(take)], period_s = 1 / out.fundamental_Hz;
  out.echoes = {{{release_s, period_s, place}, {release_s, period_s, 1 - place}}};
  std::array<Eigen::VectorXd, 2> left;
  for (std::size_t c = 0; c < 2; ++c)
    left[c] =
        Eigen::Map<const Eigen::VectorXd>(out.before.force_N[c].data(), static_cast<Eigen::Index>(out.before.force_N[c].size()));
  out.map = rosin::map_of(left, out.before.begin_s, out.rate_Hz, out.echoes, out.limits, p.best.quality.noise);
  const auto force = rosin::plucking_force_of(p.data, p.declared, p.base, take, p.best.quality.noise);
  if (!force) return;
  out.force = {force->begin_s,   force->near_N,          force->far_N,   force->step_N,
               force->parting_N, force->parting_noise_N, force->shape_N, force->shape_noise_N};
  if (const auto kind = force->kind()) out.kind = rosin::name_of(*kind);
}

}  // namespace

std::optional<residual_picture> residuals_of(const rosin::pluck_diagnosis& p) {
  if (p.base.value.size() == 0 || p.best.value.size() == 0) return std::nullopt;
  const auto before = left_by(p.data, p.mismatched ? p.base : p.best, p.mismatch.take);  // with what any wire does
  residual_picture out;
  out.take = p.data.takes[p.mismatch.take].name, out.rate_Hz = p.data.takes[p.mismatch.take].rate_Hz;
  out.fundamental_Hz = p.base.value[rosin::pluck_layout::fundamental];
  out.limits = before.limits, out.before = before.series;
  out.after = p.best.effects.empty() ? before.series : left_by(p.data, p.best, p.mismatch.take).series;
  add_noise(p.best, out);
  if (p.mismatched) locate(p, out);
  return out;
}

residual_picture residuals_of(const rosin::odd_pluck& odd) {
  const rosin::take_and_model &t = odd.ringing,
                              &after = odd.moved && odd.elsewhere.model[0].size() == t.model[0].size() ? odd.elsewhere : t;
  residual_picture out = picture_of(odd);
  out.stretch = "from a period before it goes astray on", out.bar = "The bar marks where it begins; over the whole take it is";
  const double from_s = std::max(t.begin_s, odd.time_s[0] - 1 / out.fundamental_Hz), lost_s = odd.lost ? odd.lost->time_s : 1e300;
  const auto begin = static_cast<Eigen::Index>((from_s - t.begin_s) * out.rate_Hz),
             lag = odd.lost ? static_cast<Eigen::Index>(odd.lost->count) : 0;
  const Eigen::Index count =
      std::min(t.recorded[0].size() - begin - lag, static_cast<Eigen::Index>(shown_periods * out.rate_Hz / out.fundamental_Hz));
  out.before.begin_s = out.after.begin_s = t.begin_s + static_cast<double>(begin) / out.rate_Hz;
  for (std::size_t c = 0; c < 2; ++c)
    for (Eigen::Index i = begin; i < begin + count; ++i) {
      const bool behind = t.begin_s + static_cast<double>(i) / out.rate_Hz > lost_s;
      out.before.force_N[c].push_back(t.recorded[c][i] - t.model[c][i]);
      out.after.force_N[c].push_back(t.recorded[c][i] - after.model[c][i + (behind ? lag : 0)]);
    }
  return out;
}

residual_picture residuals_of(const rosin::odd_pluck& odd, const rosin::rattle& rattle) {
  residual_picture out = picture_of(odd);
  out.bar = "The bar marks the first contact; over the periods shown it is";
  out.before.begin_s = out.after.begin_s = rattle.begin_s;
  for (std::size_t c = 0; c < 2; ++c) {
    out.before.force_N[c].assign(rattle.before_N[c].begin(), rattle.before_N[c].end());
    out.after.force_N[c].assign(rattle.left_N[c].begin(), rattle.left_N[c].end());
  }
  return out;
}

}  // namespace tool
