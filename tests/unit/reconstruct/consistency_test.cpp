// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/consistency.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/approx.hpp"

namespace reconstruct_consistency {

TEST_CASE("Delta is 0 for equal waveforms, 1 for uncorrelated ones, sqrt(2) for opposite ones") {
  std::vector<double> a, b, shifted, opposite;
  for (int i = 0; i < 1000; ++i) {
    a.push_back(std::sin(0.2 * 3.14159265358979323846 * i));
    b.push_back(3 * std::cos(0.2 * 3.14159265358979323846 * i));
    shifted.push_back(a.back() + 17);
    opposite.push_back(-a.back());
  }
  CHECK(rosin::consistency_delta(a, a) == 0);
  CHECK(rosin::consistency_delta(a, shifted) == test::approx(0).scale(1));  // means are taken out
  CHECK(rosin::consistency_delta(a, b) == test::approx(1));
  CHECK(rosin::consistency_delta(a, opposite) == test::approx(std::sqrt(2)));
}

TEST_CASE("samples that are not known in both are left out; without any there is no difference") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> a{nan, 1, 2, 3, 4, nan}, b{5, 1, 2, nan, 4, 9};
  CHECK(rosin::consistency_delta(a, b) == 0);
  CHECK(rosin::consistency_delta(std::vector<double>{nan}, std::vector<double>{1}) == 0);
  CHECK(rosin::consistency_delta(std::vector<double>{}, std::vector<double>{}) == 0);
}

}  // namespace reconstruct_consistency
