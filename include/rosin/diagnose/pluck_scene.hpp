// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a pluck can meet that is linear: a stiff string with things on it, ends that give way, a wire that lets go slowly, sensors
// with a life of their own. Every linear effect of the catalogue writes into this scene; the response is always a sum of damped
// lines, poles of one determinant and their residues (string_response.hpp, string_poles.hpp).
//
// Impedances are relative to the string's Z and lengths are fractions, so that no tension in newtons is needed.
//
#pragma once

#include <rosin/calibrate/pluck_model.hpp>
#include <rosin/math/plain_complex.hpp>
#include <rosin/propagate/termination.hpp>

#include <array>
#include <complex>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Something on the string: impedance Z_s / Z = mass_s s + resistance + spring_per_s / s, held by a small compliance: nothing is
/// a point, and what yields between string and load (extent, bond) is to first order a spring in series. May be slightly
/// negative. The answer may come late, or early: a damper with a little mass is R (1 + s M / R), to first order one that answers
/// M / R early.
struct scatterer {
  double position = 0.5;    ///< fraction of the length from the near end
  double mass_s = 0;        ///< M / Z
  double resistance = 0;    ///< R / Z
  double spring_per_s = 0;  ///< K / Z
  double bond_s = 0;        ///< Z / K of the bond; 0: rigid
  double lag_s = 0;         ///< of the force behind the motion

  [[nodiscard]] std::complex<double> impedance(std::complex<double> s) const {
    std::complex<double> z = mass_s * s + resistance;
    if (spring_per_s != 0) z += spring_per_s * plain::reciprocal(s);
    if (bond_s != 0) z *= plain::reciprocal(1.0 + s * bond_s * z);
    return lag_s == 0 ? z : z * std::exp(-s * lag_s);
  }
};

/// A termination that gives way: Z Y(s) = (sum of modes + Z / (M s)) exp(-s lag). Far above a mode the lag is all that is seen
/// of the modes beyond: -lag / M, a part of Y in phase with the force.
struct yielding_end {
  std::vector<admittance_mode> modes;
  double per_free_mass_per_s = 0;  ///< Z / M of an end that is nothing but a mass
  double lag_s = 0;                ///< of the motion behind the force; may be slightly negative
  /// against turning, k / (k + sqrt(B T)) with the end's k in N m; 0: pinned, 1: clamped. A stiff string only
  double clamping = 0;

  [[nodiscard]] bool rigid() const { return modes.empty() && per_free_mass_per_s == 0; }
  [[nodiscard]] std::complex<double> admittance(std::complex<double> s) const {
    std::complex<double> sum = 0;
    if (per_free_mass_per_s != 0) sum = per_free_mass_per_s * plain::reciprocal(s);
    for (const admittance_mode& m : modes) sum += m(s);
    return lag_s == 0 ? sum : sum * std::exp(-s * lag_s);
  }
};

/// What a channel adds to the force on its end.
struct sensor_response {
  double resonance_Hz = 0, q = 1;  ///< H = w0^2 / (s^2 + s w0 / q + w0^2); 0: none
  double corner_Hz = 0;            ///< first-order high-pass; 0: DC coupled
  double delay_s = 0;              ///< the channel comes late by this

  /// The pole of the resonance in the upper half plane (or one of two real ones).
  [[nodiscard]] std::complex<double> pole() const { return admittance_mode{resonance_Hz, q}.pole(); }
  [[nodiscard]] std::complex<double> operator()(std::complex<double> s) const {
    std::complex<double> h = delay_s == 0 ? 1.0 : std::exp(-s * delay_s);
    const double w = 2 * std::numbers::pi * resonance_Hz, corner = 2 * std::numbers::pi * corner_Hz;
    if (w > 0) h *= w * w * plain::reciprocal(s * s + s * (w / q) + w * w);
    if (corner > 0) h *= s * plain::reciprocal(s + corner);
    return h;
  }
};

