// SPDX-License-Identifier: MIT
// String-samples (steps of the contact) per second on one core: travelling waves with more and more physics, and the modal
// reference under the same stroke. Kernels are designed outside the clock; with the sensors' signals (simulate_wave_stroke)
// and without (the bare loop).
#include <rosin/simulate/wave_stroke.hpp>

#include <benchmark/benchmark.h>

#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>

namespace bench_wave_string {

namespace {

constexpr double position = 0.12;
const rosin::steady_rod rod{.speed_m_s = 0.1, .normal_force_N = 0.2, .start_s = 0, .rise_s = 0.01};

rosin::modal_rig rig(bool stiff, bool turns) {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = stiff ? 4.7e-5 : 0,
                     .loss = {.quality = 500}},
          .torsion = {.speed_ratio = turns ? 7.0 : 0.0, .impedance_ratio = 3.5, .quality = 15}};
}

rosin::velocity_curve<rosin::two_exponential_curve<>> curve() { return rosin::velocity_curve{rosin::two_exponential_curve<>{}}; }

rosin::thermal_plastic<> thermal() {
  const rosin::contact_heat_parameters<> heat;
  return {*rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), rod.normal_force_N), heat};
}

/// rate: of the contact, in multiples of 64 kHz.
template <class T, class Law>
void loop(benchmark::State& state, const rosin::modal_rig& string, Law law) {
  const rosin::wave_settings settings{.sample_rate_Hz = 64000, .oversampling = static_cast<int>(state.range(0))};
  const auto design = rosin::design_wave(string, position, settings);
  if (!design) return state.SkipWithError(design.error().c_str());
  rosin::wave_string<T> waves{rosin::wave_kernels<T>{design->kernels}};
  constexpr int steps = 100000;
  double t = 0;
  for (auto _ : state)
    for (int n = 0; n < steps; ++n, t += settings.step_s())
      benchmark::DoNotOptimize(waves.apply(law(waves.line(rod(t))).force_N));
  state.SetItemsProcessed(state.iterations() * steps);
}

template <class Law>
void modes(benchmark::State& state, const rosin::modal_rig& string, Law law) {
  const double step_s = 1 / (64000.0 * static_cast<double>(state.range(0)));
  rosin::modal_contact contact{string, position, std::min(250e3, 0.49 / step_s), step_s};
  constexpr int steps = 20000;
  double t = 0;
  for (auto _ : state)
    for (int n = 0; n < steps; ++n, t += step_s) benchmark::DoNotOptimize(contact.apply(law(contact.line(rod(t))).force_N));
  state.SetItemsProcessed(state.iterations() * steps);
}

void whole_take(benchmark::State& state) {
  const rosin::wave_settings settings{.sample_rate_Hz = 64000, .oversampling = static_cast<int>(state.range(0))};
  const auto string = rig(true, true);
  const auto design = rosin::design_wave(string, position, settings);
  if (!design) return state.SkipWithError(design.error().c_str());
  for (auto _ : state) benchmark::DoNotOptimize(rosin::simulate_wave_stroke(*design, string, curve(), rod, 0.2, settings));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(0.2 / settings.step_s()));
}

void plain(benchmark::State& state) { loop<double>(state, rig(false, false), curve()); }
void stiff(benchmark::State& state) { loop<double>(state, rig(true, false), curve()); }
void turning(benchmark::State& state) { loop<double>(state, rig(true, true), curve()); }
void turning_single(benchmark::State& state) {
  loop<float>(state, rig(true, true), rosin::velocity_curve{rosin::two_exponential_curve<float>{}});
}
void warm(benchmark::State& state) { loop<double>(state, rig(true, true), thermal()); }
void modes_turning(benchmark::State& state) { modes(state, rig(true, true), curve()); }
void modes_warm(benchmark::State& state) { modes(state, rig(true, true), thermal()); }

}  // namespace

BENCHMARK(plain)->Name("waves/plain")->Arg(4)->Arg(16);
BENCHMARK(stiff)->Name("waves/stiff")->Arg(4)->Arg(16);
BENCHMARK(turning)->Name("waves/stiff, torsion")->Arg(4)->Arg(16);
BENCHMARK(turning_single)->Name("waves/stiff, torsion, single precision")->Arg(4)->Arg(16);
BENCHMARK(warm)->Name("waves/stiff, torsion, thermal")->Arg(4)->Arg(16);
BENCHMARK(whole_take)->Name("waves/stiff, torsion, with the sensors' signals")->Arg(4)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(modes_turning)->Name("modes/stiff, torsion")->Arg(4)->Arg(16);
BENCHMARK(modes_warm)->Name("modes/stiff, torsion, thermal")->Arg(4)->Arg(16);

}  // namespace bench_wave_string
