// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a fit of plucks is given: the recordings, what is known beforehand, and which nuisances are free in which band.
//
#pragma once

#include <rosin/calibrate/pluck_model.hpp>
#include <rosin/propagate/termination.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One recorded pluck: forces on the terminations in nominal newtons.
struct pluck_take {
  std::string name{};
  double rate_Hz = 0;
  std::array<std::vector<double>, 2> force_N{};  ///< near, far; equally long
  double strength_N = 1;                         ///< nominal breaking force
  double strength_tolerance = 0.03;              ///< relative, a limit: two standard deviations
  double position = 0.5;                         ///< declared, from the near end
};

/// What is known beforehand.
struct pluck_guess {
  double fundamental_Hz = 0;  ///< within 2 %
  double inharmonicity = 0;   ///< within 60 %; 0: unknown
  double quality = 1000;
  std::array<double, 2> gain_tolerance{0.05, 0.05};  ///< relative limits
  std::array<double, 2> ac_coupled_Hz{0, 0};         ///< 0: DC coupled
  double position_tolerance = 0.005;                 ///< how far, in lengths, a predicted pluck may be from where it is declared
  /// terminations that are known to move; fit_plucks() takes them for rigid, fit_ends() and a diagnosis do not
  std::array<modal_termination, 2> ends{};

  [[nodiscard]] bool has_ends() const { return !ends[0].modes.empty() || !ends[1].modes.empty(); }
};

/// Which nuisances are free, and which band is used.
struct pluck_options {
  bool stiffness = true;      ///< false: the string is taken for ideal
  bool internal_loss = true;  ///< 1/Q may grow with frequency
  bool air_loss = false;
  bool convention = true;       ///< psi is fitted
  bool causality = false;       ///< how much the loss disperses is fitted, with a little of 1/Q as f and 1/f
  bool uneven_loss = false;     ///< the constant part of 1/Q may be uneven by some hundredths
  bool own_places = false;      ///< each take has a position of its own
  int own_losses = 0;           ///< of a diagnosis: how many modes may have a loss of their own (own_losses.hpp)
  bool asks_own_losses = true;  ///< of fit_plucks(): modes have losses of their own where the recordings ask for them
  double pass_fraction = 0.34;  ///< edges of the band, of the sampling rate: below where converters begin to cut off
  double stop_fraction = 0.42;
  int most_partials = 160;  ///< a longer, lower string is fitted over fewer hertz
  int threads = 1;          ///< of a diagnosis, whose fits do not depend on one another; 0: all cores

  [[nodiscard]] band limits_for(double rate_Hz, double highest_Hz = 1e300) const noexcept {
    const double stop = std::min(stop_fraction * rate_Hz, highest_Hz);
    return {stop * pass_fraction / stop_fraction, stop};
  }
  /// Ends between the last partial that is fitted and the next, so that no small change of the string moves one across.
  [[nodiscard]] band limits_for(double rate_Hz, const ringing_string& string) const noexcept {
    return limits_for(rate_Hz, (string.partial_Hz(most_partials) + string.partial_Hz(most_partials + 1)) / 2);
  }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
