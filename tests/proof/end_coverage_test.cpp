// SPDX-License-Identifier: MIT
//
// Do the error bars cover where the ends of the string move? Random strings on random resonances at one end or both, bowed from
// rest, simulated by component modes (tests/support/moving_end_rig.hpp), 16 bits, 0.3 mN of noise. Everything that a laboratory
// has to find out is found: pitch, place, loss and resonances from three plucks, whose wires, gains and notebook are off by what
// is usual. Errors are set against their stated standard deviations: random ones sample by sample, after the scale that suits
// best; systematic ones, the scale itself, one a rig.
//
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/reconstruct/end_sensitivity.hpp>
#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/uncertainty.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <doctest/doctest.h>

#include "support/moving_end_rig.hpp"
#include "support/through_band.hpp"

#include <cstdio>

namespace {

using physics = rosin::with_moving_ends<rosin::full_physics>;

constexpr double rate_Hz = 64e3, noise_N = 3e-4;
const rosin::band limits{20e3, 29e3};
const test::moving_settings fine{.rate_Hz = rate_Hz, .mode_limit_Hz = 70e3, .oversampling = 8};

/// A rig as it is, and what its notebook says.
struct moving_rig {
  rosin::random_rig drawn;  ///< string, law, stroke, notebook
  test::moving_end_rig rig;
  std::array<double, 2> place{}, declared_place{};  ///< of the bow and two plucks; of the third
  double declared_impedance = 0;
  rosin::gaussian_source source;

