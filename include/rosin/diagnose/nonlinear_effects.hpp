// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects of plucks that are not linear, as what has to be taken out of a recording to make it so.
//
// A sensor with output = f + a f^2 is inverted, f = (sqrt(1 + 4 a y) - 1) / (2 a). A string that is stretched by its own motion,
//
//     q_n'' + (w_n / Q) q_n' + [w_n^2 + e(t) (c k_n)^2] q_n = 0,    e = EA / (2 L T) integral y'^2 dx = EA / (4 T) sum (k_n q_n)^2
//
// (Kirchhoff, Carrier; specification sheet 6.1, items 8 and 16), is simulated twice, with and without e, and the difference taken
// out: each mode turns exactly through half a step, is kicked by the tension, and turns on (Strang).
//
#pragma once

#include <rosin/diagnose/pluck_effect.hpp>

namespace rosin {

/// output = f + a f^2 in one channel.
inline pluck_effect sensor_nonlinearity_effect(const string_facts&, int channel) {
  pluck_effect e{"sensor-nonlinearity", channel, false, {{"quadratic_per_N", -0.6, 0.6, 1e-4, false, -1, true}}, {{0}}, -3, {}};
  e.undo = [channel](std::vector<pluck_take>& takes, const pluck_layout&, const Eigen::VectorXd& v, double a) {
    const auto c = static_cast<std::size_t>(channel);
    const double gain = std::exp(v[pluck_layout::gain_near + channel]);
    for (pluck_take& take : takes)
      for (double& x : take.force_N[c]) x = gain * (std::sqrt(std::max(0.0, 1 + 4 * a * x / gain)) - 1) / (2 * a);
  };
  return e;
}

/// Forces on both ends of a plucked string whose tension follows its length; the first value is that at the release.
class stretching_pluck {
public:
  /// stretch: EA / (4 T), dimensionless with k q in units of slope.
  stretching_pluck(const ringing_string& string, double position, double force_over_tension, const band& limits, int most, double step_s)
      : force_{force_over_tension} {
    for (int n = 1; n <= most && string.partial_Hz(n) < limits.stop_Hz; ++n) {
      const double f = string.partial_Hz(n), w = 2 * std::numbers::pi * f, half = string.loss.inverse_q(f) / 2;
      const double c_k = 2 * std::numbers::pi * string.fundamental_Hz * n, b = string.inharmonicity * n * n;
      mode m;
      // slope amplitude k q of the held string: 2 F sin(k x) / (L k (T + B k^2)) -> (2 / (n pi)) (F/T) sin / (1 + b)
      m.held = 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) / (1 + b);
      m.kick = c_k * c_k;
      m.stiff = 1 + b;
      m.weight = band_weight(limits, {-w * half, w}).real();
      m.sign = n % 2 ? 1.0 : -1.0;
      const double rate = w * half, turn = w * std::sqrt(1 - half * half), h = step_s / 2, decay = std::exp(-rate * h);
      const double s = std::sin(turn * h) / turn, co = std::cos(turn * h);
      m.qq = decay * (co + rate * s), m.qp = decay * s, m.pq = -decay * w * w * s, m.pp = decay * (co - rate * s);
      modes_.push_back(m);
    }
  }

