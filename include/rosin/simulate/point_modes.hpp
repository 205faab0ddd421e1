// tier: hosted
// SPDX-License-Identifier: MIT
//
// Modes that are driven and looked at in one point only, stepped as in modal_bank.hpp: with the force linear over a step,
// exactly. Nothing but the velocity of the point is asked for, so each mode is counted in that: u = sin(k x) z, and
//
//     u(h) = e^{p h} u(0) + sin^2(k x) b (phi_a f(0) + phi_b f(h)) / mass,     velocity = sum Re u
//
// six products a step and mode. A wave string's torsion is one: it pushes no end.
//
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include <rosin/simulate/mode_step.hpp>

namespace rosin {

class point_modes {
public:
  point_modes() = default;
  template <class = void>
  point_modes(std::span<const string_mode> modes, double position, double step_s) {
    for (std::size_t n = 0; n < modes.size(); ++n) {
      if (n % width == 0) lanes_.emplace_back();
      const auto& m = modes[n];
      const auto r = respond_over_step(m, step_s);
      const double seen = m.shape(position) * m.shape(position);
      const auto push = seen * (r.decay * r.end + r.begin);
      const auto i = static_cast<Eigen::Index>(n % width);
      auto& l = lanes_.back();
      l.turn_re[i] = r.decay.real(), l.turn_im[i] = r.decay.imag();
      l.push_re[i] = push.real(), l.push_im[i] = push.imag();
      mobility_ += seen * r.end.real();
      compliance_ += seen / (m.mass_kg * m.omega_rad_s * m.omega_rad_s);
    }
  }

  /// Velocity for 1 N at the end of the same step.
  [[nodiscard]] double mobility() const noexcept { return mobility_; }
  /// Static displacement for 1 N, of these modes only.
  [[nodiscard]] double compliance() const noexcept { return compliance_; }
  /// Velocity at the end of the step under way if no force acts there.
  [[nodiscard]] double free() const noexcept { return free_; }

  /// Ends the step with this force and begins the next.
  template <class = void>
  void advance(double force) noexcept {
    pack sum = pack::Zero();
    for (auto& l : lanes_) {
      const pack re = l.turn_re * l.re - l.turn_im * l.im + l.push_re * force;
      l.im = l.turn_im * l.re + l.turn_re * l.im + l.push_im * force;
      l.re = re;
      sum += re;
    }
    free_ = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  }

private:
  static constexpr std::size_t width = 8;
  using pack = Eigen::Array<double, static_cast<int>(width), 1>;

  struct lane {
    pack re = pack::Zero(), im = pack::Zero(), turn_re = pack::Zero(), turn_im = pack::Zero(), push_re = pack::Zero(),
         push_im = pack::Zero();
  };

  std::vector<lane> lanes_{};
  double mobility_ = 0, compliance_ = 0, free_ = 0;
};

}  // namespace rosin
