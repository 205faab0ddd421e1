// tier: hosted
// SPDX-License-Identifier: MIT
//
// Pitch and inharmonicity from the partials' frequencies, f_n = n f0 sqrt(1 + b n^2): a stiff string between pinned ends.
//
// What supports do to a partial is about the same number of hertz for all (f0 / pi times admittance times impedance); what a
// second polarisation or a glide does is in proportion to n. Both shapes of scatter are tried, the likelier one is kept.
//
#pragma once

#include <rosin/calibrate/pickup_regression.hpp>
#include <rosin/core/instantiate.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Frequency of a partial with its own standard deviation.
struct numbered_frequency {
  int number = 0;
  double frequency_Hz = 0;
  double sd_Hz = 0;
};

/// Mode n of a stiff string between pinned ends.
[[nodiscard]] inline double partial_frequency(double fundamental_Hz, double inharmonicity, double number) {
  return number * fundamental_Hz * std::sqrt(std::max(1 + inharmonicity * number * number, 0.01));
}

namespace detail {

template <class Real = double>
robust_data pitch_data(const std::vector<numbered_frequency>& partials, bool in_proportion) {
  const auto n = static_cast<Eigen::Index>(partials.size());
  robust_data d{Eigen::VectorX<Real>(n), Eigen::VectorX<Real>(n), Eigen::VectorX<Real>::Ones(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& p = partials[static_cast<std::size_t>(i)];
    d.y[i] = p.frequency_Hz;
    d.variance[i] = p.sd_Hz * p.sd_Hz;
    if (in_proportion) d.shape[i] = p.number;
  }
  return d;
}

}  // namespace detail

/// value: f0 (Hz), b. Precondition: at least two partials, f0 > 0 within a per cent or so.
template <class Real = double>
[[nodiscard]] robust_fit fit_pitch(const std::vector<numbered_frequency>& partials, double fundamental_Hz, double inharmonicity) {
  const auto model = [&](const Eigen::VectorX<Real>& theta, Eigen::VectorX<Real>& y, Eigen::MatrixX<Real>& J) {
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      const double n = partials[static_cast<std::size_t>(i)].number;
      y[i] = partial_frequency(theta[0], theta[1], n);
      J(i, 0) = y[i] / theta[0];
      J(i, 1) = n * n * n * n * theta[0] * theta[0] / (2 * y[i]);
    }
  };
  const Eigen::Vector2d start{fundamental_Hz, inharmonicity};
  const robust_fit alike = robust_regression(detail::pitch_data(partials, false), model, start);
  robust_fit scaled = robust_regression(detail::pitch_data(partials, true), model, start);
  scaled.in_proportion = true;
  return scaled.cost < alike.cost ? scaled : alike;
}
ROSIN_INSTANTIATE(robust_fit fit_pitch(const std::vector<numbered_frequency>&, double, double))

/// Standard deviation of the frequency that such a fit foretells for a partial, scatter not included.
template <class = void>
[[nodiscard]] double predicted_sd(const robust_fit& fit, int number) {
  const double f0 = fit.value[0], f = partial_frequency(f0, fit.value[1], number), n2 = double(number) * number;
  const Eigen::Vector2d slope{f / f0, n2 * n2 * f0 * f0 / (2 * f)};
  return std::sqrt(std::max(slope.dot(fit.covariance * slope), 0.0));
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
