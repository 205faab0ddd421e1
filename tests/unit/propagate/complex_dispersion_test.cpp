// SPDX-License-Identifier: MIT
#include <rosin/propagate/complex_dispersion.hpp>

#include <rosin/propagate/dispersion.hpp>

#include <doctest/doctest.h>

namespace propagate_complex_dispersion {

TEST_CASE("the phase rate at complex frequencies solves q^2 + epsilon q^4 = w^2, and is the real one on the axis") {
  using complex = std::complex<double>;
  constexpr double epsilon = 1e-12;
  for (const complex w : {complex(1e-3, 1e-9), complex(4e3, 30), complex(4e5, 2e3), complex(4e6, 4e6)}) {
    const complex q = rosin::phase_rate(w, epsilon);
    CHECK(std::abs(q * q * (1.0 + epsilon * q * q) - w * w) < 1e-14 * std::norm(w) * (1 + epsilon * std::norm(q)));
    CHECK(q.real() > 0);
  }
  for (const double w : {10.0, 1e4, 1e6})
    CHECK(std::abs(rosin::phase_rate(complex(w, 0), epsilon) - rosin::phase_rate(w, epsilon)) < 1e-14 * w);
}

}  // namespace propagate_complex_dispersion
