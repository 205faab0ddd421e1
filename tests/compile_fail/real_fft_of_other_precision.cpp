// expect: RealFft
// SPDX-License-Identifier: MIT
// An FFT policy in double does not transform float records.
#include <rosin/condition/low_pass.hpp>
#include <rosin/propagate/band.hpp>

std::vector<float> quiet(std::span<const float> record) {
#ifdef ROSIN_MUST_FAIL
  return rosin::low_pass<float, rosin::eigen_fft<double>>(record, 48e3, rosin::band{8e3, 16e3});
#else
  return rosin::low_pass<float, rosin::eigen_fft<float>>(record, 48e3, rosin::band{8e3, 16e3});
#endif
}
