// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke of a string that its own motion stretches. The tension T (1 + e) is the same all along it,
//
//     e(t) = EA / (2 L T) integral y'^2 dx,    y'(x) = [F(t + x / c) + F(t - x / c)] / 2 T    on either side of the bow
//
// from the force F on that side's end (Kirchhoff; Carrier 1945). Waves run faster by sqrt(1 + e), so that on a clock that does, too,
//
//     d theta = sqrt(1 + e) dt,
//
// the string is one whose tension is even: with y = (1 + e)^(-1/4) w the wave equation is that of w at rest, but for terms in the
// second derivative of e, and forces are those of w times (1 + e)^(3/4), velocities times (1 + e)^(1/4). A reconstruction that knows
// a steady string then reads forces on that clock, and what it finds is read back.
//
#pragma once

#include <rosin/condition/record_at.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// e(t) of a stroke of a string between rigid ends: forces in newtons, delays from either end to the bow; E A and T in newtons.
[[nodiscard]] inline std::vector<double> stretch_by_motion(const std::array<std::vector<double>, 2>& force_N,
                                                           const std::array<double, 2>& delay_s, double rate_Hz, double tension_N,
                                                           double axial_stiffness_N) {
  std::vector<double> e(force_N[0].size(), 0.0);
  const auto last = static_cast<std::ptrdiff_t>(e.size()) - 1;
  const double scale = axial_stiffness_N / (8 * std::pow(tension_N, 3) * (delay_s[0] + delay_s[1]) * rate_Hz);
  for (std::size_t end = 0; end < 2; ++end) {
    const auto& F = force_N[end];
    const auto at = [&](std::ptrdiff_t i) { return F[static_cast<std::size_t>(std::clamp(i, std::ptrdiff_t{0}, last))]; };
    const double reach = delay_s[end] * rate_Hz;
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
      double sum = 0, before = 4 * at(i) * at(i);
      for (std::ptrdiff_t s = 1; static_cast<double>(s) < reach + 1; ++s) {  // trapezoids; of the last one a part
        const double both = at(i + s) + at(i - s), now = both * both, part = std::min(1.0, reach - static_cast<double>(s - 1));
        sum += part * (before + part * (now - before) / 2);
        before = now;
      }
      e[static_cast<std::size_t>(i)] += scale * sum;
    }
  }
  return e;
}

/// Between a record's time and a clock that runs as the waves do, whose mean rate is the record's. The string is then as
/// its mean tension has it.
class wave_clock {
public:
  /// e(t), sample by sample.
  explicit wave_clock(const std::vector<double>& stretch) : raised_(stretch.size()), ahead_(stretch.size()) {
    double sum = 0, ahead = 0;
    for (const double e : stretch) sum += std::sqrt(1 + e);
    if (!stretch.empty()) mean_ = sum / static_cast<double>(stretch.size());
    for (std::size_t i = 0; i < stretch.size(); ++i) {
      const double rate = std::sqrt(1 + stretch[i]) / mean_;
      ahead += (rate - 1) / 2, ahead_[i] = ahead, ahead += (rate - 1) / 2;
      raised_[i] = rate * rate;
    }
  }

  /// Tension at which waves take as long as they do in the mean, over that at rest, less 1.
  [[nodiscard]] double mean_stretch() const noexcept { return mean_ * mean_ - 1; }

  /// Forces on the ends, as they would be at the mean tension.
  [[nodiscard]] std::vector<double> even(const std::vector<double>& force_N) const {
    std::vector<double> x = force_N;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] *= std::pow(raised_[i], -0.75);
    return record_at(x, [&](std::size_t k) {  // t + ahead(t) = k
      double t = static_cast<double>(k);
      for (int pass = 0; pass < 3; ++pass) t = static_cast<double>(k) - ahead_at(t);
      return t;
    });
  }
  /// What was reconstructed from them, in the record's time; known a little less far.
  void read_back(bow_motion<double>& m) const {
    constexpr double reach = 25;  // of what reads between samples
    double most = 0;
    for (const double a : ahead_) most = std::max(most, std::abs(a));
    const auto margin = static_cast<std::size_t>(reach + most);
    const sample_range was = m.known;
    m.known = {was.begin + margin, std::max(was.begin + margin, was.end - std::min(was.end, margin))};
    const auto back = [&](std::vector<double>& x, double power) {
      std::fill(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(was.begin), 0.0);
      std::fill(x.begin() + static_cast<std::ptrdiff_t>(was.end), x.end(), 0.0);
      x = record_at(x, [&](std::size_t i) { return static_cast<double>(i) + ahead_[i]; });
      for (std::size_t i = 0; i < x.size(); ++i)
        x[i] *= m.known.begin <= i && i < m.known.end ? std::pow(raised_[i], power) : std::numeric_limits<double>::quiet_NaN();
    };
    for (auto* f : {&m.force_near_N, &m.force_far_N}) back(*f, 0.75);
    for (auto* v : {&m.velocity_near_m_s, &m.velocity_far_m_s}) back(*v, 0.25);
  }

private:
  [[nodiscard]] double ahead_at(double t) const {
    const double at = std::clamp(t, 0.0, static_cast<double>(ahead_.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(at), ahead_.size() - 1), next = std::min(i + 1, ahead_.size() - 1);
    const double part = at - static_cast<double>(i);
    return (1 - part) * ahead_[i] + part * ahead_[next];
  }

  double mean_ = 1;                     ///< waves' speed over that at rest
  std::vector<double> raised_, ahead_;  ///< tension over its mean, nearly; theta - t, in samples
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
