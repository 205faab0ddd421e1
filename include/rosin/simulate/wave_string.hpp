// tier: hosted
// SPDX-License-Identifier: MIT
//
// The string in motion: line() says how its surface would move in the coming step under any force, apply() takes the
// force that the law of friction found. Echoes need time, so all they do is computed for a block of steps at once,
// as dense FIR sums (a far end's for longer blocks than a near one's); only the law and the near part of the string run step by
// step. Nothing is allocated while it runs.
//
#pragma once

#include <algorithm>
#include <span>
#include <utility>

#include <Eigen/Core>

#include <rosin/friction/friction_law.hpp>
#include <rosin/simulate/modal_contact.hpp>
#include <rosin/simulate/wave_kernels.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A signal whose past is kept as far as it is needed; indices count from the start of the run.
template <class T>
class wave_tape {
public:
  wave_tape() = default;
  wave_tape(std::ptrdiff_t past, std::ptrdiff_t ahead)
      : past_{past}, start_{-past}, data_(static_cast<std::size_t>(4 * past + 4 * ahead + 4096), T(0)) {}

  [[nodiscard]] T* at(std::ptrdiff_t i) noexcept { return data_.data() + (i - start_); }
  [[nodiscard]] const T* at(std::ptrdiff_t i) const noexcept { return data_.data() + (i - start_); }

  /// Makes room for indices below `end`, of which those from `now` - past on are kept; new ones are 0.
  void turn(std::ptrdiff_t now, std::ptrdiff_t end) noexcept {
    if (end - start_ <= static_cast<std::ptrdiff_t>(data_.size())) return;
    const auto drop = std::min(now - past_ - start_, static_cast<std::ptrdiff_t>(data_.size()));
    std::fill(std::move(data_.begin() + drop, data_.end(), data_.begin()), data_.end(), T(0));
    start_ += drop;
  }

private:
  std::ptrdiff_t past_ = 0, start_ = 0;
  std::vector<T> data_{};
};

namespace detail {

/// Sum of a[k] b[k].
template <class T>
[[nodiscard]] inline T dot(const T* a, const T* b, std::ptrdiff_t size) noexcept {
  using pack = Eigen::Array<T, 8, 1>;
  using map = Eigen::Map<const pack>;
  pack even = pack::Zero(), odd = pack::Zero();
  std::ptrdiff_t k = 0;
  for (; k + 16 <= size; k += 16) {
    even += map(a + k) * map(b + k);
    odd += map(a + k + 8) * map(b + k + 8);
  }
  for (; k + 8 <= size; k += 8) even += map(a + k) * map(b + k);
  const pack sum = even + odd;
  T total = ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
  for (; k < size; ++k) total += a[k] * b[k];
  return total;
}

/// out[i] += sum over k of taps[k] in[i - first - k], i = 0 ... count - 1.
template <class T>
inline void add_filtered(const wave_taps<T>& kernel, const T* in, T* out, std::ptrdiff_t count) noexcept {
  constexpr std::ptrdiff_t width = 16;
  using pack = Eigen::Array<T, width, 1>;
  using map = Eigen::Map<const pack>;
  const auto taps = static_cast<std::ptrdiff_t>(kernel.taps.size());
  const T* h = kernel.taps.data();
  const T* x = in - kernel.first;
  std::ptrdiff_t i = 0;
  for (; i + width <= count; i += width) {
    pack sum = map(out + i);
    for (std::ptrdiff_t k = 0; k < taps; ++k) sum += h[k] * map(x + i - k);
    Eigen::Map<pack>(out + i) = sum;
  }
  using half = Eigen::Array<T, width / 2, 1>;
  for (; i + width / 2 <= count; i += width / 2) {
    half sum = Eigen::Map<const half>(out + i);
    for (std::ptrdiff_t k = 0; k < taps; ++k) sum += h[k] * Eigen::Map<const half>(x + i - k);
    Eigen::Map<half>(out + i) = sum;
  }
  for (; i < count; ++i) out[i] += dot(kernel.backwards.data(), x + i - taps + 1, taps);
}

/// The same for every `stride`-th input: out[i] += sum taps[k] in[stride i - first - k].
template <class T>
inline void add_thinned(const wave_taps<T>& kernel, const T* in, std::ptrdiff_t stride, T* out, std::ptrdiff_t count) noexcept {
  for (std::ptrdiff_t i = 0; i < count; ++i)
    out[i] += dot(kernel.backwards.data(), in + stride * i - kernel.last(), static_cast<std::ptrdiff_t>(kernel.taps.size()));
}

}  // namespace detail

/// Velocities at the contact at the end of a step.
template <class T>
struct wave_state {
  T centre_m_s{}, torsion_m_s{};
};

