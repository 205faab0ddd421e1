// tier: hosted
// SPDX-License-Identifier: MIT
//
// The travelling-wave string under a contact that travels, too: move_to() says where it is, line() how the surface would move in
// the coming step, apply() takes the force. What the ends send is known a little ahead, for the time that waves take to the
// contact. Nothing is allocated while it runs.
//
#pragma once

#include <rosin/simulate/modal_bank.hpp>
#include <rosin/simulate/travelling_design.hpp>
#include <rosin/simulate/wave_string.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Torsion of the surface at a contact that travels: partials, and the compliance of those left out (as in modal_contact.hpp).
class travelling_turn {
public:
  template <class = void>
  travelling_turn(const travelling_design& d, double position)
      : modes_{d.turn, damping_convention::viscous, {position}, d.kernels.step_s},
        stiffness_N_m_{d.turn_stiffness_N_m}, step_s_{d.kernels.step_s}, present_{!d.turn.empty()} {
    rest_before_ = rest_ = rest_at(position);
  }

  template <class = void>
  void move_to(double position) noexcept {
    if (!present_) return;
    modes_.move_to({position});
    const double rest = rest_at(position);
    rest_before_ = (rest_ + rest) / 2;
    rest_ = rest;
  }
  /// Velocity at the end of the step under way if no force acts there, and for 1 N.
  template <class = void>
  [[nodiscard]] double free() const noexcept {
    return modes_.free().velocity[0] - rest_before_ * force_;
  }
  template <class = void>
  [[nodiscard]] double mobility() const noexcept {
    return modes_.mobility(0, 0) + rest_;
  }
  template <class = void>
  void advance(double force_N) noexcept {
    if (!present_) return;
    modes_.advance({force_N});
    force_ = force_N, rest_before_ = rest_;
  }

private:
  template <class = void>
  [[nodiscard]] double rest_at(double x) const noexcept {
    return present_ ? (x * (1 - x) / stiffness_N_m_ - modes_.compliance(0)) / step_s_ : 0;
  }

  modal_bank<1> modes_;
  double stiffness_N_m_, step_s_, rest_ = 0, rest_before_ = 0, force_ = 0;
  bool present_;
};

template <class T = double>
class travelling_string {
public:
  travelling_string(const travelling_design& d, double position)
      : k_{d.kernels}, range_{d.range}, turn_{d, std::fmin(std::fmax(position, d.range.least), d.range.most)},
        velocity_{0, k_.block() + static_cast<std::ptrdiff_t>(k_.local.size())}, arrived_{tape(), tape()}, sent_{tape(), tape()},
        heard_{tape(), tape()} {
    begin_block();
    move_to(position);
  }

  /// Where the contact is from the end of the last step on, distance from the near end / length: to be said before line(), in
  /// every step. Returns where it is: it is held within the range of the design.
  double move_to(double position) noexcept {
    position = std::fmin(std::fmax(position, range_.least), range_.most);
    const std::array<double, 2> distance{position, 1 - position};
    echo_ = 0;
    for (std::size_t j = 0; j < 2; ++j) {
      to_end_[j] = k_.way[j].to_end(distance[j]);
      echo_ -= k_.way[j].back(distance[j]).gather(std::as_const(sent_[j]).at(now_));
    }
    turn_.move_to(position);
    return position;
  }

  [[nodiscard]] load_line<T> line(const rod_state& rod) const noexcept {
    return {*velocity_.at(now_) + echo_ + static_cast<T>(turn_.free()), k_.local.front() + static_cast<T>(turn_.mobility()),
            static_cast<T>(rod.velocity_m_s), static_cast<T>(rod.normal_force_N), static_cast<T>(k_.step_s)};
  }

  wave_state<T> apply(T force_N) noexcept {
    const auto size = static_cast<Eigen::Index>(k_.local.size());
    T* velocity = velocity_.at(now_);
    Eigen::Map<row>(velocity, size) += force_N * Eigen::Map<const row>(k_.local.data(), size);
    const wave_state<T> state{*velocity + echo_, static_cast<T>(turn_.free() + turn_.mobility() * static_cast<double>(force_N))};
    for (std::size_t j = 0; j < 2; ++j) to_end_[j].scatter(force_N, arrived_[j].at(now_));
    turn_.advance(static_cast<double>(force_N));
    if (++now_ == block_end_) begin_block();
    return state;
  }

  /// Waves that have arrived at end j up to now, as a rigid end would have to hear them to feel the force that the end feels:
  /// values n ... waves() - 1, one a step.
  [[nodiscard]] std::ptrdiff_t waves() const noexcept { return met_; }
  [[nodiscard]] T wave(std::size_t j, std::ptrdiff_t n) const noexcept { return *heard_[j].at(n); }
  [[nodiscard]] std::ptrdiff_t block() const noexcept { return k_.block(); }
  [[nodiscard]] double step_s() const noexcept { return k_.step_s; }

private:
  using row = Eigen::Array<T, Eigen::Dynamic, 1>;

  [[nodiscard]] wave_tape<T> tape() const {
    const auto past = std::max({k_.loop[0].last(), k_.loop[1].last(), k_.way[0].last(), k_.way[1].last()}) + k_.loop_block();
    return {past, past};
  }

  void begin_block() noexcept {
    block_end_ = now_ + k_.block();
    velocity_.turn(now_, block_end_ + static_cast<std::ptrdiff_t>(k_.local.size()) + 1);
    for (std::size_t j = 0; j < 2; ++j)
      for (auto* t : {&arrived_[j], &sent_[j], &heard_[j]})
        t->turn(now_, now_ + std::max({k_.way[0].last(), k_.way[1].last(), k_.loop_block()}) + k_.block() + k_.ahead() + 1);
    const auto known = now_ + k_.ahead();  // what comes later may still come from a force to come
    for (std::size_t j = 0; j < 2; ++j) meet(j, known);
    met_ = known;
    if (now_ == loop_end_) go_round();
  }

  void meet(std::size_t j, std::ptrdiff_t end) noexcept {
    const T* arrived = std::as_const(arrived_[j]).at(met_);
    T *sent = sent_[j].at(met_), *heard = heard_[j].at(met_);
    if (!k_.ends[j].moves()) {
      std::copy_n(arrived, end - met_, sent);
      std::copy_n(arrived, end - met_, heard);
      return;
    }
    for (std::ptrdiff_t i = 0; i < end - met_; ++i) {
      const auto [back, felt] = k_.ends[j](static_cast<double>(arrived[i]));
      sent[i] = static_cast<T>(back), heard[i] = static_cast<T>(felt);
    }
  }

  /// What the ends have sent arrives at the others, for some blocks to come.
  void go_round() noexcept {
    loop_end_ = now_ + k_.loop_block();
    const auto end = loop_end_ + k_.ahead(), from = std::exchange(round_, end);
    for (std::size_t j = 0; j < 2; ++j)
      detail::add_filtered(k_.loop[j], std::as_const(sent_[j]).at(from), arrived_[1 - j].at(from), end - from);
  }

  travelling_kernels<T> k_;
  contact_range range_;
  travelling_turn turn_;
  std::ptrdiff_t now_ = 0, block_end_ = 0, loop_end_ = 0, met_ = 0, round_ = 0;
  std::array<way_taps<T>, 2> to_end_{};
  T echo_ = 0;
  wave_tape<T> velocity_;
  std::array<wave_tape<T>, 2> arrived_, sent_, heard_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
