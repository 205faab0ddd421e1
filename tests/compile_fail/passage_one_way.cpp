// expect: PassageKernel
// SPDX-License-Identifier: MIT
// A kernel policy leads to the end of the string and back.
#include <rosin/reconstruct/bow_point_transfer.hpp>

struct pure_delay {
  pure_delay(const rosin::bow_point& at, int side, const rosin::band&, double)
      : delay_s{at.delay_s[static_cast<std::size_t>(side)]} {}
  std::complex<double> forward(double f) const { return std::polar(1.0, -6.283185307179586 * f * delay_s); }
#ifndef ROSIN_MUST_FAIL
  std::complex<double> back(double f) const { return std::conj(forward(f)); }
#endif
  double delay_s;
};

rosin::physics<false, false, false, pure_delay>* bare = nullptr;
