// tier: freestanding
// SPDX-License-Identifier: MIT
//
// A velocity curve under which the string never sticks altogether: in place of sticking it creeps,
//
//     v_r = -sgn(f) v0 exp((|f| / N - mu(0)) / a),
//
// v0 the creep at the limit of friction, a how sharply it grows with force. Sticking force and creep meet in
//
//     v0 e^x + y N (a x + mu(0)) = D,      |v_r| = v0 e^x,   D = |v_rod - v_free|,
//
// whose left side rises and is convex in x: Newton's method from an x above the root comes down to it. Once more
// than mu(0) N would be needed, the contact slips, with the branch rule of velocity_curve.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <rosin/friction/velocity_curve.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

template <class T = double>
struct creep_parameters {
  T limit_speed_m_s = T(5e-3);  ///< v0
  T sharpness = T(0.05);        ///< a, in units of mu
};

template <FrictionCurve Curve>
class creep {
public:
  using scalar = typename Curve::scalar;
  using T = scalar;

  explicit creep(Curve curve = {}, creep_parameters<T> parameters = {}) noexcept : curve_{curve}, given_{parameters} {}

  contact_force<T> operator()(const load_line<T>& line) noexcept {
    auto answer = stay_on_branch(curve_, line, slipping_);
    if (slipping_) return answer;
    const auto [speed, converged] = creep_speed(line);
    const T size = (line.mobility_m_Ns * std::abs(line.sticking_force()) - speed) / line.mobility_m_Ns;
    answer.force_N = std::copysign(size, line.sticking_force());
    answer.converged = answer.converged && converged;
    return answer;
  }

  void reset() noexcept { slipping_ = false; }

private:
  struct solution {
    T speed;
    bool converged;
  };

  /// Newton's method in x = ln(u / v0): v0 e^x + y N a x + y N mu(0) - D = 0, convex and rising in x.
  [[nodiscard]] solution creep_speed(const load_line<T>& line) const noexcept {
    using std::abs;
    using std::exp;
    using std::log;
    const T weight = line.mobility_m_Ns * line.normal_force_N, distance = line.mobility_m_Ns * abs(line.sticking_force());
    const T steady = weight * curve_(T(0)).value, lean = weight * given_.sharpness;
    T x = std::min((distance - steady) / lean, log(distance / given_.limit_speed_m_s + 1));  // above the root either way
    for (int i = 0; i < 100; ++i) {
      const T speed = given_.limit_speed_m_s * exp(x), excess = speed + lean * x + steady - distance;
      const T step = excess / (speed + lean);
      x -= step;
      if (abs(step) <= 8 * std::numeric_limits<T>::epsilon() * (1 + abs(x) + distance / lean))
        return {std::min(given_.limit_speed_m_s * exp(x), distance), true};
    }
    return {std::min(given_.limit_speed_m_s * exp(x), distance), false};
  }

  Curve curve_;
  creep_parameters<T> given_;
  bool slipping_ = false;
};

static_assert(FrictionLaw<creep<two_exponential_curve<>>>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
