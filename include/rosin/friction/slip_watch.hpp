// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Sticks or slips, sample by sample, for whoever watches while the bow moves. A slip throws the string against the way of the
// rod, so it begins where the string falls behind the rod by more than its speed and a little, and is over where it falls behind
// by less than half of that: hysteresis keeps one slip in one piece. (The string's centre is what the reconstruction gives; while
// it sticks, it still swings by rolling on the rod, by up to the rod's speed.) slip_phases.hpp decides with more care,
// afterwards.
//
#pragma once

#include <cstdint>

namespace rosin {

enum class contact_state { unknown, sticking, slipping };

template <class T>
class slip_watch {
public:
  /// rod_m_s: with its sign; 0: nothing can be said.
  constexpr explicit slip_watch(T rod_m_s, T share = T(1.2)) noexcept : rod_{rod_m_s}, share_{share} {}

  /// The velocity of the string under the bow. NaN: unknown until the next number.
  constexpr contact_state operator()(T velocity_m_s) noexcept {
    const T behind = (rod_ - velocity_m_s) / rod_;  // 0 sticks, 1 is a string at rest
    if (!(behind == behind) || rod_ == T(0)) return state_ = contact_state::unknown;
    if (behind > share_ && state_ != contact_state::slipping) {
      slips_ += state_ == contact_state::sticking ? 1U : 0U;
      state_ = contact_state::slipping;
    } else if (behind < share_ / 2 || state_ == contact_state::unknown) {
      state_ = contact_state::sticking;
    }
    return state_;
  }
  [[nodiscard]] constexpr contact_state state() const noexcept { return state_; }
  /// Slips that have begun.
  [[nodiscard]] constexpr std::uint64_t slips() const noexcept { return slips_; }

private:
  T rod_, share_;
  contact_state state_ = contact_state::unknown;
  std::uint64_t slips_ = 0;
};

}  // namespace rosin
