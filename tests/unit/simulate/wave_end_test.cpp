// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_end.hpp>

#include <doctest/doctest.h>

namespace simulate_wave_end {

namespace {

constexpr double rate_Hz = 256e3, pi = 3.14159265358979323846;
const rosin::modal_termination bridge{{{460, 30, 1.8}, {2400, 12, 45}, {5100, 8, 60}}};

/// Response of a run of the end at a frequency, once it has forgotten its beginning.
std::complex<double> response(rosin::wave_end end, double frequency_Hz, bool of_force) {
  const std::complex<double> turn(0, 2 * pi * frequency_Hz / rate_Hz);
  const int settle = 80000, periods = static_cast<int>(std::lround(200 * frequency_Hz / 1000)),
            count = static_cast<int>(std::lround(periods * rate_Hz / frequency_Hz));
  std::complex<double> out = 0;
  for (int n = 0; n < settle + count; ++n) {
    const auto now = end(std::cos(turn.imag() * n));
    if (n >= settle) out += (of_force ? now.heard : now.back) * std::exp(-turn * static_cast<double>(n)) * (2.0 / count);
  }
  return out;
}

}  // namespace

TEST_CASE("waves come back from an end, and push it, as its admittance says") {
  const rosin::wave_end end(bridge, rate_Hz);
  CHECK(end.moves());
  CHECK_FALSE(rosin::wave_end{}.moves());
  for (const double f : {200.0, 440.0, 480.0, 1000.0, 2300.0, 2400.0, 2500.0, 5000.0, 8000.0, 20000.0}) {
    CAPTURE(f);
    const auto z = bridge.relative_admittance(f);
    CHECK(std::abs(response(end, f, false) - (1.0 - z) / (1.0 + z)) < 2e-3);
    CHECK(std::abs(response(end, f, true) - 1.0 / (1.0 + z)) < 1e-3);
  }
}

TEST_CASE("modes near the limit of the rate are springs below") {
  const rosin::modal_termination stiff{{{90e3, 0.5, 4e5}}};
  const rosin::wave_end end(stiff, rate_Hz);
  for (const double f : {300.0, 1000.0, 5000.0, 15000.0}) {
    CAPTURE(f);
    const auto z = stiff.relative_admittance(f);
    CHECK(std::abs(response(end, f, true) - 1.0 / (1.0 + z)) < 0.02 * std::abs(z / (1.0 + z)));
  }
}

TEST_CASE("no end gives energy, whatever comes") {
  rosin::wave_end end({{{90, 3, 5000}, {700, 400, 900}, {30000, 0.7, 2e5}}}, rate_Hz);
  double in = 0, out = 0, x = 0.3;
  for (int n = 0; n < 100000; ++n) {
    x = 4 * x * (1 - x);  // chaos: all frequencies
    const double s = n < 60000 ? x - 0.5 : 0, back = end(s).back;
    in += s * s, out += back * back;
    CHECK(out <= in * (1 + 1e-12));
  }
  CHECK(out > 0.1 * in);
}

TEST_CASE("what cannot be simulated is refused") {
  CHECK(rosin::problem_with(bridge, rate_Hz).empty());
  CHECK_FALSE(rosin::problem_with(rosin::modal_termination{{{460, 30, -1}}}, rate_Hz).empty());
  CHECK_FALSE(rosin::problem_with(rosin::modal_termination{{{0, 30, 1}}}, rate_Hz).empty());
  CHECK(rosin::problem_with(rosin::modal_termination{{{120e3, 30, 1}}}, rate_Hz).find("rate") != std::string::npos);
}

}  // namespace simulate_wave_end
