// SPDX-License-Identifier: MIT
#include <rosin/core/number_text.hpp>

#include <doctest/doctest.h>

#include <support/comma_locale.hpp>

#include <cmath>
#include <cstdio>
#include <limits>

namespace core_number_text {

TEST_CASE("the forms of printf, in the locale C") {
  for (const double x : {0.0, -0.0, 1.0, -2.5, 0.1, 1e-7, 123456.789, -40.5, 1e22, 5e-324, 1.7976931348623157e308, 2.0 / 3})
    for (const char* form : {"%g", "%f", "%e", "%a", "%.0f", "%.1f", "%.3f", "%.9g", "%.17g", "%.2e", "%+.3g", "%+.1f", "%.0g"}) {
      std::array<char, 500> expected{};
      std::snprintf(expected.data(), expected.size(), form, x);
      CHECK(rosin::number_text(x, form) == expected.data());
    }
  CHECK(rosin::number_text(std::numeric_limits<double>::infinity()) == "inf");
  CHECK(rosin::number_text(std::nan("")) == "nan");
  CHECK(rosin::number_text(0.25) == "0.25");
}

TEST_CASE("a text is a number as a whole, or none") {
  CHECK(rosin::number_from("1.5") == 1.5);
  CHECK(rosin::number_from("+1e-3") == 1e-3);
  CHECK(rosin::number_from("-7") == -7);
  for (const char* text : {"", "+", "+-1", "1,5", "1.5 ", " 1", "1e999", "x", "0x10"}) CHECK_FALSE(rosin::number_from(text));
}

TEST_CASE("the locale of the program changes nothing") {
  const test::comma_locale german;
  std::array<char, 20> c{};
  std::snprintf(c.data(), c.size(), "%.1f", -40.5);
  CHECK((std::string{c.data()} == "-40,5") == german.for_c());
  if (!german.for_c()) MESSAGE("no locale with a decimal comma for C here");
  CHECK(rosin::number_text(-40.5, "%.3f") == "-40.500");
  CHECK(rosin::number_from("40.5") == 40.5);
}

}  // namespace core_number_text
