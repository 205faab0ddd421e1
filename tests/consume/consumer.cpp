// SPDX-License-Identifier: MIT
// One header that needs nothing, one that needs Boost: what a stranger's build has to find.
#include <rosin/core/pipeline.hpp>
#include <rosin/propagate/airy_kernel.hpp>
#include <rosin/version.hpp>

#include <Eigen/Core>

struct twice {
  using input_type = float;
  using output_type = float;
  float operator()(const float& x) noexcept { return 2 * x; }
  void reset() noexcept {}
  float latency() const noexcept { return 0; }
};

int main() { return rosin::pipeline(twice{}, twice{})(1.0F) == 4.0F ? 0 : 1; }
