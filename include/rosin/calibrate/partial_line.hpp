// tier: hosted
// SPDX-License-Identifier: MIT
//
// Least squares (maximum likelihood in white noise) for damped lines at baseband, by Levenberg-Marquardt:
//
//     z(t) = exp(2 pi i fc g(t)) sum_k c_k exp((-a_k + i w_k) t),     g(t) = relative (1 - exp(-kappa t)) / kappa
//
// g is the pitch glide that all partials of a string share: the stretched string is sharp by `relative` at t = 0, and that dies
// away with the energy, kappa. It may be given or fitted. Two lines at once tell beats and double decays (the two polarisations)
// from a single one; the normal matrix is at most 9 x 9, so the cost is one exponential per line and sample.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/levenberg_marquardt.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace rosin {

/// amplitude: complex, at the first sample; detuning: against the centre of the baseband.
struct damped_part {
  std::complex<double> amplitude;
  double decay_per_s = 0;
  double detuning_rad_s = 0;

  [[nodiscard]] double energy(double until_s) const {
    const double x = 2 * decay_per_s * until_s;
    return std::norm(amplitude) * until_s * (std::abs(x) < 1e-6 ? 1.0 : -std::expm1(-x) / x);
  }
};

/// A pitch that starts sharp by `relative` and settles at the rate `decay_per_s`.
struct pitch_glide {
  double relative = 0;
  double decay_per_s = 1;

  /// Integral of exp(-decay t) over (0, t).
  [[nodiscard]] double path_s(double t_s) const { return -std::expm1(-decay_per_s * t_s) / decay_per_s; }
};

struct line_model {
  std::vector<damped_part> parts;
  double centre_Hz = 0;
  pitch_glide glide{};
};

/// information: Re J^H J of Re c, Im c, decay, detuning of each part in turn, then of the glide if it was free.
struct line_fit {
  line_model model;
  Eigen::MatrixXd information;
  double residual = 0;  ///< sum of |z - model|^2
  bool glide_free = false;
};

namespace detail {

using complex_span = std::span<const std::complex<double>>;
inline constexpr double full_turn = 6.283185307179586476925;

inline std::complex<double> line_rotation(const line_model& m, double t) {
  return std::polar(1.0, full_turn * m.centre_Hz * m.glide.relative * m.glide.path_s(t));
}

/// Derivatives at one sample, one column a parameter; returns the model's value.
inline std::complex<double> line_row(const line_model& m, double t, bool glide_free, Eigen::VectorXcd& row) {
  constexpr std::complex<double> i{0, 1};
  const std::complex<double> turned = m.glide.relative != 0 ? line_rotation(m, t) : 1.0;
  std::complex<double> sum = 0;
  Eigen::Index at = 0;
  for (const damped_part& p : m.parts) {
    const std::complex<double> e = turned * std::exp(std::complex<double>{-p.decay_per_s * t, p.detuning_rad_s * t});
    const std::complex<double> y = p.amplitude * e;
    row[at++] = e;
    row[at++] = i * e;
    row[at++] = -t * y;
    row[at++] = i * t * y;
    sum += y;
  }
  if (glide_free) row[at] = i * full_turn * m.centre_Hz * m.glide.path_s(t) * sum;
  return sum;
}

/// Derivatives by Re c, Im c, decay and detuning of each part in turn, then by the glide if it is free.
struct line_descent {
  complex_span z;
  double rate_Hz = 1;
  bool glide_free = false;

  template <class Real = double>
  [[nodiscard]] normal_equations<> linearise(const line_model& m) const {
    const auto n = static_cast<Eigen::Index>(4 * m.parts.size() + (glide_free ? 1 : 0));
    auto equations = normal_equations<Real>::zero(n);
    Eigen::VectorX<std::complex<Real>> row(n);
    for (std::size_t j = 0; j < z.size(); ++j) {
      const std::complex<double> r = z[j] - line_row(m, static_cast<double>(j) / rate_Hz, glide_free, row);
      equations.add(row, r);
    }
    equations.mirror();
    return equations;
  }
  [[nodiscard]] line_model moved(line_model m, const Eigen::VectorXd& by) const {
    Eigen::Index at = 0;
    for (damped_part& p : m.parts) {
      p.amplitude += std::complex<double>{by[at], by[at + 1]};
      p.decay_per_s += by[at + 2];
      p.detuning_rad_s += by[at + 3];
      at += 4;
    }
    if (glide_free) m.glide.relative += by[at];
    return m;
  }
};

}  // namespace detail

/// Sets the amplitudes to those of least squares, the rest as it is. Returns the sum of |z - model|^2.
template <class Real = double>
double solve_amplitudes(std::span<const std::complex<double>> z, double rate_Hz, line_model& m) {
  const auto n = static_cast<Eigen::Index>(m.parts.size());
  Eigen::MatrixX<std::complex<Real>> gram = Eigen::MatrixX<std::complex<Real>>::Zero(n, n);
  Eigen::VectorX<std::complex<Real>> right = Eigen::VectorX<std::complex<Real>>::Zero(n), row(4 * n + 1);
  double power = 0;
  for (std::size_t j = 0; j < z.size(); ++j) {
    detail::line_row(m, static_cast<double>(j) / rate_Hz, false, row);
    for (Eigen::Index a = 0; a < n; ++a) {
      right[a] += std::conj(row[4 * a]) * z[j];
      for (Eigen::Index b = 0; b < n; ++b) gram(a, b) += std::conj(row[4 * a]) * row[4 * b];
    }
    power += std::norm(z[j]);
  }
  const Eigen::VectorX<std::complex<Real>> c = gram.fullPivLu().solve(right);
  for (Eigen::Index a = 0; a < n; ++a) m.parts[static_cast<std::size_t>(a)].amplitude = c[a];
  return power - std::real(c.dot(right));
}
ROSIN_INSTANTIATE(double solve_amplitudes(std::span<const std::complex<double>>, double, line_model&))

/// Levenberg-Marquardt from `start`; the amplitudes of the start do not matter.
template <class Real = double>
line_fit fit_line(std::span<const std::complex<double>> z, double rate_Hz, line_model start, bool glide_free = false,
                  int iterations = 30) {
  solve_amplitudes(z, rate_Hz, start);
  auto found = levenberg_marquardt(detail::line_descent{z, rate_Hz, glide_free}, std::move(start),
                                   {.less = 1.0 / 8, .more = 6, .iterations = iterations, .enough_relative = 1e-9});
  return {std::move(found.at), std::move(found.equations.hessian), found.cost, glide_free};
}
ROSIN_INSTANTIATE(line_fit fit_line(std::span<const std::complex<double>>, double, line_model, bool, int))

}  // namespace rosin
