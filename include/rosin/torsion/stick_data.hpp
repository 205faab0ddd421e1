// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bowed takes of one rig, reconstructed, seen while the string sticks. Everything that is linear in the force (torsion, a rod
// that gives way, bristles that bend) becomes a column of samples; whatever else moves the surface is a column too. Of each
// record its middle is used: the stroke's start, in which the rod gathers speed, is left out; what the rod still lacks then
// (rod_approach.hpp) is the rod's.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/friction/slip_phases.hpp>
#include <rosin/torsion/contact_signal.hpp>
#include <rosin/torsion/rod_approach.hpp>
#include <rosin/torsion/stick_regression.hpp>

#include <array>
#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One reconstructed stroke. Samples that are not numbers may stand at both ends only.
struct stick_take {
  static constexpr double usual_start_s = 0.03;

  std::span<const double> force_N, velocity_m_s;  ///< at the contact; velocity of the string's centre
  double rate_Hz = 0;
  double rod_speed_m_s = 0;         ///< of the steady stroke, with its sign
  std::array<double, 2> delay_s{};  ///< transverse travel times from the contact to the ends
  double impedance_Ns_m = 0;        ///< transverse
  double velocity_sd_m_s = 0;       ///< noise of the reconstruction
  double edge_Hz = 0;               ///< where the reconstruction's band ends; 0: 0.45 of the rate
  /// left out at the beginning, a quarter of the record at most (half where that is longer than usual, or the rod lags)
  double start_s = usual_start_s;
  rod_approach approach{};  ///< to the rod's speed

  /// Through which it is seen while it sticks.
  [[nodiscard]] smooth_window window() const noexcept { return {edge_Hz > 0 ? edge_Hz : 0.45 * rate_Hz}; }
};

/// How a transfer function that rings changes: `per` times the difference of two. Through the same room, what that cuts off
/// cancels.
template <class Transfer>
struct transfer_slope {
  Transfer up, down;
  double per = 1;

  [[nodiscard]] std::complex<double> operator()(double f) const noexcept { return per * (up(f) - down(f)); }
  [[nodiscard]] double memory_s() const noexcept { return std::max(up.memory_s(), down.memory_s()); }
  [[nodiscard]] std::vector<std::complex<double>> on_grid(double step_Hz, std::size_t count) const requires requires {
    up.on_grid(step_Hz, count);
  }
  {
    auto out = up.on_grid(step_Hz, count);
    const auto less = down.on_grid(step_Hz, count);
    for (std::size_t k = 0; k < count; ++k) out[k] = per * (out[k] - less[k]);
    return out;
  }
};

/// A take with its force transformed and its velocity smoothed and taken against the rod.
class stick_record {
public:
  template <class = void>
  explicit stick_record(const stick_take& take)
      : take_{take}, begin_{first(take)}, force_{known(take.force_N), take.rate_Hz, usual_memory_s} {
    contact_signal<> velocity{known(take.velocity_m_s), take.rate_Hz};
    relative_ = velocity.through(window(), [](double) { return 1.0; });
    const std::vector<double> rod = rod_m_s();
    for (std::size_t i = 0; i < relative_.size(); ++i) relative_[i] -= rod[i];
  }

  /// The rod's speed at the known samples.
  [[nodiscard]] std::vector<double> rod_m_s() const {
    std::vector<double> out(relative_.size(), take_.rod_speed_m_s);
    for (std::size_t i = 0; take_.approach.seen() && i < out.size(); ++i)
      out[i] *= 1 - take_.approach.lag(static_cast<double>(begin_ + i) / take_.rate_Hz);
    return out;
  }
  /// What a take has of its own while it sticks: a level; and where its rod approaches its speed, the errors of that.
  [[nodiscard]] std::vector<std::vector<double>> rod_columns() const {
    std::vector<std::vector<double>> out(take_.approach.seen() ? 3 : 1, std::vector<double>(relative_.size(), 1.0));
    if (!take_.approach.seen()) return out;
    for (std::size_t i = 0; i < relative_.size(); ++i) {
      const double u = (static_cast<double>(i) - static_cast<double>(begin())) / (take_.rate_Hz * take_.approach.time_s);
      out[1][i] = std::exp(-std::max(0.0, u)), out[2][i] = u * out[1][i];
    }
    return out;
  }

  /// Known samples that count: all but the start and a reach of the window at the end.
  [[nodiscard]] std::size_t begin() const noexcept {
    const bool late = take_.approach.seen() || take_.start_s > stick_take::usual_start_s;
    return std::min(relative_.size() / (late ? 2 : 4), static_cast<std::size_t>(take_.start_s * take_.rate_Hz));
  }
  [[nodiscard]] std::size_t end() const noexcept { return relative_.size() - std::min(relative_.size(), reach()); }
  /// Index in the take's own arrays of the first known sample.
  [[nodiscard]] std::size_t origin() const noexcept { return begin_; }
  [[nodiscard]] std::size_t size() const noexcept { return relative_.size(); }
  [[nodiscard]] const stick_take& take() const noexcept { return take_; }
  [[nodiscard]] smooth_window window() const noexcept { return take_.window(); }
  [[nodiscard]] std::size_t reach() const noexcept { return window().reach(take_.rate_Hz); }

