// SPDX-License-Identifier: MIT
//
// Tables of partials made up from a law, with errors and with the scatter that real supports give.
//
#pragma once

#include <rosin/diagnose/pickup_poles.hpp>
#include <rosin/diagnose/pickup_table.hpp>
#include <rosin/simulate/converter.hpp>

namespace rosin_test {

inline rosin::line_table table_from(const rosin::pickup_law& law, int count, double scatter_Hz, double scatter_decay,
                                    std::uint64_t seed) {
  rosin::gaussian_source normal{seed};
  rosin::line_table t;
  for (int n = 1; n <= count; ++n) {
    const auto s = rosin::pickup_pole(law, n);
    const double f_sd = 1e-4 * n, a_sd = 6e-4 * n;
    t.lines.push_back({n, s.imag() / rosin::detail::full_turn + std::hypot(f_sd, scatter_Hz) * normal(), f_sd,
                       -s.real() * (1 + scatter_decay * normal()) + a_sd * normal(), a_sd, 0});
  }
  return t;
}

}  // namespace rosin_test
