// SPDX-License-Identifier: MIT
// The diagnosis of a rig of five takes (three plucks, two strokes, 0.3 s each at 128 kHz) with the full catalogue on one core,
// beside the calibration of the same plucks, in the same run: a rig that is as declared, and one with a bead of 4 mg that is not.
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <benchmark/benchmark.h>

namespace bench_pluck_diagnosis {

namespace {

constexpr double rate = 128e3, noise_N = 0.3e-3;
const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 659.69,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}},
                           .torsion = {7, 3.5, 15}};
const rosin::pluck_guess guess{.fundamental_Hz = 660};
const rosin::pluck_options options{.internal_loss = false};

rosin::rig_burden bead(double kilograms) {
  rosin::rig_burden burden;
  if (kilograms > 0) burden.string.loads.push_back({.position = 0.4, .mass_kg = kilograms});
  return burden;
}

std::array<std::vector<double>, 2> recorded(const rosin::modal_take& take, std::uint64_t seed) {
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = noise_N, .bits = 16};
  return {rosin::convert(take.force_near_N, rate, sensor, seed).newtons(),
          rosin::convert(take.force_far_N, rate, sensor, seed + 1).newtons()};
}

std::vector<rosin::pluck_take> plucks(double bead_kg) {
  std::vector<rosin::pluck_take> out;
  for (std::uint64_t i = 0; i < 3; ++i) {
    const double force_N = 1 - 0.2 * static_cast<double>(i);
    const auto made =
        rosin::simulate_pluck(rig, bead(bead_kg), {.position = 0.3, .force_N = force_N, .release_s = 0.02, .duration_s = 0.3});
    rosin::pluck_take take;
    take.name = std::to_string(i), take.rate_Hz = rate, take.strength_N = force_N, take.position = 0.304,
    take.force_N = recorded(*made, 2 * i);
    out.push_back(std::move(take));
  }
  return out;
}

/// A stroke brought back to the contact.
struct stroke {
  rosin::bow_point at = rosin::contact_at(rig.string, 0.3);
  std::array<std::vector<double>, 2> end_N;
  rosin::bow_motion<double> motion;
  std::vector<double> force_N, velocity_m_s;
  double speed_m_s, normal_force_N = 0.35;

  stroke(double speed, std::uint64_t seed) : speed_m_s{speed} {
    const rosin::steady_rod rod{.speed_m_s = speed, .normal_force_N = normal_force_N, .start_s = 0.002, .rise_s = 0.005};
    end_N = recorded(*rosin::simulate_stroke(rig, rosin::velocity_curve<rosin::two_exponential_curve<>>{}, rod,
                                             {.position = 0.3, .duration_s = 0.3}, {.oversampling = 4}),
                     seed);
    motion = rosin::reconstructor<double>(at, {0.3 * rate, 0.45 * rate}, rate, 1e-5)(end_N[0], end_N[1]);
    for (std::size_t i = 0; i < end_N[0].size(); ++i)
      force_N.push_back(motion.force_N(i)), velocity_m_s.push_back(motion.velocity_m_s(i));
  }
  [[nodiscard]] rosin::contact_take take() const {
    rosin::contact_take t{"bow", force_N, velocity_m_s, motion.velocity_near_m_s, motion.velocity_far_m_s};
    t.near_N = end_N[0], t.far_N = end_N[1], t.rate_Hz = rate, t.rod_speed_m_s = speed_m_s, t.normal_force_N = normal_force_N;
    t.delay_s = at.delay_s, t.stiffness_s2 = at.stiffness_s2, t.loss = rig.string.loss, t.impedance_Ns_m = at.impedance_Ns_m,
    t.length_m = rig.string.length_m;
    t.force_sd_N = noise_N, t.velocity_sd_m_s = 5 * noise_N, t.noise_N = {noise_N, noise_N}, t.edge_Hz = 0.45 * rate;
    return t;
  }
};

void calibration(benchmark::State& state) {
  const auto takes = plucks(0);
  for (auto _ : state) {
    const auto fit = rosin::fit_plucks(takes, guess, options);
    if (!fit) return state.SkipWithError(fit.error().c_str());
  }
}

/// Argument: the bead, milligrams.
void diagnosis(benchmark::State& state) {
  auto takes = plucks(1e-6 * static_cast<double>(state.range(0)));
  const std::vector held{takes.back()};
  takes.pop_back();
  const stroke slow(0.16, 91), fast(0.22, 93);
  const std::vector strokes{slow.take(), fast.take()};
  rosin::contact_model model;
  model.torsion = rosin::torsion_values{rig.torsion.speed_ratio, rig.torsion.impedance_ratio, rig.torsion.quality};
  std::size_t found = 0;
  for (auto _ : state) {
    const auto d = rosin::diagnose_plucks(takes, held, guess, options, [](const rosin::pluck_fit_result& fit) {
      const rosin::string_facts facts{fit.value[rosin::pluck_layout::fundamental],
                                      rate,
                                      fit.limits.stop_Hz,
                                      rig.string.impedance_Ns_m(),
                                      rig.string.length_m,
                                      fit.layout.takes()};
      return rosin::catalogue_without({"bending-stiffness"}, facts, fit.limits);
    });
    if (!d) return state.SkipWithError(d.error().c_str());
    found = d->best.effects.size();
    benchmark::DoNotOptimize(rosin::contact_hypotheses(strokes, model));
  }
  state.counters["found"] = static_cast<double>(found);
}

}  // namespace

BENCHMARK(calibration)->Unit(benchmark::kMillisecond);
BENCHMARK(diagnosis)->Arg(0)->Arg(4)->Unit(benchmark::kMillisecond);

}  // namespace bench_pluck_diagnosis
