// SPDX-License-Identifier: MIT
// What is put into a stepped modal string acts where the search says; the closed forms that are propagated back had no part in
// it.
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/simulate/burdened_signals.hpp>

#include "plucked.hpp"

#include <doctest/doctest.h>

namespace {

/// Recordings with a burden less those without, from just behind the release on.
rosin::unexplained_part difference(const rosin::rig_burden& burden) {
  const rosin::modal_pluck wire{.position = 0.3, .force_N = 1, .release_s = 0.004, .duration_s = 0.03};
  const auto with = rosin::simulate_pluck(test::plucked_rig, burden, wire),
             without = rosin::simulate_pluck(test::plucked_rig, {}, wire);
  rosin::unexplained_part out{{}, {}, with->sample_rate_Hz};
  const auto from = static_cast<std::size_t>(0.004 * out.rate_Hz) + 40;
  std::mt19937_64 random{7};
  std::normal_distribution<double> noise{0, 1e-4};
  for (std::size_t c = 0; c < 2; ++c) {
    const auto &a = c == 0 ? with->force_near_N : with->force_far_N, &b = c == 0 ? without->force_near_N : without->force_far_N;
    out.force_N[c].resize(static_cast<Eigen::Index>(a.size() - from));
    for (std::size_t i = from; i < a.size(); ++i)
      out.force_N[c][static_cast<Eigen::Index>(i - from)] = a[i] - b[i] + noise(random);
  }
  return out;
}

rosin::place_search<> search_of(const rosin::unexplained_part& part) {
  rosin::pluck_scene scene;
  const auto& s = test::plucked_rig.string;
  const double pi = 3.14159265358979323846;
  scene.string.fundamental_Hz = s.fundamental_Hz,
  scene.string.inharmonicity = pi * pi * s.bending_stiffness_Nm2 / (s.tension_N * s.length_m * s.length_m);
  scene.string.loss.quality = 900;
  return rosin::place_search(scene, {1, 1}, {43e3, 54e3}, part, {1e-4, 1e-4});
}
rosin::acting_place place_of(const rosin::unexplained_part& part) { return search_of(part)(); }
rosin::acting_place place_of(const rosin::rig_burden& burden) { return place_of(difference(burden)); }

/// y = b0 x + b1 x' + b2 x'' - a1 y' - a2 y''
void filter(std::vector<double>& x, const std::array<double, 3>& b, double a1, double a2) {
  std::array<double, 2> in{}, out{};
  for (double& v : x) {
    const double y = b[0] * v + b[1] * in[0] + b[2] * in[1] - a1 * out[0] - a2 * out[1];
    in = {v, in[0]}, out = {y, out[0]}, v = y;
  }
}

/// Both channels behind one all-pass filter at 8 kHz. turn: 2 pi / rate.
void filter_alike(std::array<std::vector<double>, 2>& x, double turn) {
  const double r = 0.8, middle = -2 * r * std::cos(8e3 * turn);
  for (auto& channel : x) filter(channel, {r * r, middle, 1}, middle, r * r);
}

/// What that changes, from nearly half a period behind the release on.
rosin::unexplained_part filtered_alike() {
  const auto heard = rosin::simulate_pluck(test::plucked_rig, {}, {.position = 0.3, .release_s = 0.004, .duration_s = 0.03});
  rosin::unexplained_part out{{}, {}, heard->sample_rate_Hz};
  const auto from = static_cast<std::size_t>((0.004 + 0.48 / test::plucked_rig.string.fundamental_Hz) * out.rate_Hz);
  const std::array<std::vector<double>, 2> x{heard->force_near_N, heard->force_far_N};
  auto y = x;
  filter_alike(y, 2 * 3.14159265358979323846 / out.rate_Hz);
  for (std::size_t c = 0; c < 2; ++c) {
    out.force_N[c].resize(static_cast<Eigen::Index>(x[c].size() - from));
    for (std::size_t i = from; i < x[c].size(); ++i) out.force_N[c][static_cast<Eigen::Index>(i - from)] = y[c][i] - x[c][i];
  }
  return out;
}

}  // namespace

TEST_CASE("mismatch: the place of a bead and of a finger, from what they change at both ends") {
  rosin::rig_burden bead, finger;
  bead.string.loads = {{.position = 0.73, .mass_kg = 2e-6}};
  finger.string.loads = {{.position = 0.41, .resistance_Ns_m = 2e-3}};
  for (const auto& [burden, x] : {std::pair{bead, 0.73}, std::pair{finger, 0.41}}) {
    const auto found = place_of(burden);
    CHECK(found.on == rosin::acting::on_string);
    CHECK(std::abs(found.position - x) < 0.002);
    CHECK(found.left < 0.05);
  }
}

