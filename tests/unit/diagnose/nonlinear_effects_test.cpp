// SPDX-License-Identifier: MIT
#include <rosin/diagnose/nonlinear_effects.hpp>

#include <doctest/doctest.h>

namespace {

const rosin::string_facts facts{.fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 1};
const rosin::ringing_string string{659.69, 6.49e-5, {900, 0, 0}, -1};
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
    CHECK(takes[0].force_N[1][i] == doctest::Approx(1.03 * force[i]).epsilon(1e-12));
    CHECK(takes[0].force_N[0][i] == force[i]);
  }
}

TEST_CASE("a curved sensor in front of a high-pass is straightened, what the high-pass took away and all") {
  const auto e = rosin::sensor_nonlinearity_effect(facts, 0);
  std::vector<rosin::pluck_take> takes(1);
  std::vector<double> force(16384, 0.7);  // held, let go, ringing
  for (std::size_t i = 640; i < force.size(); ++i) {
    const double t = static_cast<double>(i - 640) / 128e3;
    force[i] = std::exp(-12 * t) * (0.6 * std::cos(2 * std::numbers::pi * 659 * t) + 0.1 * std::cos(2 * std::numbers::pi * 5310 * t));
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

TEST_CASE("a string that is not stretched rings as its partials do") {
  const auto force = rosin::stretching_pluck(string, 0.3, 0.01, limits, 200).run(0, 3e-6, 1 / 128e3, 4, 2000).force;
  const auto lines = rosin::pluck_lines(string, 0.3, 0, limits, 200);
  for (const std::size_t i : {50U, 333U, 1999U})
    for (std::size_t c = 0; c < 2; ++c) {
      double sum = 0;
      for (const auto& l : lines) sum += (l.residue[c] * std::exp(l.pole * (static_cast<double>(i) / 128e3 + 3e-6))).real();
      CHECK(force[c][i] == doctest::Approx(sum).epsilon(2e-3).scale(0.3));
    }
}

TEST_CASE("a single mode under its own tension rises in pitch as Duffing's equation says: df/f = (3/8) e, half of it shared with a turn of phase") {
  // q'' + w^2 (1 + s q^2) q = 0 oscillates at w (1 + 3 s A^2 / 8): amplitude A of the slope, s the stretch.
  const rosin::ringing_string pure{100, 0, {1e9, 0, 0}, -1};
  const double h = 1 / 64e3, stretch = 0.5, slope = 0.02;
  const rosin::stretching_pluck one(pure, 0.5, slope, {150, 150}, 1);  // only the first partial
  const auto force = one.run(stretch, 0, h, 1, 64000).force[0];
  const double amplitude = slope * 2 / std::numbers::pi;
  int crossings = 0;
  double first = 0, last = 0;
  for (std::size_t i = 1; i < force.size(); ++i)
    if (force[i - 1] < 0 && force[i] >= 0) {
      last = static_cast<double>(i - 1) + force[i - 1] / (force[i - 1] - force[i]);
      if (crossings++ == 0) first = last;
    }
  const double f = (crossings - 1) / ((last - first) * h);
  CHECK(f / 100 - 1 == doctest::Approx(3 * stretch * amplitude * amplitude / 8).epsilon(0.02));
}

TEST_CASE("what stretching puts in is taken out: larger with the square of the pluck") {
  const auto e = rosin::tension_modulation_effect(facts, limits);
  const auto change = [&](double newtons) {
    std::vector<rosin::pluck_take> takes(1);
    takes[0].rate_Hz = 128e3, takes[0].position = 0.3;
    takes[0].force_N = {std::vector<double>(3000, 0.0), std::vector<double>(3000, 0.0)};
    const rosin::pluck_layout layout(takes, {});
    Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
    v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.3, v[layout.at(0, 0)] = 0.002, v[layout.at(0, 1)] = std::log(newtons);
    e.undo(takes, {}, layout, v, 1e4);
    double power = 0;
    for (std::size_t i = 300; i < 900; ++i) power += std::pow(takes[0].force_N[0][i], 2);
    return std::sqrt(power) / newtons;
  };
  CHECK(change(0.2) / change(0.1) == doctest::Approx(4).epsilon(0.05));
}

TEST_CASE("a string with the mean stretch rings nearly as the stretched one does: what is left to take out is small") {
  const double slope = 0.02, stretch = 40, sample_s = 1 / 128e3;  // the pitch rises by some tenths of a per cent
  const auto all = [](double stop) { return rosin::band{stop, stop}; };
  const double relative = rosin::mean_stretch(string, 0.3, slope, stretch, 6);
  CHECK(relative > 0.002);
  const auto stretched = rosin::stretching_pluck(string, 0.3, slope, all(50e3), 200).run(stretch, 0, sample_s, 4, 1900).force;
  const auto mean = rosin::stretching_pluck(rosin::tightened(string, relative), 0.3, slope, all(50e3), 200).run(0, 0, sample_s, 4, 1900).force;
  const auto slack = rosin::stretching_pluck(string, 0.3, slope, all(50e3), 200).run(0, 0, sample_s, 4, 1900).force;
  double from_mean = 0, from_slack = 0;
  for (std::size_t i = 0; i < mean[0].size(); ++i) from_mean += std::pow(stretched[0][i] - mean[0][i], 2), from_slack += std::pow(stretched[0][i] - slack[0][i], 2);
  CHECK(std::sqrt(from_mean) < 0.15 * std::sqrt(from_slack));
}

TEST_CASE("the strain of a released string: as much as was held, and half of it once a period has mixed what moves with what is stretched") {
  const rosin::ringing_string ideal{500, 0, {1e9, 0, 0}, -1};
  const double rate = 200e3, slope = 0.01, at = 0.3;
  const rosin::stretching_pluck pluck(ideal, at, slope, {90e3, 90e3}, 400);
  // Held at 0.3: slopes F (1 - at) / T and -F at / T.
  const double held = 0.5 * slope * slope * (at * (1 - at) * (1 - at) + (1 - at) * at * at);
  CHECK(pluck.held_strain() == doctest::Approx(held).epsilon(0.01));
  const auto strain = pluck.run(0, 0, 1 / rate, 1, 400).strain;  // one period
  CHECK(strain[0] == doctest::Approx(held).epsilon(0.01));
  double mean = 0;
  for (const double s : strain) mean += s / 400;
  CHECK(mean == doctest::Approx(held / 2).epsilon(0.02));
  for (std::size_t i = 0; i < 200; ++i) CHECK(strain[i] == doctest::Approx(strain[i + 200]).epsilon(0.01).scale(held));  // twice a period
}

TEST_CASE("what a sensor feels of the tension is taken out, before the release and after") {
  const auto e = rosin::phantom_partials_effect(facts, limits, 1);
  std::vector<rosin::pluck_take> takes(1);
  takes[0].rate_Hz = 128e3, takes[0].position = 0.3;
  takes[0].force_N = {std::vector<double>(3000, 0.0), std::vector<double>(3000, 0.0)};
  const rosin::pluck_layout layout(takes, {});
  Eigen::VectorXd v = Eigen::VectorXd::Zero(layout.size());
  v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[layout.position(0)] = 0.3, v[layout.at(0, 0)] = 0.002, v[layout.at(0, 1)] = std::log(0.8);
  e.undo(takes, {}, layout, v, 5e3);
  const auto& far = takes[0].force_N[1];
  const double tension = facts.impedance_Ns_m * 2 * facts.length_m * facts.fundamental_Hz, held = 0.5 * 0.3 * 0.7 * std::pow(0.8 / tension, 2) * 5e3;
  CHECK(far[10] == doctest::Approx(-held).epsilon(0.02));
  CHECK(far[257] == doctest::Approx(-held).epsilon(0.05));  // at once after the release
  double least = 0, most = -1;
  for (std::size_t i = 400; i < 800; ++i) least = std::min(least, far[i]), most = std::max(most, far[i]);
  CHECK(most > -0.06 / 0.21 * held);  // slopes of 0.2 and -0.3 a quarter period on, of 0.7 and -0.3 before
  CHECK(least < -0.8 * held);
  for (const double x : takes[0].force_N[0]) CHECK(x == 0);
}
