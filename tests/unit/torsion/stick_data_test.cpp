// SPDX-License-Identifier: MIT
#include <rosin/torsion/stick_data.hpp>

#include <doctest/doctest.h>

#include <complex>
#include <limits>

namespace torsion_stick_data {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("stick data: unknown ends are left out, the start is not used, the rod's speed is taken off") {
  std::vector<double> force(6000, 0.2), velocity(6000, 0.21);
  for (std::size_t i = 0; i < 50; ++i) force[i] = velocity[i] = unknown, velocity[5999 - i] = unknown;
  rosin::stick_record record({force, velocity, 128e3, 0.2, {2e-4, 5e-4}, 0.17, 1e-3, 57600, 0.005});
  CHECK(record.origin() == 50);
  CHECK(record.size() == 5900);
  CHECK(record.begin() == 640);
  CHECK(record.end() == 5900 - record.reach());
  for (std::size_t i = record.begin(); i < record.end(); ++i) CHECK(std::abs(record.relative_m_s()[i] - 0.01) < 1e-9);
  for (const double v : record.force_through([](double f) { return f == 0 ? 3.0 : 3.0; })) CHECK(std::abs(v - 0.6) < 1e-9);
}

namespace {

/// Rings for long at 300 Hz.
struct bell {
  double q;
  std::complex<double> operator()(double f) const noexcept { return 1.0 / std::complex<double>(300 * 300 - f * f, f * 300 / q); }
  double memory_s() const noexcept { return 7 * q / (3.14 * 300); }
};

}  // namespace

TEST_CASE(
    "stick data: what rings for long does not ring on at the record's beginning, and changes as the difference of two does") {
  std::vector<double> force(6000, 0.0), velocity(6000, 0.2);
  for (std::size_t i = 5500; i < 5700; ++i) force[i] = 1;
  rosin::stick_record record({force, velocity, 128e3, 0.2, {2e-4, 5e-4}, 0.17, 1e-3, 57600, 0.005});
  const auto short_lived = [](double f) { return bell{170}(f); };  // does not say that it rings
  const auto rung = record.force_through(bell{170}), wrapped = record.force_through(short_lived);
  double late = 0, early = 0, around = 0;
  for (std::size_t i = 0; i < 5400; ++i)
    early = std::max(early, std::abs(rung[i])), around = std::max(around, std::abs(wrapped[i]));
  for (std::size_t i = 5500; i < 6000; ++i) late = std::max(late, std::abs(rung[i]));
  CHECK(early < 2e-3 * late);
  CHECK(around > 0.2 * late);
  const auto slope = record.force_through(rosin::transfer_slope<bell>{{171}, {169}, 0.5}), up = record.force_through(bell{171}),
             down = record.force_through(bell{169});
  for (std::size_t i = 0; i < slope.size(); i += 100) CHECK(std::abs(slope[i] - 0.5 * (up[i] - down[i])) < 2e-3 * late);
}

TEST_CASE("stick data: sticking samples keep a window's reach from every slip") {
  std::vector<double> force(4000, 0.2), velocity(4000, 0.2);
  for (std::size_t i = 2000; i < 2100; ++i) velocity[i] = -1;
  rosin::stick_record record({force, velocity, 128e3, 0.2, {2e-4, 5e-4}, 0.17, 1e-3, 57600, 0.005});
  const auto marked = rosin::sticking_samples(record, record.relative_m_s());
  CHECK(marked[1990] == 1);
  for (std::size_t i = 2000 - record.reach() + 1; i < 2100 + record.reach(); ++i) CHECK(marked[i] == 0);
  CHECK(marked[2110] == 1);
  CHECK(marked[100] == 0);  // before the record's begin()
  const auto rows = rosin::pick(marked, record.relative_m_s(), {force}, {velocity, force});
  CHECK(rows.sample.size() > 1600);
  CHECK(rows.shared.cols() == 1);
  CHECK(rows.own.cols() == 2);
  CHECK(rows.target.size() == static_cast<Eigen::Index>(rows.sample.size()));
  for (std::size_t i = 0; i < rows.sample.size(); ++i) {
    CHECK(marked[rows.sample[i]] == 1);
    CHECK(rows.own(static_cast<Eigen::Index>(i), 0) == velocity[rows.sample[i]]);
  }
}

}  // namespace torsion_stick_data
