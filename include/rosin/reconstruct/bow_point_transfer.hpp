// tier: hosted
// SPDX-License-Identifier: MIT
//
// From the forces on two rigid terminations to force and velocity at the contact between them, one frequency at a time.
// With gamma_j = tau_j (loss + i q(w)) the complex phase of the passage from the contact to end j, D_j = exp(-gamma_j), and
// F_j the force of the string on end j, positive the way the bow moves:
//
//     f_near = G (F_1 / D_1 + D_2 F_2),    f_far = G (F_2 / D_2 + D_1 F_1)                  Eqs. (3), (9)
//     v_j    = F_j (1 / D_j - D_j) / (2 Z_w)  -  i (k / kappa) f / (2 Z_f),  f = mean       Eqs. (1), (9)
//
// G = (1 + 2K)/(1 + K), Z_w = Z sqrt(1 + K), Z_f = G Z_w: what a constant impedance leaves out of a stiff string, and the near
// field under the contact (docs/explain/theory.md). Both are exact for the stiff string and checked against its modes in the
// tests. All that the string has to be known by: two travel times, its dispersion and loss in time, and the impedance.
//
// An end that moves with the velocity V_j = Y_j F_j sends waves out as well: with the relative admittance z_j = Z Y_j
//
//     1 / D_j -> (1 + alpha z_j) / D_j,   D_j -> (1 + beta z_j) D_j,   alpha, beta = +-sqrt(1+K) / G + i q rho K / (w G),
//
// rho = k / kappa. Nothing is inverted: z_j F_j = Z V_j is a causal, decaying function of the measured force, and goes in as a
// third and a fourth signal (moving_ends, in newtons), so that these kernels stay as short as they are. Exact for the stiff
// string (with stiffness and near field of the end); without moving ends nothing of it is compiled.
//
// Each refinement, and the kernel, is chosen at compile time, so that the paper's own processing is one of the choices:
// physics<false, false, false, airy_passage>.
//
#pragma once

#include <rosin/propagate/airy_kernel.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/propagate/transmission.hpp>

#include <array>
#include <complex>

namespace rosin {

/// How a kernel policy gives 1/D and D of a path.
template <class K>
concept PassageKernel = requires(const bow_point& at, const band& limits, double x) {
  { K(at, 0, limits, x).forward(x) } -> std::convertible_to<std::complex<double>>;
  { K(at, 0, limits, x).back(x) } -> std::convertible_to<std::complex<double>>;
};

/// The default: exact phase, loss kept and compensated.
class exact_passage {
public:
  exact_passage(const bow_point& at, int side, const band&, double)
      : out_{at.delay_s[static_cast<std::size_t>(side)], at.stiffness_s2, at.loss},
        back_{at.delay_s[static_cast<std::size_t>(side)], at.stiffness_s2, at.loss} {}
  [[nodiscard]] std::complex<double> forward(double f) const { return out_(f); }
  [[nodiscard]] std::complex<double> back(double f) const { return back_(f); }

private:
  transmission out_;
  inverse_transmission back_;
};

/// The paper's: Airy kernel, inverted by reversing time. The form is the printed one or the all-pass.
template <airy_form Form = airy_form::transmission>
class airy_passage {
public:
  /// The kernel is made for a band twice as wide, so that the caller's band is not applied twice.
  airy_passage(const bow_point& at, int side, const band& limits, double rate_Hz)
      : rate_Hz_{4 * rate_Hz}, kernel_{airy_kernel(at.delay_s[static_cast<std::size_t>(side)], at.stiffness_s2,
                                                   {1.05 * limits.stop_Hz, 1.9 * limits.stop_Hz}, 4 * rate_Hz, Form, 16)} {}
  [[nodiscard]] std::complex<double> forward(double f) const { return kernel_.response(f, rate_Hz_); }
  [[nodiscard]] std::complex<double> back(double f) const { return std::conj(forward(f)); }

private:
  double rate_Hz_;
  fir kernel_;
};

/// What the reconstruction takes into account.
template <bool ForceFactor = true, bool NearField = true, bool Loss = true, PassageKernel Kernel = exact_passage,
          bool MovingEnds = false>
struct physics {
  static constexpr bool force_factor = ForceFactor, near_field = NearField, loss = Loss, moving_ends = MovingEnds;
  using kernel = Kernel;
};

/// The same with terminations that move.
template <class P>
using with_moving_ends = physics<P::force_factor, P::near_field, P::loss, typename P::kernel, true>;

using full_physics = physics<>;
using paper_physics = physics<false, false, false, airy_passage<airy_form::transmission>>;

/// Transfer functions from {F_near, F_far} and, where the ends move, {Z V_near, Z V_far} to {f_near, f_far, v_near, v_far};
/// row-major.
template <class Physics>
class bow_point_transfer {
public:
  static constexpr std::size_t outputs = 4, inputs = Physics::moving_ends ? 4 : 2;

