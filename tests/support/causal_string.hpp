// SPDX-License-Identifier: MIT
// A string whose loss is causal, in the frequency domain: no modes, no poles. Its tension is T (s / w0)^(2 g), g = 1 / (pi Q), which
// loses a constant part; a pluck's forces on its ends by a numerical inverse Laplace transform on a shifted line.
#pragma once

#include <rosin/math/fft.hpp>
#include <rosin/propagate/band.hpp>

#include <array>
#include <complex>
#include <numbers>
#include <vector>

namespace test {

struct causal_string {
  double fundamental_Hz = 440, quality = 500;  ///< at the fundamental
  double relaxations_apart =
      0;  ///< ratio of their times, if the tension relaxes by some instead, from a thousandth of the pitch on

  /// c k of the flexible string.
  [[nodiscard]] std::complex<double> phase_rate(std::complex<double> s) const {
    const double w0 = 2 * std::numbers::pi * fundamental_Hz, g = 1 / (std::numbers::pi * quality);
    if (relaxations_apart > 0) {
      const auto relaxed = [&](std::complex<double> x) {
        std::complex<double> sum = 1;
        for (double rate = 1e-3; rate < 1e5; rate *= relaxations_apart)
          sum += 2 * std::log(relaxations_apart) * g * x / (x + rate);
        return sum;
      };
      return s / std::complex<double>(0, 1) * std::sqrt(relaxed({0, 1}).real() / relaxed(s / w0));
    }
    return s / std::complex<double>(0, 1) * std::pow(s / w0, -g) / std::pow(std::complex<double>(0, 1), -g).real();
  }
  /// Forces on the ends for a force at `position`.
  [[nodiscard]] std::array<std::complex<double>, 2> end_forces(std::complex<double> s, double position) const {
    const std::complex<double> q = phase_rate(s) * (0.5 / fundamental_Hz), all = std::sin(q);
    return {std::sin(q * (1 - position)) / all, std::sin(q * position) / all};
  }
  /// Both forces after a pluck of 1 N that lets go at `release_s`, as a record of `count` samples.
  [[nodiscard]] std::array<std::vector<double>, 2> pluck(double position, double release_s, double rate_Hz, std::size_t count,
                                                         const rosin::band& limits) const {
    const std::size_t size = 4 * count;
    const double df = rate_Hz / static_cast<double>(size), sigma = 40 * df;  // what wraps around comes back exp(-30) strong
    rosin::eigen_fft<std::complex<double>> transform(size);
    std::array<std::vector<double>, 2> out;
    for (std::size_t end = 0; end < 2; ++end) {
      std::vector<std::complex<double>> spectrum(size), signal(size);
      for (std::size_t n = 0; n < size / 2 && static_cast<double>(n) * df < limits.stop_Hz; ++n) {
        const std::complex<double> s(sigma, 2 * std::numbers::pi * static_cast<double>(n) * df);
        spectrum[n] = (n == 0 ? 0.5 : 1.0) * limits(static_cast<double>(n) * df) * end_forces(s, position)[end] / s *
                      std::exp(-s * release_s);
      }
      transform.inverse(spectrum.data(), signal.data());  // over `size`
      const double still = end == 0 ? 1 - position : position;
      for (std::size_t i = 0; i < count; ++i)
        out[end].push_back(still - 2 * rate_Hz * (signal[i] * std::exp(sigma * static_cast<double>(i) / rate_Hz)).real());
    }
    return out;
  }
};

}  // namespace test
