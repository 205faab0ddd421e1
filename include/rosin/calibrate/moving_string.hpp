// tier: hosted
// SPDX-License-Identifier: MIT
//
// How the forces on the ends of a stiff string answer a force at the contact when the ends give way: with the complex phases
// theta_j = tau_j gamma(s) of the two passages, D_j = exp(-theta_j), and the relative admittances z_j (termination.hpp),
//
//     A_1 = (a_2 D_1 - b_2 D_1 D_2^2) / N,    A_2 = (a_1 D_2 - b_1 D_2 D_1^2) / N,    N = G (a_1 a_2 - b_1 b_2 D_1^2 D_2^2)
//     a_j = 1 + alpha z_j,  b_j = 1 + beta z_j   (alpha, beta, G: reconstruct/bow_point_transfer.hpp, of which this is the inverse)
//
// at any complex frequency s = sigma + i w; near fields of contact and ends are not coupled (they reach over a millimetre). The
// derivatives by theta_j and z_j come along: all that a fit needs.
//
#pragma once

#include <rosin/propagate/complex_dispersion.hpp>
#include <rosin/propagate/dispersion.hpp>
#include <rosin/propagate/string_parameters.hpp>

#include <array>
#include <complex>
#include <numbers>

namespace rosin {

/// Stiffness and loss of a string at one complex frequency.
struct passage_at {
  std::complex<double> gamma_per_s;                      ///< c times the propagation constant
  std::complex<double> force_factor = 1, a = 1, b = -1;  ///< G, alpha, beta

  passage_at(std::complex<double> s, double stiffness_s2, const loss_law& loss) {
    const std::complex<double> w(s.imag(), -s.real()), q = phase_rate(w, stiffness_s2), K = stiffness_s2 * q * q;
    const double f = std::abs(s.imag()) / (2 * std::numbers::pi), real_w = 2 * std::numbers::pi * f;
    gamma_per_s =
        std::complex<double>(0, 1) * q +
        slowness_ratio(real_w, stiffness_s2) * std::complex<double>(real_w * loss.inverse_q(f) / 2, s.imag() * loss.lead(f));
    const std::complex<double> softer = plain::reciprocal(1.0 + K);
    force_factor = (1.0 + 2.0 * K) * softer;
    const std::complex<double> ratio = plain::sqrt(1.0 + K) * plain::reciprocal(force_factor);
    const std::complex<double> bent =
        std::complex<double>(0, 1) * q * plain::sqrt(K * softer) * K * plain::reciprocal(w * force_factor);
    a = ratio + bent, b = -ratio + bent;
  }
};

/// A_1 and A_2 with their derivatives: [end][by].
struct moving_response {
  std::array<std::complex<double>, 2> force;
  std::array<std::array<std::complex<double>, 2>, 2> by_phase, by_admittance;
};

/// `theta`: complex phases of the two passages; `z`: relative admittances of the ends.
[[nodiscard]] inline moving_response moving_string(const passage_at& p, const std::array<std::complex<double>, 2>& theta,
                                                   const std::array<std::complex<double>, 2>& z) {
  using complex = std::complex<double>;
  const std::array<complex, 2> D{std::exp(-theta[0]), std::exp(-theta[1])}, a{1.0 + p.a * z[0], 1.0 + p.a * z[1]},
      b{1.0 + p.b * z[0], 1.0 + p.b * z[1]};
  const complex round = D[0] * D[0] * D[1] * D[1], G = p.force_factor,
                per = plain::reciprocal(G * (a[0] * a[1] - b[0] * b[1] * round));
  moving_response r;
  for (std::size_t j = 0; j < 2; ++j) {
    const std::size_t o = 1 - j;
    const complex back = b[o] * D[j] * D[o] * D[o];
    r.force[j] = (a[o] * D[j] - back) * per;
    const complex lost = 2.0 * G * b[0] * b[1] * round * per * r.force[j];
    r.by_phase[j][j] = -r.force[j] - lost;
    r.by_phase[j][o] = 2.0 * back * per - lost;
    r.by_admittance[j][j] = -r.force[j] * per * G * (p.a * a[o] - p.b * b[o] * round);
    r.by_admittance[j][o] =
        (p.a * D[j] - p.b * D[j] * D[o] * D[o]) * per - r.force[j] * per * G * (p.a * a[j] - p.b * b[j] * round);
  }
  return r;
}

}  // namespace rosin
