// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_greedy.hpp>

#include <doctest/doctest.h>

#include "pickup_tables.hpp"

using namespace rosin;

namespace {

std::vector<std::string> names_in(const line_table& t, const line_table& held = {}) {
  const fitted_law base = fit_law(t, ideal_string(200), {.fundamental_Hz = 200, .inverse_q = 1e-3});
  std::vector<std::string> out;
  for (const auto& f : search_law(t, base, law_effects(200, t.lines.back().number), held).found) out.push_back(f.effect.name);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("search_law: two effects together, one after the other" * doctest::test_suite("long")) {
  const pickup_law both{.fundamental_Hz = 200, .inharmonicity = 5e-5, .inverse_q = 1e-3, .internal_s = 4e-7};
  CHECK(names_in(rosin_test::table_from(both, 14, 0.003, 0.01, 1)) ==
        std::vector<std::string>{"bending-stiffness", "frequency-dependent-loss"});
}

TEST_CASE("search_law: the scatter of real partials is not named") {
  const pickup_law plain{.fundamental_Hz = 200, .inverse_q = 1e-3};
  for (std::uint64_t seed = 1; seed <= 4; ++seed) CHECK(names_in(rosin_test::table_from(plain, 12, 0.1, 0.15, seed)).empty());
}

TEST_CASE("search_law: what is foretold are partials up to those that were fitted, not above") {
  const pickup_law stiff{.fundamental_Hz = 200, .inharmonicity = 5e-5, .inverse_q = 1e-3};
  const auto table = rosin_test::table_from(stiff, 14, 0.003, 0.01, 1);
  auto held = rosin_test::table_from(stiff, 14, 0.003, 0.01, 2);
  const auto above = rosin_test::table_from({.fundamental_Hz = 200, .inharmonicity = 5.5e-5, .inverse_q = 1e-3}, 64, 0.003, 0.01,
                                            3);  // which the law gets wrong
  for (const int n : {45, 53, 56, 60, 64}) held.lines.push_back(above.lines[static_cast<std::size_t>(n - 1)]);
  CHECK(names_in(table, held) == std::vector<std::string>{"bending-stiffness"});
  CHECK(names_in(table, rosin_test::table_from({.fundamental_Hz = 200, .inverse_q = 1e-3}, 14, 0.003, 0.01, 2)).empty());
}
