// tier: hosted
// SPDX-License-Identifier: MIT
//
// A sum of damped lines, x(t) = sum_n Re{ r_n exp(s_n t) }: what any linear rig does once it is let go. Poles and residues
// are all that a model has to supply; whatever the physics (stiffness, loss, ends, sensors), the fit below is the same.
//
// Two things make the fit fast. The lines are advanced by one complex product a sample, in blocks that stay in the cache.
// And the normal matrix of all lines and their derivatives is known in closed form: sums of t^a exp(p t) over n equidistant t = k
// h, with z = exp(p h)
//
//     (1 - z) A_0 = 1 - z^n,   (1 - z) A_1 = z A_0 - n z^n,   (1 - z) A_2 = z (2 A_1 + A_0) - n^2 z^n,      A_a = sum k^a z^k,
//
// and where that would cancel, n |1 - z| being small, by doubling (the sum over 2m samples from the sum over m).
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/plain_complex.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <complex>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One damped line seen by two channels. pole: 1/s; residues: in the unit of the signal.
struct damped_line {
  std::complex<double> pole;
  std::array<std::complex<double>, 2> residue;
};

namespace detail {

/// By doubling: cannot cancel however small p is.
[[nodiscard]] inline std::array<std::complex<double>, 3> doubled_sums(std::complex<double> one_step, double step_s,
                                                                      std::size_t count) {
  std::array<std::complex<double>, 3> sum{};  // over `done` samples
  std::complex<double> z = 1;                 // exp(p h done)
  double t = 0;                               // h done
  for (std::size_t bit = std::bit_floor(count); bit != 0; bit >>= 1) {
    const std::array<std::complex<double>, 3> half = sum;
    sum[2] += z * (half[2] + 2 * t * half[1] + t * t * half[0]);
    sum[1] += z * (half[1] + t * half[0]);
    sum[0] += z * half[0];
    z *= z;
    t *= 2;
    if (count & bit) {
      sum[0] += z;
      sum[1] += t * z;
      sum[2] += t * t * z;
      z *= one_step;
      t += step_s;
    }
  }
  return sum;
}

}  // namespace detail

/// What sums of powers need of exp(p t): after one step h and after all of them. Of a product of two exponentials, the products.
struct line_steps {
  std::complex<double> one, all;

  line_steps(std::complex<double> one_step, std::complex<double> all_steps) : one{one_step}, all{all_steps} {}
  line_steps(std::complex<double> p, double step_s, std::size_t count)
      : one{std::exp(p * step_s)}, all{std::exp(p * step_s * static_cast<double>(count))} {}
};
[[nodiscard]] inline line_steps operator*(const line_steps& a, const line_steps& b) { return {a.one * b.one, a.all * b.all}; }
[[nodiscard]] inline line_steps conj(const line_steps& a) { return {std::conj(a.one), std::conj(a.all)}; }

/// sum_{k=0}^{count-1} (k h)^a exp(p k h) for a = 0, 1, 2.
[[nodiscard]] inline std::array<std::complex<double>, 3> power_sums(const line_steps& p, double step_s, std::size_t count) {
  constexpr double enough = 16;
  const auto n = static_cast<double>(count);
  const std::complex<double> less = 1.0 - p.one;
  if (!(std::norm(less) * n * n > enough * enough)) return detail::doubled_sums(p.one, step_s, count);
  const std::complex<double> over = plain::reciprocal(less), last = n * p.all;
  const std::complex<double> a0 = (1.0 - p.all) * over, a1 = (p.one * a0 - last) * over,
                             a2 = (p.one * (2.0 * a1 + a0) - n * last) * over;
  return {a0, step_s * a1, step_s * step_s * a2};
}
[[nodiscard]] inline std::array<std::complex<double>, 3> power_sums(std::complex<double> p, double step_s, std::size_t count) {
  return power_sums(line_steps(p, step_s, count), step_s, count);
}

/// Gram matrix of the functions Re z_n, Im z_n, t Re z_n, t Im z_n (four per line, in this order), z_n = exp(s_n t),
/// over t = 0, h, ... (count - 1) h.  Shape: 4N x 4N.
template <class Real = double>
[[nodiscard]] Eigen::MatrixXd line_gram(const std::vector<damped_line>& lines, double step_s, std::size_t count) {
  const auto N = static_cast<Eigen::Index>(lines.size());
  Eigen::MatrixX<Real> gram(4 * N, 4 * N);
  std::vector<line_steps> steps;
  for (const damped_line& line : lines) steps.emplace_back(line.pole, step_s, count);
  for (Eigen::Index i = 0; i < N; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const line_steps &zi = steps[static_cast<std::size_t>(i)], &zj = steps[static_cast<std::size_t>(j)];
      const auto same = power_sums(zi * zj, step_s, count), cross = power_sums(zi * conj(zj), step_s, count);
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
          const auto u = same[static_cast<std::size_t>(a + b)], v = cross[static_cast<std::size_t>(a + b)];
          Eigen::Matrix2d part;
          part << v.real() + u.real(), u.imag() - v.imag(), u.imag() + v.imag(), v.real() - u.real();
          gram.template block<2, 2>(4 * i + 2 * a, 4 * j + 2 * b) = part / 2;
          gram.template block<2, 2>(4 * j + 2 * b, 4 * i + 2 * a) = part.transpose() / 2;
        }
    }
  return gram;
}
ROSIN_INSTANTIATE(Eigen::MatrixXd line_gram(const std::vector<damped_line>&, double, std::size_t))

/// Lines at equidistant samples. A block of them is a table times one factor a line, so that sums of lines, and products with
/// lines, are products of matrices, many blocks at a time.
class line_runner {
public:
  static constexpr std::size_t block = 256;

