// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects of plucks that are not linear, as what has to be taken out of a recording to make it so.
//
// A sensor with output = f + a f^2 is inverted, f = (sqrt(1 + 4 a y) - 1) / (2 a). A string that is stretched by its own motion,
//
//     q_n'' + (w_n / Q) q_n' + [w_n^2 + e(t) (c k_n)^2] q_n = 0,    e = EA / (2 L T) integral y'^2 dx = EA / (4 T) sum (k_n q_n)^2
//
// (Kirchhoff; Carrier 1945), is simulated twice, with and without e, and the difference taken
// out: each mode turns exactly through half a step, is kicked by the tension, and turns on (Strang). A sensor that also feels the
// tension itself records  f + s (1 / 2L) integral y'^2 dx:  sums and differences of partials, which players know as phantoms.
//
#pragma once

#include <rosin/condition/ac_coupling.hpp>
#include <rosin/diagnose/pluck_effect.hpp>

namespace rosin {

namespace detail {

/// f, where y = f + a f^2.
[[nodiscard]] inline double straightened(double y, double a) { return (std::sqrt(std::max(0.0, 1 + 4 * a * y)) - 1) / (2 * a); }

/// What a channel felt before its high-pass. The lost constant is such that f, where felt = f + a f^2, has no mean in the later half: a string
/// that rings swings about zero. (A bowed one does not: there the curvature is undone about a level that is off by the mean force.)
inline void bring_back_level(std::vector<double>& felt, double a, double corner_Hz, double rate_Hz) {
  restore_ac_coupled(std::span(felt), corner_Hz, rate_Hz);
  const auto later = felt.begin() + static_cast<std::ptrdiff_t>(felt.size() / 2);
  for (int round = 0; round < 3; ++round) {
    double mean = 0;
    for (auto x = later; x != felt.end(); ++x) mean += straightened(*x, a);
    mean /= static_cast<double>(std::max<std::ptrdiff_t>(1, felt.end() - later));
    for (double& x : felt) x -= mean;
  }
}

}  // namespace detail

/// output = f + a f^2 in one channel. A high-pass comes behind it: a f^2 passes it, too.
inline pluck_effect sensor_nonlinearity_effect(const string_facts&, int channel) {
  pluck_effect e{"sensor-nonlinearity", channel, false, {{"quadratic_per_N", -0.6, 0.6, 1e-4, false, -1, true}}, {{0}}, -3, {}};
  e.undo = [channel](std::vector<pluck_take>& takes, const pluck_scene& scene, const pluck_layout&, const Eigen::VectorXd& v, double a) {
    const auto c = static_cast<std::size_t>(channel);
    const double gain = std::exp(v[pluck_layout::gain_near + channel]), corner_Hz = scene.sensors[c].corner_Hz;
    for (pluck_take& take : takes) {
      std::vector<double> excess = take.force_N[c];
      for (double& x : excess) x /= gain;
      if (corner_Hz > 0) detail::bring_back_level(excess, a, corner_Hz, take.rate_Hz);
      for (double& x : excess) x -= detail::straightened(x, a);
      pass_ac_coupled(std::span(excess), corner_Hz, take.rate_Hz);
      for (std::size_t i = 0; i < excess.size(); ++i) take.force_N[c][i] -= gain * excess[i];
    }
  };
  return e;
}

/// What stretching_pluck gives: forces on {near, far} relative to the pluck's own, and the string's mean strain (1 / 2L) integral y'^2 dx.
struct stretched_motion {
  std::array<std::vector<double>, 2> force;
  std::vector<double> strain;
};

/// Forces on both ends of a plucked string whose tension follows its length.
class stretching_pluck {
public:
  /// Partials to `most` below the stop frequency, seen through the band.
  stretching_pluck(const ringing_string& string, double position, double force_over_tension, const band& limits, int most) : force_{force_over_tension} {
    int count = 0;
    while (count < most && string.partial_Hz(count + 1) < limits.stop_Hz) ++count;
    for (Eigen::ArrayXd* x : {&held_, &kick_, &stiff_, &weight_, &sign_, &decay_1_s_, &turn_rad_s_}) x->resize(count);
    for (int i = 0; i < count; ++i) {
      const int n = i + 1;
      const double f = string.partial_Hz(n), w = 2 * std::numbers::pi * f, half = string.loss.inverse_q(f) / 2;
      const double c_k = 2 * std::numbers::pi * string.fundamental_Hz * n, b = string.inharmonicity * n * n;
      // Slope amplitude k q of the held string: 2 F sin(k x) / (L k (T + B k^2)) -> (2 / (n pi)) (F/T) sin / (1 + b)
      held_[i] = 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) / (1 + b);
      kick_[i] = c_k * c_k, stiff_[i] = 1 + b, weight_[i] = band_weight(limits, {-w * half, w}).real(), sign_[i] = n % 2 ? 1 : -1;
      decay_1_s_[i] = w * half, turn_rad_s_[i] = w * std::sqrt(1 - half * half);
    }
  }

