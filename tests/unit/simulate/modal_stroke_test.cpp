// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_stroke.hpp>

#include <doctest/doctest.h>

#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>

#include "support/approx.hpp"

namespace simulate_modal_stroke {

namespace {

constexpr double pi = 3.14159265358979323846;
using complex = std::complex<double>;
using curve_law = rosin::velocity_curve<rosin::two_exponential_curve<>>;

rosin::modal_rig e_rig(double quality = 1000) {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = quality}},
          .torsion = {7, 3.5, 15}};
}

const rosin::modal_settings quick{.oversampling = 4, .mode_limit_Hz = 160e3};

complex transform(const std::vector<double>& x, complex p) {
  complex sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) sum += x[n] * std::exp(-p * (static_cast<double>(n) / 128e3));
  return sum;
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double error = 0, size = 0;
  for (std::size_t n = 0; n < a.size(); ++n) error += (a[n] - b[n]) * (a[n] - b[n]), size += a[n] * a[n];
  return std::sqrt(error / size);
}

}  // namespace

TEST_CASE("force and velocity at the contact follow from the forces on the ends, exactly") {
  // f = G (F1 cos k x1 + F2 cos k x2), 0 = F1 sin k x1 - F2 sin k x2; velocity from either end plus the near field.
  // On the line sigma + i w everything that has happened since rest is transformed, start and all.
  const auto rig = e_rig(1e7);
  const auto take = rosin::simulate_stroke(rig, curve_law{}, rosin::steady_rod{.start_s = 0.001, .rise_s = 0.004},
                                           {.position = 0.3, .duration_s = 0.04}, quick);
  REQUIRE(take);
  CHECK(take->slips > 3);
  const auto& s = rig.string;
  double f_error = 0, f_size = 0, e_error = 0, v_error = 0, v_size = 0;
  for (double f = 150; f < 20000; f += 777) {
    const complex p{600, 2 * pi * f}, m = -s.linear_density_kg_m() * p * p;
    const double T = s.tension_N, B = s.bending_stiffness_Nm2, x1 = 0.3 * s.length_m, x2 = 0.7 * s.length_m;
    const complex k2 = 2.0 * m / (T + std::sqrt(T * T + 4 * B * m)), k = std::sqrt(k2), K = B * k2 / T,
                  G = (1.0 + 2.0 * K) / (1.0 + K);
    const complex F1 = transform(take->force_near_N, p), F2 = transform(take->force_far_N, p),
                  force = transform(take->contact_force_N, p);
    const complex velocity = transform(take->centre_velocity_m_s, p);
    const complex near_field = -p * force / (2.0 * std::sqrt(k2 + T / B) * (T + 2.0 * B * k2));
    f_error += std::norm(G * (F1 * std::cos(k * x1) + F2 * std::cos(k * x2)) - force), f_size += std::norm(force);
    e_error += std::norm(2.0 * G * (F1 * std::sin(k * x1) - F2 * std::sin(k * x2)));
    v_error += std::norm(p * F1 * std::sin(k * x1) / (k * (T + B * k2)) + near_field - velocity), v_size += std::norm(velocity);
  }
  CHECK(std::sqrt(f_error / f_size) < 1e-4);
  CHECK(std::sqrt(e_error / f_size) < 2e-4);
  CHECK(std::sqrt(v_error / v_size) < 1e-4);
}

TEST_CASE("sticking, the surface moves with the rod; slipping, the force lies on the curve") {
  const auto take = rosin::simulate_stroke(e_rig(), curve_law{}, rosin::steady_rod{.start_s = 0.001, .rise_s = 0.004},
                                           {.duration_s = 0.05}, quick);
  REQUIRE(take);
  CHECK(rosin::motion_of(*take) == rosin::bowed_motion::stick_slip);
  CHECK(take->unconverged == 0);
  const rosin::two_exponential_curve<> curve;
  std::size_t stuck = 0, slid = 0;
  std::vector<double> slip(take->size());
  for (std::size_t n = 0; n < slip.size(); ++n)
    slip[n] = take->centre_velocity_m_s[n] + take->torsion_velocity_m_s[n] - take->rod_velocity_m_s[n];
  for (std::size_t n = 3000; n + 6 < slip.size(); ++n) {
    stuck += std::abs(slip[n]) < 5e-3 ? 1U : 0U;
    if (*std::max_element(slip.data() + n - 6, slip.data() + n + 7) > -0.4) continue;
    ++slid;  // for long enough for the low-pass to have settled, and fast enough for the curve to be flat
    CHECK(take->contact_force_N[n] / 0.3 == test::approx(curve(-slip[n]).value).epsilon(0.1));
  }
  CHECK(stuck > (slip.size() - 3000) / 2);
  CHECK(slid > 20);
}

