// SPDX-License-Identifier: MIT
// String-samples (steps of the contact) per second on one core under a contact that travels: waves against modes, with stiffness,
// torsion and a velocity curve; kernels are designed outside the clock.
#include <rosin/simulate/travelling_string.hpp>

#include <benchmark/benchmark.h>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_stroke.hpp>

namespace bench_travelling_string {

namespace {

const rosin::steady_rod rod{.speed_m_s = 0.1, .normal_force_N = 0.2, .start_s = 0, .rise_s = 0.01};
const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 660,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 500}},
                           .torsion = {.speed_ratio = 7.0, .impedance_ratio = 3.5, .quality = 15}};

rosin::velocity_curve<rosin::two_exponential_curve<>> curve() { return rosin::velocity_curve{rosin::two_exponential_curve<>{}}; }

/// A contact on its way from 0.12 to 0.14 of the string, and back.
double place(double t) { return 0.13 - 0.01 * std::cos(100 * t); }

void travelling(benchmark::State& state) {
  const rosin::wave_settings settings{.sample_rate_Hz = 64000, .oversampling = static_cast<int>(state.range(0))};
  const auto design = rosin::design_travelling_wave(rig, {0.12, 0.14}, settings);
  if (!design) return state.SkipWithError(design.error().c_str());
  rosin::travelling_string<double> waves{*design, place(0)};
  auto law = curve();
  constexpr int steps = 20000;
  double t = 0;
  for (auto _ : state)
    for (int n = 0; n < steps; ++n, t += settings.step_s()) {
      waves.move_to(place(t));
      benchmark::DoNotOptimize(waves.apply(law(waves.line(rod(t))).force_N));
    }
  state.SetItemsProcessed(state.iterations() * steps);
}

void modes_travelling(benchmark::State& state) {
  const double step_s = 1 / (64000.0 * static_cast<double>(state.range(0)));
  rosin::modal_contact contact{rig, place(0), std::min(250e3, 0.49 / step_s), step_s};
  auto law = curve();
  constexpr int steps = 20000;
  double t = 0;
  for (auto _ : state)
    for (int n = 0; n < steps; ++n, t += step_s) {
      contact.move_to(place(t));
      benchmark::DoNotOptimize(contact.apply(law(contact.line(rod(t))).force_N));
    }
  state.SetItemsProcessed(state.iterations() * steps);
}

}  // namespace

BENCHMARK(travelling)->Name("waves/stiff, torsion, travelling")->Arg(4)->Arg(16);
BENCHMARK(modes_travelling)->Name("modes/stiff, torsion, travelling")->Arg(4)->Arg(16);

}  // namespace bench_travelling_string