TEST_CASE("mismatch: an end that moves, and a channel that rings by itself") {
  rosin::rig_burden support, sensor;
  support.string.supports[1] = {.mass_kg = 5e-3, .frequency_Hz = 2500, .quality = 12};
  sensor.sensors.resonance_Hz[0] = 15e3, sensor.sensors.resonance_q[0] = 10;
  const auto end = place_of(support), channel = place_of(sensor);
  CHECK(end.on == rosin::acting::far_end);
  CHECK(end.left < 0.05);
  CHECK(channel.on == rosin::acting::near_channel);
  CHECK(channel.left < 0.01);
}

TEST_CASE("mismatch: a channel that rings by itself, beside gains that show in one channel each") {
  rosin::rig_burden sensor;
  sensor.sensors.resonance_Hz[0] = 15e3, sensor.sensors.resonance_q[0] = 10;
  auto part = difference(sensor);
  const auto heard = rosin::simulate_pluck(test::plucked_rig, {}, {.position = 0.3, .release_s = 0.004, .duration_s = 0.03});
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& x = c == 0 ? heard->force_near_N : heard->force_far_N;
    const Eigen::Index size = part.force_N[c].size();
    part.nuisances.push_back({Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size)});
    part.nuisances.back()[c] = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).tail(size);
  }
  const auto search = search_of(part);
  const auto found = search();
  CHECK(found.on == rosin::acting::near_channel);
  CHECK(found.left < 0.01);
  CHECK(found.left_elsewhere > 10 * found.left);
  CHECK(search.is_clear(found));
}

TEST_CASE("mismatch: what both channels do alike acts where the string is plucked, though the search finds the mirror image") {
  const auto found = place_of(filtered_alike());
  CHECK(found.on == rosin::acting::on_string);
  CHECK(found.left < 0.1);
  const auto told = rosin::where_plucked(found, 0.3);
  CHECK(told.on == rosin::acting::with_release);
  CHECK(told.position == 0.3);
  const auto elsewhere = rosin::where_plucked(found, 0.35);
  CHECK(elsewhere.on == rosin::acting::on_string);
  CHECK(elsewhere.position == found.position);
}

namespace {

/// Where the whole diagnosis, by a catalogue that knows nothing, says that it acts.
rosin::pluck_mismatch told_of(const rosin::rig_burden& burden, auto alter) {
  auto takes = test::recorded_plucks({1, 0.5, 0.75}, [&](double force_N) {
    return rosin::simulate_pluck(test::plucked_rig, burden,
                                 {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.06});
  });
  for (auto& take : takes) alter(take.force_N, 2 * 3.14159265358979323846 / take.rate_Hz);
  const auto held = test::last_of(takes);
  const auto d = rosin::diagnose_plucks(takes, held, {.fundamental_Hz = 660}, {},
                                        [](const auto&) { return std::vector<rosin::pluck_effect>{}; });
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->mismatched);
  return d->mismatch;
}

}  // namespace

TEST_CASE("mismatch: where the fit's nuisances have taken up what they can, only what is clear is told" *
          doctest::test_suite("long")) {
  rosin::rig_burden finger, support;
  finger.string.loads = {{.position = 0.41, .resistance_Ns_m = 2e-3}};
  support.string.supports[1] = {.mass_kg = 5e-3, .frequency_Hz = 2500, .quality = 12};
  const auto as_is = [](auto&, double) {};
  const auto notch = [](auto& x, double turn) {
    const double w = 5e3 * turn, a = std::sin(w) / 10, whole = 1 + a, middle = -2 * std::cos(w) / whole;
    filter(x[1], {1 / whole, middle, 1 / whole}, middle, (1 - a) / whole);
  };
  const auto touched = told_of(finger, as_is).place, alike = told_of({}, filter_alike).place;
  const auto sounds = told_of({}, notch);
  REQUIRE(touched);
  CHECK(touched->on == rosin::acting::on_string);
  CHECK(std::abs(touched->position - 0.41) < 0.003);
  REQUIRE(sounds.place);
  CHECK(sounds.place->on == rosin::acting::far_channel);
  CHECK(sounds.channel == 1);
  CHECK(sounds.residual_over_noise > 2);
  REQUIRE(alike);
  CHECK(alike->on == rosin::acting::with_release);
  CHECK(std::abs(alike->position - 0.3) < 0.001);
  const auto unclear = told_of(support, as_is).place;  // most of it could be the string's pitch and loss
  CHECK((!unclear || unclear->on == rosin::acting::far_end));
}
