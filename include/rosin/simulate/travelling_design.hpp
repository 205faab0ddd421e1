// tier: hosted
// SPDX-License-Identifier: MIT
//
// Kernels of a string whose contact travels (wave_way.hpp): with a_j the wave that arrives at end j, and m_j what a moving end
// makes of it (wave_end.hpp),
//
//     a_j = H_j f + R_i m_i  (i the other end),     v = local * f - G_1 m_1 - G_2 m_2.
//
// R_j, once along the whole string after end j has turned the wave over, are a loop with the poles of all partials
// (wave_loop.hpp), the same wherever the contact is. All runs at the contact's rate.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/simulate/wave_design.hpp>
#include <rosin/simulate/wave_way.hpp>

#include <rosin/core/macros_aside.ipp>

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
      : step_s{k.step_s}, way{wave_way<T>{k.way[0]}, wave_way<T>{k.way[1]}},
        loop{wave_taps<T>{k.loop[0]}, wave_taps<T>{k.loop[1]}}, ends{k.ends}, local(k.local.begin(), k.local.end()) {}

  /// Steps until a force can be at either end, at the earliest.
  [[nodiscard]] std::ptrdiff_t ahead() const noexcept { return std::min(way[0].first(), way[1].first()); }
  /// Steps whose echoes are known before the first of them.
  [[nodiscard]] std::ptrdiff_t block() const noexcept { return 2 * ahead(); }
  [[nodiscard]] std::ptrdiff_t loop_block() const noexcept {
    return std::max(std::min<std::ptrdiff_t>(std::min(loop[0].first, loop[1].first), 64) / block(), std::ptrdiff_t{1}) * block();
  }
};

struct travelling_design {
  travelling_kernels<double> kernels{};
  contact_range range{};            ///< the contact is held within it
  std::vector<string_mode> turn{};  ///< torsional partials; empty without torsion
  double turn_stiffness_N_m = 0;    ///< of the surface against both ends
  band limits{};
};

namespace detail {

/// Where the contact sticks it parts the string in two, f = (G_1 m_1 + G_2 m_2) / local, and what goes round is
///
///     a_j = R_i m_i + H_j (G_1 m_1 + G_2 m_2) / local.
///
/// The largest gain of its two ways round where their phase passes 0, from 0.3 of the first partial on.
template <class = void>
[[nodiscard]] double largest_stuck_gain(const travelling_kernels<double>& k, double position, double period) {
  using complex = std::complex<double>;
  std::size_t grid = 4096;
  while (grid < 16 * static_cast<std::size_t>(k.loop[0].last() + k.loop[1].last())) grid *= 2;
  const lane_fft<double, 1> transform(grid);
  std::array<std::vector<complex>, 2> h, g, r;
  for (std::size_t j = 0; j < 2; ++j) {
    const double distance = j == 0 ? position : 1 - position;
    std::vector<double> to_end(static_cast<std::size_t>(k.way[j].last()) + 1, 0.0), back(to_end.size(), 0.0);
    k.way[j].to_end(distance).scatter(1, to_end.data());
    k.way[j].back(distance).spread(back.data());
    h[j] = spectrum_of(transform, 0, to_end), g[j] = spectrum_of(transform, 0, back),
    r[j] = spectrum_of(transform, k.loop[j].first, k.loop[j].taps);
  }
  const auto local = spectrum_of(transform, 0, k.local);
  double largest = 0;
  std::array<complex, 2> before{};
  for (auto i = static_cast<std::size_t>(0.3 * static_cast<double>(grid) / period); i <= grid / 2; ++i) {
    const complex a = h[0][i] * g[0][i] / local[i], d = h[1][i] * g[1][i] / local[i];
    const complex b = r[1][i] + h[0][i] * g[1][i] / local[i], c = r[0][i] + h[1][i] * g[0][i] / local[i], half = (a + d) / 2.0,
                  root = std::sqrt((a - d) * (a - d) / 4.0 + b * c);
    std::array<complex, 2> here{half + root, half - root};
    if (std::abs(here[0] - before[0]) + std::abs(here[1] - before[1]) >
        std::abs(here[1] - before[0]) + std::abs(here[0] - before[1]))
      std::swap(here[0], here[1]);
    for (std::size_t j = 0; j < 2; ++j) largest = std::max(largest, gain_at_crossing(before[j], here[j]));
    before = here;
  }
  return largest;
}
ROSIN_INSTANTIATE(double largest_stuck_gain(const travelling_kernels<double>&, double, double))

}  // namespace detail

