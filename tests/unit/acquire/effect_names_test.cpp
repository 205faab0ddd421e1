// SPDX-License-Identifier: MIT
#include <rosin/acquire/effect_names.hpp>

#include <doctest/doctest.h>

#include <set>

namespace acquire_effect_names {

TEST_CASE("every effect name is there once, and nothing else is one") {
  CHECK(std::set(rosin::effect_names.begin(), rosin::effect_names.end()).size() == rosin::effect_names.size());
  CHECK(rosin::is_effect_name("support-resonance"));
  CHECK(rosin::is_effect_name("creep"));
  CHECK_FALSE(rosin::is_effect_name(""));
  CHECK_FALSE(rosin::is_effect_name("Support-resonance"));
}

}  // namespace acquire_effect_names
