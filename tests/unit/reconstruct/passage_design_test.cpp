// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/passage_design.hpp>

#include <doctest/doctest.h>

namespace reconstruct_passage_design {

namespace {

rosin::bow_point contact(double position) { return rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {1000, 1e-9, 0}}, position); }
constexpr rosin::band of_rate(double rate_Hz) { return {0.3 * rate_Hz, 0.45 * rate_Hz}; }

/// Largest difference of two of the 4 x 2 transfer functions in the pass band, against the largest of the output's row.
double row_error(const std::vector<rosin::fir>& kernels, const rosin::bow_point& at, const rosin::band& limits, double rate_Hz,
                 std::size_t row) {
  const rosin::bow_point_transfer<rosin::full_physics> exact(at, limits, rate_Hz);
  double worst = 0, scale = 0;
  for (int i = 0; i <= 300; ++i) {
    const double f = limits.pass_Hz * i / 300;
    const auto wanted = exact(f);
    for (const std::size_t k : {2 * row, 2 * row + 1}) {
      worst = std::max(worst, std::abs(kernels[k].response(f, rate_Hz) - wanted[k]));
      scale = std::max(scale, std::abs(wanted[k]));
    }
  }
  return worst / scale;
}

}  // namespace

TEST_CASE("forces are the whole-record kernels, velocities within a few times the error asked for") {
  for (const double rate_Hz : {48e3, 128e3})
    for (const double error : {1e-2, 1e-3}) {
      const auto at = contact(0.3);
      const auto limits = of_rate(rate_Hz);
      const auto plan = rosin::plan_passages(at, {1, 1}, limits, rate_Hz, error);
      const auto whole = rosin::bow_point_kernels<rosin::full_physics>(at, limits, rate_Hz, error);
      CHECK(plan.passage[0].taps == whole[0].taps);
      CHECK(plan.passage[3].first == whole[1].first);
      const auto kernels = rosin::kernels_of(plan);
      for (const std::size_t row : {0U, 1U}) CHECK(row_error(kernels, at, limits, rate_Hz, row) <= 1.01 * error);
      for (const std::size_t row : {2U, 3U}) CHECK(row_error(kernels, at, limits, rate_Hz, row) <= 3 * error);
      CHECK(plan.half_length() <= 10);
    }
}

TEST_CASE("look-ahead is a transit time and half a kernel: of the nearer end for one version, of the farther for both") {
  const double rate_Hz = 128e3;
  const auto at = contact(0.3);
  const auto ahead = [&](rosin::bow_version version) {
    return rosin::plan_passages(at, {1, 1}, of_rate(rate_Hz), rate_Hz, 1e-3, version).reach_ahead();
  };
  const double near = at.delay_s[0] * rate_Hz, far = at.delay_s[1] * rate_Hz;
  CHECK(ahead(rosin::bow_version::near) >= near);
  CHECK(ahead(rosin::bow_version::near) <= near + 20);
  CHECK(ahead(rosin::bow_version::both) >= far);
  CHECK(ahead(rosin::bow_version::both) <= far + 20);
  CHECK(ahead(rosin::bow_version::far) == ahead(rosin::bow_version::both));
}

TEST_CASE("what does not fit says what would") {
  const double rate_Hz = 48e3;
  const auto plan = rosin::plan_passages(contact(0.3), {1, 1}, of_rate(rate_Hz), rate_Hz, 1e-3, rosin::bow_version::both, 6);
  CHECK(rosin::fixed_size<float, 64, 256, 6>(plan));
  const auto taps = rosin::fixed_size<float, 16, 256, 6>(plan);
  REQUIRE_FALSE(taps);
  CHECK(taps.error().find("there is room for 16") != std::string::npos);
  const auto line = rosin::fixed_size<float, 64, 32, 6>(plan);
  REQUIRE_FALSE(line);
  CHECK(line.error().find("the delay lines hold 32") != std::string::npos);
  const auto half = rosin::fixed_size<float, 64, 256, 5>(plan);
  REQUIRE_FALSE(half);
  CHECK(half.error().find("half-length 6, not 5") != std::string::npos);
}

}  // namespace reconstruct_passage_design
