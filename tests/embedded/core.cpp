// SPDX-License-Identifier: MIT
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/pipeline.hpp>
#include <rosin/core/stage.hpp>

namespace {

struct one_pole {
  using input_type = float;
  using output_type = float;
  float pole = 0;
  float last = 0;
  float operator()(const float& x) noexcept { return last = x + pole * last; }
  void reset() noexcept { last = 0; }
  [[nodiscard]] float latency() const noexcept { return 0; }
};

}  // namespace

extern "C" void rosin_pipeline(float* samples, int count) noexcept {
  auto chain = rosin::pipeline(one_pole{0.5F}, one_pole{0.25F}, one_pole{0.125F});
  for (int n = 0; n < count; ++n) samples[n] = chain(samples[n]);
}
