// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_law_fit.hpp>

#include <doctest/doctest.h>

#include "pickup_tables.hpp"
#include "support/approx.hpp"

using namespace rosin;

namespace {
const std::vector<law_parameter> stiff{{"fundamental_Hz", &pickup_law::fundamental_Hz, 100, 400, true},
                                       {"inverse_quality", &pickup_law::inverse_q, 0, 0.2},
                                       {"inharmonicity", &pickup_law::inharmonicity, 0, 0.05}};
}

TEST_CASE("fit_law: intervals of pitch, loss and stiffness cover the truth, with scatter and without") {
  const pickup_law truth{.fundamental_Hz = 200, .inharmonicity = 1e-4, .inverse_q = 1e-3};
  for (const double scatter : {0.0, 0.05}) {
    int inside = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      const auto table = rosin_test::table_from(truth, 24, scatter, scatter, seed);
      const fitted_law f = fit_law(table, stiff, {.fundamental_Hz = 201, .inverse_q = 2e-3});
      inside += std::abs(f.law.fundamental_Hz - 200) < 2 * f.sd_of("fundamental_Hz");
      inside += std::abs(f.law.inharmonicity - 1e-4) < 2 * f.sd_of("inharmonicity");
      inside += std::abs(f.law.inverse_q - 1e-3) < 2 * f.sd_of("inverse_quality");
      if (scatter > 0) CHECK(f.scatter_decay == test::approx(0.05).epsilon(0.6));
    }
    CHECK(inside >= 105);  // of 120
    CHECK(inside < 120);
  }
}

TEST_CASE("predicted_log_likelihood: the true law foretells another table better") {
  const pickup_law truth{.fundamental_Hz = 200, .inharmonicity = 1e-4, .inverse_q = 1e-3};
  const auto table = rosin_test::table_from(truth, 20, 0.02, 0.05, 1), other = rosin_test::table_from(truth, 20, 0.02, 0.05, 2);
  const auto plain = std::vector<law_parameter>{stiff[0], stiff[1]};
  CHECK(predicted_log_likelihood(other, fit_law(table, stiff, {.fundamental_Hz = 200, .inverse_q = 1e-3})) >
        predicted_log_likelihood(other, fit_law(table, plain, {.fundamental_Hz = 200, .inverse_q = 1e-3})) + 20);
}
