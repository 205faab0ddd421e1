// SPDX-License-Identifier: MIT
// One real transform forward and back, per backend and length, and the worst error of its bins.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace fft_cases {

/// Worst error of thirty bins against the definition in long double, over the root mean square of all, in epsilons.
template <class T>
double error_in_epsilons(const std::vector<T>& x, const std::vector<std::complex<T>>& bins) {
  const std::size_t n = x.size();
  double worst = 0;
  for (std::size_t i = 0; i < 30; ++i) {
    const std::size_t k = (bins.size() - 1) * i / 29;
    std::complex<long double> sum{};
    for (std::size_t j = 0; j < n; ++j)
      sum += static_cast<long double>(x[j]) *
             std::polar(1.0L,
                        -2 * std::numbers::pi_v<long double> * static_cast<long double>(j * k % n) / static_cast<long double>(n));
    const std::complex<long double> bin{static_cast<long double>(bins[k].real()), static_cast<long double>(bins[k].imag())};
    worst = std::max(worst, static_cast<double>(std::abs(bin - sum)));
  }
  return worst / std::sqrt(static_cast<double>(n)) / static_cast<double>(std::numeric_limits<T>::epsilon());
}

template <class T, class Fft>
void there_and_back(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0));
  std::mt19937 engine{1};
  std::uniform_real_distribution<double> uniform{-1.7320508, 1.7320508};
  std::vector<T> x(n), back(n);
  for (T& sample : x) {
    sample = static_cast<T>(uniform(engine));
    if (sample == T(0)) sample = T(1);
  }
  std::vector<std::complex<T>> bins(n / 2 + 1);
  Fft fft(n);
  for (auto _ : state) {
    fft.forward(x.data(), bins.data());
    fft.inverse(bins.data(), back.data());
    benchmark::ClobberMemory();
  }
  state.counters["epsilons"] = error_in_epsilons(x, bins);
}

inline void lengths(benchmark::internal::Benchmark* bench) {
  for (const int n : {1024, 1000, 1021, 16384, 17921, 131072, 131071}) bench->Arg(n);
  bench->Unit(benchmark::kMicrosecond);
}

}  // namespace fft_cases
