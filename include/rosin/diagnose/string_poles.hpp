// tier: hosted
// SPDX-License-Identifier: MIT
//
// Poles of a string with scatterers and yielding ends, and the residues of its free decay from a static deflection:
//
//     F_j(t) = -F sum_p  Res_p[ H_j(s) / s ] exp(s_p t)   for t > 0,    H_j = N_j / D  (string_response.hpp)
//
// Aberth's simultaneous Newton iteration: every root repels its neighbours, so that no two can fall onto one pole where a
// support's resonance crosses a partial. Strength is raised from nothing in steps, each root following from the last.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/string_response.hpp>

#include <algorithm>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The polynomials of the ends' modes that lie within `reach` of a place: zero where a weak mode all but has its pole.
inline std::complex<double> mode_zeros(const pluck_scene& scene, std::complex<double> s, std::complex<double> around,
                                       double reach) {
  std::complex<double> value = 1;
  for (const yielding_end& end : scene.ends)
    for (const admittance_mode& m : end.modes) {
      const double w = 2 * std::numbers::pi * m.frequency_Hz;
      if (std::abs((m.q < 0.5 ? m.pole().imag() : w) - around.imag()) < reach)
        value *= (s * s + s * (w / m.q) + w * w) * (1 / (w * w));
    }
  return value;
}

/// D(s), times the polynomials of the ends' modes: entire around the roots that are sought.
template <class = void>
std::complex<double> characteristic(const pluck_scene& scene, std::complex<double> s, double strength) {
  return loop_determinant(scene, s, strength) * mode_zeros(scene, s, s, 1e300);
}

/// One Aberth sweep over the roots that are not settled yet; returns the largest correction relative to the spacing.
template <class = void>
double sweep(const pluck_scene& scene, std::vector<std::complex<double>>& roots, std::vector<bool>& settled, double strength,
             double spacing) {
  constexpr std::size_t neighbours = 3;
  double largest = 0;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (settled[i]) continue;
    const std::complex<double> s = roots[i], h(0, 1e-4 * spacing);
    const std::complex<double> above = characteristic(scene, s + h, strength), below = characteristic(scene, s - h, strength);
    const std::complex<double> newton = (above + below) * h * plain::reciprocal(above - below);  // value over slope
    std::complex<double> repulsion = 0;
    double nearest = spacing * spacing;
    for (std::size_t j = i > neighbours ? i - neighbours : 0; j < std::min(roots.size(), i + neighbours + 1); ++j)
      if (const double apart = std::norm(roots[i] - roots[j]); j != i && apart > 1e-18 * spacing * spacing)
        repulsion += plain::reciprocal(roots[i] - roots[j]), nearest = std::min(nearest, apart);
    // The roots that are not sought stand in a regular comb; only what a neighbour adds beyond it must repel.
    std::complex<double> step = newton * plain::reciprocal(1.0 - newton * repulsion);
    if (std::norm(newton) < std::min(4e-4 * spacing * spacing, 0.1 * nearest) || !std::isfinite(std::norm(step))) step = newton;
    const double length = plain::abs(step) / spacing;
    roots[i] -= length > 0.3 ? step * (0.3 / length) : step;
    settled[i] = length < 1e-5;  // the next correction would be of the order of its square
    largest = std::max(largest, length);
  }
  return largest;
}

/// Sweeps until all roots are settled; false where they are not after that many.
template <class = void>
bool settle(const pluck_scene& scene, std::vector<std::complex<double>>& roots, double strength, double spacing, int most) {
  std::vector<bool> settled(roots.size(), false);
  for (int i = 0; i < most; ++i)
    if (const double moved = sweep(scene, roots, settled, strength, spacing); !(moved >= 1e-5)) return std::isfinite(moved);
  return false;
}

/// No root has wandered to another's place.
inline bool stayed(const std::vector<std::complex<double>>& roots, const std::vector<std::complex<double>>& begin,
                   double spacing) {
  for (std::size_t i = 0; i < roots.size(); ++i) {
    if (!(std::norm(roots[i] - begin[i]) < 0.04 * spacing * spacing)) return false;
    for (std::size_t j = i + 1; j < std::min(roots.size(), i + 3); ++j)
      if (std::norm(roots[i] - roots[j]) < 1e-8 * spacing * spacing) return false;
  }
  return true;
}

/// What an overdamped end relaxes with is real; what loss as a constant Q makes of it is not.
inline std::vector<std::complex<double>> with_real_poles(std::vector<std::complex<double>> poles) {
  for (auto& s : poles)
    if (std::abs(s.imag()) < 0.1 * std::abs(s.real())) s = s.real();
  return poles;
}

