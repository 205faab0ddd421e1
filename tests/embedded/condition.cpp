// SPDX-License-Identifier: MIT
#include <rosin/condition/ac_coupling.hpp>

extern "C" void rosin_restore(float* samples, std::size_t count) noexcept {
  rosin::restore_ac_coupled(std::span<float>{samples, count}, 0.5, 48e3);
}
