// tier: hosted
// SPDX-License-Identifier: MIT
//
// From a rig, a place of contact and settings to the kernels of the run. The waves' rate is the lowest divisor of the
// contact's that holds the band and leaves time, within the shorter echo, to come down to it and back up; a contact very near an
// end needs the full rate.
//
#pragma once

#include <numeric>

#include <rosin/core/instantiate.hpp>
#include <rosin/propagate/transmission.hpp>
#include <rosin/simulate/wave_echo.hpp>
#include <rosin/simulate/wave_kernels.hpp>
#include <rosin/simulate/wave_local.hpp>
#include <rosin/simulate/wave_settings.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Kernels in double, and what the design has to say of itself.
struct wave_design {
  wave_kernels<double> kernels{};
  std::array<double, 2> end_delay_s{};  ///< contact to end
  wave_loop loop{};
  band limits{};
  double wave_rate_Hz = 0;
};

namespace detail {

/// Round to `stride` fewer.
[[nodiscard]] inline std::ptrdiff_t whole_strides(std::ptrdiff_t steps, std::ptrdiff_t stride) noexcept {
  return steps / stride * stride;
}

/// A Kaiser low-pass at the contact's rate that keeps `limits` and what the waves' rate folds onto it apart.
[[nodiscard]] inline fir rate_filter(const band& limits, double wave_rate_Hz, double step_s) {
  const modal_low_pass filter{limits.pass_Hz, wave_rate_Hz - limits.pass_Hz, 3e-5};
  const int half = static_cast<int>(filter.half_width_s() / step_s);
  fir out{-half, {}};
  for (int n = -half; n <= half; ++n) out.taps.push_back(filter(n * step_s) * step_s);
  return out;
}

[[nodiscard]] inline fir convolved(const fir& a, const fir& b, double factor) {
  fir out{a.first + b.first, std::vector<double>(a.taps.size() + b.taps.size() - 1, 0.0)};
  for (std::size_t i = 0; i < a.taps.size(); ++i)
    for (std::size_t j = 0; j < b.taps.size(); ++j) out.taps[i + j] += factor * a.taps[i] * b.taps[j];
  return out;
}

/// Every stride-th tap from each phase on.
[[nodiscard]] inline std::vector<wave_taps<double>> phases(const fir& kernel, int stride) {
  std::vector<wave_taps<double>> out;
  for (int phase = 0; phase < stride; ++phase) {
    fir part;
    const int behind = (phase - kernel.first) / stride;  // first lag i with phase + i stride >= kernel.first
    part.first = -behind;
    for (int at = phase - behind * stride; at <= kernel.last(); at += stride)
      part.taps.push_back(kernel.taps[static_cast<std::size_t>(at - kernel.first)]);
    out.emplace_back(part);
  }
  return out;
}

inline void scale_to(std::vector<double>& taps, double sum) noexcept {
  const double factor = sum / std::accumulate(taps.begin(), taps.end(), 0.0);
  for (double& tap : taps) tap *= factor;
}

/// thin, fill and local: all that is not an echo.
template <class = void>
void set_contact(wave_design& d, const string_parameters& string) {
  const double step_s = d.kernels.step_s, rate = 1 / step_s;
  const auto wave = [&](double f) {
    const double w = 2 * std::numbers::pi * f;
    return std::complex<double>{wave_mobility(string, w) * straight_line_weight(w, step_s), 0};
  };
  const int stride = static_cast<int>(d.kernels.stride);
  const double from = std::min(d.limits.stop_Hz, 0.4 * rate);
  // what the stiffness spreads lasts as long at any rate
  const int reach = static_cast<int>(std::ceil(64e-6 * std::max(rate, 1e6)));
  fir fill = shortest_fir(wave, {from, 0.5 * rate}, rate, -reach, reach, 1e-4);
  if (stride > 1) {
    const fir low = rate_filter(d.limits, d.wave_rate_Hz, step_s);
    d.kernels.thin = wave_taps<double>{low};
    fill = convolved(fill, low, stride);
  }
  d.kernels.fill = phases(fill, stride);
  d.kernels.local = local_response(string, step_s);
  const double at_rest = wave_mobility(string, 0);  // exactly: a force that stays must move the string nowhere
  if (stride > 1) d.kernels.thin.scale_to(1);
  for (auto& phase : d.kernels.fill) phase.scale_to(at_rest);
  scale_to(d.kernels.local, at_rest);
}

/// At stride 1: the near side's echo straight to the velocity; what would come before half of its lag is moved there.
template <class = void>
void set_direct(wave_design& d) {
  const auto& echo = d.loop.echo[d.kernels.near];
  const auto& fill = d.kernels.fill.front();
  fir whole = convolved({static_cast<int>(fill.first), fill.taps}, echo, 1), direct{std::max(1, echo.first / 2), {}};
  direct.taps.assign(static_cast<std::size_t>(whole.last() - direct.first + 16) / 16 * 16, 0.0);  // whole registers
  for (int lag = whole.first; lag <= whole.last(); ++lag)
    direct.taps[static_cast<std::size_t>(std::max(lag, direct.first) - direct.first)] +=
        whole.taps[static_cast<std::size_t>(lag - whole.first)];
  d.kernels.direct = wave_taps<double>{direct};
}

template <class = void>
[[nodiscard]] outcome<wave_loop> string_loop(const wave_design& d, const string_parameters& string) {
  const std::array<double, 2> delay{2 * d.end_delay_s[0], 2 * d.end_delay_s[1]};
  echo_plan plan{delay, string.stiffness_s2(), d.limits, d.wave_rate_Hz, 1, poles_of(transverse_modes(string, d.limits.pass_Hz))};
  if (d.kernels.stride > 1)
    plan.earliest = d.kernels.fill_ahead() + (d.kernels.look_ahead() + d.kernels.stride) / d.kernels.stride;
  return design_loop(plan, [&](std::size_t j) {
    return pinned_echo{{delay[j], string.stiffness_s2(), string.loss}, string.fundamental_Hz};
  });
}

/// Torsional partials as far as a round of the string leaves anything of them.
[[nodiscard]] inline std::vector<string_mode> turn_modes(const modal_rig& rig, const band& limits, double step_s) {
  const double first_Hz = rig.torsion.speed_ratio * rig.string.fundamental_Hz;
  return torsional_modes(
      rig, std::max(std::min(0.4 / step_s, std::max(limits.pass_Hz, 1.5 * rig.torsion.quality * first_Hz)), first_Hz));
}
/// Of the surface against both ends together.
[[nodiscard]] inline double turn_stiffness_N_m(const modal_rig& rig) noexcept {
  return rig.torsion.impedance_ratio * rig.torsion.speed_ratio * rig.string.tension_N / rig.string.length_m;
}

/// Torsion: partials, and the compliance of the rest.
template <class = void>
void set_turn(wave_design& d, const modal_rig& rig, double position) {
  d.kernels.turn = {turn_modes(rig, d.limits, d.kernels.step_s), position, d.kernels.step_s};
  d.kernels.turn_rest = (position * (1 - position) / turn_stiffness_N_m(rig) - d.kernels.turn.compliance()) / d.kernels.step_s;
}

/// The design at one stride; its block is 0 if there is no time for it.
template <class = void>
[[nodiscard]] outcome<wave_design> design_at_stride(const modal_rig& rig, double position, const wave_settings& s,
                                                    std::ptrdiff_t stride) {
  wave_design d;
  d.kernels.step_s = s.step_s();
  d.kernels.stride = stride;
  d.wave_rate_Hz = 1 / (s.step_s() * static_cast<double>(stride));
  d.limits.pass_Hz = std::min(s.band_Hz, (stride > 1 ? 0.36 : 0.25) * d.wave_rate_Hz);
  d.limits.stop_Hz = std::min(4 * d.limits.pass_Hz, 0.49 * d.wave_rate_Hz);
  d.kernels.near = position <= 0.5 ? 0 : 1;
  d.end_delay_s = {position / (2 * rig.string.fundamental_Hz), (1 - position) / (2 * rig.string.fundamental_Hz)};
  set_contact(d, rig.string);
  const auto loop = string_loop(d, rig.string);
  if (!loop) return failure{loop.error()};
  d.loop = *loop;
  for (std::size_t j = 0; j < 2; ++j) d.kernels.echo[j] = wave_taps<double>{loop->echo[j]};
  const auto soonest = std::min(loop->echo[0].first, loop->echo[1].first);
  if (stride == 1) {
    set_direct(d);
    const auto far = loop->echo[1 - d.kernels.near].first - d.kernels.fill_ahead();
    d.kernels.block = std::min<std::ptrdiff_t>(std::min<std::ptrdiff_t>(soonest, d.kernels.direct.first), far);
    const auto block = std::max<std::ptrdiff_t>(d.kernels.block, 1);
    d.kernels.far_block = std::max(whole_strides(std::min<std::ptrdiff_t>(far, 64), block), block);
  } else d.kernels.block = (soonest - d.kernels.fill_ahead() - (d.kernels.look_ahead() + stride) / stride + 1) * stride;
  return d;
}

}  // namespace detail

