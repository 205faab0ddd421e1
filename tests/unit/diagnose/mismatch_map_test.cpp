// SPDX-License-Identifier: MIT
#include <rosin/diagnose/mismatch_map.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace {

constexpr double map_rate_Hz = 128e3, map_begin_s = 0.0042;
const rosin::band map_limits{43e3, 54e3};
const std::array<rosin::echo_times, 2> map_times{{{0.004, 1 / 660.0, 0.3}, {0.004, 1 / 660.0, 0.7}}};

/// White noise of 1 mN through the band, by a transform of its own.
std::array<Eigen::VectorXd, 2> seen_noise() {
  std::mt19937_64 random{3};
  std::normal_distribution<double> normal{0, 1e-3};
  std::array<Eigen::VectorXd, 2> out;
  for (auto& x : out) {
    std::vector<double> wave(7680), seen(7680);
    std::vector<std::complex<double>> bins(3841);
    for (double& v : wave) v = normal(random);
    rosin::eigen_fft<double> fft(7680);
    fft.forward(wave.data(), bins.data());
    for (std::size_t k = 0; k < bins.size(); ++k) bins[k] *= map_limits(map_rate_Hz * static_cast<double>(k) / 7680);
    fft.inverse(bins.data(), seen.data());
    x = Eigen::Map<Eigen::VectorXd>(seen.data(), 7680);
  }
  return out;
}

}  // namespace

TEST_CASE("mismatch map: waves arrive as on a string that is drawn with its mirror images") {
  for (const double d : {0.3, 0.7}) {
    std::vector<double> ways;  // of the images of a pluck, in lengths
    for (int image = 0; image < 6; ++image) ways.push_back(2 * image + d), ways.push_back(2 * image + 2 - d);
    std::sort(ways.begin(), ways.end());
    const rosin::echo_times when{0.01, 0.002, d};
    for (int echo = 1; echo <= 12; ++echo) {
      CHECK(when.arrival_s(echo) == test::approx(0.01 + 0.001 * ways[static_cast<std::size_t>(echo - 1)]));
      CHECK(when.at(when.arrival_s(echo) + 1e-9) == echo);
      CHECK(when.at(when.arrival_s(echo) - 1e-9) == echo - 1);
    }
    CHECK(when.at(0) == 0);
  }
}

TEST_CASE("mismatch map: noise is one everywhere, the rows follow each other without a gap") {
  const auto map = rosin::map_of(seen_noise(), map_begin_s, map_rate_Hz, map_times, map_limits, {1e-3, 1e-3});
  CHECK(map.band_Hz.front() == 0);
  CHECK(map.band_Hz[1] >= 660);
  CHECK(map.band_Hz.back() == 43e3);
  for (const auto& channel : map.channels) {
    REQUIRE(channel.time_s.size() == channel.echo.size() + 1);
    CHECK(std::is_sorted(channel.time_s.begin(), channel.time_s.end()));
    CHECK(channel.time_s.front() == map_begin_s);
    CHECK(channel.time_s.back() == test::approx(map_begin_s + 0.06));
    const auto top = channel.over_noise.rightCols(1);  // twenty independent samples a cell at least, the last two thousand
    CHECK((top.array() - 1).abs().maxCoeff() < 0.6);
    CHECK(std::abs(top.mean() - 1) < 0.05);
    CHECK(std::abs(top(top.rows() - 1) - 1) < 0.1);
    CHECK(channel.over_noise.bottomRows(1).minCoeff() > 0.5);
    CHECK(channel.over_noise.bottomRows(1).maxCoeff() < 1.5);
  }
}

TEST_CASE("mismatch map: a burst stands in its channel, behind its echo and in its octave") {
  auto residual = seen_noise();
  const double from_s = map_times[1].arrival_s(5) + 1e-4;
  for (int i = 0; i < 40; ++i) {
    const auto at = static_cast<Eigen::Index>((from_s - map_begin_s) * map_rate_Hz) + i;
    residual[1][at] += 0.02 * std::sin(3.14159265 * i / 40) * std::sin(2 * 3.14159265 * 16e3 * i / map_rate_Hz);
  }
  const auto map = rosin::map_of(residual, map_begin_s, map_rate_Hz, map_times, map_limits, {1e-3, 1e-3});
  Eigen::Index row = 0, octave = 0;
  const double most = map.channels[1].over_noise.maxCoeff(&row, &octave);
  CHECK(most > 6);
  CHECK(map.channels[1].echo[static_cast<std::size_t>(row)] == 5);
  CHECK(map.band_Hz[static_cast<std::size_t>(octave)] < 16e3);
  CHECK(map.band_Hz[static_cast<std::size_t>(octave) + 1] > 16e3);
  CHECK(map.channels[0].over_noise.maxCoeff() < 3);
}
