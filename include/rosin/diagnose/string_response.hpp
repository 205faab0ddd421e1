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
// (M, A, S are one another's by reciprocity, A from -B y''' + T y'). An end that resists turning gives the string a moment; a
// unit moment (over c) does what two opposite forces close to the end do, so that all of its answers are slopes of M and A there:
//
//     velocity at d from the end:  s / (Z (1+2K)) [ sin q(L-d) / sin qL  -  sinh kc (L-d) / sinh kc L ]
//     the end's own turning:       s / (Z (1+2K)) [ kc coth kc L  -  q cot qL ],       the other end's: s / (Z (1+2K)) [ q / sin qL - kc / sinh kc L ]
//     force on the same end:       -[ (1+K) q cot qL + K kc coth kc L ] / (1+2K),   on the other: [ (1+K) q / sin qL + K kc / sinh kc L ] / (1+2K)
//
// Scatterers and ends close the loop:
// a small linear system whose determinant vanishes at the poles. Newton from the pinned string's poles, strength raised in steps.
// Loss enters k as in transmission.hpp. What it makes of the impedance is a matter of convention, and a heavy bead tells: with
// every mode damped by itself, i w w_m / Q, the loss sits half in the tension and half in the mass, T (1 + i / 2Q), but for
//     sum_m phi_m^2 i w (i / 2Q) (w_m - w)^2 / (w_m^2 - w^2)^2  =  -1 / (2 pi Q Z)   at the load itself (twice that, times Z^2, at an end),
// and what the ends feel of the damping, which the fit's psi takes up. Where the modes that are damped by themselves are those of
// the loaded string, all that depends on the frequency does so on w (1 - i / 2Q), the load's impedance, too, and the last term is
// not there. What a string and its bead do lies somewhere between (pluck_scene::loaded_loss).
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_scene.hpp>
#include <rosin/propagate/complex_dispersion.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <Eigen/Dense>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// sin and cos of z together. Damping is weak, so that Im z is small nearly always: then the hyperbolic parts are short series.
struct sine_cosine {
  std::complex<double> sine, cosine;

  explicit sine_cosine(std::complex<double> z) {
    const double s = std::sin(z.real()), c = std::cos(z.real()), y = z.imag(), y2 = y * y;
    const bool small = y2 < 0.01;  // the first term left out is below 1e-17
    const double sh = small ? y * (1 + y2 / 6 * (1 + y2 / 20 * (1 + y2 / 42 * (1 + y2 / 72)))) : std::sinh(y);
    const double ch = small ? 1 + y2 / 2 * (1 + y2 / 12 * (1 + y2 / 30 * (1 + y2 / 56))) : std::cosh(y);
    sine = {s * ch, c * sh};
    cosine = {c * ch, -s * sh};
  }
};

}  // namespace detail

/// The string of a scene at one complex frequency.
class string_at {
public:
  using complex = std::complex<double>;

  string_at(const pluck_scene& scene, complex s) : s_{s}, length_{0.5 / scene.string.fundamental_Hz} {
    const double epsilon = std::max(scene.string.stiffness_s2(), 1e-30);
    const complex w(s.imag(), -s.real());
    q_ = phase_rate(w, epsilon);
    const double f = std::abs(s.imag()) / (2 * std::numbers::pi), real_w = 2 * std::numbers::pi * f;
    const loss_law& loss = scene.string.loss;
    q_ += slowness_ratio(real_w, epsilon) * complex(s.imag() * loss.lead(f), -real_w * loss.inverse_q(f) / 2);
    modulus_ = complex(1, loss.inverse_q(f) / 2);
    load_s_ = s * plain::reciprocal(1.0 + scene.loaded_loss * (modulus_ - 1.0));
    own_loss_ = (1 - scene.loaded_loss) * modulus_.imag() / std::numbers::pi;
    K_ = epsilon * q_ * q_;
    kappa_ = plain::sqrt(q_ * q_ + 1 / epsilon);
    epsilon_ = epsilon;
    const detail::sine_cosine whole(q_ * length_);
    sine_ = whole.sine, cosine_ = whole.cosine;
    stiff_ = plain::reciprocal(1.0 + 2.0 * K_);
  }

