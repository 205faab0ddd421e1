// SPDX-License-Identifier: MIT
#include <rosin/math/median.hpp>

#include <doctest/doctest.h>

#include <vector>

TEST_CASE("median: the middle one, the mean of the middle two, of none 0") {
  CHECK(rosin::median_of(Eigen::Vector3d(7, -2, 3)) == 3);
  CHECK(rosin::median_of(Eigen::Vector4d(7, -2, 3, 4)) == 3.5);
  CHECK(rosin::median_of(std::vector<double>{5}) == 5);
  CHECK(rosin::median_of(std::vector<double>{}) == 0);
}
