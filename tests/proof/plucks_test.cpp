// SPDX-License-Identifier: MIT
// 200 noisy plucks from the modal simulator: are the stated standard deviations true, and could anybody do better?
#include "pluck_statistics.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

TEST_CASE("200 plucks: errors as large as stated, within 20 %, and at most 1.3 times the Cramer-Rao bound") {
  const proof::pluck_errors e = proof::judge_plucks(1, 40, 5, rosin::damping_convention::viscous, 0.14, true);
  CHECK(e.failed == 0);
  REQUIRE(e.error.size() == 200);
  for (std::size_t i = 0; i < proof::judged_names.size(); ++i) {
    CAPTURE(proof::judged_names[i]);
    CHECK(proof::rms_ratio(e.error, e.sd, i) == test::approx(1).epsilon(0.2));
    CHECK(proof::rms_ratio(e.error, e.bound, i) < 1.3);
  }
}

TEST_CASE("with the loss in the elastic stress the error bars stay honest") {
  const proof::pluck_errors e = proof::judge_plucks(1, 20, 5, rosin::damping_convention::kelvin_voigt, 0.14, true);
  CHECK(e.failed == 0);
  for (std::size_t i = 0; i < proof::judged_names.size(); ++i) {
    CAPTURE(proof::judged_names[i]);
    CHECK(proof::coverage(e, i) > 0.88);
  }
}
