// tier: hosted
// SPDX-License-Identifier: MIT
//
// Torsion of a string that is held at two places, a and b: how fast either rolls under a newton at the same or at the other one.
// With Q alike at all frequencies (torsion_response.hpp), t_a, t_b the travel times from a to the near end and from b to the far
// one, t between them,
//
//     H_ij = sinh(g x_<) sinh(g (T - x_>)) / (Z_T sinh(g T)),    T = t_a + t + t_b,  g = i w + |w| / (2 Q),
//
// x_< and x_> the travel times from the near end to the nearer and to the farther of i and j (dispersed, and with the impedance that
// goes with it, where that is asked for); with viscous modes (torsion_modes.hpp) the sum H_ij = (2 / (Z_T T)) sum_n sin(n pi x_i / T) sin(n pi x_j / T) i w / (w_n^2 - w^2 + i w w_n / Q),
// and the compliance of the modes that are not summed.
//
#pragma once

#include <rosin/torsion/torsion_fit.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class torsion_pair {
public:
  using complex = std::complex<double>;
  /// Surface velocities for 1 N at a frequency, m/s per N: at a, at b, at either under the other.
  struct response {
    complex aa = 0, bb = 0, across = 0;
  };

  /// `delay_s`: torsional, from a to the near end, between both, from b to the far end. `modes`: viscous ones to sum.
  torsion_pair(const std::array<double, 3>& delay_s, double impedance_Ns_m, double q, torsion_damping damping, int modes)
      : a_{delay_s[0]}, b_{delay_s[0] + delay_s[1]}, all_{delay_s[0] + delay_s[1] + delay_s[2]},
        impedance_{impedance_Ns_m}, q_{q}, damping_{damping} {
    if (!in_modes(damping)) return;
    rest_ = {static_compliance(a_, a_), static_compliance(b_, b_), static_compliance(a_, b_)};
    for (int n = 1; n <= modes; ++n) {
      const double turn = n * std::numbers::pi / all_, at_a = std::sin(turn * a_), at_b = std::sin(turn * b_),
                   weight = 2 / (impedance_ * all_);
      const double wn = torsion_modes::ratio(n, q_, is_causal(damping)) * std::numbers::pi / all_;
      modes_.push_back({wn, weight * at_a * at_a, weight * at_b * at_b, weight * at_a * at_b});
      for (std::size_t k = 0; k < 3; ++k) rest_[k] -= modes_.back()[k + 1] / (turn * turn);
    }
    const double wider = torsion_modes::ratio(modes, q_, is_causal(damping)) / modes;
    for (double& r : rest_) r /= wider * wider;
  }

  [[nodiscard]] response operator()(double frequency_Hz) const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz;
    if (w == 0) return {};
    if (!in_modes(damping_)) {
      const causal_loss loss(q_, is_causal(damping_) ? w * all_ / std::numbers::pi : 0);
      const complex g = w * loss.sooner * complex(loss.per_phase, 1), scale = loss.softer / (impedance_ * std::sinh(g * all_)),
                    a = std::sinh(g * a_), b = std::sinh(g * (all_ - b_));
      return {a * std::sinh(g * (all_ - a_)) * scale, b * std::sinh(g * b_) * scale, a * b * scale};
    }
    const complex turn(0, w);
    response r{turn * rest_[0], turn * rest_[1], turn * rest_[2]};
    for (const auto& [wn, aa, bb, across] : modes_) {
      const complex one = turn / complex(wn * wn - w * w, w * wn / q_);
      r.aa += aa * one, r.bb += bb * one, r.across += across * one;
    }
    return r;
  }

private:
  [[nodiscard]] double static_compliance(double x, double y) const noexcept {
    return std::min(x, y) * (all_ - std::max(x, y)) / (all_ * impedance_);
  }

  double a_, b_, all_, impedance_, q_;
  torsion_damping damping_;
  std::array<double, 3> rest_{};
  std::vector<std::array<double, 4>> modes_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
