// tier: hosted
// SPDX-License-Identifier: MIT
//
// A pluck by a breaking wire, exactly: the string stands deflected by a force until it is let go, then every mode
// rings freely. With S(t) the (low-passed) share of the force that is gone and h = dS/dt,
//
//     F_near(t) = F0 [ (1 - beta)(1 - S(t)) + sum_n 2/(n pi) sin(n pi beta) Re{ zeta_n y_n(t) } ]
//     y_n' = p_n y_n + h(t),      zeta_n = 1 + i Re(p_n) / Im(p_n)    (times 1 + p_n / (w_n Q_n) for Kelvin-Voigt loss)
//
// and once h is over, y_n rings as exp(p_n t). F_far has the factor (-1)^(n+1) and beta for 1 - beta. The equation
// for y_n is integrated by four-point Gauss quadrature on a fine grid; there is no sampled step anywhere, hence
// neither aliasing nor an error of the release's time. Modes left out still follow the force quasi-statically.
//
#pragma once

#include <algorithm>

#include <rosin/core/outcome.hpp>
#include <rosin/simulate/modal_take.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The wire holds the string from the start and lets go at `release_s`: at once, or over `release_duration_s` as
/// F(t) = F0 (1 + cos(pi t / d)) / 2.
struct modal_pluck {
  double position = 0.3;  ///< distance from the near end / length
  double force_N = 1;
  double release_s = 0.004;
  double release_duration_s = 0;
  double duration_s = 0.14;
};

namespace detail {

/// h(t) of the release: the low-pass kernel about t = 0, smeared by the rate at which the wire lets go.
class release_rate {
public:
  release_rate(const modal_low_pass& filter, double duration_s) : filter_{filter}, duration_{duration_s} {}
  [[nodiscard]] double begin_s() const noexcept { return -filter_.half_width_s(); }
  [[nodiscard]] double end_s() const noexcept { return filter_.half_width_s() + duration_; }

  [[nodiscard]] double operator()(double t) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    if (!(duration_ > 0)) return filter_(t);
    const int panels = 4 + static_cast<int>(duration_ * filter_.stop_Hz() * 2);
    double sum = 0;
    for (int i = 0; i < panels; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const double u = (i + gauss4::node[j]) / panels;
        sum += gauss4::weight[j] * std::sin(pi * u) * filter_(t - u * duration_);
      }
    return sum * pi / 2 / panels;
  }

private:
  modal_low_pass filter_;
  double duration_;
};

/// One mode's part in all signals: Re{ weight y(t) }.
struct ringing_mode {
  std::complex<double> pole, near, far, velocity, y, turn;
  std::array<std::complex<double>, 4> from_node;  ///< Gauss weight times exp(p (step - node))
};

[[nodiscard]] inline std::vector<ringing_mode> ringing_modes(const modal_rig& rig, const modal_pluck& pluck,
                                                             const modal_settings& settings, double step_s) {
  constexpr std::complex<double> i{0, 1};
  std::vector<ringing_mode> ringing;
  for (const auto& mode : transverse_modes(rig, settings.mode_limit_Hz)) {
    const auto p = mode.pole();
    const double deflection = pluck.force_N * mode.shape(pluck.position) / (mode.mass_kg * mode.omega_rad_s * mode.omega_rad_s);
    const auto zeta = 1.0 + i * p.real() / p.imag();
    const bool in_stress = rig.damping == damping_convention::kelvin_voigt;
    const auto stress = in_stress ? 1.0 + p * mode.inverse_quality / mode.omega_rad_s : 1.0;
    const auto end = deflection * mode.end_stiffness_N_m * zeta * stress;
    ringing_mode r{p, end, mode.parity() * end, deflection * mode.shape(pluck.position) * zeta * p, 0, std::exp(p * step_s), {}};
    for (std::size_t j = 0; j < 4; ++j)
      r.from_node[j] = gauss4::weight[j] * step_s * std::exp(p * step_s * (1 - gauss4::node[j]));
    ringing.push_back(r);
  }
  return ringing;
}

