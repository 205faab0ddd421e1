// tier: hosted
// SPDX-License-Identifier: MIT
//
// Poles and residues of a stiff string with scatterers and yielding ends, in closed form. With q(s) = c k, kappa c = sqrt(q^2 +
// 1/epsilon), all lengths as travel times, the pinned string answers a unit force at x by
//
//     velocity at x':  M(x, x') = s / (Z (1+2K)) [ sin(q a) sin(q b) / (q sin qL)  -  sinh(kc a) sinh(kc b) / (kc sinh kc L) ]
//     force at an end: A(d)     = [ (1+K) sin(q d) / sin(qL) + K sinh(kc d) / sinh(kc L) ] / (1+2K),   d from the other end
//     an end moved at unit speed feels  S = (Z/s) kc q / (q^2+kc^2) epsilon [ kc^3 cot qL - q^3 coth kc L ]  at itself,
//                             and  X = the same with -1/sin qL, -1/sinh kc L at the other end
//
// (specification sheet 1.4; M, A, S are one another's by reciprocity, A from -B y''' + T y'). Scatterers and ends close the loop:
// a small linear system whose determinant vanishes at the poles. Newton from the pinned string's poles, strength raised in steps.
// Loss enters k as in transmission.hpp, so its convention is the hysteretic one; the fit's psi takes up the difference.
//
#pragma once

#include <rosin/diagnose/pluck_scene.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <Eigen/Dense>

namespace rosin {

/// The string of a scene at one complex frequency.
class string_at {
public:
  using complex = std::complex<double>;

  string_at(const pluck_scene& scene, complex s) : s_{s}, length_{0.5 / scene.string.fundamental_Hz} {
    const double epsilon = std::max(scene.string.stiffness_s2(), 1e-30);
    const complex w = s / complex(0, 1);
    q_ = phase_rate(w, complex(epsilon));
    const double f = std::abs(s.imag()) / (2 * std::numbers::pi), real_w = 2 * std::numbers::pi * f;
    q_ -= complex(0, real_w * scene.string.loss.inverse_q(f) / 2 * slowness_ratio(real_w, epsilon));
    K_ = epsilon * q_ * q_;
    kappa_ = std::sqrt(q_ * q_ + 1 / epsilon);
    epsilon_ = epsilon;
    sine_ = std::sin(q_ * length_);
  }