TEST_CASE("energy: what the rod gives is rubbed away, lost in the string or in it; the string's share adds up to rounding") {
  const rosin::steady_rod rod{.start_s = 0.001, .rise_s = 0.004};
  const auto take = rosin::simulate_stroke(e_rig(), curve_law{}, rod, {.duration_s = 0.1, .account = true}, quick);
  REQUIRE(take);
  REQUIRE(take->energy);
  const auto& e = *take->energy;
  CHECK(std::abs(e.string_error()) < 1e-10);
  CHECK(std::abs(e.error()) < 3e-3);
  CHECK(e.friction_J > 0.8 * e.rod_J);
  CHECK(e.transverse.lost_J > 0);
  CHECK(e.torsion.lost_J > 0);
  CHECK(e.transverse.stored_J > 0);
  CHECK(e.left_out_J >= 0);
  double rod_J = 0;  // from the samples that come out
  for (std::size_t n = 0; n < take->size(); ++n)
    rod_J += take->contact_force_N[n] * take->rod_velocity_m_s[n] / take->sample_rate_Hz;
  CHECK(e.rod_J == test::approx(rod_J).epsilon(5e-3));
  CHECK(!rosin::simulate_stroke(e_rig(), curve_law{}, rod, {.duration_s = 0.002}, quick)->energy);
}

TEST_CASE("with a smooth law the motion converges as the steps get finer") {
  const rosin::velocity_curve law{rosin::hyperbolic_curve<>{.dynamic = 0.3, .at_rest = 0.5, .v0_m_s = 0.5}};
  const rosin::steady_rod rod{.start_s = 0.001, .rise_s = 0.004};
  std::vector<rosin::modal_take> takes;
  for (const int os : {2, 4, 16})
    takes.push_back(
        *rosin::simulate_stroke(e_rig(), law, rod, {.duration_s = 0.012}, {.oversampling = os, .mode_limit_Hz = 120e3}));
  const double coarse = difference(takes[2].force_near_N, takes[0].force_near_N),
               fine = difference(takes[2].force_near_N, takes[1].force_near_N);
  CHECK(takes[1].slips > 0);
  CHECK(fine < 0.6 * coarse);
  CHECK(fine < 0.05);
}

TEST_CASE("a rod that is too slow or pressed too hard does not make the string slip, and that is reported") {
  const auto take = rosin::simulate_stroke(e_rig(), curve_law{}, rosin::steady_rod{.speed_m_s = 0.001, .normal_force_N = 3},
                                           {.duration_s = 0.02}, quick);
  REQUIRE(take);
  CHECK(take->slips == 0);
  CHECK(rosin::motion_of(*take) == rosin::bowed_motion::sticking);
}

TEST_CASE("any law and any motion of the rod: thermal and elasto-plastic, a rod that presses late") {
  const rosin::contact_heat_parameters<> heat;
  const auto strength = rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), 0.3);
  const auto rod = [](double t) noexcept { return rosin::rod_state{0.2, t < 0.002 ? 0.0 : 0.3}; };
  const auto warm = rosin::simulate_stroke(e_rig(), rosin::thermal_plastic<>{*strength, heat}, rod, {.duration_s = 0.02}, quick);
  REQUIRE(warm);
  CHECK(std::abs(warm->contact_force_N[150]) < 1e-12);
  CHECK(*std::max_element(warm->contact_force_N.begin(), warm->contact_force_N.end()) > 0.2);
  CHECK(*std::max_element(warm->temperature_rise_K.begin(), warm->temperature_rise_K.end()) > 5);
  const auto bristles =
      rosin::simulate_stroke(e_rig(), rosin::elasto_plastic<rosin::two_exponential_curve<>>{}, rod, {.duration_s = 0.01}, quick);
  REQUIRE(bristles);
  CHECK(bristles->unconverged == 0);
  CHECK(bristles->temperature_rise_K.empty());
}

