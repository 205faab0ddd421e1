// expect: Transfer
// SPDX-License-Identifier: MIT
// A response is one complex number, not magnitude and phase side by side.
#include <rosin/propagate/fir.hpp>

#include <utility>

#ifdef ROSIN_MUST_FAIL
auto response = [](double) { return std::pair{1.0, 0.0}; };
#else
auto response = [](double) { return std::polar(1.0, 0.0); };
#endif
auto taps = rosin::sample_response(response, rosin::band{8e3, 16e3}, 48e3, 0, 63);
