// tier: hosted
// SPDX-License-Identifier: MIT
//
// A measured bridge admittance as a termination, made causal and passive. Of the table only the real part is taken, straight
// between its points, falling to nothing at 0 Hz and, as f^-4 would, above the last; a causal admittance follows from that alone
// (Kramers and Kronig):
//
//     Y(s) = (2 s / pi) integral_0^inf Re Y(w') / (s^2 + w'^2) dw',        Re s >= 0,
//
// in closed form for each straight piece. So it can neither answer early nor create energy, which a table with noise in it does.
// What the imaginary part says besides, of modes below and above the table, is one mass and one spring, fitted to the difference
// and kept where they are positive. What then still differs is noise or a fault of phase and is told (`mismatch`).
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/propagate/termination.hpp>

#include <span>
#include <string>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Y of a termination in m/s per N at one frequency.
struct measured_admittance {
  double frequency_Hz = 0;
  std::complex<double> m_sN;
};

/// A causal, passive completion of a table; relative to the string's impedance.
class table_termination {
public:
  using complex = std::complex<double>;

  [[nodiscard]] complex relative_admittance(double frequency_Hz) const {
    return at({1e-7 * std::abs(frequency_Hz) + 1e-6, 2 * std::numbers::pi * frequency_Hz});
  }
  /// At any s with a positive real part.
  [[nodiscard]] complex at(complex s) const {
    complex by_level = 0, by_slope = 0;
    const complex is(-s.imag(), s.real());
    for (std::size_t k = 1; k < w_.size(); ++k) {
      const double half = (w_[k] - w_[k - 1]) / 2, middle = w_[k - 1] + half, slope = (re_[k] - re_[k - 1]) / (2 * half),
                   level = re_[k] - slope * w_[k];
      const complex minus = log_ratio(middle - is, half), plus = log_ratio(middle + is, half);
      by_level += level * (minus - plus), by_slope += slope * (minus + plus);
    }
    return (by_level / complex(0, 1) + s * by_slope) / std::numbers::pi + beyond(s);
  }
  /// z at 0, step, 2 step, ... Hz, by two transforms: the even response of the real part, folded onto t > 0.
  template <class = void>
  [[nodiscard]] std::vector<complex> on_grid(double step_Hz, std::size_t count) const {
    std::size_t n = 1024;
    while (static_cast<double>(n) * step_Hz <
           16 * std::max(w_.back() / (2 * std::numbers::pi * 5), step_Hz * static_cast<double>(count)))
      n *= 2;
    std::vector<complex> bins(n), response(n);
    for (std::size_t k = 0, node = 1; k <= n / 2; ++k) {
      const double w = 2 * std::numbers::pi * step_Hz * static_cast<double>(k);
      while (node + 1 < w_.size() && w_[node] < w) ++node;
      if (w > w_.back()) break;
      bins[k] = bins[(n - k) % n] = re_[node - 1] + (re_[node] - re_[node - 1]) * (w - w_[node - 1]) / (w_[node] - w_[node - 1]);
    }
    eigen_fft<complex> fft(n);
    fft.inverse(bins.data(), response.data());
    for (std::size_t k = 1; k < n; ++k) response[k] *= k < n / 2 ? 2.0 : k == n / 2 ? 1.0 : 0.0;
    fft.forward(response.data(), bins.data());
    bins.resize(count);
    for (std::size_t k = 1; k < count; ++k) bins[k] += beyond({0, 2 * std::numbers::pi * step_Hz * static_cast<double>(k)});
    return bins;
  }
  [[nodiscard]] double memory_s() const noexcept { return memory_s_; }

  double mismatch = 0;        ///< rms of what differs from the table, over rms of the table
  double repaired = 0;        ///< negative real parts that were set to 0, their sum over that of all |Re Y|
  double spring_s = 0;        ///< Z times the compliance of what lies above the table
  double per_mass_per_s = 0;  ///< Z over the mass of what lies below

private:
  /// ln((m + h) / (m - h)): far from a piece by its series, to 1e-12 of it.
  [[nodiscard]] static complex log_ratio(complex m, double h) {
    const double square = m.real() * m.real() + m.imag() * m.imag();
    if (square < 400 * h * h) return std::log(m + h) - std::log(m - h);
    const double re = m.real() * h / square, im = -m.imag() * h / square, re2 = re * re - im * im,
                 im2 = 2 * re * im;             // q = h / m, q^2
    double a = 1.0 / 7 + re2 / 9, b = im2 / 9;  // 1 + q^2 (1/3 + q^2 (1/5 + q^2 (1/7 + q^2 / 9)))
    for (const double next : {1.0 / 5, 1.0 / 3, 1.0}) {
      const double up = next + a * re2 - b * im2;
      b = a * im2 + b * re2;
      a = up;
    }
    return {2 * (re * a - im * b), 2 * (re * b + im * a)};
  }
  friend outcome<table_termination> complete_admittance(std::span<const measured_admittance>, double, double);
  [[nodiscard]] complex beyond(complex s) const { return spring_s * s + (per_mass_per_s > 0 ? residual_mass()(s) : 0.0); }
  /// A mass to the table's eye; at 0 Hz it is held.
  [[nodiscard]] admittance_mode residual_mass() const { return {lowest_Hz_ / 4, 0.7, per_mass_per_s}; }

  std::vector<double> w_, re_;
  double memory_s_ = 0, lowest_Hz_ = 0;
};

