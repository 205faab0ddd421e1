// SPDX-License-Identifier: MIT
#include <rosin/math/robust_loss.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

#include "support/approx.hpp"

namespace {

constexpr std::initializer_list<double> residuals{-30, -2.7, -1.1, -0.3, 1e-3, 0.2, 0.9, 1.6, 5, 1e3};

/// What all losses have in common: derivatives by central differences, even and odd, least at 0, weights that only fall.
template <rosin::RobustLoss Loss>
void check(const Loss& loss, double weight_at_0) {
  CHECK(loss.rho(0) == 0);
  CHECK(loss.psi(0) == 0);
  CHECK(loss.weight(0) == test::approx(weight_at_0).epsilon(1e-15));
  CHECK(loss.slope(0) == test::approx(weight_at_0).epsilon(1e-15));
  CHECK(loss.rho(1e-8) == test::approx(weight_at_0 * 0.5e-16).epsilon(1e-7));
  for (const double u : residuals) {
    CAPTURE(u);
    const double h = 1e-5 * std::abs(u);
    CHECK(loss.psi(u) == test::approx((loss.rho(u + h) - loss.rho(u - h)) / (2 * h)).epsilon(1e-5));
    CHECK(std::abs(loss.slope(u) - (loss.psi(u + h) - loss.psi(u - h)) / (2 * h)) < 1e-7 * weight_at_0);
    CHECK(loss.weight(u) == test::approx(loss.psi(u) / u).epsilon(1e-13));
    CHECK(loss.rho(-u) == loss.rho(u));
    CHECK(loss.psi(-u) == -loss.psi(u));
    CHECK(loss.rho(2 * u) > loss.rho(u));
    CHECK(loss.weight(2 * u) <= loss.weight(u));
  }
}

}  // namespace

TEST_CASE("robust losses: psi is the slope of rho, weight is psi / u, slope is that of psi") {
  check(rosin::huber_loss<>{}, 1);
  check(rosin::huber_loss<>{2.5}, 1);
  check(rosin::cauchy_loss<>{}, 1);
  check(rosin::cauchy_loss<>{2.3849}, 1);
  check(rosin::geman_mcclure_loss<>{}, 1);
  check(rosin::geman_mcclure_loss<>{3}, 1);
  check(rosin::student_loss<>{}, 5.0 / 4);
  check(rosin::student_loss<>{1}, 2);
}

TEST_CASE("robust losses: far out") {
  const double far = 1e150;
  CHECK(rosin::huber_loss<>{2}.psi(far) == 2);
  CHECK(rosin::huber_loss<>{2}.rho(far) / far == test::approx(2).epsilon(1e-15));
  CHECK(rosin::cauchy_loss<>{2}.psi(far) * far == test::approx(4).epsilon(1e-12));
  CHECK(rosin::cauchy_loss<>{2}.rho(1e8) == test::approx(4 * std::log(1e8 / 2)).epsilon(1e-12));
  CHECK(rosin::geman_mcclure_loss<>{2}.rho(far) == 2);
  CHECK(rosin::geman_mcclure_loss<>{2}.psi(far) == 0);
  CHECK(rosin::student_loss<>{4}.psi(far) * far == test::approx(5).epsilon(1e-12));
  CHECK(rosin::student_loss<>{4}.rho(1e8) == test::approx(5 * std::log(1e8 / 2)).epsilon(1e-12));
}

TEST_CASE("robust losses: Student's with one degree of freedom is twice Cauchy's, and with many it is least squares") {
  for (const double u : residuals) {
    CHECK(rosin::student_loss<>{1}.rho(u) == test::approx(2 * rosin::cauchy_loss<>{}.rho(u)).epsilon(1e-14));
    if (std::abs(u) < 100) CHECK(rosin::student_loss<>{1e9}.rho(u) == test::approx(u * u / 2).epsilon(1e-5));
  }
}

TEST_CASE("robust losses: what Huber's psi^2 is of a normal number, by summing it") {
  for (const double bend : {0.5, 1.5, 4.0}) {
    const rosin::huber_loss<> loss{bend};
    double sum = 0;
    for (double z = -12; z < 12; z += 1e-3) sum += std::pow(loss.psi(z), 2) * std::exp(-z * z / 2) * 1e-3;
    CHECK(loss.usual_square() == test::approx(sum / std::sqrt(2 * 3.14159265358979)).epsilon(1e-6));
  }
}

TEST_CASE("robust losses: in single precision") {
  CHECK(rosin::huber_loss<float>{}.psi(3) == 1.345F);
  CHECK(rosin::geman_mcclure_loss<float>{}.rho(1e19F) == 0.5F);
}
