// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_prediction.hpp>

#include "plucked.hpp"

#include <doctest/doctest.h>

TEST_CASE("noise is told from what the recordings show before the release") {
  const auto layout = test::two_plucks({});
  const Eigen::VectorXd v = test::values_of(layout);
  constexpr double noise_N = 3e-4;
  const std::vector<rosin::pluck_take> takes{test::scene_pluck(layout, {}, v, 0, noise_N, 1),
                                             test::scene_pluck(layout, {}, v, 1, noise_N, 2)};
  const rosin::scene_data data{takes, {.fundamental_Hz = 660}, {}, layout};
  rosin::scene_fit fit;
  fit.value = v, fit.horizon_periods = 1e9;
  const auto before = rosin::detail::noise_before_release(data, fit);
  for (const double n : before.rms_N) CHECK(n == doctest::Approx(noise_N).epsilon(0.12));  // some 600 samples
  fit.value[layout.at(0, rosin::pluck_layout::strength)] += 0.1;  // how strong the steady force was is another matter
  CHECK(rosin::detail::noise_before_release(data, fit).rms_N[0] == doctest::Approx(before.rms_N[0]));
}

TEST_CASE("a record that begins with the release says nothing of its noise, and then nothing is called noisier") {
  const auto layout = test::two_plucks({});
  Eigen::VectorXd v = test::values_of(layout);
  v[layout.at(0, rosin::pluck_layout::release)] = v[layout.at(1, rosin::pluck_layout::release)] = 0.0003;
  const std::vector<rosin::pluck_take> takes{test::scene_pluck(layout, {}, v, 0, 3e-4, 1),
                                             test::scene_pluck(layout, {}, v, 1, 3e-4, 2)};
  rosin::scene_fit fit;
  fit.value = v, fit.horizon_periods = 1e9;
  const auto before = rosin::detail::noise_before_release({takes, {.fundamental_Hz = 660}, {}, layout}, fit);
  CHECK(before.samples == 0);
  CHECK_FALSE(rosin::detail::is_noisier({1, 1}, before));
}

TEST_CASE("noisier is by three tenths, and by more where little was seen") {
  const rosin::detail::seen_noise well{{1e-3, 1e-3}, 600}, hardly{{1e-3, 1e-3}, 40};
  CHECK(rosin::detail::is_noisier({1e-3, 1.4e-3}, well));
  CHECK_FALSE(rosin::detail::is_noisier({1e-3, 1.1e-3}, well));
  CHECK_FALSE(rosin::detail::is_noisier({1e-3, 1.4e-3}, hardly));
  CHECK(rosin::detail::is_noisier({1.6e-3, 1e-3}, hardly));
}

TEST_CASE(
    "a pluck from a place of its own is predicted from there, as far off as a notebook is; where others were made, from theirs") {
  const auto layout = test::two_plucks({});
  const Eigen::VectorXd v = test::values_of(layout);
  constexpr double noise_N = 3e-4;
  const std::vector<rosin::pluck_take> takes{test::scene_pluck(layout, {}, v, 0, noise_N, 1),
                                             test::scene_pluck(layout, {}, v, 1, noise_N, 2)};
  const rosin::scene_data data{takes, {.fundamental_Hz = 660}, {}, layout};
  rosin::scene_fit fit;
  fit.value = v, fit.horizon_periods = 1e9;
  Eigen::VectorXd there = v;
  there[layout.position(0)] = 0.421;
  rosin::pluck_take held = test::scene_pluck(layout, {}, there, 0, noise_N, 3);
  const auto left_over_floor = [&](double declared) {
    held.position = declared;
    const auto [left, floor, samples] = rosin::detail::predicted(data, fit, held, noise_N);
    return left / floor;
  };
  CHECK(left_over_floor(0.42) == doctest::Approx(1).epsilon(0.1));  // 0.3 of the others stands for 0.301
  CHECK(left_over_floor(0.4203) == doctest::Approx(1).epsilon(0.1));
  CHECK(left_over_floor(0.44) > 20);
  there[layout.position(0)] = 0.3015;
  held = test::scene_pluck(layout, {}, there, 0, noise_N, 4);
  CHECK(left_over_floor(0.3) > 3);
}
