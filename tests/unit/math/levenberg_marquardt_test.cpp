// SPDX-License-Identifier: MIT
#include <rosin/math/levenberg_marquardt.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "support/approx.hpp"

namespace {

/// Residuals of a curve y = f(x; b), record by record.
template <int Size, class Curve>
struct curve_problem {
  std::vector<std::array<double, 2>> data;  ///< y, x
  Curve curve;                              ///< value, and the derivatives by b

  [[nodiscard]] rosin::normal_equations<double, Size> linearise(const Eigen::Vector<double, Size>& b) const {
    auto equations = rosin::normal_equations<double, Size>::zero();
    for (const auto& [y, x] : data) {
      Eigen::Vector<double, Size> slope;
      const double r = y - curve(x, b, slope);
      equations.hessian += slope * slope.transpose(), equations.gradient += r * slope, equations.cost += r * r;
    }
    return equations;
  }
};

/// b1 (1 - exp(-b2 x)).
const auto saturation = [](double x, const Eigen::Vector2d& b, Eigen::Vector2d& slope) {
  const double e = std::exp(-b[1] * x);
  slope = {1 - e, b[0] * x * e};
  return b[0] * (1 - e);
};
/// NIST StRD, Misra1a and BoxBOD: https://www.itl.nist.gov/div898/strd/nls/nls_main.shtml
const curve_problem<2, decltype(saturation)> misra1a{{{10.07, 77.6},
                                                      {14.73, 114.9},
                                                      {17.94, 141.1},
                                                      {23.93, 190.8},
                                                      {29.61, 239.9},
                                                      {35.18, 289.0},
                                                      {40.02, 332.8},
                                                      {44.82, 378.4},
                                                      {50.76, 434.8},
                                                      {55.05, 477.3},
                                                      {61.01, 536.8},
                                                      {66.40, 593.1},
                                                      {75.47, 689.1},
                                                      {81.78, 760.0}},
                                                     saturation};
const curve_problem<2, decltype(saturation)> box_bod{{{109, 1}, {149, 2}, {149, 3}, {191, 5}, {213, 7}, {224, 10}}, saturation};

/// b1 exp(b2 / (x + b3)), NIST StRD, MGH10.
const auto meyer = [](double x, const Eigen::Vector3d& b, Eigen::Vector3d& slope) {
  const double e = std::exp(b[1] / (x + b[2]));
  slope = {e, b[0] * e / (x + b[2]), -b[0] * e * b[1] / std::pow(x + b[2], 2)};
  return b[0] * e;
};
const curve_problem<3, decltype(meyer)> mgh10{{{34780, 50},
                                               {28610, 55},
                                               {23650, 60},
                                               {19630, 65},
                                               {16370, 70},
                                               {13720, 75},
                                               {11540, 80},
                                               {9744, 85},
                                               {8261, 90},
                                               {7030, 95},
                                               {6005, 100},
                                               {5147, 105},
                                               {4427, 110},
                                               {3820, 115},
                                               {3307, 120},
                                               {2872, 125}},
                                              meyer};

template <class Real>
struct rosenbrock {
  [[nodiscard]] rosin::normal_equations<Real, 2> linearise(const Eigen::Vector<Real, 2>& x) const {
    const Eigen::Vector<Real, 2> r{10 * (x[1] - x[0] * x[0]), 1 - x[0]};
    Eigen::Matrix<Real, 2, 2> j;
    j << -20 * x[0], 10, -1, 0;
    return {j.transpose() * j, -j.transpose() * r, r.squaredNorm()};
  }
};

/// (x - 3)^2, one number; counts what it is asked.
struct parabola {
  mutable int linearised = 0, looked_at = 0;
  double least = -1e9, wrong_by = 1;

  [[nodiscard]] rosin::normal_equations<double, 1> linearise(const Eigen::Vector<double, 1>& x) const {
    ++linearised;
    return {Eigen::Matrix<double, 1, 1>(1), wrong_by * (Eigen::Vector<double, 1>(3) - x), (x[0] - 3) * (x[0] - 3)};
  }
  [[nodiscard]] bool plausible(const Eigen::Vector<double, 1>& x) const {
    ++looked_at;
    return x[0] > least;
  }
};

/// The same on a circle: a point is an angle, and carries its cost.
struct on_a_circle {
  struct point {
    double angle, cost;
  };
  mutable int linearised = 0;

