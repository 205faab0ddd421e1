// expect: Interpolator
// SPDX-License-Identifier: MIT
// As many taps on either side: an odd number has no middle between two samples.
#include <rosin/condition/fractional_delay.hpp>

#ifdef ROSIN_MUST_FAIL
constexpr std::size_t taps = 5;
#else
constexpr std::size_t taps = 6;
#endif
auto late = rosin::design_delay<float, rosin::lagrange<taps>>(7.3);
