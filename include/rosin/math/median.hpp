// tier: hosted
// SPDX-License-Identifier: MIT
//
// The median: of an even number of values the mean of the middle two, of none 0.
//
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <span>

namespace rosin {

[[nodiscard]] inline double median_of(Eigen::VectorXd v) {
  std::sort(v.begin(), v.end());
  const Eigen::Index n = v.size();
  return n == 0 ? 0.0 : n % 2 == 1 ? v[n / 2] : (v[n / 2 - 1] + v[n / 2]) / 2;
}
template <class Real = double>
[[nodiscard]] double median_of(std::span<const double> v) {
  return median_of(Eigen::VectorX<Real>(Eigen::VectorX<Real>::Map(v.data(), static_cast<Eigen::Index>(v.size()))));
}

}  // namespace rosin
