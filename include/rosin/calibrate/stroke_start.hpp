// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a fit of strokes begins with: records that can be used at all, the pitch by which they are like themselves one, four and
// sixteen periods later, and the places where their takes were declared. A bowed string plays as much as a per cent flat, and a
// raucous one has no period: so the pitch heard only replaces the declared one where most takes agree on it, and the fit looks at the
// first partials first.
//
#pragma once

#include <rosin/calibrate/pluck_start.hpp>
#include <rosin/calibrate/stroke_layout.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/outcome.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The first thing about a take that no fit can use; empty if nothing.
[[nodiscard]] inline std::string problem_with(const stroke_take& take, double fundamental_Hz) {
  const auto& [near, far] = take.force_N;
  constexpr double fewest_periods = 30;
  if (!(take.rate_Hz > 0)) return take.name + ": the sampling rate must be above 0";
  if (near.size() != far.size())
    return take.name + ": near has " + std::to_string(near.size()) + " samples, far " + std::to_string(far.size());
  if (static_cast<double>(near.size()) < fewest_periods * take.rate_Hz / fundamental_Hz)
    return take.name + ": shorter than 30 periods of the declared string";
  if (!(take.position > 0 && take.position < 1)) return take.name + ": the contact must lie between the ends";
  for (const auto* channel : {&near, &far}) {
    const std::string name = channel == &near ? "near" : "far";
    double least = channel->front(), most = least;
    for (std::size_t i = 0; i < channel->size(); ++i) {
      if (!std::isfinite((*channel)[i])) return take.name + ": " + name + ", sample " + std::to_string(i) + " is not a number";
      least = std::min(least, (*channel)[i]), most = std::max(most, (*channel)[i]);
    }
    if (!(most > least)) return take.name + ": " + name + " is constant";
  }
  return {};
}

/// By likeness of the middle of the record; 0: nothing like it.
[[nodiscard]] inline double heard_pitch_Hz(const stroke_take& take, const stroke_guess& guess) {
  const double period = take.rate_Hz / guess.fundamental_Hz, wide = std::max(0.03, 2 * guess.fundamental_tolerance);
  double lag = 0;
  for (const int periods : {1, 4, 16}) {
    const double centre = lag > 0 ? periods * lag : period, range = lag > 0 ? 0.1 * lag : wide * period;
    const double found = likest_lag(take.force_N[0], take.force_N[0].size() / 3, centre - range, centre + range);
    if (found > 0) lag = found / periods;
  }
  return lag > 0 ? take.rate_Hz / lag : 0;
}

}  // namespace detail

/// The pitch to begin with: what most takes have, within half a per cent of each other; else the declared one.
[[nodiscard]] inline double starting_pitch_Hz(const std::vector<stroke_take>& takes, const stroke_guess& guess) {
  std::vector<double> heard;
  for (const stroke_take& take : takes)
    if (const double f = detail::heard_pitch_Hz(take, guess); f > 0) heard.push_back(f);
  if (heard.empty()) return guess.fundamental_Hz;
  std::sort(heard.begin(), heard.end());
  const double middle = heard[heard.size() / 2];
  std::size_t near = 0;
  for (const double f : heard) near += std::abs(f / middle - 1) < 0.005 ? 1U : 0U;
  const bool agreed = 2 * near > takes.size();
  return agreed && std::abs(middle / guess.fundamental_Hz - 1) > 0.01 ? middle : guess.fundamental_Hz;
}

/// Every reason not to begin; empty if there is none.
[[nodiscard]] inline std::string problem_with(const std::vector<stroke_take>& takes, const stroke_guess& guess) {
  if (takes.empty()) return "no stroke to fit";
  if (!(guess.fundamental_Hz > 0)) return "strokes: the declared pitch must be above 0";
  for (const stroke_take& take : takes)
    if (const std::string why = detail::problem_with(take, guess.fundamental_Hz); !why.empty()) return why;
  return {};
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
