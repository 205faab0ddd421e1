// SPDX-License-Identifier: MIT
#include <rosin/friction/friction_law.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_friction_law {

namespace {

/// The least that is a law: never any friction.
struct slippery {
  using scalar = double;
  rosin::contact_force<double> operator()(const rosin::load_line<double>&) noexcept { return {.slipping = true}; }
  void reset() noexcept {}
};

struct may_throw : slippery {
  rosin::contact_force<double> operator()(const rosin::load_line<double>&) { return {}; }
};

}  // namespace

static_assert(rosin::FrictionLaw<slippery>);
static_assert(!rosin::FrictionLaw<may_throw>, "a law runs inside the time step: it must not throw");
static_assert(!rosin::FrictionLaw<int>);

TEST_CASE_TEMPLATE("the sticking force brings the surface to the rod's speed", T, float, double) {
  const rosin::load_line<T> line{T(-0.75), T(2.5), T(0.25), T(0.3), T(1e-6)};
  CHECK(line.sticking_force() == test::approx(0.4));
  CHECK(line.slip(line.sticking_force()) == test::approx(0.0).scale(1));
  CHECK(line.slip(T(0)) == test::approx(-1.0));
}

}  // namespace friction_friction_law
