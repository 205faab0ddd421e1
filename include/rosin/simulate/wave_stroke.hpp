// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke on the travelling-wave string: any law of friction, any motion of the rod, also along the string, and what the sensors
// at the ends would record. The take has the same form, the same clock and the same low-pass as one of the modal reference
// (modal_stroke.hpp), so the two can be set against each other sample by sample. The force on end j is
//
//     F_j = D_j s_j / G,       G = (1 + 2K) / (1 + K),
//
// the wave that left for it, one passage later; of an end that moves 1 / (1 + z) of that (wave_end.hpp).
//
#pragma once

#include <rosin/propagate/dispersion.hpp>
#include <rosin/simulate/modal_stroke.hpp>
#include <rosin/simulate/travelling_string.hpp>
#include <rosin/simulate/wave_design.hpp>
#include <rosin/simulate/wave_string.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct wave_stroke {
  double position = 0.3;  ///< distance from the near end / length
  double duration_s = 0.36;
  /// keep the books of energy, by the modes under the same force: what the waves lack or have too much is in the error
  bool account = false;
};

namespace detail {

/// From s_j to the samples of the force on end j, at the waves' rate: passage that takes delay_s, 1 / G, straight lines,
/// low-pass.
[[nodiscard]] inline fir end_kernel(double delay_s, const string_parameters& string, const band& limits, double wave_rate_Hz,
                                    double step_s, const modal_low_pass& low_pass) {
  const transmission pass{delay_s, string.stiffness_s2(), string.loss};
  const auto wanted = [&](double f) {
    const double w = 2 * std::numbers::pi * f;
    return pass(f) * straight_line_weight(w, step_s) / force_factor(w, string.stiffness_s2());
  };
  const auto lags = lags_of_passage(pass.delay_s, pass.stiffness_s2, limits, wave_rate_Hz);
  fir low{-static_cast<int>(low_pass.half_width_s() * wave_rate_Hz), {}};
  for (int n = low.first; n <= -low.first; ++n) low.taps.push_back(low_pass(n / wave_rate_Hz) / wave_rate_Hz);
  fir passage = sample_response(wanted, limits, wave_rate_Hz, lags.first, lags.last);
  const double sum = std::accumulate(passage.taps.begin(), passage.taps.end(), 0.0);
  for (double& tap : passage.taps) tap += (1 - sum) / static_cast<double>(passage.taps.size());
  return convolved(passage, low, 1);
}

/// What the run leaves behind: the signals at every step, and the waves sent at every step of theirs.
struct wave_record {
  stroke_steps at_steps;  ///< near, far: unused
  std::array<std::vector<double>, 2> sent;

