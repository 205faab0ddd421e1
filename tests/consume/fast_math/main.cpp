// SPDX-License-Identifier: MIT
#include "run.hpp"

#include <rosin/propagate/string_parameters.hpp>
#include <rosin/reconstruct/streaming_design.hpp>

#include <cmath>
#include <vector>

int main() {
  const rosin::string_parameters string{.length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660};
  const auto design =
      rosin::design_streaming<float, taps, line>(rosin::contact_at(string, 0.3), {1, 1}, {20e3, 40e3}, 128e3, 1e-3);
  if (!design) return 2;
  std::vector<float> near_N, far_N, exact(4000), fast(4000);
  for (int n = 0; n < 4000; ++n) {
    near_N.push_back(std::sin(0.0324F * static_cast<float>(n)) + 0.3F * std::sin(0.21F * static_cast<float>(n)));
    far_N.push_back(std::cos(0.0324F * static_cast<float>(n)));
  }
  run_exact(*design, near_N.data(), far_N.data(), exact.data(), exact.size());
  run_fast(*design, near_N.data(), far_N.data(), fast.data(), fast.size());
  float largest = 0, off = 0;
  for (std::size_t n = 0; n < exact.size(); ++n)
    largest = std::fmax(largest, std::fabs(exact[n])), off = std::fmax(off, std::fabs(exact[n] - fast[n]));
  return largest > 0.1F && off < 1e-5F * largest ? 0 : 1;
}
