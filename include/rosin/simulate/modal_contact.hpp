// tier: hosted
// SPDX-License-Identifier: MIT
//
// The string as the rod feels it: transverse and torsional modes under one point force, and the compliance of the modes
// left out, which answers the force's change within the step. Gives the load line, takes the force.
//
#pragma once

#include <rosin/friction/friction_law.hpp>
#include <rosin/simulate/modal_bank.hpp>
#include <rosin/simulate/modal_take.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The rod at an instant: its speed, and the force that presses it against the string (<= 0: it is off).
struct rod_state {
  double velocity_m_s = 0;
  double normal_force_N = 0;
};

/// State of the string at the end of a step; the parts of the modes left out are not in it (see `left_out`).
struct modal_contact_state {
  double near_N = 0, far_N = 0, centre_m_s = 0, torsion_m_s = 0;
};

/// What the modes left out add to a signal, per newton of contact force; velocities per N/s.
struct modes_left_out {
  double near = 0, far = 0, centre_m_N = 0, torsion_m_N = 0;
};

class modal_contact {
public:
  template <class = void>
  modal_contact(const modal_rig& rig, double position, double mode_limit_Hz, double step_s)
      : rig_{rig}, step_{step_s}, transverse_{transverse_modes(rig, mode_limit_Hz), rig.damping, {position}, step_s},
        torsion_{torsional_modes(rig, mode_limit_Hz), damping_convention::viscous, {position}, step_s} {
    set_place(position);
    rest_before_ = rest_;
  }

  /// Where the contact is from the end of the last step on: to be said before the line is drawn. The modes left out follow the
  /// force f with the deflection C f, and the surface moves with their sum sin (sin f)' / stiffness = C f' + C' f / 2.
  template <class = void>
  void move_to(double position) noexcept {
    rest_before_ = rest_;
    transverse_.move_to({position});
    torsion_.move_to({position});
    set_place(position);
    rest_before_ = (rest_before_ + rest_) / 2;
  }

  template <class = void>
  [[nodiscard]] load_line<double> line(const rod_state& rod) const noexcept {
    return {transverse_.free().velocity[0] + torsion_.free().velocity[0] - rest_before_ * force_, mobility_, rod.velocity_m_s,
            rod.normal_force_N, step_};
  }

  /// Ends the step under way with this force and begins the next.
  template <class = void>
  modal_contact_state apply(double force_N) noexcept {
    const auto& t = transverse_.free();
    const modal_contact_state state{t.near + transverse_.near_gain(0) * force_N, t.far + transverse_.far_gain(0) * force_N,
                                    t.velocity[0] + transverse_.mobility(0, 0) * force_N,
                                    torsion_.free().velocity[0] + torsion_.mobility(0, 0) * force_N};
    transverse_.advance({force_N});
    torsion_.advance({force_N});
    force_ = force_N, rest_before_ = rest_;
    return state;
  }

  [[nodiscard]] const modes_left_out& left_out() const noexcept { return left_out_; }
  [[nodiscard]] double mobility_m_Ns() const noexcept { return mobility_; }

private:
  template <class = void>
  void set_place(double position) noexcept {
    left_out_.near = 1 - position - transverse_.near_share(0);
    left_out_.far = position - transverse_.far_share(0);
    left_out_.centre_m_N = static_compliance_m_N(rig_.string, position) - transverse_.compliance(0);
    if (rig_.torsion.present()) {
      const double stiffness =  // of the surface against both ends together, N/m
          rig_.torsion.impedance_ratio * rig_.torsion.speed_ratio * rig_.string.tension_N / rig_.string.length_m;
      left_out_.torsion_m_N = position * (1 - position) / stiffness - torsion_.compliance(0);
    }
    rest_ = (left_out_.centre_m_N + left_out_.torsion_m_N) / step_;
    mobility_ = transverse_.mobility(0, 0) + torsion_.mobility(0, 0) + rest_;
  }

  modal_rig rig_;
  double step_;
  modal_bank<1> transverse_, torsion_;
  modes_left_out left_out_{};
  double rest_ = 0, rest_before_ = 0, mobility_ = 0, force_ = 0;  // rest_: compliance / step, m/s per N
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
