// SPDX-License-Identifier: MIT
// Delays of whole records: taps, worst error over fractions of a sample, and time for ten seconds at 128 kHz.
#include <rosin/condition/record_delay.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace bench_record_delay {

namespace {

template <class T>
void ten_seconds(benchmark::State& state) {
  const rosin::delay_limits limits{static_cast<double>(state.range(0)) / 100, static_cast<double>(state.range(1))};
  auto delay = rosin::record_delay<T>::make(29.5, limits);
  std::vector<T> in(1280000, T(1)), out(in.size());
  for (auto _ : state) {
    delay->process(in, out);
    benchmark::ClobberMemory();
  }
  double worst = -400;
  for (int fortieth = 1; fortieth < 40; ++fortieth)
    worst = std::max(
        worst, rosin::delay_error_dB(*rosin::design_kaiser_delay(fortieth / 40.0, limits), fortieth / 40.0, limits.bandwidth));
  state.counters["taps"] = static_cast<double>(delay->taps());
  state.counters["worst_dB"] = worst;
}

}  // namespace

BENCHMARK_TEMPLATE(ten_seconds, double)
    ->Name("record_delay/double/percent_dB")
    ->ArgsProduct({{50, 80, 90, 95}, {-60, -100, -140, -200}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(ten_seconds, float)
    ->Name("record_delay/float/percent_dB")
    ->Args({80, -100})
    ->Args({80, -140})
    ->Unit(benchmark::kMillisecond);

}  // namespace bench_record_delay
