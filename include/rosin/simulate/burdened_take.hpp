// tier: hosted
// SPDX-License-Identifier: MIT
//
// Takes of a burdened string: a pluck by a wire that lets go at once or gradually, and a stroke of a rod that may itself
// yield, touch the string over a width (contacts that share the force), and press or move unsteadily. Everything is
// stepped; what the sensors and the converter do to it is in burdened_sensors.hpp.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/simulate/burdened_string.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <array>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Forces on the ends and the truth at the contact at every step; instant of step n: n step_s.
struct burdened_steps {
  double step_s = 0;
  std::array<std::vector<double>, 2> end_N{};
  std::vector<double> force_N{}, centre_m_s{}, twist_m_s{}, rod_m_s{};
  double centre_left_out_m_N = 0, twist_left_out_m_N = 0;  ///< the velocities lack these times the rate of the force
  std::vector<double> temperature_K{};                     ///< rise, where the law has one
  std::vector<double> raised_N{};                          ///< what a pluck's motion adds to the tension, where E A is known
  std::size_t slips = 0, unconverged = 0;
  double slipping = 0;  ///< share of the second half's steps

  void reserve(std::size_t size) {
    for (auto* s : {&end_N[0], &end_N[1], &force_N, &centre_m_s, &twist_m_s, &rod_m_s, &temperature_K}) s->reserve(size);
  }
};

/// The wire's force on the string while it lets go: F(t) = F0 (1 + cos(pi t / d)) / 2 from the release on, or at once.
struct burdened_pluck {
  double position = 0.3, force_N = 1, release_s = 0.004, release_duration_s = 0;
  double width_m = 0;  ///< that the wire grips, evenly
};

/// Places (distance from the near end / length) and shares of a wire's force: three points have an even force's moments to the
/// fifth (Gauss and Legendre).
[[nodiscard]] inline std::vector<std::array<double, 2>> grip_of(const burdened_pluck& p, double length_m) {
  if (!(p.width_m > 0)) return {{p.position, 1}};
  const double apart = std::sqrt(0.6) * p.width_m / 2 / length_m;
  return {{p.position - apart, 5.0 / 18}, {p.position, 8.0 / 18}, {p.position + apart, 5.0 / 18}};
}

[[nodiscard]] inline double wire_force(const burdened_pluck& p, double t) noexcept {
  constexpr double pi = 3.14159265358979323846;
  if (t <= p.release_s) return p.force_N;
  const double into = t - p.release_s;
  return into < p.release_duration_s ? p.force_N * (1 + std::cos(pi * into / p.release_duration_s)) / 2 : 0;
}

/// The string where it may meet a stop, and the stop's answer: solved with the motion in every step.
class guarded_point {
public:
  guarded_point(const obstacle& stop, double rest_m) : stop_{stop}, side_{stop.gap_m < 0 ? -1.0 : 1.0}, y_{rest_m} {}

  /// On the string, for the velocity that it would have without and its response.
  [[nodiscard]] double force_N(double free_m_s, double mobility, double step_s) const {
    const double over = side_ * (y_ + step_s / 2 * (v_ + free_m_s) - stop_.gap_m);
    return over > 0 ? -side_ * stop_.stiffness_N_m * over / (1 + stop_.stiffness_N_m * mobility * step_s / 2) : 0;
  }
  void move(double v, double step_s) {
    y_ += step_s / 2 * (v_ + v);
    v_ = v;
  }

private:
  obstacle stop_;
  double side_, y_, v_ = 0;
};