  line_runner(const std::vector<damped_line>& lines, double step_s)
      : step_s_{step_s}, table_(block, 2 * lines.size()), jump_(static_cast<Eigen::Index>(lines.size())) {
    const auto N = static_cast<Eigen::Index>(lines.size());
    for (Eigen::Index n = 0; n < N; ++n) {
      const std::complex<double> pole = lines[static_cast<std::size_t>(n)].pole;
      const std::complex<double> step = std::exp(pole * step_s);
      std::complex<double> z = 1;
      for (Eigen::Index i = 0; i < Eigen::Index{block}; ++i, z *= step) table_(i, n) = z.real(), table_(i, N + n) = z.imag();
      jump_[n] = std::exp(pole * step_s * static_cast<double>(block));
    }
  }

  /// sum_n Re{ residue_nc z_n }: count x 2.
  template <class Real = double>
  [[nodiscard]] Eigen::MatrixXd sum(const std::vector<damped_line>& lines, std::size_t count) const {
    const Eigen::Index N = jump_.size();
    Eigen::MatrixX<Real> out(static_cast<Eigen::Index>(count), 2);
    in_chunks(count, [&](Eigen::Index begin, Eigen::Index blocks, const Eigen::MatrixX<std::complex<Real>>& start) {
      Eigen::MatrixX<Real> factor(2 * N, 2 * blocks);
      for (Eigen::Index n = 0; n < N; ++n)
        for (Eigen::Index c = 0; c < 2; ++c) {
          const auto r = lines[static_cast<std::size_t>(n)].residue[static_cast<std::size_t>(c)] * start.row(n);
          factor.row(n).segment(c * blocks, blocks) = r.real(), factor.row(N + n).segment(c * blocks, blocks) = -r.imag();
        }
      const Eigen::MatrixX<Real> both = table_ * factor;
      for (Eigen::Index c = 0; c < 2; ++c) {
        const Eigen::Index length = std::min(blocks * table_.rows(), out.rows() - begin);
        out.col(c).segment(begin, length) =
            Eigen::Map<const Eigen::VectorX<Real>>(both.data() + c * blocks * table_.rows(), length);
      }
    });
    return out;
  }

  /// Products of each column of `signals` with Re z_n, Im z_n, t Re z_n, t Im z_n: N x 4 a column.
  template <class Real = double>
  [[nodiscard]] std::vector<Eigen::MatrixXd> products(const Eigen::MatrixXd& signals) const {
    const Eigen::Index N = jump_.size(), rows = table_.rows();
    const Eigen::VectorX<Real> ramp = Eigen::VectorX<Real>::LinSpaced(rows, 0.0, step_s_ * static_cast<double>(rows - 1));
    std::vector<Eigen::MatrixX<Real>> out(static_cast<std::size_t>(signals.cols()), Eigen::MatrixX<Real>::Zero(N, 4));
    in_chunks(static_cast<std::size_t>(signals.rows()), [&](Eigen::Index begin, Eigen::Index blocks,
                                                            const Eigen::MatrixX<std::complex<Real>>& start) {
      const Eigen::Index length = std::min(blocks * rows, signals.rows() - begin);
      Eigen::MatrixX<Real> cut = Eigen::MatrixX<Real>::Zero(rows, 2 * blocks);
      for (Eigen::Index c = 0; c < signals.cols(); ++c) {
        Eigen::Map<Eigen::VectorX<Real>>(cut.data(), blocks * rows).head(length) = signals.col(c).segment(begin, length);
        Eigen::Map<Eigen::VectorX<Real>>(cut.data(), blocks * rows).tail(blocks * rows - length).setZero();
        cut.rightCols(blocks) = ramp.asDiagonal() * cut.leftCols(blocks);
        const Eigen::MatrixX<Real> onto = table_.transpose() * cut;
        add_products(onto, start, step_s_ * static_cast<double>(begin), out[static_cast<std::size_t>(c)]);
      }
    });
    return out;
  }

private:
  static constexpr Eigen::Index most_blocks = 32;

  /// visit(first sample, how many blocks, z_n at the beginning of each: N x blocks)
  template <class Visit>
  void in_chunks(std::size_t count, Visit&& visit) const {
    const Eigen::Index rows = table_.rows(), all = static_cast<Eigen::Index>(count);
    Eigen::VectorXcd at = Eigen::VectorXcd::Ones(jump_.size());
    for (Eigen::Index begin = 0; begin < all; begin += most_blocks * rows) {
      Eigen::MatrixXcd start(jump_.size(), std::min(most_blocks, (all - begin + rows - 1) / rows));
      for (Eigen::Index b = 0; b < start.cols(); ++b, at.array() *= jump_.array()) start.col(b) = at;
      visit(begin, start.cols(), start);
    }
  }

  void add_products(const Eigen::MatrixXd& onto, const Eigen::MatrixXcd& start, double begin_s, Eigen::MatrixXd& sum) const {
    const Eigen::Index N = start.rows(), blocks = start.cols();
    for (Eigen::Index b = 0; b < blocks; ++b) {
      const double t = begin_s + step_s_ * static_cast<double>(b * table_.rows());
      for (Eigen::Index n = 0; n < N; ++n) {
        const std::complex<double> plain = start(n, b) * std::complex<double>(onto(n, b), onto(N + n, b));
        const std::complex<double> ramped =
            t * plain + start(n, b) * std::complex<double>(onto(n, blocks + b), onto(N + n, blocks + b));
        sum(n, 0) += plain.real(), sum(n, 1) += plain.imag(), sum(n, 2) += ramped.real(), sum(n, 3) += ramped.imag();
      }
    }
  }

  double step_s_;
  Eigen::MatrixXd table_;  // block x 2N: Re z, Im z
  Eigen::VectorXcd jump_;  // z over a block
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
