// SPDX-License-Identifier: MIT
// Instantiated, not run: the symbols that these functions leave undefined are the test.
#include <rosin/propagate/band.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/propagate/dispersion.hpp>
#include <rosin/propagate/string_parameters.hpp>

extern "C" float rosin_dispersion(float omega, float epsilon_s2) noexcept {
  return rosin::phase_rate(omega, epsilon_s2) + rosin::stiffness_ratio(omega, epsilon_s2) +
         rosin::slowness_ratio(omega, epsilon_s2) + rosin::force_factor(omega, epsilon_s2) +
         rosin::wave_impedance_ratio(omega, epsilon_s2) + rosin::near_field_ratio(omega, epsilon_s2);
}

extern "C" double rosin_string(const rosin::string_parameters& string, double frequency_Hz) noexcept {
  return string.impedance_Ns_m() + string.linear_density_kg_m() + string.stiffness_s2() + string.inharmonicity() +
         string.loss.inverse_q(frequency_Hz);
}

extern "C" double rosin_bow_point(const rosin::string_parameters& string, double position) noexcept {
  const rosin::bow_point bow = rosin::contact_at(string, position);
  return bow.delay_s[0] + bow.delay_s[1] + bow.impedance_Ns_m;
}

extern "C" double rosin_band(double pass_Hz, double stop_Hz, double frequency_Hz) noexcept {
  return rosin::band{pass_Hz, stop_Hz}(frequency_Hz);
}
