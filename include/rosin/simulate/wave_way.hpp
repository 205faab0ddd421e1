// tier: hosted
// SPDX-License-Identifier: MIT
//
// A contact that travels, for waves: the string itself stays, so its waves are counted at its ends, and the way between an end
// and the contact, x long, is a kernel that changes from step to step,
//
//     H = exp(-gamma x)  from a force to the end,      G = H E sinc^2  from the end to the velocity,   E = 1 / (2 Z_f)
//
// (wave_kernels.hpp). Both are tabulated over the way, finely enough that a straight line between two rows is right to 3e-3 at
// the band's edge and 1e-4 at a fifth of it.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <rosin/simulate/wave_echo.hpp>
#include <rosin/simulate/wave_local.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Part of the string that a contact keeps to, as distances from the near end / length.
struct contact_range {
  double least = 0.3, most = 0.3;
};

/// A kernel somewhere on the way: taps a + weight (b - a) for lags first, first + 1, ...
template <class T>
struct way_taps {
  const T *a = nullptr, *b = nullptr;
  T weight = 0;
  std::ptrdiff_t first = 0, size = 0;

  /// to[lag] += value * tap.
  void scatter(T value, T* to) const noexcept {
    Eigen::Map<row>(to + first, size) +=
        (value * (1 - weight)) * Eigen::Map<const row>(a, size) + (value * weight) * Eigen::Map<const row>(b, size);
  }
  /// Sum of tap * from[-lag]; for rows in turned order.
  [[nodiscard]] T gather(const T* from) const noexcept {
    const Eigen::Map<const row> past(from - first - size + 1, size);
    return (1 - weight) * (Eigen::Map<const row>(a, size) * past).sum() + weight * (Eigen::Map<const row>(b, size) * past).sum();
  }

  /// to[lag] += tap; for rows in turned order.
  void spread(T* to) const noexcept {
    for (std::ptrdiff_t k = 0; k < size; ++k) to[first + k] += (1 - weight) * a[size - 1 - k] + weight * b[size - 1 - k];
  }

private:
  using row = Eigen::Array<T, Eigen::Dynamic, 1>;
};

/// H and G between the contact and one end.
template <class T = double>
class wave_way {
public:
  wave_way() = default;
  /// For distances least ... most from the end, as shares of the length. Precondition: 0 < least <= most < 1.
  wave_way(const string_parameters& string, double least, double most, const band& limits, double rate_Hz)
      : steps_{rate_Hz / (2 * string.fundamental_Hz)}, least_{least * steps_}, parts_{std::ceil(2 * std::numbers::pi *
                                                                                                limits.pass_Hz /
                                                                                                (0.15 * rate_Hz))} {
    const double longest = most * steps_;
    // less, and a held string may grow
    const passage_span span{
        least_, longest, string.stiffness_s2(), limits, rate_Hz, string.loss.inverse_q(string.fundamental_Hz) / 2, 800};
    first_ = std::max<std::ptrdiff_t>(1, static_cast<std::ptrdiff_t>(span.first));
    size_ = static_cast<std::ptrdiff_t>(std::ceil(std::max(span.last, longest + 0.2 * steps_))) - first_ + 1;
    rows_ = static_cast<std::ptrdiff_t>(std::ceil((longest - least_) * parts_)) + 2;
    for (std::ptrdiff_t i = 0; i < rows_; ++i) append(string, least_ + static_cast<double>(i) / parts_, limits, rate_Hz);
  }
  /// In another scalar.
  template <class U>
  explicit wave_way(const wave_way<U>& w)
      : steps_{w.steps_}, least_{w.least_}, parts_{w.parts_}, first_{w.first_}, size_{w.size_}, rows_{w.rows_},
        to_end_(w.to_end_.begin(), w.to_end_.end()), back_(w.back_.begin(), w.back_.end()) {}

  /// At a distance from the end, share of the length; beyond the way it is that of the way's end. Precondition: not empty.
  [[nodiscard]] way_taps<T> to_end(double distance) const noexcept { return at(to_end_, distance); }
  [[nodiscard]] way_taps<T> back(double distance) const noexcept { return at(back_, distance); }

  [[nodiscard]] bool empty() const noexcept { return rows_ == 0; }
  [[nodiscard]] std::ptrdiff_t first() const noexcept { return first_; }  ///< least lag of any kernel
  [[nodiscard]] std::ptrdiff_t last() const noexcept { return first_ + size_ - 1; }

private:
  template <class>
  friend class wave_way;

  void append(const string_parameters& string, double steps, const band& limits, double rate_Hz) {
    const pinned_echo echo{{steps / rate_Hz, string.stiffness_s2(), string.loss}, string.fundamental_Hz};
    const auto wanted = [&](double f) {
      const double w = 2 * std::numbers::pi * f;
      const std::complex<double> pass = -echo(f);
      return std::array<std::complex<double>, 2>{pass, pass * (wave_mobility(string, w) * straight_line_weight(w, 1 / rate_Hz))};
    };
    auto [to_end, back] = sample_responses(wanted, limits, rate_Hz, static_cast<int>(first_), static_cast<int>(last()));
    hold_at_rest(to_end, 1, steps);
    hold_at_rest(back, wave_mobility(string, 0), steps);
    to_end_.insert(to_end_.end(), to_end.taps.begin(), to_end.taps.end());
    back_.insert(back_.end(), back.taps.rbegin(), back.taps.rend());
  }

  [[nodiscard]] way_taps<T> at(const std::vector<T>& table, double distance) const noexcept {
    const double place = std::fmin(std::fmax((distance * steps_ - least_) * parts_, 0.0), static_cast<double>(rows_ - 2)),
                 whole = std::floor(place);
    const T* a = table.data() + static_cast<std::ptrdiff_t>(whole) * size_;
    return {a, a + size_, static_cast<T>(place - whole), first_, size_};
  }

  double steps_ = 0, least_ = 0, parts_ = 1;  // steps for the whole length; for the least distance; rows for a step
  std::ptrdiff_t first_ = 0, size_ = 0, rows_ = 0;
  std::vector<T> to_end_{}, back_{};
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