  /// `count` values, the first `first_s` after the release (in [0, sample_s]), then every sample_s, each reached in `steps` steps.
  /// stretch: EA / (4 T), dimensionless with k q in units of slope.
  [[nodiscard]] stretched_motion run(double stretch, double first_s, double sample_s, std::size_t steps, std::size_t count) const {
    Eigen::ArrayXd q, p = Eigen::ArrayXd::Zero(held_.size()), scratch;
    double e = 0;
    for (int i = 0; i < 8; ++i) {  // the held string is stretched as well
      q = force_ * held_ * stiff_ / (stiff_ + e);
      e = stretch * q.square().sum();
    }
    stretched_motion out{{std::vector<double>(count), std::vector<double>(count)}, std::vector<double>(count)};
    const double first_step_s = first_s / static_cast<double>(steps), step_s = sample_s / static_cast<double>(steps);
    const half_turn first_turn = half_turn_in(first_step_s), turn = half_turn_in(step_s);
    for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, first_turn, stretch, first_step_s);
    for (std::size_t i = 0; i < count; ++i) {
      const double sum = q.square().sum();
      scratch = weight_ * (stiff_ + stretch * sum) * q;
      out.force[0][i] = scratch.sum() / force_, out.force[1][i] = (sign_ * scratch).sum() / force_, out.strain[i] = sum / 4;
      for (std::size_t k = 0; k < steps; ++k) step(q, p, scratch, turn, stretch, step_s);
    }
    return out;
  }

  /// Mean strain of the held string.
  [[nodiscard]] double held_strain() const { return (force_ * held_).square().sum() / 4; }

private:
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
    return {decay * (c + decay_1_s_ * s), decay * s, -decay * (decay_1_s_.square() + turn_rad_s_.square()) * s, decay * (c - decay_1_s_ * s)};
  }

  void step(Eigen::ArrayXd& q, Eigen::ArrayXd& p, Eigen::ArrayXd& scratch, const half_turn& turn, double stretch, double step_s) const {
    turn(q, p, scratch);
    p -= stretch * q.square().sum() * step_s * kick_ * q;
    turn(q, p, scratch);
  }

  double force_;
  Eigen::ArrayXd held_, kick_, stiff_, weight_, sign_, decay_1_s_, turn_rad_s_;  ///< mode by mode
};

