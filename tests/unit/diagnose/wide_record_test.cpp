// SPDX-License-Identifier: MIT
#include <rosin/diagnose/wide_record.hpp>

#include <doctest/doctest.h>

#include "two_places.hpp"

namespace {

using contact_rigs::e_string;

double error(const std::vector<double>& smooth, const std::vector<double>& truth) {
  return contact_rigs::off(smooth, contact_rigs::within_30_kHz(truth));
}

}  // namespace

TEST_CASE("wide record: both places of a wide contact follow from the ends' forces") {
  const double width = 0.005, position = 0.27;
  const auto truth = contact_rigs::drive(position, width);
  const auto take = contact_rigs::take_of(truth, position);
  const rosin::stick_record record(rosin::stick_bench::stick_takes({take}).front());
  rosin::wide_record wide(take, record);
  const rosin::torsion_values rigid{7, 1e9, 15};
  const double d = 0.5 * width / e_string.wave_speed_m_s();
  const auto right = wide.at(d, {30e3}, rigid), point = wide.at(0, {30e3}, rigid);
  CHECK(error(right.near_m_s, truth.v_near) < 0.05);
  CHECK(error(right.far_m_s, truth.v_far) < 0.05);
  CHECK(error(point.near_m_s, truth.v_near) > 2 * error(right.near_m_s, truth.v_near));
}

TEST_CASE("wide record: the same with a bead and a finger on the string, and an end that moves") {
  const double width = 0.005, position = 0.27, z = e_string.impedance_Ns_m();
  rosin::string_burden burden;
  burden.loads = {{.position = 0.12, .mass_kg = 4e-6}, {.position = 0.7, .resistance_Ns_m = 2e-3}};
  burden.supports[1] = {.mass_kg = 0.004, .frequency_Hz = 2500, .quality = 15};
  rosin::pluck_scene scene;
  for (const auto& l : burden.loads)
    scene.scatterers.push_back({.position = l.position, .mass_s = l.mass_kg / z, .resistance = l.resistance_Ns_m / z});
  scene.ends[1].modes = {{2500, 15, z / 0.004}};
  const auto truth = contact_rigs::drive(position, width, burden);
  auto take = contact_rigs::take_of(truth, position);
  const auto errors = [&] {
    const rosin::stick_record record(rosin::stick_bench::stick_takes({take}).front());
    const auto motion = rosin::wide_record(take, record).at(0.5 * width / e_string.wave_speed_m_s(), {30e3}, {7, 1e9, 15});
    return std::array{error(motion.near_m_s, truth.v_near), error(motion.far_m_s, truth.v_far)};
  };
  const auto as_plain = errors();
  take.sides = rosin::sides_of(scene, take.delay_s);
  const auto as_it_is = errors();
  for (std::size_t place = 0; place < 2; ++place) {
    INFO("place ", place, ": as plain ", as_plain[place], ", as it is ", as_it_is[place]);
    CHECK(as_it_is[place] < 0.05);
    CHECK(as_plain[place] > 5 * as_it_is[place]);
  }
}
