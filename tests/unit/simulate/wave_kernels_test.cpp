// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_kernels.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_wave_kernels {

TEST_CASE("lags, look-ahead and mobility, also in single precision") {
  rosin::wave_kernels<double> k;
  k.stride = 2;
  k.echo = {rosin::wave_taps<double>{rosin::fir{5, {-1, 0.25}}}, rosin::wave_taps<double>{rosin::fir{9, {-1}}}};
  k.thin = rosin::wave_taps<double>{rosin::fir{-2, {0.1, 0.2, 0.4, 0.2, 0.1}}};
  k.fill = {rosin::wave_taps<double>{rosin::fir{-3, {1, 1, 1}}}, rosin::wave_taps<double>{rosin::fir{-1, {1}}}};
  k.local = {2.5, 1};
  k.turn_rest = 0.25;
  const rosin::wave_kernels<float> single{k};
  CHECK(k.reach_back() == 9);
  CHECK(k.look_ahead() == 2);
  CHECK(k.fill_ahead() == 3);
  CHECK(k.mobility_m_Ns() == test::approx(2.75));
  CHECK(single.mobility_m_Ns() == test::approx(2.75));
  CHECK(single.echo[0].taps[1] == 0.25F);
  CHECK(single.echo[0].last() == 6);
}

}  // namespace simulate_wave_kernels
