// SPDX-License-Identifier: MIT
#include <rosin/propagate/termination_table.hpp>

#include <doctest/doctest.h>

#include <random>

namespace propagate_termination_table {

namespace {

constexpr double Z = 0.175;
const rosin::modal_termination body{
    {{280, 25, Z / 0.25}, {460, 35, Z / 0.12}, {900, 30, Z / 0.1}, {2400, 8, Z / 0.03}, {3800, 25, Z / 0.2}}};

/// What a hammer and a laser would write down, up to `to_Hz`.
std::vector<rosin::measured_admittance> measured(double from_Hz, double to_Hz, double step_Hz, double noise = 0) {
  std::mt19937 random{1};
  std::normal_distribution<double> gauss;
  std::vector<rosin::measured_admittance> table;
  for (double f = from_Hz; f <= to_Hz; f += step_Hz)
    table.push_back({f, body.relative_admittance(f) / Z + noise * std::complex<double>(gauss(random), gauss(random))});
  return table;
}

}  // namespace

TEST_CASE("the completion of a table of modes is the modes") {
  const auto end = rosin::complete_admittance(measured(4, 12e3, 4), Z);
  REQUIRE(end);
  double off = 0, size = 0;
  for (double f = 50; f < 9e3; f += 31.3)
    off += std::norm(end->relative_admittance(f) - body.relative_admittance(f)), size += std::norm(body.relative_admittance(f));
  CHECK(std::sqrt(off / size) < 0.05);  // 4 Hz between points, 11 Hz the narrowest resonance
  CHECK(end->mismatch < 0.02);
  CHECK(end->repaired == 0);
  const auto grid = end->on_grid(5, 1600);
  for (std::size_t k = 20; k < grid.size(); k += 37)
    CHECK(std::abs(grid[k] - end->relative_admittance(5.0 * static_cast<double>(k))) < 2e-3);
  const std::complex<double> s(60, 2 * std::numbers::pi * 1500);
  std::complex<double> exact = 0;
  for (const auto& m : body.modes) exact += m(s);
  CHECK(std::abs(end->at(s) - exact) < 0.01 * std::abs(exact));
}

TEST_CASE("modes above and below the table show as a spring and a mass") {
  const auto end = rosin::complete_admittance(measured(600, 1800, 2), Z);
  REQUIRE(end);
  CHECK(end->spring_s > 0);
  CHECK(end->per_mass_per_s > 0);
  double off = 0, size = 0;
  for (double f = 700; f < 1400; f += 7.3)
    off += std::norm(end->relative_admittance(f) - body.relative_admittance(f)), size += std::norm(body.relative_admittance(f));
  CHECK(std::sqrt(off / size) < 0.1);
}

TEST_CASE("noise cannot make it active, a wrong sign is refused") {
  const auto noisy = rosin::complete_admittance(measured(2, 6e3, 2, 2e-3), Z);
  REQUIRE(noisy);
  CHECK(noisy->repaired > 0);
  for (double f = 5; f < 20e3; f *= 1.01) CHECK(noisy->relative_admittance(f).real() > -1e-9);
  auto wrong = measured(2, 6e3, 2);
  for (auto& p : wrong) p.m_sN = -p.m_sN;
  const auto refused = rosin::complete_admittance(wrong, Z);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("not passive") != std::string::npos);
  auto shuffled = measured(2, 6e3, 2);
  std::swap(shuffled[3], shuffled[4]);
  CHECK_FALSE(rosin::complete_admittance(shuffled, Z));
}

TEST_CASE("a reflection function is an admittance, and may not give back more than it gets") {
  const auto damper = rosin::reflecting_end({-0.8}, 48e3);  // a dashpot: z = (1 - 0.8) / (1 + 0.8)
  REQUIRE(damper);
  CHECK(std::abs(damper->relative_admittance(3210) - 0.2 / 1.8) < 1e-12);
  const auto refused = rosin::reflecting_end({-1.0, -0.1}, 48e3);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("not passive") != std::string::npos);
  CHECK_FALSE(rosin::reflecting_end({}, 48e3));
}

}  // namespace propagate_termination_table