template <class T = double>
class wave_string {
public:
  explicit wave_string(wave_kernels<T> kernels)
      : k_{std::move(kernels)}, wave_ahead_{k_.block / k_.stride + k_.far_block + k_.fill_ahead() +
                                            std::max(k_.echo[0].first, k_.echo[1].first) + 2},
        force_{thin_reach(), k_.block}, velocity_{0, std::max(k_.block, k_.far_block) +
                                                         static_cast<std::ptrdiff_t>(k_.local.size())},
        echoes_{k_.fill_ahead() + fill_back() + 8, wave_ahead_}, out_{tape(k_.reach_back()), tape(k_.reach_back())},
        heard_{tape(k_.reach_back()), tape(k_.reach_back())}, back_{tape(8), tape(8)} {
    begin_block();
  }

  /// The coming step as the law of friction sees it.
  [[nodiscard]] load_line<T> line(const rod_state& rod) const noexcept {
    return {*velocity_.at(now_) + turn_velocity(), mobility_, static_cast<T>(rod.velocity_m_s),
            static_cast<T>(rod.normal_force_N), static_cast<T>(k_.step_s)};
  }

  /// Ends the coming step with this force.
  wave_state<T> apply(T force_N) noexcept {
    const auto size = static_cast<Eigen::Index>(k_.local.size());
    T* velocity = velocity_.at(now_);
    Eigen::Map<row>(velocity, size) += force_N * Eigen::Map<const row>(k_.local.data(), size);
    const wave_state<T> state{*velocity, turn_velocity() + turn_mobility_ * force_N};
    *force_.at(now_) = force_N;
    if (turns_) k_.turn.advance(static_cast<double>(force_N));
    last_force_ = force_N;
    if (++now_ == block_end_) begin_block();
    return state;
  }

  /// Waves that have left for side j up to now, as a rigid end would have to hear them to feel the force that the end feels:
  /// values n ... waves() - 1 at the waves' rate; the last reach_back() are kept.
  [[nodiscard]] std::ptrdiff_t waves() const noexcept { return std::min(sent_[0], sent_[1]); }
  [[nodiscard]] T wave(std::size_t j, std::ptrdiff_t n) const noexcept {
    return *(k_.ends[j].moves() ? heard_[j] : out_[j]).at(n);
  }
  [[nodiscard]] const wave_kernels<T>& kernels() const noexcept { return k_; }
  [[nodiscard]] std::ptrdiff_t block() const noexcept { return k_.block; }
  [[nodiscard]] double step_s() const noexcept { return k_.step_s; }

private:
  using row = Eigen::Array<T, Eigen::Dynamic, 1>;

  [[nodiscard]] std::ptrdiff_t thin_reach() const noexcept {
    return k_.block + k_.far_block + 2 * k_.stride + 8 + (k_.thin.empty() ? 0 : 2 * k_.thin.last());
  }
  [[nodiscard]] std::ptrdiff_t fill_back() const noexcept {
    std::ptrdiff_t back = 0;
    for (const auto& phase : k_.fill) back = std::max(back, phase.last());
    return back;
  }
  [[nodiscard]] wave_tape<T> tape(std::ptrdiff_t past) const { return {past + 2 * wave_ahead_, 2 * wave_ahead_}; }
  [[nodiscard]] T turn_velocity() const noexcept {
    return turns_ ? static_cast<T>(k_.turn.free()) - k_.turn_rest * last_force_ : T(0);
  }

  void begin_block() noexcept {
    block_end_ = now_ + k_.block;
    make_room();
    if (k_.direct.empty()) {
      send();
      receive();
      fill_up();
    } else {
      send(k_.near, now_);
      if (now_ == far_end_) begin_far_block();
      detail::add_filtered(k_.direct, std::as_const(out_[k_.near]).at(now_), velocity_.at(now_), k_.block);
    }
  }

  /// Stride 1: what the near side sends to the far one, its echo, and what that does at the contact.
  void begin_far_block() noexcept {
    const std::size_t far = 1 - k_.near;
    far_end_ = now_ + k_.far_block;
    receive(k_.near, now_);
    send(far, now_);
    receive(far, sent_[far] + k_.echo[far].first);
    detail::add_filtered(k_.fill.front(), std::as_const(back_[far]).at(now_), velocity_.at(now_), k_.far_block);
  }

  /// Forces before `end`, which are known, leave for side j, together with what came back from the other.
  void send(std::size_t j, std::ptrdiff_t end) noexcept {
    const auto from = std::exchange(sent_[j], end);
    T* to = out_[j].at(from);
    const T *force = force_.at(from), *back = back_[1 - j].at(from);
    for (std::ptrdiff_t i = 0; i < end - from; ++i) to[i] = force[i] + back[i];
    if (k_.ends[j].moves()) meet(j, to, end - from, from);
  }

