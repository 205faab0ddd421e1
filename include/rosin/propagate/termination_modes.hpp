// tier: hosted
// SPDX-License-Identifier: MIT
//
// Any termination as a sum of modes, for the simulators, which step modes. None is lost by that: a causal, passive admittance is
// a sum of modes with positive masses, if need be of very many (the integral in termination_table.hpp is one of undamped modes,
// of weight (2 / pi) Re z dw). Few do: where the reflection R = -(1 - z)/(1 + z) differs most from the wanted one, modes are
// added, and
//
//     ln f, ln Q, ln Z/M  of all of them:   sum |R_modes - R|^2  smallest   (Levenberg and Marquardt).
//
// By the logarithms no mass can become negative: what comes out is passive, whatever went in. Not vector fitting: its poles are
// found faster, but whether their sum is passive has to be hoped for.
//
#pragma once

#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/math/levenberg_marquardt.hpp>
#include <rosin/propagate/termination.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Where the modes have to answer as the termination does, how well, and how many they may be.
struct mode_limits {
  double from_Hz = 50, to_Hz = 20e3;  ///< modes themselves up to three times as high
  double tolerance = 1e-3;            ///< stop here
  double refuse = 0.1;                ///< fail above
  int modes = 90;
  double least_q = 0.02;  ///< below 0.5 a mode does not ring: its poles are real
};

/// Modes, and the rms of what their reflection misses over the rms of what makes the wanted one differ from a rigid end's.
struct modal_likeness {
  modal_termination end;
  double mismatch = 0;
};

namespace detail {

class mode_fit {
public:
  using complex = std::complex<double>;

  template <Termination End>
  mode_fit(const End& end, const mode_limits& limits) : limits_{limits} {
    const double step_Hz = std::clamp(0.5 / std::max(end.memory_s(), 1e-9), limits.from_Hz / 400, limits.from_Hz / 40);
    const auto count = static_cast<std::size_t>(limits.to_Hz / step_Hz) + 1;
    std::vector<complex> grid;
    if constexpr (requires { end.on_grid(step_Hz, count); }) grid = end.on_grid(step_Hz, count);
    for (auto k = static_cast<std::size_t>(limits.from_Hz / step_Hz); k < count; k += 1 + k / 400) {
      const double f = step_Hz * static_cast<double>(k);
      const complex z = grid.empty() ? complex(end.relative_admittance(f)) : grid[k];
      s_.emplace_back(0, 2 * std::numbers::pi * f);
      wanted_.push_back(2.0 * z / (1.0 + z));
      all_ += std::norm(wanted_.back());
    }
    now_ = {{}, wanted_, all_};
  }

  template <class = void>
  [[nodiscard]] modal_likeness run() {
    for (int in_vain = 0;
         in_vain < 2 && all_ > 0 && mismatch() > limits_.tolerance && static_cast<int>(now_.modes.size()) < limits_.modes;) {
      const double before = mismatch();
      now_ = polished(with_more());
      in_vain = mismatch() < 0.95 * before ? 0 : in_vain + 1;
    }
    return {{now_.modes}, mismatch()};
  }

  /// Modes, and what their reflection misses.
  struct trial {
    std::vector<admittance_mode> modes;
    std::vector<complex> missed;
    double squares = 0;
  };
  [[nodiscard]] double cost(const trial& t) const { return t.squares; }
  template <class Real = double>
  [[nodiscard]] normal_equations<> linearise(const trial& t) const {
    const auto n = static_cast<Eigen::Index>(3 * t.modes.size());
    Eigen::MatrixX<Real> rows(n, static_cast<Eigen::Index>(2 * s_.size()));
    Eigen::VectorX<Real> missed(rows.cols());
    for (std::size_t k = 0; k < s_.size(); ++k) {
      const auto at = static_cast<Eigen::Index>(2 * k);
      missed[at] = t.missed[k].real(), missed[at + 1] = t.missed[k].imag();
      const complex by = slope(t, k);
      for (std::size_t m = 0; m < t.modes.size(); ++m) {
        const double w = 2 * std::numbers::pi * t.modes[m].frequency_Hz, w_s = s_[k].imag();
        const complex unit = unit_at(k, t.modes[m].frequency_Hz, t.modes[m].q),
                      over{unit.imag() / w_s, -unit.real() / w_s};  // unit / s
        const complex z = by * t.modes[m].per_mass_per_s * unit, resist{0, w_s * w / t.modes[m].q};
        const std::array<complex, 3> d{-z * (resist + 2 * w * w) * over, z * resist * over, z};
        for (std::size_t i = 0; i < 3; ++i) {
          rows(static_cast<Eigen::Index>(3 * m + i), at) = d[i].real();
          rows(static_cast<Eigen::Index>(3 * m + i), at + 1) = d[i].imag();
        }
      }
    }
    normal_equations<> equations{rows * rows.transpose(), rows * missed, t.squares};
    equations.hessian.diagonal().array() += 1e-12 * equations.hessian.diagonal().maxCoeff();
    return equations;
  }
  [[nodiscard]] trial moved(const trial& t, const Eigen::VectorXd& change) const {
    auto modes = t.modes;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      const auto by = [&](std::size_t i, double most) {
        return std::exp(std::clamp(change[static_cast<Eigen::Index>(3 * m + i)], -most, most));
      };
      modes[m].frequency_Hz = std::clamp(modes[m].frequency_Hz * by(0, 0.2), limits_.from_Hz / 8, 3 * limits_.to_Hz);
      modes[m].q = std::clamp(modes[m].q * by(1, 1), limits_.least_q, 2000.0);
      modes[m].per_mass_per_s *= by(2, 2);
    }
    return tried(std::move(modes));
  }

private:
  [[nodiscard]] double mismatch() const { return all_ > 0 ? std::sqrt(now_.squares / all_) : 0; }
  [[nodiscard]] trial tried(std::vector<admittance_mode> modes) const {
    trial out{std::move(modes), wanted_, 0};
    for (std::size_t k = 0; k < s_.size(); ++k) {
      complex z = 0;
      for (const auto& m : out.modes) z += m.per_mass_per_s * unit_at(k, m.frequency_Hz, m.q);
      out.missed[k] -= 2.0 * z / (1.0 + z);
      out.squares += std::norm(out.missed[k]);
    }
    return out;
  }
  /// dR / dz, from R itself.
  [[nodiscard]] complex slope(const trial& t, std::size_t k) const {
    const complex half = 1.0 - 0.5 * (wanted_[k] - t.missed[k]);  // 1 / (1 + z)
    return 2.0 * half * half;
  }

