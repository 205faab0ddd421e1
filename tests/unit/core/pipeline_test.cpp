// SPDX-License-Identifier: MIT
#include <rosin/core/pipeline.hpp>

#include <doctest/doctest.h>

#include <memory>
#include <type_traits>

namespace core_pipeline {

namespace {

template <class T>
struct scale {
  using input_type = T;
  using output_type = T;
  T factor;
  constexpr T operator()(const T& x) noexcept { return factor * x; }
  constexpr void reset() noexcept {}
  [[nodiscard]] constexpr T latency() const noexcept { return T(0); }
};

template <class T>
struct one_frame_late {
  using input_type = T;
  using output_type = T;
  T last{};
  constexpr T operator()(const T& x) noexcept { return std::exchange(last, x); }
  constexpr void reset() noexcept { last = T{}; }
  [[nodiscard]] constexpr T latency() const noexcept { return T(1); }
};

struct add_one : scale<int> {
  constexpr int operator()(const int& x) noexcept { return x + 1; }
  [[nodiscard]] constexpr float latency() const noexcept { return 0; }
};

struct times_two : add_one {
  constexpr int operator()(const int& x) noexcept { return 2 * x; }
};

// Holds something that cannot be copied, as a hardware stream does.
struct owner {
  using input_type = float;
  using output_type = float;
  std::unique_ptr<float> gain;
  float operator()(const float& x) noexcept { return *gain * x; }
  void reset() noexcept {}
  [[nodiscard]] float latency() const noexcept { return 0; }
};

}  // namespace

TEST_CASE("stages are applied in the order in which they are written") {
  CHECK(rosin::pipeline(add_one{}, times_two{})(3) == 8);
  CHECK(rosin::pipeline(times_two{}, add_one{})(3) == 7);
  CHECK(rosin::pipeline(add_one{}, times_two{}, add_one{}, times_two{})(3) == 18);
  CHECK(rosin::pipeline(add_one{})(3) == 4);
}

TEST_CASE_TEMPLATE("latencies add up, and a reset reaches every stage", T, float, double) {
  auto chain = rosin::pipeline(one_frame_late<T>{}, scale<T>{3}, one_frame_late<T>{});
  CHECK(chain.latency() == T(2));
  CHECK(chain(T(1)) == T(0));
  CHECK(chain(T(5)) == T(0));
  CHECK(chain(T(0)) == T(3));
  chain.reset();
  CHECK(chain(T(7)) == T(0));
  CHECK(chain(T(0)) == T(0));
  CHECK(chain(T(0)) == T(21));
}

TEST_CASE("a chain of chains is the chain") {
  auto nested = rosin::pipeline(rosin::pipeline(add_one{}, times_two{}), rosin::pipeline(add_one{}, add_one{}));
  CHECK(nested(3) == 10);
  CHECK(rosin::Stage<decltype(nested)>);
}

TEST_CASE("a stage that can only be moved is moved in, and keeps working") {
  auto chain = rosin::pipeline(owner{std::make_unique<float>(2.0F)}, owner{std::make_unique<float>(3.0F)},
                               owner{std::make_unique<float>(5.0F)});
  CHECK(chain(1.0F) == 30.0F);
  auto moved = std::move(chain);
  CHECK(moved(2.0F) == 60.0F);
}

TEST_CASE("composition costs no memory and is available to the compiler") {
  using two = rosin::then<scale<float>, scale<float>>;
  CHECK(sizeof(two) == 2 * sizeof(float));
  CHECK(std::is_trivially_copyable_v<two>);
  constexpr float at_compile_time = rosin::pipeline(scale<float>{2}, scale<float>{3}, scale<float>{5})(1.0F);
  CHECK(at_compile_time == 30.0F);
}

}  // namespace core_pipeline
