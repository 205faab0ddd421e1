// SPDX-License-Identifier: MIT
#include <rosin/propagate/bow_point.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>

// Instantiated, not run: the symbols it leaves undefined are the test.
extern "C" void rosin_bow_block(const rosin::streaming_coefficients<float, 128>* coefficients, const float* near_N,
                                const float* far_N, float* force_N, int count) noexcept {
  rosin::streaming_reconstructor<float, 128, 512> stream{*coefficients};
  for (int n = 0; n < count; ++n) force_N[n] = stream({near_N[n], far_N[n]}).force_N();
}