  /// sin(qL) times the velocity at b for a unit force at a (fractions), in units of 1/Z.
  [[nodiscard]] complex mobility(double a, double b) const {
    const double low = std::min(a, b) * length_, high = (1 - std::max(a, b)) * length_, gap = length_ - low - high;
    const complex decay = (fading(gap) - fading(gap + 2 * low) - fading(gap + 2 * high)) / 2.0;
    const complex m = s_ * plain::reciprocal(modulus_) * stiff_ *
                      (sine_of(low) * sine_of(high) * plain::reciprocal(q_) - sine_ * decay * plain::reciprocal(kappa_));
    return a == b ? m - own_loss_ * sine_ : m;
  }
  /// sin(qL) times the force on end 0 or 1 for a unit force at a.
  [[nodiscard]] complex end_force(int end, double a) const {
    const double other = (end == 0 ? 1 - a : a) * length_, here = length_ - other;
    return ((1.0 + K_) * sine_of(other) + K_ * sine_ * fading(here)) * stiff_;
  }
  /// sin(qL) times the force (in Z) on an end per unit speed of the same end, and of the other end.
  [[nodiscard]] complex own_end() const {
    return -modulus_ * kappa_ * q_ / (q_ * q_ + kappa_ * kappa_) * epsilon_ / s_ *
               (kappa_ * kappa_ * kappa_ * cosine_ - q_ * q_ * q_ * sine_) -
           2.0 * own_loss_ * sine_;
  }
  [[nodiscard]] complex other_end() const {
    return modulus_ * kappa_ * q_ / (q_ * q_ + kappa_ * kappa_) * epsilon_ / s_ * kappa_ * kappa_ * kappa_;
  }
  /// The answer to a unit moment on an end, sin(qL) times: velocity at a, over s (1/Z); the same end's turning and the other's,
  /// likewise; force on the same end and on the other.
  [[nodiscard]] complex turning(int end, double a) const {
    const double here = (end == 0 ? a : 1 - a) * length_;
    return stiff_ * (sine_of(length_ - here) - sine_ * fading(here));
  }
  [[nodiscard]] complex own_turning() const { return stiff_ * (kappa_ * sine_ - q_ * cosine_); }
  [[nodiscard]] complex other_turning() const { return stiff_ * q_; }
  [[nodiscard]] complex own_end_by_moment() const { return -stiff_ * ((1.0 + K_) * q_ * cosine_ + K_ * kappa_ * sine_); }
  [[nodiscard]] complex other_end_by_moment() const { return stiff_ * (1.0 + K_) * q_; }
  [[nodiscard]] complex sine() const { return sine_; }
  /// T (1 + i / 2Q) / T / s: what turns the answers above into velocities, inverted.
  [[nodiscard]] complex per_velocity() const { return modulus_ / s_; }
  /// sqrt(B / T) as a travel time: the reach of the near field.
  [[nodiscard]] double reach_s() const { return std::sqrt(epsilon_); }
  /// The frequency that a load's impedance is to be taken at.
  [[nodiscard]] complex load_s() const { return load_s_; }

private:
  [[nodiscard]] complex sine_of(double time) const { return detail::sine_cosine(q_ * time).sine; }
  /// The near field at that distance.
  [[nodiscard]] complex fading(double time) const { return kappa_.real() * time > 40 ? complex(0) : std::exp(-kappa_ * time); }

  complex s_;
  double length_, epsilon_ = 0, own_loss_ = 0;  ///< the last: 1 / (2 pi Q), where the bare string's modes lose
  complex load_s_, modulus_, q_, K_, kappa_, sine_, cosine_, stiff_;
};

/// Scatterers, yielding and clamped ends together.
inline constexpr int most_loops = 10;

/// The closed loop at one frequency: determinant, and the forces on the ends for a unit force at `position`.
struct loop_response {
  std::complex<double> determinant;                       ///< zero at the poles
  std::array<std::complex<double>, 2> times_determinant;  ///< end forces times the determinant
};

