// SPDX-License-Identifier: MIT
#pragma once

#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include <cstddef>

constexpr std::size_t taps = 512, line = 1024;
using coefficients = rosin::streaming_coefficients<float, taps>;
void run_exact(const coefficients& design, const float* near_N, const float* far_N, float* force_N, std::size_t count);
void run_fast(const coefficients& design, const float* near_N, const float* far_N, float* force_N, std::size_t count);
