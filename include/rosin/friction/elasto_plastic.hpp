// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Friction by bristles that bend before they give way (Dupont et al.; LuGre with a purely elastic beginning). With v the
// speed of the rod relative to the string and z the bristles' deflection,
//
//     f = s0 z + s1(v) z' + s2 v,     z' = v (1 - alpha(z, v) z / z_ss(v)),     z_ss = sgn(v) mu(|v|) N / s0,
//
// alpha = 0 up to the breakaway deflection, 1 beyond z_ss, half a sine in between; with s1(v) = f_C / sqrt(v^2 + (f_C / s1)^2)
// the law is passive. s0 is proportional to the normal force. The trapezoidal rule z = z0 + h (z' + z0') / 2 and the load
// line leave one equation in v, since f(v) follows from the line, z' from f and z from z'. It goes from + to - as v
// grows; the root is bracketed outwards from the last one (the contact moves on continuously) and found by
// bisection with secant steps.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/friction_law.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

template <class T = double>
struct elasto_plastic_parameters {
  T stiffness_1_m = T(1e6);    ///< s0 / N
  T damping_Ns_m = T(0.0027);  ///< s1
  T viscous_Ns_m = 0;          ///< s2
  T kinetic = T(0.35);         ///< f_C / N: least value of the steady curve
  T breakaway = T(0.7);        ///< elastic up to this share of f_C / s0, below 1
};

template <FrictionCurve Curve>
class elasto_plastic {
public:
  using scalar = typename Curve::scalar;
  using T = scalar;

  explicit elasto_plastic(Curve steady = {}, elasto_plastic_parameters<T> parameters = {}) noexcept
      : steady_{steady}, given_{parameters} {}

  contact_force<T> operator()(const load_line<T>& line) noexcept {
    if (!(line.normal_force_N > 0)) {
      reset();
      return {.slipping = true};
    }
    bool converged = false;
    const trial found = solve(line, converged);
    z_ = found.z;
    rate_ = found.rate;
    v_ = found.v;
    const T flow = plastic_share(found.z, found.v);
    return {.force_N = found.force, .slipping = flow > T(0.5), .converged = converged};
  }

  void reset() noexcept { z_ = rate_ = v_ = 0; }
  /// Deflection of the bristles, m.
  [[nodiscard]] T deflection_m() const noexcept { return z_; }
  /// Energy that the bristles hold, J.
  [[nodiscard]] T stored_J(T normal_N) const noexcept { return given_.stiffness_1_m * normal_N * z_ * z_ / 2; }

private:
  struct trial {
    T v, force, rate, z, error;
  };

  /// alpha z / z_ss: which part of the motion is flow; 0 elastic, 1 steady sliding.
  [[nodiscard]] T plastic_share(T z, T v) const noexcept {
    using std::abs;
    using std::sin;
    if (!(z * v > 0)) return 0;
    const T size = abs(z), steady = steady_(abs(v)).value / given_.stiffness_1_m;
    const T free = given_.breakaway * given_.kinetic / given_.stiffness_1_m;
    if (size <= free) return 0;
    if (size >= steady) return size / steady;
    const T alpha = (1 + sin(T(3.14159265358979323846) * (size - (steady + free) / 2) / (steady - free))) / 2;
    return alpha * size / steady;
  }

  [[nodiscard]] trial at(const load_line<T>& line, T v) const noexcept {
    using std::sqrt;
    const T h = line.step_s / 2, s0 = given_.stiffness_1_m * line.normal_force_N;
    const T coulomb = given_.kinetic * line.normal_force_N, width = coulomb / std::max(given_.damping_Ns_m, T(1e-12));
    const T s1 = coulomb / sqrt(v * v + width * width);
    const T force = line.sticking_force() - v / line.mobility_m_Ns;
    const T start = z_ + h * rate_;
    const T rate = (force - s0 * start - given_.viscous_Ns_m * v) / (s0 * h + s1);
    const T z = start + h * rate;
    return {v, force, rate, z, rate - v * (1 - plastic_share(z, v))};
  }

  /// A root between two trials of opposite sign (low.error >= 0 >= high.error); the better end if rounding stops it.
  [[nodiscard]] trial refine(const load_line<T>& line, trial low, trial high, bool& converged) const noexcept {
    using std::abs;
    const T small = 16 * std::numeric_limits<T>::epsilon();
    for (int i = 0; i < 4 * std::numeric_limits<T>::digits; ++i) {
      const T width = high.v - low.v, middle = low.v + width / 2;
      T next = i % 3 == 2 ? middle : low.v + width * low.error / (low.error - high.error);
      if (!(next > low.v && next < high.v)) next = middle;
      const trial t = at(line, next);
      (t.error > 0 ? low : high) = t;
      const T scale = abs(t.v) + abs(line.rod_velocity_m_s) + abs(line.free_velocity_m_s) + T(1e-3);
      converged = abs(t.error) <= small * scale || high.v - low.v <= small * scale;
      if (converged) break;
    }
    return abs(low.error) < abs(high.error) ? low : high;
  }

  [[nodiscard]] trial solve(const load_line<T>& line, bool& converged) const noexcept {
    using std::abs;
    T reach = std::numeric_limits<T>::epsilon() + T(1e-3) * (abs(v_) + abs(line.rod_velocity_m_s));
    trial last = at(line, v_);
    const T way = last.error > 0 ? T(1) : T(-1);
    for (int i = 0; i < 64; ++i, reach *= 2) {
      const trial next = at(line, last.v + way * reach);
      if (!(next.error * way > 0)) return way > 0 ? refine(line, last, next, converged) : refine(line, next, last, converged);
      last = next;
    }
    return last;
  }

  Curve steady_;
  elasto_plastic_parameters<T> given_;
  T z_ = 0, rate_ = 0, v_ = 0;
};

static_assert(FrictionLaw<elasto_plastic<stribeck_curve<>>>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
