// SPDX-License-Identifier: MIT
// Ten seconds of two channels at 128 kHz through four filters, as in a reconstruction of force and velocity, against the
// four bare real transforms of the whole record that a frequency-domain version would need at least.
#pragma once

#include <rosin/condition/overlap_save.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace overlap_save_cases {

inline constexpr double rate_Hz = 128e3, duration_s = 10;
inline constexpr std::size_t length = 1280000;

struct kernel {
  int first;
  std::vector<double> taps;
};

template <class T>
std::vector<T> noise(std::size_t n, unsigned seed) {
  std::mt19937 engine{seed};
  std::normal_distribution<double> normal;
  std::vector<T> x(n);
  for (T& sample : x) sample = static_cast<T>(normal(engine));
  return x;
}

/// The spans that the kernels of the paper's string have at 1e-5: inverse of one side and the other side; and both of the one
/// side.
inline std::vector<kernel> kernels() {
  return {{-49, noise<double>(50, 1)}, {22, noise<double>(64, 2)}, {-49, noise<double>(99, 3)}, {0, {}}};
}

template <class T>
struct record {
  std::array<std::vector<T>, 2> in{noise<T>(length, 5), noise<T>(length, 6)};
  std::array<std::vector<T>, 2> out{std::vector<T>(length), std::vector<T>(length)};
};

inline void report(benchmark::State& state) {
  state.counters["x_real_time"] =
      benchmark::Counter(duration_s * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

template <class T, class Fft>
void convolve(benchmark::State& state) {
  record<T> r;
  rosin::block_convolver<T, Fft> convolver(2, kernels(), static_cast<std::size_t>(state.range(0)));
  const std::array<std::span<const T>, 2> in{r.in[0], r.in[1]};
  const std::array<std::span<T>, 2> out{r.out[0], r.out[1]};
  for (auto _ : state) {
    convolver.process(in, out);
    benchmark::ClobberMemory();
  }
  state.counters["block"] = static_cast<double>(convolver.block_size());
  report(state);
}

template <class T, class RealFft>
void four_bare_ffts(benchmark::State& state) {
  record<T> r;
  RealFft fft(length);
  std::vector<std::complex<T>> bins(length / 2 + 1);
  for (auto _ : state)
    for (std::size_t channel = 0; channel < 2; ++channel) {
      fft.forward(r.in[channel].data(), bins.data());
      fft.inverse(bins.data(), r.out[channel].data());
      benchmark::ClobberMemory();
    }
  report(state);
}

/// The plain sum, written so that the compiler can use its vector unit: blocks of outputs, one tap after the other.
template <class T>
void direct_sum(benchmark::State& state) {
  record<T> r;
  const std::vector<kernel> all = kernels();
  constexpr std::size_t block = 512, margin = 512;
  for (auto _ : state) {
    for (std::size_t begin = margin; begin + block + margin <= length; begin += block)
      for (std::size_t output = 0; output < 2; ++output) {
        std::array<T, block> sum{};
        for (std::size_t input = 0; input < 2; ++input) {
          const kernel& h = all[2 * output + input];
          const T* x = r.in[input].data() + static_cast<std::ptrdiff_t>(begin) - h.first;
          for (const double tap : h.taps) {
            for (std::size_t n = 0; n < block; ++n) sum[n] += static_cast<T>(tap) * x[n];
            --x;
          }
        }
        std::copy(sum.begin(), sum.end(), r.out[output].begin() + static_cast<std::ptrdiff_t>(begin));
      }
    benchmark::ClobberMemory();
  }
  report(state);
}

}  // namespace overlap_save_cases
