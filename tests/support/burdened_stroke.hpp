// SPDX-License-Identifier: MIT
//
// A stroke of a burdened string that is stepped mode by mode, and how far a reconstruction is from what happened in it.
#pragma once

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/modal_decimator.hpp>

namespace test {

struct burdened_stroke {
  static constexpr double rate_Hz = 128000, position = 0.3;
  static constexpr rosin::band limits{18e3, 22e3};

  std::array<std::vector<double>, 2> end_N;
  std::vector<double> force_N, centre_m_s;

  burdened_stroke(const rosin::modal_rig& rig, const rosin::string_burden& burden, double speed_m_s = 0.2) {
    constexpr int oversampling = 8;
    constexpr double step = 1 / rate_Hz / oversampling;
    const rosin::velocity_curve<rosin::two_exponential_curve<double>> law{{0.38, 0.02, 0.42, 0.14, 0.35}};
    const auto steps =
        rosin::step_stroke(rig, burden, law, rosin::steady_rod{.speed_m_s = speed_m_s, .normal_force_N = 1.5 * speed_m_s}, {},
                           position, 0, 0.06, 200e3, step);
    const rosin::modal_decimator decimate{rosin::modal_settings{}.low_pass(), step, oversampling};
    end_N = {decimate.points(steps.end_N[0]), decimate.points(steps.end_N[1])};
    force_N = decimate.points(steps.force_N), centre_m_s = decimate.points(steps.centre_m_s);
  }

  /// rms difference of force and of velocity from the truth, relative.
  [[nodiscard]] std::array<double, 2> errors_of(const rosin::bow_motion<double>& motion) const {
    const auto kernel = rosin::shortest_fir([](double) { return 1.0; }, limits, rate_Hz, -300, 300, 1e-6);
    const auto smooth = [&](const std::vector<double>& x, std::size_t i) {
      double sum = 0;
      for (int k = kernel.first; k <= kernel.last(); ++k)
        sum += kernel.taps[static_cast<std::size_t>(k - kernel.first)] * x[i - static_cast<std::size_t>(k + 1000) + 1000];
      return sum;
    };
    std::array<double, 2> off{}, all{};
    for (std::size_t i = motion.known.begin + 1500; i + 1500 < motion.known.end; ++i) {
      const double f = smooth(force_N, i), v = smooth(centre_m_s, i);
      off[0] += std::pow(motion.force_N(i) - f, 2), all[0] += f * f;
      off[1] += std::pow(motion.velocity_m_s(i) - v, 2), all[1] += v * v;
    }
    return {std::sqrt(off[0] / all[0]), std::sqrt(off[1] / all[1])};
  }
};

}  // namespace test
