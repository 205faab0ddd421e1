// SPDX-License-Identifier: MIT
// What must hold at compile time: if this file is built, it has passed.
#include <rosin/core/pipeline.hpp>

#include <type_traits>

namespace {

template <class T>
struct gain {
  using input_type = T;
  using output_type = T;
  T factor;
  constexpr T operator()(const T& x) noexcept { return factor * x; }
  constexpr void reset() noexcept {}
  [[nodiscard]] constexpr T latency() const noexcept { return T(0); }
};

// A stage that holds nothing.
struct nothing {
  using input_type = float;
  using output_type = float;
  constexpr float operator()(const float& x) noexcept { return -x; }
  constexpr void reset() noexcept {}
  [[nodiscard]] constexpr float latency() const noexcept { return 0; }
};

using rosin::Feeds, rosin::pipeline, rosin::Stage, rosin::then;

static_assert(Stage<then<gain<float>, nothing>>, "a pipeline is a stage");
static_assert(!Feeds<gain<float>, gain<double>>, "precision is never changed silently");
static_assert(sizeof(then<gain<float>, gain<float>>) == 2 * sizeof(float), "composition is free");
static_assert(sizeof(then<gain<float>, nothing>) == sizeof(float), "a stage without state takes no room");
static_assert(std::is_trivially_copyable_v<then<gain<float>, nothing>>);
static_assert(pipeline(gain<float>{2}, nothing{}, gain<float>{5})(1.0F) == -10.0F, "usable at compile time");

}  // namespace
