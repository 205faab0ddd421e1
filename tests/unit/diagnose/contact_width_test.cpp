// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_width.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"

TEST_CASE("contact width: a contact at one point is not called wide") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  CHECK((!h || !h->decided));
}
