// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a wire does that does not break at once, or holds more than a point of the string. No wire breaks at once: a release over some
// microseconds stays in the model of the plucks without a name.
//
#pragma once

#include <rosin/diagnose/pluck_effect.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rosin {

/// A wire of a tenth of a millimetre that parts as slowly as by 25 m/s takes so long.
inline constexpr double ordinary_release_s = 4e-6;

/// The wire lets go over a time. Not as a logarithm: what a fit knows best is the middle, a straight line in instant and duration.
inline pluck_effect slow_release_effect(const string_facts&) {
  pluck_effect e{.name = "slow-release",
                 .parameters = {{"duration_s", 2e-7, 1e-3, 1e-9}},
                 .starts = {{8e-7}, {1.5e-6}, {3e-6}, {1e-5}, {1.8e-5}, {3e-5}, {6e-5}, {1.2e-4}},
                 .strength = -1,
                 .apply = [](pluck_scene& s, const double* v, int) { s.release_duration_s = v[0]; }};
  e.shrinks_with = 0;
  e.is_ordinary = [](const std::vector<double>& v) { return v[0] < ordinary_release_s; };
  e.rebase = [](const pluck_layout& layout, Eigen::VectorXd& v) {
    for (std::size_t t = 0; t < layout.takes(); ++t) v[layout.at(t, pluck_layout::release)] -= v[v.size() - 1] / 2;
  };
  return e;
}

/// The same, each pluck over a time of its own.
inline pluck_effect own_releases_effect(const string_facts& f) {
  pluck_effect e{.name = "slow-release",
                 .strength = -1,
                 .apply = [](pluck_scene& s, const double* v, int take) { s.release_duration_s = v[take]; },
                 .variant = "each"};
  for (std::size_t t = 0; t < f.takes; ++t) e.parameters.push_back({"duration_s", 2e-8, 1e-3, 1e-9, false, static_cast<int>(t)});
  for (const double duration_s : {1.5e-6, 3e-6, 1e-5, 3e-5, 1e-4}) e.starts.emplace_back(f.takes, duration_s);
  e.is_ordinary = [](const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double duration_s) { return duration_s < ordinary_release_s; });
  };
  e.rebase = [](const pluck_layout& layout, Eigen::VectorXd& v) {
    const Eigen::Index first = v.size() - static_cast<Eigen::Index>(layout.takes());
    for (std::size_t t = 0; t < layout.takes(); ++t)
      v[layout.at(t, pluck_layout::release)] -= v[first + static_cast<Eigen::Index>(t)] / 2;
  };
  return e;
}

/// The wire grips the string over a width.
inline pluck_effect pluck_width_effect(const string_facts& f) {
  const double L = f.length_m > 0 ? f.length_m : 1.0;
  pluck_effect e{.name = "finite-pluck-width",
                 .parameters = {{"width_m", 1e-5 * L, 0.1 * L, 1e-5, true}},
                 .starts = {{3e-4 * L}, {6e-4 * L}, {1.5e-3 * L}, {3e-3 * L}, {1e-2 * L}, {3e-2 * L}},
                 .strength = -1,
                 .apply = [L](pluck_scene& s, const double* v, int) { s.width = v[0] / L; }};
  e.shrinks_with = 0;
  return e;
}

}  // namespace rosin
