// SPDX-License-Identifier: MIT
#include <rosin/diagnose/slip_record.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

TEST_CASE("slip records: samples of each stroke that slip, with the friction that the law has there") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 61, 0.27, 0.06),
             b = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 63, 0.27, 0.06);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const auto records = rosin::slip_records(sticks, takes);
  REQUIRE(records.size() == 2);
  const rosin::two_exponential_curve<> law;
  for (const auto& r : records) {
    CHECK(r.load.empty());
    REQUIRE(r.slips.sample.size() > 200);
    CHECK(r.slips.speed_m_s.minCoeff() > 0.02);
    Eigen::VectorXd off = r.slips.friction;
    for (Eigen::Index i = 0; i < off.size(); ++i) off[i] = std::abs(off[i] - law(r.slips.speed_m_s[i]).value);
    std::sort(off.begin(), off.end());
    CHECK(off[off.size() / 2] < 0.01);
  }
  CHECK(records[0].normal_N == a.normal);
  CHECK(records[1].normal_N == b.normal);
}
