// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_pluck.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_pluck {

namespace {

constexpr double pi = 3.14159265358979323846;
using complex = std::complex<double>;

rosin::modal_rig e_rig(double quality = 1000) {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = quality}}};
}

/// F0 sum 2/(n pi) sin(n pi beta) Re{(1 + i psi / (2 Q)) exp((i w - w / (2 Q)) t)}, smoothed by brute force.
double closed_form(const rosin::modal_rig& rig, const rosin::modal_pluck& pluck, double psi, double time, bool near) {
  const auto h = rosin::modal_settings{}.low_pass();
  const auto& s = rig.string;
  const double step = 1 / (128e3 * 24), Q = s.loss.quality;
  double sum = 0;
  for (double u = -h.half_width_s(); u <= h.half_width_s(); u += step) {
    const double t = time - u - pluck.release_s;
    double force = near ? 1 - pluck.position : pluck.position;
    if (t >= 0) {
      force = 0;
      for (int n = 1; n <= 330; ++n) {
        const double w = 2 * pi * n * s.fundamental_Hz * std::sqrt(1 + s.inharmonicity() * n * n);
        const double a = 2 / (n * pi) * std::sin(n * pi * pluck.position) * (near || n % 2 == 1 ? 1 : -1);
        force += a * std::exp(-w * t / (2 * Q)) * (std::cos(w * t) - psi / (2 * Q) * std::sin(w * t));
      }
    }
    sum += step * h(u) * pluck.force_N * force;
  }
  return sum;
}

}  // namespace

TEST_CASE("agrees with the closed form summed by brute force, in both conventions of damping") {
  auto rig = e_rig();
  const rosin::modal_pluck pluck{.position = 0.3, .force_N = 0.8, .release_s = 0.0020013, .duration_s = 0.012};
  for (const bool in_stress : {false, true}) {
    rig.damping = in_stress ? rosin::damping_convention::kelvin_voigt : rosin::damping_convention::viscous;
    const auto take = rosin::simulate_pluck(rig, pluck);
    REQUIRE(take);
    for (const std::size_t n : {250U, 262U, 300U, 333U, 900U, 1500U}) {
      const double time = static_cast<double>(n) / 128e3;
      CAPTURE(n);
      CHECK(std::abs(take->force_near_N[n] - closed_form(rig, pluck, in_stress ? 1 : -1, time, true)) < 5e-5);
      CHECK(std::abs(take->force_far_N[n] - closed_form(rig, pluck, in_stress ? 1 : -1, time, false)) < 5e-5);
    }
  }
}

TEST_CASE("before the release the wire's force is shared as a lever shares it") {
  const auto take = rosin::simulate_pluck(e_rig(), {.position = 0.37, .force_N = 0.75, .release_s = 0.004, .duration_s = 0.01});
  REQUIRE(take);
  CHECK(take->size() == 1280);
  for (const std::size_t n : {0U, 100U, 460U}) {
    CHECK(take->force_near_N[n] == test::approx(0.75 * 0.63));
    CHECK(take->force_far_N[n] == test::approx(0.75 * 0.37));
    CHECK(take->contact_force_N[n] == test::approx(0.75));
    CHECK(std::abs(take->centre_velocity_m_s[n]) < 1e-6);
  }
  CHECK(take->contact_force_N[512] == test::approx(0.375).epsilon(1e-6));  // the low-passed step is half way at t0
  CHECK(take->contact_force_N[1000] == 0.0);
}

TEST_CASE("frequency and Q of the recorded partials are the string's") {
  const auto rig = e_rig(700);
  const auto take = rosin::simulate_pluck(rig, {.position = 0.23, .release_s = 0.004, .duration_s = 0.14});
  REQUIRE(take);
  for (const int n : {1, 2, 7, 20, 50}) {
    const double w = 2 * pi * n * 660 * std::sqrt(1 + rig.string.inharmonicity() * n * n);
    const auto line = [&](std::size_t first) {  // amplitude of one partial, others suppressed by a smooth window
      complex sum = 0;
      for (std::size_t i = 0; i < 4096; ++i) {
        const double t = static_cast<double>(first + i) / 128e3;
        const double window = std::pow(std::sin(pi * static_cast<double>(i) / 4096), 4);
        sum += take->force_near_N[first + i] * window * std::exp(complex{0, -w * t});
      }
      return sum;
    };
    const auto ratio = line(9000) / line(1000);
    const double time = 8000 / 128e3;
    CAPTURE(n);
    CHECK(std::abs(std::arg(ratio)) < 2e-3 + w * time / (8 * 700.0 * 700.0) * 1.1);  // damping lowers the pitch by 1/(8 Q^2)
    CHECK(-std::log(std::abs(ratio)) / time == test::approx(w / (2 * 700)).epsilon(2e-3));
  }
}

