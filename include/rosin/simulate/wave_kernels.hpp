// tier: hosted
// SPDX-License-Identifier: MIT
//
// All that the run of a travelling-wave string needs, made by design_wave(). With force-like waves s_j = f + q_other going out to
// side j and q_j = R_j s_j coming back, a force f at the contact moves it at
//
//     v = local * f + fill * (q_1 + q_2),
//
// local: the driving-point mobility of a string without ends; fill: E sinc^2, E = 1 / (2 Z_f), the wave that a newton
// sends out. s, q and R live at 1 / stride of the contact's rate; thin and fill lead down to it and back up.
// At stride 1 an end may be so near that fill could not look ahead: then that side's echo has a kernel of its own straight to
// the velocity, and what the far side does is computed in longer blocks. Where an end moves, R_j is still that of a rigid one,
// and s_j has met the end beforehand (wave_end.hpp). Normalised this way the dispersion of the wave impedance needs one short
// kernel, outside the loop.
//
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <rosin/propagate/fir.hpp>
#include <rosin/simulate/point_modes.hpp>
#include <rosin/simulate/wave_end.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Taps in the run's scalar, for lags first, first + 1, ...
template <class T>
struct wave_taps {
  std::ptrdiff_t first = 0;
  std::vector<T> taps{}, backwards{};

  wave_taps() = default;
  template <class U>
  explicit wave_taps(const wave_taps<U>& other)
      : first{other.first}, taps(other.taps.begin(), other.taps.end()), backwards(taps.rbegin(), taps.rend()) {}
  explicit wave_taps(const fir& kernel)
      : first{kernel.first}, taps(kernel.taps.begin(), kernel.taps.end()), backwards(taps.rbegin(), taps.rend()) {}
  void scale_to(T sum) noexcept {
    T all = 0;
    for (const T tap : taps) all += tap;
    for (auto* side : {&taps, &backwards})
      for (T& tap : *side) tap *= sum / all;
  }
  [[nodiscard]] std::ptrdiff_t last() const noexcept { return first + static_cast<std::ptrdiff_t>(taps.size()) - 1; }
  [[nodiscard]] bool empty() const noexcept { return taps.empty(); }
};

template <class T = double>
struct wave_kernels {
  double step_s = 0;             ///< of the contact
  std::ptrdiff_t stride = 1;     ///< steps of the contact for one of the waves
  std::ptrdiff_t block = 1;      ///< steps of the contact computed together, a multiple of the stride
  std::ptrdiff_t far_block = 0;  ///< stride 1 only: the same for all that goes through the far side, a multiple of the block
  std::array<wave_taps<T>, 2> echo{};
  std::array<wave_end, 2> ends{};
  std::size_t near = 0;              ///< the side whose end is nearer
  wave_taps<T> direct{};             ///< stride 1 only: E sinc^2 R of the near side; then fill serves the far side alone
  wave_taps<T> thin{};               ///< contact's rate to the waves'; empty where the stride is 1
  std::vector<wave_taps<T>> fill{};  ///< one for each of the stride's phases; lags in steps of the waves
  std::vector<T> local{};
  point_modes turn{};  ///< torsional partials up to the band
  T turn_rest = 0;     ///< of those above: compliance / step, m/s per N

  wave_kernels() = default;
  /// In another scalar.
  template <class U>
  explicit wave_kernels(const wave_kernels<U>& k)
      : step_s{k.step_s}, stride{k.stride}, block{k.block}, far_block{k.far_block},
        echo{wave_taps<T>{k.echo[0]}, wave_taps<T>{k.echo[1]}}, ends{k.ends}, near{k.near}, direct{k.direct}, thin{k.thin},
        fill(k.fill.begin(), k.fill.end()),
        local(k.local.begin(), k.local.end()), turn{k.turn}, turn_rest{static_cast<T>(k.turn_rest)} {}

  [[nodiscard]] std::ptrdiff_t reach_back() const noexcept { return std::max(echo[0].last(), echo[1].last()); }
  [[nodiscard]] std::ptrdiff_t look_ahead() const noexcept { return thin.empty() ? 0 : -thin.first; }
  /// Steps of the waves by which fill looks ahead.
  [[nodiscard]] std::ptrdiff_t fill_ahead() const noexcept {
    std::ptrdiff_t ahead = 0;
    for (const auto& phase : fill) ahead = std::max(ahead, -phase.first);
    return ahead;
  }
  /// Velocity for 1 N within a step.
  [[nodiscard]] T mobility_m_Ns() const noexcept { return local.front() + turn_mobility_m_Ns(); }
  [[nodiscard]] T turn_mobility_m_Ns() const noexcept { return static_cast<T>(turn.mobility()) + turn_rest; }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
