// SPDX-License-Identifier: MIT
#include <rosin/propagate/transmission.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "support/approx.hpp"

namespace propagate_transmission {

namespace {

constexpr double rate_Hz = 128e3;
const rosin::string_parameters paper{0.314, 72.5, 659.69, 4.7e-5, {}};
const rosin::band limits{20e3, 60e3};

double travel_s(double beta) { return beta / (2 * paper.fundamental_Hz); }

/// (a * b)[n] over all n, first tap at a.first + b.first.
rosin::fir convolved(const rosin::fir& a, const rosin::fir& b) {
  rosin::fir c{a.first + b.first, std::vector<double>(a.taps.size() + b.taps.size() - 1, 0.0)};
  for (std::size_t i = 0; i < a.taps.size(); ++i)
    for (std::size_t j = 0; j < b.taps.size(); ++j) c.taps[i + j] += a.taps[i] * b.taps[j];
  return c;
}

/// Largest | response - wanted | up to 20 kHz.
template <class Wanted>
double worst(const rosin::fir& k, const Wanted& wanted) {
  double error = 0;
  for (double f = 0; f <= 20e3; f += 37) error = std::max(error, std::abs(k.response(f, rate_Hz) - wanted(f)));
  return error;
}

}  // namespace

TEST_CASE("lengths of exact-phase kernels") {
  // The paper's string: taps for an error of 1e-2, 1e-3, 1e-4, 1e-5.
  struct row {
    double beta;
    std::array<std::size_t, 4> most;
  };
  for (const row& r :
       {row{0.25, {15, 20, 29, 49}}, row{0.3, {17, 22, 31, 52}}, row{0.7, {29, 36, 43, 64}}, row{0.75, {31, 37, 44, 58}}})
    for (std::size_t i = 0; i < 4; ++i) {
      const double error = std::pow(10.0, -2.0 - static_cast<double>(i));
      const rosin::fir k =
          rosin::transmission_kernel(rosin::transmission{travel_s(r.beta), paper.stiffness_s2(), {}}, limits, rate_Hz, error);
      CHECK(k.taps.size() <= r.most[i]);
      CHECK(worst(k, rosin::transmission{travel_s(r.beta), paper.stiffness_s2(), {}}) <= 1.02 * error);
    }
}

TEST_CASE("without loss the inverse is the same taps backwards in time") {
  const double tau = travel_s(0.3), epsilon = paper.stiffness_s2();
  const rosin::fir out = rosin::transmission_kernel(rosin::transmission{tau, epsilon, {}}, limits, rate_Hz, 1e-5);
  const rosin::fir back = rosin::transmission_kernel(rosin::inverse_transmission{tau, epsilon, {}}, limits, rate_Hz, 1e-5);
  const rosin::fir reversed = rosin::time_reversed(out);
  CHECK(worst(back, [&](double f) { return reversed.response(f, rate_Hz); }) < 3e-5);
  CHECK(worst(convolved(out, reversed), [](double) { return 1.0; }) < 5e-5);
}

TEST_CASE("with loss only the compensated inverse brings everything back") {
  const rosin::loss_law loss{300, 1e-7, 0};
  const double tau = travel_s(0.7), epsilon = paper.stiffness_s2();
  const rosin::fir out = rosin::transmission_kernel(rosin::transmission{tau, epsilon, loss}, limits, rate_Hz, 1e-5);
  const rosin::fir back = rosin::transmission_kernel(rosin::inverse_transmission{tau, epsilon, loss}, limits, rate_Hz, 1e-5);
  // 3e-4, not 1e-5: |w| has a corner at 0 Hz, whose tails of tau/(2 Q) / (pi t^2) reach beyond any short kernel.
  CHECK(worst(convolved(out, back), [](double) { return 1.0; }) < 3e-4);
  CHECK(worst(convolved(out, rosin::time_reversed(out)), [](double) { return 1.0; }) > 0.1);
}

TEST_CASE("a round trip costs what the modes' Q says") {
  // A mode of n half waves on a string of one-way travel time tau loses exp(-pi f / Q) a second: over one round trip at the group
  // velocity, 2 tau c / c_g seconds. Twice the passage has to lose as much.
  const rosin::loss_law loss{450, 0, 0};
  const double tau = 0.5 / 660, epsilon = paper.stiffness_s2();
  for (const double f : {660.0, 8000.0, 30000.0}) {
    const double w = 2 * std::numbers::pi * f, seconds = 2 * tau * rosin::slowness_ratio(w, epsilon);
    CHECK(std::norm(rosin::transmission{tau, epsilon, loss}(f)) == test::approx(std::exp(-w / (2 * 450.0) * seconds)));
  }
}

TEST_CASE(
    "where the loss is causal, a round trip is a whole number of turns at the dispersed partials, and nothing arrives early") {
  const double f0 = 440;
  const rosin::loss_law loss{.quality = 300, .causality = 1, .reference_Hz = f0};
  for (const int n : {1, 7, 40}) {
    const double f = n * f0 * std::pow(n, 1 / (300 * std::numbers::pi - 1));
    CHECK(rosin::propagation_rate(f, 0, loss).imag() / f0 == test::approx(2 * std::numbers::pi * n).epsilon(1e-7));
  }
  // What comes before the wave is what the low-pass rings by; a loss that does not disperse sends more ahead
  const auto early = [&](double causality) {
    rosin::loss_law law = loss;
    law.causality = causality;
    const double delay_s = 4.5 / f0;
    const rosin::fir k = rosin::transmission_kernel(rosin::transmission{delay_s, 0, law}, limits, rate_Hz, 1e-6);
    const double first = delay_s * rate_Hz * (1 + law.lead(40e3)) - 12;  // samples; of the fastest waves
    double sum = 0;
    for (std::size_t i = 0; i < k.taps.size() && k.first + static_cast<int>(i) < first; ++i) sum += k.taps[i];
    return std::abs(sum);
  };
  CHECK(early(1) < 0.3 * early(0));
}

}  // namespace propagate_transmission