/// A sudden release happens at the step nearest to it, and there at once: were it spread over a step, every pluck's spectrum
/// would fall towards high frequencies by another amount (a thousandth at 50 kHz and 0.5 us), as no two releases lie alike
/// between the steps. `across_N`: what motion in another plane adds to the tension, step by step (of the last one from there on);
/// needs E A.
template <class Real = double>
[[nodiscard]] burdened_steps step_pluck(const modal_rig& rig, const string_burden& burden, const burdened_pluck& pluck,
                                        double duration_s, double mode_limit_Hz, double step_s,
                                        std::span<const double> across_N = {}) {
  const auto grip = grip_of(pluck, rig.string.length_m);
  const bool guarded = burden.stop.stiffness_N_m > 0;
  const auto wires = static_cast<Eigen::Index>(grip.size()), contacts = wires + (guarded ? 1 : 0);
  std::vector<double> at;
  Eigen::VectorX<Real> share = Eigen::VectorX<Real>::Zero(contacts);
  for (const auto& [position, part] : grip) share[static_cast<Eigen::Index>(at.size())] = part, at.push_back(position);
  if (guarded) at.push_back(burden.stop.position);
  burdened_string string{rig, burden, at, mode_limit_Hz, step_s};
  if (!across_N.empty()) string.add_tension(across_N.front());
  string.rest_under(share * pluck.force_N);
  const double low = std::min(pluck.position, burden.stop.position), high = std::max(pluck.position, burden.stop.position);
  guarded_point point(burden.stop, pluck.force_N * low * (1 - high) * rig.string.length_m / rig.string.tension_N);
  burdened_steps out{.step_s = step_s, .centre_left_out_m_N = share.dot(string.centre_left_out_m_N().cwiseProduct(share))};
  const auto steps = static_cast<std::size_t>(duration_s / step_s);
  out.reserve(steps);
  const bool sudden = !(pluck.release_duration_s > 0);
  const auto release = static_cast<std::size_t>(std::lround(std::max(0.0, pluck.release_s / step_s)));
  for (std::size_t n = 0; n < steps; ++n) {
    double force = sudden ? (n <= release ? pluck.force_N : 0) : wire_force(pluck, static_cast<double>(n) * step_s);
    if (!across_N.empty()) string.add_tension(across_N[std::min(n, across_N.size() - 1)]);
    const Eigen::VectorX<Real> free = string.free_velocity();
    Eigen::VectorX<Real> forces = share * force;
    if (guarded)
      forces[wires] =
          point.force_N(free[wires] + string.mobility().row(wires).dot(share) * force, string.mobility()(wires, wires), step_s);
    auto now = string.advance(forces);
    if (guarded) point.move(now.surface_m_s[wires], step_s);
    if (sudden && n == release) now.end_N -= 0.5 * string.let_go(share * force), force /= 2;  // the middle of a jump
    for (std::size_t e = 0; e < 2; ++e) out.end_N[e].push_back(now.end_N[static_cast<Eigen::Index>(e)]);
    out.force_N.push_back(force);
    out.centre_m_s.push_back(share.dot(now.surface_m_s - now.twist_m_s));
    if (burden.axial_stiffness_N > 0) out.raised_N.push_back(string.raised_N());
  }
  return out;
}
ROSIN_INSTANTIATE(burdened_steps step_pluck(const modal_rig&, const string_burden&, const burdened_pluck&, double, double, double,
                                            std::span<const double>))

/// A pluck that moves a string in two planes, which differ in pitch: what each of them does by itself. Where motion stretches the
/// string, each also feels what the other's adds to the tension; the first is stepped once more with what the second then does.
template <class = void>
[[nodiscard]] std::array<burdened_steps, 2> step_planes(const modal_rig& along, const burdened_pluck& wire,
                                                        const modal_rig& across, const burdened_pluck& other,
                                                        const string_burden& burden, double duration_s, double mode_limit_Hz,
                                                        double step_s) {
  std::array<burdened_steps, 2> out{step_pluck(along, burden, wire, duration_s, mode_limit_Hz, step_s), {}};
  out[1] = step_pluck(across, burden, other, duration_s, mode_limit_Hz, step_s, out[0].raised_N);
  if (burden.axial_stiffness_N > 0) out[0] = step_pluck(along, burden, wire, duration_s, mode_limit_Hz, step_s, out[1].raised_N);
  return out;
}
ROSIN_INSTANTIATE(std::array<burdened_steps, 2> step_planes(const modal_rig&, const burdened_pluck&, const modal_rig&,
                                                            const burdened_pluck&, const string_burden&, double, double, double))

/// The rod's or bow's own give: a mass on a spring along its motion. None where the mass is 0.
using yielding_rod = yielding_support;

