// tier: hosted
// SPDX-License-Identifier: MIT
//
// The names that [model] physics may hold: the catalogue of effects that a diagnosis knows by name (diagnosis, schema 1),
// with the further names foreseen there.
//
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace rosin {

inline constexpr std::array<std::string_view, 34> effect_names{"bending-stiffness",
                                                               "frequency-dependent-loss",
                                                               "tension-modulation",
                                                               "second-polarization",
                                                               "point-mass",
                                                               "point-damper",
                                                               "support-resonance",
                                                               "ac-coupling",
                                                               "sensor-resonance",
                                                               "channel-skew",
                                                               "channel-crosstalk",
                                                               "sensor-nonlinearity",
                                                               "mains-hum",
                                                               "slow-release",
                                                               "torsion",
                                                               "tension-drift",
                                                               "rod-resonance",
                                                               "finite-contact-width",
                                                               "speed-ripple",
                                                               "normal-force-ripple",
                                                               "thermal-friction",
                                                               "elasto-plastic-friction",
                                                               "air-loss",
                                                               "resistive-end",
                                                               "massive-end",
                                                               "finite-pluck-width",
                                                               "pluck-position",
                                                               "rattle",
                                                               "sympathetic-string",
                                                               "phantom-partials",
                                                               "clock-drift",
                                                               "dropouts",
                                                               "creep",
                                                               "clamped-end"};

[[nodiscard]] constexpr bool is_effect_name(std::string_view name) noexcept {
  return std::find(effect_names.begin(), effect_names.end(), name) != effect_names.end();
}

}  // namespace rosin
