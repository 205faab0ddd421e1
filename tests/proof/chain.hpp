// SPDX-License-Identifier: MIT
// The whole way on strings whose truth is known: bowed by the modal simulator, recorded, calibrated from plucks, reconstructed,
// and compared with the true force and velocity through one and the same low-pass.
#pragma once

#include <rosin/calibrate/calibration.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/uncertainty.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <future>
#include <optional>
#include <string>
#include <vector>

namespace proof {

inline constexpr double rate_Hz = 128e3;
inline constexpr rosin::band wide{20e3, 60e3};    ///< for exact parameters: nearly all that is recorded
inline constexpr rosin::band narrow{20e3, 30e3};  ///< for the whole chain: flat to 20 kHz, nothing from 30 kHz on

/// A signal through the window of a band; NaN where the low-pass reaches beyond the record.
inline std::vector<double> through(const rosin::band& limits, const std::vector<double>& x) {
  rosin::block_convolver<double> low_pass(
      1, std::vector<rosin::fir>{rosin::shortest_fir([](double) { return 1.0; }, limits, rate_Hz, -400, 400, 1e-7)});
  std::vector<double> y(x.size());
  const std::array<std::span<const double>, 1> in{x};
  const std::array<std::span<double>, 1> out{std::span<double>(y)};
  low_pass.process(in, out);
  const auto known = low_pass.valid(x.size());
  for (std::size_t i = 0; i < y.size(); ++i)
    if (i < known.begin || i >= known.end) y[i] = std::numeric_limits<double>::quiet_NaN();
  return y;
}

inline std::span<const double> part(const std::vector<double>& x, double begin_s, double end_s) {
  const auto at = [&](double t_s) { return std::min(x.size(), static_cast<std::size_t>(t_s * rate_Hz)); };
  return std::span<const double>(x).subspan(at(begin_s), at(end_s) - at(begin_s));
}

/// Delta of Eq. (12): the two versions of the force; their mean, and that of the velocity, against the truth.
struct deltas {
  double versions = 0, force = 0, velocity = 0;
};

struct verdict {
  deltas whole, transient, periodic;  ///< the take, its first 60 ms, its last 200 ms
};

inline verdict compare(const rosin::bow_motion<double>& motion, const rosin::modal_take& truth, const rosin::band& limits,
                       double force_scale = 1, double velocity_scale = 1) {
  std::vector<double> force(truth.size()), velocity(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    force[i] = force_scale * motion.force_N(i);
    velocity[i] = velocity_scale * motion.velocity_m_s(i);
  }
  const std::vector<double> true_force = through(limits, truth.contact_force_N),
                            true_velocity = through(limits, truth.centre_velocity_m_s);
  const auto over = [&](double begin_s, double end_s) {
    const auto cut = [&](const std::vector<double>& x) { return part(x, begin_s, end_s); };
    return deltas{rosin::consistency_delta(cut(motion.force_near_N), cut(motion.force_far_N)),
                  rosin::consistency_delta(cut(force), cut(true_force)),
                  rosin::consistency_delta(cut(velocity), cut(true_velocity))};
  };
  const double end_s = static_cast<double>(truth.size()) / rate_Hz;
  return {over(0, end_s), over(0, 0.06), over(end_s - 0.2, end_s)};
}

/// The factor that brings `made` closest to `truth`, means aside.
inline double best_scale(const std::vector<double>& made, const std::vector<double>& truth) {
  double mean_m = 0, mean_t = 0, count = 0, product = 0, power = 0;
  const auto each = [&](auto&& take) {
    for (std::size_t i = 0; i < made.size(); ++i)
      if (std::isfinite(made[i]) && std::isfinite(truth[i])) take(made[i], truth[i]);
  };
  each([&](double m, double t) { mean_m += m, mean_t += t, ++count; });
  mean_m /= count, mean_t /= count;
  each([&](double m, double t) { product += (m - mean_m) * (t - mean_t), power += (m - mean_m) * (m - mean_m); });
  return product / power;
}

/// The string of the paper's verification, its rod and its friction.
inline rosin::modal_rig paper_rig() {
  return {{.length_m = 0.314,
           .tension_N = 72.5,
           .fundamental_Hz = 659.69,
           .bending_stiffness_Nm2 = 4.7e-5,
           .loss = {.quality = 1000}},
          {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};
}
inline constexpr double paper_position = 0.3;
inline constexpr rosin::steady_rod paper_rod{.speed_m_s = 0.2, .normal_force_N = 0.3};

/// Thermal friction that shows the steady curve of Smith and Woodhouse at the paper's normal force, or that curve itself.
inline auto paper_law(bool thermal) {
  decltype(rosin::random_rig::law) law = rosin::velocity_curve<rosin::two_exponential_curve<double>>{{}};
  const rosin::contact_heat_parameters<double> heat{};
  const auto strength =
      rosin::design_yield_curve(rosin::two_exponential_curve<double>{}, heat.without_string(), paper_rod.normal_force_N);
  if (thermal && strength) law = rosin::thermal_plastic<double>{*strength, heat};
  return law;
}

inline rosin::modal_take paper_take(bool thermal) {
  const auto law = paper_law(thermal);
  auto take = std::visit(
      [&](const auto& l) { return rosin::simulate_stroke(paper_rig(), l, paper_rod, {.position = paper_position}); }, law);
  return *std::move(take);
}

/// Exact parameters, no noise.
template <class Physics>
verdict with_exact_parameters(const rosin::modal_take& take, const rosin::band& limits = wide) {
  const rosin::bow_point at = rosin::contact_at(paper_rig().string, paper_position);
  return compare(rosin::reconstructor<double, Physics>(at, limits, rate_Hz)(take.force_near_N, take.force_far_N), take, limits);
}

/// The paper's rig as a laboratory has it: gains, strengths and the notebook are off by what is usual; 16 bits, 0.3 mN of noise.
inline rosin::random_rig paper_laboratory(bool thermal) {
  rosin::random_rig r;
  r.rig = paper_rig();
  r.position = paper_position;
  r.law = paper_law(thermal);
  r.declared = {.string = r.rig.string, .torsion = r.rig.torsion, .position = 0.302};
  r.declared.string.fundamental_Hz *= 1.001;
  r.declared.string.bending_stiffness_Nm2 *= 0.98;
  r.declared.string.loss = {};
  r.plucks = {{{.position = paper_position, .force_N = 1.012, .release_s = 0.00413},
               {.position = paper_position, .force_N = 0.493, .release_s = 0.00407},
               {.position = paper_position, .force_N = 0.761, .release_s = 0.00419}}};
  r.strokes = {paper_rod, paper_rod};
  r.strokes[1].speed_m_s = 0.15;
  r.gain = {1.021, 0.985};
  r.noise_N = 0.3e-3;
  r.seed = 4711;
  return r;
}

/// One bowed take at the end of the chain.
struct chain_row {
  std::uint64_t seed = 0;
  std::string take;
  double position = 0;
  bool thermal = false;
  double force_rms_N = 0;                        ///< of the true force, mean aside
  verdict made;                                  ///< after the common scale
  double scale_error = 0, scale_sd = 0;          ///< relative: force made / true, and what is stated
  double force_inside = 0, velocity_inside = 0;  ///< share of samples within 1.96 stated sd
  double force_width = 0, velocity_width = 0;    ///< rms of the stated sd / rms of the error
  double tuning_sigmas = 0;
};

struct chain_result {
  std::vector<chain_row> rows;
  std::vector<std::string> failures;
  int without_slip = 0;
};

inline rosin::outcome<rosin::calibration> calibrate(const rosin::random_rig& r, const rosin::rig_recordings& recordings) {
  std::vector<rosin::pluck_take> plucks;
  for (std::size_t i = 0; i < r.plucks.size(); ++i) {
    const auto& take = recordings.takes[i];
    plucks.push_back({take.name,
                      rate_Hz,
                      {take.channels[0].newtons(), take.channels[1].newtons()},
                      r.declared.pluck_N[i],
                      0.03,
                      r.declared.position});
  }
  const auto fit = rosin::fit_plucks(
      plucks, {.fundamental_Hz = r.declared.string.fundamental_Hz, .inharmonicity = r.declared.string.inharmonicity()});
  if (!fit) return rosin::failure{fit.error()};
  return rosin::calibration_from(*fit, r.declared.position, r.declared.string.impedance_Ns_m(), 0.01);
}

/// Share of samples within 1.96 sd, and rms sd / rms error.
inline std::pair<double, double> judge_sd(const std::vector<double>& made, const std::vector<double>& truth,
                                          const std::vector<double>& sd, double scale) {
  double inside = 0, count = 0, error = 0, stated = 0;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (!std::isfinite(made[i]) || !std::isfinite(truth[i])) continue;
    const double e = scale * made[i] - truth[i], s = scale * sd[i];
    ++count, inside += std::abs(e) < 1.96 * s ? 1 : 0, error += e * e, stated += s * s;
  }
  return {inside / count, std::sqrt(stated / error)};
}

inline chain_row judge_take(const rosin::calibration& plucked, const rosin::recorded_take& take) {
  const auto near = take.channels[0].newtons(), far = take.channels[1].newtons();
  const auto tuning = rosin::fine_tune(plucked, near, far, narrow, rate_Hz);
  const rosin::calibration& c = tuning.tuned;
  const auto force = rosin::detail::calibrated(c, near, far);
  const auto motion = rosin::reconstructor<double>(c.at, narrow, rate_Hz)(force[0], force[1]);
  const auto answers = rosin::sensitivity(c, force[0], force[1], narrow, rate_Hz);
  const auto sure = rosin::uncertainty(c, motion, answers, {c.noise_N[0] / c.gain[0], c.noise_N[1] / c.gain[1]}, narrow, rate_Hz);

  std::vector<double> made_f(near.size()), made_v(near.size());
  for (std::size_t i = 0; i < near.size(); ++i) made_f[i] = motion.force_N(i), made_v[i] = motion.velocity_m_s(i);
  const auto true_f = through(narrow, take.truth.contact_force_N), true_v = through(narrow, take.truth.centre_velocity_m_s);
  const double f_scale = best_scale(made_f, true_f), v_scale = best_scale(made_v, true_v);
  chain_row row;
  row.take = take.name;
  row.made = compare(motion, take.truth, narrow, f_scale, v_scale);
  row.scale_error = 1 / f_scale - 1;
  row.scale_sd = sure.force_scale;
  std::tie(row.force_inside, row.force_width) = judge_sd(made_f, true_f, sure.force_sd_N, f_scale);
  std::tie(row.velocity_inside, row.velocity_width) = judge_sd(made_v, true_v, sure.velocity_sd_m_s, v_scale);
  row.tuning_sigmas = tuning.sigmas;
  double mean = 0, square = 0, count = 0;
  for (const double f : true_f)
    if (std::isfinite(f)) mean += f, square += f * f, ++count;
  row.force_rms_N = std::sqrt(square / count - mean / count * mean / count);
  return row;
}

/// Plays, records, calibrates and reconstructs all that a rig has.
inline chain_result run_chain(const rosin::random_rig& r) {
  chain_result out;
  const auto recordings = rosin::record(r);
  if (!recordings) return {{}, {recordings.error()}, 0};
  const auto c = calibrate(r, *recordings);
  if (!c) return {{}, {c.error()}, 0};
  for (const auto& take : recordings->takes) {
    if (!take.bowed) continue;
    if (!take.usable()) {
      ++out.without_slip;
      continue;
    }
    out.rows.push_back(judge_take(*c, take));
    out.rows.back().seed = r.seed, out.rows.back().position = r.position, out.rows.back().thermal = r.thermal();
  }
  return out;
}

/// The rigs of these seeds, on two cores.
inline chain_result run_random_rigs(std::uint64_t first_seed, int rigs) {
  std::vector<chain_result> parts(static_cast<std::size_t>(rigs));
  const auto some = [&](std::size_t begin) {
    for (std::size_t i = begin; i < parts.size(); i += 2) parts[i] = run_chain(rosin::draw_rig(first_seed + i));
  };
  auto odd = std::async(std::launch::async, some, 1);
  some(0);
  odd.get();
  chain_result all;
  for (const chain_result& p : parts) {
    all.rows.insert(all.rows.end(), p.rows.begin(), p.rows.end());
    all.failures.insert(all.failures.end(), p.failures.begin(), p.failures.end());
    all.without_slip += p.without_slip;
  }
  return all;
}

}  // namespace proof
