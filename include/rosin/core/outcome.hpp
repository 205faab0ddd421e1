// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bad data is not a bug: whoever reads, designs or fits returns a value or the reason why there is none.
//
#pragma once

#include <string>
#include <utility>
#include <variant>

namespace rosin {

/// Why there is no value: one sentence that names the file, the key or the sample, and the reason.
struct failure {
  std::string message;
};

/// A value, or the failure that stands in its place. (std::expected is C++23.)
template <class T>
class outcome {
public:
  outcome(T value) : state_{std::in_place_index<0>, std::move(value)} {}
  outcome(failure why) : state_{std::in_place_index<1>, std::move(why)} {}

  [[nodiscard]] bool has_value() const noexcept { return state_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }

  /// Precondition of the next five: has_value().
  [[nodiscard]] T& operator*() & noexcept { return *std::get_if<0>(&state_); }
  [[nodiscard]] const T& operator*() const& noexcept { return *std::get_if<0>(&state_); }
  [[nodiscard]] T&& operator*() && noexcept { return std::move(*std::get_if<0>(&state_)); }
  [[nodiscard]] T* operator->() noexcept { return std::get_if<0>(&state_); }
  [[nodiscard]] const T* operator->() const noexcept { return std::get_if<0>(&state_); }

  /// The reason; empty where there is a value.
  [[nodiscard]] std::string error() const { return has_value() ? std::string{} : std::get_if<1>(&state_)->message; }

private:
  std::variant<T, failure> state_;
};

}  // namespace rosin
