// SPDX-License-Identifier: MIT
#include <rosin/math/plain_complex.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

using complex = std::complex<double>;

/// All quadrants, both axes and sizes from 1e-100 to 1e100.
template <class Check>
void everywhere(Check&& check) {
  for (const double size : {1e-100, 1e-3, 1.0, 7e4, 1e100})
    for (const complex direction : {complex(1, 0), complex(-1, 0), complex(0, 1), complex(0, -1), complex(0.6, 0.8),
                                    complex(-0.6, 0.8), complex(-0.6, -0.8), complex(1, 1e-9), complex(-1, -1e-9)})
      check(size * direction);
}

}  // namespace

TEST_CASE("plain reciprocals, magnitudes and roots are the library's, to a few roundings") {
  everywhere([](complex z) {
    CAPTURE(z);
    CHECK(std::abs(rosin::plain::reciprocal(z) * z - 1.0) < 1e-15);
    CHECK(rosin::plain::abs(z) == test::approx(std::abs(z)).epsilon(1e-15).scale(0));
    CHECK(std::abs(rosin::plain::sqrt(z) - std::sqrt(z)) <= 1e-15 * std::abs(std::sqrt(z)));
  });
  CHECK(rosin::plain::sqrt(complex(0, 0)) == complex(0, 0));
}

TEST_CASE("sinh and cosh from one exponential") {
  for (const complex z : {complex(0, 0), complex(1e-6, 2e-3), complex(0.3, 40), complex(-2, 1), complex(20, -700)}) {
    const rosin::plain::hyperbolic both(z);
    CHECK(std::abs(both.sinh - std::sinh(z)) <= 1e-15 * std::exp(std::abs(z.real())));
    CHECK(std::abs(both.cosh - std::cosh(z)) <= 1e-15 * std::exp(std::abs(z.real())));
  }
}