/// Fails where the rig, the position, the settings or the ends make no sense, or the rate is too low for them.
template <class = void>
[[nodiscard]] outcome<wave_design> design_wave(const modal_rig& rig, double position, const wave_settings& settings = {},
                                               const std::array<modal_termination, 2>& ends = {}) {
  for (const auto& problem : {problem_with(rig, position), problem_with(settings)})
    if (!problem.empty()) return failure{problem};
  if (const auto problem = problem_with_contact(rig, position, settings); !problem.empty()) return failure{problem};
  outcome<wave_design> best = failure{"the contact is too near an end for the rate of the steps"};
  for (const int stride : {8, 4, 2, 1}) {
    const bool holds =
        settings.oversampling % stride == 0 && (stride == 1 || 2.8 * settings.band_Hz * settings.step_s() * stride <= 1);
    if (!holds) continue;
    best = detail::design_at_stride(rig, position, settings, stride);
    // a kernel that had to begin too late would have to be bent to hold its poles
    const bool whole = best && best->loop.largest_change < 2e-3;
    if (whole && best->kernels.block >= (stride > 1 ? 8 : 1)) break;
  }
  if (!best) return best;
  if (rig.torsion.present()) detail::set_turn(*best, rig, position);
  for (std::size_t e = 0; e < 2; ++e) {
    if (const auto problem = problem_with(ends[e], best->wave_rate_Hz); !problem.empty()) return failure{problem};
    best->kernels.ends[e] = {ends[e], best->wave_rate_Hz};
  }
  const auto stride = best->kernels.stride;
  best->kernels.block = std::max(detail::whole_strides(best->kernels.block, stride), stride);
  return best;
}
ROSIN_INSTANTIATE(outcome<wave_design> design_wave(const modal_rig&, double, const wave_settings&,
                                                   const std::array<modal_termination, 2>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
