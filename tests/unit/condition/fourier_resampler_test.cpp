// SPDX-License-Identifier: MIT
#include <rosin/condition/fourier_resampler.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace condition_fourier_resampler {

namespace {

struct partial {
  std::size_t cycles;  // per record
  double amplitude, phase;
};

/// Up to forty partials anywhere below half of `n` cycles (excluded), the highest one included.
std::vector<partial> partials_below(std::size_t n, unsigned seed) {
  std::mt19937 engine{seed};
  std::uniform_real_distribution<double> uniform;
  std::vector<partial> all{{0, 1, 0}};
  const std::size_t highest = (n - 1) / 2;
  for (std::size_t i = 0; i < std::min<std::size_t>(40, highest); ++i) {
    const auto cycles = i == 0 ? highest : static_cast<std::size_t>(uniform(engine) * static_cast<double>(highest));
    const double amplitude = uniform(engine);
    all.push_back({cycles, amplitude, 6 * uniform(engine)});
  }
  return all;
}

template <class T>
std::vector<T> sampled(const std::vector<partial>& partials, std::size_t n) {
  std::vector<T> x(n);
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0;
    for (const partial& p : partials)
      sum +=
          p.amplitude * std::cos(2 * std::numbers::pi * static_cast<double>(p.cycles * j % n) / static_cast<double>(n) + p.phase);
    x[j] = static_cast<T>(sum);
  }
  return x;
}

/// Worst error in dB against the worst value.
template <class T>
double error_dB(const std::vector<T>& is, const std::vector<T>& should) {
  double error = 1e-300, largest = 0;
  for (std::size_t j = 0; j < is.size(); ++j) {
    error = std::max(error, static_cast<double>(std::abs(is[j] - should[j])));
    largest = std::max(largest, static_cast<double>(std::abs(should[j])));
  }
  return 20 * std::log10(error / largest);
}

const std::vector<std::pair<std::size_t, std::size_t>> lengths{
    {17921, 16384}, {16384, 17921}, {1021, 997}, {997, 1021}, {1000, 1001}, {1001, 1000},
    {1000, 3000},   {1200, 100},    {8, 12},     {9, 4},      {4, 9},       {1, 5},
    {5, 1},         {2, 7},         {7, 2},      {6, 6},      {7, 7},       {4409, 8802}};

}  // namespace

TEST_CASE("a periodic record is resampled to rounding, at any length") {
  for (const auto& pair : lengths) {
    const std::size_t from = pair.first, to = pair.second;
    CAPTURE(from);
    CAPTURE(to);
    const std::vector<partial> partials = partials_below(std::min(from, to), static_cast<unsigned>(from + to));
    CHECK(error_dB(rosin::fourier_resample<double>(sampled<double>(partials, from), to), sampled<double>(partials, to)) < -280);
  }
}

TEST_CASE("in single precision too") {
  for (const auto& [from, to] : lengths) {
    const std::vector<partial> partials = partials_below(std::min(from, to), static_cast<unsigned>(from + to));
    CHECK(error_dB(rosin::fourier_resample<float>(sampled<float>(partials, from), to), sampled<float>(partials, to)) < -105);
  }
}

TEST_CASE("a cosine at half the sampling rate goes on as that cosine") {
  const std::vector<partial> at_half{{4, 1.5, 0}};
  CHECK(error_dB(rosin::fourier_resample<double>(sampled<double>(at_half, 8), 20), sampled<double>(at_half, 20)) < -290);
  CHECK(error_dB(rosin::fourier_resample<double>(sampled<double>(at_half, 8), 8), sampled<double>(at_half, 8)) < -290);
}

TEST_CASE("what ends at half the new sampling rate shows what sampling it shows") {
  const std::vector<partial> turned{{4, 1.5, 1.0}};
  CHECK(error_dB(rosin::fourier_resample<double>(sampled<double>(turned, 20), 8), sampled<double>(turned, 8)) < -290);
}

TEST_CASE("what lies above is left out, not folded") {
  const std::vector<partial> low{{3, 1, 0.5}}, both{{3, 1, 0.5}, {9, 1, 0.2}};
  CHECK(error_dB(rosin::fourier_resample<double>(sampled<double>(both, 32), 15), sampled<double>(low, 15)) < -290);
}

TEST_CASE("an empty record stays empty") { CHECK(rosin::fourier_resample<double>(std::span<const double>{}, 8).empty()); }

}  // namespace condition_fourier_resampler