/// Fails where the table is no table or is not passive: negative real parts that make up more than `forgive` of all.
[[nodiscard]] inline outcome<table_termination> complete_admittance(std::span<const measured_admittance> table,
                                                                    double impedance_Ns_m, double forgive = 0.3) {
  if (table.size() < 8) return failure{"an admittance needs 8 points at least"};
  double taken = 0, given = 0, lowest = 0, lowest_at = 0, closest = 1e300;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!(std::isfinite(table[k].m_sN.real()) && std::isfinite(table[k].m_sN.imag()) && table[k].frequency_Hz >= 0 &&
          (k == 0 || table[k].frequency_Hz > table[k - 1].frequency_Hz)))
      return failure{"point " + std::to_string(k + 1) +
                     " of the admittance: frequencies have to ascend and all values to be finite"};
    (table[k].m_sN.real() < 0 ? given : taken) += std::abs(table[k].m_sN.real());
    if (k > 0) closest = std::min(closest, table[k].frequency_Hz - table[k - 1].frequency_Hz);
    if (table[k].m_sN.real() < lowest) lowest = table[k].m_sN.real(), lowest_at = table[k].frequency_Hz;
  }
  if (given > forgive * (given + taken))
    return failure{"the admittance is not passive: its real part is " + number_text(lowest) + " m/s per N at " +
                   number_text(lowest_at) + " Hz; a termination takes energy (check sign, phase and columns)"};
  table_termination out;
  out.repaired = given > 0 ? given / (given + taken) : 0;
  out.memory_s_ = std::min(0.5, 2 / closest);
  out.lowest_Hz_ = std::max(table.front().frequency_Hz, closest);
  const auto add = [&](double f, double re) {
    out.w_.push_back(2 * std::numbers::pi * f), out.re_.push_back(impedance_Ns_m * std::max(0.0, re));
  };
  if (table.front().frequency_Hz > 0) add(0, 0);
  for (const measured_admittance& p : table) add(p.frequency_Hz, p.m_sN.real());
  const double last = table.back().frequency_Hz;
  for (const double above : {1.05, 1.12, 1.25, 1.5, 2.0, 3.0}) add(above * last, table.back().m_sN.real() * std::pow(above, -4));
  add(5 * last, 0);

  // Difference of the imaginary parts: a w - b / w, least squares over the table's inner three quarters, weighed evenly.
  double aa = 0, ab = 0, bb = 0, ad = 0, bd = 0, all = 0;
  std::vector<std::pair<double, double>> differ;  // w, difference
  const std::size_t stride = 1 + table.size() / 400;
  for (std::size_t k = 0; k < table.size(); k += stride) {
    const double w = 2 * std::numbers::pi * table[k].frequency_Hz,
                 d = impedance_Ns_m * table[k].m_sN.imag() - out.relative_admittance(table[k].frequency_Hz).imag();
    differ.emplace_back(w, d);
    all += std::norm(impedance_Ns_m * table[k].m_sN);
    if (w <= 0 || table[k].frequency_Hz > 0.75 * last) continue;
    aa += w * w, ab -= 1, bb += 1 / (w * w), ad += w * d, bd -= d / w;
  }
  const double det = aa * bb - ab * ab;
  double a = det > 0 ? (ad * bb - bd * ab) / det : 0, b = det > 0 ? (bd * aa - ad * ab) / det : 0;
  if (a < 0) a = 0, b = bb > 0 ? bd / bb : 0;
  if (b < 0) b = 0, a = std::max(0.0, ad / aa);
  out.spring_s = a, out.per_mass_per_s = b;
  double left = 0;
  for (const auto& [w, d] : differ) left += std::pow(d - a * w + (w > 0 ? b / w : 0.0), 2);
  out.mismatch = std::sqrt(left / std::max(1e-300, all));
  return out;
}

/// A termination by the impulse response of its reflection of velocity waves: r[n] at n / rate_Hz, sum about -1. z = (1 + R)/(1 -
/// R).
class reflection_termination {
public:
  [[nodiscard]] std::complex<double> relative_admittance(double frequency_Hz) const {
    return at({0, 2 * std::numbers::pi * frequency_Hz});
  }
  [[nodiscard]] std::complex<double> at(std::complex<double> s) const {
    const std::complex<double> step = std::exp(-s / rate_Hz_);
    std::complex<double> R = 0;
    for (std::size_t n = taps_.size(); n-- > 0;) R = R * step + taps_[n];
    return (1.0 + R) / (1.0 - R);
  }
  [[nodiscard]] double memory_s() const noexcept { return 4 * static_cast<double>(taps_.size()) / rate_Hz_; }

private:
  friend outcome<reflection_termination> reflecting_end(std::vector<double>, double);
  std::vector<double> taps_;
  double rate_Hz_ = 1;
};

/// Fails where more comes back than arrives.
[[nodiscard]] inline outcome<reflection_termination> reflecting_end(std::vector<double> taps, double rate_Hz) {
  if (taps.empty() || !(rate_Hz > 0)) return failure{"a reflection function needs samples and their rate"};
  reflection_termination out;
  out.taps_ = std::move(taps), out.rate_Hz_ = rate_Hz;
  const int points = 4 * static_cast<int>(out.taps_.size());
  for (int k = 0; k <= points; ++k) {
    const double f = 0.5 * rate_Hz * k / points;
    const std::complex<double> z = out.relative_admittance(f);
    const double reflected = std::abs((z - 1.0) / (z + 1.0));
    if (!(reflected < 1 + 1e-3))
      return failure{"the reflection function is not passive: " + number_text(reflected) +
                     " times as much as arrives comes back at " + number_text(f) + " Hz"};
  }
  return out;
}

static_assert(Termination<table_termination> && Termination<reflection_termination>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
