// expect: RodMotion
// SPDX-License-Identifier: MIT
// The speed alone does not say how the rod presses.
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_stroke.hpp>

struct sled {
#ifdef ROSIN_MUST_FAIL
  double operator()(double) const noexcept { return 0.2; }
#else
  rosin::rod_state operator()(double) const noexcept { return {0.2, 0.3}; }
#endif
};

auto take = rosin::simulate_stroke(rosin::modal_rig{}, rosin::velocity_curve<rosin::two_exponential_curve<>>{{}}, sled{});