/// One harmonic of the mains as both channels see it: Re{ amplitude exp(i 2 pi f t) }, t from the take's beginning, newtons.
struct hum_phasor {
  double frequency_Hz = 0;
  std::array<std::complex<double>, 2> amplitude_N{};
};

/// Everything linear that a pluck can meet.
struct pluck_scene {
  ringing_string string;
  std::vector<scatterer> scatterers;
  double loaded_loss = 0;  ///< 0: every mode of the bare string loses by itself; 1: every mode of the string with what sits on it
  std::array<yielding_end, 2> ends;
  double release_duration_s = 0;      ///< F(t) = F0 (1 + cos(pi t / d)) / 2
  double width = 0;                   ///< of the wire's grip, fraction of the length
  double detuning = 0, coupling = 0;  ///< second polarisation: (f_z - f_y) / f_y; tan tan of the two angles
  double detuned_alike = 0;           ///< 0: as by another tension, which stiffness does not feel; 1: all partials by one ratio
  std::array<sensor_response, 2> sensors;
  double crosstalk = 0;  ///< of each channel in the other
  std::vector<hum_phasor> hum;

  [[nodiscard]] bool plain_string() const {
    return scatterers.empty() && ends[0].rigid() && ends[1].rigid() && ends[0].clamping == 0 && ends[1].clamping == 0;
  }
};

/// The phase by which a wave is ahead at an end that resists turning, tan a = q sqrt(1/epsilon) clamping / ((1 - clamping) (q^2 +
/// kc^2) + clamping kc sqrt(1/epsilon)); q and kc per second of travel, kc^2 = q^2 + 1/epsilon.
[[nodiscard]] inline double phase_ahead(double q, double epsilon, double clamping) {
  if (clamping == 0) return 0;
  const double kappa = std::sqrt(q * q + 1 / epsilon), still = std::sqrt(1 / epsilon);
  return std::atan2(clamping * still * q, (1 - clamping) * (q * q + kappa * kappa) + clamping * kappa * still);
}

/// What an end that does not turn freely takes from the string's length for slow motion, a fraction of it: clamping sqrt(B / T) /
/// L.
[[nodiscard]] inline double shortened_by(const ringing_string& string, double clamping) {
  return clamping * std::sqrt(std::max(0.0, string.stiffness_s2())) * 2 * string.fundamental_Hz;
}

/// The string between pinned ends that comes nearest to one whose ends resist turning, up to the third power of the frequency,
/// and places on it.
struct nearest_pinned {
  ringing_string string;
  double begin = 0, whole = 1;  ///< in lengths of the other

  nearest_pinned(const pluck_scene& scene, const ringing_string& held)
      : string{held}, begin{shortened_by(held, scene.ends[0].clamping)} {
    const double reach = shortened_by(held, 1);
    double softer = 0;
    for (const yielding_end& end : scene.ends) {
      const double c = end.clamping;
      whole -= c * reach, softer += 2 * reach * c * (2 - c * (1.5 - c / 3));
    }
    string.fundamental_Hz /= whole;
    string.inharmonicity *= (1 - softer) / (whole * whole);
  }
  [[nodiscard]] double place(double position) const { return (position - begin) / whole; }
};

/// Forces on the ends while the wire holds the string with 1 N, near and far. Modes that yield are so much more string; what
/// moves as a mere mass is taken to be held.
[[nodiscard]] inline std::array<double, 2> held_forces(const pluck_scene& scene, double position) {
  std::array<double, 2> longer{};  // by fractions of the length
  for (std::size_t e = 0; e < 2; ++e) {
    longer[e] = -shortened_by(scene.string, scene.ends[e].clamping);
    for (const admittance_mode& m : scene.ends[e].modes) longer[e] += m.compliance_s() * 2 * scene.string.fundamental_Hz;
  }
  return static_forces(position, longer);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
