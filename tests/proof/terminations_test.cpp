// SPDX-License-Identifier: MIT
//
// Force and velocity under the bow of strings whose ends move, from 16-bit recordings with 0.3 mN of noise of a rig that is
// simulated by component modes (tests/support/moving_end_rig.hpp): three plucks at two places, then a stroke from rest. Errors in
// per cent of the truth, in mN and in mm/s, one common scale taken out, up to 20 kHz: the ends taken for rigid, as declared, and
// as fitted from the plucks alone, beside the same rig on rigid ends.
//
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <doctest/doctest.h>

#include "support/moving_end_rig.hpp"
#include "support/through_band.hpp"

#include <cstdio>
#include <string>

namespace {

constexpr double rate_Hz = 64e3, noise_N = 3e-4, position = 0.3;
const rosin::band limits{20e3, 29e3};
const test::moving_settings fine{.rate_Hz = rate_Hz, .mode_limit_Hz = 70e3, .oversampling = 8};
const rosin::string_parameters e_string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 659.69, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};

using end_modes = std::vector<test::end_mode>;

std::vector<rosin::pluck_take> plucks_of(const test::moving_end_rig& rig, double place) {
  std::vector<rosin::pluck_take> takes;
  for (const double at : {place, place, place < 0.25 ? 0.3 : 0.2}) {
    auto take = test::pluck_moving_ends(rig, at, 1, 0.01, 0.35, fine);
    const auto seed = static_cast<unsigned>(10 + 2 * takes.size());
    test::record(take.near_N, noise_N, 2, seed), test::record(take.far_N, noise_N, 2, seed + 1);
    takes.push_back({"pluck-" + std::to_string(takes.size() + 1), rate_Hz, {take.near_N, take.far_N}, 1, 0.03, at});
  }
  return takes;
}

/// What a, best scaled, misses of b, means aside: rms, in the unit of b, and in per cent of b's.
struct error {
  double rms = 0, per_cent = 100;
};

error missed(const std::vector<double>& a, const std::vector<double>& b, std::size_t from = 0, std::size_t to = 1000000000) {
  double count = 0, sa = 0, sb = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = from; i < std::min({a.size(), b.size(), to}); ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i]))
      ++count, sa += a[i], sb += b[i], aa += a[i] * a[i], bb += b[i] * b[i], ab += a[i] * b[i];
  const double va = aa - sa * sa / count, vb = bb - sb * sb / count, c = ab - sa * sb / count;
  if (!(va > 0 && vb > 0)) return {};
  const double share = std::sqrt(std::max(0.0, 1 - c * c / (va * vb)));
  return {share * std::sqrt(vb / count), 100 * share};
}

struct errors {
  error force, velocity;
};

using ends = std::array<rosin::modal_termination, 2>;

errors errors_of(const rosin::calibration& c, const ends& e, const test::moving_take& take,
                 std::array<std::vector<double>, 2> recorded, std::size_t from = 0, std::size_t to = 1000000000) {
  for (std::size_t k = 0; k < 2; ++k)
    for (double& x : recorded[k]) x /= c.gain[k];
  const auto near = rosin::motion_of_end(e[0], recorded[0], limits, rate_Hz),
             far = rosin::motion_of_end(e[1], recorded[1], limits, rate_Hz);
  const auto m = rosin::reconstructor<double, rosin::with_moving_ends<rosin::full_physics>>(
      c.at, limits, rate_Hz)({recorded[0], recorded[1], near.times_impedance_N, far.times_impedance_N});
  std::vector<double> force, velocity;
  for (std::size_t i = 0; i < m.force_near_N.size(); ++i) force.push_back(m.force_N(i)), velocity.push_back(m.velocity_m_s(i));
  return {missed(force, test::through_band(take.force_N, limits, rate_Hz), from, to),
          missed(velocity, test::through_band(take.velocity_m_s, limits, rate_Hz), from, to)};
}

struct row {
  errors as_rigid, declared, fitted, rigid_rig;
  std::size_t modes = 0;
};

test::moving_take stroke_of(const test::moving_end_rig& rig, double duration_s, double place) {
  return test::bow_moving_ends(rig, place, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                               {.speed_m_s = 0.2, .normal_force_N = 0.3}, duration_s, fine);
}
std::array<std::vector<double>, 2> recording_of(const test::moving_take& take) {
  std::array<std::vector<double>, 2> out{take.near_N, take.far_N};
  test::record(out[0], noise_N, 4, 1), test::record(out[1], noise_N, 4, 2);
  return out;
}
rosin::calibration calibrated(const rosin::pluck_fit_result& fit, double place) {
  return rosin::calibration_from(fit, place, e_string.impedance_Ns_m(), 0.01);
}

