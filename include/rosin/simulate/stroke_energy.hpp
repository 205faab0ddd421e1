// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where the work of the rod went in a simulated stroke. In joules, from rest to the end of the take.
//
#pragma once

namespace rosin {

/// Of one kind of motion.
struct motion_energy {
  double received_J = 0;  ///< work of the contact's force on it
  double stored_J = 0;    ///< in motion and elastic at the end
  double lost_J = 0;      ///< to its damping
};

struct stroke_energy {
  double rod_J = 0;       ///< work of the rod (or bow)
  double friction_J = 0;  ///< of it turned to heat where rod and string rub, by force and slip at the steps
  motion_energy transverse{}, torsion{};
  double left_out_J = 0;  ///< elastic, in the modes that are left out and only yield

  /// What the string's motion received less what is found of it, as a part of what it received: rounding, if the modes were
  /// stepped exactly.
  [[nodiscard]] constexpr double string_error() const noexcept {
    const double received = transverse.received_J + torsion.received_J;
    return received != 0 ? (received - string_J()) / received : 0;
  }
  /// What the rod gave less all that is found of it, as a part of what it gave. Not zero: force and slip fulfil the law of
  /// friction at the steps, and not between them.
  [[nodiscard]] constexpr double error() const noexcept {
    return rod_J != 0 ? (rod_J - friction_J - string_J() - left_out_J) / rod_J : 0;
  }

private:
  [[nodiscard]] constexpr double string_J() const noexcept {
    return transverse.stored_J + transverse.lost_J + torsion.stored_J + torsion.lost_J;
  }
};

}  // namespace rosin
