// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where a tone that the bow brings in can be told from what the string does by itself. A bowed string repeats itself, so that all
// that a model of its contact leaves has the multiples of its pitch. How long a period is shows in the motion under the bow: the
// lag at which it is most like itself. Friction makes periods longer than those of the free string (the flattening effect), by up
// to a quarter where a stroke is pressed hard.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_stick.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The pitch of one stroke; not `measured`: that of the string at rest, which friction may have flattened.
struct stroke_pitch {
  double pitch_Hz = 0;
  bool measured = false;

  /// Whether a multiple of it, or what may have become of one, is as near to `f_Hz` as `blur_Hz` or a fiftieth.
  [[nodiscard]] bool is_near(double f_Hz, double blur_Hz = 0) const noexcept {
    if (!(pitch_Hz > 0)) return false;
    constexpr double apart = 0.02;
    const auto near = [&](double n) {
      const double own = n * pitch_Hz, flat = measured ? apart : n > 1 ? 0.05 : 0.25;
      return f_Hz > own - std::max(flat * own, blur_Hz) && f_Hz < own + std::max(apart * own, blur_Hz);
    };
    const double below = std::floor(f_Hz / pitch_Hz);
    return near(std::max(1.0, below)) || near(below + 1);
  }
};

/// Where a tone is sought: up to `highest_Hz`, and not where one of the strokes repeats itself. From some multiple on (the 14th, the
/// 25th if measured) these stretches meet.
struct tone_band {
  double highest_Hz = 900;
  std::vector<stroke_pitch> pitches{};

  [[nodiscard]] bool is_its_own(double f_Hz, double blur_Hz = 0) const noexcept {
    return std::any_of(pitches.begin(), pitches.end(), [&](const stroke_pitch& p) { return p.is_near(f_Hz, blur_Hz); });
  }
};

/// The pitch of a motion whose period at rest is `rest_s`, from samples `begin` to `end`: the lag from 0.97 to 1.4 of that period
/// at which it is most like itself. Taken as measured where four fifths of its power repeat.
template <class Real = double>
[[nodiscard]] stroke_pitch pitch_of(std::span<const double> motion, std::size_t begin, std::size_t end, double rate_Hz,
                                    double rest_s) {
  constexpr double least = 0.8;
  const auto first = static_cast<std::size_t>(0.97 * rest_s * rate_Hz),
             last = static_cast<std::size_t>(1.4 * rest_s * rate_Hz) + 1;
  if (first < 2 || end < begin + 4 * last) return {1 / rest_s, false};
  Eigen::VectorX<Real> x = Eigen::Map<const Eigen::VectorX<Real>>(motion.data() + begin, static_cast<Eigen::Index>(end - begin));
  if (!x.allFinite()) return {1 / rest_s, false};
  x.array() -= x.mean();
  const auto likeness = [&](std::size_t lag) {
    const auto n = x.size() - static_cast<Eigen::Index>(lag);
    const auto a = x.head(n), b = x.tail(n);
    return a.dot(b) / std::max(1e-300, std::sqrt(a.squaredNorm() * b.squaredNorm()));
  };
  std::size_t best = first;
  double most = -1;
  for (std::size_t lag = first; lag <= last; ++lag)
    if (const double r = likeness(lag); r > most) most = r, best = lag;
  if (most < least || best == first || best == last) return {1 / rest_s, false};
  const double left = likeness(best - 1), right = likeness(best + 1);
  const double off = 0.5 * (left - right) / std::min(-1e-12, left - 2 * most + right);
  return {rate_Hz / (static_cast<double>(best) + off), true};
}
ROSIN_INSTANTIATE(stroke_pitch pitch_of(std::span<const double>, std::size_t, std::size_t, double, double))

/// The pitches of a bench's strokes.
template <class = void>
[[nodiscard]] std::vector<stroke_pitch> pitches_of(stick_bench& bench) {
  std::vector<stroke_pitch> out;
  for (std::size_t t = 0; t < bench.records().size(); ++t) {
    const auto& r = bench.records()[t];
    out.push_back(
        pitch_of(bench.relative_m_s()[t], r.begin(), r.end(), r.take().rate_Hz, 2 * (r.take().delay_s[0] + r.take().delay_s[1])));
  }
  return out;
}
ROSIN_INSTANTIATE(std::vector<stroke_pitch> pitches_of(stick_bench&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
