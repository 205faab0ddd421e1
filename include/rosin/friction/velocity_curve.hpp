// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Friction as a function of the slip speed alone, with the rule of Friedlander and of McIntyre and Woodhouse for
// the case that load line and curve meet more than once: the contact stays on its branch until the branch is gone.
// With D = |v_rod - v_free| and u = |v_r| a slip solves
//
//     F(u) = u - D + y N mu(u) = 0.
//
// sticking:  stays so while |f_stick| <= mu(0) N;
// slipping:  takes the largest root; where there is none, the string is captured. The middle root is never used.
//
// F is convex where mu is. Newton's method from u = D, where F > 0, then comes down to the largest root without ever
// overshooting it, and proves that there is none by meeting a slope <= 0.
//
#pragma once

#include <cmath>
#include <limits>

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/friction_law.hpp>

namespace rosin {

/// The largest root of u - distance + weight mu(u) in [0, distance].
template <class T>
struct slip_root {
  T speed{};
  bool exists = false;
  bool converged = true;
};

namespace detail {

/// The root below the point of inflection, where F is concave and F(0) < 0 <= F(top): halving.
template <FrictionCurve Curve, class T>
[[nodiscard]] slip_root<T> bisect_slip(const Curve& curve, T distance, T weight, T top) noexcept {
  T low = 0, high = top;
  for (int i = 0; i < std::numeric_limits<T>::digits + 2; ++i) {
    const T middle = (low + high) / 2;
    (middle - distance + weight * curve(middle).value < 0 ? low : high) = middle;
  }
  return {high, true, true};
}

}  // namespace detail

template <FrictionCurve Curve, class T = typename Curve::scalar>
[[nodiscard]] slip_root<T> largest_slip(const Curve& curve, T distance, T weight) noexcept {
  using std::abs;
  const T tolerance = 8 * std::numeric_limits<T>::epsilon() * distance;
  T u = distance;
  for (int i = 0; i < 64; ++i) {
    const auto mu = curve(u);
    const T excess = u - distance + weight * mu.value, slope = 1 + weight * mu.slope;
    const T next = slope > 0 ? u - excess / slope : -distance;
    if (next < curve.convex_from()) {
      const bool crosses = curve.convex_from() > 0 && weight * curve(T(0)).value < distance;
      return crosses ? detail::bisect_slip(curve, distance, weight, u) : slip_root<T>{};
    }
    if (abs(next - u) <= tolerance || abs(excess) <= tolerance / 2) return {u, true, true};
    u = next;
  }
  return {u, true, false};
}

/// One step of the rule in the header for a curve; `slipping` is the branch it is on, before and after.
template <FrictionCurve Curve, class T = typename Curve::scalar>
[[nodiscard]] contact_force<T> stay_on_branch(const Curve& curve, const load_line<T>& line, bool& slipping) noexcept {
  using std::abs;
  const T normal = line.normal_force_N, sticking = line.sticking_force();
  if (!(normal > 0)) {
    slipping = true;
    return {.slipping = true};
  }
  if (!slipping && abs(sticking) <= curve(T(0)).value * normal) return {.force_N = sticking};
  const auto root = largest_slip(curve, line.mobility_m_Ns * abs(sticking), line.mobility_m_Ns * normal);
  slipping = root.exists;
  if (!slipping) return {.force_N = sticking, .converged = root.converged};
  const T size = normal * curve(root.speed).value;
  return {.force_N = sticking < 0 ? -size : size, .slipping = true, .converged = root.converged};
}

/// The law for any curve.
template <FrictionCurve Curve>
class velocity_curve {
public:
  using scalar = typename Curve::scalar;

  constexpr explicit velocity_curve(Curve curve = {}) noexcept : curve_{curve} {}

  contact_force<scalar> operator()(const load_line<scalar>& line) noexcept { return stay_on_branch(curve_, line, slipping_); }

  void reset() noexcept { slipping_ = false; }
  [[nodiscard]] bool slipping() const noexcept { return slipping_; }
  [[nodiscard]] const Curve& curve() const noexcept { return curve_; }

private:
  Curve curve_;
  bool slipping_ = false;
};

static_assert(FrictionLaw<velocity_curve<two_exponential_curve<>>>);

}  // namespace rosin
