// tier: freestanding
// SPDX-License-Identifier: MIT
//
//     input ──▶ first ──▶ second ──▶ … ──▶ last ──▶ output
//
// Stages in a row are a stage: held by value, as large as their sum, inlined like the product written by
// hand. The constraint stands on the function, where both compilers name the joint that does not fit; on a
// partial specialisation they would only say "incomplete type", and operator| would need the user's
// namespaces to know of it.
//
#pragma once

#include <rosin/core/stage.hpp>

#include <utility>

namespace rosin {

/// Two stages in a row; chains of any length are built from it.
template <Stage First, Stage Second>
requires Feeds<First, Second>
class then {
public:
  using input_type = typename First::input_type;
  using output_type = typename Second::output_type;

  constexpr then(First first, Second second) noexcept : first_{std::move(first)}, second_{std::move(second)} {}

  constexpr output_type operator()(const input_type& x) noexcept { return second_(first_(x)); }
  constexpr void reset() noexcept {
    first_.reset();
    second_.reset();
  }
  /// Sum of both: frames are counted at one common rate.
  [[nodiscard]] constexpr auto latency() const noexcept { return first_.latency() + second_.latency(); }

private:
  [[no_unique_address]] First first_;
  [[no_unique_address]] Second second_;
};

/// A chain of one.
template <Stage Only>
[[nodiscard]] constexpr Only pipeline(Only only) noexcept {
  return only;
}

/// Joins stages in the order in which the signal meets them.
///
///     auto bow = rosin::pipeline(align, undo_bridge, calibrate);
///     float force_N = bow(sample);
template <Stage First, Stage Second, Stage... Rest>
requires Feeds<First, Second>
[[nodiscard]] constexpr auto pipeline(First first, Second second, Rest... rest) noexcept {
  return pipeline(then<First, Second>{std::move(first), std::move(second)}, std::move(rest)...);
}

}  // namespace rosin
