// SPDX-License-Identifier: MIT
//
// Later by any number of samples: sample by sample, with a stage that firmware can run, and as a whole record.
//
#include <cmath>
#include <cstdio>
#include <vector>

#include <rosin/condition/fractional_delay.hpp>
#include <rosin/condition/fractional_delay_design.hpp>
#include <rosin/condition/record_delay.hpp>

int main() {
  rosin::fractional_delay<float, rosin::lagrange<4>, 64> line{2.5};
  for (const float x : {0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F}) std::printf("%7.4f", static_cast<double>(line(x)));
  std::printf("   %.1f samples late\n", static_cast<double>(line.latency()));

  // Weights for a firmware that has no room for their design: computed here, held there.
  const auto taps = rosin::design_delay<float, rosin::kaiser<8>>(29.105);
  std::printf("%zu whole samples, then", taps.whole);
  for (const float weight : taps.weights) std::printf(" %.4f", static_cast<double>(weight));
  std::printf("\n");

  auto later = rosin::record_delay<double>::make(29.105, {.bandwidth = 0.8, .error_dB = -140});
  if (!later) return 1;
  std::vector<double> in(1000), out(1000);
  for (std::size_t n = 0; n < in.size(); ++n) in[n] = std::sin(2.5 * static_cast<double>(n));  // 0.8 of half the rate
  later->process(in, out);
  const rosin::sample_range valid = later->valid(in.size());
  double worst = 0;
  for (std::size_t n = valid.begin; n < valid.end; ++n)
    worst = std::fmax(worst, std::abs(out[n] - std::sin(2.5 * (static_cast<double>(n) - 29.105))));
  std::printf("%zu taps, samples %zu to %zu, worst error %.0f dB\n", later->taps(), valid.begin, valid.end,
              20 * std::log10(worst));
  return worst < 1e-6 ? 0 : 1;
}
