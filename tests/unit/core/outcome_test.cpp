// SPDX-License-Identifier: MIT
#include <rosin/core/outcome.hpp>

#include <doctest/doctest.h>

#include <memory>
#include <vector>

namespace core_outcome {

namespace {

rosin::outcome<int> half(int x) {
  if (x % 2 != 0) return rosin::failure{"x: 3 is odd"};
  return x / 2;
}

}  // namespace

TEST_CASE("an outcome holds the value, and then no error") {
  const auto result = half(8);
  REQUIRE(result.has_value());
  CHECK(static_cast<bool>(result));
  CHECK(*result == 4);
  CHECK(result.error().empty());
}

TEST_CASE("an outcome holds the reason where there is no value") {
  const auto result = half(3);
  CHECK_FALSE(result.has_value());
  CHECK_FALSE(static_cast<bool>(result));
  CHECK(result.error() == "x: 3 is odd");
}

TEST_CASE("a value can be changed in place and moved out") {
  rosin::outcome<std::vector<int>> result{std::vector<int>{1, 2}};
  result->push_back(3);
  CHECK(result->size() == 3);
  rosin::outcome<std::unique_ptr<int>> owner{std::make_unique<int>(5)};
  const std::unique_ptr<int> taken = *std::move(owner);
  CHECK(*taken == 5);
}

TEST_CASE("a string and a failure are told apart") {
  const rosin::outcome<std::string> word{std::string{"value"}};
  const rosin::outcome<std::string> none{rosin::failure{"reason"}};
  CHECK(*word == "value");
  CHECK(none.error() == "reason");
}

}  // namespace core_outcome