  /// The centre's velocity less the rod's, smoothed.
  [[nodiscard]] const std::vector<double>& relative_m_s() const noexcept { return relative_; }
  /// The force through a transfer function, smoothed. One that says how long it rings (memory_s, to a thousandth) finds so much
  /// room behind the record, four seconds at most: else its end would ring on at its beginning.
  template <class Transfer>
  [[nodiscard]] std::vector<double> force_through(const Transfer& transfer) {
    if constexpr (requires { transfer.memory_s(); }) {
      constexpr double longest_s = 4;
      const double needed_s = std::min(longest_s, transfer.memory_s());
      if (needed_s > 2 * usual_memory_s) {
        if (!roomy_ || needed_s > room_s_)
          room_s_ = std::min(longest_s, 1.5 * needed_s), roomy_.emplace(known(take_.force_N), take_.rate_Hz, room_s_ / 2);
        return roomy_->through(window(), transfer);
      }
    }
    return force_.through(window(), transfer);
  }
  /// The force, smoothed. Kept once made.
  [[nodiscard]] const std::vector<double>& force_N() {
    if (smooth_.empty()) smooth_ = force_through([](double) { return 1.0; });
    return smooth_;
  }
  /// Two columns for what the contact yields besides: compliance_unit s f, and the same times (frequency / corner)^2. Kept once
  /// made.
  static constexpr double compliance_unit = 1e-6, compliance_corner_Hz = 5e4;
  [[nodiscard]] const std::vector<std::vector<double>>& compliance() {
    if (!compliance_.empty()) return compliance_;
    const auto first = [](double f) { return std::complex<double>(0, 2 * std::numbers::pi * f * compliance_unit); };
    compliance_.push_back(force_through(first));
    compliance_.push_back(force_through([&](double f) { return first(f) * std::pow(f / compliance_corner_Hz, 2); }));
    return compliance_;
  }
  [[nodiscard]] std::span<const double> known(std::span<const double> samples) const {
    return samples.subspan(begin_, last(take_) - begin_);
  }

private:
  static constexpr double usual_memory_s = 0.03;  ///< half of what is kept free behind the record

  [[nodiscard]] static bool is_known(const stick_take& t, std::size_t i) {
    return std::isfinite(t.force_N[i]) && std::isfinite(t.velocity_m_s[i]);
  }
  [[nodiscard]] static std::size_t first(const stick_take& t) {
    std::size_t i = 0;
    while (i + 1 < t.force_N.size() && !is_known(t, i)) ++i;
    return i;
  }
  [[nodiscard]] static std::size_t last(const stick_take& t) {
    std::size_t i = std::min(t.force_N.size(), t.velocity_m_s.size());
    while (i > 1 && !is_known(t, i - 1)) --i;
    return i;
  }

  stick_take take_;
  std::size_t begin_;
  contact_signal<> force_;
  std::optional<contact_signal<>> roomy_{};
  double room_s_ = 0;
  std::vector<double> relative_, smooth_;
  std::vector<std::vector<double>> compliance_;
};

/// Samples of a record at which the string sticks if its surface moves as `relative_m_s` says; a window's reach inside.
/// `seen_through`: the window that `relative_m_s` was smoothed by, if it is not the record's.
[[nodiscard]] inline std::vector<char> sticking_samples(const stick_record& record, const std::vector<double>& relative_m_s,
                                                        const phase_options& options = {},
                                                        std::optional<smooth_window> seen_through = {}) {
  const auto phases = find_phases(std::span(relative_m_s).subspan(record.begin(), record.end() - record.begin()),
                                  record.take().rod_speed_m_s, options);
  const auto inside =
      interior(phases.sticks, record.end() - record.begin(), seen_through.value_or(record.window()).reach(record.take().rate_Hz));
  std::vector<char> all(record.size(), 0);
  std::copy(inside.begin(), inside.end(), all.begin() + static_cast<std::ptrdiff_t>(record.begin()));
  return all;
}

/// Picks every other of the marked samples of columns of samples: the window leaves no more than that of information.
template <class = void>
[[nodiscard]] stick_rows pick(const std::vector<char>& marked, const std::vector<double>& target,
                              const std::vector<std::vector<double>>& shared, const std::vector<std::vector<double>>& own) {
  stick_rows rows;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i] && i % 2 == 0) rows.sample.push_back(i);
  const auto n = static_cast<Eigen::Index>(rows.sample.size());
  const auto take = [&](const std::vector<double>& from, auto to) {
    for (Eigen::Index i = 0; i < n; ++i) to[i] = from[rows.sample[static_cast<std::size_t>(i)]];
  };
  rows.target.resize(n);
  rows.shared.resize(n, static_cast<Eigen::Index>(shared.size()));
  rows.own.resize(n, static_cast<Eigen::Index>(own.size()));
  take(target, rows.target.segment(0, n));
  for (std::size_t c = 0; c < shared.size(); ++c) take(shared[c], rows.shared.col(static_cast<Eigen::Index>(c)));
  for (std::size_t c = 0; c < own.size(); ++c) take(own[c], rows.own.col(static_cast<Eigen::Index>(c)));
  return rows;
}
ROSIN_INSTANTIATE(stick_rows pick(const std::vector<char>&, const std::vector<double>&, const std::vector<std::vector<double>>&,
                                  const std::vector<std::vector<double>>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
