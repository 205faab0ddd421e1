// tier: hosted
// SPDX-License-Identifier: MIT
//
// Time-domain reconstruction of a whole take, transient included: the transfer functions of bow_point_transfer.hpp as FIR kernels
// within a band, run over the record by overlap-save. Nothing periodic is assumed. A sample whose kernel would reach beyond
// the record is unknown (not a number), never made up. Where the ends move, their velocities (end_motion.hpp) come in beside the
// forces.
//
#pragma once

#include <rosin/condition/overlap_save.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/reconstruct/bow_point_transfer.hpp>

#include <limits>
#include <memory>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What happened under the bow, sample by sample at the recording's rate; NaN where it cannot be known.
template <class T>
struct bow_motion {
  std::vector<T> force_near_N, force_far_N;            ///< two versions of Eq. (3)
  std::vector<T> velocity_near_m_s, velocity_far_m_s;  ///< two versions of Eq. (1)
  sample_range known{0, 0};

  [[nodiscard]] T force_N(std::size_t i) const { return (force_near_N[i] + force_far_N[i]) / 2; }
  [[nodiscard]] T velocity_m_s(std::size_t i) const { return (velocity_near_m_s[i] + velocity_far_m_s[i]) / 2; }
};

/// What goes in: {F_near, F_far}; where the ends move {F_near, F_far, Z V_near, Z V_far}. Newtons, equally long.
template <class T, class Physics>
using end_signals = std::array<std::span<const T>, bow_point_transfer<Physics>::inputs>;

/// Largest relative error of the FIR kernels inside the pass band.
inline constexpr double kernel_error = 1e-6;

/// Kernels for the transfer functions of a bow point; row-major.
template <class Physics>
[[nodiscard]] std::vector<fir> bow_point_kernels(const bow_point& at, const band& limits, double rate_Hz,
                                                 double error = kernel_error) {
  const bow_point_transfer<Physics> transfer(at, limits, rate_Hz);
  const double longest = std::max(at.delay_s[0], at.delay_s[1]);
  const passage_lags lags = lags_of_passage(longest, at.stiffness_s2, limits, rate_Hz);
  const auto kernels = shortest_firs(transfer, limits, rate_Hz, -lags.last, lags.last, error);
  return {kernels.begin(), kernels.end()};
}

/// A reconstruction with a fixed calibration, for takes of any length. T: float or double.
template <class T = double, class Physics = full_physics, class Fft = lane_fft<T>>
class reconstructor {
public:
  /// Preconditions: delays > 0, impedance > 0, limits.stop_Hz <= rate_Hz / 2.
  reconstructor(const bow_point& at, const band& limits, double rate_Hz, double error = kernel_error)
      : convolver_(bow_point_transfer<Physics>::inputs, bow_point_kernels<Physics>(at, limits, rate_Hz, error)) {}

  /// Forces on rigid terminations in newtons, equally long.
  [[nodiscard]] bow_motion<T> operator()(std::span<const T> near_N, std::span<const T> far_N) requires(!Physics::moving_ends) {
    return (*this)(end_signals<T, Physics>{near_N, far_N});
  }
  [[nodiscard]] bow_motion<T> operator()(end_signals<T, Physics> in) {
    std::size_t n = in[0].size();
    for (const auto& x : in) n = std::min(n, x.size());
    for (auto& x : in) x = x.first(n);
    bow_motion<T> out;
    out.known = convolver_.valid(n);
    std::array<std::vector<T>*, 4> rows{&out.force_near_N, &out.force_far_N, &out.velocity_near_m_s, &out.velocity_far_m_s};
    std::array<std::span<T>, 4> views;
    for (std::size_t p = 0; p < 4; ++p) {
      rows[p]->resize(n);
      views[p] = *rows[p];
    }
    convolver_.process(in, views);
    for (std::vector<T>* row : rows) {
      std::fill(row->begin(), row->begin() + static_cast<std::ptrdiff_t>(out.known.begin), std::numeric_limits<T>::quiet_NaN());
      std::fill(row->begin() + static_cast<std::ptrdiff_t>(out.known.end), row->end(), std::numeric_limits<T>::quiet_NaN());
    }
    return out;
  }

private:
  block_convolver<T, Fft> convolver_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
