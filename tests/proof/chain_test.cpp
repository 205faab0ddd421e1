// SPDX-License-Identifier: MIT
// The figures of the README: the paper's verification, exact and through the whole chain, and the same on random rigs.
#include "chain.hpp"

#include <doctest/doctest.h>

TEST_CASE("exact parameters, no noise: at most 0.002, transient and periodic part") {
  for (const bool thermal : {true, false}) {
    CAPTURE(thermal);
    const rosin::modal_take take = proof::paper_take(thermal);
    const proof::verdict v = proof::with_exact_parameters<rosin::full_physics>(take);
    for (const proof::deltas& d : {v.whole, v.transient, v.periodic}) {
      CHECK(d.versions < 0.002);
      CHECK(d.force < 0.002);
      CHECK(d.velocity < 0.002);
    }
  }
}

TEST_CASE("the paper's processing, done well, is no strawman: its two versions differ by 0.02 to 0.07") {
  const proof::verdict v = proof::with_exact_parameters<rosin::paper_physics>(proof::paper_take(false));
  CHECK(v.whole.versions > 0.02);
  CHECK(v.whole.versions < 0.07);
  CHECK(v.whole.force < 0.042);  // the paper's own figure
}

TEST_CASE("the whole chain on the paper's string: at most 0.006 against the truth, with honest error bars") {
  for (const bool thermal : {true, false}) {
    const proof::chain_result result = proof::run_chain(proof::paper_laboratory(thermal));
    REQUIRE(result.failures.empty());
    REQUIRE(result.rows.size() == 2);
    for (const proof::chain_row& r : result.rows) {
      CAPTURE(r.take);
      CHECK(r.made.whole.force < 0.006);
      CHECK(std::abs(r.scale_error) < 3 * r.scale_sd);
      CHECK(r.force_inside > 0.93);
      CHECK(r.velocity_inside > 0.93);
      CHECK(r.force_width < 1.1);
      CHECK(r.velocity_width < 1.1);
    }
  }
}

TEST_CASE("the same on 24 random rigs, every take of them") {
  const proof::chain_result result = proof::run_random_rigs(1, 24);
  CHECK(result.failures.empty());
  CHECK(static_cast<int>(result.rows.size()) + result.without_slip == 48);
  int scale_outside = 0;
  for (const proof::chain_row& r : result.rows) {
    CAPTURE(r.seed);
    CAPTURE(r.take);
    CHECK(r.made.whole.force < 0.006);
    CHECK(r.force_inside > 0.93);
    CHECK(r.velocity_inside > 0.93);
    CHECK(r.force_width < 1.1);
    CHECK(r.velocity_width < 1.1);
    scale_outside += std::abs(r.scale_error) > 2 * r.scale_sd ? 1 : 0;
  }
  CHECK(scale_outside <= 6);  // two takes a rig share one scale
}
