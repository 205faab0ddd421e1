// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where to begin with effects so strong that the declared string, fitted to them, is far off: what such a fit leaves says little
// of them. A support's mode comes from the fit along complex frequencies; a heavy load from the first period and a half, over
// which the declared string, not fitted, still holds but for the load's own echoes.
//
#pragma once

#include <rosin/calibrate/end_fit.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_score.hpp>
#include <rosin/diagnose/scene_fit.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

/// A way to begin that another method has found: all of the values, for the effect with that id.
struct found_start {
  std::string id;
  Eigen::VectorXd value;
};

template <class Real = double>
Eigen::VectorXd extended(const pluck_layout& layout, const Eigen::VectorXd& value, const pluck_effect& e,
                         const std::vector<double>& start) {
  Eigen::VectorX<Real> v(value.size() + static_cast<Eigen::Index>(start.size()));
  v.head(value.size()) = value;
  for (std::size_t i = 0; i < start.size(); ++i)
    v[value.size() + static_cast<Eigen::Index>(i)] = to_fitted(e.parameters[i], start[i]);
  if (e.rebase) e.rebase(layout, v);
  return v;
}
ROSIN_INSTANTIATE(Eigen::VectorXd extended(const pluck_layout&, const Eigen::VectorXd&, const pluck_effect&,
                                           const std::vector<double>&))

/// What an effect would gain as it stands: on the parabola through 0 and the best mix.
inline double gain_as_it_stands(const score_result& s) {
  return s.mix > 0 ? std::max(0.0, s.gain * (2 / s.mix - 1 / (s.mix * s.mix))) : 0.0;
}

/// Starts that depend on the recordings alone: found once, however often a search begins anew.
using known_starts = std::optional<std::vector<found_start>>;

/// A support's mode as the fit along a line of complex frequencies sees it (calibrate/end_fit.hpp), which no strong coupling
/// leads astray; for either end, whichever it chose. It knows of no other effect.
template <class Real = double>
[[nodiscard]] std::vector<found_start> support_starts(const scene_data& data, const std::vector<pluck_effect>& supports) {
  end_options one;
  one.most_modes = 1;
  pluck_options by_the_law = data.options;
  by_the_law.own_losses = 0;
  const auto fitted = fit_ends(data.takes, data.guess, by_the_law, one);
  if (!fitted || fitted->modes.empty() || fitted->plucks.value.size() != data.layout.loss_scatter()) return {};
  Eigen::VectorX<Real> value = Eigen::VectorX<Real>::Zero(data.layout.size());  // known ends as declared
  value.head(data.layout.loss_scatter()) = fitted->plucks.value;
  const admittance_mode& mode = fitted->modes.front().mode;
  std::vector<found_start> out;
  for (const pluck_effect& e : supports) {
    pluck_scene probe;
    const std::array<double, 4> unit{1000, 10, 1, 0};
    e.apply(probe, unit.data(), 0);
    const double per_mass = probe.ends[static_cast<std::size_t>(e.place)].modes.front().per_mass_per_s;
    out.push_back({e.id(), extended(data.layout, value, e, {mode.frequency_Hz, mode.q, mode.per_mass_per_s / per_mass, 0})});
  }
  return out;
}

/// The declared string with its releases where they are seen.
template <class = void>
std::optional<Eigen::VectorXd> declared_values(const scene_data& data) {
  auto start = find_start(data.takes, data.guess);
  if (!start) return std::nullopt;
  std::vector<double> position;
  for (std::size_t t = 0; t < data.takes.size(); ++t) {
    start->release_s[t] += 0.25 / start->fundamental_Hz - 0.25 / data.guess.fundamental_Hz;
    position.push_back(data.takes[t].position);
  }
  return data.layout.initial(data.takes, data.guess, data.guess.fundamental_Hz, start->release_s, position);
}

/// Masses from a thirtieth of the string's to a third of it, each at the place where it explains most of the first echoes.
template <class = void>
void add_load_starts(const scene_data& data, const std::vector<pluck_effect>& catalogue, std::array<double, 2> noise,
                     std::vector<found_start>& out) {
  const auto load =
      std::find_if(catalogue.begin(), catalogue.end(), [](const pluck_effect& e) { return e.name == "point-mass"; });
  const auto value = load == catalogue.end() ? std::nullopt : declared_values(data);
  if (!value) return;
  pluck_scene probe;
  std::vector<double> here = load->starts.front();
  here[0] = 0.5, here[1] = 1;
  load->apply(probe, here.data(), 0);
  const double string_mass = 0.5 / data.guess.fundamental_Hz / probe.scatterers.front().mass_s;
  auto problem = data.problem({}, *value, {1000, 1.5, true}, noise);
  problem.set_noise(problem.assess(*value).noise);
  const pluck_score test(problem, *value);
  const scene_plucks with(data.layout, data.guess.ac_coupled_Hz, {*load});
  for (const double share : {0.03, 0.06, 0.12, 0.24}) {
    double most = 0;
    std::vector<double> best;
    for (int i = 1; i < 48; ++i) {
      here[0] = i / 48.0, here[1] = share * string_mass;
      if (const double gain = gain_as_it_stands(test(with, here)); gain > most) most = gain, best = here;
    }
    if (most > 0) out.push_back({load->id(), extended(data.layout, *value, *load, best)});
  }
}

/// `declared`: the fit of the declared model. A load is only sought in this way where that leaves much.
template <class = void>
std::vector<found_start> strong_starts(const scene_data& data, const scene_fit& declared,
                                       const std::vector<pluck_effect>& catalogue, std::array<double, 2> noise,
                                       known_starts& of_supports) {
  constexpr double much = 0.3;
  std::vector<pluck_effect> supports;
  std::copy_if(catalogue.begin(), catalogue.end(), std::back_inserter(supports),
               [](const pluck_effect& e) { return e.name == "support-resonance"; });
  if (!supports.empty() && !of_supports) of_supports = support_starts(data, supports);
  std::vector<found_start> out = supports.empty() ? std::vector<found_start>{} : *of_supports;
  const auto& left = declared.quality.residual_ratio;
  if (!left.empty() && *std::max_element(left.begin(), left.end()) > much) add_load_starts(data, catalogue, noise, out);
  return out;
}
ROSIN_INSTANTIATE(std::vector<found_start> strong_starts(const scene_data&, const scene_fit&, const std::vector<pluck_effect>&,
                                                         std::array<double, 2>, known_starts&))

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
