// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where are the partials? One spectrum of the first second or so after the attack, and a model of where to look that learns.
//
// Start: the pair (f0, b) whose first eight partials, all together, stand highest above the noise around them, f0 within a few
// per cent of the nominal value. Then upwards: each partial is sought where those below foretell it, in a window as wide as
// the forecast is unsure, and joins the fit. So the inharmonicity is learnt while the windows are still narrow enough to
// tell neighbours apart. The spectrum's window rises in a tenth of its length and falls over the rest, so that high partials,
// which die at once, are not lost in the foot of a symmetric one.
//
#pragma once

#include <rosin/calibrate/pickup_pitch.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/fft.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct found_partials {
  double fundamental_Hz = 0, inharmonicity = 0;
  std::vector<numbered_frequency> partials;
  double bin_Hz = 0;
};

namespace detail {

/// Power spectrum with peaks and the noise around them.
class peak_finder {
public:
  struct peak {
    double frequency_Hz, power;
  };

  template <class = void>
  peak_finder(std::span<const double> x, double rate_Hz, double spacing_Hz) : spacing_Hz_{spacing_Hz} {
    const std::size_t n = fast_size(2 * x.size());
    bin_Hz_ = rate_Hz / static_cast<double>(n);
    std::vector<double> windowed(n, 0.0);
    const double rise = 0.1 * static_cast<double>(x.size()), fall = static_cast<double>(x.size()) - rise;
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double t = static_cast<double>(j) + 0.5;
      const double phase = t < rise ? 1 - t / rise : (t - rise) / fall;
      windowed[j] = x[j] * (0.5 + 0.5 * std::cos(std::numbers::pi * phase));
    }
    std::vector<std::complex<double>> bins(n / 2 + 1);
    eigen_fft<double>{n}.forward(windowed.data(), bins.data());
    for (const auto& b : bins) power_.push_back(std::norm(b));
    find_floor();
    find_peaks();
  }

  [[nodiscard]] double bin_Hz() const noexcept { return bin_Hz_; }
  [[nodiscard]] double top_Hz() const noexcept { return bin_Hz_ * static_cast<double>(power_.size() - 2); }

  /// Mean power of the noise at a frequency: from the median over one spacing around it.
  [[nodiscard]] double floor_at(double f) const {
    const auto i = static_cast<std::size_t>(std::max(f, 0.0) / (spacing_Hz_ / 4));
    return floor_[std::min(i, floor_.size() - 1)];
  }

  /// The strongest peak in a range. A peak is the highest bin within 0.15 spacings, and stands above the noise.
  [[nodiscard]] std::optional<peak> strongest(double low_Hz, double high_Hz) const {
    const auto below = [](const peak& p, double f) { return p.frequency_Hz < f; };
    std::optional<peak> best;
    for (auto p = std::lower_bound(peaks_.begin(), peaks_.end(), low_Hz, below); p != peaks_.end() && p->frequency_Hz <= high_Hz;
         ++p)
      if (!best || p->power > best->power) best = *p;
    return best;
  }

private:
  void find_floor() {
    const auto half = std::max<std::size_t>(4, static_cast<std::size_t>(spacing_Hz_ / 2 / bin_Hz_));
    for (double f = 0; f < bin_Hz_ * static_cast<double>(power_.size()); f += spacing_Hz_ / 4) {
      const auto k = static_cast<std::size_t>(f / bin_Hz_);
      const std::size_t a = k > half ? k - half : 1, b = std::min(k + half, power_.size());
      std::vector<double> near(power_.begin() + static_cast<std::ptrdiff_t>(std::min(a, b - 1)),
                               power_.begin() + static_cast<std::ptrdiff_t>(b));
      const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
      std::nth_element(near.begin(), middle, near.end());
      floor_.push_back(*middle / 0.693 + 1e-300);
    }
  }

