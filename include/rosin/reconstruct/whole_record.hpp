// tier: hosted
// SPDX-License-Identifier: MIT
//
// Reconstruction of a whole take at once, by one transform of the record: any propagation, that of a string whose modes lose one by
// one included (calibrate/uneven_string.hpp), whose kernels would be long; and the combination of both ends that has the least
// variance (end_weights.hpp) beside the two versions and their mean. The passages to the ends, and what the band rings, make the
// samples at both ends of the record unknown: not a number. There the mismatch of the ends is not of noise, but of a record that was cut
// off: it is weighed down to nothing before the weights of the combination, whose features are narrow, can spread it over the record.
//
//     standard deviation by noise:   sd^2 = (2 / rate) int_0^stop W^2 (s_1^2 |a_1|^2 + s_2^2 |a_2|^2) df,   a_j the weights
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/propagate/band.hpp>
#include <rosin/reconstruct/end_weights.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Force and velocity by one way of weighing the ends.
struct weighed_motion {
  std::vector<double> force_N, velocity_m_s;
  double force_sd_N = 0, velocity_sd_m_s = 0;  ///< by the sensors' noise
};

struct whole_motion {
  bow_motion<double> versions;    ///< the two of each
  weighed_motion mean, combined;  ///< their mean, and the combination with the least variance
};

/// From calibrated forces (N), equally long. `rate_of`: gamma c at a frequency in Hz, a string's propagation. Preconditions: delays and
/// impedance > 0, limits.stop_Hz <= half the sampling rate.
template <class Rate>
[[nodiscard]] whole_motion reconstruct_whole(const bow_point& at, const Rate& rate_of, const end_noise& noise,
                                             std::span<const double> near_N, std::span<const double> far_N, const band& limits,
                                             double rate_Hz) {
  using complex = std::complex<double>;
  const std::size_t samples = std::min(near_N.size(), far_N.size());
  const double longest = std::max(at.delay_s[0], at.delay_s[1]);
  const auto guard = static_cast<std::size_t>(longest * rate_Hz + 12 * rate_Hz / (limits.stop_Hz - limits.pass_Hz));
  const std::size_t n = fast_size(samples + 2 * guard);
  eigen_fft<double> fft(n);
  const double bin_Hz = rate_Hz / static_cast<double>(n);
  std::array<std::vector<complex>, 2> F;
  std::vector<double> work(n);
  for (std::size_t j = 0; j < 2; ++j) {
    const auto from = (j == 0 ? near_N : far_N).first(samples);
    std::fill(std::copy(from.begin(), from.end(), work.begin()), work.end(), 0.0);
    F[j].resize(n / 2 + 1);
    fft.forward(work.data(), F[j].data());
  }
  whole_motion out;
  std::array<std::vector<complex>, 8> made;
  for (auto& m : made) m.assign(n / 2 + 1, complex(0));
  std::vector<complex> mismatch(n / 2 + 1, complex(0)), force_per, velocity_per;
  std::array<double, 4> variance{};
  for (std::size_t k = 0; k <= n / 2; ++k) {
    const double f = static_cast<double>(k) * bin_Hz, W = limits(f);
    if (!(W > 0)) break;
    const auto power = [&](std::size_t j) { return std::norm(F[j][k]) / static_cast<double>(samples); };
    const auto all = weigh_ends(rate_of(f), f, at, noise, {power(0), power(1)});
    const std::array ways{&all.near, &all.far, &all.mean};
    for (std::size_t i = 0; i < ways.size(); ++i) {
      made[2 * i][k] = W * (ways[i]->force[0] * F[0][k] + ways[i]->force[1] * F[1][k]);
      made[2 * i + 1][k] = W * (ways[i]->velocity[0] * F[0][k] + ways[i]->velocity[1] * F[1][k]);
    }
    mismatch[k] = W * (all.mismatch[0] * F[0][k] + all.mismatch[1] * F[1][k]);
    force_per.push_back(all.force_per_mismatch), velocity_per.push_back(all.velocity_per_mismatch);
    const double share = 2 / static_cast<double>(n) * W * W;
    variance[0] += share * all.mean.force_variance(noise.sensor_N);
    variance[1] += share * all.mean.velocity_variance(noise.sensor_N);
    variance[2] += share * all.combined.force_variance(noise.sensor_N);
    variance[3] += share * all.combined.velocity_variance(noise.sensor_N);
  }
  fft.inverse(mismatch.data(), work.data());
  for (std::size_t i = 0; i < n; ++i) {
    const double in = static_cast<double>(std::min(i, samples - std::min(samples, i))) - static_cast<double>(guard);
    const double up = std::clamp(in / static_cast<double>(guard + 1), 0.0, 1.0);
    work[i] *= 0.5 * (1 - std::cos(std::numbers::pi * up));
  }
  fft.forward(work.data(), mismatch.data());
  for (std::size_t k = 0; k < force_per.size(); ++k) {
    made[6][k] = made[4][k] + force_per[k] * mismatch[k];
    made[7][k] = made[5][k] + velocity_per[k] * mismatch[k];
  }
  const sample_range known{std::min(guard, samples), samples > guard ? samples - guard : 0};
  out.versions.known = known.end > known.begin ? known : sample_range{0, 0};
  const std::array to{
      &out.versions.force_near_N, &out.versions.velocity_near_m_s, &out.versions.force_far_N, &out.versions.velocity_far_m_s,
      &out.mean.force_N,          &out.mean.velocity_m_s,          &out.combined.force_N,     &out.combined.velocity_m_s};
  for (std::size_t i = 0; i < to.size(); ++i) {
    fft.inverse(made[i].data(), work.data());
    to[i]->assign(samples, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t s = out.versions.known.begin; s < out.versions.known.end; ++s) (*to[i])[s] = work[s];
  }
  out.mean.force_sd_N = std::sqrt(variance[0]), out.mean.velocity_sd_m_s = std::sqrt(variance[1]);
  out.combined.force_sd_N = std::sqrt(variance[2]), out.combined.velocity_sd_m_s = std::sqrt(variance[3]);
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
