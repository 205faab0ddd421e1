// SPDX-License-Identifier: MIT
#include <rosin/diagnose/nonlinear_effects.hpp>

#include <rosin/simulate/burdened_sensors.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

const rosin::string_facts facts{
    .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 1};
constexpr rosin::band limits{40e3, 50e3};

}  // namespace

TEST_CASE("a curved sensor is straightened exactly") {
  const auto e = rosin::sensor_nonlinearity_effect(facts, 1);
  std::vector<rosin::pluck_take> takes(1);
  const std::vector<double> force{-0.8, -0.1, 0, 0.3, 0.9};
  takes[0].force_N = {force, force};
  for (double& y : takes[0].force_N[1]) y = 1.03 * (y + 0.04 * y * y);
  takes[0].position = 0.3;
  const rosin::pluck_layout layout(takes, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[rosin::pluck_layout::gain_far] = std::log(1.03);
  e.undo(takes, {}, layout, v, 0.04);
  for (std::size_t i = 0; i < force.size(); ++i) {
    CHECK(takes[0].force_N[1][i] == test::approx(1.03 * force[i]).scale(1).epsilon(1e-12));
    CHECK(takes[0].force_N[0][i] == force[i]);
  }
}

TEST_CASE("a curved sensor in front of a high-pass is straightened, what the high-pass took away and all") {
  const auto e = rosin::sensor_nonlinearity_effect(facts, 0);
  std::vector<rosin::pluck_take> takes(1);
  std::vector<double> force(16384, 0.7);  // held, let go, ringing
  for (std::size_t i = 640; i < force.size(); ++i) {
    const double t = static_cast<double>(i - 640) / 128e3;
    force[i] =
        std::exp(-12 * t) * (0.6 * std::cos(2 * std::numbers::pi * 659 * t) + 0.1 * std::cos(2 * std::numbers::pi * 5310 * t));
  }
  std::vector<double> straight = force, curved = force;
  for (double& y : curved) y += 0.03 * y * y;
  rosin::pass_ac_coupled(std::span(straight), 2.7, 128e3);
  rosin::pass_ac_coupled(std::span(curved), 2.7, 128e3);
  for (double& y : curved) y *= 0.98;
  takes[0].force_N = {curved, curved};
  takes[0].rate_Hz = 128e3;
  const rosin::pluck_layout layout(takes, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[rosin::pluck_layout::gain_near] = std::log(0.98);
  const auto left = [&](double corner_Hz) {
    auto once = takes;
    rosin::pluck_scene coupled;
    coupled.sensors[0].corner_Hz = corner_Hz;
    e.undo(once, coupled, layout, v, 0.03);
    double most = 0;
    for (std::size_t i = 0; i < force.size(); ++i) most = std::max(most, std::abs(once[0].force_N[0][i] - 0.98 * straight[i]));
    return most;
  };
  CHECK(left(2.7) < 1e-4);
  CHECK(left(0) > 1e-2);  // as if the sensor had felt what was recorded
}

TEST_CASE("what stretching puts in is taken out: larger with the square of the pluck") {
  const auto e = rosin::tension_modulation_effect(facts, limits);
  const auto change = [&](double newtons) {
    std::vector<rosin::pluck_take> takes(1);
    takes[0].rate_Hz = 128e3, takes[0].position = 0.3;
    takes[0].force_N = {std::vector<double>(3000, 0.0), std::vector<double>(3000, 0.0)};
    const rosin::pluck_layout layout(takes, {});
    Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
    v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.3, v[layout.at(0, 0)] = 0.002,
    v[layout.at(0, 1)] = std::log(newtons);
    rosin::pluck_scene scene;
    scene.string = layout.string(v);
    e.undo(takes, scene, layout, v, 1e4);
    double power = 0;
    for (std::size_t i = 300; i < 900; ++i) power += std::pow(takes[0].force_N[0][i], 2);
    return std::sqrt(power) / newtons;
  };
  CHECK(change(0.2) / change(0.1) == test::approx(4).epsilon(0.05));
}

TEST_CASE("what stretching puts in is that of the string as other effects make it: stiff, damped") {
  std::vector<rosin::pluck_take> none(1);
  none[0].rate_Hz = 128e3, none[0].position = 0.17;
  none[0].force_N = {std::vector<double>(2000, 0.0), std::vector<double>(2000, 0.0)};
  const rosin::pluck_layout layout(none, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[0] = 659.69, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.17, v[layout.at(0, 0)] = 0.002,
  v[layout.at(0, 1)] = std::log(0.8);
  Eigen::VectorXd declared = v;
  declared[1] = 6.49e-5;
  const auto apart = [&](const rosin::pluck_effect& e, double value) {
    const auto taken_out = [&](const Eigen::VectorXd& known, double inharmonicity) {
      auto takes = none;
      rosin::pluck_scene scene;
      scene.string = layout.string(known), scene.string.inharmonicity = inharmonicity;
      e.undo(takes, scene, layout, known, value);
      return takes[0].force_N[1];
    };
    const auto known = taken_out(declared, 6.49e-5), effect = taken_out(v, 6.49e-5), flexible = taken_out(v, 0);
    double off = 0, ignored = 0, all = 0;
    for (std::size_t i = 0; i < known.size(); ++i)
      off += std::pow(effect[i] - known[i], 2), ignored += std::pow(flexible[i] - known[i], 2), all += std::pow(known[i], 2);
    return std::array{std::sqrt(off / all), std::sqrt(ignored / all)};
  };
  // what the stretched string is set against is tuned by the mean tension of the declared one
  const auto stretching = apart(rosin::tension_modulation_effect(facts, limits), 1e4),
             phantoms = apart(rosin::phantom_partials_effect(facts, limits, 1), 5e3);
  CHECK(stretching[0] < 0.1);
  CHECK(stretching[1] > 0.3);
  CHECK(phantoms[0] < 1e-9);
  CHECK(phantoms[1] > 0.01);
}

TEST_CASE("what a sensor feels of the tension is taken out, before the release and after") {
  const auto e = rosin::phantom_partials_effect(facts, limits, 1);
  std::vector<rosin::pluck_take> takes(1);
  takes[0].rate_Hz = 128e3, takes[0].position = 0.3;
  takes[0].force_N = {std::vector<double>(3000, 0.0), std::vector<double>(3000, 0.0)};
  const rosin::pluck_layout layout(takes, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.3, v[layout.at(0, 0)] = 0.002,
  v[layout.at(0, 1)] = std::log(0.8);
  rosin::pluck_scene scene;
  scene.string = layout.string(v);
  e.undo(takes, scene, layout, v, 5e3);
  const auto& far = takes[0].force_N[1];
  const double tension = facts.impedance_Ns_m * 2 * facts.length_m * facts.fundamental_Hz,
               held = 0.5 * 0.3 * 0.7 * std::pow(0.8 / tension, 2) * 5e3;
  CHECK(far[10] == test::approx(-held).epsilon(0.02));
  CHECK(far[257] == test::approx(-held).epsilon(0.05));  // at once after the release
  double least = 0, most = -1;
  for (std::size_t i = 400; i < 800; ++i) least = std::min(least, far[i]), most = std::max(most, far[i]);
  CHECK(most > -0.06 / 0.21 * held);  // slopes of 0.2 and -0.3 a quarter period on, of 0.7 and -0.3 before
  CHECK(least < -0.8 * held);
  for (const double x : takes[0].force_N[0]) CHECK(x == 0);
}

TEST_CASE("a sensor that bends before it rings: what it makes of the bend is taken out") {
  constexpr double curve = 0.03, rate = 128e3;
  constexpr std::size_t fine = 16, count = 4096;
  std::vector<double> force(count * fine), bent;
  for (std::size_t i = 0; i < force.size(); ++i) {
    const double t = static_cast<double>(i) / (rate * fine) - 0.003;
    force[i] = t < 0 ? 0.6
                     : std::exp(-40 * t) *
                           (0.4 * std::cos(2 * std::numbers::pi * 640 * t) + 0.2 * std::cos(2 * std::numbers::pi * 3210 * t));
  }
  bent = force;
  for (double& f : bent) f += curve * f * f;
  for (auto* x : {&force, &bent}) rosin::detail::ring_along(*x, 12e3, 15, 1 / (rate * fine));
  const auto every = [](const std::vector<double>& x) {
    std::vector<double> out;
    for (std::size_t i = 0; i < x.size(); i += fine) out.push_back(x[i]);
    return out;
  };
  const auto straight = every(force);
  const rosin::pluck_layout layout({rosin::pluck_take{.position = 0.3}}, {});
  rosin::pluck_scene ringing;
  ringing.sensors[1].resonance_Hz = 12e3, ringing.sensors[1].q = 15;
  const auto left = [&](rosin::bending where) {
    std::vector<rosin::pluck_take> takes(1);
    takes[0].force_N = {straight, every(bent)}, takes[0].rate_Hz = rate;
    rosin::sensor_nonlinearity_effect(facts, 1, where).undo(takes, ringing, layout, Eigen::VectorXd::Zero(layout.size()), curve);
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += std::pow(takes[0].force_N[1][i] - straight[i], 2) / count;
    CHECK(takes[0].force_N[0] == straight);
    return std::sqrt(sum);
  };
  CHECK(rosin::sensor_nonlinearity_effect(facts, 1, rosin::bending::before_ringing).id() ==
        "sensor-nonlinearity@far before it rings");  // the key that `simulate --model` looks for
  const double as_it_is = left(rosin::bending::before_ringing), other_way = left(rosin::bending::behind_ringing);
  CHECK(as_it_is < 1e-4);
  CHECK(other_way > 5 * as_it_is);
}

TEST_CASE("stretching as the channels record it: behind a high-pass, late, leaking, from a wire that lets go slowly") {
  const auto e = rosin::tension_modulation_effect(facts, limits);
  rosin::pluck_take take{.rate_Hz = 128e3, .position = 0.3};
  take.force_N = {std::vector<double>(4000, 0.0), std::vector<double>(4000, 0.0)};
  const rosin::pluck_layout layout({take}, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.3, v[layout.at(0, 0)] = 0.002,
  v[layout.at(0, 1)] = std::log(0.8);
  const auto taken_out = [&](rosin::pluck_scene scene) {
    scene.string = layout.string(v);
    std::vector<rosin::pluck_take> takes{take};
    e.undo(takes, scene, layout, v, 1e4);
    return takes[0].force_N;
  };
  rosin::pluck_scene heard;
  heard.crosstalk = 0.05, heard.sensors[0].corner_Hz = heard.sensors[1].corner_Hz = 20, heard.sensors[1].delay_s = 4e-6,
  heard.release_duration_s = 40e-6;
  auto expected = taken_out({});
  rosin::pass_wire(expected, heard, take.rate_Hz);
  rosin::pass_sensors(expected, heard, take.rate_Hz);
  const auto out = taken_out(heard);
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = 300; i < 1800; i += 37) CHECK(out[c][i] == test::approx(expected[c][i]).epsilon(0.01).scale(0.02));
}
