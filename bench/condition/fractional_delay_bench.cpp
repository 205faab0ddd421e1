// SPDX-License-Identifier: MIT
// The streaming delays: time per sample, and the worst error against bandwidth that the documentation tables.
#include <rosin/condition/fractional_delay.hpp>
#include <rosin/condition/fractional_delay_design.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace bench_fractional_delay {

namespace {

/// Largest |H exp(i w d) - 1| in dB over all fractions of a sample (in fortieths), of the line's own response to a click.
template <class Line>
double error_dB(double bandwidth) {
  using T = typename Line::input_type;
  double worst = 0;
  for (int fortieth = 0; fortieth < 40; ++fortieth) {
    const double delay = static_cast<double>(Line::least_delay) + fortieth / 40.0;
    Line line{delay};
    std::vector<double> click;
    for (int n = 0; n < 160; ++n) click.push_back(static_cast<double>(line(static_cast<T>(n == 0))));
    for (int i = 1; i <= 200; ++i) {
      const double w = std::numbers::pi * bandwidth * i / 200;
      std::complex<double> sum = 0;
      for (std::size_t n = 0; n < click.size(); ++n) sum += click[n] * std::polar(1.0, w * (delay - static_cast<double>(n)));
      worst = std::max(worst, std::abs(sum - 1.0));
    }
  }
  return 20 * std::log10(worst);
}

template <class T, class Interpolator>
void delay_line(benchmark::State& state) {
  using line_type = rosin::fractional_delay<T, Interpolator, 256>;
  line_type line{T(100.25)};
  std::vector<T> block(4096, T(1));
  for (auto _ : state) {
    for (T& x : block) x = line(x);
    benchmark::DoNotOptimize(block.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(block.size()));
  for (const double percent : {12.5, 25.0, 50.0, 60.0, 70.0, 80.0, 90.0})
    state.counters["dB_" + std::to_string(static_cast<int>(percent))] = error_dB<line_type>(percent / 100);
}

}  // namespace

BENCHMARK_TEMPLATE(delay_line, float, rosin::lagrange<2>)->Name("fractional_delay/float/lagrange<2>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::lagrange<4>)->Name("fractional_delay/float/lagrange<4>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::lagrange<6>)->Name("fractional_delay/float/lagrange<6>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::lagrange<8>)->Name("fractional_delay/float/lagrange<8>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<8>)->Name("fractional_delay/float/kaiser<8>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<16>)->Name("fractional_delay/float/kaiser<16>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<16, 60>)->Name("fractional_delay/float/kaiser<16,60>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<32>)->Name("fractional_delay/float/kaiser<32>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<64>)->Name("fractional_delay/float/kaiser<64>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<48>)->Name("fractional_delay/float/kaiser<48>");
BENCHMARK_TEMPLATE(delay_line, float, rosin::kaiser<64, 90>)->Name("fractional_delay/float/kaiser<64,90>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::lagrange<4>)->Name("fractional_delay/double/lagrange<4>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::lagrange<8>)->Name("fractional_delay/double/lagrange<8>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::kaiser<16>)->Name("fractional_delay/double/kaiser<16>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::kaiser<32>)->Name("fractional_delay/double/kaiser<32>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::kaiser<48>)->Name("fractional_delay/double/kaiser<48>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::kaiser<64>)->Name("fractional_delay/double/kaiser<64>");
BENCHMARK_TEMPLATE(delay_line, double, rosin::kaiser<64, 90>)->Name("fractional_delay/double/kaiser<64,90>");

}  // namespace bench_fractional_delay
