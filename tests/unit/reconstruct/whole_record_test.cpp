// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/whole_record.hpp>

#include <rosin/calibrate/uneven_string.hpp>
#include <rosin/condition/low_pass.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/uneven_strokes.hpp"

namespace {

struct known_stroke {
  test::drawn_strokes drawn = test::draw_strokes(1, 1, 0.5);
  rosin::modal_take truth;
  rosin::stroke_take seen;
  rosin::uneven_string string;
  double position = drawn.strokes[0].position;

  explicit known_stroke(double noise_N) {
    drawn.machine.gain = {1, 1}, drawn.machine.noise_N = {noise_N, noise_N};
    truth = test::bow(drawn.machine, drawn.strokes[0]);
    seen = test::record(drawn.machine, truth, position, 0, "stroke");
    const auto& s = drawn.machine.rig.string;
    string = {s.fundamental_Hz, s.stiffness_s2(), s.loss, {}};
    for (int n = 1; n * s.fundamental_Hz < 9000; ++n) string.ln_own_q.push_back(drawn.machine.ln_own_q(n));
  }
  [[nodiscard]] rosin::whole_motion reconstructed(const rosin::uneven_string& with, const rosin::end_noise& noise) const {
    return rosin::reconstruct_whole(
        with.seen_from(position, drawn.machine.rig.string.impedance_Ns_m()), [&](double f) { return with.propagation_rate(f); },
        noise, seen.force_N[0], seen.force_N[1], limits, 50e3);
  }
  static constexpr rosin::band limits{7000, 8000};
};

/// rms of the difference over samples that both know, mean aside.
double rms_error(const std::vector<double>& x, const std::vector<double>& truth, rosin::sample_range known) {
  const std::vector<double> t = rosin::low_pass(std::span<const double>(truth), 50e3, known_stroke::limits);
  double sum = 0, power = 0;
  const double count = static_cast<double>(known.end - known.begin);
  for (std::size_t i = known.begin; i < known.end; ++i) sum += x[i] - t[i], power += (x[i] - t[i]) * (x[i] - t[i]);
  return std::sqrt(power / count - (sum / count) * (sum / count));
}
double rms_of(const std::vector<double>& x, rosin::sample_range known) {
  return rms_error(x, std::vector<double>(x.size(), 0.0), known);
}

}  // namespace

TEST_CASE("A string whose modes lose one by one gives its force back, and a smooth loss gives less of it") {
  const known_stroke stroke(1e-7);
  const auto motion = stroke.reconstructed(stroke.string, {{1e-7, 1e-7}, 0.03, 1e-3});
  const auto known = motion.versions.known;
  CHECK(known.end - known.begin > 20000);
  CHECK(std::isnan(motion.mean.force_N[known.begin - 1]));
  const double size = rms_of(stroke.truth.contact_force_N, known);
  const double error = rms_error(motion.mean.force_N, stroke.truth.contact_force_N, known);
  CHECK(error < 3e-3 * size);
  CHECK(rms_error(motion.combined.force_N, stroke.truth.contact_force_N, known) < 3e-3 * size);
  CHECK(rms_error(motion.versions.force_near_N, stroke.truth.contact_force_N, known) < 5e-3 * size);
  const double speed = rms_of(stroke.truth.centre_velocity_m_s, known);
  CHECK(rms_error(motion.combined.velocity_m_s, stroke.truth.centre_velocity_m_s, known) < 3e-3 * speed);
  auto smooth = stroke.string;
  smooth.ln_own_q.clear();
  const auto worse = stroke.reconstructed(smooth, {{1e-7, 1e-7}, 0.03, 1e-3});
  CHECK(rms_error(worse.mean.force_N, stroke.truth.contact_force_N, known) > 1.2 * error);
}

TEST_CASE("The combination of both ends has 0.82 of the mean's noise, as its standard deviation says") {
  const known_stroke stroke(8e-3);
  const auto motion = stroke.reconstructed(stroke.string, {{8e-3, 8e-3}, 0.03, 1e-3});
  const auto known = motion.versions.known;
  const double mean = rms_error(motion.mean.force_N, stroke.truth.contact_force_N, known),
               combined = rms_error(motion.combined.force_N, stroke.truth.contact_force_N, known);
  CHECK(combined < 0.86 * mean);
  CHECK(motion.mean.force_sd_N == test::approx(mean).epsilon(0.05));
  CHECK(motion.combined.force_sd_N == test::approx(combined).epsilon(0.07));
  const double v = rms_error(motion.combined.velocity_m_s, stroke.truth.centre_velocity_m_s, known);
  CHECK(v <= rms_error(motion.mean.velocity_m_s, stroke.truth.centre_velocity_m_s, known));
  CHECK(motion.combined.velocity_sd_m_s == test::approx(v).epsilon(0.07));
}
