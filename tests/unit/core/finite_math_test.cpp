// SPDX-License-Identifier: MIT
#include <rosin/core/finite_math.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace core_finite_math {

TEST_CASE("where this compiles, a value that is no number is told from one") {
  const volatile double none = std::numeric_limits<double>::quiet_NaN(), endless = std::numeric_limits<double>::infinity();
  CHECK(!std::isfinite(none));
  CHECK(!std::isfinite(endless));
}

}  // namespace core_finite_math
