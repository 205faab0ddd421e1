// tier: hosted
// SPDX-License-Identifier: MIT
//
// Coefficients for passage_reconstructor.hpp. The four passages are the kernels of the whole-record reconstruction's forces. What
// makes velocities of them is smooth in frequency,
//
//     y(f) = 1 / (2 Z_f) = 1 / (2 G Z_w)           2 y(f) cos:  y[0] + 2 sum y[k] cos(2 pi k f / rate)
//     n(f) = -i (k / kappa) / (2 Z_f)                            -2 i sum n[k] sin(2 pi k f / rate)
//
// so that a few taps do, fitted by least squares with the band's own weight: no more than the band needs, nothing beyond it.
//
#pragma once

#include <rosin/core/outcome.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <numbers>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A design in double, of any length.
struct passage_plan {
  std::array<fir, 4> passage;  ///< from newtons as recorded; empty where the version has no use for it
  /// from the middle: y[0] and y[k] on both sides; n[k] on the older, -n[k] on the newer
  std::vector<double> admittance, near_field;
  bow_version version = bow_version::both;

  [[nodiscard]] int reach_ahead() const noexcept {
    return half_length() + extreme([](const fir& k) { return -k.first; });
  }
  [[nodiscard]] int reach_back() const noexcept {
    return half_length() + extreme([](const fir& k) { return k.last(); });
  }
  [[nodiscard]] int half_length() const noexcept { return static_cast<int>(admittance.size()) - 1; }
  /// Taps of the longest passage, rounded up to a multiple of 4, and frames that one output depends on.
  [[nodiscard]] std::size_t longest() const noexcept {
    std::size_t n = 0;
    for (const fir& k : passage) n = std::max(n, k.taps.size());
    return (n + 3) / 4 * 4;
  }
  [[nodiscard]] std::size_t span() const noexcept { return static_cast<std::size_t>(reach_ahead() + reach_back()) + 1; }

  /// A passage as the run-time part wants it: oldest sample first, zeros before it up to a multiple of 4.
  [[nodiscard]] std::vector<double> arrival_taps(std::size_t p) const {
    std::vector<double> out((passage[p].taps.size() + 3) / 4 * 4, 0.0);
    std::copy_backward(passage[p].taps.rbegin(), passage[p].taps.rend(), out.end());
    return out;
  }
  /// y and n likewise.
  [[nodiscard]] std::vector<double> arrival_admittance() const { return both_sides(admittance, 1); }
  [[nodiscard]] std::vector<double> arrival_near_field() const { return both_sides(near_field, -1); }
  [[nodiscard]] std::size_t newest_age(std::size_t p) const noexcept {
    return passage[p].taps.empty() ? 0 : static_cast<std::size_t>(reach_ahead() - half_length() + passage[p].first);
  }

private:
  static std::vector<double> both_sides(const std::vector<double>& half, double newer) {
    std::vector<double> out((2 * half.size() + 2) / 4 * 4, 0.0);
    const std::size_t middle = out.size() - half.size();
    for (std::size_t k = 0; k < half.size(); ++k) out[middle + k] = newer * half[k], out[middle - k] = half[k];
    return out;
  }
  template <class Of>
  [[nodiscard]] int extreme(Of of) const noexcept {
    int most = 0;
    for (const fir& k : passage)
      if (!k.taps.empty()) most = std::max(most, of(k));
    return most;
  }
};

