// tier: hosted
// SPDX-License-Identifier: MIT
//
// Force and velocity at the contact with the least variance that two noisy ends allow, one frequency at a time. The difference of the
// two versions of the force holds noise only, never the friction,
//
//     e = f_near - f_far = 2 G (F_1 sinh(g_1) - F_2 sinh(g_2)),    g_j = x_j gamma(w),
//
// so what it foretells of the noise of their mean f_0 can be taken out: f = f_0 - H e, H = E[f_0 e*] / E|e|^2. With white noise of
// variance s_j^2 in the forces
//
//     H = (s_1^2 cosh(g_1) sinh(g_1)* - s_2^2 cosh(g_2) sinh(g_2)*) / (2 (s_1^2 |sinh(g_1)|^2 + s_2^2 |sinh(g_2)|^2) + d^2 (s_1^2 + s_2^2)),
//
// and the same for the velocity, whose two versions differ by e / (2 G Z_w). d bounds H where both sinh vanish and what calibration and
// model leave decides instead of noise. At d = 0 it is a regression of what arrives at the ends on what the force makes there,
//
//     f = G sinh(gamma L) (s_2^2 sinh(g_2)* F_1 + s_1^2 sinh(g_1)* F_2) / (s_1^2 |sinh(g_1)|^2 + s_2^2 |sinh(g_2)|^2).
//
// So each end counts where it hears the contact: near a node of the one, the other decides.
//
#pragma once

#include <rosin/propagate/bow_point.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// How much of a force on either end is in the force and the velocity at the contact.
struct end_weights {
  std::array<std::complex<double>, 2> force{}, velocity{};  ///< of near and far

  /// Variance for noise of variance s_j^2 in the two forces.
  [[nodiscard]] double force_variance(const std::array<double, 2>& noise_N) const noexcept {
    return noise_N[0] * noise_N[0] * std::norm(force[0]) + noise_N[1] * noise_N[1] * std::norm(force[1]);
  }
  [[nodiscard]] double velocity_variance(const std::array<double, 2>& noise_N) const noexcept {
    return noise_N[0] * noise_N[0] * std::norm(velocity[0]) + noise_N[1] * noise_N[1] * std::norm(velocity[1]);
  }
};

/// Both versions, their mean, and the combination with the least variance.
struct weights_of_ends {
  end_weights near, far, mean, combined;
  std::array<std::complex<double>, 2> mismatch{};                          ///< e / (2 G): sinh(g_1), -sinh(g_2)
  std::complex<double> force_per_mismatch = 0, velocity_per_mismatch = 0;  ///< combined - mean, for one of that
};

/// What they are made for: noise of the forces (N), and d.
struct end_noise {
  std::array<double, 2> sensor_N{1, 1};
  double floor = 0.03;  ///< d^2 = 1e-3
  double model = 0;     ///< what the model leaves of F_j sinh(g_j), relative: counts as noise that no weighing can foretell
};

/// At a frequency in Hz. `rate`: gamma c there; `at`: travel times, stiffness, impedance; `signal_N2`: power of the forces there, in
/// units of the power that noise of variance 1 has.
[[nodiscard]] inline weights_of_ends weigh_ends(std::complex<double> rate, double frequency_Hz, const bow_point& at,
                                                const end_noise& noise, const std::array<double, 2>& signal_N2 = {}) noexcept {
  using complex = std::complex<double>;
  const double w = 2 * std::numbers::pi * frequency_Hz, epsilon = at.stiffness_s2, G = force_factor(w, epsilon);
  const double Zw = at.impedance_Ns_m * wave_impedance_ratio(w, epsilon);
  const complex near_field(0, -near_field_ratio(w, epsilon) / (2 * Zw * G));
  std::array<complex, 2> out, back, s, c;
  std::array<double, 2> variance{};
  for (std::size_t j = 0; j < 2; ++j) {
    out[j] = std::exp(-at.delay_s[j] * rate), back[j] = 1.0 / out[j];
    s[j] = 0.5 * (back[j] - out[j]), c[j] = 0.5 * (back[j] + out[j]);
    variance[j] = noise.sensor_N[j] * noise.sensor_N[j];
  }
  const double unsure = noise.model * noise.model;
  const double of_e = 2 * (variance[0] + unsure * signal_N2[0]) * std::norm(s[0]) +
                      2 * (variance[1] + unsure * signal_N2[1]) * std::norm(s[1]) +
                      noise.floor * noise.floor * (variance[0] + variance[1]);
  const complex H = (variance[0] * c[0] * std::conj(s[0]) - variance[1] * c[1] * std::conj(s[1])) / of_e;
  const double K = (variance[0] * std::norm(s[0]) - variance[1] * std::norm(s[1])) / of_e;  // of velocity, times Z_w
  weights_of_ends all;
  all.near.force = {G * back[0], G * out[1]}, all.far.force = {G * out[0], G * back[1]};
  all.mean.force = {G * c[0], G * c[1]};
  all.combined.force = {G * (c[0] - 2.0 * H * s[0]), G * (c[1] + 2.0 * H * s[1])};
  const auto velocity = [&](end_weights& x, complex one, complex two) {
    x.velocity = {one / Zw + near_field * x.force[0], two / Zw + near_field * x.force[1]};
  };
  velocity(all.mean, 0.5 * s[0], 0.5 * s[1]);
  velocity(all.combined, (0.5 - K) * s[0], (0.5 + K) * s[1]);
  all.mismatch = {s[0], -s[1]};
  all.force_per_mismatch = -2.0 * G * H, all.velocity_per_mismatch = -K / Zw + near_field * all.force_per_mismatch;
  for (end_weights* version : {&all.near, &all.far}) {  // the near field is of the mean, as ever
    const bool is_near = version == &all.near;
    version->velocity = {(is_near ? s[0] : complex(0)) / Zw + near_field * all.mean.force[0],
                         (is_near ? complex(0) : s[1]) / Zw + near_field * all.mean.force[1]};
  }
  return all;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