namespace detail {

using loop_matrix = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, 0, most_loops, most_loops>;

/// The ends of a scene that yield.
struct moving_ends {
  std::array<int, 2> end{};
  Eigen::Index count = 0;
  explicit moving_ends(const pluck_scene& scene) {
    for (int e = 0; e < 2; ++e)
      if (!scene.ends[static_cast<std::size_t>(e)].rigid()) end[static_cast<std::size_t>(count++)] = e;
  }
  [[nodiscard]] int operator[](Eigen::Index i) const { return end[static_cast<std::size_t>(i)]; }
};

/// The ends of a scene that resist turning.
struct clamped_ends {
  std::array<int, 2> end{};
  Eigen::Index count = 0;
  explicit clamped_ends(const pluck_scene& scene) {
    for (int e = 0; e < 2; ++e)
      if (scene.ends[static_cast<std::size_t>(e)].clamping != 0) end[static_cast<std::size_t>(count++)] = e;
  }
  [[nodiscard]] int operator[](Eigen::Index i) const { return end[static_cast<std::size_t>(i)]; }
};

/// Rows and columns of the ends that resist turning, after those of the others: (1 - clamping) M + clamping sqrt(B T) (turning /
/// s) = 0.
inline void add_moments(loop_matrix& A, const pluck_scene& scene, const string_at& string, const moving_ends& ends,
                        std::complex<double> s, double strength) {
  const clamped_ends clamped(scene);
  const auto count = static_cast<Eigen::Index>(scene.scatterers.size()), first = count + ends.count;
  for (Eigen::Index c = 0; c < clamped.count; ++c) {
    const double clamping = scene.ends[static_cast<std::size_t>(clamped[c])].clamping, k = clamping * string.reach_s();
    const auto end_force = [&](Eigen::Index m) {
      return ends[m] == clamped[c] ? string.own_end_by_moment() : string.other_end_by_moment();
    };
    for (Eigen::Index j = 0; j < count; ++j) {
      const scatterer& on = scene.scatterers[static_cast<std::size_t>(j)];
      const std::complex<double> turning = string.turning(clamped[c], on.position);
      A(first + c, j) = k * turning;
      A(j, first + c) = strength * on.impedance(string.load_s()) / string.per_velocity() * turning;
    }
    for (Eigen::Index m = 0; m < ends.count; ++m) {
      A(first + c, count + m) = k * string.per_velocity() * end_force(m);
      A(count + m, first + c) = -strength * scene.ends[static_cast<std::size_t>(ends[m])].admittance(s) * end_force(m);
    }
    for (Eigen::Index o = 0; o < clamped.count; ++o)
      A(first + c, first + o) = o == c ? (1 - clamping) * string.sine() + k * string.own_turning() : k * string.other_turning();
  }
}

/// sin(qL) times the loop's matrix: g_i + Z_i v_i = 0 for scatterers, u_m - Y F_m = 0 for ends (the string's velocity by u_m is
/// by reciprocity its end force).
template <class = void>
[[nodiscard]] loop_matrix loop_of(const pluck_scene& scene, const string_at& string, const moving_ends& ends,
                                  std::complex<double> s, double strength) {
  const auto count = static_cast<Eigen::Index>(scene.scatterers.size());
  const auto at = [&](Eigen::Index i) { return scene.scatterers[static_cast<std::size_t>(i)].position; };
  const auto size = count + ends.count + clamped_ends(scene).count;
  loop_matrix A = loop_matrix::Zero(size, size);
  for (Eigen::Index i = 0; i < count; ++i) {
    const std::complex<double> Z = strength * scene.scatterers[static_cast<std::size_t>(i)].impedance(string.load_s());
    for (Eigen::Index j = 0; j < count; ++j) A(i, j) = Z * string.mobility(at(i), at(j));
    A(i, i) += string.sine();
    for (Eigen::Index m = 0; m < ends.count; ++m) A(i, count + m) = Z * string.end_force(ends[m], at(i));
  }
  for (Eigen::Index m = 0; m < ends.count; ++m) {
    const std::complex<double> Y = strength * scene.ends[static_cast<std::size_t>(ends[m])].admittance(s);
    A(count + m, count + m) = string.sine();
    for (Eigen::Index i = 0; i < count; ++i) A(count + m, i) = -Y * string.end_force(ends[m], at(i));
    for (Eigen::Index k = 0; k < ends.count; ++k) A(count + m, count + k) -= Y * (k == m ? string.own_end() : string.other_end());
  }
  add_moments(A, scene, string, ends, s, strength);
  return A;
}

/// det A / sin(qL)^(n-1), which is entire.
template <class = void>
[[nodiscard]] std::complex<double> determinant_of(const loop_matrix& A, std::complex<double> sine) {
  const Eigen::Index n = A.rows();
  if (n == 0) return sine;
  if (n == 1) return A(0, 0);
  if (n == 2) return (A(0, 0) * A(1, 1) - A(0, 1) * A(1, 0)) * plain::reciprocal(sine);
  return A.determinant() / std::pow(sine, static_cast<int>(n) - 1);
}

}  // namespace detail

