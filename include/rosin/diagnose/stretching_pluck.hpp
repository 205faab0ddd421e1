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
// A mass M makes other modes, combinations v of those without it, each stiffened by v^T n^2 v in place of n^2 (they hardly mix).
//
#pragma once

#include <rosin/calibrate/pluck_model.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A plane across the one that is plucked: tuned to (1 + detuning), heard `coupling` times as strongly.
struct second_plane {
  double detuning = 0, coupling = 0;  ///< the latter tan(angle of the pluck) tan(angle of the sensors)
};

/// Something on the string that resists its motion, or is heavy.
struct string_load {
  double position = 0.5, resistance = 0, mass_s = 0;  ///< fraction of the length; R / Z; M / Z
};

/// Forces on both ends of a plucked string whose tension follows its length.
class stretching_pluck {
public:
  /// Partials to `most` below the stop frequency, seen through the band. Both planes have one tension: of the square of the
  /// motion a share c / (1 + c) is across, c = |coupling|, as if the angles of pluck and sensors were alike.
  template <class Real = double>
  stretching_pluck(const ringing_string& string, double position, double force_over_tension, const band& limits, int most,
                   second_plane other = {}, const std::vector<string_load>& loads = {}) {
    const double c = other.coupling, across = std::abs(c) / (1 + std::abs(c));
    ringing_string second = string;
    second.fundamental_Hz *= 1 + other.detuning, second.inharmonicity /= std::pow(1 + other.detuning, 2);
    add(string, loads, limits, most, 1 / (1 + c), 1 - across);
    if (c != 0) add(second, loads, limits, most, c / (1 + c), across);
    for (slowed& s : slowed_)
      for (Eigen::ArrayX<Real>* x : {&s.push, &s.feel}) append(*x, Eigen::ArrayX<Real>::Zero(kick_.size() - x->size()));
    pluck_at(position, force_over_tension);
  }

  /// The same string, plucked elsewhere or with another force.
  template <class Real = double>
  void pluck_at(double position, double force_over_tension) {
    force_ = force_over_tension;
    held_.resize(0);
    for (const plane_basis& m : planes_) {
      const Eigen::ArrayX<Real> pi_n = std::numbers::pi * numbers(m.partials);
      // Slope amplitude k q of the held string: 2 F sin(k x) / (L k (T + B k^2)) -> (2 / (n pi)) (F/T) sin / (1 + b)
      append(held_, 2 / pi_n * (position * pi_n).sin());
    }
  }

  /// Forces on {near, far}, relative to the pluck's own: `count` values, the first `first_s` after the release (in [0,
  /// sample_s]), then every sample_s, each reached in `steps` steps. stretch: EA / (4 T), dimensionless with k q in units of
  /// slope; raised: what else the tension is higher by, relatively.
  template <class Real = double>
  [[nodiscard]] std::array<std::vector<double>, 2> run(double stretch, double first_s, double sample_s, std::size_t steps,
                                                       std::size_t count, double raised = 0) const {
    Eigen::ArrayX<Real> q = held(raised), p = Eigen::ArrayX<Real>::Zero(q.size()), scratch;
    for (int i = 0; stretch > 0 && i < 8; ++i) q = held(raised + stretch * squared(q));  // the held string is stretched as well
    std::array<std::vector<double>, 2> out{std::vector<double>(count), std::vector<double>(count)};
    const double first_step_s = first_s / static_cast<double>(steps), step_s = sample_s / static_cast<double>(steps);
    const half_turn first_turn = half_turn_in(first_step_s), turn = half_turn_in(step_s);
    for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, first_turn, stretch, raised, first_step_s);
    for (std::size_t i = 0; i < count; ++i) {
      const double e = raised + (stretch > 0 ? stretch * squared(q) : 0);
      for (std::size_t c = 0; c < 2; ++c) out[c][i] = ((heard_[c] + e * heard_of_stretch_[c]) * q).sum() / force_;
      for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, turn, stretch, raised, step_s);
    }
    return out;
  }

  /// The string's mean strain (1 / 2L) integral y'^2 dx where its tension stays as it is, at the same instants.
  template <class Real = double>
  [[nodiscard]] std::vector<double> unstretched_strain(double first_s, double sample_s, std::size_t count) const {
    const half_turn begin = half_turn_in(2 * first_s), turn = half_turn_in(2 * sample_s);
    Eigen::ArrayX<Real> q = held(0), p = Eigen::ArrayX<Real>::Zero(q.size()), scratch;
    begin(q, p, scratch);
    std::vector<double> out(count);
    for (double& strain : out) {
      strain = squared(q) / 4;
      turn(q, p, scratch);
    }
    return out;
  }

  /// Mean strain of the held string.
  template <class = void>
  [[nodiscard]] double held_strain() const {
    return squared(held(0)) / 4;
  }

