// tier: freestanding
// SPDX-License-Identifier: MIT
//
// The reconstruction sample by sample or block by block at less than half the work of streaming_reconstructor.hpp, for live use
// and firmware: each of the four passages is filtered once, and both forces and both velocities are made of the four.
//
//     near --+--> G/D1 --> a1       force_near = a1 + b2      velocity_near = y * (a1 - b1) + n * force
//            +--> G D1 --> b1       force_far  = a2 + b1      velocity_far  = y * (a2 - b2) + n * force
//     far  --+--> G/D2 --> a2
//            +--> G D2 --> b2     y = 1/(2 Z_f): even in time, short;   n, the near field: odd, short;   force: the mean
//
// The force is that of the whole-record reconstruction to rounding, the velocity too but for the error that y and n were designed
// for. Fixed size, no heap, no libm. One version of the force alone, bow_version::near or far, asks for less look-ahead:
//
//     latency = reach of 1/D_j ahead + Short,    of 1/D_j: its transit time + half a kernel;    both versions: the longer one
//
// No less will do: before a transit time has passed no end knows of the contact, and half a kernel is what the band costs.
//
#pragma once

#include <rosin/math/lanes.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>

namespace rosin {

/// Which of the two versions of force and velocity is made; of one alone both fields of a frame hold it.
enum class bow_version { both, near, far };

/// Everything the run-time part has to be given (passage_design.hpp, or the header that `rosin fit --emit-header` writes). Taps stand in
/// order of arrival, oldest sample first; where their number is no multiple of 4, zeros stand before them.
template <class T, std::size_t Taps, std::size_t Short>
struct passage_coefficients {
  static constexpr std::size_t short_taps = (2 * Short + 4) / 4 * 4;
  std::array<streaming_kernel<T, Taps>, 4> passage{};           ///< near back, near out, far back, far out
  std::array<T, short_taps> admittance{}, near_field{};         ///< y and n, 2 Short + 1 taps each
  std::size_t latency = 0;                                      ///< frames
  std::size_t reach = 0;                                        ///< frames that one output depends on
  bow_version version = bow_version::both;
};

/// The latest Length frames of some signals; each is kept twice in a row, so that a stretch of it never wraps.
template <class T, std::size_t Signals, std::size_t Length>
class doubled_lines {
public:
  template <std::size_t Count>
  constexpr void push(const std::array<std::array<T, Count>, Signals>& frames) noexcept {
    const std::size_t start = head_ + 1;
    if (start + Count <= Length)
      for (std::size_t s = 0; s < Signals; ++s) copy(frames[s], line_[s].data() + start);
    else
      for (std::size_t i = 0, at = start; i < Count; ++i, ++at)
        for (std::size_t s = 0; s < Signals; ++s) {
          at = at >= Length ? 0 : at;
          line_[s][at] = line_[s][at + Length] = frames[s][i];
        }
    head_ = start + Count <= Length ? head_ + Count : head_ + Count - Length;
  }
  /// The sample that is `age` frames old, < Length; those after it follow.
  [[nodiscard]] constexpr const T* at(std::size_t signal, std::size_t age) const noexcept {
    return line_[signal].data() + head_ + Length - age;
  }

private:
  template <std::size_t Count>
  static constexpr void copy(const std::array<T, Count>& from, T* to) noexcept {
#pragma GCC unroll 16
    for (std::size_t i = 0; i < Count; ++i) to[i] = to[i + Length] = from[i];
  }

