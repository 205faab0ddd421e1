// tier: hosted
// SPDX-License-Identifier: MIT
//
// The first question about a mismatch: do both versions of the force at the contact agree on it? A pluck is a force at one point like
// a bow's, so it is reconstructed from its two ends (Woodhouse, Schumacher & Garoff 2000, Eq. 3) with the declared model:
//
//     f_near - f_far                     what no force at the contact can do: a sensor, an end, a load, the string;
//     (f_near + f_far) / 2 - a step      what both agree on: the wire lets go in another way, both channels filter alike.
//
// Where the plucks show neither, but the strokes contradict what is declared of rod, contact or friction, it is the contact.
// The first periods are looked at: later on partials that are out of tune part both alike.
//
#pragma once

#include <rosin/calibrate/calibration.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/corrected_take.hpp>
#include <rosin/diagnose/loaded_motion.hpp>
#include <rosin/reconstruct/uncertainty.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

enum class mismatch_class { sensor_or_string, common_mode, contact };

[[nodiscard]] constexpr const char* name_of(mismatch_class c) noexcept {
  return c == mismatch_class::sensor_or_string ? "sensor-or-string"
         : c == mismatch_class::common_mode    ? "common-mode"
                                               : "contact";
}

/// The plucking force as both ends have it, over the first periods; all that long.
struct plucking_force {
  double begin_s = 0;                               ///< in the take
  std::vector<double> near_N{}, far_N{}, step_N{};  ///< both versions; the release, through the same band
  double parting_N = 0, parting_noise_N = 0;        ///< rms of the versions' difference, and what noise makes of it
  double shape_N = 0, shape_noise_N = 0;            ///< the same of their mean less the step
  /// nothing where neither is above the noise
  [[nodiscard]] std::optional<mismatch_class> kind() const {
    constexpr double above = 1.3, much = 0.3;
    const auto beyond = [](double x, double noise) { return std::sqrt(std::max(0.0, x * x - noise * noise)); };
    const bool parted = parting_N > above * parting_noise_N, misshapen = shape_N > above * shape_noise_N;
    if (parted && beyond(parting_N, parting_noise_N) > much * beyond(shape_N, shape_noise_N))
      return mismatch_class::sensor_or_string;
    return misshapen ? std::optional(mismatch_class::common_mode) : std::nullopt;
  }
};

namespace detail {

/// A step from 0 to 1 through a band, so long after it.
[[nodiscard]] inline double limited_step(const band& limits, double after_s) {
  constexpr int points = 1500;
  const double df = limits.stop_Hz / points;
  double s = 0.5;
  for (int i = 0; i < points; ++i) {
    const double f = (i + 0.5) * df;
    s += limits(f) * std::sin(2 * std::numbers::pi * f * after_s) / (std::numbers::pi * f) * df;
  }
  return s;
}

/// The step of the best height and level; without a sample before it, the level alone.
template <class Real = double>
void fit_step(plucking_force& p, std::size_t before) {
  const auto n = static_cast<Eigen::Index>(p.step_N.size());
  const Eigen::VectorX<Real> mean =
      0.5 * (Eigen::Map<Eigen::VectorX<Real>>(p.near_N.data(), n) + Eigen::Map<Eigen::VectorX<Real>>(p.far_N.data(), n));
  Eigen::Map<Eigen::VectorX<Real>> step(p.step_N.data(), n);
  Eigen::MatrixX<Real> basis(n, before > 0 ? 2 : 1);
  basis.col(0).setOnes();
  if (before > 0) basis.col(1) = step;
  step = basis * (basis.transpose() * basis).ldlt().solve(basis.transpose() * mean);
  p.shape_N = std::sqrt((mean - step).squaredNorm() / static_cast<double>(n));
}

}  // namespace detail

/// Of one of the takes that were fitted. `fit`: of the declared model (scene_data); `noise_N`: of the recorded channels, as the best
/// model has it. Nothing where the take is too short.
template <class = void>
[[nodiscard]] std::optional<plucking_force> plucking_force_of(const scene_data& data, const pluck_fit_result& declared,
                                                              const scene_fit& fit, std::size_t take,
                                                              const std::array<double, 2>& noise_N) {
  constexpr double most_periods = 8;
  const pluck_take& recorded = data.takes[take];
  const double rate = recorded.rate_Hz, release_s = fit.value[data.layout.at(take, pluck_layout::release)],
               period_s = 1 / fit.value[pluck_layout::fundamental];
  const band limits{0.30 * rate, 0.45 * rate};
  pluck_fit_result plain = declared;
  plain.value = fit.value.head(data.layout.size());
  const calibration c = calibration_from(plain, recorded.position, 1, 0);
  auto force_N = recorded.force_N;
  undo_sensors(data, fit, force_N, c.at.delay_s, rate, limits.stop_Hz);
  for (std::size_t end = 0; end < 2; ++end)
    for (double& x : force_N[end])
      x = (x - plain.value[data.layout.at(take, end == 0 ? pluck_layout::offset_near : pluck_layout::offset_far)]) / c.gain[end];
  const auto motion = reconstruct_loaded(scene_of(data, fit), c.at, force_N, limits, rate);

  plucking_force out;
  const auto first = std::max(static_cast<double>(motion.known.begin), (release_s - period_s) * rate),
             last = std::min(static_cast<double>(motion.known.end), (release_s + most_periods * period_s) * rate);
  if (!(last > first + 100)) return std::nullopt;
  const auto begin = static_cast<std::size_t>(first), end = static_cast<std::size_t>(last);
  out.begin_s = static_cast<double>(begin) / rate;
  double parting = 0;
  for (std::size_t i = begin; i < end; ++i) {
    out.near_N.push_back(motion.force_near_N[i]), out.far_N.push_back(motion.force_far_N[i]);
    out.step_N.push_back(1 - detail::limited_step(limits, static_cast<double>(i) / rate - release_s));
    parting += std::pow(out.near_N.back() - out.far_N.back(), 2);
  }
  out.parting_N = std::sqrt(parting / static_cast<double>(end - begin));
  detail::fit_step(out, static_cast<double>(begin) < release_s * rate ? 1 : 0);
  const auto kernels = bow_point_kernels<full_physics>(c.at, limits, rate, kernel_error);
  const std::array<double, 2> noise{noise_N[0] / c.gain[0], noise_N[1] / c.gain[1]};
  out.parting_noise_N = detail::noise_through(kernels, {1, -1, 0, 0}, noise);
  out.shape_noise_N = detail::noise_through(kernels, {0.5, 0.5, 0, 0}, noise);
  return out;
}
ROSIN_INSTANTIATE(std::optional<plucking_force> plucking_force_of(const scene_data&, const pluck_fit_result&, const scene_fit&,
                                                                  std::size_t, const std::array<double, 2>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