/// The closed loop's determinant at one frequency. `strength` scales scatterers and the motion of the ends.
template <class = void>
[[nodiscard]] std::complex<double> loop_determinant(const pluck_scene& scene, std::complex<double> s, double strength = 1) {
  const string_at string(scene, s);
  return detail::determinant_of(detail::loop_of(scene, string, detail::moving_ends(scene), s, strength), string.sine());
}

/// Determinant and end forces; unknowns are the forces of the scatterers on the string and the speeds of the yielding ends.
template <class = void>
[[nodiscard]] loop_response close_loop(const pluck_scene& scene, double position, std::complex<double> s) {
  const string_at string(scene, s);
  const detail::moving_ends ends(scene);
  const detail::clamped_ends clamped(scene);
  const auto count = static_cast<Eigen::Index>(scene.scatterers.size()), n = count + ends.count + clamped.count;
  if (n == 0) return {string.sine(), {string.end_force(0, position), string.end_force(1, position)}};
  const detail::loop_matrix A = detail::loop_of(scene, string, ends, s, 1);
  Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, 0, most_loops, 1> drive(n);
  Eigen::Matrix<std::complex<double>, 2, Eigen::Dynamic, 0, 2, most_loops> out(2, n);
  for (Eigen::Index i = 0; i < count; ++i) {
    const scatterer& on = scene.scatterers[static_cast<std::size_t>(i)];
    drive[i] = -on.impedance(string.load_s()) * string.mobility(on.position, position);
    for (int e = 0; e < 2; ++e) out(e, i) = string.end_force(e, on.position);
  }
  for (Eigen::Index m = 0; m < ends.count; ++m) {
    drive[count + m] = scene.ends[static_cast<std::size_t>(ends[m])].admittance(s) * string.end_force(ends[m], position);
    for (int o = 0; o < 2; ++o) out(o, count + m) = o == ends[m] ? string.own_end() : string.other_end();
  }
  for (Eigen::Index c = 0; c < clamped.count; ++c) {
    drive[count + ends.count + c] =
        -scene.ends[static_cast<std::size_t>(clamped[c])].clamping * string.reach_s() * string.turning(clamped[c], position);
    for (int o = 0; o < 2; ++o)
      out(o, count + ends.count + c) = o == clamped[c] ? string.own_end_by_moment() : string.other_end_by_moment();
  }
  loop_response r{detail::determinant_of(A, string.sine()), {}};
  if (n == 1) drive *= plain::reciprocal(A(0, 0));
  else drive = A.partialPivLu().solve(drive).eval();
  for (int e = 0; e < 2; ++e)
    r.times_determinant[static_cast<std::size_t>(e)] =
        r.determinant * plain::reciprocal(string.sine()) * (string.end_force(e, position) + (out.row(e) * drive)(0));
  return r;
}
ROSIN_INSTANTIATE(loop_response close_loop(const pluck_scene&, double, std::complex<double>))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
