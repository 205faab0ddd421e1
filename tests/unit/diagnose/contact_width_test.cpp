// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_width.hpp>

#include <doctest/doctest.h>

#include "two_places.hpp"

namespace {

using contact_rigs::e_string;
using contact_rigs::rate;

double error(const std::vector<double>& a, std::vector<double> b) {
  rosin::contact_signal<> signal(b, rate);
  b = signal.through(rosin::smooth_window{30e3}, [](double) { return 1.0; });
  double off = 0, all = 0;
  for (std::size_t i = 1500; i < 6500; ++i) off += std::pow(a[i] - b[i], 2), all += b[i] * b[i];
  return std::sqrt(off / all);
}

}  // namespace

TEST_CASE("contact width: both places of a wide contact follow from the ends' forces") {
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

TEST_CASE("contact width: a contact at one point is not called wide") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  CHECK((!h || !h->decided));
}
