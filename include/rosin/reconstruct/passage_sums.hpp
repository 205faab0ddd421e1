// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What a streaming filter is made of: delay lines that never wrap, and sums of products over them in vector registers, one output
// at a time or a chunk of outputs at once. On a core without vectors a register is one number, and the chunk is what its
// registers hold:
//
//     passage_dot   one output, taps and samples side by side           two loads a product
//     passage_fir   a chunk, each tap and each sample fetched once      1 + 1/8 ... 1/16 loads a product
//
#pragma once

#include <rosin/math/lanes.hpp>

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace rosin {

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
    }
    (std::make_index_sequence<Count / 2>{});
    return sum_of_lanes<T, Count / 2>(low + high);
  }
}

/// Lanes 0 ... 3, with those that are 4, 8, ... further on added.
template <class T, std::size_t Count>
[[nodiscard]] std::array<T, 4> fold_by_four(const typename lanes_of<T, Count>::type& v) noexcept {
  if constexpr (Count == 4) {
    std::array<T, 4> out;
    std::memcpy(out.data(), &v, sizeof out);
    return out;
  } else {
    return [&]<std::size_t... I>(std::index_sequence<I...>) {
      using half = typename lanes_of<T, Count / 2>::type;
      const half low = __builtin_shufflevector(v, v, I...), high = __builtin_shufflevector(v, v, (I + Count / 2)...);
      return fold_by_four<T, Count / 2>(low + high);
    }
    (std::make_index_sequence<Count / 2>{});
  }
}

/// The sums of the lanes of four registers: halves are added while they are interleaved, all four at once.
template <class T, std::size_t Count>
[[nodiscard]] std::array<T, 4> four_sums_of_lanes(const std::array<typename lanes_of<T, Count>::type, 4>& v) noexcept {
  using vector = typename lanes_of<T, Count>::type;
  if constexpr (Count < 4) {
    return {sum_of_lanes<T, Count>(v[0]), sum_of_lanes<T, Count>(v[1]), sum_of_lanes<T, Count>(v[2]),
            sum_of_lanes<T, Count>(v[3])};
  } else {
    // a0+a2, b0+b2, a1+a3, b1+b3
    const auto halves = []<std::size_t... I>(const vector& a, const vector& b, std::index_sequence<I...>) {
      return vector(__builtin_shufflevector(a, b, (I / 4 * 4 + I % 4 / 2 + I % 2 * Count)...) +
                    __builtin_shufflevector(a, b, (I / 4 * 4 + 2 + I % 4 / 2 + I % 2 * Count)...));
    };
    const auto quarters = []<std::size_t... I>(const vector& a, const vector& b, std::index_sequence<I...>) {
      return vector(__builtin_shufflevector(a, b, (I / 4 * 4 + I % 2 + I % 4 / 2 * Count)...) +
                    __builtin_shufflevector(a, b, (I / 4 * 4 + 2 + I % 2 + I % 4 / 2 * Count)...));
    };
    constexpr std::make_index_sequence<Count> all;
    return fold_by_four<T, Count>(quarters(halves(v[0], v[1], all), halves(v[2], v[3], all), all));
  }
}

/// sum_j taps[j] x[j], still spread over the lanes; count is a multiple of passage_quantum.
template <class T>
[[nodiscard, gnu::always_inline]] inline auto passage_dot(const T* taps, const T* x, std::size_t count) noexcept {
  constexpr std::size_t width = register_lanes<T>, sums = width == 1 ? 4 : 2, step = sums * width;
  using vector = typename lanes_of<T, width>::type;
  std::array<vector, sums> sum{};
  std::size_t j = 0;
  for (; j + step <= count; j += step)
#pragma GCC unroll 4
    for (std::size_t p = 0; p < sums; ++p)
      sum[p] += load_lanes<vector>(taps + j + p * width) * load_lanes<vector>(x + j + p * width);
  if (j < count) sum[0] += load_lanes<vector>(taps + j) * load_lanes<vector>(x + j);
  if constexpr (sums == 4) return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  else return vector(sum[0] + sum[1]);
}

/// Moves a window of `count` samples on by one, `newest` behind them; `sum` and the sum of taps and window, spread over the
/// lanes.
template <class T, class Vector>
[[nodiscard, gnu::always_inline]] inline Vector shift_dot(T* window, const T* taps, std::size_t count, T newest,
                                                          Vector sum) noexcept {
  constexpr std::size_t width = register_lanes<T>;
  Vector now = load_lanes<Vector>(window);
  for (std::size_t j = 0; j < count; j += width) {
    Vector next{};
    if (j + width < count) next = load_lanes<Vector>(window + j + width);
    else if constexpr (width == 1) next = newest;
    else next[0] = newest;
    if constexpr (width == 1) now = next;
    else now = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return __builtin_shufflevector(now, next, (I + 1)...);
      }
    (std::make_index_sequence<width>{});
    std::memcpy(window + j, &now, sizeof now);
    sum += load_lanes<Vector>(taps + j) * now;
    now = next;
  }
  return sum;
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

}  // namespace rosin
