// SPDX-License-Identifier: MIT
#include <rosin/torsion/contact_signal.hpp>

#include <doctest/doctest.h>

#include <rosin/torsion/torsion_response.hpp>

namespace torsion_contact_signal {

namespace {

constexpr double rate = 128e3;

std::vector<double> tone(std::size_t n, double f) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 0.3 + std::cos(2 * std::numbers::pi * f * static_cast<double>(i) / rate);
  return x;
}

}  // namespace

TEST_CASE("contact signal: the window alone is 1 at 0 Hz, and a tone is scaled by it") {
  const rosin::smooth_window window{57600};
  rosin::contact_signal signal(tone(5000, 9600), rate);
  const auto y = signal.through(window, [](double) { return 1.0; });
  const double gain = std::pow(std::cos(std::numbers::pi / 12), 2);
  for (std::size_t i = 200; i < 4800; ++i)
    CHECK(std::abs(y[i] - 0.3 - gain * std::cos(2 * std::numbers::pi * 9600 * static_cast<double>(i) / rate)) < 1e-3);
}

TEST_CASE("contact signal: a derivative") {
  rosin::contact_signal signal(tone(5000, 1000), rate);
  const auto y =
      signal.through(rosin::smooth_window{1e6}, [](double f) { return std::complex<double>(0, 2 * std::numbers::pi * f); });
  for (std::size_t i = 500; i < 4500; ++i) {
    const double exact = -2e3 * std::numbers::pi * std::sin(2e3 * std::numbers::pi * static_cast<double>(i) / rate);
    CHECK(std::abs(y[i] - exact) < 60.0);  // the record's edges reach in a little
  }
}

TEST_CASE("contact signal: the same torsion as the function for whole records") {
  const auto guide = rosin::torsion_of({2.3e-4, 5.3e-4}, 0.175, 7, 3.5, 15);
  const auto force = tone(4000, 4000);
  rosin::contact_signal signal(force, rate);
  const auto mine = signal.through(rosin::smooth_window{1e9}, guide), theirs = rosin::torsion_velocity(guide, force, rate);
  for (std::size_t i = 0; i < 3900; ++i) CHECK(std::abs(mine[i] - theirs[i]) < 3e-3);
}

TEST_CASE("contact signal: beyond its reach the window's kernel is gone") {
  const rosin::smooth_window window{57600};
  const std::size_t reach = window.reach(rate);
  CHECK(reach <= 4);
  std::vector<double> x(1001, 0.0);
  x[500] = 1;
  rosin::contact_signal signal(x, rate);
  const auto y = signal.through(window, [](double) { return 1.0; });
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i + reach < 500 || i > 500 + reach) CHECK(std::abs(y[i]) < 2e-3);
  CHECK(std::abs(y[500 + 2]) > 0.01);
}

TEST_CASE("contact signal: two signals through one transform are the sum of both, up to the bins that are asked") {
  const rosin::smooth_window window{57600};
  rosin::contact_signal a(tone(3000, 2000), rate), b(tone(3000, 7000), rate);
  const auto of_a = [](double f) { return std::complex<double>(1, f / 1e4); };
  const auto of_b = [](double f) { return std::complex<double>(0.5 - f / 3e4, 0); };
  const auto by_bin = [&](const auto& transfer) {
    return [&, transfer](std::size_t k) { return transfer(static_cast<double>(k) * a.bin_Hz()); };
  };
  const auto one = a.through(window, of_a), other = b.through(window, of_b);
  const auto both = a.through_with(b, window, 100000, by_bin(of_a), by_bin(of_b));
  double worst = 0;
  for (std::size_t i = 0; i < both.size(); ++i) worst = std::max(worst, std::abs(both[i] - one[i] - other[i]));
  CHECK(worst < 1e-12);
  const auto below_Hz = 5000.0;
  const auto low = a.through_with(b, window, static_cast<std::size_t>(below_Hz / a.bin_Hz()), by_bin(of_a), by_bin(of_b));
  for (std::size_t i = 500; i < 2500; ++i)  // all of the tone at 2000 Hz, nothing of the one at 7000 Hz
    CHECK(std::abs(low[i] - one[i] - 0.5 * 0.3) < 0.02);
}

}  // namespace torsion_contact_signal
