// expect: FrictionLaw
// SPDX-License-Identifier: MIT
// A law without reset() cannot start a take anew.
#include <rosin/simulate/modal_stroke.hpp>

struct dry {
  using scalar = double;
  rosin::contact_force<double> operator()(const rosin::load_line<double>& line) noexcept {
    return {line.sticking_force(), 0, false, true};
  }
#ifndef ROSIN_MUST_FAIL
  void reset() noexcept {}
#endif
};

auto take = rosin::simulate_stroke(rosin::modal_rig{}, dry{});
