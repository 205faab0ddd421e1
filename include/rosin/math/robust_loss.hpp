// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Losses that bear outliers (M-estimators): with u = residual / scale, minimise sum rho(u) instead of sum u^2 / 2.
//
//                    rho(u)                            psi = d rho/du          weight = psi/u          beyond
//     Huber          u^2/2, k |u| - k^2/2 above k      u, k sgn u above k      1, k/|u| above k        rho ~ |u|
//     Cauchy         c^2/2 ln(1 + u^2/c^2)             u / (1 + u^2/c^2)       1 / (1 + u^2/c^2)       rho ~ ln |u|
//     Geman-McClure  u^2/2 / (1 + u^2/c^2)             u / (1 + u^2/c^2)^2     1 / (1 + u^2/c^2)^2     rho -> c^2/2
//     Student's t    (n + 1)/2 ln(1 + u^2/n)           (n + 1) u / (n + u^2)   (n + 1) / (n + u^2)     rho ~ ln |u|
//
// psi is the influence of a residual, weight what its square counts for in iteratively reweighted least squares
// (reweighted_regression.hpp), slope = d psi/du what it adds to a Hessian. Huber: Ann. Math. Statist. 35, 73 (1964), convex, the least worst for normal errors that are contaminated. Cauchy (or
// Lorentz): Holland & Welsch, Commun. Statist. A6, 813 (1977). Geman & McClure: Proc. Statist. Comput. Sect. ASA (1985), 12:
// far outliers count the same however far they are. Student's t with n degrees of freedom is -ln of a density, so that the scale can be
// found with the rest: Lange, Little & Taylor, J. Am. Statist. Assoc. 84, 881 (1989). Student's with n = 1 is Cauchy's with twice the size.
//
#pragma once

#include <cmath>
#include <concepts>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

template <class L>
concept RobustLoss = requires(const L& loss, typename L::real u) {
  { loss.rho(u) } -> std::same_as<typename L::real>;
  { loss.psi(u) } -> std::same_as<typename L::real>;
  { loss.weight(u) } -> std::same_as<typename L::real>;
  { loss.slope(u) } -> std::same_as<typename L::real>;
};

/// The default bend has 95 % of the efficiency of least squares where errors are normal.
template <class Real = double>
struct huber_loss {
  using real = Real;
  Real bend = Real(1.345);

  [[nodiscard]] Real rho(Real u) const noexcept {
    const Real a = std::abs(u);
    return a <= bend ? a * a / 2 : bend * (a - bend / 2);
  }
  [[nodiscard]] Real psi(Real u) const noexcept { return std::abs(u) <= bend ? u : std::copysign(bend, u); }
  [[nodiscard]] Real weight(Real u) const noexcept { return std::abs(u) <= bend ? Real(1) : bend / std::abs(u); }
  [[nodiscard]] Real slope(Real u) const noexcept { return std::abs(u) <= bend ? Real(1) : Real(0); }
  /// E psi(z)^2 of a normal z: what "proposal 2" wants of the residuals when it asks for their scale.
  [[nodiscard]] Real usual_square() const noexcept {
    const Real inside = std::erf(bend / Real(1.41421356237309504880L)),
               density = std::exp(-bend * bend / 2) / Real(2.50662827463100050242L);
    return inside - 2 * bend * density + bend * bend * (1 - inside);
  }
};

template <class Real = double>
struct cauchy_loss {
  using real = Real;
  Real width = 1;

  [[nodiscard]] Real rho(Real u) const noexcept { return width * width / 2 * std::log1p(square(u)); }
  [[nodiscard]] Real psi(Real u) const noexcept { return u * weight(u); }
  [[nodiscard]] Real weight(Real u) const noexcept { return 1 / (1 + square(u)); }
  [[nodiscard]] Real slope(Real u) const noexcept { return (1 - square(u)) * weight(u) * weight(u); }

private:
  [[nodiscard]] Real square(Real u) const noexcept { return u / width * (u / width); }
};

template <class Real = double>
struct geman_mcclure_loss {
  using real = Real;
  Real width = 1;

  [[nodiscard]] Real rho(Real u) const noexcept {
    const Real over = width / u;  // so that nothing overflows, and nothing cancels
    return width * width / 2 / (1 + over * over);
  }
  [[nodiscard]] Real psi(Real u) const noexcept { return u * weight(u); }
  [[nodiscard]] Real weight(Real u) const noexcept { return near(u) * near(u); }
  [[nodiscard]] Real slope(Real u) const noexcept { return weight(u) * (4 * near(u) - 3); }

private:
  [[nodiscard]] Real near(Real u) const noexcept { return 1 / (1 + u / width * (u / width)); }
};

/// -ln of the density, but for a constant.
template <class Real = double>
struct student_loss {
  using real = Real;
  Real freedom = 4;

  [[nodiscard]] Real rho(Real u) const noexcept { return (freedom + 1) / 2 * std::log1p(u * u / freedom); }
  [[nodiscard]] Real psi(Real u) const noexcept { return u * weight(u); }
  [[nodiscard]] Real weight(Real u) const noexcept { return (freedom + 1) / (freedom + u * u); }
  [[nodiscard]] Real slope(Real u) const noexcept { return weight(u) * (freedom - u * u) / (freedom + u * u); }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
