// tier: hosted
// SPDX-License-Identifier: MIT
//
// A plucked string that is stretched by its own motion,
//
//     q_n'' + (w_n / Q) q_n' + [w_n^2 + e(t) (c k_n)^2] q_n = 0,    e = EA / (2 L T) integral y'^2 dx = EA / (4 T) sum (k_n q_n)^2
//
// (Kirchhoff; Carrier 1945), stepped: each mode turns exactly through half a step, is kicked by the tension, and turns on
// (Strang). Motion across the plane of the pluck stretches it as well, and feels the same tension. A damper at x_d, of resistance
// R, slows all modes at once by what it does in a step alone,
//
//     d/dt (k_n q_n)' = -4 (R / Z) f_1 n sin(n pi x_d) sum (k_m q_m)' sin(m pi x_d) / m.
//
#pragma once

#include <rosin/calibrate/pluck_model.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace rosin {

/// A plane across the one that is plucked: tuned to (1 + detuning), heard `coupling` times as strongly.
struct second_plane {
  double detuning = 0, coupling = 0;  ///< the latter tan(angle of the pluck) tan(angle of the sensors)
};

/// Something on the string that resists its motion.
struct damping_place {
  double position = 0.5, resistance = 0;  ///< fraction of the length; R / Z
};

/// Forces on both ends of a plucked string whose tension follows its length.
class stretching_pluck {
public:
  /// Partials to `most` below the stop frequency, seen through the band. Both planes have one tension: of the square of the
  /// motion a share c / (1 + c) is across, c = |coupling|, as if the angles of pluck and sensors were alike.
  stretching_pluck(const ringing_string& string, double position, double force_over_tension, const band& limits, int most,
                   second_plane other = {}, const std::vector<damping_place>& dampers = {})
      : force_{force_over_tension} {
    const double c = other.coupling, across = std::abs(c) / (1 + std::abs(c));
    ringing_string second = string;
    second.fundamental_Hz *= 1 + other.detuning, second.inharmonicity /= std::pow(1 + other.detuning, 2);
    const int first_count = partials_of(string, limits.stop_Hz, most),
              second_count = c != 0 ? partials_of(second, limits.stop_Hz, most) : 0;
    for (Eigen::ArrayXd* x : {&held_, &kick_, &stiff_, &weight_, &share_, &sign_, &decay_1_s_, &turn_rad_s_})
      x->resize(first_count + second_count);
    put(string, position, limits, 0, first_count, 1 / (1 + c), 1 - across);
    put(second, position, limits, first_count, second_count, c / (1 + c), across);
    for (const damping_place& d : dampers) {
      slow_down(d, string.fundamental_Hz, 0, first_count);
      if (second_count > 0) slow_down(d, second.fundamental_Hz, first_count, second_count);
    }
  }

  /// Forces on {near, far}, relative to the pluck's own: `count` values, the first `first_s` after the release (in [0,
  /// sample_s]), then every sample_s, each reached in `steps` steps. stretch: EA / (4 T), dimensionless with k q in units of
  /// slope.
  [[nodiscard]] std::array<std::vector<double>, 2> run(double stretch, double first_s, double sample_s, std::size_t steps,
                                                       std::size_t count) const {
    Eigen::ArrayXd q, p = Eigen::ArrayXd::Zero(held_.size()), scratch;
    double e = 0;
    for (int i = 0; i < 8; ++i) {  // the held string is stretched as well
      q = force_ * held_ * stiff_ / (stiff_ + e);
      e = stretch * squared(q);
    }
    std::array<std::vector<double>, 2> out{std::vector<double>(count), std::vector<double>(count)};
    const double first_step_s = first_s / static_cast<double>(steps), step_s = sample_s / static_cast<double>(steps);
    const half_turn first_turn = half_turn_in(first_step_s), turn = half_turn_in(step_s);
    for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, first_turn, stretch, first_step_s);
    for (std::size_t i = 0; i < count; ++i) {
      scratch = weight_ * (stiff_ + stretch * squared(q)) * q;
      out[0][i] = scratch.sum() / force_, out[1][i] = (sign_ * scratch).sum() / force_;
      for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, turn, stretch, step_s);
    }
    return out;
  }

  /// The string's mean strain (1 / 2L) integral y'^2 dx where its tension stays as it is, at the same instants.
  [[nodiscard]] std::vector<double> unstretched_strain(double first_s, double sample_s, std::size_t count) const {
    const half_turn begin = half_turn_in(2 * first_s), turn = half_turn_in(2 * sample_s);
    Eigen::ArrayXd q = force_ * held_, p = Eigen::ArrayXd::Zero(held_.size()), scratch;
    begin(q, p, scratch);
    std::vector<double> out(count);
    for (double& strain : out) {
      strain = squared(q) / 4;
      turn(q, p, scratch);
    }
    return out;
  }

  /// Mean strain of the held string.
  [[nodiscard]] double held_strain() const { return squared(force_ * held_) / 4; }

