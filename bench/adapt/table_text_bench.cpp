// SPDX-License-Identifier: MIT
// A stroke of 15 MB of text (four columns, 50 kHz, as public recordings have it) into columns of numbers; beside it the same numbers by
// std::from_chars alone, and by fast_float where that library is installed, neither of which looks at lines or columns.
#include <rosin/adapt/table_text.hpp>

#include <benchmark/benchmark.h>

#include <array>
#include <cstdio>
#include <random>

#if __has_include(<fast_float/fast_float.h>)
#include <fast_float/fast_float.h>
#define ROSIN_BENCH_FAST_FLOAT 1
#endif

namespace bench_table_text {

namespace {

const std::string& stroke() {
  static const std::string text = [] {
    std::mt19937_64 random{1};
    std::normal_distribution<double> noise;
    std::string out;
    std::array<char, 100> line{};
    while (out.size() < 15'000'000) {
      const int size = std::snprintf(line.data(), line.size(), "%.7g,%.7g,%.7g,%.7g\r\n", 0.3 + 0.002 * noise(random),
                                     0.05 + 1e-9 * noise(random), 0.2 * noise(random), 0.1 * noise(random));
      out.append(line.data(), static_cast<std::size_t>(size));
    }
    return out;
  }();
  return text;
}

void finish(benchmark::State& state) { state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(stroke().size())); }

/// Every number, and nothing else.
template <class Read>
void numbers_alone(benchmark::State& state, Read read) {
  const std::string& text = stroke();
  for (auto _ : state) {
    double sum = 0;
    for (const char *at = text.data(), *end = at + text.size(); at != end;) {
      double value = 0;
      at = read(at, end, value).ptr;
      sum += value;
      while (at != end && (*at == ',' || *at == '\r' || *at == '\n')) ++at;
    }
    benchmark::DoNotOptimize(sum);
  }
  finish(state);
}

void table_text(benchmark::State& state) {
  const std::string& text = stroke();
  for (auto _ : state) benchmark::DoNotOptimize(rosin::parse_table_text(text, "stroke.csv"));
  finish(state);
}
void from_chars_alone(benchmark::State& state) {
  numbers_alone(state, [](const char* at, const char* end, double& to) { return std::from_chars(at, end, to); });
}
#ifdef ROSIN_BENCH_FAST_FLOAT
void fast_float_alone(benchmark::State& state) {
  numbers_alone(state, [](const char* at, const char* end, double& to) { return fast_float::from_chars(at, end, to); });
}
BENCHMARK(fast_float_alone)->Unit(benchmark::kMillisecond);
#endif

BENCHMARK(table_text)->Unit(benchmark::kMillisecond);
BENCHMARK(from_chars_alone)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace bench_table_text
