// SPDX-License-Identifier: MIT
// Periodic records to other lengths: time, and the worst error against closed-form sums of forty cosines.
#include <rosin/condition/fourier_resampler.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace bench_fourier_resampler {

namespace {

/// Forty cosines below half the sampling rate of `band` samples per period, the highest included.
template <class T>
std::vector<T> cosines(std::size_t n, std::size_t band) {
  std::vector<long double> sum(n);
  for (std::size_t i = 1; i <= 40; ++i) {
    const std::size_t cycles = (band - 1) / 2 * i / 40;
    for (std::size_t j = 0; j < n; ++j)
      sum[j] +=
          std::cos(2 * std::numbers::pi_v<long double> * static_cast<long double>(cycles * j % n) / static_cast<long double>(n) +
                   static_cast<long double>(i * i));
  }
  return {sum.begin(), sum.end()};
}

template <class T>
void resample(benchmark::State& state) {
  const auto from = static_cast<std::size_t>(state.range(0)), to = static_cast<std::size_t>(state.range(1));
  const std::vector<T> in = cosines<T>(from, std::min(from, to)), should = cosines<T>(to, std::min(from, to));
  std::vector<T> out(to);
  rosin::fourier_resampler<T> resampler(from, to);
  for (auto _ : state) {
    resampler.process(in, out);
    benchmark::ClobberMemory();
  }
  double worst = 0, largest = 0;
  for (std::size_t j = 0; j < to; ++j) {
    worst = std::max(worst, static_cast<double>(std::abs(out[j] - should[j])));
    largest = std::max(largest, static_cast<double>(std::abs(should[j])));
  }
  state.counters["error_dB"] = 20 * std::log10(worst / largest);
}

void lengths(benchmark::internal::Benchmark* bench) {
  bench->Args({16384, 12288})
      ->Args({12288, 16384})
      ->Args({17921, 16384})
      ->Args({16384, 17921})
      ->Args({17921, 17923})
      ->Args({99991, 100003})
      ->Args({199999, 131072});
  bench->Unit(benchmark::kMillisecond);
}

}  // namespace

BENCHMARK_TEMPLATE(resample, double)->Name("fourier_resampler/double")->Apply(lengths);
BENCHMARK_TEMPLATE(resample, float)->Name("fourier_resampler/float")->Apply(lengths);

}  // namespace bench_fourier_resampler