  void make_room() noexcept {
    const auto waves_end = block_end_ / k_.stride + 2 * wave_ahead_;
    force_.turn(now_, block_end_ + 1);
    velocity_.turn(now_, block_end_ + k_.far_block + static_cast<std::ptrdiff_t>(k_.local.size()) + 1);
    echoes_.turn(now_ / k_.stride, waves_end);
    for (std::size_t j = 0; j < 2; ++j) {
      out_[j].turn(waves(), waves_end);
      heard_[j].turn(waves(), waves_end);
      back_[j].turn(waves(), waves_end);
    }
  }

  /// The forces known by now leave to both sides, together with what came back from the other.
  void send() noexcept {
    const auto known = now_ - k_.look_ahead();  // forces before `now_` are known
    const auto end = known <= 0 ? 0 : (known - 1) / k_.stride + 1;
    const auto from = sent_[0], count = end - from;
    if (count <= 0) return;
    T* to[2] = {out_[0].at(from), out_[1].at(from)};
    if (k_.thin.empty()) std::copy_n(force_.at(from), count, to[0]);
    else {
      std::fill_n(to[0], count, T(0));
      detail::add_thinned(k_.thin, std::as_const(force_).at(from * k_.stride), k_.stride, to[0], count);
    }
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const T force = to[0][i];
      to[0][i] = force + *back_[1].at(from + i);
      to[1][i] = force + *back_[0].at(from + i);
    }
    for (std::size_t j = 0; j < 2; ++j)
      if (k_.ends[j].moves()) meet(j, to[j], count, from);
    sent_ = {end, end};
  }

  /// What a moving end makes of the waves that leave for it.
  void meet(std::size_t j, T* waves, std::ptrdiff_t count, std::ptrdiff_t from) noexcept {
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const auto [back, heard] = k_.ends[j](static_cast<double>(waves[i]));
      waves[i] = static_cast<T>(back);
      *heard_[j].at(from + i) = static_cast<T>(heard);
    }
  }

  /// Echoes as far ahead as the coming block needs them; the far side's, once more are needed, as far as they are known.
  void receive() noexcept {
    const auto now_end = (block_end_ - 1) / k_.stride + 1, end = now_end + k_.fill_ahead();
    const std::size_t far = 1 - k_.near;
    receive(k_.near, end);
    if (received_[far] < end) receive(far, std::max(end, sent_[far] + k_.echo[far].first));
    const T *near_back = back_[k_.near].at(summed_), *far_back = back_[far].at(summed_);
    T* sum = echoes_.at(summed_);
    for (std::ptrdiff_t i = 0; i < end - summed_; ++i) sum[i] = near_back[i] + far_back[i];
    summed_ = std::max(summed_, end);
  }
  void receive(std::size_t j, std::ptrdiff_t end) noexcept {
    const auto from = received_[j];
    received_[j] = std::max(from, end);
    if (end > from) detail::add_filtered(k_.echo[j], std::as_const(out_[j]).at(from), back_[j].at(from), end - from);
  }

  /// From the waves' rate to the contact's.
  void fill_up() noexcept {
    T* velocity = velocity_.at(now_);
    if (k_.stride == 1) return detail::add_filtered(k_.fill.front(), std::as_const(echoes_).at(now_), velocity, k_.block);
    const auto count = k_.block / k_.stride;
    for (std::size_t phase = 0; phase < k_.fill.size(); ++phase) {
      std::fill_n(scratch_.begin(), count, T(0));
      detail::add_filtered(k_.fill[phase], std::as_const(echoes_).at(now_ / k_.stride), scratch_.data(), count);
      for (std::ptrdiff_t i = 0; i < count; ++i)
        velocity[i * k_.stride + static_cast<std::ptrdiff_t>(phase)] += scratch_[static_cast<std::size_t>(i)];
    }
  }

  wave_kernels<T> k_;
  std::ptrdiff_t wave_ahead_ = 0, now_ = 0, block_end_ = 0, far_end_ = 0, summed_ = 0;
  std::array<std::ptrdiff_t, 2> sent_{}, received_{};
  wave_tape<T> force_, velocity_, echoes_;
  std::array<wave_tape<T>, 2> out_, heard_, back_;
  T turn_mobility_ = k_.turn_mobility_m_Ns(), mobility_ = k_.mobility_m_Ns(), last_force_ = 0;
  bool turns_ = k_.turn.mobility() > 0;
  std::vector<T> scratch_ = std::vector<T>(static_cast<std::size_t>(k_.block));
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
