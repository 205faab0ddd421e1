// tier: freestanding
// SPDX-License-Identifier: MIT
//
// How strongly rosin resists at a temperature: a table at even steps of temperature, straight in between, held at
// its ends. Multiplied by the normal force (and, in the enhanced thermal law, by a slow function of slip speed) it is
// the friction. Made by design_yield_curve() from friction measured in steady sliding.
//
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace rosin {

template <class T = double>
struct yield_curve {
  static constexpr std::size_t entries = 1024;
  T spacing_K = 1;
  std::array<T, entries> value{};

  [[nodiscard]] T operator()(T rise_K) const noexcept {
    const T place = std::clamp(rise_K / spacing_K, T(0), T(entries - 1) - T(1e-3));
    const auto i = static_cast<std::size_t>(place);
    const T part = place - static_cast<T>(i);
    return value[i] + part * (value[i + 1] - value[i]);
  }
};

}  // namespace rosin