  void find_peaks() {
    const auto reach = std::max<std::size_t>(2, static_cast<std::size_t>(0.15 * spacing_Hz_ / bin_Hz_));
    for (std::size_t k = 1; k + 1 < power_.size(); ++k) {
      if (power_[k] < power_[k - 1] || power_[k] < power_[k + 1]) continue;
      if (power_[k] < peak_over_floor * floor_at(static_cast<double>(k) * bin_Hz_)) continue;
      const auto from = power_.begin() + static_cast<std::ptrdiff_t>(k > reach ? k - reach : 0);
      const auto to = power_.begin() + static_cast<std::ptrdiff_t>(std::min(k + reach + 1, power_.size()));
      if (*std::max_element(from, to) > power_[k]) continue;
      const auto level = [&](std::size_t i) { return std::log(power_[i] + 1e-300); };  // a parabola through three logarithms
      const double curve = level(k - 1) - 2 * level(k) + level(k + 1);
      const double shift = curve < 0 ? std::clamp((level(k - 1) - level(k + 1)) / (2 * curve), -0.5, 0.5) : 0.0;
      peaks_.push_back({(static_cast<double>(k) + shift) * bin_Hz_, power_[k]});
    }
  }

  static constexpr double peak_over_floor = 20;  // exp(-20) a bin by chance

  double spacing_Hz_, bin_Hz_ = 0;
  std::vector<double> power_, floor_;
  std::vector<peak> peaks_;
};

inline double partials_stand_out(const peak_finder& peaks, double f0, double b) {
  double sum = 0;
  for (int n = 1; n <= 8; ++n) {
    const double f = partial_frequency(f0, b, n), near = 0.003 * f + peaks.bin_Hz();
    const auto peak = peaks.strongest(f - near, f + near);
    if (!peak) continue;
    const double off = (peak->frequency_Hz - f) / near;
    sum += (1 - off * off) * std::min(std::log(peak->power / peaks.floor_at(f)), 9.0);
  }
  return sum;
}

/// The pair (f0, b) to begin with.
inline std::array<double, 2> likeliest_pitch(const peak_finder& peaks, double nominal_Hz, double range) {
  std::array<double, 2> best{nominal_Hz, 0};
  double highest = -1;
  for (double ratio = 1 - range; ratio < 1 + range; ratio += 0.001)
    for (const double b : {0.0, 5e-5, 1e-4, 2e-4, 4e-4, 8e-4, 1.6e-3}) {
      const double value = partials_stand_out(peaks, nominal_Hz * ratio, b) - 1e-3 * std::abs(ratio - 1);
      if (value > highest) highest = value, best = {nominal_Hz * ratio, b};
    }
  return best;
}

}  // namespace detail

/// range: how far f0 may be from the nominal value, as a part of it. Finds nothing (no partials) in noise.
template <class = void>
[[nodiscard]] found_partials find_partials(std::span<const double> x, double rate_Hz, double nominal_Hz, double range,
                                           int at_most) {
  const detail::peak_finder peaks{x, rate_Hz, nominal_Hz};
  const auto [first, stiff] = detail::likeliest_pitch(peaks, nominal_Hz, range);
  found_partials found{first, stiff, {}, peaks.bin_Hz()};
  double unsure = 0.004;  // of a forecast, as a part of the frequency
  robust_fit fit;
  for (int n = 1, missed = 0; n <= at_most && missed < 9; ++n) {
    const double f = partial_frequency(found.fundamental_Hz, found.inharmonicity, n);
    if (f + found.fundamental_Hz / 2 > 0.97 * peaks.top_Hz()) break;
    const double wide = fit.used >= 4 ? 4 * std::hypot(predicted_sd(fit, n), fit.scatter) + 0.0005 * f : unsure * f;
    const double reach = std::min(wide + 2 * peaks.bin_Hz(), 0.3 * found.fundamental_Hz);
    const auto peak = peaks.strongest(f - reach, f + reach);
    if (!peak) {
      ++missed;
      continue;
    }
    missed = 0;
    found.partials.push_back({n, peak->frequency_Hz, std::hypot(peaks.bin_Hz() / 2, 0.002 * nominal_Hz)});
    if (found.partials.size() < 4) continue;
    fit = fit_pitch(found.partials, found.fundamental_Hz, found.inharmonicity);
    found.fundamental_Hz = fit.value[0];
    found.inharmonicity = fit.value[1];
  }
  return found;
}
ROSIN_INSTANTIATE(found_partials find_partials(std::span<const double>, double, double, double, int))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
