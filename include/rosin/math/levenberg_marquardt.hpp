// tier: hosted
// SPDX-License-Identifier: MIT
//
// Levenberg-Marquardt: from a start on to the least of cost(x) = |r(x)|^2, by the normal equations of its linearisation,
//
//     (H + damping D) step = g,     H = J'J,     g = -J'r,     J = dr/dx
//
// with a step that does not lower the cost taken back and damped more (Levenberg, Q. Appl. Math. 2, 164, 1944; Marquardt, J. SIAM 11,
// 431, 1963). D is H's diagonal as a rule: the path is then the same whatever the units of x. The equations are solved scaled by
// it, to a unit diagonal. With no damping at first and none as long as steps help (`first`, `floor` 0) this is Gauss-Newton.
//
// A problem gives normal equations: it may add them up over records that no memory holds as a Jacobian, add what is known
// beforehand to H, g and cost, or weigh residuals by a robust loss (robust_loss.hpp); and it may bend or refuse steps. That is
// why this is not somebody else's: Ceres' TinySolver and Eigen's unsupported module (MINPACK) want residuals and Jacobian in
// memory, and the latter always allocates. Steps tried, and correct digits of the worst parameter (NIST StRD, second start but for the
// first Misra1a; tolerances at rounding, 1e-12 of the cost here):
//
//                        Misra1a, 1   Misra1a   BoxBOD   MGH10      MGH17    Rosenbrock
//     this               70, 11.1     6, 9.6    11, 7.2  867, 10.8  48, 7.0  44, exact
//     TinySolver         35, 11.1     12, 8.7   23, 9.2  150, 8.4   14, 9.2  37, 14.8
//     Eigen (MINPACK)    29, 9.8      15, 10.2  15, 8.5  135, 9.0   31, 8.1  21, exact
//
// So they are quicker along curved valleys far from the solution (this one, of plain factors, found neither MGH10 nor MGH17 from
// the first start, nor did any but `identity` BoxBOD). rosin's fits begin near, in a model of the string that is all but linear there.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <limits>
#include <type_traits>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Of a least-squares problem at a point. `gradient` points downhill: it is minus half the gradient of the cost.
template <class Real = double, int Size = Eigen::Dynamic>
struct normal_equations {
  Eigen::Matrix<Real, Size, Size> hessian;
  Eigen::Vector<Real, Size> gradient;
  Real cost = 0;

  /// Of nothing: to be added to.
  [[nodiscard]] static normal_equations zero(Eigen::Index size = Size) {
    return {Eigen::Matrix<Real, Size, Size>::Zero(size, size), Eigen::Vector<Real, Size>::Zero(size), 0};
  }
  /// One complex residual, data less model, and the model's derivatives. Of the Hessian only the lower triangle: mirror() it in the end.
  template <class Row>
  void add(const Row& row, std::complex<Real> residual) {
    for (Eigen::Index a = 0; a < gradient.size(); ++a) {
      gradient[a] += row[a].real() * residual.real() + row[a].imag() * residual.imag();
      for (Eigen::Index b = 0; b <= a; ++b) hessian(a, b) += row[a].real() * row[b].real() + row[a].imag() * row[b].imag();
    }
    cost += std::norm(residual);
  }
  void mirror() { hessian.template triangularView<Eigen::StrictlyUpper>() = hessian.transpose(); }
};

/// linearise(x) gives what a normal_equations has. What a problem may have besides:
///   moved(x, step)   where the step leads; else x + step
///   plausible(x)     whether a point may be looked at
///   cost(x)          alone, where it costs much less than linearise(x): asked of every point tried
/// A point may be anything that can be copied, and carry what was worked out for it.
template <class Problem, class Point>
concept LeastSquares = std::copyable<Point> && requires(const Problem& problem, const Point& x) {
  {problem.linearise(x).hessian.ldlt().solve(problem.linearise(x).gradient)};
  { problem.linearise(x).cost + 0 } -> std::floating_point;
};

/// What the damping is in units of: the Hessian's diagonal, the largest that has been there (More 1978: no parameter gets far
/// where the data do not tell of it), or 1 (Levenberg).
enum class damping_scale { diagonal, largest_diagonal, identity };

template <class Real = double>
struct descent_options {
  Real first = Real(1e-3);           ///< damping to begin with
  Real less = Real(0.1), more = 10;  ///< factors after a step that was taken, or not
  Real floor = Real(1e-12);          ///< the damping stays above
  Real restart = 0;                  ///< and above that after a step that was not taken
  Real ceiling = Real(1e8);          ///< no step is to be had beyond
  damping_scale scale = damping_scale::diagonal;
  int iterations = 50;                               ///< steps tried, at most
  int rejections = std::numeric_limits<int>::max();  ///< in a row, at most
  Real enough = 0, enough_relative = Real(1e-12);    ///< a gain in cost of no more is the last; the second is times the cost
  Real negligible = 0;                               ///< a step that promises no more gain is not tried any more
};

