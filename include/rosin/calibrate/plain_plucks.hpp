// tier: hosted
// SPDX-License-Identifier: MIT
//
// What rings in the plucks of a string between pinned ends, as the problem behind their fit sees it (pluck_problem.hpp): partials, and
// in each channel one slow line.
//
#pragma once

#include <rosin/calibrate/pluck_layout.hpp>

#include <cmath>
#include <complex>
#include <numbers>

namespace rosin {

/// Plucks of a string between pinned ends.
struct plain_plucks : pluck_layout {
  std::array<double, 2> ac_coupled_Hz{};

  plain_plucks(const pluck_layout& layout, std::array<double, 2> corner_Hz) : pluck_layout{layout}, ac_coupled_Hz{corner_Hz} {}
  template <class = void>
  [[nodiscard]] rosin::own_losses own_losses_at(const Eigen::VectorXd& v, std::size_t, const band&, int) const {
    return own_losses_of(v, string(v));
  }
  /// The ringing partials first, then one slow line a channel.
  template <class = void>
  [[nodiscard]] std::vector<damped_line> lines(const Eigen::VectorXd& v, std::size_t take, std::size_t part, double begin_s,
                                               const band& limits, int most) const {
    const double newtons = std::exp(v[at(take, strength)]), released = release_s(v, take);
    std::vector<damped_line> out;
    if (part == 1) out = pluck_lines(string(v), own_losses_of(v, string(v)), v[position(take)], begin_s - released, limits, most);
    for (std::size_t c = 0; c < 2; ++c) {
      const double scale = newtons * gain(v, c), corner = 2 * std::numbers::pi * ac_coupled_Hz[c];
      for (damped_line& line : out) line.residue[c] *= scale * (corner > 0 ? line.pole / (line.pole + corner) : 1.0);
    }
    for (std::size_t c = 0; c < 2; ++c)
      out.push_back(
          slow_line(v, take, part, begin_s, c, ac_coupled_Hz[c], newtons * gain(v, c) * static_forces(v[position(take)])[c]));
    return out;
  }
};

}  // namespace rosin
