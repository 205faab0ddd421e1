// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_table.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("table_of: two plucks, one of them tuned higher, become one table") {
  rosin_test::heard_string low, high;
  high.fundamental_Hz = 220 * 1.001;
  const auto a = listen(low.pluck("a", 0.13, 1, 1), 220), b = listen(high.pluck("b", 0.31, 1, 2), 220);
  REQUIRE(a);
  REQUIRE(b);
  const line_table t = table_of({*a, *b}, {});
  REQUIRE(t.offset.size() == 2);
  CHECK((1 + t.offset[1]) / (1 + t.offset[0]) == test::approx(1.001).epsilon(1e-6));
  const string_line* five = t.find(5);
  REQUIRE(five != nullptr);
  CHECK(std::abs(five->decay_per_s - 3.14159265358979323846 * 5 * 220 / 900) < 4 * five->decay_sd + 1e-3);
  CHECK(t.find(1000) == nullptr);
}

TEST_CASE("mean_of_several: takes that disagree widen the error") {
  detail::mean_of_several agree, differ;
  agree.add(1.0, 0.1), agree.add(1.05, 0.1);
  differ.add(1.0, 0.1), differ.add(3.0, 0.1);
  CHECK(agree.sd() == test::approx(0.1 / std::sqrt(2.0)));
  CHECK(differ.sd() == test::approx(1.0));
}