  explicit moving_rig(std::uint64_t seed) : drawn{rosin::draw_rig(seed)}, rig{drawn.rig.string, {}}, source{seed + 1000} {
    for (std::size_t e = 0; e < 2; ++e)
      for (int i = 0, count = static_cast<int>(source.uniform(e == 0 ? 1 : 0, e == 0 ? 4 : 2)); i < count; ++i)
        rig.ends[e].push_back(
            {300 * std::pow(20, source.uniform()), 8 * std::pow(5, source.uniform()), 4e-3 * std::pow(15, source.uniform())});
    place = {drawn.position, 0.6 * drawn.position};
    for (std::size_t i = 0; i < 2; ++i) declared_place[i] = place[i] + 0.002 * source();
    declared_impedance = rig.string.impedance_Ns_m() * (1 + 0.01 * source());
  }
};

void recorded(std::vector<double>& force_N, double gain, unsigned seed, double full_scale_N) {
  for (double& x : force_N) x *= gain;
  test::record(force_N, noise_N, full_scale_N, seed);
}

std::vector<rosin::pluck_take> plucks_of(moving_rig& r) {
  std::vector<rosin::pluck_take> takes;
  for (const std::size_t where : {0U, 0U, 1U}) {
    auto take = test::pluck_moving_ends(r.rig, r.place[where], 1 + 0.015 * r.source(), 0.01, 0.35, fine);
    const auto seed = static_cast<unsigned>(100 * r.drawn.seed + 2 * takes.size());
    recorded(take.near_N, r.drawn.gain[0], seed, 2), recorded(take.far_N, r.drawn.gain[1], seed + 1, 2);
    takes.push_back(
        {"pluck-" + std::to_string(takes.size() + 1), rate_Hz, {take.near_N, take.far_N}, 1, 0.03, r.declared_place[where]});
  }
  return takes;
}

/// Error over stated standard deviation: rms over the samples after the best scale, and of that scale.
struct coverage {
  double random = 0, systematic = 0, per_cent = 0;
};

coverage judge(const std::vector<double>& made, const std::vector<double>& sd, const std::vector<double>& raw_truth,
               double scale_sd) {
  const auto truth = test::through_band(raw_truth, limits, rate_Hz);
  double count = 0, m = 0, t = 0, mm = 0, mt = 0, tt = 0;
  const auto each = [&](auto&& see) {
    for (std::size_t i = 0; i < made.size(); ++i)
      if (std::isfinite(made[i]) && std::isfinite(truth[i])) see(i);
  };
  each([&](std::size_t i) {
    ++count, m += made[i], t += truth[i], mm += made[i] * made[i], mt += made[i] * truth[i], tt += truth[i] * truth[i];
  });
  const double scale = (mt - m * t / count) / (mm - m * m / count);
  double random = 0, error = 0;
  each([&](std::size_t i) {
    const double e = scale * made[i] - truth[i];
    random += std::pow(e / (scale * sd[i]), 2), error += e * e;
  });
  return {std::sqrt(random / count), (1 / scale - 1) / scale_sd, 100 * std::sqrt(error / (tt - t * t / count))};
}

struct row {
  coverage force, velocity;
};

row run(std::uint64_t seed) {
  moving_rig r(seed);
  const rosin::pluck_guess guess{.fundamental_Hz = r.drawn.declared.string.fundamental_Hz,
                                 .inharmonicity = r.drawn.declared.string.inharmonicity()};
  const auto found = rosin::fit_ends(plucks_of(r), guess);
  REQUIRE(found);
  const auto plucked = rosin::calibration_from(found->plucks, r.declared_place[0], r.declared_impedance, 0.01);

  const auto stroke =
      std::visit([&](const auto& law) { return test::bow_moving_ends(r.rig, r.place[0], law, r.drawn.strokes[0], 0.15, fine); },
                 r.drawn.law);
  std::array<std::vector<double>, 2> force{stroke.near_N, stroke.far_N};
  for (std::size_t e = 0; e < 2; ++e) recorded(force[e], r.drawn.gain[e], static_cast<unsigned>(100 * seed + 50 + e), 4);
  const auto near = rosin::motion_of_end(found->ends[0], force[0], limits, rate_Hz),
             far = rosin::motion_of_end(found->ends[1], force[1], limits, rate_Hz);
  const rosin::end_signals<double, physics> heard{force[0], force[1], near.times_impedance_N, far.times_impedance_N};
  const rosin::calibration c = rosin::fine_tune<physics>(plucked, heard, limits, rate_Hz).tuned;
  const auto signals = rosin::detail::calibrated(c, heard);
  const rosin::end_signals<double, physics> views{signals[0], signals[1], signals[2], signals[3]};
  const auto motion = rosin::reconstructor<double, physics>(c.at, limits, rate_Hz)(views);

  auto slopes = rosin::sensitivity<physics>(c, views, limits, rate_Hz);
  std::vector<rosin::mode_of_end> modes;
  for (const auto& m : found->modes) modes.push_back({m.end, m.mode});
  rosin::append_end_sensitivity<physics>(slopes, c.at, modes, views, limits, rate_Hz);
  const auto of_modes = static_cast<Eigen::Index>(3 * modes.size());
  constexpr Eigen::Index waveform = rosin::waveform_parameters;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(waveform + of_modes, waveform + of_modes);
  covariance.topLeftCorner(waveform, waveform) = c.covariance;
  covariance.bottomRightCorner(of_modes, of_modes) = found->covariance.bottomRightCorner(of_modes, of_modes);
  const auto sure = rosin::uncertainty<physics>(c, motion, slopes, {c.noise_N[0] / c.gain[0], c.noise_N[1] / c.gain[1]}, limits,
                                                rate_Hz, covariance);

  std::vector<double> made_f, made_v;
  for (std::size_t i = 0; i < force[0].size(); ++i) made_f.push_back(motion.force_N(i)), made_v.push_back(motion.velocity_m_s(i));
  const row out{judge(made_f, sure.force_sd_N, stroke.force_N, sure.force_scale),
                judge(made_v, sure.velocity_sd_m_s, stroke.velocity_m_s, sure.velocity_scale)};
  std::printf("%4u  %zu %zu (%2zu)  %5.2f %6.2f   %5.2f %6.2f   %6.2f %6.2f\n", static_cast<unsigned>(seed), r.rig.ends[0].size(),
              r.rig.ends[1].size(), modes.size(), out.force.random, out.velocity.random, out.force.systematic,
              out.velocity.systematic, out.force.per_cent, out.velocity.per_cent);
  std::fflush(stdout);
  return out;
}

}  // namespace

TEST_CASE("error over stated standard deviation: 0.8 to 1.25, random and systematic apart") {
  constexpr int rigs = 12;
  std::printf("seed  modes near, far (found)  error / sd: force, velocity random; systematic; error in per cent\n");
  double force = 0, velocity = 0, force_scale = 0, velocity_scale = 0;
  for (std::uint64_t seed = 1; seed <= rigs; ++seed) {
    CAPTURE(seed);
    const row r = run(seed);
    force += r.force.random * r.force.random, velocity += r.velocity.random * r.velocity.random;
    force_scale += r.force.systematic * r.force.systematic, velocity_scale += r.velocity.systematic * r.velocity.systematic;
  }
  for (double* sum : {&force, &velocity, &force_scale, &velocity_scale}) *sum = std::sqrt(*sum / rigs);
  std::printf("all   rms of error / sd: force %.2f, velocity %.2f; their scales %.2f, %.2f\n", force, velocity, force_scale,
              velocity_scale);
  for (const double z : {force, velocity}) {
    CHECK(z > 0.8);
    CHECK(z < 1.25);
  }
  for (const double z : {force_scale, velocity_scale}) {
    CHECK(z > 0.6);  // of twelve draws
    CHECK(z < 1.4);
  }
}
