// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_prediction.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

namespace {

constexpr double seen_noise_N = 3e-4;

/// Two plucks, and the fit that knows them exactly.
struct seen_plucks {
  rosin::pluck_layout layout;
  rosin::scene_data data;
  rosin::scene_fit fit;
};
seen_plucks seen_as_made() {
  const auto layout = test::two_plucks({});
  seen_plucks out{layout, {{}, {.fundamental_Hz = 660}, {}, layout}, {}};
  out.fit.value = test::values_of(layout), out.fit.horizon_periods = 1e9;
  for (std::size_t t = 0; t < 2; ++t)
    out.data.takes.push_back(test::scene_pluck(layout, {}, out.fit.value, t, seen_noise_N, t + 1));
  return out;
}

}  // namespace

TEST_CASE("noise is told from what the recordings show before the release") {
  auto [layout, data, fit] = seen_as_made();
  const auto before = rosin::detail::noise_before_release(data, fit);
  for (const double n : before.rms_N) CHECK(n == test::approx(seen_noise_N).epsilon(0.12));  // some 600 samples
  fit.value[layout.at(0, rosin::pluck_layout::strength)] += 0.1;  // how strong the steady force was is another matter
  CHECK(rosin::detail::noise_before_release(data, fit).rms_N[0] == test::approx(before.rms_N[0]));
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
  CHECK_FALSE(rosin::detail::is_noisier({1e-3, 1.35e-3}, well, true));
  CHECK(rosin::detail::is_noisier({1e-3, 1.45e-3}, well, true));
  CHECK_FALSE(rosin::detail::is_noisier({1e-3, 1.4e-3}, hardly));
  CHECK(rosin::detail::is_noisier({1.6e-3, 1e-3}, hardly));
}

TEST_CASE(
    "a pluck from a place of its own is predicted from there, as far off as a notebook is; where others were made, from theirs") {
  seen_plucks p = seen_as_made();
  Eigen::VectorXd there = p.fit.value;
  there[p.layout.position(0)] = 0.421;
  rosin::pluck_take held = test::scene_pluck(p.layout, {}, there, 0, seen_noise_N, 3);
  const auto left_over_floor = [&](double declared) {
    held.position = declared;
    const auto [left, floor, samples] = rosin::detail::predicted(p.data, p.fit, held, seen_noise_N);
    return left / floor;
  };
  CHECK(left_over_floor(0.42) == test::approx(1).epsilon(0.1));  // 0.3 of the others stands for 0.301
  CHECK(left_over_floor(0.4203) == test::approx(1).epsilon(0.1));
  CHECK(left_over_floor(0.413) == test::approx(1).epsilon(0.1));  // both a little off, to opposite sides
  CHECK(left_over_floor(0.44) > 20);
  p.data.guess.position_tolerance = 0;
  CHECK(left_over_floor(0.4203) > 1.5);
  there[p.layout.position(0)] = 0.3015;
  held = test::scene_pluck(p.layout, {}, there, 0, seen_noise_N, 4);
  CHECK(left_over_floor(0.3) > 3);
}

TEST_CASE(
    "sensors' zeros creep from take to take, and a high-pass remembers for how long a string was held: both are free in a "
    "prediction") {
  const auto layout = test::two_plucks({});
  const rosin::string_facts facts{659.69, 128e3, 60e3, 0.175, 0.314, 2};
  const auto coupled = rosin::ac_coupling_effect(facts);
  const auto left_over_floor = [&](const std::vector<rosin::pluck_effect>& effects, std::array<double, 2> declared_Hz,
                                   double offset_N) {
    rosin::scene_data data{{}, {.fundamental_Hz = 660, .ac_coupled_Hz = declared_Hz}, {}, layout};
    rosin::scene_fit fit;
    fit.value = test::values_of(layout, effects.empty() ? std::vector<double>{} : std::vector{std::log(5.0)});
    fit.effects = effects, fit.horizon_periods = 1e9;
    for (std::size_t t = 0; t < 2; ++t)
      data.takes.push_back(test::scene_pluck(layout, effects, fit.value, t, seen_noise_N, t + 1));
    Eigen::VectorXd here = fit.value;
    here[layout.at(0, rosin::pluck_layout::offset_near)] = offset_N;
    here[layout.at(0, rosin::pluck_layout::offset_far)] = 0.4 * offset_N;
    const auto [left, floor, samples] =
        rosin::detail::predicted(data, fit, test::scene_pluck(layout, effects, here, 0, seen_noise_N, 3), seen_noise_N);
    return left / floor;
  };
  CHECK(left_over_floor({coupled}, {0, 0}, 0.3) == test::approx(1).epsilon(0.1));
  CHECK(left_over_floor({}, {0, 0}, 0.002) == test::approx(1).epsilon(0.1));
  CHECK(left_over_floor({}, {0, 0}, 0.3) == test::approx(1).epsilon(0.1));
}