namespace detail {

/// What the fit of y and n is measured against, at one frequency.
template <class Physics>
[[nodiscard]] std::array<double, 2> short_responses(const bow_point& at, double f_Hz) {
  const double w = 2 * std::numbers::pi * f_Hz, e = at.stiffness_s2;
  const double G = Physics::force_factor ? force_factor(w, e) : 1.0;
  const double Zw = at.impedance_Ns_m * (Physics::force_factor ? wave_impedance_ratio(w, e) : 1.0);
  return {1 / (2 * Zw * G), Physics::near_field ? near_field_ratio(w, e) / (2 * Zw * force_factor(w, e)) : 0.0};
}

/// Least squares in the band: part 0, cosines, for y; part 1, sines, for n.
template <class Physics>
[[nodiscard]] std::vector<double> short_taps(const bow_point& at, const band& limits, double rate_Hz, int half_length,
                                             std::size_t part) {
  const int points = 16 * (half_length + 8);
  const Eigen::Index unknowns = part == 0 ? half_length + 1 : half_length;
  std::vector<double> out(static_cast<std::size_t>(half_length + 1), 0.0);
  if (unknowns == 0) return out;
  Eigen::MatrixXd to(points, unknowns);
  Eigen::VectorXd wanted(points);
  for (int i = 0; i < points; ++i) {
    const double f = limits.stop_Hz * i / points, angle = 2 * std::numbers::pi * f / rate_Hz, weight = limits(f);
    for (Eigen::Index c = 0; c < unknowns; ++c)
      to(i, c) = weight * (part == 1 ? 2 * std::sin(angle * static_cast<double>(c + 1))
                           : c == 0  ? 1.0
                                     : 2 * std::cos(angle * static_cast<double>(c)));
    wanted[i] = weight * short_responses<Physics>(at, f)[part];
  }
  const Eigen::VectorXd taps = to.colPivHouseholderQr().solve(wanted);
  std::copy(taps.begin(), taps.end(), out.begin() + (part == 0 ? 0 : 1));
  return out;
}

/// Largest error of y and n together in the pass band, relative to y at low frequency.
template <class Physics>
[[nodiscard]] double short_error(const passage_plan& plan, const bow_point& at, const band& limits, double rate_Hz) {
  double worst = 0;
  for (int i = 0; i <= 200; ++i) {
    const double f = limits.pass_Hz * i / 200, angle = 2 * std::numbers::pi * f / rate_Hz;
    double y = plan.admittance[0], n = 0;
    for (std::size_t k = 1; k < plan.admittance.size(); ++k) {
      y += 2 * plan.admittance[k] * std::cos(angle * static_cast<double>(k));
      n += 2 * plan.near_field[k] * std::sin(angle * static_cast<double>(k));
    }
    const auto wanted = short_responses<Physics>(at, f);
    worst = std::max(worst, (std::abs(y - wanted[0]) + std::abs(n - wanted[1])) * 2 * at.impedance_Ns_m);
  }
  return worst;
}

/// a * b, y[n] = sum a[k] b[n - k]; a symmetric (sign = 1) or odd (-1) about lag 0 with taps a[0], a[1], ...
inline void add_convolved(fir& sum, const std::vector<double>& a, double sign, double gain, const fir& b) {
  const int h = static_cast<int>(a.size()) - 1;
  for (int k = -h; k <= h && !b.taps.empty(); ++k) {
    // a tap that looks at older frames has a positive lag
    const double tap = gain * a[static_cast<std::size_t>(std::abs(k))] * (k < 0 ? sign : 1.0);
    for (std::size_t j = 0; j < b.taps.size(); ++j)
      sum.taps[static_cast<std::size_t>(b.first + static_cast<int>(j) + k - sum.first)] += tap * b.taps[j];
  }
}

}  // namespace detail

/// gain: recorded / true, of near and far. error: largest relative error of the passages in the pass band, and of y and n.
/// half_length < 0: as short as `error` allows.
template <class Physics = full_physics>
[[nodiscard]] passage_plan plan_passages(const bow_point& at, const std::array<double, 2>& gain, const band& limits,
                                         double rate_Hz, double error = 1e-3, bow_version version = bow_version::both,
                                         int half_length = -1) {
  const std::vector<fir> all = bow_point_kernels<Physics>(at, limits, rate_Hz, error);
  passage_plan plan{{all[0], all[2], all[3], all[1]}, {}, {}, version};
  if (version == bow_version::near) plan.passage[2] = {};
  if (version == bow_version::far) plan.passage[0] = {};
  for (std::size_t p = 0; p < 4; ++p)
    for (double& tap : plan.passage[p].taps) tap /= gain[p / 2];
  for (int h = std::max(half_length, 0); h <= 32; ++h) {
    plan.admittance = detail::short_taps<Physics>(at, limits, rate_Hz, h, 0);
    plan.near_field = detail::short_taps<Physics>(at, limits, rate_Hz, h, 1);
    if (half_length >= 0 || detail::short_error<Physics>(plan, at, limits, rate_Hz) <= error) break;
  }
  return plan;
}

