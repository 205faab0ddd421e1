// SPDX-License-Identifier: MIT
#include <rosin/simulate/burdened_string.hpp>

#include <rosin/diagnose/string_poles.hpp>

#include <doctest/doctest.h>

namespace simulate_burdened_string {

namespace {

const rosin::modal_rig rig{
    {.length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}}};
constexpr double step_s = 1 / 1024e3;

/// Forces on the near end after a pluck of 1 N at 0.3, every 16th step.
std::vector<double> decay(const rosin::string_burden& burden) {
  rosin::burdened_string string{rig, burden, {0.3}, 120e3, step_s};
  string.rest_under(Eigen::VectorXd::Ones(1));
  std::vector<double> near;
  for (int n = 0; n < 64000; ++n) {
    (void)string.free_velocity();
    const auto now = string.advance(Eigen::VectorXd::Zero(1));
    if (n % 16 == 0) near.push_back(now.end_N[0]);
  }
  return near;
}

/// The record against the sum of lines that a closed form gives: misfit over the first partials by projection on each pole.
double off_pole(const std::vector<double>& x, std::complex<double> pole, double shift_Hz) {
  const std::complex<double> rate = pole + std::complex<double>(0, 2 * 3.14159265358979323846 * shift_Hz);
  std::complex<double> sum = 0;
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double t = static_cast<double>(n) * 16 * step_s, u = static_cast<double>(n) / static_cast<double>(x.size());
    sum += x[n] * std::exp(-std::complex<double>(0, rate.imag()) * t) * std::pow(std::sin(3.14159265358979323846 * u), 2);
  }
  return std::abs(sum);
}

}  // namespace

TEST_CASE("at rest the ends carry the wire's force, whatever hangs on the string") {
  rosin::string_burden burden{.loads = {{.position = 0.6, .mass_kg = 3e-6, .stiffness_N_m = 40}},
                              .supports = {{{0.004, 1500, 10}, {}}}};
  rosin::burdened_string string{rig, burden, {0.3}, 120e3, step_s};
  string.rest_under(Eigen::VectorXd::Ones(1));
  (void)string.free_velocity();
  const auto first = string.advance(Eigen::VectorXd::Ones(1));
  for (int n = 0; n < 400; ++n) {
    (void)string.free_velocity();
    const auto now = string.advance(Eigen::VectorXd::Ones(1));
    CHECK(std::abs(now.end_N[0] - first.end_N[0]) < 1e-7);
    CHECK(std::abs(now.surface_m_s[0]) < 1e-7);
  }
  CHECK(first.end_N.sum() < 1 - 1e-3);  // the spring takes its share
  CHECK(first.end_N.sum() > 0.5);
}

TEST_CASE(
    "partials of a string with a bead, a finger, a support that yields and a bridge of two modes stand where its closed form has "
    "them") {
  const double z = rig.string.impedance_Ns_m();
  rosin::string_burden burden{.loads = {{.position = 0.41, .mass_kg = 5e-6}, {.position = 0.7, .resistance_Ns_m = 4e-4}},
                              .supports = {{{}, {0.003, 2100, 12}}}};
  burden.ends[0].modes = {{900, 10, z / 0.02}, {3300, 9, z / 0.005}};
  rosin::pluck_scene scene;
  scene.string = {rig.string.fundamental_Hz, rig.string.inharmonicity(), {1000, 0, 0}, 0};
  scene.scatterers = {{.position = 0.41, .mass_s = 5e-6 / z}, {.position = 0.7, .resistance = 4e-4 / z}};
  scene.ends[1].modes = {{2100, 12, z / 0.003}};
  scene.ends[0].modes = burden.ends[0].modes;
  const auto poles = rosin::string_poles(scene, 8000, 20);
  const auto x = decay(burden);
  for (std::size_t i = 0; i < 10; ++i) {
    if (-poles[i].real() > 200) continue;  // gone before it can be seen
    const double f = poles[i].imag() / (2 * 3.14159265358979323846);
    INFO("partial at ", f);
    double best = 0, at = 0;
    for (double shift = -20; shift <= 20; shift += 0.5)
      if (const double p = off_pole(x, poles[i], shift); p > best) best = p, at = shift;
    CHECK(std::abs(at) < 1.1 + 2e-4 * f);
  }
}

TEST_CASE("a string whose ends resist turning decays after a pluck as its closed form says, wave by wave") {
  for (const auto& clamping : {std::array{1.0, 1.0}, std::array{0.4, 1.0}}) {
    const auto x = decay({.clamping = clamping});
    rosin::pluck_scene scene;
    scene.string = {rig.string.fundamental_Hz, rig.string.inharmonicity(), {1000, 0, 0}, 0};
    for (std::size_t e = 0; e < 2; ++e) scene.ends[e].clamping = clamping[e];
    const auto lines = rosin::decay_lines(scene, 0.3, rosin::string_poles(scene, 120e3, 500));
    double off = 0, all = 0;
    for (std::size_t n = 0; n < x.size(); n += 3) {
      double y = 0;
      for (const auto& l : lines) y += (l.residue[0] * std::exp(l.pole * ((static_cast<double>(n) * 16 + 0.5) * step_s))).real();
      off += (x[n] - y) * (x[n] - y), all += y * y;
    }
    CHECK(std::sqrt(off / all) < 8e-4);
  }
}

}  // namespace simulate_burdened_string
