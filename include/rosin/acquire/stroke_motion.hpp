// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the bow did in a stroke, where channels measure it: its speed and the normal force sample by sample, and what follows from
// them. The stroke is steady where the speed is on its plateau and the bow presses; what whoever recorded it called steady (steady_s)
// is taken only as far as that bears it out. A channel of normal force has an offset, as amplifiers have: its level while the bow is
// off the string, where the take shows that, by a level that is clearly lower than that of the stroke.
//
#pragma once

#include <rosin/acquire/recording.hpp>
#include <rosin/acquire/rig_values.hpp>
#include <rosin/core/instantiate.hpp>

#include <algorithm>
#include <span>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct stroke_motion {
  std::string speed_channel, normal_channel;  ///< names; empty where nothing measures it
  std::vector<double> speed_m_s;              ///< of the bow, sample by sample, with its sign; empty where nothing measures it
  std::vector<double> normal_force_N;         ///< as the channel has it, offset included; empty where nothing measures it
  std::optional<nominal> normal_offset_N;     ///< to be taken off normal_force_N; empty where the take does not show it
  double speed_noise_m_s = 0, normal_noise_N = 0;  ///< white, rms, of one sample
  std::size_t steady_begin = 0, steady_end = 0;    ///< samples; equal: nothing is steady
  std::optional<double> steady_speed_m_s;          ///< mean over the steady part
  std::optional<double> steady_normal_force_N;     ///< the same, offset taken off
  bool hint_doubted = false;                       ///< steady_s is off the plateau for more than half of its time

  /// Sample by sample, offset taken off.
  [[nodiscard]] double normal_N(std::size_t i) const noexcept {
    return normal_force_N[i] - (normal_offset_N ? normal_offset_N->value : 0);
  }
};

namespace detail {

/// Means of stretches of a few milliseconds: noise and the string's own period are averaged out.
struct stroke_blocks {
  std::size_t samples = 1;
  std::vector<double> mean;

  stroke_blocks(std::span<const double> x, double rate_Hz)
      : samples{std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(0.005 * rate_Hz)))} {
    for (std::size_t i = 0; i + samples <= x.size(); i += samples) {
      double sum = 0;
      for (std::size_t k = i; k < i + samples; ++k) sum += x[k];
      mean.push_back(sum / static_cast<double>(samples));
    }
  }
};

template <class = void>
[[nodiscard]] double quantile_of(std::vector<double> x, double share) {
  if (x.empty()) return 0;
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(x.size() - 1));
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

/// White noise of one sample: by differences of neighbours, of which most are quiet.
template <class = void>
[[nodiscard]] double quiet_noise(const std::vector<double>& x) {
  std::vector<double> moves;
  for (std::size_t i = 1; i < x.size(); ++i) moves.push_back(std::abs(x[i] - x[i - 1]));
  return quantile_of(std::move(moves), 0.5) / 0.9539;  // sqrt(2) times the median of |normal|
}

/// Level while the bow is off the string, and which blocks those are.
template <class = void>
[[nodiscard]] std::optional<nominal> lifted_level(const stroke_blocks& normal, double noise, double string_noise,
                                                  const stroke_blocks& string) {
  const double low = quantile_of(normal.mean, 0.02), high = quantile_of(normal.mean, 0.8), span = high - low;
  const double block_noise = noise / std::sqrt(static_cast<double>(normal.samples));
  if (!(span > 8 * block_noise) || !(std::abs(low) < 0.3 * high)) return std::nullopt;
  std::vector<double> level;
  double pulls = 0;
  for (std::size_t i = 0; i < normal.mean.size(); ++i)
    if (normal.mean[i] < low + std::max(4 * block_noise, 0.03 * span)) {
      level.push_back(normal.mean[i]);
      if (i < string.mean.size()) pulls += string.mean[i];
    }
  if (level.size() < 3) return std::nullopt;
  const double n = static_cast<double>(level.size());
  if (std::abs(pulls / n) > 0.1 * span + 8 * string_noise) return std::nullopt;  // the string is still dragged along
  const double middle = quantile_of(level, 0.5);
  double spread = 0;
  for (const double x : level) spread += (x - middle) * (x - middle);
  return nominal{middle, std::max(std::sqrt(spread / n), block_noise) / std::sqrt(n)};
}

/// The longest stretch of blocks in which holds(i).
template <class Holds>
[[nodiscard]] std::pair<std::size_t, std::size_t> longest_run(std::size_t blocks, Holds holds) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  for (std::size_t i = 0, begin = 0; i <= blocks; ++i)
    if (i == blocks || !holds(i)) {
      if (i - begin > best.second - best.first) best = {begin, i};
      begin = i + 1;
    }
  return best;
}