TEST_CASE("signals have the length asked for, and nothing moves before the rod does") {
  const auto take = rosin::simulate_stroke(e_rig(), curve_law{}, rosin::steady_rod{}, {.duration_s = 0.01}, quick);
  REQUIRE(take);
  CHECK(take->size() == 1280);
  CHECK(take->rod_velocity_m_s.size() == 1280);
  CHECK(take->torsion_velocity_m_s.size() == 1280);
  for (std::size_t n = 0; n < 450; ++n) CHECK(std::abs(take->force_near_N[n]) < 1e-9);
  CHECK(take->rod_velocity_m_s[1279] > 0.1);
  CHECK(!rosin::simulate_stroke(e_rig(), curve_law{}, rosin::steady_rod{}, {.duration_s = 0}));
  CHECK(!rosin::simulate_stroke(e_rig(), curve_law{}, rosin::steady_rod{}, {.position = 0}));
}

TEST_CASE("lifted, the rod leaves a string that rings freely, and what it did before is told") {
  const auto rod = [](double t) noexcept { return rosin::rod_state{0.2, t < 0.03 ? 0.3 : 0.0}; };
  const auto take = rosin::simulate_stroke(e_rig(50), curve_law{}, rod, {.duration_s = 0.07, .account = true}, quick);
  REQUIRE(take);
  CHECK(rosin::motion_of(*take) == rosin::bowed_motion::stick_slip);
  const auto power = [&](double from_s) {  // of the near force over 0.01 s
    double sum = 0;
    for (auto n = static_cast<std::size_t>(from_s * 128e3); n < static_cast<std::size_t>((from_s + 0.01) * 128e3); ++n)
      sum += take->force_near_N[n] * take->force_near_N[n];
    return sum;
  };
  for (std::size_t n = 3900; n < take->size(); ++n) CHECK(std::abs(take->contact_force_N[n]) < 1e-12);
  CHECK(power(0.055) / power(0.045) < std::exp(-2 * pi * 660 / 50 * 0.01));  // the first partial decays slowest
  CHECK(power(0.055) / power(0.045) > 0.7 * std::exp(-2 * pi * 660 / 50 * 0.01));
  CHECK(std::abs(take->energy->string_error()) < 1e-10);
}

TEST_CASE(
    "a rod that travels: standing still it is the fixed one; on its way energy still adds up, and the pattern of slips goes with "
    "it") {
  struct travelling : rosin::steady_rod {
    double from = 0.3, to = 0.3;
    [[nodiscard]] bool travels() const noexcept { return true; }
    [[nodiscard]] double position(double t) const noexcept {
      return from + (to - from) * std::clamp((t - 0.02) / 0.04, 0.0, 1.0);
    }
  };
  const rosin::steady_rod steady{.start_s = 0.001, .rise_s = 0.004};
  const auto fixed = rosin::simulate_stroke(e_rig(), curve_law{}, steady, {.position = 0.3, .duration_s = 0.003}, quick);
  const auto stays =
      rosin::simulate_stroke(e_rig(), curve_law{}, travelling{steady}, {.position = 0.9, .duration_s = 0.003}, quick);
  REQUIRE(stays);
  CHECK(difference(fixed->force_near_N, stays->force_near_N) < 1e-6);
  CHECK(difference(fixed->centre_velocity_m_s, stays->centre_velocity_m_s) < 1e-6);
  const auto moves =
      rosin::simulate_stroke(e_rig(), curve_law{}, travelling{steady, 0.3, 0.2}, {.duration_s = 0.09, .account = true}, quick);
  REQUIRE(moves);
  CHECK(std::abs(moves->energy->string_error()) < 1e-10);
  CHECK(std::abs(moves->energy->error()) < 3e-3);
  // Force and velocity at the place where the rod is then, from the forces on the ends: the balance of the lever, slowly.
  const auto share = [&](double begin_s, double end_s) {
    double near = 0, far = 0;
    for (auto n = static_cast<std::size_t>(begin_s * 128e3); n < static_cast<std::size_t>(end_s * 128e3); ++n)
      near += moves->force_near_N[n], far += moves->force_far_N[n];
    return far / (near + far);
  };
  CHECK(share(0.01, 0.02) == test::approx(0.3).epsilon(0.01));
  CHECK(share(0.07, 0.09) == test::approx(0.2).epsilon(0.03));
  const auto off = rosin::simulate_stroke(e_rig(), curve_law{}, travelling{steady, 0.3, 1.2}, {.duration_s = 0.09}, quick);
  CHECK(!off);
}

}  // namespace simulate_modal_stroke
