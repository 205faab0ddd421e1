// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where in time and frequency does what a model leaves of a pluck stand out? A pluck reaches either end as a direct wave and then as
// its echoes, at
//
//     t_k = t_release + T (2 n + d) / 2   and   t_release + T (2 n + 2 - d) / 2,      n = 0, 1, ...
//
// (T: the period; d: the pluck's distance from that end / length). What a sensor, the wire or the first bounce does is there from
// one of them on; what a string does along its length grows from each to the next. So the map has a row for each stretch between
// two arrivals (later ones together, by doubling numbers) and a column for each octave, and in each cell the residual's rms over
// that of the noise, taken as white.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/propagate/band.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// When the waves of a pluck arrive at an end.
struct echo_times {
  double release_s = 0, period_s = 1;
  double distance = 0.5;  ///< of the pluck from that end, in lengths: 0 to 1

  /// 1: the direct wave.
  [[nodiscard]] double arrival_s(int echo) const noexcept {
    const int n = (echo - 1) / 2;
    return release_s + 0.5 * period_s * (echo % 2 == 1 ? 2 * n + distance : 2 * n + 2 - distance);
  }
  /// The last wave that has arrived; 0: none yet.
  [[nodiscard]] int at(double time_s) const noexcept {
    int echo = 2 * std::max(0, static_cast<int>((time_s - release_s) / period_s) - 1);
    while (arrival_s(echo + 1) <= time_s) ++echo;
    return time_s < arrival_s(1) ? 0 : echo;
  }
};

struct mismatch_map {
  struct channel {
    std::vector<double> time_s{};  ///< edges of the rows
    std::vector<int> echo{};       ///< the wave that begins each row; 0: what comes before any
    Eigen::MatrixXd over_noise{};  ///< (row, octave)
  };
  std::vector<double> band_Hz{};  ///< edges of the columns; the first is 0
  std::array<channel, 2> channels{};
};

namespace detail {

/// Octaves down from `highest_Hz`, the lowest at or above the pitch, and what is below.
[[nodiscard]] inline std::vector<double> octaves(double lowest_Hz, double highest_Hz) {
  std::vector<double> edges{highest_Hz};
  while (edges.back() / 2 >= lowest_Hz) edges.push_back(edges.back() / 2);
  edges.push_back(0);
  std::reverse(edges.begin(), edges.end());
  return edges;
}

/// Rows from the first sample to the last: each arrival by itself for eight periods, then twice as many together each time.
[[nodiscard]] inline mismatch_map::channel rows_of(const echo_times& when, double begin_s, double end_s) {
  constexpr int one_by_one = 16;
  mismatch_map::channel out;
  out.time_s.push_back(begin_s), out.echo.push_back(when.at(begin_s));
  for (int echo = when.at(begin_s) + 1, step = 1; when.arrival_s(echo) < end_s; echo += step) {
    out.time_s.push_back(when.arrival_s(echo)), out.echo.push_back(echo);
    if (echo > one_by_one) step = echo - 1;
  }
  out.time_s.push_back(end_s);
  return out;
}

/// A series, zeros behind it, in one octave after the other.
class octave_filter {
public:
  template <class = void>
  octave_filter(const Eigen::VectorXd& x, double rate_Hz) : rate_Hz_{rate_Hz}, fft_{2 * static_cast<std::size_t>(x.size())} {
    std::vector<double> padded(fft_.size(), 0.0);
    std::copy(x.begin(), x.end(), padded.begin());
    bins_.resize(padded.size() / 2 + 1);
    fft_.forward(padded.data(), bins_.data());
  }
  /// `share`: of the power of white noise that `limits` lets through here.
  template <class = void>
  [[nodiscard]] std::vector<double> between(double low_Hz, double high_Hz, const band& limits, double& share) {
    std::vector<std::complex<double>> some(bins_.size());
    share = 0;
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      const double f = rate_Hz_ * static_cast<double>(k) / static_cast<double>(fft_.size());
      if (f < low_Hz || f >= high_Hz) continue;
      some[k] = bins_[k];
      share += limits(f) * limits(f) / static_cast<double>(bins_.size());
    }
    std::vector<double> out(fft_.size());
    fft_.inverse(some.data(), out.data());
    return out;
  }

private:
  double rate_Hz_;
  eigen_fft<double> fft_;
  std::vector<std::complex<double>> bins_;
};

}  // namespace detail

/// `residual_N`: from `begin_s` on, of both channels, seen through `limits`; `noise_N`: of a sample before that, white.
template <class Real = double>
[[nodiscard]] mismatch_map map_of(const std::array<Eigen::VectorXd, 2>& residual_N, double begin_s, double rate_Hz,
                                  const std::array<echo_times, 2>& when, const band& limits,
                                  const std::array<double, 2>& noise_N) {
  mismatch_map out{detail::octaves(1 / when[0].period_s, limits.pass_Hz), {}};
  for (std::size_t c = 0; c < 2; ++c) {
    const Eigen::VectorX<Real>& r = residual_N[c];
    if (r.size() < 2) continue;
    auto& channel = out.channels[c] = detail::rows_of(when[c], begin_s, begin_s + static_cast<double>(r.size()) / rate_Hz);
    channel.over_noise.resize(static_cast<Eigen::Index>(channel.echo.size()), static_cast<Eigen::Index>(out.band_Hz.size() - 1));
    const auto sample_at = [&](double t) {
      return static_cast<std::size_t>(std::clamp(std::ceil((t - begin_s) * rate_Hz - 1e-9), 0.0, static_cast<double>(r.size())));
    };
    detail::octave_filter octaves(r, rate_Hz);
    for (std::size_t b = 0; b + 1 < out.band_Hz.size(); ++b) {
      double share = 0;
      const auto part = octaves.between(out.band_Hz[b], out.band_Hz[b + 1], limits, share);
      for (std::size_t row = 0; row < channel.echo.size(); ++row) {
        const std::size_t from = sample_at(channel.time_s[row]), to = sample_at(channel.time_s[row + 1]);
        double power = 0;
        for (std::size_t i = from; i < to; ++i) power += part[i] * part[i];
        const double expected = noise_N[c] * noise_N[c] * share * static_cast<double>(to - from);
        channel.over_noise(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(b)) =
            expected > 0 ? std::sqrt(power / expected) : 0;
      }
    }
  }
  return out;
}
ROSIN_INSTANTIATE(mismatch_map map_of(const std::array<Eigen::VectorXd, 2>&, double, double, const std::array<echo_times, 2>&,
                                      const band&, const std::array<double, 2>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