template <class = void>
void find_steady(stroke_motion& out, const take& t, double rate_Hz, const stroke_blocks& speed, const stroke_blocks& normal) {
  const std::size_t blocks = speed.mean.empty() ? normal.mean.size() : speed.mean.size();
  std::vector<double> size;
  for (const double v : speed.mean) size.push_back(std::abs(v));
  const double plateau = quantile_of(size, 0.8),
               off = 0.05 * plateau + 4 * out.speed_noise_m_s / std::sqrt(static_cast<double>(speed.samples));
  const double zero = out.normal_offset_N ? out.normal_offset_N->value : 0, press = quantile_of(normal.mean, 0.8) - zero;
  const auto [begin, end] = longest_run(blocks, [&](std::size_t i) {
    const bool moves = speed.mean.empty() || std::abs(size[i] - plateau) <= off;
    return moves && (normal.mean.empty() || !(press > 0) || normal.mean[i] - zero > 0.5 * press);
  });
  out.steady_begin = begin * speed.samples, out.steady_end = end * speed.samples;
  if (!t.steady_s) return;
  const auto frame = [&](double time_s) { return static_cast<std::size_t>(std::lround(time_s * rate_Hz)); };
  const std::size_t from = std::max(out.steady_begin, frame(t.steady_s->first)),
                    to = std::min(out.steady_end, frame(t.steady_s->second));
  const double shared = to > from ? static_cast<double>(to - from) / rate_Hz : 0;
  out.hint_doubted = shared < 0.5 * (t.steady_s->second - t.steady_s->first);
  if (!out.hint_doubted) out.steady_begin = from, out.steady_end = to;
}

[[nodiscard]] inline std::optional<double> mean_between(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  if (x.empty() || end <= begin) return std::nullopt;
  double sum = 0;
  for (std::size_t i = begin; i < end; ++i) sum += x[i];
  return sum / static_cast<double>(end - begin);
}

[[nodiscard]] inline const take_signal* measured(const take_signals& from, quantity what) noexcept {
  for (const auto& s : from.signals)
    if (s.sensor.quantity == what && s.sensor.per_full_scale) return &s;
  return nullptr;
}

}  // namespace detail

/// Precondition: every sample is finite.
template <class = void>
[[nodiscard]] stroke_motion motion_of(const take& t, const take_signals& from) {
  stroke_motion out;
  const auto* speed = detail::measured(from, quantity::bow_speed);
  const auto* normal = detail::measured(from, quantity::normal_force);
  if (speed == nullptr && normal == nullptr) return out;
  if (speed != nullptr) out.speed_m_s = speed->values, out.speed_channel = speed->sensor.name;
  if (normal != nullptr) out.normal_force_N = normal->values, out.normal_channel = normal->sensor.name;
  const double rate = from.sample_rate_Hz;
  out.speed_noise_m_s = detail::quiet_noise(out.speed_m_s), out.normal_noise_N = detail::quiet_noise(out.normal_force_N);
  const detail::stroke_blocks speeds{out.speed_m_s, rate}, normals{out.normal_force_N, rate};
  std::vector<double> drag;
  for (const char* end : {"near", "far"})
    if (const auto* force = from.find(end)) {
      drag.resize(force->values.size());
      for (std::size_t i = 0; i < drag.size(); ++i) drag[i] += force->values[i];
    }
  if (normal != nullptr)
    out.normal_offset_N = detail::lifted_level(normals, out.normal_noise_N, detail::quiet_noise(drag), {drag, rate});
  detail::find_steady(out, t, rate, speeds, normals);
  out.steady_speed_m_s = detail::mean_between(out.speed_m_s, out.steady_begin, out.steady_end);
  out.steady_normal_force_N = detail::mean_between(out.normal_force_N, out.steady_begin, out.steady_end);
  if (out.steady_normal_force_N && out.normal_offset_N) *out.steady_normal_force_N -= out.normal_offset_N->value;
  return out;
}
ROSIN_INSTANTIATE(stroke_motion motion_of(const take&, const take_signals&))

/// The take with what was measured in the place of what was not declared: magnitudes, over the steady part.
[[nodiscard]] inline take with_measured(take declared, const stroke_motion& moved) {
  if (!declared.speed_m_s && declared.speed_profile_m_s.empty() && moved.steady_speed_m_s)
    declared.speed_m_s = std::abs(*moved.steady_speed_m_s);
  if (!declared.normal_force_N && declared.normal_force_profile_N.empty() && moved.steady_normal_force_N)
    declared.normal_force_N = *moved.steady_normal_force_N;
  return declared;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
