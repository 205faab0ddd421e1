// tier: freestanding
// SPDX-License-Identifier: MIT
//
// The string as seen from the contact: all that reconstruction has to know of it, in time rather than in length. Two travel
// times, dispersion and loss follow from plucks alone; only the impedance, a scale of the velocity, needs a tension in newtons.
//
#pragma once

#include <rosin/propagate/string_parameters.hpp>

#include <array>

namespace rosin {

struct bow_point {
  std::array<double, 2> delay_s{};  ///< travel times to the near and the far end, at low frequency
  double stiffness_s2 = 0;          ///< epsilon = B m / T^2
  loss_law loss{};
  double impedance_Ns_m = 0;  ///< Z = sqrt(T m)
};

/// A contact at `position` (0..1, from the near end) of a string.
[[nodiscard]] inline bow_point contact_at(const string_parameters& string, double position) noexcept {
  const double one_way_s = 0.5 / string.fundamental_Hz;
  return {{position * one_way_s, (1 - position) * one_way_s}, string.stiffness_s2(), string.loss, string.impedance_Ns_m()};
}

}  // namespace rosin
