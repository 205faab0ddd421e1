// expect: Stage
// SPDX-License-Identifier: MIT
// Something that can be called is not yet a stage: it has no latency and no reset.
#include <rosin/core/pipeline.hpp>

struct gain {
  using input_type = float;
  using output_type = float;
  float operator()(const float& x) noexcept { return x; }
  void reset() noexcept {}
  float latency() const noexcept { return 0; }
};

#ifdef ROSIN_MUST_FAIL
auto chain = rosin::pipeline(gain{}, [](const float& x) noexcept { return x; });
#else
auto chain = rosin::pipeline(gain{}, gain{});
#endif