  [[nodiscard]] static point at(double angle) { return {angle, 4 * std::pow(std::sin(angle / 2), 2)}; }  // chord to (1, 0)
  [[nodiscard]] double cost(const point& p) const { return p.cost; }
  [[nodiscard]] rosin::normal_equations<> linearise(const point& p) const {
    ++linearised;
    rosin::normal_equations<> equations = rosin::normal_equations<>::zero(1);
    equations.hessian(0, 0) = std::pow(std::cos(p.angle / 2), 2);  // of r = 2 sin(angle / 2)
    equations.gradient[0] = -std::sin(p.angle);
    equations.cost = p.cost;
    return equations;
  }
  [[nodiscard]] point moved(const point& p, const Eigen::VectorXd& by) const { return at(p.angle + by[0]); }
};

}  // namespace

TEST_CASE("levenberg_marquardt: certified values of NIST's nonlinear regressions") {
  for (const Eigen::Vector2d& start : {Eigen::Vector2d(500, 1e-4), Eigen::Vector2d(250, 5e-4)}) {
    const auto found = rosin::levenberg_marquardt(misra1a, start, {.iterations = 200});
    CHECK(found.converged());
    CHECK(found.at[0] == test::approx(2.3894212918e+02).epsilon(1e-8));
    CHECK(found.at[1] == test::approx(5.5015643181e-04).epsilon(1e-8));
    CHECK(found.cost == test::approx(1.2455138894e-01).epsilon(1e-10));
    const Eigen::Matrix2d covariance = found.cost / 12 * found.equations.hessian.inverse();
    CHECK(std::sqrt(covariance(0, 0)) == test::approx(2.7070075241).epsilon(1e-7));
    CHECK(std::sqrt(covariance(1, 1)) == test::approx(7.2668688436e-06).epsilon(1e-7));
  }
  const auto boxed = rosin::levenberg_marquardt(box_bod, Eigen::Vector2d(100, 0.75));
  CHECK(boxed.converged());
  CHECK(boxed.at[0] == test::approx(2.1380940889e+02).epsilon(1e-6));
  CHECK(boxed.at[1] == test::approx(5.4723748542e-01).epsilon(1e-6));
  CHECK(boxed.cost == test::approx(1.1680088766e+03).epsilon(1e-10));
  const auto curved = rosin::levenberg_marquardt(mgh10, Eigen::Vector3d(0.02, 4000, 250), {.iterations = 2000});
  CHECK(curved.converged());
  CHECK(curved.at[0] == test::approx(5.6096364710e-03).epsilon(1e-8));
  CHECK(curved.at[1] == test::approx(6.1813463463e+03).epsilon(1e-8));
  CHECK(curved.at[2] == test::approx(3.4522363462e+02).epsilon(1e-8));
  CHECK(curved.cost == test::approx(8.7945855171e+01).epsilon(1e-10));
}

TEST_CASE("levenberg_marquardt: Rosenbrock's valley, in either precision and however the damping is scaled") {
  for (const auto scale :
       {rosin::damping_scale::diagonal, rosin::damping_scale::largest_diagonal, rosin::damping_scale::identity}) {
    const auto found =
        rosin::levenberg_marquardt(rosenbrock<double>{}, Eigen::Vector2d(-1.2, 1), {.scale = scale, .iterations = 100});
    CHECK(found.converged());
    CHECK((found.at - Eigen::Vector2d(1, 1)).norm() < 1e-12);
  }
  const auto single = rosin::levenberg_marquardt(rosenbrock<float>{}, Eigen::Vector2f(-1.2F, 1), {.iterations = 100});
  CHECK((single.at - Eigen::Vector2f(1, 1)).norm() < 1e-5F);
}

TEST_CASE("levenberg_marquardt: the units of parameters do not matter where the Hessian's diagonal scales the damping") {
  struct in_units {
    Eigen::Vector2d unit;
    [[nodiscard]] rosin::normal_equations<double, 2> linearise(const Eigen::Vector2d& x) const {
      auto equations = misra1a.linearise(x.cwiseProduct(unit));
      equations.hessian = (unit.asDiagonal() * equations.hessian * unit.asDiagonal()).eval();
      equations.gradient = unit.cwiseProduct(equations.gradient).eval();
      return equations;
    }
  };
  const Eigen::Vector2d unit(1024, 1.0 / 4096), start(250, 5e-4);  // powers of two: the same to the last bit
  const auto found = rosin::levenberg_marquardt(misra1a, start),
             scaled = rosin::levenberg_marquardt(in_units{unit}, Eigen::Vector2d(start.cwiseQuotient(unit)));
  CHECK(found.iterations == scaled.iterations);
  CHECK((scaled.at.cwiseProduct(unit) - found.at).cwiseQuotient(found.at).norm() < 1e-12);
}

