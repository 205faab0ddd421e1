// tier: hosted
// SPDX-License-Identifier: MIT
//
// A termination that moves, for waves: of a wave s that leaves for it (as it would come back from a rigid end, but for its sign),
//
//     x = 2 s / (1 + z),     back: x - s = s (1 - z) / (1 + z),     force on the end / force on a rigid one: x / (2 s),     z = Z Y,
//
// one step at a time. Each mode of z becomes a section of two poles by the bilinear transformation: what takes energy still does
// (a positive real z stays so), and no loop gains by it. Its frequency, its height there and its compliance far below are exact:
// modes near the rate's limit often stand for a spring. Stiffness is left out of Z here: K z of the wave, small where z is large.
//
#pragma once

#include <rosin/propagate/termination.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace rosin {

/// The first thing about an end that cannot be simulated at this rate; empty if nothing.
[[nodiscard]] inline std::string problem_with(const modal_termination& end, double rate_Hz) {
  for (const auto& m : end.modes) {
    if (!(m.frequency_Hz > 0 && m.q > 0 && m.per_mass_per_s >= 0))
      return "termination: frequency and Q must be above 0, and no mass negative";
    if (!(m.frequency_Hz < 0.4 * rate_Hz)) return "termination: a mode lies above what the rate of the waves can hold";
  }
  return {};
}

class wave_end {
public:
  wave_end() = default;  ///< rigid
  wave_end(const modal_termination& end, double rate_Hz) {
    for (const auto& m : end.modes) {
      const double c = 2 * rate_Hz, straight = 2 * std::numbers::pi * m.frequency_Hz, w = c * std::tan(straight / c),
                   bent = w / straight;
      const double resists = w * c * bent / m.q, norm = c * c + resists + w * w;
      sections_.push_back(
          {m.per_mass_per_s * bent * bent * c / norm, 2 * (w * w - c * c) / norm, (c * c - resists + w * w) / norm});
      at_once_ += sections_.back().b;
    }
  }

  [[nodiscard]] bool moves() const noexcept { return !sections_.empty(); }

  struct answer {
    double back, heard;  ///< wave that comes back; half of x: the wave that would make the same force on a rigid end
  };
  answer operator()(double s) noexcept {
    double held = 0;
    for (const auto& m : sections_) held += m.first;
    const double x = (2 * s - held) / (1 + at_once_);
    for (auto& m : sections_) {
      const double y = m.b * x + m.first;
      m.first = m.second - m.a1 * y;
      m.second = -m.b * x - m.a2 * y;
    }
    return {x - s, x / 2};
  }

private:
  struct section {  // b (1 - q^2) / (1 + a1 q + a2 q^2), q = 1 / z
    double b, a1, a2, first = 0, second = 0;
  };
  std::vector<section> sections_;
  double at_once_ = 0;
};

}  // namespace rosin
