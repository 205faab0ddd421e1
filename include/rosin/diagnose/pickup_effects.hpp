// tier: hosted
// SPDX-License-Identifier: MIT
//
// The effects on a string's partials that a single channel can show, each as free numbers of the law (pickup_poles.hpp) with
// bounds, and where to begin. An effect of a place or of a frequency is sought along it first: how much would a little of it,
// there, take away? The three best places are then fitted in full. Adding an effect of this kind is one entry.
//
// Not here: a position and its mirror image look alike to partials; high-passes, sensors' resonances and the pluck's own shape
// change amplitudes only, and those are free.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_law_fit.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct law_effect {
  std::string name;
  std::vector<law_parameter> parameters;
  double pickup_law::*strength = nullptr;  ///< zero: not there
  double little = 0;                       ///< of it, to look along the places
  std::vector<pickup_law> places;          ///< where it is sought: only the effect's own members count
};

namespace detail {

inline std::vector<pickup_law> bead_places(double pickup_law::*position, int highest) {
  std::vector<pickup_law> out;
  const int count = std::clamp(4 * highest, 40, 240);
  for (int i = 1; i <= count; ++i) {
    pickup_law l;
    l.*position = 0.5 * i / count;
    out.push_back(l);
  }
  return out;
}

inline std::vector<pickup_law> support_places(double low_Hz, double high_Hz) {
  std::vector<pickup_law> out;
  for (double f = low_Hz; f < high_Hz; f *= 1.03)
    for (const double q : {5.0, 15.0, 50.0}) {
      pickup_law l;
      l.support_Hz = f, l.support_q = q;
      out.push_back(l);
    }
  return out;
}

}  // namespace detail

/// For a table of this pitch up to that partial.
[[nodiscard]] inline std::vector<law_effect> law_effects(double fundamental_Hz, int highest) {
  using l = pickup_law;
  const double top = fundamental_Hz * highest;
  return {
      {"bending-stiffness", {{"inharmonicity", &l::inharmonicity, 0, 0.05}}, &l::inharmonicity, 1e-7, {{}}},
      {"frequency-dependent-loss", {{"loss_internal_s", &l::internal_s, 0, 1e-4}}, &l::internal_s, 1e-10, {{}}},
      {"air-loss", {{"loss_air_sqrt_Hz", &l::air_sqrt_Hz, 0, 10}}, &l::air_sqrt_Hz, 1e-6, {{}}},
      {"resistive-end", {{"conductance", &l::conductance, 0, 0.2}}, &l::conductance, 1e-7, {{}}},
      {"point-mass",
       {{"position", &l::bead_position, 0.002, 0.5}, {"mass", &l::bead_mass, 0, 0.5}},
       &l::bead_mass,
       1e-6,
       detail::bead_places(&l::bead_position, highest)},
      {"point-damper",
       {{"position", &l::finger_position, 0.002, 0.5}, {"resistance", &l::finger_resistance, 0, 1}},
       &l::finger_resistance,
       1e-7,
       detail::bead_places(&l::finger_position, highest)},
      {"support-resonance",
       {{"frequency_Hz", &l::support_Hz, 0.4 * fundamental_Hz, 1.1 * top, true},
        {"q", &l::support_q, 1, 300, true},
        {"lightness", &l::support_lightness, 0, 5}},
       &l::support_lightness,
       1e-6,
       detail::support_places(0.5 * fundamental_Hz, top)},
  };
}

/// What every law has.
[[nodiscard]] inline std::vector<law_parameter> ideal_string(double fundamental_Hz) {
  return {{"fundamental_Hz", &pickup_law::fundamental_Hz, 0.5 * fundamental_Hz, 2 * fundamental_Hz, true},
          {"inverse_quality", &pickup_law::inverse_q, 0, 0.2}};
}

namespace detail {

/// The law with as much of an effect at each of its places as the score there calls for, the best gain first.
template <class Real = double>
std::vector<std::pair<double, pickup_law>> likeliest_places(const line_table& table, const fitted_law& base,
                                                            const law_effect& e) {
  std::vector<std::pair<double, pickup_law>> starts;
  const law_problem problem(table, base.parameters, base.in_proportion);
  const Eigen::VectorX<Real> plain = problem.predicted(base.law);
  const auto score = problem.score_at(base.law);
  for (const auto& place : e.places) {
    pickup_law at = base.law;
    for (const auto& p : e.parameters) at.*p.member = place.*p.member;
    at.*e.strength = e.little;
    const auto [gain, size] = score((problem.predicted(at) - plain) / e.little);
    if (!(size > 0)) continue;
    at.*e.strength = size;
    starts.emplace_back(gain, at);
  }
  std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  return starts;
}

}  // namespace detail

/// The law with one effect more, from the three likeliest places on. What a load makes of the string's loss is a matter of
/// convention: both are tried.
template <class Real = double>
[[nodiscard]] fitted_law with_effect(const line_table& table, const fitted_law& base, const law_effect& e) {
  const auto starts = detail::likeliest_places(table, base, e);
  std::vector<law_parameter> parameters = base.parameters;
  parameters.insert(parameters.end(), e.parameters.begin(), e.parameters.end());
  fitted_law best = base;
  best.log_likelihood = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min<std::size_t>(3, starts.size()); ++i)
    for (const double share : {1.0, 0.3})
      for (const double loaded : e.places.size() > 1 ? std::vector{0.0, 1.0} : std::vector{base.law.loaded_loss}) {
        pickup_law at = starts[i].second;
        at.*e.strength = std::min(at.*e.strength * share, e.parameters.back().high);
        at.loaded_loss = loaded;
        if (fitted_law f = detail::law_problem(table, parameters, base.in_proportion).fit(at);
            f.log_likelihood > best.log_likelihood)
          best = f;
      }
  if (std::isfinite(best.log_likelihood)) return fit_law(table, parameters, best.law);
  best.parameters = parameters, best.log_likelihood = base.log_likelihood;  // nothing of it anywhere
  best.sd = Eigen::VectorX<Real>::Zero(static_cast<Eigen::Index>(parameters.size()));
  best.sd.head(base.sd.size()) = base.sd;
  return best;
}
ROSIN_INSTANTIATE(fitted_law with_effect(const line_table&, const fitted_law&, const law_effect&))

/// ln L less what so many free numbers gain by chance; small tables pay more.
[[nodiscard]] inline double evidence_of(const fitted_law& f, std::size_t lines) {
  const double n = 2 * static_cast<double>(lines), p = static_cast<double>(f.parameters.size());
  return f.log_likelihood - 0.5 * p * std::log(n) * n / std::max(n - p - 2, 1.0);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
