// SPDX-License-Identifier: MIT
#include <rosin/core/pipeline.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <Eigen/Core>

struct twice {
  using input_type = float;
  using output_type = float;
  float operator()(const float& x) noexcept { return 2 * x; }
  void reset() noexcept {}
  float latency() const noexcept { return 0; }
};

int main() {
  // Without stiffness every frequency travels alike, and the phase is the frequency itself.
  const bool ideal = rosin::phase_rate(100.0F, 0.0F) == 100.0F;
  return ideal && rosin::pipeline(twice{}, twice{})(1.0F) == 4.0F ? 0 : 1;
}