private:
  /// One plane as the string moves in it: modes, as combinations v of the partials that a string without masses has.
  struct plane {
    Eigen::ArrayXd frequency_Hz, stiffened;  ///< of each mode; v^T n^2 v
    Eigen::MatrixXd shapes;                  ///< v, column by column
    Eigen::MatrixXd to_modes;                ///< from displacements; empty without masses
  };
  /// Masses hang on what partials beyond the highest one give way by, as on springs.
  template <class Real = double>
  [[nodiscard]] static plane plane_of(const ringing_string& string, const std::vector<string_load>& loads, double stop_Hz,
                                      int most) {
    std::vector<string_load> masses;
    std::copy_if(loads.begin(), loads.end(), std::back_inserter(masses), [](const string_load& l) { return l.mass_s > 0; });
    int count = 0;
    const double highest_Hz = masses.empty() ? stop_Hz : 1.3 * stop_Hz;
    while (count < most && string.partial_Hz(count + 1) < highest_Hz) ++count;
    plane out;
    const auto squares = [&](const Eigen::ArrayX<Real>& n) {
      return Eigen::ArrayX<Real>(n.square() * (1 + string.inharmonicity * n.square()));  // of frequencies, in fundamentals
    };
    const Eigen::ArrayX<Real> n = numbers(count), w2 = squares(n);
    const auto dispersed = [&](double f) { return string.dispersed(f); };
    out.frequency_Hz = (string.fundamental_Hz * w2.sqrt()).unaryExpr(dispersed), out.stiffened = n.square();
    out.shapes = Eigen::MatrixX<Real>::Identity(count, count);
    if (masses.empty()) return out;
    const auto heavy = static_cast<Eigen::Index>(masses.size());
    Eigen::MatrixX<Real> stiffness = Eigen::MatrixX<Real>::Zero(count + heavy, count + heavy), inertia = stiffness,
                         at_rest = Eigen::MatrixX<Real>::Identity(count + heavy, count);
    stiffness.diagonal().head(count) = w2, inertia.diagonal().head(count).setOnes();
    const Eigen::ArrayX<Real> beyond = numbers(50 * count).tail(49 * count), beyond2 = squares(beyond);
    for (Eigen::Index m = 0; m < heavy; ++m) {
      const string_load& l = masses[static_cast<std::size_t>(m)];
      const auto shape = [&](const Eigen::ArrayX<Real>& k) {
        return Eigen::ArrayX<Real>((k * std::numbers::pi * l.position).sin());
      };
      const double spring = 1 / std::max(1e-9, (shape(beyond).square() / beyond2).sum());  // near an end hardly any give way
      Eigen::VectorX<Real> stretch = Eigen::VectorX<Real>::Zero(count + heavy);
      stretch.head(count) = shape(n).matrix(), stretch[count + m] = -1;
      stiffness += spring * stretch * stretch.transpose();
      inertia(count + m, count + m) = 4 * string.fundamental_Hz * l.mass_s;
      at_rest.row(count + m) = shape(n).matrix().transpose();
    }
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixX<Real>> modes(stiffness, inertia);
    const Eigen::ArrayX<Real> f =
        (string.fundamental_Hz * modes.eigenvalues().cwiseMax(0).cwiseSqrt().array()).unaryExpr(dispersed);
    const Eigen::Index kept = (f < stop_Hz).count();
    out.frequency_Hz = f.head(kept), out.shapes = modes.eigenvectors().topLeftCorner(count, kept);
    out.stiffened = (out.shapes.array().square().colwise() * n.square()).colwise().sum().transpose();
    out.to_modes = modes.eigenvectors().leftCols(kept).transpose() * inertia * at_rest;
    return out;
  }
  template <class Real = double>
  [[nodiscard]] static Eigen::ArrayXd numbers(Eigen::Index count) {
    return Eigen::ArrayX<Real>::LinSpaced(count, 1, static_cast<double>(count));
  }
  template <class = void>
  static void append(Eigen::ArrayXd& to, const Eigen::ArrayXd& more) {
    to.conservativeResize(to.size() + more.size());
    to.tail(more.size()) = more;
  }
  /// How much of one plane's modes is heard, and their share of the motion's square.
  template <class Real = double>
  void add(const ringing_string& string, const std::vector<string_load>& loads, const band& limits, int most, double heard,
           double share) {
    const plane modes = plane_of(string, loads, limits.stop_Hz, most);
    const Eigen::Index partials = modes.shapes.rows(), count = modes.shapes.cols(), first = kick_.size();
    const Eigen::ArrayX<Real> n = numbers(partials), pi_n = std::numbers::pi * n, stiff = 1 + string.inharmonicity * n.square();
    append(stiff_, stiff);
    const Eigen::ArrayX<Real> size = modes.stiffened.sqrt();  // of a mode in units of slope
    const Eigen::MatrixX<Real> slopes = n.matrix().asDiagonal() * modes.shapes * (1 / size).matrix().asDiagonal();
    planes_.push_back({partials, {}});
    if (modes.to_modes.size() > 0)
      planes_.back().to_modes = size.matrix().asDiagonal() * modes.to_modes * (1 / n).matrix().asDiagonal();
    Eigen::ArrayX<Real> weight(count), decay(count), turn(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const double f = modes.frequency_Hz[k], w = 2 * std::numbers::pi * f, half = string.loss.inverse_q(f) / 2;
      weight[k] = heard * band_weight(limits, {-w * half, w}).real(), decay[k] = w * half,
      turn[k] = w * std::sqrt(1 - half * half);
    }
    append(decay_1_s_, decay), append(turn_rad_s_, turn), append(share_, Eigen::ArrayX<Real>::Constant(count, share));
    append(kick_, std::pow(2 * std::numbers::pi * string.fundamental_Hz, 2) * modes.stiffened);
    for (std::size_t c = 0; c < 2; ++c) {
      const Eigen::ArrayX<Real> sign = c == 0 ? Eigen::ArrayX<Real>::Ones(partials) : Eigen::ArrayX<Real>(-(pi_n.cos()));
      append(heard_[c], weight * (slopes.transpose() * (sign * stiff).matrix()).array());
      append(heard_of_stretch_[c], weight * (slopes.transpose() * sign.matrix()).array());
    }
    for (const string_load& l : loads) {
      const Eigen::ArrayX<Real> there = (modes.shapes.transpose() * (l.position * pi_n).sin().matrix()).array();
      slowed s{Eigen::ArrayX<Real>::Zero(first), Eigen::ArrayX<Real>::Zero(first), 4 * l.resistance * string.fundamental_Hz,
               there.square().sum()};
      append(s.push, size * there), append(s.feel, there / size);
      if (l.resistance > 0 && s.all > 0) slowed_.push_back(std::move(s));
    }
  }
  /// Of the held string, in modes, as a rise e of its tension leaves it.
  template <class Real = double>
  [[nodiscard]] Eigen::ArrayXd held(double e) const {
    const Eigen::ArrayX<Real> slopes = force_ * held_ / (stiff_ + e);
    Eigen::ArrayX<Real> out;
    Eigen::Index at = 0;
    for (const plane_basis& m : planes_) {
      const Eigen::ArrayX<Real> here = slopes.segment(at, m.partials);
      append(out, m.to_modes.size() > 0 ? Eigen::ArrayX<Real>(m.to_modes * here.matrix()) : here);
      at += m.partials;
    }
    return out;
  }
  /// Sum of (k q)^2.
  template <class = void>
  [[nodiscard]] double squared(const Eigen::ArrayXd& q) const {
    return (share_ * q.square()).sum();
  }

  struct half_turn {
    Eigen::ArrayXd qq, qp, pq, pp;
    template <class = void>
    void operator()(Eigen::ArrayXd& q, Eigen::ArrayXd& p, Eigen::ArrayXd& scratch) const {
      scratch = qq * q + qp * p;
      p = pq * q + pp * p;
      q.swap(scratch);
    }
  };

  template <class Real = double>
  [[nodiscard]] half_turn half_turn_in(double step_s) const {
    const double h = step_s / 2;
    const Eigen::ArrayX<Real> decay = (-decay_1_s_ * h).exp(), s = (turn_rad_s_ * h).sin() / turn_rad_s_,
                              c = (turn_rad_s_ * h).cos();
    return {decay * (c + decay_1_s_ * s), decay * s, -decay * (decay_1_s_.square() + turn_rad_s_.square()) * s,
            decay * (c - decay_1_s_ * s)};
  }

  template <class = void>
  void step(Eigen::ArrayXd& q, Eigen::ArrayXd& p, Eigen::ArrayXd& scratch, const half_turn& turn, double stretch, double raised,
            double step_s) const {
    turn(q, p, scratch);
    p -= (raised + stretch * squared(q)) * step_s * kick_ * q;
    for (const slowed& s : slowed_) p -= (-std::expm1(-s.rate_1_s * s.all * step_s) / s.all * (s.feel * p).sum()) * s.push;
    turn(q, p, scratch);
  }

  /// What a damper does by itself: p' = -rate push (feel . p); `all` is push . feel.
  struct slowed {
    Eigen::ArrayXd push, feel;
    double rate_1_s = 0, all = 0;
  };

  struct plane_basis {
    Eigen::Index partials = 0;
    Eigen::MatrixXd to_modes;  ///< empty: the partials are the modes
  };

  double force_ = 0;
  std::vector<plane_basis> planes_;
  std::vector<slowed> slowed_;
  Eigen::ArrayXd held_, stiff_;                             ///< partial by partial
  Eigen::ArrayXd kick_, share_, decay_1_s_, turn_rad_s_;    ///< mode by mode
  std::array<Eigen::ArrayXd, 2> heard_, heard_of_stretch_;  ///< per end, of a mode and of e times it
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

#include <rosin/core/macros_back.ipp>