/// Why a descent ended: the last step gained little; none promises any gain; or the limits of its options.
enum class descent_end { little_gained, nothing_to_gain, iterations, rejections, ceiling, not_finite };

/// Where a descent ended. The equations are those of `at`; of a problem with cost() those that the last step began with.
template <class Point, class Equations, class Real = double>
struct descent {
  Point at;
  Equations equations;
  Real cost = 0, damping = 0;
  int iterations = 0;
  descent_end reason = descent_end::iterations;

  [[nodiscard]] bool converged() const noexcept {
    return reason == descent_end::little_gained || reason == descent_end::nothing_to_gain;
  }
};

namespace detail {

/// (H + damping D) step = g, scaled by D to begin with.
template <class Matrix, class Vector>
[[nodiscard]] Vector damped_step(const Matrix& hessian, const Vector& gradient, const Vector& d,
                                 typename Vector::Scalar damping) {
  const Vector scale = d.cwiseMax(std::numeric_limits<typename Vector::Scalar>::min()).cwiseSqrt().cwiseInverse();
  Matrix scaled = scale.asDiagonal() * hessian * scale.asDiagonal();
  scaled.diagonal().array() += damping;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * gradient);
}

template <class Problem, class Point>
using equations_of = std::remove_cvref_t<decltype(std::declval<const Problem&>().linearise(std::declval<const Point&>()))>;
template <class Problem, class Point>
using real_of = std::remove_cvref_t<decltype(equations_of<Problem, Point>::cost)>;

}  // namespace detail

/// Allocates nothing where the size of the equations is fixed (and the problem does not).
template <class Problem, class Point>
requires LeastSquares<Problem, Point>
[[nodiscard]] descent<Point, detail::equations_of<Problem, Point>, detail::real_of<Problem, Point>> levenberg_marquardt(
    const Problem& problem, Point start, const descent_options<detail::real_of<Problem, Point>>& options = {}) {
  using Equations = detail::equations_of<Problem, Point>;
  using Real = detail::real_of<Problem, Point>;
  using Vector = decltype(Equations::gradient);
  constexpr bool cost_alone = requires { problem.cost(start); };

  Equations first = problem.linearise(start);
  const Real first_cost = first.cost;
  descent<Point, Equations, Real> now{std::move(start), std::move(first), first_cost, options.first};
  const auto ended = [&](descent_end reason) { return now.reason = reason, std::move(now); };
  if (!std::isfinite(now.cost)) return ended(descent_end::not_finite);

  bool stale = false;  // the equations, of the point before
  const auto is_better = [&](Real cost) { return std::isfinite(cost) && cost <= now.cost; };
  const auto moved = [&](const Vector& step) -> Point {
    if constexpr (requires { problem.moved(now.at, step); }) return problem.moved(now.at, step);
    else return now.at + step;
  };
  const auto is_plausible = [&](const Point& tried) {
    if constexpr (requires { problem.plausible(tried); }) return problem.plausible(tried);
    else return true;
  };
  const auto take = [&](Point&& tried) {
    Real cost = 0;
    if constexpr (cost_alone) {
      if (cost = problem.cost(tried); !is_better(cost)) return false;
      stale = true;
    } else {
      Equations there = problem.linearise(tried);
      if (cost = there.cost; !is_better(cost)) return false;
      now.equations = std::move(there);
    }
    now.at = std::move(tried), now.cost = cost;
    return true;
  };

  Vector d = Vector::Constant(now.equations.gradient.size(), options.scale == damping_scale::identity ? Real(1) : Real(0));
  for (int rejected = 0; now.iterations < options.iterations;) {
    if constexpr (cost_alone)
      if (std::exchange(stale, false)) now.equations = problem.linearise(now.at);
    if (options.scale == damping_scale::diagonal) d = now.equations.hessian.diagonal();
    else if (options.scale == damping_scale::largest_diagonal) d = d.cwiseMax(now.equations.hessian.diagonal());
    const Vector step = detail::damped_step(now.equations.hessian, now.equations.gradient, d, now.damping);
    const Real promised = step.dot(now.equations.gradient);  // half of it at least, were the problem linear
    if (promised >= 0 && promised <= options.negligible) return ended(descent_end::nothing_to_gain);
    ++now.iterations;
    const Real before = now.cost, enough = options.enough + options.enough_relative * std::abs(before);
    bool plausible = step.allFinite(), taken = false;
    if (plausible) {
      Point tried = moved(step);
      plausible = is_plausible(tried);
      taken = plausible && take(std::move(tried));
    }
    if (taken) {
      now.damping = std::max(options.floor, now.damping * options.less), rejected = 0;
      if (before - now.cost <= enough) return ended(descent_end::little_gained);
    } else {
      if (plausible && promised <= enough) return ended(descent_end::nothing_to_gain);
      now.damping = std::max(options.restart, now.damping * options.more);
      if (now.damping > options.ceiling) return ended(descent_end::ceiling);
      if (++rejected >= options.rejections) return ended(descent_end::rejections);
    }
  }
  return ended(descent_end::iterations);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
