// SPDX-License-Identifier: MIT
// Streaming reconstruction of force and velocity at 128 kHz, both versions, kernels to 1e-3: how many times faster than the
// string plays it, by length of block, beside two others in the same run: the eight direct filters of streaming_reconstructor.hpp
// and the same four passages by std::inner_product. mean_us, p999_us and worst_us: of a hundred thousand blocks, each timed by
// itself; the clock's own time and the system's interruptions are in them. of_block: what the 999th of a thousand takes of the
// time it has.
#include <rosin/reconstruct/passage_design.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>
#include <rosin/reconstruct/streaming_design.hpp>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

namespace bench_passage_reconstructor {

namespace {

constexpr double rate_Hz = 128e3;
constexpr rosin::band limits{0.30 * rate_Hz, 0.45 * rate_Hz};
constexpr std::size_t Taps = 56, Line = 256, Short = 7;

rosin::bow_point contact() { return rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {1000, 1e-9, 0}}, 0.3); }

template <class T>
std::vector<rosin::termination_frame<T>> forces() {
  std::vector<rosin::termination_frame<T>> out(8192);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {static_cast<T>(std::sin(1.7 * static_cast<double>(i * i % 1013))),
              static_cast<T>(std::cos(1.1 * static_cast<double>(i * i % 977)))};
  return out;
}

/// run(first frame, block): any of the candidates.
template <class T, class Run>
void timed(benchmark::State& state, Run run) {
  using clock = std::chrono::steady_clock;
  const auto block = static_cast<std::size_t>(state.range(0));
  const auto in = forces<T>();
  for (std::size_t i = 0; i + block <= in.size(); i += block) run(in.data() + i, block);
  std::size_t at = 0, frames = 0;
  for (auto _ : state) {
    run(in.data() + at, block);
    frames += block;
    at = at + 2 * block > in.size() ? 0 : at + block;
  }
  state.counters["times_real_time"] = benchmark::Counter(static_cast<double>(frames) / rate_Hz, benchmark::Counter::kIsRate);
  std::vector<double> took_us(100000);
  for (double& us : took_us) {
    const auto start = clock::now();
    run(in.data() + at, block);
    us = std::chrono::duration<double, std::micro>(clock::now() - start).count();
    at = at + 2 * block > in.size() ? 0 : at + block;
  }
  std::sort(took_us.begin(), took_us.end());
  const double p999_us = took_us[took_us.size() / 1000 * 999];
  state.counters["mean_us"] = std::accumulate(took_us.begin(), took_us.end(), 0.0) / static_cast<double>(took_us.size());
  state.counters["p999_us"] = p999_us;
  state.counters["worst_us"] = took_us.back();
  state.counters["of_block"] = 1e-6 * p999_us * rate_Hz / static_cast<double>(block);
}

template <class T>
void passages(benchmark::State& state) {
  const auto fixed = rosin::fixed_size<T, Taps, Line, Short>(rosin::plan_passages(contact(), {1, 1}, limits, rate_Hz, 1e-3));
  if (!fixed) return state.SkipWithError(fixed.error().c_str());
  rosin::passage_reconstructor<T, Taps, Line, Short> stream{*fixed};
  std::vector<rosin::bow_frame<T>> out(8192);
  timed<T>(state, [&](const rosin::termination_frame<T>* in, std::size_t block) {
    stream.process({in, block}, {out.data(), block});
    benchmark::ClobberMemory();
  });
}

template <class T>
void eight_filters(benchmark::State& state) {
  const auto designed = rosin::design_streaming<T, 192, 512>(contact(), {1, 1}, limits, rate_Hz, 1e-3);
  if (!designed) return state.SkipWithError(designed.error().c_str());
  rosin::streaming_reconstructor<T, 192, 512> stream{*designed};
  std::vector<rosin::bow_frame<T>> out(8192);
  timed<T>(state, [&](const rosin::termination_frame<T>* in, std::size_t block) {
    for (std::size_t i = 0; i < block; ++i) out[i] = stream(in[i]);
    benchmark::ClobberMemory();
  });
}

/// The four passages alone, on lines that lie ready: what the standard library makes of them.
template <class T>
void inner_products(benchmark::State& state) {
  const auto plan = rosin::plan_passages(contact(), {1, 1}, limits, rate_Hz, 1e-3);
  std::array<std::vector<T>, 4> taps;
  for (std::size_t p = 0; p < 4; ++p)
    for (const double tap : plan.arrival_taps(p)) taps[p].push_back(static_cast<T>(tap));
  const std::vector<T> line(8192 + Taps, T(0.5));
  std::vector<rosin::bow_frame<T>> out(8192);
  timed<T>(state, [&](const rosin::termination_frame<T>*, std::size_t block) {
    for (std::size_t i = 0; i < block; ++i) {
      const auto dot = [&](std::size_t p) {
        return std::inner_product(taps[p].begin(), taps[p].end(), line.begin() + static_cast<std::ptrdiff_t>(i), T(0));
      };
      out[i] = {dot(0), dot(1), dot(2), dot(3)};
    }
    benchmark::ClobberMemory();
  });
}

void blocks(benchmark::internal::Benchmark* b) {
  for (const int block : {1, 16, 64, 512}) b->Arg(block);
}

}  // namespace

BENCHMARK(passages<float>)->Name("streaming/float/passages/block")->Apply(blocks);
BENCHMARK(eight_filters<float>)->Name("streaming/float/eight_filters/block")->Apply(blocks);
BENCHMARK(inner_products<float>)->Name("streaming/float/inner_products/block")->Apply(blocks);
BENCHMARK(passages<double>)->Name("streaming/double/passages/block")->Apply(blocks);
BENCHMARK(eight_filters<double>)->Name("streaming/double/eight_filters/block")->Apply(blocks);
BENCHMARK(inner_products<double>)->Name("streaming/double/inner_products/block")->Apply(blocks);

}  // namespace bench_passage_reconstructor
