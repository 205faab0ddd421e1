// tier: hosted
// SPDX-License-Identifier: MIT
//
// A sum of damped lines, x(t) = sum_n Re{ r_n exp(s_n t) }: what any linear rig does once it is let go. Poles and residues
// are all that a model has to supply; whatever the physics (stiffness, loss, ends, sensors), the fit below is the same.
//
// Two things make the fit fast. The lines are advanced by one complex product a sample, in blocks that stay in the cache.
// And the normal matrix of all lines and their derivatives is known in closed form: sums of t^a exp(p t) over equidistant t,
// built by doubling (sum over 2m samples from the sum over m), which cannot cancel however small p is.
//
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <bit>
#include <complex>
#include <cstddef>
#include <vector>

namespace rosin {

/// One damped line seen by two channels. pole: 1/s; residues: in the unit of the signal.
struct damped_line {
  std::complex<double> pole;
  std::array<std::complex<double>, 2> residue;
};

/// sum_{k=0}^{count-1} (k h)^a exp(p k h) for a = 0, 1, 2.
[[nodiscard]] inline std::array<std::complex<double>, 3> power_sums(std::complex<double> p, double step_s, std::size_t count) {
  std::array<std::complex<double>, 3> sum{};  // over `done` samples
  std::complex<double> z = 1;                 // exp(p h done)
  double t = 0;                               // h done
  const std::complex<double> one_step = std::exp(p * step_s);
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

/// Gram matrix of the functions Re z_n, Im z_n, t Re z_n, t Im z_n (four per line, in this order), z_n = exp(s_n t),
/// over t = 0, h, ... (count - 1) h.  Shape: 4N x 4N.
[[nodiscard]] inline Eigen::MatrixXd line_gram(const std::vector<damped_line>& lines, double step_s, std::size_t count) {
  const auto N = static_cast<Eigen::Index>(lines.size());
  Eigen::MatrixXd gram(4 * N, 4 * N);
  for (Eigen::Index i = 0; i < N; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto si = lines[static_cast<std::size_t>(i)].pole, sj = lines[static_cast<std::size_t>(j)].pole;
      const auto same = power_sums(si + sj, step_s, count), cross = power_sums(si + std::conj(sj), step_s, count);
      for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
          const auto u = same[static_cast<std::size_t>(a + b)], v = cross[static_cast<std::size_t>(a + b)];
          Eigen::Matrix2d part;
          part << v.real() + u.real(), u.imag() - v.imag(), u.imag() + v.imag(), v.real() - u.real();
          gram.block<2, 2>(4 * i + 2 * a, 4 * j + 2 * b) = part / 2;
          gram.block<2, 2>(4 * j + 2 * b, 4 * i + 2 * a) = part.transpose() / 2;
        }
    }
  return gram;
}

/// Runs over equidistant samples with all lines at hand: `visit(begin, length, re, im)` is called for blocks of samples, where
/// re and im are length x N matrices of the lines at these samples.
class line_runner {
public:
  static constexpr std::size_t block = 256;

  line_runner(const std::vector<damped_line>& lines, double step_s) {
    const auto N = static_cast<Eigen::Index>(lines.size());
    power_re_.resize(block, N);
    power_im_.resize(block, N);
    jump_.resize(lines.size());
    for (Eigen::Index n = 0; n < N; ++n) {
      const std::complex<double> pole = lines[static_cast<std::size_t>(n)].pole;
      const std::complex<double> step = std::exp(pole * step_s);
      std::complex<double> z = 1;
      for (Eigen::Index i = 0; i < Eigen::Index{block}; ++i, z *= step) {
        power_re_(i, n) = z.real();
        power_im_(i, n) = z.imag();
      }
      jump_[static_cast<std::size_t>(n)] = std::exp(pole * step_s * static_cast<double>(block));
    }
  }

  template <class Visit>
  void operator()(std::size_t count, Visit&& visit) const {
    const auto N = power_re_.cols();
    Eigen::MatrixXd re(block, N), im(block, N);
    std::vector<std::complex<double>> start(jump_.size(), 1.0);
    for (std::size_t begin = 0; begin < count; begin += block) {
      for (Eigen::Index n = 0; n < N; ++n) {
        std::complex<double>& z = start[static_cast<std::size_t>(n)];
        re.col(n) = z.real() * power_re_.col(n) - z.imag() * power_im_.col(n);
        im.col(n) = z.real() * power_im_.col(n) + z.imag() * power_re_.col(n);
        z *= jump_[static_cast<std::size_t>(n)];
      }
      visit(begin, std::min(block, count - begin), re, im);
    }
  }

private:
  Eigen::MatrixXd power_re_, power_im_;
  std::vector<std::complex<double>> jump_;
};

}  // namespace rosin
