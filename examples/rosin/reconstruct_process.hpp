// SPDX-License-Identifier: MIT
//
// The numerical part of a reconstruction, for one choice of physics. Full and paper's processing are compiled apart.
//
#pragma once

#include "rig_ends.hpp"

#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/periodic_reconstruction.hpp>
#include <rosin/reconstruct/uncertainty.hpp>

#include <functional>
#include <optional>
#include <string>

namespace tool {

/// Reflection at a termination; rigid where nothing is set.
struct any_reflection {
  std::function<std::complex<double>(double)> of_frequency;
  [[nodiscard]] std::complex<double> operator()(double f_Hz) const { return of_frequency ? of_frequency(f_Hz) : -1.0; }
};

struct process_input {
  rosin::calibration calibration;
  std::vector<double> near_N, far_N;  ///< recorded, nominal newtons; coupling and offset already undone
  rosin::band limits{0, 0};
  double rate_Hz = 0;
  bool fine_tune = true;
  std::array<moving_end, 2> ends;
  std::vector<rosin::mode_of_end> uncertain_modes;  ///< those that were fitted
  Eigen::MatrixXd joint_covariance;                 ///< of waveform parameters and these; empty: none
};

struct processed {
  std::optional<rosin::fine_tuning> tuning;
  rosin::sample_range tuned_on{0, 0};
  rosin::calibration used;
  std::array<std::vector<double>, 2> force_N;  ///< on the terminations, true newtons
  rosin::bow_motion<double> motion;
  rosin::reconstruction_uncertainty sd;
  std::optional<rosin::periodic_motion> periodic;
  std::string why_not_periodic;
  bool ends_settle = false;  ///< the take began in motion: nothing is known until the ends have forgotten what was before
};

[[nodiscard]] processed process_full(const process_input& in);
[[nodiscard]] processed process_moving_ends(const process_input& in);
[[nodiscard]] processed process_as_paper(const process_input& in);

namespace detail {

/// At most one second, in the middle: the search needs no more.
[[nodiscard]] inline rosin::sample_range tuning_range(std::size_t samples, double rate_Hz) {
  const auto most = static_cast<std::size_t>(rate_Hz);
  if (samples <= most) return {0, samples};
  return {(samples - most) / 2, (samples + most) / 2};
}

/// What moves, beside the forces: recorded newtons.
struct recorded_ends {
  std::array<rosin::end_motion, 2> motion;
  rosin::sample_range known{0, 0};
  bool in_motion = false;
};

/// From rest, if the first 2 ms hardly stir.
[[nodiscard]] inline bool begins_at_rest(const std::vector<double>& force_N, double rate_Hz) {
  const auto spread = [](std::span<const double> x) {
    double mean = 0, power = 0;
    for (const double v : x) mean += v / static_cast<double>(x.size());
    for (const double v : x) power += (v - mean) * (v - mean) / static_cast<double>(x.size());
    return std::sqrt(power);
  };
  const auto early = std::min(force_N.size(), static_cast<std::size_t>(2e-3 * rate_Hz) + 16);
  return spread(std::span(force_N).first(early)) < 0.05 * spread(force_N);
}

[[nodiscard]] inline recorded_ends record_ends(const process_input& in) {
  recorded_ends out;
  out.known = {0, in.near_N.size()};
  for (std::size_t e = 0; e < 2; ++e) {
    const std::vector<double>& force = e == 0 ? in.near_N : in.far_N;
    if (in.ends[e]) out.motion[e] = in.ends[e].motion(force, in.limits, in.rate_Hz);
    else out.motion[e] = rosin::motion_of_end(rosin::rigid_termination{}, force, in.limits, in.rate_Hz);
    out.in_motion = out.in_motion || !begins_at_rest(force, in.rate_Hz);
  }
  for (const rosin::end_motion& m : out.motion) {
    out.known.end = std::min(out.known.end, m.known.end);
    if (out.in_motion) out.known.begin = std::max(out.known.begin, m.settled);
  }
  return out;
}

inline void keep_only(rosin::bow_motion<double>& m, rosin::sample_range more) {
  const rosin::sample_range known{std::max(m.known.begin, more.begin),
                                  std::max(std::max(m.known.begin, more.begin), std::min(m.known.end, more.end))};
  for (auto* row : {&m.force_near_N, &m.force_far_N, &m.velocity_near_m_s, &m.velocity_far_m_s})
    for (std::size_t i = 0; i < row->size(); ++i)
      if (i < known.begin || i >= known.end) (*row)[i] = std::numeric_limits<double>::quiet_NaN();
  m.known = known;
}

template <class Physics>
[[nodiscard]] processed process(const process_input& in) {
  processed out;
  out.used = in.calibration;
  recorded_ends ends;
  rosin::end_signals<double, Physics> recorded{in.near_N, in.far_N};
  if constexpr (Physics::moving_ends) {
    ends = record_ends(in);
    out.ends_settle = ends.in_motion;
    for (std::size_t e = 0; e < 2; ++e) recorded[2 + e] = ends.motion[e].times_impedance_N;
  }
  if (in.fine_tune) {
    out.tuned_on = tuning_range(in.near_N.size(), in.rate_Hz);
    auto part = recorded;
    for (auto& x : part) x = x.subspan(out.tuned_on.begin, out.tuned_on.end - out.tuned_on.begin);
    out.tuning = rosin::fine_tune<Physics>(in.calibration, part, in.limits, in.rate_Hz);
    out.used = out.tuning->tuned;
  }
  const auto signals = rosin::detail::calibrated(out.used, recorded);
  const auto views = rosin::detail::views_of(signals);
  out.force_N = {signals[0], signals[1]};
  out.motion = rosin::reconstructor<double, Physics>(out.used.at, in.limits, in.rate_Hz)(views);
  if constexpr (Physics::moving_ends) keep_only(out.motion, ends.known);
  if (out.motion.known.end <= out.motion.known.begin) return out;
  auto slopes = rosin::sensitivity<Physics>(out.used, views, in.limits, in.rate_Hz);
  Eigen::MatrixXd covariance;
  if constexpr (Physics::moving_ends)
    if (!in.uncertain_modes.empty()) {
      rosin::append_end_sensitivity<Physics>(slopes, out.used.at, in.uncertain_modes, views, in.limits, in.rate_Hz);
      covariance = in.joint_covariance;
      constexpr Eigen::Index waveform = rosin::waveform_parameters;
      if (out.tuning) {  // what the take itself says of the delays is worth more than how they hang together with the modes
        covariance.topRows(waveform).setZero();
        covariance.leftCols(waveform).setZero();
      }
      covariance.topLeftCorner(waveform, waveform) = out.used.covariance;
    }
  const std::array<double, 2> noise{out.used.noise_N[0] / out.used.gain[0], out.used.noise_N[1] / out.used.gain[1]};
  out.sd = rosin::uncertainty<Physics>(out.used, out.motion, slopes, noise, in.limits, in.rate_Hz, covariance);
  auto periodic =
      rosin::reconstruct_periodic<Physics>(out.used.at, views[0], views[1], in.limits, in.rate_Hz,
                                           any_reflection{in.ends[0].reflection}, any_reflection{in.ends[1].reflection});
  if (periodic) out.periodic = *std::move(periodic);
  else out.why_not_periodic = periodic.error();
  return out;
}

}  // namespace detail

}  // namespace tool
