// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/end_weights.hpp>

#include <rosin/propagate/transmission.hpp>
#include <rosin/reconstruct/bow_point_transfer.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

using weight = std::complex<double>;
const rosin::bow_point weighed_at{{0.23e-3, 1.4e-3}, 4e-12, {.quality = 700}, 0.3};

weight rate_at(double f) { return rosin::propagation_rate(f, weighed_at.stiffness_s2, weighed_at.loss); }
bool near_to(weight a, weight b) { return std::abs(a - b) < 1e-9 * std::abs(b); }

}  // namespace

TEST_CASE("Both versions are those of the reconstruction by kernels") {
  const rosin::bow_point_transfer<rosin::full_physics> transfer(weighed_at, {20e3, 40e3}, 128e3);
  for (const double f : {50.0, 333.3, 4000.0, 17000.0}) {
    const auto expected = transfer(f);
    const auto w = rosin::weigh_ends(rate_at(f), f, weighed_at, {});
    for (std::size_t j = 0; j < 2; ++j) {
      CHECK(near_to(w.near.force[j], expected[j]));
      CHECK(near_to(w.far.force[j], expected[2 + j]));
      CHECK(near_to(w.near.velocity[j], expected[4 + j]));
      CHECK(near_to(w.far.velocity[j], expected[6 + j]));
    }
  }
}

TEST_CASE("All ways find the force that a string of this kind was bowed with") {
  for (const double f : {50.0, 333.3, 1234.5, 4000.0, 17000.0}) {
    const weight rate = rate_at(f), g1 = rate * weighed_at.delay_s[0], g2 = rate * weighed_at.delay_s[1];
    const double G = rosin::force_factor(2 * std::numbers::pi * f, weighed_at.stiffness_s2);
    const weight one = std::sinh(g2) / std::sinh(g1 + g2) / G, two = std::sinh(g1) / std::sinh(g1 + g2) / G;  // for 1 N
    const auto w = rosin::weigh_ends(rate, f, weighed_at, {{0.5e-3, 0.9e-3}, 0.03});
    for (const auto* way : {&w.near, &w.far, &w.mean, &w.combined})
      CHECK(std::abs(way->force[0] * one + way->force[1] * two - 1.0) < 1e-9);
    const weight v = w.mean.velocity[0] * one + w.mean.velocity[1] * two;
    CHECK(std::abs(w.combined.velocity[0] * one + w.combined.velocity[1] * two - v) < 1e-9 * std::abs(v));
    CHECK(std::abs(w.mismatch[0] * one + w.mismatch[1] * two) < 1e-9);
  }
}

TEST_CASE("Without a floor it is the regression on what either end hears, and no other weights have less variance") {
  const std::array<double, 2> noise{0.4e-3, 1.1e-3};
  for (const double f : {200.0, 931.0, 5120.0}) {
    const weight rate = rate_at(f), s1 = std::sinh(rate * weighed_at.delay_s[0]), s2 = std::sinh(rate * weighed_at.delay_s[1]),
                 whole = std::sinh(rate * (weighed_at.delay_s[0] + weighed_at.delay_s[1]));
    const double G = rosin::force_factor(2 * std::numbers::pi * f, weighed_at.stiffness_s2), a = noise[0] * noise[0],
                 b = noise[1] * noise[1];
    const weight per = G * whole / (a * std::norm(s1) + b * std::norm(s2));
    const auto w = rosin::weigh_ends(rate, f, weighed_at, {noise, 0});
    CHECK(near_to(w.combined.force[0], per * b * std::conj(s2)));
    CHECK(near_to(w.combined.force[1], per * a * std::conj(s1)));
    CHECK(w.combined.force_variance(noise) <= w.mean.force_variance(noise));
    for (const weight by : {weight(0.1, 0), weight(-0.1, 0), weight(0, 0.1), weight(0, -0.1)}) {
      auto other = w.combined;
      for (std::size_t j = 0; j < 2; ++j) other.force[j] += by * w.mismatch[j], other.velocity[j] += by * w.mismatch[j];
      CHECK(other.force_variance(noise) > w.combined.force_variance(noise));
    }
  }
}

TEST_CASE("Where the model leaves much more than noise, the combination is the mean") {
  const auto w = rosin::weigh_ends(rate_at(1000), 1000, weighed_at, {{1e-3, 1e-3}, 0.03, 1e-3}, {1e9, 1e9});
  for (std::size_t j = 0; j < 2; ++j) CHECK(std::abs(w.combined.force[j] - w.mean.force[j]) < 1e-3 * std::abs(w.mean.force[j]));
}
