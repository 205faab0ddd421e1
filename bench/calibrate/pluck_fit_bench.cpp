// SPDX-License-Identifier: MIT
// The calibration from plucks of 0.14 s at 128 kHz, a modal string through 16-bit converters: the whole fit, from the declared
// values to the covariance, beside what a plain least-squares fit would do in each of its steps, all in the same run: the model
// sample by sample, once as it is and once for each free parameter (line sums at their best; such a fit takes five to ten steps).
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include <benchmark/benchmark.h>

namespace bench_pluck_fit {

namespace {

const rosin::pluck_guess guess{.fundamental_Hz = 660};

std::vector<rosin::pluck_take> plucks(std::int64_t count) {
  constexpr rosin::modal_rig rig{.string = {.length_m = 0.314,
                                            .tension_N = 72.5,
                                            .fundamental_Hz = 659.69,
                                            .bending_stiffness_Nm2 = 4.7e-5,
                                            .loss = {.quality = 1000}}};
  std::vector<rosin::pluck_take> out;
  for (std::int64_t i = 0; i < count; ++i) {
    const double force_N = 1 - 0.2 * static_cast<double>(i);
    const auto made = rosin::simulate_pluck(rig, {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.14});
    const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .bits = 16};
    const auto seed = static_cast<std::uint64_t>(2 * i);
    rosin::pluck_take take;
    take.name = std::to_string(i), take.rate_Hz = made->sample_rate_Hz, take.strength_N = force_N, take.position = 0.304;
    take.force_N = {rosin::convert(made->force_near_N, take.rate_Hz, sensor, seed).newtons(),
                    rosin::convert(made->force_far_N, take.rate_Hz, sensor, seed + 1).newtons()};
    out.push_back(std::move(take));
  }
  return out;
}

void pluck_fit(benchmark::State& state) {
  const auto takes = plucks(state.range(0));
  int iterations = 0;
  for (auto _ : state) {
    const auto fit = rosin::fit_plucks(takes, guess);
    if (!fit) return state.SkipWithError(fit.error().c_str());
    iterations = fit->iterations;
    benchmark::DoNotOptimize(fit->value.data());
  }
  state.counters["steps"] = iterations;
}

void pluck_fit_one_plain_step(benchmark::State& state) {
  const auto takes = plucks(state.range(0));
  const auto fit = rosin::fit_plucks(takes, guess);
  if (!fit) return state.SkipWithError(fit.error().c_str());
  const rosin::scene_data data{takes, guess, {}, fit->layout};
  const auto problem = data.problem({}, fit->value, {}, fit->noise_N);
  for (auto _ : state)
    for (std::size_t t = 0; t < takes.size(); ++t) {
      benchmark::DoNotOptimize(rosin::detail::residual_of(problem, fit->value, t));
      for (Eigen::Index p = 0; p < problem.model().size(); ++p)
        if (problem.model().is_free(p) && problem.model().concerns(p, t))
          benchmark::DoNotOptimize(rosin::detail::residual_of(problem, fit->value, t));
    }
}

}  // namespace

BENCHMARK(pluck_fit)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);
BENCHMARK(pluck_fit_one_plain_step)->Arg(1)->Arg(3)->Unit(benchmark::kMillisecond);

}  // namespace bench_pluck_fit