private:
  [[nodiscard]] static int partials_of(const ringing_string& string, double stop_Hz, int most) {
    int count = 0;
    while (count < most && string.partial_Hz(count + 1) < stop_Hz) ++count;
    return count;
  }

  /// Partials of one plane, from `first` on: how much of them is heard, and their share of the motion's square.
  void put(const ringing_string& string, double position, const band& limits, int first, int count, double heard, double share) {
    for (int n = 1; n <= count; ++n) {
      const int i = first + n - 1;
      const double f = string.partial_Hz(n), w = 2 * std::numbers::pi * f, half = string.loss.inverse_q(f) / 2;
      const double c_k = 2 * std::numbers::pi * string.fundamental_Hz * n, b = string.inharmonicity * n * n;
      // Slope amplitude k q of the held string: 2 F sin(k x) / (L k (T + B k^2)) -> (2 / (n pi)) (F/T) sin / (1 + b)
      held_[i] = 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) / (1 + b);
      kick_[i] = c_k * c_k, stiff_[i] = 1 + b, weight_[i] = heard * band_weight(limits, {-w * half, w}).real(), share_[i] = share,
      sign_[i] = n % 2 ? 1 : -1;
      decay_1_s_[i] = w * half, turn_rad_s_[i] = w * std::sqrt(1 - half * half);
    }
  }
  /// Of one plane's partials, from `first` on.
  void slow_down(const damping_place& d, double fundamental_Hz, int first, int count) {
    slowed s{Eigen::ArrayXd::Zero(held_.size()), Eigen::ArrayXd::Zero(held_.size()), 4 * d.resistance * fundamental_Hz, 0};
    for (int n = 1; n <= count; ++n) {
      const double there = std::sin(n * std::numbers::pi * d.position);
      s.push[first + n - 1] = n * there, s.feel[first + n - 1] = there / n;
    }
    s.all = (s.push * s.feel).sum();
    if (s.all > 0) slowed_.push_back(std::move(s));
  }
  /// Sum of (k q)^2.
  [[nodiscard]] double squared(const Eigen::ArrayXd& q) const { return (share_ * q.square()).sum(); }

  struct half_turn {
    Eigen::ArrayXd qq, qp, pq, pp;
    void operator()(Eigen::ArrayXd& q, Eigen::ArrayXd& p, Eigen::ArrayXd& scratch) const {
      scratch = qq * q + qp * p;
      p = pq * q + pp * p;
      q.swap(scratch);
    }
  };

  [[nodiscard]] half_turn half_turn_in(double step_s) const {
    const double h = step_s / 2;
    const Eigen::ArrayXd decay = (-decay_1_s_ * h).exp(), s = (turn_rad_s_ * h).sin() / turn_rad_s_, c = (turn_rad_s_ * h).cos();
    return {decay * (c + decay_1_s_ * s), decay * s, -decay * (decay_1_s_.square() + turn_rad_s_.square()) * s,
            decay * (c - decay_1_s_ * s)};
  }

  void step(Eigen::ArrayXd& q, Eigen::ArrayXd& p, Eigen::ArrayXd& scratch, const half_turn& turn, double stretch,
            double step_s) const {
    turn(q, p, scratch);
    p -= stretch * squared(q) * step_s * kick_ * q;
    for (const slowed& s : slowed_) p -= (-std::expm1(-s.rate_1_s * s.all * step_s) / s.all * (s.feel * p).sum()) * s.push;
    turn(q, p, scratch);
  }

  /// What a damper does by itself: p' = -rate push (feel . p); `all` is push . feel.
  struct slowed {
    Eigen::ArrayXd push, feel;
    double rate_1_s = 0, all = 0;
  };

  double force_;
  std::vector<slowed> slowed_;
  Eigen::ArrayXd held_, kick_, stiff_, weight_, share_, sign_, decay_1_s_, turn_rad_s_;  ///< mode by mode
};

/// What the tension of a plucked string is higher by in the mean over the first periods, relatively: half of e is there in the
/// mean, as half of the energy is.
[[nodiscard]] inline double mean_stretch(const ringing_string& string, double position, double force_over_tension, double stretch,
                                         double periods) {
  double sum = 0;
  for (int n = 1; n <= 200; ++n) {
    const double q = force_over_tension * 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) /
                     (1 + string.inharmonicity * n * n);
    const double lost = 2 * std::numbers::pi * n * periods * std::max(0.0, string.loss.inverse_q(n * string.fundamental_Hz));
    sum += 0.5 * q * q * (lost > 1e-6 ? -std::expm1(-lost) / lost : 1.0);
  }
  return stretch * sum;
}

/// The string with that much more tension.
[[nodiscard]] inline ringing_string tightened(ringing_string string, double relative) {
  string.fundamental_Hz *= std::sqrt(1 + relative);
  string.inharmonicity /= 1 + relative;
  return string;
}
/// The string that was tightened so.
[[nodiscard]] inline ringing_string relaxed(const ringing_string& string, double relative) {
  return tightened(string, 1 / (1 + relative) - 1);
}

}  // namespace rosin