  std::array<std::array<T, 2 * Length>, Signals> line_{};
  std::size_t head_ = 0;
};

namespace detail {

/// Outputs of one run over the taps: what the registers hold, four sums at least.
template <class T>
inline constexpr std::size_t passage_chunk = register_lanes<T> < 4 ? 8 : 16;

template <class Vector, class T>
[[nodiscard]] Vector load_lanes(const T* from) noexcept {
  if constexpr (std::is_same_v<Vector, T>) return *from;
  else {
    Vector x;
    std::memcpy(&x, from, sizeof x);
    return x;
  }
}

/// Taps of one frame's sums are padded to a multiple of this, so that no register is left half full.
template <class T>
inline constexpr std::size_t passage_quantum = register_lanes<T> < 4 ? 4 : register_lanes<T>;

/// The sum of a register's lanes.
template <class T, std::size_t Count>
[[nodiscard]] T sum_of_lanes(const typename lanes_of<T, Count>::type& v) noexcept {
  if constexpr (Count == 1) return v;
  else if constexpr (Count == 2) return v[0] + v[1];
  else {
    using half = typename lanes_of<T, Count / 2>::type;
    const auto [low, high] = [&]<std::size_t... I>(std::index_sequence<I...>) {
      return std::array<half, 2>{__builtin_shufflevector(v, v, I...), __builtin_shufflevector(v, v, (I + Count / 2)...)};
    }(std::make_index_sequence<Count / 2>{});
    return sum_of_lanes<T, Count / 2>(low + high);
  }
}

/// sum_j taps[j] x[j]; count is a multiple of passage_quantum.
template <class T>
[[nodiscard]] T passage_dot(const T* taps, const T* x, std::size_t count) noexcept {
  constexpr std::size_t width = register_lanes<T>, sums = width == 1 ? 4 : 2, step = sums * width;
  using vector = typename lanes_of<T, width>::type;
  std::array<vector, sums> sum{};
  std::size_t j = 0;
  for (; j + step <= count; j += step)
#pragma GCC unroll 4
    for (std::size_t p = 0; p < sums; ++p) sum[p] += load_lanes<vector>(taps + j + p * width) * load_lanes<vector>(x + j + p * width);
  if (j < count) sum[0] += load_lanes<vector>(taps + j) * load_lanes<vector>(x + j);
  if constexpr (sums == 4) return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  else return sum_of_lanes<T, width>(sum[0] + sum[1]);
}

/// Moves a window of `count` samples on by one, `newest` behind them, and shows use(j, register) what is in it from j on.
template <class T, class Use>
void shift_in(T* window, std::size_t count, T newest, Use use) noexcept {
  constexpr std::size_t width = register_lanes<T>;
  using vector = typename lanes_of<T, width>::type;
  vector now = load_lanes<vector>(window);
  for (std::size_t j = 0; j < count; j += width) {
    vector next{};
    if (j + width < count) next = load_lanes<vector>(window + j + width);
    else if constexpr (width == 1) next = newest;
    else next[0] = newest;
    if constexpr (width == 1) now = next;
    else
      now = [&]<std::size_t... I>(std::index_sequence<I...>) { return __builtin_shufflevector(now, next, (I + 1)...); }(std::make_index_sequence<width>{});
    std::memcpy(window + j, &now, sizeof now);
    use(j, now);
    now = next;
  }
}

/// The same for x, x + 1, ...: a chunk of outputs at once, each tap fetched once.
template <class T>
void passage_fir(const T* taps, const T* x, std::size_t count, T* out) noexcept {
  constexpr std::size_t width = register_lanes<T> < passage_chunk<T> ? register_lanes<T> : passage_chunk<T>;
  constexpr std::size_t parts = passage_chunk<T> / width, sets = parts >= 4 ? 1 : 4 / parts;
  using vector = typename lanes_of<T, width>::type;
  std::array<std::array<vector, parts>, sets> sum;
#pragma GCC unroll 4
  for (std::size_t s = 0; s < sets; ++s)
#pragma GCC unroll 16
    for (std::size_t p = 0; p < parts; ++p) sum[s][p] = vector{};
  for (std::size_t j = 0; j < count; j += 4)
#pragma GCC unroll 4
    for (std::size_t t = 0; t < 4; ++t)
#pragma GCC unroll 16
      for (std::size_t p = 0; p < parts; ++p) sum[t % sets][p] += taps[j + t] * load_lanes<vector>(x + j + t + p * width);
  for (std::size_t s = 1; s < sets; ++s)
    for (std::size_t p = 0; p < parts; ++p) sum[0][p] += sum[s][p];
#pragma GCC unroll 16
  for (std::size_t p = 0; p < parts; ++p) std::memcpy(out + p * width, &sum[0][p], sizeof(vector));
}

}  // namespace detail

/// T: float or double. Taps: longest passage, a multiple of 4. Line: length of the delay lines. Short: half-length of y and n.
template <class T, std::size_t Taps, std::size_t Line, std::size_t Short>
class passage_reconstructor {
public:
  using input_type = termination_frame<T>;
  using output_type = bow_frame<T>;
  using coefficients_type = passage_coefficients<T, Taps, Short>;
  /// Frames that are computed together where a block holds as many.
  static constexpr std::size_t chunk = detail::passage_chunk<T>;
  static_assert(Taps % 4 == 0, "kernels are run four taps at a time");

