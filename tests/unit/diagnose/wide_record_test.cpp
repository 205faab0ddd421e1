// SPDX-License-Identifier: MIT
#include <rosin/diagnose/wide_record.hpp>

#include <doctest/doctest.h>

#include "two_places.hpp"

namespace {

using contact_rigs::e_string;

double error(const std::vector<double>& smooth, const std::vector<double>& truth) { return contact_rigs::off(smooth, contact_rigs::within_30_kHz(truth)); }

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
