// SPDX-License-Identifier: MIT
// A bowed string without stiffness, torsion or a place of its own for the contact (Debian's libstk-dev), for comparison with
// "waves/plain": two linear delays, one pole, a table for friction and a body of six resonances.
#include <benchmark/benchmark.h>

#include <stk/Bowed.h>

namespace bench_stk {

namespace {

void stk_bowed(benchmark::State& state) {
  stk::Stk::setSampleRate(64000.0 * static_cast<double>(state.range(0)));
  stk::Bowed string(8);
  string.noteOn(660, 0.8);
  constexpr int steps = 100000;
  for (auto _ : state)
    for (int n = 0; n < steps; ++n) benchmark::DoNotOptimize(string.tick());
  state.SetItemsProcessed(state.iterations() * steps);
}

}  // namespace

BENCHMARK(stk_bowed)->Name("peer/stk::Bowed")->Arg(4)->Arg(16);

}  // namespace bench_stk
