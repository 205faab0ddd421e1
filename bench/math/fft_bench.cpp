// SPDX-License-Identifier: MIT
// Eigen's transforms, and where the chirp-z transform overtakes Eigen's butterfly for a prime radix: the bound in math/fft.hpp.
#include "fft_cases.hpp"

#include <rosin/math/fft.hpp>

#include <benchmark/benchmark.h>

#include <complex>
#include <cstddef>
#include <vector>

namespace bench_fft {

namespace {

using bins = std::vector<std::complex<double>>;

void eigen_butterfly(benchmark::State& state) {
  const std::size_t n = 512 * static_cast<std::size_t>(state.range(0));
  Eigen::FFT<double> fft;
  const bins in(n, {1, 2});
  bins out(n);
  for (auto _ : state) fft.fwd(out.data(), in.data(), static_cast<Eigen::Index>(n));
}

void chirp_z(benchmark::State& state) {
  const std::size_t n = 512 * static_cast<std::size_t>(state.range(0));
  rosin::chirp_z<double, rosin::eigen_fft<std::complex<double>>> fft(n);
  const bins in(n, {1, 2});
  bins out(n);
  for (auto _ : state) fft.forward(in.data(), out.data());
}

void primes(benchmark::internal::Benchmark* bench) {
  for (const int p : {7, 13, 19, 23, 29, 31, 41, 61}) bench->Arg(p);
  bench->Unit(benchmark::kMicrosecond);
}

}  // namespace

using fft_cases::there_and_back;

BENCHMARK(eigen_butterfly)->Name("fft/512_times_prime/eigen_butterfly")->Apply(primes);
BENCHMARK(chirp_z)->Name("fft/512_times_prime/chirp_z")->Apply(primes);

BENCHMARK_TEMPLATE(there_and_back, double, rosin::eigen_fft<double>)->Name("fft/eigen/double")->Apply(fft_cases::lengths);
BENCHMARK_TEMPLATE(there_and_back, float, rosin::eigen_fft<float>)->Name("fft/eigen/float")->Apply(fft_cases::lengths);

}  // namespace bench_fft
