// SPDX-License-Identifier: MIT
//
// The terminations of a rig: as declared (modes, a table of admittance), and as its plucks say.
//
#pragma once

#include <rosin/acquire/rig.hpp>
#include <rosin/acquire/rig_values.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/propagate/termination_modes.hpp>
#include <rosin/propagate/termination_table.hpp>
#include <rosin/reconstruct/end_sensitivity.hpp>

#include <array>
#include <functional>

namespace tool {

/// A termination that moves, in the three ways in which the tool needs it; empty functions: rigid.
struct moving_end {
  std::function<std::complex<double>(double)> reflection;                                        ///< at a frequency in Hz
  std::function<rosin::end_motion(std::span<const double>, const rosin::band&, double)> motion;  ///< under a force
  rosin::known_admittance admittance;                                                            ///< at s
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(motion); }
};

/// Modes that were fitted, with the covariance of ln f, ln Q, ln(Z/M) of each; `with_waveform`: for each position, their
/// covariance with the waveform parameters.
struct fitted_ends {
  std::array<bool, 2> fitted{};
  std::vector<rosin::fitted_mode> modes;
  Eigen::MatrixXd covariance;
  std::vector<Eigen::MatrixXd> with_waveform;

  [[nodiscard]] rosin::modal_termination end(std::size_t which) const;
  [[nodiscard]] std::vector<rosin::mode_of_end> list() const;
};

/// As declared; rigid where it is declared so, or to be fitted. What had to be done to a table is said in `remarks`.
[[nodiscard]] rosin::outcome<moving_end> declared_end(const rosin::rig& rig, std::size_t which, double impedance_Ns_m,
                                                      std::vector<std::string>& remarks);
/// Both as a diagnosis knows them, into what it begins with: modes as they are, a table by modes that answer as it does
/// (`remarks` tells how well), rigid where they are to be fitted.
[[nodiscard]] std::optional<rosin::failure> add_known_ends(const rosin::rig& rig, const rosin::rig_values& values,
                                                           rosin::pluck_guess& guess, std::vector<std::string>& remarks);
/// Both as a simulation steps them: the same; "fit" fails.
[[nodiscard]] rosin::outcome<std::array<rosin::modal_termination, 2>> simulated_ends(const rosin::rig& rig, double impedance_Ns_m,
                                                                                     std::vector<std::string>& remarks);
[[nodiscard]] moving_end end_of_modes(const rosin::modal_termination& modes);
[[nodiscard]] bool any_end_moves(const rosin::rig& rig);
[[nodiscard]] bool to_be_fitted(const rosin::rig& rig, std::size_t which);

}  // namespace tool
