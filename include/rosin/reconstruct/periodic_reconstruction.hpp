// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frequency-domain reconstruction of periodic motion, Eqs. (10) of Woodhouse, Schumacher & Garoff (2000), with any reflection
// function R_j at either end. With D_j the passage to end j, F_j the force of the string on it and Z_w, Z_f, near field as in
// bow_point_transfer.hpp:
//
//     wave that left the contact    U_j = F_j / (Z_w (1 - R_j) D_j),     wave that comes back    R_j D_j^2 U_j
//     f_1 = 2 Z_f (U_1 - R_2 D_2^2 U_2),    f_2 = 2 Z_f (U_2 - R_1 D_1^2 U_1),    v_j = U_j (1 + R_j D_j^2) + near field.
//
// Rigid ends, R = -1, give back the time-domain formulas. Where an end moves so freely that |1 - R| is small it feels next to no
// force and dividing by it would blow up noise: the quotient is regularised, and the bands in which it had to be are named.
//
#pragma once

#include <rosin/reconstruct/bow_point_transfer.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/periodic_part.hpp>

#include <concepts>

namespace rosin {

/// Reflection function of a termination: complex R at a frequency in Hz, for velocity waves; -1 for a rigid one.
template <class R>
concept ReflectionFunction = requires(const R& r, double frequency_Hz) {
  { r(frequency_Hz) } -> std::convertible_to<std::complex<double>>;
};

struct rigid_end {
  [[nodiscard]] std::complex<double> operator()(double) const noexcept { return -1.0; }
};

/// One period of the motion under the bow, on an integral grid.
struct periodic_motion {
  periodic_part source;
  int samples_per_period = 0;
  std::vector<double> force_near_N, force_far_N, velocity_near_m_s, velocity_far_m_s;
  double delta = 0;               ///< Eq. (12), of the two versions of the force
  std::vector<band> regularised;  ///< bands in which a denominator was too small to trust
};

namespace detail {

/// x / d, damped where |d| falls below `floor`.
inline std::complex<double> careful_quotient(std::complex<double> x, std::complex<double> d, double floor) {
  const double size = std::abs(d);
  return size >= floor ? x / d : x * std::conj(d) / (size * size + (floor - size) * (floor - size));
}

/// Series to one period of samples.
inline std::vector<double> evaluate_series(const Eigen::VectorXcd& series, int count) {
  std::vector<double> out(static_cast<std::size_t>(count), 0.0);
  for (int n = 0; n < count; ++n)
    for (Eigen::Index h = 0; h < series.size(); ++h)
      out[static_cast<std::size_t>(n)] +=
          (series[h] * std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(h * n % count) / count)).real();
  return out;
}

inline void note_band(std::vector<band>& bands, double f, double spacing) {
  if (!bands.empty() && bands.back().stop_Hz >= f - 0.6 * spacing) bands.back().stop_Hz = f + spacing / 2;
  else bands.push_back({f - spacing / 2, f + spacing / 2});
}

}  // namespace detail

/// Calibrated forces (newtons) of a take. `floor`: smallest |1 - R| that is divided by; 2 for a rigid end.
template <class Physics = full_physics, ReflectionFunction Near = rigid_end, ReflectionFunction Far = rigid_end>
[[nodiscard]] outcome<periodic_motion> reconstruct_periodic(const bow_point& at, std::span<const double> near_N,
                                                            std::span<const double> far_N, const band& limits, double rate_Hz,
                                                            const Near& near_end = {}, const Far& far_end = {},
                                                            double floor = 0.05) {
  const double nominal = 0.5 / (at.delay_s[0] + at.delay_s[1]);
  outcome<periodic_part> part = find_periodic_part(near_N, far_N, rate_Hz, nominal, limits.stop_Hz);
  if (!part) return failure{part.error()};
  periodic_motion out{.source = *std::move(part),
                      .samples_per_period = 0,
                      .force_near_N = {},
                      .force_far_N = {},
                      .velocity_near_m_s = {},
                      .velocity_far_m_s = {},
                      .delta = 0,
                      .regularised = {}};
  const periodic_part& p = out.source;
  const typename Physics::kernel side1(at, 0, limits, rate_Hz), side2(at, 1, limits, rate_Hz);
  const double f0 = rate_Hz / p.period;
  const Eigen::Index H = p.series[0].size();
  std::array<Eigen::VectorXcd, 4> result;
  for (auto& r : result) r = Eigen::VectorXcd::Zero(H);

  for (Eigen::Index h = 0; h < H; ++h) {
    const double f = static_cast<double>(h) * f0, w = 2 * std::numbers::pi * f;
    const double G = Physics::force_factor ? force_factor(w, at.stiffness_s2) : 1.0;
    const double Zw = at.impedance_Ns_m * (Physics::force_factor ? wave_impedance_ratio(w, at.stiffness_s2) : 1.0);
    const std::complex<double> R1 = near_end(f), R2 = far_end(f);
    if (std::abs(1.0 - R1) < floor || std::abs(1.0 - R2) < floor) detail::note_band(out.regularised, f, f0);
    const std::complex<double> a1 = limits(f) * detail::careful_quotient(p.series[0][h], (1.0 - R1) * Zw, floor * Zw);
    const std::complex<double> a2 = limits(f) * detail::careful_quotient(p.series[1][h], (1.0 - R2) * Zw, floor * Zw);
    const std::complex<double> u1 = a1 * side1.back(f), u2 = a2 * side2.back(f);
    const std::complex<double> b1 = a1 * R1 * side1.forward(f), b2 = a2 * R2 * side2.forward(f);
    result[0][h] = 2 * G * Zw * (u1 - b2);
    result[1][h] = 2 * G * Zw * (u2 - b1);
    const std::complex<double> near_field =
        Physics::near_field
            ? std::complex<double>(0, -near_field_ratio(w, at.stiffness_s2) / (2 * Zw * force_factor(w, at.stiffness_s2)))
            : std::complex<double>(0);
    const std::complex<double> extra = near_field * (result[0][h] + result[1][h]) / 2.0;
    result[2][h] = u1 + b1 + extra;
    result[3][h] = u2 + b2 + extra;
  }
  out.samples_per_period = static_cast<int>(std::ceil(p.period));
  out.force_near_N = detail::evaluate_series(result[0], out.samples_per_period);
  out.force_far_N = detail::evaluate_series(result[1], out.samples_per_period);
  out.velocity_near_m_s = detail::evaluate_series(result[2], out.samples_per_period);
  out.velocity_far_m_s = detail::evaluate_series(result[3], out.samples_per_period);
  out.delta = consistency_delta(out.force_near_N, out.force_far_N);
  return out;
}

}  // namespace rosin
