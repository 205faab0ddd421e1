// SPDX-License-Identifier: MIT
//
// The numerical part of a reconstruction, for one choice of physics. Full and paper's processing are compiled apart.
//
#pragma once

#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/periodic_reconstruction.hpp>
#include <rosin/reconstruct/uncertainty.hpp>

#include <functional>
#include <optional>
#include <string>

namespace tool {

/// Reflection at a declared termination; rigid where nothing is set.
struct declared_end {
  std::function<std::complex<double>(double)> of_frequency;
  [[nodiscard]] std::complex<double> operator()(double f_Hz) const { return of_frequency ? of_frequency(f_Hz) : -1.0; }
};

struct process_input {
  rosin::calibration calibration;
  std::vector<double> near_N, far_N;  ///< recorded, nominal newtons; coupling and offset already undone
  rosin::band limits{0, 0};
  double rate_Hz = 0;
  bool fine_tune = true;
  std::array<declared_end, 2> ends;
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
};

[[nodiscard]] processed process_full(const process_input& in);
[[nodiscard]] processed process_as_paper(const process_input& in);

namespace detail {

/// At most one second, in the middle: the search needs no more.
[[nodiscard]] inline rosin::sample_range tuning_range(std::size_t samples, double rate_Hz) {
  const auto most = static_cast<std::size_t>(rate_Hz);
  if (samples <= most) return {0, samples};
  return {(samples - most) / 2, (samples + most) / 2};
}

template <class Physics>
[[nodiscard]] processed process(const process_input& in) {
  processed out;
  out.used = in.calibration;
  if (in.fine_tune) {
    out.tuned_on = tuning_range(in.near_N.size(), in.rate_Hz);
    const auto part = [&](const std::vector<double>& x) { return std::span(x).subspan(out.tuned_on.begin, out.tuned_on.end - out.tuned_on.begin); };
    out.tuning = rosin::fine_tune<Physics>(in.calibration, part(in.near_N), part(in.far_N), in.limits, in.rate_Hz);
    out.used = out.tuning->tuned;
  }
  out.force_N = rosin::detail::calibrated(out.used, in.near_N, in.far_N);
  const auto& [near, far] = out.force_N;
  out.motion = rosin::reconstructor<double, Physics>(out.used.at, in.limits, in.rate_Hz)(near, far);
  if (out.motion.known.end <= out.motion.known.begin) return out;
  const auto slopes = rosin::sensitivity<Physics>(out.used, near, far, in.limits, in.rate_Hz);
  const std::array<double, 2> noise{out.used.noise_N[0] / out.used.gain[0], out.used.noise_N[1] / out.used.gain[1]};
  out.sd = rosin::uncertainty<Physics>(out.used, out.motion, slopes, noise, in.limits, in.rate_Hz);
  auto periodic = rosin::reconstruct_periodic<Physics>(out.used.at, near, far, in.limits, in.rate_Hz, in.ends[0], in.ends[1]);
  if (periodic) out.periodic = *std::move(periodic);
  else out.why_not_periodic = periodic.error();
  return out;
}

}  // namespace detail

}  // namespace tool