  wave_record(std::size_t steps, std::size_t waves) : at_steps{steps} {
    for (auto& s : sent) s.assign(waves, 0.0);
  }
};

template <class String>
void copy_waves(const String& string, wave_record& out, std::ptrdiff_t& from) noexcept {
  const auto end = std::min(string.waves(), static_cast<std::ptrdiff_t>(out.sent[0].size()));
  for (; from < end; ++from)
    for (std::size_t j = 0; j < 2; ++j) out.sent[j][static_cast<std::size_t>(from)] = static_cast<double>(string.wave(j, from));
}

/// The run itself: no allocation. Stops at the end of the record; true if it stayed finite.
template <class String, class Law, class Motion>
bool run_waves(String& string, Law& law, const Motion& motion, wave_record& out, modal_take& take, std::size_t first) noexcept {
  auto& s = out.at_steps;
  const double step_s = string.step_s();
  std::size_t slipped = 0;
  std::ptrdiff_t copied = 0, block = 0;
  bool before = false;
  const std::size_t end = pressed_steps(motion, first, s.force.size(), step_s);
  for (std::size_t i = first; i < s.force.size(); ++i) {
    const double t = static_cast<double>(i - first) * step_s;
    const rod_state rod = motion(t);
    if constexpr (requires { string.move_to(t); }) s.position[i] = string.move_to(place_of(motion, t, 0));
    const auto line = string.line(rod);
    const auto answer = law(line);
    s.slip[i] = static_cast<double>(line.slip(answer.force_N));
    const auto state = string.apply(answer.force_N);
    s.centre[i] = static_cast<double>(state.centre_m_s), s.torsion[i] = static_cast<double>(state.torsion_m_s);
    s.force[i] = static_cast<double>(answer.force_N), s.rod[i] = rod.velocity_m_s;
    s.temperature[i] = static_cast<double>(answer.temperature_rise_K);
    take.unconverged += answer.converged ? 0U : 1U;
    take.slips += answer.slipping && !before ? 1U : 0U;
    before = answer.slipping;
    slipped += before && i > end / 2 && i < end ? 1U : 0U;
    if (++block < string.block()) continue;
    block = 0;
    copy_waves(string, out, copied);
    if (!(std::abs(s.centre[i]) < 1e6 && std::abs(s.torsion[i]) < 1e6)) return false;
  }
  take.slipping = static_cast<double>(slipped) / static_cast<double>(end - end / 2);
  return true;
}

/// The signals at the contact through the low-pass.
template <class = void>
void sample_waves(modal_take& take, const stroke_steps& s, const modal_decimator& decimate) {
  take.contact_force_N = decimate.lines(s.force);
  take.centre_velocity_m_s = decimate.points(s.centre);
  take.torsion_velocity_m_s = decimate.points(s.torsion);
  take.rod_velocity_m_s = decimate.points(s.rod);
  const bool warm = std::any_of(s.temperature.begin(), s.temperature.end(), [](double t) { return t != 0; });
  if (warm) take.temperature_rise_K = decimate.points(s.temperature);
}

/// The books, as of a stroke that was simulated by modes (modal_stroke.hpp); s.position says where the contact was.
template <class = void>
[[nodiscard]] stroke_energy account_of_waves(const modal_rig& rig, stroke_steps& s, double step_s) {
  const double limit_Hz = std::min(250e3, 0.49 / step_s);
  s.rest = {modal_contact{rig, s.position.back(), limit_Hz, step_s}.left_out()};
  return account_of(rig, s, limit_Hz, step_s);
}

[[nodiscard]] inline std::vector<double> end_force(const fir& kernel, const std::vector<double>& sent, std::size_t samples,
                                                   std::ptrdiff_t stride) {
  std::vector<double> out(samples, 0.0);
  const auto size = static_cast<std::ptrdiff_t>(sent.size());
  for (std::size_t n = 0; n < samples; ++n) {
    const auto at = static_cast<std::ptrdiff_t>(n) * stride - kernel.first;  // newest wave that counts
    const auto begin = std::max<std::ptrdiff_t>(0, at - size + 1),
               end = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(kernel.taps.size()), at + 1);
    double sum = 0;
    for (auto k = begin; k < end; ++k) sum += kernel.taps[static_cast<std::size_t>(k)] * sent[static_cast<std::size_t>(at - k)];
    out[n] = sum;
  }
  return out;
}

/// What differs between a string whose contact stays and one whose contact travels.
struct wave_outlet {
  std::array<fir, 2> ends;    ///< from the waves to the samples of the forces on the ends
  std::ptrdiff_t stride = 1;  ///< steps for one of the waves
  std::ptrdiff_t late = 0;    ///< steps by which waves come after the forces that they are of
};

/// A stroke on a string at rest.
template <class String, class Law, class Motion>
[[nodiscard]] outcome<modal_take> run_stroke(String& string, const wave_outlet& outlet, const modal_rig& rig, Law law,
                                             const Motion& motion, double start, double duration_s, const wave_settings& settings,
                                             bool account) {
  if (const auto problem = problem_with_duration(duration_s, settings.as_modal()); !problem.empty()) return failure{problem};
  const modal_decimator decimate{settings.low_pass(), settings.step_s(), settings.oversampling};
  const auto stride = static_cast<std::size_t>(outlet.stride);
  const auto samples = static_cast<std::size_t>(std::lround(duration_s * settings.sample_rate_Hz));
  const auto ahead = static_cast<std::size_t>(std::max(0, -std::min(outlet.ends[0].first, outlet.ends[1].first))) * stride;
  const auto reach = decimate.reach();
  const auto steps = (samples - 1) * static_cast<std::size_t>(settings.oversampling) + 1 + reach +
                     std::max(reach, ahead + static_cast<std::size_t>(outlet.late));
  wave_record record{steps, steps / stride + 1};
  record.at_steps.position.assign(travels(motion) ? steps : 1, start);
  modal_take take{.sample_rate_Hz = settings.sample_rate_Hz};
  law.reset();
  if (!run_waves(string, law, motion, record, take, reach))
    return failure{"simulation: the string's velocity grew without bound"};
  sample_waves(take, record.at_steps, decimate);
  for (auto* signal : {&take.contact_force_N, &take.centre_velocity_m_s, &take.torsion_velocity_m_s, &take.rod_velocity_m_s,
                       &take.temperature_rise_K})
    signal->resize(std::min(signal->size(), samples));
  take.force_near_N = end_force(outlet.ends[0], record.sent[0], samples, settings.oversampling / outlet.stride);
  take.force_far_N = end_force(outlet.ends[1], record.sent[1], samples, settings.oversampling / outlet.stride);
  if (account) take.energy = account_of_waves(rig, record.at_steps, settings.step_s());
  return take;
}

}  // namespace detail

