// SPDX-License-Identifier: MIT
#include "compare_columns.hpp"

#include <rosin/condition/low_pass.hpp>
#include <rosin/reconstruct/consistency.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace tool {

namespace {

struct stretch {
  std::size_t begin = 0, end = 0;
};

bool known(std::span<const double> a, std::span<const double> b, std::size_t i) {
  return std::isfinite(a[i]) && std::isfinite(b[i]);
}

/// From the first to the last row in which both columns hold a value.
stretch known_in_both(std::span<const double> a, std::span<const double> b) {
  stretch out{0, a.size()};
  while (out.begin < out.end && !known(a, b, out.begin)) ++out.begin;
  while (out.end > out.begin && !known(a, b, out.end - 1)) --out.end;
  return out;
}

}  // namespace

std::optional<std::size_t> gap_between(const std::vector<double>& a, const std::vector<double>& b) {
  const auto [begin, end] = known_in_both(a, b);
  for (std::size_t i = begin; i < end; ++i)
    if (!known(a, b, i)) return i;
  return std::nullopt;
}

rosin::band compared_band(double rate_Hz, std::optional<double> pass_Hz, std::optional<double> stop_Hz) {
  const double pass = pass_Hz.value_or(std::min(20000.0, 0.3 * rate_Hz));
  return {pass, stop_Hz.value_or(std::min(1.5 * pass, (pass + rate_Hz / 2) / 2))};
}

compared compare_columns(const std::string& name, const std::vector<double>& result, const std::vector<double>& truth,
                         double rate_Hz, const rosin::band& window) {
  const auto known = known_in_both(result, truth);
  const auto margin = static_cast<std::size_t>(std::ceil(4 * rate_Hz / (window.stop_Hz - window.pass_Hz)));
  if (known.end - known.begin < 4 * margin || gap_between(result, truth)) return {.name = name};
  const auto within = [&](const std::vector<double>& x) {
    const auto filtered = rosin::low_pass<double>(std::span{x}.subspan(known.begin, known.end - known.begin), rate_Hz, window);
    std::vector<double> kept(filtered.begin() + static_cast<std::ptrdiff_t>(margin),
                             filtered.end() - static_cast<std::ptrdiff_t>(margin));
    const double mean = std::accumulate(kept.begin(), kept.end(), 0.0) / static_cast<double>(kept.size());
    for (double& value : kept) value -= mean;
    return kept;
  };
  auto r = within(result);
  const auto t = within(truth);
  compared out{.name = name, .delta = rosin::consistency_delta(r, t)};
  double rt = 0, tt = 0, ee = 0;
  for (std::size_t i = 0; i < t.size(); ++i) rt += r[i] * t[i], tt += t[i] * t[i];
  if (rt > 0 && tt > 0) out.scale = rt / tt;
  for (std::size_t i = 0; i < t.size(); ++i) {
    r[i] /= out.scale;
    ee += (r[i] - t[i]) * (r[i] - t[i]);
    out.worst = std::max(out.worst, std::abs(r[i] - t[i]));
  }
  out.delta_scaled = rosin::consistency_delta(r, t);
  out.rms_truth = std::sqrt(tt / static_cast<double>(t.size()));
  out.rms_error = std::sqrt(ee / static_cast<double>(t.size()));
  return out;
}

}  // namespace tool