  constexpr explicit passage_reconstructor(const coefficients_type& c) noexcept
      : admittance_{padded<short_room>(c.admittance, short_taps)}, near_field_{padded<short_room>(c.near_field, short_taps)},
        latency_{c.latency}, reach_{c.reach}, version_{c.version} {
    for (std::size_t p = 0; p < 4; ++p) passage_[p] = passage(c.passage[p]);
  }

  /// Total on any input. What rests on a NaN, an infinity (or what is on the way to one, above 1e26 N in float) or on frames
  /// before the first is NaN, never made up.
  output_type operator()(const input_type& frame) noexcept {
    const bool sound = strangeness(frame) == T(0);
    finite_ = sound ? finite_ + (known() ? 0 : 1) : 0;
    lines_.push(std::array<std::array<T, 1>, 2>{{{sound ? frame.near_N : T(0)}, {sound ? frame.far_N : T(0)}}});
    std::array<std::array<T, 1>, 4> wave;
    for (std::size_t p = 0; p < 4; ++p) {  // the newest sample apart: a register that holds it would wait for it
      const std::size_t older = passage_[p].older;
      const T* x = samples(p, older);
      wave[p][0] = detail::passage_dot(passage_[p].taps.data(), x, older) + passage_[p].taps[older] * x[older];
    }
    const output_type latest = moved_on(mixed(wave));
    return known() ? latest : unknown();
  }

  /// The same frame by frame, quicker from `chunk` frames on. Both spans have one length.
  void process(std::span<const input_type> in, std::span<output_type> out) noexcept {
    std::size_t n = 0;
    while (n < in.size()) {
      const std::size_t count = in.size() - n < chunk ? in.size() - n : chunk;
      if (count == chunk && known() && all_sound(in.data() + n)) run_chunk(in.data() + n, out.data() + n);
      else
        for (std::size_t i = n; i < n + count; ++i) out[i] = (*this)(in[i]);
      n += count;
    }
  }

  /// The latest output rests on finite samples only, and on as many as it needs: false at the beginning, and after a NaN or an
  /// infinity until it has left the lines.
  [[nodiscard]] bool known() const noexcept { return finite_ >= reach_; }

  void reset() noexcept {
    lines_ = {};
    forces_ = {};
    window_ = {};
    finite_ = 0;
  }

  /// Frames by which the output lags.
  [[nodiscard]] T latency() const noexcept { return static_cast<T>(latency_); }

private:
  enum signal : std::size_t { force_near, force_far, round_near, round_far, force, signals };

  using row = std::array<T, chunk>;

