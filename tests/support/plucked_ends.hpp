// SPDX-License-Identifier: MIT
//
// Plucks on ends that move, as a fit takes them: component modes (moving_end_rig.hpp), noise, a converter of 16 bits.
//
#pragma once

#include "moving_end_rig.hpp"

#include <rosin/calibrate/pluck_layout.hpp>

namespace test {

inline const rosin::string_parameters steel_e{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 659.69, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
inline const rosin::pluck_guess about_steel_e{.fundamental_Hz = 662, .inharmonicity = 6e-5};

/// One pluck of 1 N at each position.
inline std::vector<rosin::pluck_take> pluck_at(const moving_end_rig& rig, const std::vector<double>& positions, double duration_s,
                                               double noise_N = 3e-4, double rate_Hz = 40e3) {
  std::vector<rosin::pluck_take> takes;
  for (const double p : positions) {
    auto take = pluck_moving_ends(rig, p, 1.0, 0.008, duration_s, {.rate_Hz = rate_Hz, .mode_limit_Hz = 40e3, .oversampling = 8});
    const auto seed = static_cast<unsigned>(2 * takes.size());
    if (noise_N > 0) record(take.near_N, noise_N, 2, seed + 1), record(take.far_N, noise_N, 2, seed + 2);
    takes.push_back(
        {"pluck-" + std::to_string(takes.size() + 1), rate_Hz, {std::move(take.near_N), std::move(take.far_N)}, 1.0, 0.03, p});
  }
  return takes;
}

}  // namespace test