/// One sample of the take: the wire's force (N) and its rate (N/s), and the ringing. `residual_m_N` is the compliance
/// of the modes left out.
struct wire_force {
  double value_N = 0, rate_N_s = 0;
};
inline void write_pluck_sample(modal_take& take, std::size_t n, double position, wire_force wire, double residual_m_N,
                               const std::vector<ringing_mode>& modes) {
  const auto part = [](std::complex<double> a, std::complex<double> b) { return a.real() * b.real() - a.imag() * b.imag(); };
  double near = wire.value_N * (1 - position), far = wire.value_N * position, velocity = residual_m_N * wire.rate_N_s;
  for (const auto& m : modes) {
    near += part(m.near, m.y);
    far += part(m.far, m.y);
    velocity += part(m.velocity, m.y);
  }
  take.force_near_N[n] = near;
  take.force_far_N[n] = far;
  take.centre_velocity_m_s[n] = velocity;
  take.contact_force_N[n] = wire.value_N;
}

/// Advances all modes by one step of which `rate` starts at `t`; returns what the step adds to S.
inline double advance_release(std::vector<ringing_mode>& modes, const release_rate& rate, double t, double step_s) {
  std::array<double, 4> h{};
  double gone = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    h[j] = rate(t + gauss4::node[j] * step_s);
    gone += gauss4::weight[j] * step_s * h[j];
  }
  for (auto& m : modes) {
    m.y *= m.turn;
    for (std::size_t j = 0; j < 4; ++j) m.y += h[j] * m.from_node[j];
  }
  return gone;
}

/// From here on the modes only ring: whole samples at a time, and none that the low-pass has taken out.
inline void ring_on(std::vector<ringing_mode>& modes, double stop_Hz, int steps_per_sample) {
  constexpr double pi = 3.14159265358979323846;
  std::erase_if(modes, [&](const ringing_mode& m) { return m.pole.imag() > 1.02 * 2 * pi * stop_Hz; });
  for (auto& m : modes) m.turn = std::pow(m.turn, steps_per_sample);
}

/// Sets all signals of a take to zero.
inline modal_take silent_take(double sample_rate_Hz, std::size_t size) {
  modal_take take{.sample_rate_Hz = sample_rate_Hz};
  for (auto* signal :
       {&take.force_near_N, &take.force_far_N, &take.contact_force_N, &take.centre_velocity_m_s, &take.torsion_velocity_m_s})
    signal->assign(size, 0.0);
  return take;
}

[[nodiscard]] inline modal_take run_pluck(const modal_rig& rig, const modal_pluck& pluck, const modal_settings& settings) {
  constexpr int steps = 8;
  const double fs = settings.sample_rate_Hz, step_s = 1 / (fs * steps);
  const release_rate rate{settings.low_pass(), pluck.release_duration_s};
  const double residual = residual_compliance_m_N(rig.string, pluck.position, settings.mode_limit_Hz);
  auto modes = ringing_modes(rig, pluck, settings, step_s);
  const long size = std::lround(pluck.duration_s * fs);
  auto take = silent_take(fs, static_cast<std::size_t>(size));
  double held = 1;
  bool over = false;
  for (long n = std::min(0L, std::lround(std::floor((pluck.release_s + rate.begin_s()) * fs))); n < size; ++n) {
    const double t = static_cast<double>(n) / fs - pluck.release_s;
    const wire_force wire{over ? 0 : pluck.force_N * held, over ? 0 : -pluck.force_N * rate(t)};
    if (n >= 0) write_pluck_sample(take, static_cast<std::size_t>(n), pluck.position, wire, residual, modes);
    if (!over && t > rate.end_s()) ring_on(modes, settings.low_pass().stop_Hz(), steps), over = true;
    if (over)
      for (auto& m : modes) m.y *= m.turn;
    else if (t + 1 / fs > rate.begin_s())
      for (int i = 0; i < steps; ++i) held -= advance_release(modes, rate, t + i * step_s, step_s);
  }
  return take;
}

}  // namespace detail

/// Simulates a pluck; fails where rig, pluck or settings make no sense.
[[nodiscard]] inline outcome<modal_take> simulate_pluck(const modal_rig& rig, const modal_pluck& pluck,
                                                        const modal_settings& settings = {}) {
  for (const auto& problem :
       {problem_with(rig, pluck.position), problem_with(settings), problem_with_duration(pluck.duration_s, settings)})
    if (!problem.empty()) return failure{problem};
  if (!(pluck.release_s > 0 && pluck.release_s < pluck.duration_s)) return failure{"pluck: the release must lie within the take"};
  if (!(pluck.release_duration_s >= 0 && pluck.release_duration_s <= 0.1))
    return failure{"pluck: the release must last for 0.1 s at most"};
  return detail::run_pluck(rig, pluck, settings);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
