// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/sensitivity.hpp>

#include <doctest/doctest.h>

#include <cmath>

namespace reconstruct_sensitivity {

TEST_CASE("sensitivities are the differences of whole reconstructions") {
  constexpr double rate_Hz = 128e3;
  const rosin::band limits{20e3, 45e3};
  rosin::calibration c;
  c.at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {800, 1e-8, 0}}, 0.3);
  std::vector<double> near(3000), far(3000);
  for (std::size_t i = 0; i < near.size(); ++i) {
    near[i] = std::sin(0.05 * static_cast<double>(i)) + std::sin(0.3 * static_cast<double>(i));
    far[i] = std::cos(0.07 * static_cast<double>(i)) - std::sin(0.4 * static_cast<double>(i));
  }
  const rosin::reconstruction_sensitivity s = rosin::sensitivity(c, near, far, limits, rate_Hz);
  const std::array<Eigen::Index, 3> some{0, 1, 5};
  const Eigen::MatrixXd alone = rosin::difference_sensitivity<rosin::full_physics>(c, {near, far}, limits, rate_Hz, some);
  for (Eigen::Index k = 0; k < 3; ++k)
    CHECK((alone.col(k) - s.difference.col(some[static_cast<std::size_t>(k)])).norm() < 1e-12 * alone.col(k).norm());
  rosin::waveform_vector step;
  step << 3e-9, 3e-9, 1e-15, 1e-6, 1e-11, 1e-4;
  for (int p = 0; p < rosin::waveform_parameters; ++p) {
    CAPTURE(p);
    rosin::waveform_vector by = rosin::waveform_vector::Zero();
    by[p] = step[p];
    const auto run = [&](const rosin::calibration& with) {
      std::vector<double> a = near, b = far;
      for (double& x : a) x /= with.gain[0];
      for (double& x : b) x /= with.gain[1];
      return rosin::reconstructor<double>(with.at, limits, rate_Hz, 1e-7)(a, b);
    };
    const auto above = run(c.moved(by)), below = run(c.moved(-by));
    double worst = 0, largest = 0, worst_v = 0, largest_v = 0;
    for (std::size_t i = 600; i < 2400; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double difference = (above.force_N(i) - below.force_N(i)) / (2 * step[p]);
      const double of_velocity = (above.velocity_m_s(i) - below.velocity_m_s(i)) / (2 * step[p]);
      worst = std::max(worst, std::abs(difference - s.force(row, p)));
      largest = std::max(largest, std::abs(difference));
      worst_v = std::max(worst_v, std::abs(of_velocity - s.velocity(row, p)));
      largest_v = std::max(largest_v, std::abs(of_velocity));
    }
    CHECK(worst < 0.02 * largest);
    CHECK(worst_v < 0.02 * largest_v);
  }
}

}  // namespace reconstruct_sensitivity