  /// Force on {near, far} relative to the pluck's own force, every `every` steps, `count` values.
  [[nodiscard]] std::array<std::vector<double>, 2> run(double stretch, double step_s, std::size_t every, std::size_t count) const {
    std::vector<double> q(modes_.size()), p(modes_.size(), 0.0);
    double e = 0;
    for (int i = 0; i < 8; ++i) {  // the held string is stretched as well
      double sum = 0;
      for (std::size_t n = 0; n < q.size(); ++n) {
        q[n] = force_ * modes_[n].held * modes_[n].stiff / (modes_[n].stiff + e);
        sum += q[n] * q[n];
      }
      e = stretch * sum;
    }
    std::array<std::vector<double>, 2> out{std::vector<double>(count), std::vector<double>(count)};
    for (std::size_t i = 0; i < count; ++i) {
      double even = 0, odd = 0, sum = 0;
      for (std::size_t n = 0; n < q.size(); ++n) sum += q[n] * q[n];
      e = stretch * sum;
      for (std::size_t n = 0; n < q.size(); ++n) (modes_[n].sign > 0 ? odd : even) += modes_[n].weight * (modes_[n].stiff + e) * q[n];
      out[0][i] = (odd + even) / force_, out[1][i] = (odd - even) / force_;
      for (std::size_t k = 0; k < every; ++k) step(q, p, stretch, step_s);
    }
    return out;
  }

private:
  struct mode {
    double held, kick, stiff, weight, sign, qq, qp, pq, pp;
  };

  void step(std::vector<double>& q, std::vector<double>& p, double stretch, double step_s) const {
    double sum = 0;
    for (std::size_t n = 0; n < q.size(); ++n) {
      const mode& m = modes_[n];
      const double a = m.qq * q[n] + m.qp * p[n];
      p[n] = m.pq * q[n] + m.pp * p[n];
      q[n] = a;
      sum += a * a;
    }
    const double e = stretch * sum * step_s;
    for (std::size_t n = 0; n < q.size(); ++n) {
      const mode& m = modes_[n];
      p[n] -= e * m.kick * q[n];
      const double a = m.qq * q[n] + m.qp * p[n];
      p[n] = m.pq * q[n] + m.pp * p[n];
      q[n] = a;
    }
  }

  double force_;
  std::vector<mode> modes_;
};

/// Large motion stretches the string. Needs the tension in newtons.
inline pluck_effect tension_modulation_effect(const string_facts& f, const band& limits) {
  pluck_effect e{"tension-modulation", -1, false, {{"axial_stiffness_N", 0, 3e6, 20, false, -1, true}}, {{0}}, -3, {}};
  e.horizon_periods = 10;
  const double tension = f.impedance_Ns_m * 2 * f.length_m * f.fundamental_Hz, horizon_s = e.horizon_periods / f.fundamental_Hz;
  e.undo = [=](std::vector<pluck_take>& takes, const pluck_layout& layout, const Eigen::VectorXd& v, double axial_N) {
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const double rate = takes[t].rate_Hz, released = v[layout.at(t, pluck_layout::release)], newtons = std::exp(v[layout.at(t, pluck_layout::strength)]);
      constexpr std::size_t finer = 4;
      const double step_s = 1 / (rate * static_cast<double>(finer));
      const auto count = static_cast<std::size_t>(horizon_s * rate * 1.1) + 8;
      const stretching_pluck string(layout.string(v), v[layout.position(t)], newtons / tension, limits, 400, step_s);
      const auto with = string.run(axial_N / (4 * tension), step_s, finer, count), without = string.run(0, step_s, finer, count);
      for (std::size_t c = 0; c < 2; ++c) {
        std::vector<double>& x = takes[t].force_N[c];
        const double gain = newtons * std::exp(v[pluck_layout::gain_near + static_cast<int>(c)]);
        for (auto i = static_cast<std::size_t>(std::ceil(released * rate)); i < x.size(); ++i) {
          const double at = (static_cast<double>(i) - released * rate);
          const auto j = static_cast<std::size_t>(at);
          if (j + 3 > count) break;
          const double u = at - static_cast<double>(j);
          const auto change = [&](std::size_t k) { return with[c][k] - without[c][k]; };
          // Cubic between the values: the change is small and smooth.
          const double y0 = change(j > 0 ? j - 1 : j), y1 = change(j), y2 = change(j + 1), y3 = change(j + 2);
          x[i] -= gain * (y1 + 0.5 * u * (y2 - y0 + u * (2 * y0 - 5 * y1 + 4 * y2 - y3 + u * (3 * (y1 - y2) + y3 - y0))));
        }
      }
    }
  };
  return e;
}

}  // namespace rosin
