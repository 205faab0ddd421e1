// expect: FirKernel
// SPDX-License-Identifier: MIT
// Taps alone do not say at which lag they begin.
#include <rosin/condition/overlap_save_design.hpp>
#include <rosin/propagate/fir.hpp>

#ifdef ROSIN_MUST_FAIL
std::vector<std::vector<double>> kernels;
#else
std::vector<rosin::fir> kernels;
#endif
auto lags = rosin::lags_of(kernels);
