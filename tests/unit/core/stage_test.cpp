// SPDX-License-Identifier: MIT
#include <rosin/core/stage.hpp>

#include <doctest/doctest.h>

namespace core_stage {

namespace {

template <class In, class Out = In>
struct convert {
  using input_type = In;
  using output_type = Out;
  Out operator()(const In& x) noexcept { return static_cast<Out>(x); }
  void reset() noexcept {}
  [[nodiscard]] float latency() const noexcept { return 0; }
};

// Each of these breaks one line of the concept, and nothing else.
struct may_throw : convert<float> {
  float operator()(const float& x) { return x; }
};
struct gives_another_type : convert<float> {
  double operator()(const float& x) noexcept { return static_cast<double>(x); }
};
struct takes_writable_input : convert<float> {
  float operator()(float& x) noexcept { return x; }
};
struct reset_may_throw : convert<float> {
  void reset() {}
};
struct latency_in_whole_frames : convert<float> {
  [[nodiscard]] int latency() const noexcept { return 0; }
};
struct latency_changes_the_stage : convert<float> {
  [[nodiscard]] float latency() noexcept { return 0; }
};
struct cannot_move : convert<float> {
  cannot_move() = default;
  cannot_move(cannot_move&&) = delete;
};
struct names_no_types {
  float operator()(const float& x) noexcept { return x; }
  void reset() noexcept {}
  [[nodiscard]] float latency() const noexcept { return 0; }
};

}  // namespace

TEST_CASE("a stage is recognised, and each single breach of its contract too") {
  CHECK(rosin::Stage<convert<float>>);
  CHECK_FALSE(rosin::Stage<may_throw>);
  CHECK_FALSE(rosin::Stage<gives_another_type>);
  CHECK_FALSE(rosin::Stage<takes_writable_input>);
  CHECK_FALSE(rosin::Stage<reset_may_throw>);
  CHECK_FALSE(rosin::Stage<latency_in_whole_frames>);
  CHECK_FALSE(rosin::Stage<latency_changes_the_stage>);
  CHECK_FALSE(rosin::Stage<cannot_move>);
  CHECK_FALSE(rosin::Stage<names_no_types>);
  CHECK_FALSE(rosin::Stage<float>);
}

TEST_CASE("a stage feeds another only where the types agree exactly") {
  CHECK(rosin::Feeds<convert<float>, convert<float, double>>);
  CHECK(rosin::Feeds<convert<float, double>, convert<double>>);
  CHECK_FALSE(rosin::Feeds<convert<float>, convert<double>>);
  CHECK_FALSE(rosin::Feeds<convert<float, double>, convert<float>>);
  CHECK_FALSE(rosin::Feeds<convert<float>, may_throw>);
}

}  // namespace core_stage