TEST_CASE("a slow release is the mean of sudden ones over its course") {
  const double d = 60e-6;
  const rosin::modal_pluck slow{.position = 0.3, .release_s = 0.002, .release_duration_s = d, .duration_s = 0.008};
  const auto take = rosin::simulate_pluck(e_rig(), slow);
  REQUIRE(take);
  std::vector<double> near(take->size()), force(take->size()), velocity(take->size());
  const int parts = 40;
  for (int i = 0; i < parts; ++i) {  // equal shares of the force: F falls by 1/parts around each time
    auto sudden = slow;
    sudden.release_duration_s = 0;
    sudden.release_s = 0.002 + d / pi * std::acos(1 - 2 * (i + 0.5) / parts);
    const auto part = rosin::simulate_pluck(e_rig(), sudden);
    for (std::size_t n = 0; n < near.size(); ++n) {
      near[n] += part->force_near_N[n] / parts;
      force[n] += part->contact_force_N[n] / parts;
      velocity[n] += part->centre_velocity_m_s[n] / parts;
    }
  }
  for (std::size_t n = 0; n < near.size(); n += 7) {
    CHECK(std::abs(take->force_near_N[n] - near[n]) < 6e-4);
    CHECK(std::abs(take->contact_force_N[n] - force[n]) < 6e-4);
    CHECK(std::abs(take->centre_velocity_m_s[n] - velocity[n]) < 3e-3);
  }
}

TEST_CASE("the contact's velocity is that of a point force on a stiff string") {
  // transforms of the change since rest: v = i w f [sin k x1 sin k x2 / (k sin k L) - near field] / (T + 2 B k^2)
  auto rig = e_rig(1e7);
  const double beta = 0.3, sigma = 400;
  const auto take = rosin::simulate_pluck(rig, {.position = beta, .release_s = 0.002, .duration_s = 0.06});
  REQUIRE(take);
  const auto& s = rig.string;
  const auto transform = [&](const std::vector<double>& x, complex p) {
    complex sum = 0;
    for (std::size_t n = 0; n < x.size(); ++n) sum += (x[n] - x[0]) * std::exp(-p * (static_cast<double>(n) / 128e3));
    return sum;
  };
  for (const double f : {500.0, 3100.0, 9700.0, 20000.0}) {
    const complex p{sigma, 2 * pi * f}, m = -s.linear_density_kg_m() * p * p;
    const double T = s.tension_N, B = s.bending_stiffness_Nm2, x1 = beta * s.length_m, x2 = s.length_m - x1;
    const complex k2 = 2.0 * m / (T + std::sqrt(T * T + 4 * B * m)), k = std::sqrt(k2), kappa = std::sqrt(k2 + T / B);
    const complex waves = std::sin(k * x1) * std::sin(k * x2) / (k * std::sin(k * (x1 + x2)));
    const complex expected = p * (waves - 1.0 / (2.0 * kappa)) / (T + 2 * B * k2) * transform(take->contact_force_N, p);
    CAPTURE(f);
    CHECK(std::abs(transform(take->centre_velocity_m_s, p) / expected - 1.0) < 1e-3);
  }
}

TEST_CASE("modes left out hardly matter") {
  const rosin::modal_pluck pluck{.duration_s = 0.02};
  const auto few = rosin::simulate_pluck(e_rig(), pluck), many = rosin::simulate_pluck(e_rig(), pluck, {.mode_limit_Hz = 1e6});
  for (std::size_t n = 0; n < few->size(); ++n) {
    CHECK(std::abs(few->force_near_N[n] - many->force_near_N[n]) < 5e-5);
    CHECK(std::abs(few->centre_velocity_m_s[n] - many->centre_velocity_m_s[n]) < 5e-4);
  }
}

TEST_CASE("a release before the recording begins is the tail of the same motion") {
  const rosin::modal_pluck early{.release_s = 1.0 / 128e3, .duration_s = 0.01}, late{.release_s = 0.004, .duration_s = 0.02};
  const auto a = rosin::simulate_pluck(e_rig(), early), b = rosin::simulate_pluck(e_rig(), late);
  for (std::size_t n = 0; n < a->size(); n += 3) CHECK(a->force_far_N[n] == test::approx(b->force_far_N[n + 511]).epsilon(1e-9));
}

TEST_CASE("senseless plucks are refused") {
  CHECK(!rosin::simulate_pluck(e_rig(), {.position = 1.2}));
  CHECK(!rosin::simulate_pluck(e_rig(), {.release_s = 0}));
  CHECK(!rosin::simulate_pluck(e_rig(), {.release_s = 0.2}));
  CHECK(!rosin::simulate_pluck(e_rig(), {.release_duration_s = 1}));
  CHECK(!rosin::simulate_pluck(e_rig(), {.duration_s = -1}));
  CHECK(!rosin::simulate_pluck({}, {}));
  CHECK(rosin::simulate_pluck({}, {}).error() == "string: length, tension and pitch must be above 0");
}

}  // namespace simulate_modal_pluck
