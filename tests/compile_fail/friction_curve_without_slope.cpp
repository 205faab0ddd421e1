// expect: FrictionCurve
// SPDX-License-Identifier: MIT
// The contact is solved by Newton's method: a curve gives its slope as well.
#include <rosin/friction/elasto_plastic.hpp>

struct coulomb {
  using scalar = float;
#ifdef ROSIN_MUST_FAIL
  float operator()(float) const noexcept { return 0.4f; }
#else
  rosin::curve_point<float> operator()(float) const noexcept { return {0.4f, 0.0f}; }
#endif
  float convex_from() const noexcept { return 0; }
};

rosin::elasto_plastic<coulomb>* law = nullptr;