/// Where a rod is during a stroke. Precondition: its duration and the sample rate are above 0 and finite.
template <RodMotion Motion>
[[nodiscard]] contact_range range_of(const Motion& motion, const wave_stroke& stroke, const wave_settings& settings) noexcept {
  const double start = detail::place_of(motion, 0, stroke.position);
  contact_range range{start, start};
  if (!detail::travels(motion)) return range;
  for (double t = 0; t <= stroke.duration_s; t += 1 / settings.sample_rate_Hz) {
    const double x = detail::place_of(motion, t, start);
    range = {std::min(range.least, x), std::max(range.most, x)};
  }
  return range;
}

/// Simulates a stroke on kernels that design_wave() has made for this rig, position and settings.
template <class T = double, FrictionLaw Law, RodMotion Motion = steady_rod>
[[nodiscard]] outcome<modal_take> simulate_wave_stroke(const wave_design& design, const modal_rig& rig, Law law, Motion motion,
                                                       double duration_s, const wave_settings& settings, bool account = false) {
  if (detail::travels(motion))
    return failure{"contact: it travels, but the kernels are those of one place; design_travelling_wave() makes others"};
  const auto& k = design.kernels;
  const auto low_pass = settings.low_pass();
  const auto end = [&](std::size_t j) {
    return detail::end_kernel(design.end_delay_s[j], rig.string, design.limits, design.wave_rate_Hz, k.step_s, low_pass);
  };
  wave_string<T> string{wave_kernels<T>{k}};
  const double position = design.end_delay_s[0] / (design.end_delay_s[0] + design.end_delay_s[1]);
  return detail::run_stroke(string, {{end(0), end(1)}, k.stride, k.look_ahead() + 2 * k.block + k.far_block}, rig, law, motion,
                            position, duration_s, settings, account);
}

/// The same for a rod that travels, on kernels that design_travelling_wave() has made; beyond their range it stays at its end.
template <class T = double, FrictionLaw Law, TravellingRod Motion>
[[nodiscard]] outcome<modal_take> simulate_wave_stroke(const travelling_design& design, const modal_rig& rig, Law law,
                                                       Motion motion, double duration_s, const wave_settings& settings,
                                                       bool account = false) {
  if (!motion.travels()) return failure{"contact: it stays, but the kernels are those of a way; design_wave() makes others"};
  const auto& k = design.kernels;
  const fir end = detail::end_kernel(0, rig.string, design.limits, 1 / k.step_s, k.step_s, settings.low_pass());
  const double start = motion.position(0);
  travelling_string<T> string{design, start};
  return detail::run_stroke(string, {{end, end}, 1, k.block()}, rig, law, motion, start, duration_s, settings, account);
}

/// The same from a rig; fails where rig, stroke or settings make no sense.
template <class T = double, FrictionLaw Law, RodMotion Motion = steady_rod>
[[nodiscard]] outcome<modal_take> simulate_wave_stroke(const modal_rig& rig, Law law, Motion motion = {}, wave_stroke stroke = {},
                                                       const wave_settings& settings = {},
                                                       const std::array<modal_termination, 2>& ends = {}) {
  for (const auto& problem : {problem_with(settings), problem_with_duration(stroke.duration_s, settings.as_modal())})
    if (!problem.empty()) return failure{problem};
  if constexpr (TravellingRod<Motion>)
    if (motion.travels()) {
      const auto design = design_travelling_wave(rig, range_of(motion, stroke, settings), settings, ends);
      if (!design) return failure{design.error()};
      return simulate_wave_stroke<T>(*design, rig, law, motion, stroke.duration_s, settings, stroke.account);
    }
  const auto design = design_wave(rig, stroke.position, settings, ends);
  if (!design) return failure{design.error()};
  return simulate_wave_stroke<T>(*design, rig, law, motion, stroke.duration_s, settings, stroke.account);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