  /// z of a mode of unit strength at s_k, by real numbers: most of the time goes here.
  [[nodiscard]] complex unit_at(std::size_t k, double f, double q) const {
    const double w = s_[k].imag(), w0 = 2 * std::numbers::pi * f, off = w0 * w0 - w * w, resists = w * w0 / q,
                 over = w / (off * off + resists * resists);
    return {over * resists, over * off};
  }
  /// What a mode would take from the difference if it stood alone, and its strength.
  [[nodiscard]] std::pair<double, admittance_mode> gain_of(double f, double q, const std::vector<double>& weight,
                                                           const std::vector<complex>& pull) const {
    double along = 0, size = 0;
    for (std::size_t k = 0; k < s_.size(); ++k) {
      const complex a = unit_at(k, f, q);
      along += a.real() * pull[k].real() + a.imag() * pull[k].imag();
      size += weight[k] * (a.real() * a.real() + a.imag() * a.imag());
    }
    return {along > 0 ? along * along / size : 0, {f, q, along / size}};
  }

  /// Up to three modes more, apart from each other, each of which alone would take most from the difference.
  [[nodiscard]] std::vector<admittance_mode> with_more() const {
    std::vector<double> weight;
    std::vector<complex> pull;
    for (std::size_t k = 0; k < s_.size(); ++k) {
      const complex by = slope(now_, k);
      weight.push_back(std::norm(by)), pull.push_back(std::conj(by) * now_.missed[k]);
    }
    std::vector<std::pair<double, admittance_mode>> found;
    for (const double sharp : {0.3, 2.0, 8.0, 25.0, 80.0}) {
      const double q = std::max(sharp, limits_.least_q);
      for (std::size_t k = 0; k < s_.size(); k += 3)
        found.push_back(gain_of(s_[k].imag() / (2 * std::numbers::pi), q, weight, pull));
      for (const double f : {limits_.from_Hz / 4, limits_.from_Hz / 2, 1.5 * limits_.to_Hz, 2.5 * limits_.to_Hz})
        found.push_back(gain_of(f, q, weight, pull));
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    auto modes = now_.modes;
    const std::size_t had = modes.size();
    for (auto it = found.begin(); it != found.end() && it->first > 0 && modes.size() < had + 3; ++it)
      if (std::none_of(modes.begin() + static_cast<std::ptrdiff_t>(had), modes.end(),
                       [&](const auto& m) { return std::abs(std::log(it->second.frequency_Hz / m.frequency_Hz)) < 0.3; }))
        modes.push_back(it->second);
    return modes;
  }

  /// A few steps, as long as they help.
  template <class = void>
  [[nodiscard]] trial polished(std::vector<admittance_mode> modes) const {
    return levenberg_marquardt(*this, tried(std::move(modes)),
                               {.less = 0.2, .floor = 0, .iterations = 8, .rejections = 4, .enough_relative = 0.002})
        .at;
  }

  mode_limits limits_;
  std::vector<complex> s_, wanted_;  ///< R + 1 is wanted
  double all_ = 0;
  trial now_;
};

}  // namespace detail

/// Modes stay what they are.
[[nodiscard]] inline outcome<modal_likeness> as_modes(const modal_termination& end, const mode_limits& = {}) {
  return modal_likeness{end, 0};
}

/// Fails where no sum of modes within the limits comes near.
template <Termination End>
[[nodiscard]] outcome<modal_likeness> as_modes(const End& end, const mode_limits& limits = {}) {
  auto found = detail::mode_fit(end, limits).run();
  if (!(found.mismatch <= limits.refuse))
    return failure{"termination: " + std::to_string(found.end.modes.size()) + " modes come no nearer to its reflection than " +
                   number_text(found.mismatch, "%.3g") + " of what moves"};
  return found;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