  /// sin(qL) times the velocity at b for a unit force at a (fractions), in units of 1/Z.
  [[nodiscard]] complex mobility(double a, double b) const {
    const double low = std::min(a, b) * length_, high = (1 - std::max(a, b)) * length_, gap = length_ - low - high;
    const complex decay = (std::exp(-kappa_ * gap) - std::exp(-kappa_ * (gap + 2 * low)) - std::exp(-kappa_ * (gap + 2 * high))) / 2.0;
    return s_ / (1.0 + 2.0 * K_) * (std::sin(q_ * low) * std::sin(q_ * high) / q_ - sine_ * decay / kappa_);
  }
  /// sin(qL) times the force on end 0 or 1 for a unit force at a.
  [[nodiscard]] complex end_force(int end, double a) const {
    const double other = (end == 0 ? 1 - a : a) * length_, here = length_ - other;
    return ((1.0 + K_) * std::sin(q_ * other) + K_ * sine_ * std::exp(-kappa_ * here)) / (1.0 + 2.0 * K_);
  }
  /// sin(qL) times the force (in Z) on an end per unit speed of the same end, and of the other end.
  [[nodiscard]] complex own_end() const {
    return -kappa_ * q_ / (q_ * q_ + kappa_ * kappa_) * epsilon_ / s_ * (kappa_ * kappa_ * kappa_ * std::cos(q_ * length_) - q_ * q_ * q_ * sine_);
  }
  [[nodiscard]] complex other_end() const {
    return kappa_ * q_ / (q_ * q_ + kappa_ * kappa_) * epsilon_ / s_ * kappa_ * kappa_ * kappa_;
  }
  [[nodiscard]] complex sine() const { return sine_; }

private:
  complex s_;
  double length_, epsilon_ = 0;
  complex q_, K_, kappa_, sine_;
};

/// Scatterers and yielding ends together.
inline constexpr int most_loops = 8;

/// The closed loop at one frequency: determinant, and the forces on the ends for a unit force at `position`.
struct loop_response {
  std::complex<double> determinant;                     ///< zero at the poles
  std::array<std::complex<double>, 2> times_determinant; ///< end forces times the determinant
};

/// Unknowns: forces of the scatterers on the string, speeds of the yielding ends. `strength` scales all of them.
[[nodiscard]] inline loop_response close_loop(const pluck_scene& scene, double position, std::complex<double> s, double strength = 1) {
  using complex = std::complex<double>;
  const string_at string(scene, s);
  const auto count = static_cast<Eigen::Index>(scene.scatterers.size());
  std::array<int, 2> moving{};
  Eigen::Index ends = 0;
  for (int e = 0; e < 2; ++e)
    if (!scene.ends[static_cast<std::size_t>(e)].rigid()) moving[static_cast<std::size_t>(ends++)] = e;
  const Eigen::Index n = count + ends;
  // A x = drive with A = sin(qL) (...); F_end sin(qL) = end_force + out x.  Scaled so that nothing is divided by sin(qL).
  if (n == 0) return {string.sine(), {string.end_force(0, position), string.end_force(1, position)}};
  using small = Eigen::Matrix<complex, Eigen::Dynamic, Eigen::Dynamic, 0, most_loops, most_loops>;
  using column = Eigen::Matrix<complex, Eigen::Dynamic, 1, 0, most_loops, 1>;
  small A = small::Zero(n, n);
  column drive(n);
  Eigen::Matrix<complex, 2, Eigen::Dynamic, 0, 2, most_loops> out(2, n);
  const auto at = [&](Eigen::Index i) { return scene.scatterers[static_cast<std::size_t>(i)].position; };
  for (Eigen::Index i = 0; i < count; ++i) {  // g_i + Z_i v_i = 0
    const complex Z = strength * scene.scatterers[static_cast<std::size_t>(i)].impedance(s);
    A(i, i) = string.sine();
    for (Eigen::Index j = 0; j < count; ++j) A(i, j) += Z * string.mobility(at(i), at(j));
    for (Eigen::Index m = 0; m < ends; ++m) A(i, count + m) = Z * string.end_force(moving[static_cast<std::size_t>(m)], at(i));
    drive[i] = -Z * string.mobility(at(i), position);
    for (int e = 0; e < 2; ++e) out(e, i) = string.end_force(e, at(i));
  }
  for (Eigen::Index m = 0; m < ends; ++m) {  // u_m - Y F_m = 0; the string's velocity by u_m is by reciprocity its end force
    const int e = moving[static_cast<std::size_t>(m)];
    const complex Y = strength * scene.ends[static_cast<std::size_t>(e)].admittance(s);
    A(count + m, count + m) = string.sine();
    for (Eigen::Index i = 0; i < count; ++i) A(count + m, i) = -Y * string.end_force(e, at(i));
    for (Eigen::Index k = 0; k < ends; ++k)
      A(count + m, count + k) -= Y * (k == m ? string.own_end() : string.other_end());
    drive[count + m] = Y * string.end_force(e, position);
    for (int o = 0; o < 2; ++o) out(o, count + m) = o == e ? string.own_end() : string.other_end();
  }
  const complex det = A.determinant();
  loop_response r{det / std::pow(string.sine(), static_cast<int>(n) - 1), {}};
  const column x = A.partialPivLu().solve(drive);
  for (int e = 0; e < 2; ++e)
    r.times_determinant[static_cast<std::size_t>(e)] =
        r.determinant / string.sine() * (string.end_force(e, position) + (out.row(e) * x)(0));
  return r;
}

}  // namespace rosin