/// What the run-time part does, as the 4 x 2 kernels of the whole-record reconstruction: rows force and velocity, near and far.
[[nodiscard]] inline std::vector<fir> kernels_of(const passage_plan& plan) {
  const int first = -plan.reach_ahead(), last = plan.reach_back();
  std::vector<fir> out(8, fir{first, std::vector<double>(static_cast<std::size_t>(last - first + 1), 0.0)});
  const auto& [near_back, near_out, far_back, far_out] = plan.passage;
  const std::array<std::array<const fir*, 2>, 2> force{{{&near_back, &far_out}, {&near_out, &far_back}}};
  const std::array<std::array<const fir*, 2>, 2> back_and_out{{{&near_back, &near_out}, {&far_back, &far_out}}};
  for (std::size_t version = 0; version < 2; ++version)
    for (std::size_t input = 0; input < 2; ++input) {
      detail::add_convolved(out[2 * version + input], {1.0}, 1, 1, *force[version][input]);
      fir& velocity = out[4 + 2 * version + input];
      for (std::size_t of = 0; of < 2; ++of) {
        const double share = plan.version == bow_version::both                  ? 0.5
                             : (plan.version == bow_version::near) == (of == 0) ? 1.0
                                                                                : 0.0;
        detail::add_convolved(velocity, plan.near_field, -1, share, *force[of][input]);
      }
      if (version != input) continue;
      detail::add_convolved(velocity, plan.admittance, 1, 1, *back_and_out[input][0]);
      detail::add_convolved(velocity, plan.admittance, 1, -1, *back_and_out[input][1]);
    }
  return out;
}

/// Into fixed size. Fails where Taps, Line or Short do not hold the plan.
template <class T, std::size_t Taps, std::size_t Line, std::size_t Short>
[[nodiscard]] outcome<passage_coefficients<T, Taps, Short>> fixed_size(const passage_plan& plan) {
  const std::size_t longest = plan.longest(), half = plan.admittance.size() - 1, span = plan.span() + 3,
                    chunk = detail::passage_chunk<T>;
  if (longest > Taps)
    return failure{"a passage needs " + std::to_string(longest) + " taps, there is room for " + std::to_string(Taps)};
  if (half != Short)
    return failure{"the short filters have half-length " + std::to_string(half) + ", not " + std::to_string(Short)};
  if (span + chunk > Line)
    return failure{"the passages span " + std::to_string(span + chunk) + " frames with a chunk, the delay lines hold " +
                   std::to_string(Line)};
  passage_coefficients<T, Taps, Short> out;
  const auto to = [](double tap) { return static_cast<T>(tap); };
  out.version = plan.version;
  out.latency = static_cast<std::size_t>(plan.reach_ahead());
  out.reach = plan.span();
  const std::vector<double> admittance = plan.arrival_admittance(), near_field = plan.arrival_near_field();
  std::transform(admittance.begin(), admittance.end(), out.admittance.begin(), to);
  std::transform(near_field.begin(), near_field.end(), out.near_field.begin(), to);
  for (std::size_t p = 0; p < 4; ++p) {
    const std::vector<double> taps = plan.arrival_taps(p);
    out.passage[p].count = taps.size();
    out.passage[p].newest_age = plan.newest_age(p);
    std::transform(taps.begin(), taps.end(), out.passage[p].taps.begin(), to);
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
