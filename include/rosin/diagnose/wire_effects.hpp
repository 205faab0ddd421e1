// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a wire does that does not break at once, or holds more than a point of the string. No wire breaks at once: a release over some
// microseconds stays in the model of the plucks without a name.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effect.hpp>

#include <algorithm>
#include <vector>

namespace rosin {

/// A wire of a tenth of a millimetre that parts as slowly as by 25 m/s takes so long.
inline constexpr double ordinary_release_s = 4e-6;

/// The wire lets go over a time, `each` pluck over its own. What was taken for the instant of release is its middle. Not as a
/// logarithm: what a fit knows best is the middle, a straight line in instant and duration.
template <class Real = double>
pluck_effect slow_release_effect(const string_facts& f, bool each = false) {
  const std::size_t count = each ? f.takes : 1;
  pluck_effect e{.name = "slow-release",
                 .strength = -1,
                 .apply = [each](pluck_scene& s, const double* v, int take) { s.release_duration_s = v[each ? take : 0]; },
                 .variant = each ? "each" : ""};
  for (int t = 0; t < static_cast<int>(count); ++t)
    e.parameters.push_back({"duration_s", each ? 2e-8 : 2e-7, 1e-3, 1e-9, false, each ? t : -1});
  for (const double duration_s : {8e-7, 1.5e-6, 3e-6, 1e-5, 1.8e-5, 3e-5, 6e-5, 1.2e-4}) e.starts.emplace_back(count, duration_s);
  if (!each) e.shrinks_with = 0;
  e.is_ordinary = [](const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double duration_s) { return duration_s < ordinary_release_s; });
  };
  e.rebase = [each, first = static_cast<Eigen::Index>(count)](const pluck_layout& layout, Eigen::VectorX<Real>& v) {
    for (std::size_t t = 0; t < layout.takes(); ++t)
      v[layout.at(t, pluck_layout::release)] -= v[v.size() - first + static_cast<Eigen::Index>(each ? t : 0)] / 2;
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect slow_release_effect(const string_facts&, bool))

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