row run(const std::string& name, const test::moving_end_rig& rig, double stroke_s = 0.15, double place = position) {
  const rosin::pluck_guess guess{.fundamental_Hz = rig.string.fundamental_Hz * 1.001, .inharmonicity = 6.5e-5};
  const auto takes = plucks_of(rig, place);
  const auto stroke = stroke_of(rig, stroke_s, place);
  const auto recorded = recording_of(stroke);
  ends declared;
  rosin::end_options as_declared;
  as_declared.free_ends = {false, false};
  for (std::size_t e = 0; e < 2; ++e) {
    for (const auto& m : rig.ends[e]) declared[e].modes.push_back({m.frequency_Hz, m.q, e_string.impedance_Ns_m() / m.mass_kg});
    as_declared.known[e] = [modes = declared[e].modes](std::complex<double> s) {
      std::complex<double> z = 0;
      for (const auto& m : modes) z += m(s);
      return z;
    };
  }
  row out;
  const auto plain = rosin::fit_plucks(takes, guess);
  if (plain) out.as_rigid = errors_of(calibrated(*plain, place), {}, stroke, recorded);
  const auto known = rosin::fit_ends(takes, guess, {}, as_declared);
  REQUIRE(known);
  out.declared = errors_of(calibrated(known->plucks, place), declared, stroke, recorded);
  const auto found = rosin::fit_ends(takes, guess);
  REQUIRE(found);
  out.modes = found->modes.size();
  out.fitted = errors_of(calibrated(found->plucks, place), found->ends, stroke, recorded);
  const test::moving_end_rig stiff{rig.string, {}};
  const auto still = rosin::fit_plucks(plucks_of(stiff, place), guess);
  REQUIRE(still);
  const auto stiff_stroke = stroke_of(stiff, stroke_s, place);
  out.rigid_rig = errors_of(calibrated(*still, place), {}, stiff_stroke, recording_of(stiff_stroke));
  std::printf("%-40s", name.c_str());
  for (const errors* e : {&out.as_rigid, &out.declared, &out.fitted, &out.rigid_rig})
    std::printf("  %6.2f %6.2f", e->force.per_cent, e->velocity.per_cent);
  std::printf("   %.3f %.3f   %.3f %.3f  (%zu)\n", 1e3 * out.fitted.force.rms, 1e3 * out.rigid_rig.force.rms,
              1e3 * out.fitted.velocity.rms, 1e3 * out.rigid_rig.velocity.rms, out.modes);
  std::fflush(stdout);
  return out;
}

void header() {
  std::printf(
      "per cent of force and velocity             taken as rigid    as declared       fitted       rigid ends    mN: fitted, "
      "rigid  mm/s: fitted, rigid  (modes)\n");
}

/// In newtons and metres per second: a bow that plays into a body makes another motion of the string, whose velocity is 0.31 to
/// 0.44 m/s in these rigs (0.44 on rigid ends), so that the same error is another share of it. Measured: force 1.00 to 1.01,
/// velocity 0.98 to 1.05 times the error on rigid ends.
void check(const row& r) {
  for (const errors* e : {&r.declared, &r.fitted}) {
    CHECK(e->force.rms < 1.1 * r.rigid_rig.force.rms);
    CHECK(e->velocity.rms < 1.1 * r.rigid_rig.velocity.rms);
  }
}

/// Twenty modes, 0.2 to 6 kHz, light about a hill at 2.5 kHz.
end_modes violin_bridge(unsigned seed) {
  std::mt19937 random{seed};
  const auto chance = [&] { return static_cast<double>(random() % 10000) / 10000; };
  end_modes out;
  for (int i = 0; i < 20; ++i) {
    const double f = 200 * std::pow(30.0, (i + chance()) / 20), hill = std::exp(-std::pow(std::log(f / 2500) / 0.6, 2));
    out.push_back({f, 20 + 40 * chance(), (0.4 - 0.3 * chance()) * (1 - hill) + 0.02 * hill});
  }
  return out;
}

}  // namespace

TEST_CASE("(a) one resonance at one end") {
  header();
  for (const test::end_mode m : {test::end_mode{900, 40, 1.5e-3},
                                 {900, 10, 10e-3},
                                 {1500, 6, 3e-3},
                                 {2500, 25, 8e-3},
                                 {3000, 20, 5e-3},
                                 {4200, 40, 2e-3},
                                 {5500, 12, 15e-3},
                                 {7000, 6, 1.5e-3},
                                 {7000, 40, 30e-3}})
    for (const std::size_t end : {0U, 1U}) {
      test::moving_end_rig rig{e_string, {}};
      rig.ends[end] = {m};
      char name[80];
      std::snprintf(name, sizeof name, "%4.0f Hz, Q %2.0f, %4.1f g at %s", m.frequency_Hz, m.q, 1e3 * m.mass_kg,
                    end == 0 ? "near" : "far");
      check(run(name, rig));
    }
}

TEST_CASE("(b) a violin-like bridge and a stiff nut") {
  header();
  check(run("20 modes of a body, stiff nut", {e_string, {violin_bridge(5), end_modes{}}}));
}

TEST_CASE("(c) both ends move") {
  header();
  check(run("900 Hz 4 g near, 2700 Hz 8 g far", {e_string, {end_modes{{900, 30, 0.004}}, end_modes{{2700, 15, 0.008}}}}));
  check(run("three modes near, 2000 Hz 6 g far",
            {e_string, {end_modes{{460, 35, 0.12}, {900, 30, 0.05}, {2500, 20, 0.03}}, end_modes{{2000, 20, 6e-3}}}}));
}

TEST_CASE("a wolf: the string is tuned onto a mode of the body, through its beating") {
  header();
  const test::moving_end_rig wolf{e_string, {end_modes{{660, 60, 0.02}}, end_modes{}}};
  constexpr double duration_s = 0.5, place = 0.15;
  check(run("660 Hz, Q 60, 20 g under a 660 Hz string", wolf, duration_s, place));
  std::vector<double> fundamental;  // of the force on the bridge, in windows of 6 ms, once it sounds
  const auto stroke = stroke_of(wolf, duration_s, place);
  for (std::size_t begin = 6400, size = 384; begin + size <= stroke.near_N.size(); begin += size) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(i);
      sum += stroke.near_N[begin + i] * (1 - std::cos(turn / static_cast<double>(size))) *
             std::polar(2.0 / static_cast<double>(size), -turn * 660 / rate_Hz);
    }
    fundamental.push_back(std::abs(sum));
  }
  const auto [least, most] = std::minmax_element(fundamental.begin(), fundamental.end());
  std::printf("the fundamental at the bridge, mN:");
  for (const double x : fundamental) std::printf(" %.0f", 1e3 * x);
  std::printf("\n");
  CHECK(*least < 0.4 * *most);
}
