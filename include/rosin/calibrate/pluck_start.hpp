// tier: hosted
// SPDX-License-Identifier: MIT
//
// First guesses for the fit of plucks: pitch from the signal's likeness to itself one, four and sixteen periods later;
// instant of release and position from the moments at which the force steps through its middle at either end,
//
//     t_near = t0 + p / (2 f0),   t_far = t0 + (1 - p) / (2 f0).
//
#pragma once

#include <rosin/calibrate/pluck_layout.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/number_text.hpp>

#include <numeric>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Starting values: the common pitch; per take release and position.
struct pluck_start {
  double fundamental_Hz = 0;
  std::vector<double> release_s, position;
};

namespace detail {

/// Fraction of a sample from a parabola through three values around a maximum.
inline double vertex(double before, double at, double after) {
  const double bend = before - 2 * at + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0.0;
}

/// Lag in [first, last] at which x, from `begin` on, is most like itself.
inline double likest_lag(const std::vector<double>& x, std::size_t begin, double first, double last) {
  const auto from = static_cast<std::size_t>(std::max(1.0, first)), to = static_cast<std::size_t>(last) + 1;
  if (begin + 2 * to + 2 > x.size()) return 0;
  const std::size_t count = std::min<std::size_t>(x.size() - begin - to - 1, 20000);
  const double mean =
      std::accumulate(x.begin() + static_cast<std::ptrdiff_t>(begin), x.end(), 0.0) / static_cast<double>(x.size() - begin);
  const auto likeness = [&](std::size_t lag) {
    double sum = 0, power = 0;
    for (std::size_t i = begin; i < begin + count; ++i) {
      sum += (x[i] - mean) * (x[i + lag] - mean);
      power += (x[i + lag] - mean) * (x[i + lag] - mean);
    }
    return power > 0 ? sum / std::sqrt(power) : 0.0;
  };
  std::vector<double> value;
  for (std::size_t lag = from - 1; lag <= to + 1; ++lag) value.push_back(likeness(lag));
  const auto best = static_cast<std::size_t>(std::max_element(value.begin() + 1, value.end() - 1) - value.begin());
  return static_cast<double>(from - 1 + best) + vertex(value[best - 1], value[best], value[best + 1]);
}

/// The instant (in samples) at which a signal first falls by half of `drop` below its level in the beginning; or, where it has come
/// down slowly until then, as a high-pass lets the force of a wire that still holds, below what it was a little before.
struct first_step {
  double crosses = 0;
  bool found = false;
};
inline first_step find_step(const std::vector<double>& x, double drop, double period) {
  const auto reach = std::max<std::size_t>(4, static_cast<std::size_t>(0.12 * period));
  if (x.size() < 3 * reach) return {};
  const auto mean_of = [&](std::size_t from) {
    const auto first = x.begin() + static_cast<std::ptrdiff_t>(from);
    return std::accumulate(first, first + static_cast<std::ptrdiff_t>(reach), 0.0) / static_cast<double>(reach);
  };
  const double in_the_beginning = mean_of(0);
  double before = in_the_beginning;  // mean of `reach` samples, as many before this one
  bool slowly = false;
  for (std::size_t i = reach; i + 1 < x.size(); ++i) {
    if (i > 2 * reach) before += (x[i - reach - 1] - x[i - 2 * reach - 1]) / static_cast<double>(reach);
    const double level = slowly ? before : in_the_beginning, a = level - x[i] - drop / 2, b = level - x[i + 1] - drop / 2;
    if (!(a < 0 && b >= 0)) continue;
    slowly = slowly || before < in_the_beginning - drop / 4;
    if (before - x[i + 1] >= drop / 4) return {static_cast<double>(i) + a / (a - b), true};
  }
  return {};
}

}  // namespace detail

/// Finds pitch, releases and positions. Fails where a take is too short, silent or has no release.
[[nodiscard]] inline outcome<pluck_start> find_start(const std::vector<pluck_take>& takes, const pluck_guess& guess) {
  if (takes.empty()) return failure{"no pluck to fit"};
  pluck_start start;
  std::vector<double> pitches;
  for (const pluck_take& take : takes) {
    const double period = take.rate_Hz / guess.fundamental_Hz;
    const auto& [near, far] = take.force_N;
    if (near.size() != far.size() || static_cast<double>(near.size()) < 8 * period)
      return failure{take.name + ": shorter than eight periods of the declared string"};
    for (const auto* channel : {&near, &far})
      for (std::size_t i = 0; i < channel->size(); ++i)
        if (!std::isfinite((*channel)[i]))
          return failure{take.name + ": " + (channel == &near ? "near" : "far") + ", sample " + std::to_string(i) +
                         " is not a number"};
    const auto one = detail::find_step(near, take.strength_N, period), two = detail::find_step(far, take.strength_N, period);
    if (!one.found || !two.found)
      return failure{take.name + ": no release found in channel " + (one.found ? "far" : "near") +
                     ": the force never falls by half of the declared " + number_text(take.strength_N) + " N"};
    const auto begin = static_cast<std::size_t>(std::max(one.crosses, two.crosses));
    double lag = 0;
    for (int periods : {1, 4, 16}) {
      const double centre = lag > 0 ? periods * lag : period, range = lag > 0 ? 0.3 * lag : 0.06 * period;
      const double found = detail::likest_lag(near, begin, centre - range, centre + range);
      if (found > 0) lag = found / periods;
    }
    pitches.push_back(lag > 0 ? take.rate_Hz / lag : guess.fundamental_Hz);
    start.release_s.push_back(0.5 * (one.crosses + two.crosses) / take.rate_Hz);  // less 1/(4 f0), below
    start.position.push_back((two.crosses - one.crosses) / take.rate_Hz);
  }
  std::nth_element(pitches.begin(), pitches.begin() + static_cast<std::ptrdiff_t>(pitches.size() / 2), pitches.end());
  start.fundamental_Hz = pitches[pitches.size() / 2];
  for (std::size_t i = 0; i < takes.size(); ++i) {
    start.release_s[i] -= 0.25 / start.fundamental_Hz;
    const double p = 0.5 - start.position[i] * start.fundamental_Hz;
    start.position[i] = std::clamp(p, std::max(0.005, takes[i].position - 0.04), std::min(0.995, takes[i].position + 0.04));
  }
  return start;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
