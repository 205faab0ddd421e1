// tier: hosted
// SPDX-License-Identifier: MIT
//
// An end of the string that gives way: masses on springs that all feel the end's force, and whose motions add up,
//
//     u = sum u_k,     M_k (u_k'' + (w_k / Q_k) u_k' + w_k^2 u_k) = F.
//
// Over a step h the accelerations -g_k run straight (Newmark's beta = 1/6). Each mode then obeys
//
//     D_k g_k = r_k - F,     D_k = M + c h/2 + K h^2/6,     r_k = c (u_0' - h g_0/2) + K (u_0 + h u_0' - h^2 g_0/3),
//
// and their sum, which is all that the string has to know,  D g + F = r  with 1/D = sum 1/D_k and r = D sum r_k / D_k.
//
#pragma once

#include <array>
#include <vector>

namespace rosin {

/// A support under an end of the string; none where the mass is 0.
struct yielding_support {
  double mass_kg = 0, frequency_Hz = 0, quality = 1;
};

/// One mode of it in motion.
struct moving_mode {
  yielding_support support;
  double u = 0, v = 0, g = 0;  ///< displacement, velocity, minus acceleration

  [[nodiscard]] double omega() const noexcept { return 2 * 3.14159265358979323846 * support.frequency_Hz; }
  [[nodiscard]] double stiffness() const noexcept { return support.mass_kg * omega() * omega(); }
  [[nodiscard]] double damping() const noexcept { return support.mass_kg * omega() / support.quality; }
  /// Displacement at the end of the step but for what this step's own g takes: h^2 g / 6.
  [[nodiscard]] double ahead(double h) const noexcept { return u + h * v - h * h * g / 3; }
  [[nodiscard]] double inertia(double h) const noexcept { return support.mass_kg + damping() * h / 2 + stiffness() * h * h / 6; }
  [[nodiscard]] double holds(double h) const noexcept { return damping() * (v - h * g / 2) + stiffness() * ahead(h); }
};

struct moving_support {
  int side = 0;  ///< 0 near, 1 far
  std::vector<moving_mode> modes{};

  [[nodiscard]] double sum(double moving_mode::*what) const noexcept {
    double all = 0;
    for (const auto& m : modes) all += m.*what;
    return all;
  }
  [[nodiscard]] double ahead(double h) const noexcept {
    double all = 0;
    for (const auto& m : modes) all += m.ahead(h);
    return all;
  }
  /// D and r.
  [[nodiscard]] std::array<double, 2> inertia_and_force(double h) const noexcept {
    double yields = 0, driven = 0;
    for (const auto& m : modes) yields += 1 / m.inertia(h), driven += m.holds(h) / m.inertia(h);
    return {1 / yields, driven / yields};
  }
  /// Static, N/m.
  [[nodiscard]] double stiffness() const noexcept {
    double gives = 0;
    for (const auto& m : modes) gives += 1 / m.stiffness();
    return 1 / gives;
  }
  void rest_at(double displacement_m) noexcept {
    const double force = stiffness() * displacement_m;
    for (auto& m : modes) m.u = force / m.stiffness(), m.v = m.g = 0;
  }
  /// Ends the step with this force on the end.
  void move(double h, double force_N) noexcept {
    for (auto& m : modes) {
      const double g = (m.holds(h) - force_N) / m.inertia(h);
      m.u += h * m.v - h * h * (m.g / 3 + g / 6);
      m.v -= h * (m.g + g) / 2;
      m.g = g;
    }
  }
};

}  // namespace rosin
