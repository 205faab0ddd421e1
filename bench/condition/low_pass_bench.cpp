// SPDX-License-Identifier: MIT
// The low-pass of a whole record: time for ten seconds at 128 kHz, and how far the mirrors at the ends are felt.
#include <rosin/condition/low_pass.hpp>
#include <rosin/propagate/band.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <vector>

namespace bench_low_pass {

namespace {

constexpr double rate_Hz = 128e3;

/// Worst error of tones in the pass band, in any phase, from `distance` samples off the ends.
double end_effect_dB(const rosin::band& limits, std::size_t distance) {
  double worst = 0;
  for (int i = 1; i <= 10; ++i)
    for (int quarter = 0; quarter < 4; ++quarter) {
      std::vector<double> x(8000);
      for (std::size_t n = 0; n < x.size(); ++n)
        x[n] = std::cos(2 * std::numbers::pi * limits.pass_Hz * i / 10 / rate_Hz * static_cast<double>(n) +
                        quarter * std::numbers::pi / 4);
      const std::vector<double> y = rosin::low_pass<double>(x, rate_Hz, limits);
      for (std::size_t n = distance; n + distance < x.size(); ++n) worst = std::max(worst, std::abs(y[n] - x[n]));
    }
  return 20 * std::log10(worst);
}

void low_pass(benchmark::State& state) {
  const rosin::band limits{static_cast<double>(state.range(0)), static_cast<double>(state.range(1))};
  const std::vector<double> x(1280000, 1.0);
  for (auto _ : state) benchmark::DoNotOptimize(rosin::low_pass<double>(x, rate_Hz, limits));
  for (const double periods : {0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {  // of the width of the transition
    const auto distance = static_cast<std::size_t>(std::ceil(periods * rate_Hz / (limits.stop_Hz - limits.pass_Hz)));
    state.counters["dB_" + std::to_string(static_cast<int>(periods))] = end_effect_dB(limits, distance);
  }
}

}  // namespace

BENCHMARK(low_pass)
    ->Name("low_pass/double/pass_stop")
    ->Args({20000, 60000})
    ->Args({10000, 30000})
    ->Args({8000, 12000})
    ->Unit(benchmark::kMillisecond);

}  // namespace bench_low_pass