  bow_point_transfer(const bow_point& at, const band& limits, double rate_Hz)
      : at_{Physics::loss ? at : lossless(at)}, side_{typename Physics::kernel(at_, 0, limits, rate_Hz),
                                                      typename Physics::kernel(at_, 1, limits, rate_Hz)} {}

  [[nodiscard]] std::array<std::complex<double>, outputs * inputs> operator()(double f_Hz) const {
    using complex = std::complex<double>;
    const double w = 2 * std::numbers::pi * f_Hz, epsilon = at_.stiffness_s2;
    const double G = Physics::force_factor ? force_factor(w, epsilon) : 1.0;
    const double Zw = at_.impedance_Ns_m * (Physics::force_factor ? wave_impedance_ratio(w, epsilon) : 1.0);
    const complex back1 = side_[0].back(f_Hz), out1 = side_[0].forward(f_Hz), back2 = side_[1].back(f_Hz),
                  out2 = side_[1].forward(f_Hz);
    const complex near_field =
        Physics::near_field ? complex(0, -near_field_ratio(w, epsilon) / (2 * Zw * force_factor(w, epsilon))) : complex(0);
    const complex nf1 = near_field * G * (back1 + out1) / 2.0, nf2 = near_field * G * (back2 + out2) / 2.0;
    const complex v1 = (back1 - out1) / (2 * Zw), v2 = (back2 - out2) / (2 * Zw);
    if constexpr (!Physics::moving_ends) {
      return {G * back1, G * out2, G * out1, G * back2, v1 + nf1, nf2, nf1, v2 + nf2};
    } else {
      const auto [a, b] = moved(w, G);
      const complex nw1 = near_field * G * (a * back1 + b * out1) / 2.0, nw2 = near_field * G * (a * back2 + b * out2) / 2.0;
      const complex w1 = (a * back1 - b * out1) / (2 * Zw), w2 = (a * back2 - b * out2) / (2 * Zw);
      return {G * back1, G * out2, G * a * back1, G * b * out2, G * out1, G * back2, G * b * out1, G * a * back2,
              v1 + nf1,  nf2,      w1 + nw1,      nw2,          nf1,      v2 + nf2,  nw1,          w2 + nw2};
    }
  }

private:
  /// alpha and beta of the header.
  [[nodiscard]] std::array<std::complex<double>, 2> moved(double w, double G) const {
    const double ratio = Physics::force_factor ? wave_impedance_ratio(w, at_.stiffness_s2) / G : 1.0;
    if (!Physics::force_factor || w == 0) return {ratio, -ratio};
    const double K = stiffness_ratio(w, at_.stiffness_s2);
    const std::complex<double> bent(0, phase_rate(w, at_.stiffness_s2) * near_field_ratio(w, at_.stiffness_s2) * K / (w * G));
    return {ratio + bent, -ratio + bent};
  }
  static bow_point lossless(bow_point at) {
    at.loss = {};
    return at;
  }
  bow_point at_;
  std::array<typename Physics::kernel, 2> side_;
};

}  // namespace rosin
