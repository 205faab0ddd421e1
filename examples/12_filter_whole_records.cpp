// SPDX-License-Identifier: MIT
//
// Two records through a matrix of FIR filters at once; the second channel came a sample late and is looked at ahead.
//
#include <array>
#include <cstdio>
#include <span>
#include <vector>

#include <rosin/condition/overlap_save.hpp>

struct kernel {
  int first;  // a negative one looks ahead
  std::vector<double> taps;
};

int main() {
  const std::vector<kernel> kernels{{0, {1.0}},
                                    {-1, {1.0}},  // output 0 from inputs 0 and 1
                                    {0, {1.0}},
                                    {-1, {-0.5}}};  // output 1 from inputs 0 and 1
  rosin::block_convolver<float> convolver(2, kernels);

  const std::vector<float> left{1, 2, 3, 4, 5, 6}, right{0, 1, 2, 3, 4, 5};
  std::vector<float> sum(6), mixture(6);
  convolver.process(std::array<std::span<const float>, 2>{left, right}, std::array<std::span<float>, 2>{sum, mixture});

  const rosin::sample_range valid = convolver.valid(left.size());
  for (std::size_t n = valid.begin; n < valid.end; ++n)
    std::printf("%zu: %4.1f %4.1f\n", n, static_cast<double>(sum[n]), static_cast<double>(mixture[n]));
}