/// What the tension of a plucked string is higher by in the mean over the first periods, relatively: half of e is there in the mean, as half
/// of the energy is.
[[nodiscard]] inline double mean_stretch(const ringing_string& string, double position, double force_over_tension, double stretch, double periods) {
  double sum = 0;
  for (int n = 1; n <= 200; ++n) {
    const double q = force_over_tension * 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) / (1 + string.inharmonicity * n * n);
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

/// Large motion stretches the string. Needs the tension in newtons. The string that rings in the mean is part of the scene; what is
/// taken out is by how much the stretched one differs from it.
inline pluck_effect tension_modulation_effect(const string_facts& f, const band& limits) {
  pluck_effect e{"tension-modulation", -1, false, {{"axial_stiffness_N", 0, 3e6, 20}}, {{0}}, -3, {}};
  constexpr double most_periods = 10;
  e.horizon_periods = most_periods;
  const double tension = f.impedance_Ns_m * 2 * f.length_m * f.fundamental_Hz, horizon_s = most_periods / f.fundamental_Hz;
  const auto raised = [=](const pluck_layout& layout, const Eigen::VectorXd& v, std::size_t t, double axial_N) {
    return mean_stretch(layout.string(v), v[layout.position(t)], std::exp(v[layout.at(t, pluck_layout::strength)]) / tension, axial_N / (4 * tension), 0.6 * most_periods);
  };
  e.retune = [=](pluck_scene& s, const pluck_layout& layout, const Eigen::VectorXd& v, std::size_t t, double axial_N) {
    s.string = tightened(s.string, raised(layout, v, t, axial_N));
  };
  e.undo = [=](std::vector<pluck_take>& takes, const pluck_scene&, const pluck_layout& layout, const Eigen::VectorXd& v, double axial_N) {
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const double rate = takes[t].rate_Hz, released = v[layout.at(t, pluck_layout::release)] * rate, newtons = std::exp(v[layout.at(t, pluck_layout::strength)]);
      const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(released)));  // on the record's own samples: nothing is interpolated
      if (first >= takes[t].force_N[0].size()) continue;
      const std::size_t count = std::min(takes[t].force_N[0].size() - first, static_cast<std::size_t>(horizon_s * rate * 1.1) + 8);
      const band all{limits.stop_Hz, limits.stop_Hz};
      const ringing_string slack = layout.string(v), mean = tightened(slack, raised(layout, v, t, axial_N));
      const double wait_s = std::min(1.0, static_cast<double>(first) - released) / rate;
      const auto run = [&](const ringing_string& string, double stretch) {
        return stretching_pluck(string, v[layout.position(t)], newtons / tension, all, 400).run(stretch, wait_s, 1 / rate, 4, count);
      };
      const auto with = run(slack, axial_N / (4 * tension)), without = run(mean, 0);
      for (std::size_t c = 0; c < 2; ++c) {
        const double gain = newtons * std::exp(v[pluck_layout::gain_near + static_cast<int>(c)]);
        for (std::size_t i = 0; i < count; ++i) takes[t].force_N[c][first + i] -= gain * (with.force[c][i] - without.force[c][i]);
      }
    }
  };
  return e;
}

/// A channel that feels the tension, too: what it reads per unit of strain. The tension is the same all along the string: the partials
/// are below its longitudinal modes.
inline pluck_effect phantom_partials_effect(const string_facts& f, const band& limits, int channel) {
  const double tension = f.impedance_Ns_m * 2 * f.length_m * f.fundamental_Hz;
  pluck_effect e{"phantom-partials", channel, false, {{"sensed_axial_stiffness_N", -3e6, 3e6, 1e-3 * tension, false, -1, true}}, {{0}}, -3, {}};
  e.undo = [=](std::vector<pluck_take>& takes, const pluck_scene&, const pluck_layout& layout, const Eigen::VectorXd& v, double sensed_N) {
    const auto c = static_cast<std::size_t>(channel);
    const double gain = std::exp(v[pluck_layout::gain_near + channel]);
    for (std::size_t t = 0; t < takes.size(); ++t) {
      std::vector<double>& recorded = takes[t].force_N[c];
      const double rate = takes[t].rate_Hz, released = v[layout.at(t, pluck_layout::release)] * rate, newtons = std::exp(v[layout.at(t, pluck_layout::strength)]);
      const auto first = std::min(recorded.size(), static_cast<std::size_t>(std::max(0.0, std::ceil(released))));
      const stretching_pluck string(layout.string(v), v[layout.position(t)], newtons / tension, {limits.stop_Hz, limits.stop_Hz}, 120);
      const auto moves = string.run(0, std::min(1.0, static_cast<double>(first) - released) / rate, 1 / rate, 1, recorded.size() - first);
      for (std::size_t i = 0; i < first; ++i) recorded[i] -= gain * sensed_N * string.held_strain();
      for (std::size_t i = first; i < recorded.size(); ++i) recorded[i] -= gain * sensed_N * moves.strain[i - first];
    }
  };
  return e;
}

}  // namespace rosin
