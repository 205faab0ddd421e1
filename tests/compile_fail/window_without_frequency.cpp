// expect: FrequencyWindow
// SPDX-License-Identifier: MIT
// A cut-off in Hz is not yet a window.
#include <rosin/condition/low_pass.hpp>
#include <rosin/propagate/band.hpp>

std::vector<double> quiet(std::span<const double> record) {
#ifdef ROSIN_MUST_FAIL
  return rosin::low_pass(record, 48e3, 8e3);
#else
  return rosin::low_pass(record, 48e3, rosin::band{8e3, 16e3});
#endif
}