TEST_CASE("levenberg_marquardt: without damping a linear problem takes one step, and a good place none") {
  const parabola p;
  const auto found = rosin::levenberg_marquardt(p, Eigen::Vector<double, 1>(40), {.first = 0, .floor = 0});
  CHECK(found.iterations == 1);
  CHECK(found.at[0] == 3);
  CHECK(found.reason == rosin::descent_end::nothing_to_gain);
  CHECK(p.linearised == 2);
  const auto near = rosin::levenberg_marquardt(p, Eigen::Vector<double, 1>(3.01), {.first = 0, .negligible = 1e-3});
  CHECK(near.iterations == 0);
  CHECK(near.at[0] == 3.01);
  CHECK(near.converged());
}

TEST_CASE("levenberg_marquardt: a step that leads nowhere plausible is not looked at, but damped") {
  const parabola p{.least = 5};
  const auto found = rosin::levenberg_marquardt(p, Eigen::Vector<double, 1>(40), {.iterations = 400, .enough_relative = 0});
  CHECK(found.at[0] > 5);
  CHECK(found.at[0] < 5.1);
  CHECK(p.linearised < p.looked_at);  // of those that are not plausible, nothing but that
  CHECK_FALSE(found.converged());
}

TEST_CASE("levenberg_marquardt: says why it ended") {
  const Eigen::Vector<double, 1> start(40);
  const parabola uphill{.wrong_by = -1};
  CHECK(rosin::levenberg_marquardt(uphill, start).reason == rosin::descent_end::ceiling);
  CHECK(rosin::levenberg_marquardt(uphill, start).at == start);
  const auto few = rosin::levenberg_marquardt(uphill, start, {.rejections = 3});
  CHECK(few.reason == rosin::descent_end::rejections);
  CHECK(few.iterations == 3);
  CHECK(few.damping == test::approx(1e-3 * 1e3).epsilon(1e-12));
  CHECK(rosin::levenberg_marquardt(parabola{}, start, {.iterations = 1}).reason == rosin::descent_end::iterations);
  CHECK(rosin::levenberg_marquardt(parabola{}, start, {.enough_relative = 1}).reason == rosin::descent_end::little_gained);
  const Eigen::Vector<double, 1> unknown(std::numeric_limits<double>::quiet_NaN());
  CHECK(rosin::levenberg_marquardt(parabola{}, unknown).reason == rosin::descent_end::not_finite);
}

TEST_CASE("levenberg_marquardt: points of any kind, and a cost that is asked alone") {
  const on_a_circle problem;
  const auto found = rosin::levenberg_marquardt(problem, on_a_circle::at(2.5));
  CHECK(found.converged());
  CHECK(std::abs(found.at.angle) < 1e-6);
  CHECK(problem.linearised <= found.iterations + 1);
}

TEST_CASE("levenberg_marquardt: a parameter that the data do not tell of stays") {
  struct flat {
    [[nodiscard]] rosin::normal_equations<> linearise(const Eigen::VectorXd& x) const {
      auto equations = rosin::normal_equations<>::zero(2);
      equations.hessian(0, 0) = 1, equations.gradient[0] = 3 - x[0], equations.cost = std::pow(x[0] - 3, 2);
      return equations;
    }
  };
  const auto found = rosin::levenberg_marquardt(flat{}, Eigen::VectorXd(Eigen::Vector2d(40, 7)));
  CHECK(found.at[0] == test::approx(3).epsilon(1e-6));
  CHECK(found.at[1] == 7);
}

TEST_CASE("normal_equations: complex residuals, one by one, as real and imaginary parts") {
  Eigen::MatrixXcd rows = Eigen::MatrixXcd::Random(5, 3);
  const Eigen::VectorXcd residual = Eigen::VectorXcd::Random(5);
  auto one_by_one = rosin::normal_equations<>::zero(3);
  for (Eigen::Index i = 0; i < 5; ++i) one_by_one.add(Eigen::VectorXcd(rows.row(i).transpose()), residual[i]);
  one_by_one.mirror();
  CHECK((one_by_one.hessian - (rows.adjoint() * rows).real()).norm() < 1e-14);
  CHECK((one_by_one.gradient - (rows.adjoint() * residual).real()).norm() < 1e-14);
  CHECK(one_by_one.cost == test::approx(residual.squaredNorm()).epsilon(1e-14));
}
