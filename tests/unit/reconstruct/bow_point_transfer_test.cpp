// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/bow_point_transfer.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/approx.hpp"

namespace reconstruct_bow_point_transfer {

namespace {

using complex = std::complex<double>;
const rosin::string_parameters ideal{0.314, 72.5, 659.69, 4.7e-5, {}};
constexpr double position = 0.27, rate_Hz = 128e3;
const rosin::band limits{30e3, 60e3};

struct response {
  complex near, far, velocity;  ///< N/N, N/N, m/s per N
};

/// A pinned stiff string driven by 1 N at its contact, by summing modes: no wave, no near field, no force factor anywhere.
/// The tail of the sums beyond `modes` is taken from what it would be without inertia (forces) and stiffness alone (velocity).
response by_modes(double f_Hz, double q) {
  const double w = 2 * std::numbers::pi * f_Hz, L = ideal.length_m, T = ideal.tension_N, B = ideal.bending_stiffness_Nm2;
  const double m = ideal.linear_density_kg_m();
  response r{1 - position, position, 0};
  for (int n = 1; n <= 60000; ++n) {
    const double k = n * std::numbers::pi / L, stiffness = T * k * k + B * k * k * k * k;
    const double shape = std::sin(k * position * L), sign = n % 2 ? 1.0 : -1.0;
    const complex with = 2 / L * shape / (stiffness * complex(1, 1 / q) - m * w * w), without = 2 / L * shape / stiffness;
    const complex end = (T * k + B * k * k * k);
    // static part in closed form (1 - p, p); the sum only carries what inertia adds, and converges
    r.near += (with * complex(1, 1 / q) - without) * end;
    r.far += sign * (with * complex(1, 1 / q) - without) * end;
    r.velocity += complex(0, w) * with * shape;
  }
  return r;
}

/// What bow_point_transfer makes of these end forces: the force back to 1 N, and the velocity.
template <class Physics>
std::array<complex, 4> back(const response& r, double f_Hz, const rosin::loss_law& loss) {
  rosin::string_parameters s = ideal;
  s.loss = loss;
  const rosin::bow_point_transfer<Physics> h(rosin::contact_at(s, position), limits, rate_Hz);
  const auto m = h(f_Hz);
  std::array<complex, 4> out;
  for (std::size_t i = 0; i < 4; ++i) out[i] = m[2 * i] * r.near + m[2 * i + 1] * r.far;
  return out;
}

}  // namespace

TEST_CASE("force and velocity at the contact of a stiff string come back exactly from its end forces") {
  for (const double f : {313.0, 1500.0, 7777.0, 17100.0, 29000.0}) {
    CAPTURE(f);
    const response r = by_modes(f, 1e12);
    const auto out = back<rosin::full_physics>(r, f, {});
    CHECK(std::abs(out[0] - 1.0) < 1e-6);
    CHECK(std::abs(out[1] - 1.0) < 1e-6);
    CHECK(std::abs(out[2] - r.velocity) < 1e-5 * std::abs(r.velocity) + 1e-7);
    CHECK(std::abs(out[3] - r.velocity) < 1e-5 * std::abs(r.velocity) + 1e-7);
  }
}

TEST_CASE("each refinement earns its place") {
  const double f = 17100;
  const response r = by_modes(f, 1e12);
  const auto plain = back<rosin::physics<false, false, false>>(r, f, {});
  CHECK(std::abs(plain[0] - 1.0) == test::approx(1 - 1 / 1.0404).epsilon(0.02));  // G is missing
  const auto far_field = back<rosin::physics<true, false, true>>(r, f, {});
  CHECK(std::abs(far_field[0] - 1.0) < 1e-6);
  CHECK(std::abs(far_field[2] - r.velocity) > 1e-3 * std::abs(r.velocity));  // the near field is missing
}

TEST_CASE("with loss the compensated versions agree, the lossless ones do not") {
  const double f = 9000, q = 500;
  const response r = by_modes(f, q);
  const auto with = back<rosin::full_physics>(r, f, {q, 0, 0});
  CHECK(std::abs(with[0] - 1.0) < 3e-3);  // the two ways of writing a loss agree to about 1/Q
  CHECK(std::abs(with[0] - with[1]) < 1e-3);
  const auto without = back<rosin::physics<true, true, false>>(r, f, {q, 0, 0});
  CHECK(std::abs(without[0] - without[1]) > 0.02);
}

TEST_CASE("the paper's Airy kernels, inverted by time reversal, are an all-pass and stay near the exact phase") {
  rosin::string_parameters s = ideal;
  const rosin::bow_point at = rosin::contact_at(s, position);
  const rosin::band band{20e3, 40e3};
  const rosin::airy_passage<> airy(at, 0, band, rate_Hz);
  const rosin::exact_passage exact(at, 0, band, rate_Hz);
  for (double f = 0; f <= 20e3; f += 2500) {
    CHECK(std::abs(airy.forward(f) - exact.forward(f)) < 2e-3);
    CHECK(std::abs(airy.forward(f) * airy.back(f) - 1.0) < 4e-3);
  }
}

}  // namespace reconstruct_bow_point_transfer
