// tier: hosted
// SPDX-License-Identifier: MIT
//
// Kernels of a string whose contact travels (wave_way.hpp): with a_j the wave that arrives at end j, and m_j what a moving end makes of it
// (wave_end.hpp),
//
//     a_j = H_j f + R_i m_i  (i the other end),     v = local * f - G_1 m_1 - G_2 m_2.
//
// R_j, once along the whole string after end j has turned the wave over, are a loop with the poles of all partials (wave_loop.hpp), the same wherever the contact
// is. All runs at the contact's rate.
//
#pragma once

#include <rosin/simulate/wave_design.hpp>
#include <rosin/simulate/wave_way.hpp>

namespace rosin {

template <class T = double>
struct travelling_kernels {
  double step_s = 0;
  std::array<wave_way<T>, 2> way{};    ///< to the near and the far end
  std::array<wave_taps<T>, 2> loop{};  ///< R_j
  std::array<wave_end, 2> ends{};
  std::vector<T> local{};

  travelling_kernels() = default;
  /// In another scalar.
  template <class U>
  explicit travelling_kernels(const travelling_kernels<U>& k)
      : step_s{k.step_s}, way{wave_way<T>{k.way[0]}, wave_way<T>{k.way[1]}}, loop{wave_taps<T>{k.loop[0]}, wave_taps<T>{k.loop[1]}}, ends{k.ends}, local(k.local.begin(), k.local.end()) {}

  /// Steps until a force can be at either end, at the earliest.
  [[nodiscard]] std::ptrdiff_t ahead() const noexcept { return std::min(way[0].first(), way[1].first()); }
  /// Steps whose echoes are known before the first of them.
  [[nodiscard]] std::ptrdiff_t block() const noexcept { return 2 * ahead(); }
  [[nodiscard]] std::ptrdiff_t loop_block() const noexcept { return std::max(std::min<std::ptrdiff_t>(std::min(loop[0].first, loop[1].first), 64) / block(), std::ptrdiff_t{1}) * block(); }
};

struct travelling_design {
  travelling_kernels<double> kernels{};
  std::vector<string_mode> turn{};  ///< torsional partials; empty without torsion
  double turn_stiffness_N_m = 0;    ///< of the surface against both ends
  band limits{};
};

/// Fails where the rig, the range, the settings or the ends make no sense, or the rate is too low for them.
[[nodiscard]] inline outcome<travelling_design> design_travelling_wave(const modal_rig& rig, const contact_range& range, const wave_settings& settings = {},
                                                                       const std::array<modal_termination, 2>& ends = {}) {
  const double rate_Hz = 1 / settings.step_s(), length_s = 1 / (2 * rig.string.fundamental_Hz);
  for (const double position : {range.least, range.most}) {
    for (const auto& problem : {problem_with(rig, position), problem_with(settings)})
      if (!problem.empty()) return failure{problem};
    if (const auto problem = problem_with_contact(rig, position, settings); !problem.empty()) return failure{problem};
  }
  travelling_design d;
  auto& k = d.kernels;
  d.limits.pass_Hz = std::min(settings.band_Hz, 0.25 * rate_Hz);
  d.limits.stop_Hz = std::min(4 * d.limits.pass_Hz, 0.49 * rate_Hz);
  k.step_s = settings.step_s();
  k.local = local_response(rig.string, k.step_s);
  detail::scale_to(k.local, wave_mobility(rig.string, 0));
  k.way = {wave_way<double>{rig.string, range.least, range.most, d.limits, rate_Hz}, wave_way<double>{rig.string, 1 - range.most, 1 - range.least, d.limits, rate_Hz}};
  const echo_plan plan{{length_s, length_s}, rig.string.stiffness_s2(), d.limits, rate_Hz, 2 * k.ahead(), poles_of(transverse_modes(rig.string, d.limits.pass_Hz))};
  const auto loop = design_loop(plan, [&](std::size_t) { return pinned_echo{{length_s, rig.string.stiffness_s2(), rig.string.loss}, rig.string.fundamental_Hz}; });
  if (!loop) return failure{loop.error()};
  for (std::size_t j = 0; j < 2; ++j) {
    if (const auto problem = problem_with(ends[j], rate_Hz); !problem.empty()) return failure{problem};
    k.loop[j] = wave_taps<double>{loop->echo[j]};
    k.ends[j] = {ends[j], rate_Hz};
  }
  if (rig.torsion.present()) d.turn = detail::turn_modes(rig, d.limits, k.step_s), d.turn_stiffness_N_m = detail::turn_stiffness_N_m(rig);
  return d;
}

}  // namespace rosin
