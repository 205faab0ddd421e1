// SPDX-License-Identifier: MIT
//
// The law of friction that a rig file asks for: [model].friction with the parameters in [friction], and what is taken where
// nothing is given.
//
#pragma once

#include "command_line.hpp"

#include <rosin/acquire/rig_values.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>

#include <variant>

namespace tool {

/// constant + sum of coefficient exp(-v / speed) + rise exp(-(v / stribeck)^2); as a rig file declares it, either the
/// exponentials are there or the last part.
struct declared_curve {
  using scalar = double;
  static constexpr std::size_t most_terms = 8;
  std::array<rosin::friction_term, most_terms> terms{};
  std::size_t count = 0;
  double constant = 0, stribeck_rise = 0, stribeck_m_s = 1;

  [[nodiscard]] rosin::curve_point<double> operator()(double v) const noexcept;
  [[nodiscard]] double convex_from() const noexcept { return stribeck_rise > 0 ? stribeck_m_s * std::sqrt(0.5) : 0.0; }
};

using friction_law =
    std::variant<rosin::velocity_curve<declared_curve>, rosin::thermal_plastic<double>, rosin::elasto_plastic<declared_curve>>;

/// The law, and all that is needed to say which it is.
struct chosen_friction {
  friction_law law;
  rosin::friction_model model = rosin::friction_model::velocity_curve;
  declared_curve curve{};  ///< friction in steady sliding, for every law
  double ambient_C = 20;
  rosin::contact_heat_parameters<double> heat{};        ///< thermal
  rosin::elasto_plastic_parameters<double> bristles{};  ///< elasto-plastic
  double normal_force_N = 0;                            ///< the one to which the law's parameters refer

  [[nodiscard]] json to_json() const;
};

/// `assumed` gets every default, `notes` what is in [friction] and not used by the law. Fails where the parameters
/// contradict each other, or no such law can be had from them.
[[nodiscard]] rosin::outcome<chosen_friction> choose_friction(const rosin::rig& rig, std::vector<std::string>& assumed,
                                                              std::vector<std::string>& notes);

}  // namespace tool
