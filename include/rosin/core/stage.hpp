// tier: freestanding
// SPDX-License-Identifier: MIT
//
//     input ──▶ stage ──▶ output        one call per frame: no allocation, no throw
//
// Sample-by-sample processing is made of stages, on a desk as in firmware. The two concepts say which
// types are stages and which may follow each other; pipeline.hpp joins them.
//
#pragma once

#include <concepts>

namespace rosin {

/// A processing step: takes one `input_type`, gives one `output_type`.
///
/// What the compiler cannot check, and every stage promises:
///  - `stage(x)` is real-time safe: no allocation, no lock, no I/O; NaN in, NaN out;
///  - `stage.reset()` brings back the state after construction;
///  - `stage.latency()` is the delay it adds at low frequency, in frames.
template <class S>
concept Stage = std::movable<S> && requires(S stage, const S& same, const typename S::input_type& x) {
  typename S::input_type;
  typename S::output_type;
  { stage(x) }
  noexcept->std::same_as<typename S::output_type>;
  { stage.reset() }
  noexcept;
  { same.latency() }
  noexcept->std::floating_point;
};

/// `First` may be followed by `Second`: what the one gives is exactly what the other takes. A change of
/// precision is never made silently.
template <class First, class Second>
concept Feeds = Stage<First> && Stage<Second> && std::same_as<typename First::output_type, typename Second::input_type>;

}  // namespace rosin