/// The n-th partial of a string whose ends resist turning, but for what else is in the scene: q L = n pi + the phases that the
/// ends are ahead by.
inline double partial_between_clamps_Hz(const pluck_scene& scene, int n) {
  if (scene.ends[0].clamping == 0 && scene.ends[1].clamping == 0) return scene.string.partial_Hz(n);
  const double epsilon = std::max(scene.string.stiffness_s2(), 1e-30), length = 0.5 / scene.string.fundamental_Hz;
  double q = n * std::numbers::pi / length;
  for (int i = 0; i < 30; ++i) {
    const double next = (n * std::numbers::pi + phase_ahead(q, epsilon, scene.ends[0].clamping) +
                         phase_ahead(q, epsilon, scene.ends[1].clamping)) /
                        length;
    if (std::abs(next - q) < 1e-12 * q) break;
    q = next;
  }
  return scene.string.dispersed(q * std::sqrt(1 + epsilon * q * q) / (2 * std::numbers::pi));
}

}  // namespace detail

/// Poles below `highest_Hz`, in order of frequency. `near`: poles of a scene much like this one, to begin from; may be empty.
template <class = void>
[[nodiscard]] std::vector<std::complex<double>> string_poles(const pluck_scene& scene, double highest_Hz, int most,
                                                             const std::vector<std::complex<double>>& near = {}) {
  const double spacing = 2 * std::numbers::pi * scene.string.fundamental_Hz;
  if (!near.empty()) {
    std::vector<std::complex<double>> roots = near;
    if (detail::settle(scene, roots, 1.0, spacing, 8) && detail::stayed(roots, near, spacing))
      return detail::with_real_poles(std::move(roots));
  }
  std::vector<std::complex<double>> roots;
  for (int n = 1; n <= most; ++n) {
    const double f = detail::partial_between_clamps_Hz(scene, n);
    if (f >= highest_Hz) break;
    roots.emplace_back(-std::numbers::pi * f * scene.string.loss.inverse_q(f), 2 * std::numbers::pi * f);
  }
  for (const yielding_end& end : scene.ends)
    for (const admittance_mode& m : end.modes) {
      const double w = 2 * std::numbers::pi * m.frequency_Hz;
      // the slower one; the string draws the end back as well
      if (m.q < 0.5) roots.push_back(m.pole() - 2 * scene.string.fundamental_Hz * m.per_mass_per_s * m.q / w);
      else roots.emplace_back(-w / (2 * m.q), w * std::sqrt(std::max(0.01, 1 - 0.25 / (m.q * m.q))));
    }
  std::sort(roots.begin(), roots.end(), [](auto a, auto b) { return a.imag() < b.imag(); });
  for (std::size_t i = 1; i < roots.size(); ++i)  // ends that are alike: where two begin at one place they would go on as one
    if (std::norm(roots[i] - roots[i - 1]) < 1e-6 * spacing * spacing)
      roots[i] += roots[i].imag() == 0 ? std::complex<double>(-2e-3 * spacing) : std::complex<double>(0, 2e-3 * spacing);
  const std::vector<std::complex<double>> begin = roots;
  std::vector<bool> none(roots.size(), false);
  if (detail::sweep(scene, roots, none, 1.0, spacing) < 0.01 && detail::settle(scene, roots, 1.0, spacing, 8))
    return detail::with_real_poles(std::move(roots));  // next to where it began
  roots = begin;
  for (double strength = 0.125; strength <= 1.0; strength += 0.125)
    detail::settle(scene, roots, strength, spacing, strength == 1.0 ? 12 : 4);
  return detail::with_real_poles(std::move(roots));
}
ROSIN_INSTANTIATE(std::vector<std::complex<double>> string_poles(const pluck_scene&, double, int,
                                                                 const std::vector<std::complex<double>>&))

/// Free decay of a pluck of 1 N at `position`, from its poles. Residues at the instant of release.
template <class = void>
[[nodiscard]] std::vector<damped_line> decay_lines(const pluck_scene& scene, double position,
                                                   const std::vector<std::complex<double>>& poles) {
  const double spacing = 2 * std::numbers::pi * scene.string.fundamental_Hz;
  std::vector<damped_line> lines;
  for (const std::complex<double> s : poles) {
    const std::complex<double> h(0, 1e-4 * spacing);
    const loop_response above = close_loop(scene, position, s + h), below = close_loop(scene, position, s - h);
    // the loop as such is straight only far from a mode
    const std::complex<double> up = detail::mode_zeros(scene, s + h, s, spacing),
                               down = detail::mode_zeros(scene, s - h, s, spacing);
    const std::complex<double> over = plain::reciprocal((above.determinant * up - below.determinant * down) * s) * (-2.0 * h);
    damped_line line{s, {}};
    for (std::size_t e = 0; e < 2; ++e) {
      line.residue[e] = over * (above.times_determinant[e] * up + below.times_determinant[e] * down);
      if (s.imag() == 0) line.residue[e] = 0.5 * line.residue[e].real();  // it has no twin
    }
    lines.push_back(line);
  }
  return lines;
}
ROSIN_INSTANTIATE(std::vector<damped_line> decay_lines(const pluck_scene&, double, const std::vector<std::complex<double>>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