  static output_type unknown() noexcept {
    constexpr T nan = std::numeric_limits<T>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  /// Zero, but for a frame that is not finite or too large to be summed up. (2^40 x is exact unless it overflows.)
  static constexpr T strangeness(const input_type& frame) noexcept {
    constexpr T headroom = T(1ULL << 40U);
    return (frame.near_N * headroom - frame.near_N * headroom) + (frame.far_N * headroom - frame.far_N * headroom);
  }
  static bool all_sound(const input_type* in) noexcept {
    T sum = 0;
    for (std::size_t i = 0; i < chunk; ++i) sum += strangeness(in[i]);
    return sum == T(0);
  }

  static constexpr std::size_t quantum = detail::passage_quantum<T>;
  static constexpr std::size_t up(std::size_t count) noexcept { return (count + quantum - 1) / quantum * quantum; }
  static constexpr std::size_t short_taps = coefficients_type::short_taps, short_room = up(short_taps);

  /// The same taps at the end of a longer array.
  template <std::size_t Room, std::size_t Count>
  static constexpr std::array<T, Room> padded(const std::array<T, Count>& taps, std::size_t count) noexcept {
    std::array<T, Room> out{};
    for (std::size_t j = 0; j < count; ++j) out[up(count) - count + j] = taps[j];
    return out;
  }
  /// The taps but the newest, padded, and the newest.
  struct passage {
    std::array<T, up(Taps) + 1> taps{};
    std::size_t older = 0, count = 0, newest_age = 0;

    constexpr passage() noexcept = default;
    constexpr explicit passage(const streaming_kernel<T, Taps>& k) noexcept : count{k.count}, newest_age{k.newest_age} {
      if (count == 0) return;
      older = up(count - 1);
      for (std::size_t j = 0; j < count; ++j) taps[older + 1 - count + j] = k.taps[j];
    }
    [[nodiscard]] const T* oldest() const noexcept { return taps.data() + (older + 1 - count); }
  };
  /// The sample under a passage's taps that is `before` frames older than the newest of them.
  [[nodiscard]] const T* samples(std::size_t p, std::size_t before) const noexcept {
    return lines_.at(p / 2, passage_[p].newest_age + (passage_[p].count > 0 ? before : 0));
  }

  /// Takes one frame into the windows and gives what is in their middle. They move within registers, and are stored as they are loaded.
  output_type moved_on(const std::array<std::array<T, 1>, signals>& m) noexcept {
    forces_.push(std::array<std::array<T, 1>, 2>{{m[force_near], m[force_far]}});
    using vector = typename lanes_of<T, register_lanes<T>>::type;
    vector near{}, far{}, near_field{};
    detail::shift_in<T>(window_[0].data(), short_room, m[round_near][0], [&](std::size_t j, const vector& x) { near += detail::load_lanes<vector>(&admittance_[j]) * x; });
    detail::shift_in<T>(window_[1].data(), short_room, m[round_far][0], [&](std::size_t j, const vector& x) { far += detail::load_lanes<vector>(&admittance_[j]) * x; });
    detail::shift_in<T>(window_[2].data(), short_room, m[force][0], [&](std::size_t j, const vector& x) { near_field += detail::load_lanes<vector>(&near_field_[j]) * x; });
    constexpr std::size_t width = register_lanes<T>;
    return {*forces_.at(0, Short), *forces_.at(1, Short), detail::sum_of_lanes<T, width>(near + near_field), detail::sum_of_lanes<T, width>(far + near_field)};
  }

  void run_chunk(const input_type* in, output_type* out) noexcept {
    std::array<row, 2> forces;
    for (std::size_t i = 0; i < chunk; ++i) forces[0][i] = in[i].near_N, forces[1][i] = in[i].far_N;
    lines_.push(forces);
    std::array<row, 4> wave;
    for (std::size_t p = 0; p < 4; ++p)
      detail::passage_fir(passage_[p].oldest(), samples(p, passage_[p].count + chunk - 2), passage_[p].count, wave[p].data());
    put_chunk(mixed(wave), out);
  }

  template <std::size_t Count>
  [[nodiscard]] std::array<std::array<T, Count>, signals> mixed(const std::array<std::array<T, Count>, 4>& wave) const noexcept {
    std::array<std::array<T, Count>, signals> out;
    const bool near_only = version_ == bow_version::near, far_only = version_ == bow_version::far;
    for (std::size_t i = 0; i < Count; ++i) {
      const T near = wave[0][i] + wave[3][i], far = wave[2][i] + wave[1][i];
      const T trip_near = wave[0][i] - wave[1][i], trip_far = wave[2][i] - wave[3][i];
      out[force_near][i] = far_only ? far : near;
      out[force_far][i] = near_only ? near : far;
      out[round_near][i] = far_only ? trip_far : trip_near;
      out[round_far][i] = near_only ? trip_near : trip_far;
      out[force][i] = (out[force_near][i] + out[force_far][i]) / T(2);
    }
    return out;
  }

  /// moved_on(), for each frame of a chunk.
  void put_chunk(const std::array<row, signals>& m, output_type* out) noexcept {
    forces_.push(std::array<row, 2>{m[force_near], m[force_far]});
    row near, far, near_field;
    through_window(admittance_, 0, m[round_near], near);
    through_window(admittance_, 1, m[round_far], far);
    through_window(near_field_, 2, m[force], near_field);
    const T *force_n = forces_.at(0, Short + chunk - 1), *force_f = forces_.at(1, Short + chunk - 1);
    for (std::size_t i = 0; i < chunk; ++i) out[i] = {force_n[i], force_f[i], near[i] + near_field[i], far[i] + near_field[i]};
  }
  void through_window(const std::array<T, short_room>& taps, std::size_t which, const row& in, row& out) noexcept {
    auto& w = window_[which];
    std::copy(in.begin(), in.end(), w.begin() + short_room);
    detail::passage_fir(taps.data() + short_room - short_taps, w.data() + short_room - short_taps + 1, short_taps, out.data());
    std::copy(w.begin() + chunk, w.end(), w.begin());
  }

  std::array<passage, 4> passage_;
  std::array<T, short_room> admittance_, near_field_;
  std::size_t latency_, reach_;
  bow_version version_;
  doubled_lines<T, 2, Line + quantum> lines_;
  doubled_lines<T, 2, Short + 5 * chunk> forces_;                     ///< under the bow, until the velocities are there
  std::array<std::array<T, short_room + chunk>, 3> window_{};        ///< of the short filters, oldest first; room for a chunk
  std::size_t finite_ = 0;
};

}  // namespace rosin