/// Fails where the rig, the range, the settings or the ends make no sense, or the rate is too low for them.
template <class = void>
[[nodiscard]] outcome<travelling_design> design_travelling_wave(const modal_rig& rig, const contact_range& range,
                                                                const wave_settings& settings = {},
                                                                const std::array<modal_termination, 2>& ends = {}) {
  const double rate_Hz = 1 / settings.step_s(), length_s = 1 / (2 * rig.string.fundamental_Hz);
  if (!(range.least <= range.most)) return failure{"contact: the least of its positions lies beyond the most"};
  for (const double position : {range.least, range.most}) {
    for (const auto& problem : {problem_with(rig, position), problem_with(settings)})
      if (!problem.empty()) return failure{problem};
    if (const auto problem = problem_with_contact(rig, position, settings); !problem.empty()) return failure{problem};
  }
  travelling_design d{.range = range};
  auto& k = d.kernels;
  d.limits.pass_Hz = std::min(settings.band_Hz, 0.25 * rate_Hz);
  d.limits.stop_Hz = std::min(4 * d.limits.pass_Hz, 0.49 * rate_Hz);
  k.step_s = settings.step_s();
  k.local = local_response(rig.string, k.step_s);
  detail::scale_to(k.local, wave_mobility(rig.string, 0));
  const double whole = rate_Hz * length_s, values = 4 * 4 * (range.most - range.least) * whole * whole;  // of the tables, or so
  if (values > 1e8)
    return failure{"contact: its way is too long to be tabulated for this string and rate (" +
                   std::to_string(static_cast<int>(values * 8e-9)) + " GB); shorten it or lower the rate"};
  k.way = {wave_way<double>{rig.string, range.least, range.most, d.limits, rate_Hz},
           wave_way<double>{rig.string, 1 - range.most, 1 - range.least, d.limits, rate_Hz}};
  const echo_plan plan{{length_s, length_s},
                       rig.string.stiffness_s2(),
                       d.limits,
                       rate_Hz,
                       2 * k.ahead(),
                       poles_of(transverse_modes(rig.string, d.limits.pass_Hz))};
  const auto loop = design_loop(plan, [&](std::size_t) {
    return pinned_echo{{length_s, rig.string.stiffness_s2(), rig.string.loss}, rig.string.fundamental_Hz};
  });
  if (!loop) return failure{loop.error()};
  for (std::size_t j = 0; j < 2; ++j) {
    if (const auto problem = problem_with(ends[j], rate_Hz); !problem.empty()) return failure{problem};
    k.loop[j] = wave_taps<double>{loop->echo[j]};
    k.ends[j] = {ends[j], rate_Hz};
  }
  for (const double position : {range.least, (range.least + range.most) / 2, range.most})
    if (const double gain = detail::largest_stuck_gain(k, position, 2 * whole); !(gain < 1))
      return failure{"contact: where it sticks at " + number_text(position) +
                     " of the length the string would not be stable (gain " + number_text(gain) +
                     "); it may be at a higher rate of the steps, or a little further on"};
  if (rig.torsion.present())
    d.turn = detail::turn_modes(rig, d.limits, k.step_s), d.turn_stiffness_N_m = detail::turn_stiffness_N_m(rig);
  return d;
}
ROSIN_INSTANTIATE(outcome<travelling_design> design_travelling_wave(const modal_rig&, const contact_range&, const wave_settings&,
                                                                    const std::array<modal_termination, 2>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
