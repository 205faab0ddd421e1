// tier: hosted
// SPDX-License-Identifier: MIT
//
// From the simulation's own steps to samples, through the one low-pass h(t). What is known at the steps and hardly
// changes in between (motion of the modes) is summed with h itself. The contact force is a straight line between
// its values at the steps, so the low-passed force is the sum over h convolved with a triangle, exactly, and its
// rate the sum over the derivative of that:
//
//     (h * tri)(t) = int_{-1}^{1} h(t + u T) (1 - |u|) du,      (h * tri)'(t) = int_0^1 [h(t + u T) - h(t - u T)] du / T
//
#pragma once

#include <vector>

#include <Eigen/Core>

#include <rosin/simulate/modal_low_pass.hpp>

namespace rosin {

class modal_decimator {
public:
  template <class = void>
  modal_decimator(const modal_low_pass& filter, double step_s, int steps_per_sample)
      : stride_{steps_per_sample}, reach_{static_cast<Eigen::Index>(filter.half_width_s() / step_s) + 1} {
    for (auto* taps : {&points_, &lines_, &slopes_}) taps->setZero(2 * reach_ + 1);
    for (Eigen::Index i = 0; i <= 2 * reach_; ++i) {
      const double t = static_cast<double>(reach_ - i) * step_s;
      points_[i] = step_s * filter(t);
      for (std::size_t j = 0; j < 4; ++j) {
        const double u = gauss4::node[j], after = filter(t + u * step_s), before = filter(t - u * step_s);
        lines_[i] += step_s * gauss4::weight[j] * (1 - u) * (after + before);
        slopes_[i] += gauss4::weight[j] * (after - before);
      }
    }
  }

  /// Steps before the first and after the last sample that the kernel looks at.
  [[nodiscard]] std::size_t reach() const noexcept { return static_cast<std::size_t>(reach_); }

  /// Each of these takes a signal at all steps, sample n at step reach() + n stride, and returns the samples.
  template <class = void>
  [[nodiscard]] std::vector<double> points(const std::vector<double>& steps) const {
    return run(steps, points_);
  }
  template <class = void>
  [[nodiscard]] std::vector<double> lines(const std::vector<double>& steps) const {
    return run(steps, lines_);
  }
  template <class = void>
  [[nodiscard]] std::vector<double> slopes(const std::vector<double>& steps) const {
    return run(steps, slopes_);
  }

private:
  using pack = Eigen::Array<double, 8, 1>;

  /// Eight partial sums; Eigen's own dot product makes GCC 12 warn of its AVX-512 header.
  template <class = void>
  [[nodiscard]] static double dot(const Eigen::VectorXd& taps, const double* x) noexcept {
    pack sum = pack::Zero();
    Eigen::Index i = 0;
    for (; i + 8 <= taps.size(); i += 8) sum += Eigen::Map<const pack>(taps.data() + i) * Eigen::Map<const pack>(x + i);
    double total = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
    for (; i < taps.size(); ++i) total += taps[i] * x[i];
    return total;
  }

  template <class = void>
  [[nodiscard]] std::vector<double> run(const std::vector<double>& steps, const Eigen::VectorXd& taps) const {
    const auto last = static_cast<Eigen::Index>(steps.size()) - taps.size();
    std::vector<double> samples;
    for (Eigen::Index first = 0; first <= last; first += stride_) samples.push_back(dot(taps, steps.data() + first));
    return samples;
  }

  Eigen::Index stride_, reach_;
  Eigen::VectorXd points_, lines_, slopes_;
};

}  // namespace rosin
