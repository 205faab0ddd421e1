// tier: hosted
// SPDX-License-Identifier: MIT
//
// From pitch and inharmonicity to SI: what a single uncalibrated channel cannot tell, a ruler, a scale or a catalogue can.
//
//     T = m (2 L f0)^2,   B = b T L^2 / pi^2,   m = rho pi d^2 / 4,   B = E pi d^4 / 64   (plain round wire)
//     so  b = pi^2 E d^2 / (64 rho L^4 f0^2),   d = (8 L^2 f0 / pi) sqrt(rho b / E)
//
// Whatever follows from the facts given is computed, with first-order errors; the rest stays empty. For a wound string rho, E
// and d do not belong together: give the linear density or the tension.
//
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct measured_value {
  double value = 0;
  double sd = 0;
};

/// What is known of a string besides its sound. Of tension, linear density and (diameter, density) the first given is used.
struct pickup_string_facts {
  std::optional<measured_value> length_m, tension_N, linear_density_kg_m, diameter_m, density_kg_m3, youngs_modulus_Pa;
};

/// What follows from facts and sound.
struct string_in_SI {
  std::optional<measured_value> tension_N, linear_density_kg_m, impedance_Ns_m;
  std::optional<measured_value> bending_stiffness_Nm2;  ///< from the inharmonicity heard
  /// of a plain round wire, from length, diameter, density, modulus and pitch
  std::optional<measured_value> expected_inharmonicity;
  /// of a plain round wire, from length, density, modulus and what is heard
  std::optional<measured_value> diameter_from_sound_m;
};

namespace detail {

/// f of values with independent errors, to first order; empty if a value is missing.
inline std::optional<measured_value> combined(const std::vector<std::optional<measured_value>>& x,
                                              const std::function<double(const std::vector<double>&)>& f) {
  std::vector<double> at;
  for (const auto& v : x) {
    if (!v) return std::nullopt;
    at.push_back(v->value);
  }
  double variance = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (x[i]->sd == 0) continue;
    const double h = 1e-4 * std::max(std::abs(at[i]), x[i]->sd);
    std::vector<double> up = at, down = at;
    up[i] += h;
    down[i] -= h;
    variance += std::pow((f(up) - f(down)) / (2 * h) * x[i]->sd, 2);
  }
  return measured_value{f(at), std::sqrt(variance)};
}

}  // namespace detail

[[nodiscard]] inline string_in_SI string_from(const pickup_string_facts& facts, measured_value fundamental_Hz,
                                              measured_value inharmonicity) {
  using values = std::vector<double>;
  using std::numbers::pi;
  const std::optional<measured_value> f0 = fundamental_Hz, b = inharmonicity;
  const auto square = [](double x) { return x * x; };
  const auto wave = [square](double L, double f) { return square(2 * L * f); };
  string_in_SI s;
  if (facts.tension_N) {
    s.tension_N = facts.tension_N;
    s.linear_density_kg_m =
        detail::combined({s.tension_N, facts.length_m, f0}, [=](const values& v) { return v[0] / wave(v[1], v[2]); });
    s.impedance_Ns_m =
        detail::combined({s.tension_N, facts.length_m, f0}, [](const values& v) { return v[0] / (2 * v[1] * v[2]); });
    s.bending_stiffness_Nm2 =
        detail::combined({s.tension_N, facts.length_m, b}, [=](const values& v) { return v[2] * v[0] * square(v[1] / pi); });
  } else {
    s.linear_density_kg_m = facts.linear_density_kg_m
                                ? facts.linear_density_kg_m
                                : detail::combined({facts.density_kg_m3, facts.diameter_m},
                                                   [=](const values& v) { return v[0] * pi / 4 * square(v[1]); });
    const auto& m = s.linear_density_kg_m;
    s.tension_N = detail::combined({m, facts.length_m, f0}, [=](const values& v) { return v[0] * wave(v[1], v[2]); });
    s.impedance_Ns_m = detail::combined({m, facts.length_m, f0}, [](const values& v) { return v[0] * 2 * v[1] * v[2]; });
    s.bending_stiffness_Nm2 = detail::combined(
        {m, facts.length_m, f0, b}, [=](const values& v) { return v[3] * v[0] * wave(v[1], v[2]) * square(v[1] / pi); });
  }
  s.expected_inharmonicity =
      detail::combined({facts.youngs_modulus_Pa, facts.diameter_m, facts.density_kg_m3, facts.length_m, f0},
                       [=](const values& v) { return square(pi * v[1] / (8 * v[3] * v[3] * v[4])) * v[0] / v[2]; });
  if (inharmonicity.value > 0)
    s.diameter_from_sound_m =
        detail::combined({facts.length_m, f0, facts.density_kg_m3, b, facts.youngs_modulus_Pa},
                         [=](const values& v) { return 8 * v[0] * v[0] * v[1] / pi * std::sqrt(v[2] * v[3] / v[4]); });
  return s;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