/// A stroke: `width_m` 0 is one contact, otherwise as many as `places` (two or more), evenly over width_m, that share the normal
/// force. Nothing happens for `still` steps, from which on the motion's time counts.
template <FrictionLaw Law, class Motion>
[[nodiscard]] burdened_steps step_stroke(const modal_rig& rig, const string_burden& burden, Law law, const Motion& motion,
                                         const yielding_rod& rod, double position, double width_m, double duration_s,
                                         double mode_limit_Hz, double step_s, std::size_t still = 0, int places = 2) {
  std::vector<double> at{position};
  if (width_m > 0) at.resize(static_cast<std::size_t>(places));
  for (std::size_t i = 0; i < at.size() && width_m > 0; ++i)
    at[i] = position + (static_cast<double>(i) / (places - 1) - 0.5) * width_m / rig.string.length_m;
  const auto contacts = static_cast<Eigen::Index>(at.size());
  burdened_string string{rig, burden, at, mode_limit_Hz, step_s};
  driven_mode gives;
  if (rod.mass_kg > 0)
    gives = driven_mode({1, 2 * 3.14159265358979323846 * rod.frequency_Hz, 1 / rod.quality, rod.mass_kg, 0}, step_s);
  law.reset();
  std::vector<Law> laws(at.size(), law);
  burdened_steps out{.step_s = step_s,  // the contacts share the force alike
                     .centre_left_out_m_N = string.centre_left_out_m_N().mean() / static_cast<double>(contacts),
                     .twist_left_out_m_N = string.twist_left_out_m_N().mean() / static_cast<double>(contacts)};
  const auto steps = static_cast<std::size_t>(duration_s / step_s);
  out.reserve(steps);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(contacts);
  std::size_t slipped = 0;
  const std::size_t end = detail::pressed_steps(motion, still, steps, step_s);
  bool before = false;
  for (auto* signal :
       {&out.end_N[0], &out.end_N[1], &out.force_N, &out.centre_m_s, &out.twist_m_s, &out.rod_m_s, &out.temperature_K})
    signal->assign(still, 0.0);
  for (std::size_t n = still; n < steps; ++n) {
    const auto state = motion(static_cast<double>(n - still) * step_s);
    const Eigen::VectorXd free = string.free_velocity();
    const auto& mobility = string.mobility();
    const auto solve = [&](Law& l, Eigen::Index i) {  // the others' forces as they stand
      double v = free[i] + gives.free();
      for (Eigen::Index j = 0; j < contacts; ++j)
        if (j != i) v += (mobility(i, j) + gives.mobility()) * force[j];
      return l(load_line<double>{v, mobility(i, i) + gives.mobility(), state.velocity_m_s,
                                 state.normal_force_N / static_cast<double>(contacts), step_s});
    };
    bool slipping = false, solved = true;
    double warmest = 0;
    if (contacts > 1)
      for (int round = 0; round < 20 * contacts; ++round) {
        const Eigen::VectorXd old = force;
        for (Eigen::Index i = 0; i < contacts; ++i) {
          Law trial = laws[static_cast<std::size_t>(i)];
          force[i] = solve(trial, i).force_N;
        }
        if ((force - old).cwiseAbs().maxCoeff() < 1e-12) break;
      }
    for (Eigen::Index i = 0; i < contacts; ++i) {
      const auto answer = solve(laws[static_cast<std::size_t>(i)], i);
      force[i] = answer.force_N, slipping = slipping || answer.slipping;
      warmest = std::max(warmest, answer.temperature_rise_K), solved = solved && answer.converged;
    }
    out.temperature_K.push_back(warmest);
    out.unconverged += solved ? 0 : 1;
    const auto now = string.advance(force);
    const double yielded = gives.advance(force.sum()).velocity;
    for (std::size_t e = 0; e < 2; ++e) out.end_N[e].push_back(now.end_N[static_cast<Eigen::Index>(e)]);
    out.force_N.push_back(force.sum());
    out.centre_m_s.push_back((now.surface_m_s - now.twist_m_s).mean());
    out.twist_m_s.push_back(now.twist_m_s.mean());
    out.rod_m_s.push_back(state.velocity_m_s - yielded);
    out.slips += slipping && !before ? 1 : 0;
    before = slipping;
    slipped += slipping && n > end / 2 && n < end ? 1 : 0;
  }
  out.slipping = static_cast<double>(slipped) / static_cast<double>(end - end / 2);
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
