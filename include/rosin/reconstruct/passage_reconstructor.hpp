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

#include <array>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <type_traits>

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

/// Adds a[j] b[j] to the lanes of `sum`.
template <class Vector, class T>
void add_product(Vector& sum, const T* a, const T* b) noexcept {
  sum += load_lanes<Vector>(a) * load_lanes<Vector>(b);
}

/// sum_j taps[j] x[j]; count is a multiple of 4.
template <class T>
[[nodiscard]] T passage_dot(const T* taps, const T* x, std::size_t count) noexcept {
  constexpr std::size_t narrow = register_lanes<T> < 4 ? register_lanes<T> : 4, wide = register_lanes<T> < 8 ? narrow : 8;
  using vector = typename lanes_of<T, wide>::type;
  vector even{}, odd{};
  std::size_t j = 0;
  if constexpr (wide > narrow)
    for (; j + 2 * wide <= count; j += 2 * wide) {
      add_product(even, taps + j, x + j);
      add_product(odd, taps + j + wide, x + j + wide);
    }
  even += odd;
  std::array<typename lanes_of<T, narrow>::type, 4 / narrow * (wide / narrow)> sum;
  if constexpr (wide > narrow) std::memcpy(sum.data(), &even, sizeof even);
  else sum = {};
  for (; j < count; j += 4)
#pragma GCC unroll 4
    for (std::size_t p = 0; p < 4 / narrow; ++p) add_product(sum[p], taps + j + p * narrow, x + j + p * narrow);
  if constexpr (sum.size() > 1) sum[0] += sum[1];
  if constexpr (sum.size() > 2) sum[0] += sum[2] + sum[3];
  std::array<T, narrow> lane;
  std::memcpy(lane.data(), sum.data(), sizeof lane);
  if constexpr (narrow == 4) return (lane[0] + lane[1]) + (lane[2] + lane[3]);
  else if constexpr (narrow == 2) return lane[0] + lane[1];
  else return lane[0];
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

  constexpr explicit passage_reconstructor(const coefficients_type& coefficients) noexcept : c_{coefficients} {}

  /// Total on any input. What rests on a NaN, an infinity or on frames before the first is NaN, never made up.
  output_type operator()(const input_type& frame) noexcept {
    const T zero = (frame.near_N - frame.near_N) + (frame.far_N - frame.far_N);  // NaN where one is not finite
    finite_ = zero == T(0) ? finite_ + (known() ? 0 : 1) : 0;
    lines_.push(std::array<std::array<T, 1>, 2>{{{frame.near_N}, {frame.far_N}}});
    std::array<std::array<T, 1>, 4> wave;
    for (std::size_t p = 0; p < 4; ++p) wave[p][0] = detail::passage_dot(taps(p), samples(p, 0), c_.passage[p].count);
    mix(wave);
    return known() ? latest() : unknown();
  }

  /// The same frame by frame, quicker from `chunk` frames on. Both spans have one length.
  void process(std::span<const input_type> in, std::span<output_type> out) noexcept {
    std::size_t n = 0;
    while (n < in.size()) {
      const std::size_t count = in.size() - n < chunk ? in.size() - n : chunk;
      if (count == chunk && known() && all_finite(in.data() + n)) run_chunk(in.data() + n, out.data() + n);
      else
        for (std::size_t i = n; i < n + count; ++i) out[i] = (*this)(in[i]);
      n += count;
    }
  }

  /// The latest output rests on finite samples only, and on as many as it needs: false at the beginning, and after a NaN or an
  /// infinity until it has left the lines.
  [[nodiscard]] bool known() const noexcept { return finite_ >= c_.reach; }

  void reset() noexcept {
    lines_ = {};
    mixed_ = {};
    finite_ = 0;
  }

  /// Frames by which the output lags.
  [[nodiscard]] T latency() const noexcept { return static_cast<T>(c_.latency); }

private:
  enum signal : std::size_t { force_near, force_far, round_near, round_far, force, signals };

  using row = std::array<T, chunk>;

  static output_type unknown() noexcept {
    constexpr T nan = std::numeric_limits<T>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  static bool all_finite(const input_type* in) noexcept {
    T zero = 0;
    for (std::size_t i = 0; i < chunk; ++i) zero += (in[i].near_N - in[i].near_N) + (in[i].far_N - in[i].far_N);
    return zero == T(0);
  }
  [[nodiscard]] const T* taps(std::size_t passage) const noexcept { return c_.passage[passage].taps.data(); }
  /// The oldest sample under a passage's taps, as of `ago` frames before the latest.
  [[nodiscard]] const T* samples(std::size_t passage, std::size_t ago) const noexcept {
    const auto& k = c_.passage[passage];
    return lines_.at(passage / 2, k.newest_age + k.count + ago - (k.count > 0 ? 1 : 0));
  }

  static constexpr std::size_t short_taps = coefficients_type::short_taps;

  [[nodiscard]] output_type latest() const noexcept {
    const auto dot = [&](const std::array<T, short_taps>& taps, signal s) {
      return detail::passage_dot(taps.data(), mixed_.at(s, short_taps - 1), short_taps);
    };
    const T near_field = dot(c_.near_field, force);
    return {*mixed_.at(force_near, Short), *mixed_.at(force_far, Short), dot(c_.admittance, round_near) + near_field,
            dot(c_.admittance, round_far) + near_field};
  }

  void run_chunk(const input_type* in, output_type* out) noexcept {
    std::array<row, 2> forces;
    for (std::size_t i = 0; i < chunk; ++i) forces[0][i] = in[i].near_N, forces[1][i] = in[i].far_N;
    lines_.push(forces);
    std::array<row, 4> wave;
    for (std::size_t p = 0; p < 4; ++p)
      detail::passage_fir(taps(p), samples(p, chunk - 1), c_.passage[p].count, wave[p].data());
    mix(wave);
    put_chunk(out);
  }

  template <std::size_t Count>
  void mix(const std::array<std::array<T, Count>, 4>& wave) noexcept {
    std::array<std::array<T, Count>, signals> out;
    const bool near_only = c_.version == bow_version::near, far_only = c_.version == bow_version::far;
    for (std::size_t i = 0; i < Count; ++i) {
      const T near = wave[0][i] + wave[3][i], far = wave[2][i] + wave[1][i];
      const T trip_near = wave[0][i] - wave[1][i], trip_far = wave[2][i] - wave[3][i];
      out[force_near][i] = far_only ? far : near;
      out[force_far][i] = near_only ? near : far;
      out[round_near][i] = far_only ? trip_far : trip_near;
      out[round_far][i] = near_only ? trip_near : trip_far;
      out[force][i] = (out[force_near][i] + out[force_far][i]) / T(2);
    }
    mixed_.push(out);
  }

  /// latest(), for each frame of a chunk.
  void put_chunk(output_type* out) const noexcept {
    const auto fir = [&](const std::array<T, short_taps>& taps, signal s, row& to) {
      detail::passage_fir(taps.data(), mixed_.at(s, short_taps + chunk - 2), short_taps, to.data());
    };
    row near, far, near_field;
    fir(c_.admittance, round_near, near);
    fir(c_.admittance, round_far, far);
    fir(c_.near_field, force, near_field);
    const T *force_n = mixed_.at(force_near, Short + chunk - 1), *force_f = mixed_.at(force_far, Short + chunk - 1);
    for (std::size_t i = 0; i < chunk; ++i) out[i] = {force_n[i], force_f[i], near[i] + near_field[i], far[i] + near_field[i]};
  }

  coefficients_type c_;
  doubled_lines<T, 2, Line> lines_;
  doubled_lines<T, signals, short_taps + 4 * chunk> mixed_;
  std::size_t finite_ = 0;
};

}  // namespace rosin
