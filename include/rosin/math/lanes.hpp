// tier: freestanding
// SPDX-License-Identifier: MIT
//
// A vector register as a value: `lanes<T>::count` independent numbers that are added and multiplied together. Written with
// the vector types of GCC and Clang, whose arithmetic operators need no intrinsics and no library; where the compiler is
// another one, or knows no vector unit, a register is one number and all that is built on it still works.
//
#pragma once

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace rosin {

/// Width of the vector unit that the compiler may use, in bytes.
#if defined(__AVX512F__)
inline constexpr std::size_t register_bytes = 64;
#elif defined(__AVX__)
inline constexpr std::size_t register_bytes = 32;
#elif defined(__SSE2__) || defined(__ARM_NEON)
inline constexpr std::size_t register_bytes = 16;
#else
inline constexpr std::size_t register_bytes = 0;
#endif

/// As many T as a register holds. Count = 1 is T itself.
template <class T, std::size_t Count>
struct lanes_of {
#if defined(__GNUC__)
  using type [[gnu::vector_size(sizeof(T) * Count)]] = T;
#endif
};
template <class T>
struct lanes_of<T, 1> {
  using type = T;
};

#if defined(__GNUC__)
template <class T>
inline constexpr std::size_t register_lanes = register_bytes > sizeof(T) ? register_bytes / sizeof(T) : 1;
#else
template <class T>
inline constexpr std::size_t register_lanes = 1;
#endif

/// Count complex numbers side by side. In memory: Count real parts, then Count imaginary parts.
template <class T, std::size_t Count>
struct lane_complex {
  using vector = typename lanes_of<T, Count>::type;
  vector re, im;

  static lane_complex load(const T* from) noexcept {
    lane_complex z;
    std::memcpy(&z.re, from, sizeof(vector));
    std::memcpy(&z.im, from + Count, sizeof(vector));
    return z;
  }
  void store(T* to) const noexcept {
    std::memcpy(to, &re, sizeof(vector));
    std::memcpy(to + Count, &im, sizeof(vector));
  }

  friend lane_complex operator+(const lane_complex& a, const lane_complex& b) noexcept { return {a.re + b.re, a.im + b.im}; }
  friend lane_complex operator-(const lane_complex& a, const lane_complex& b) noexcept { return {a.re - b.re, a.im - b.im}; }

  /// a + i b and a - i b.
  friend lane_complex plus_i(const lane_complex& a, const lane_complex& b) noexcept { return {a.re - b.im, a.im + b.re}; }
  friend lane_complex minus_i(const lane_complex& a, const lane_complex& b) noexcept { return {a.re + b.im, a.im - b.re}; }

  /// Times w[0] + i w[1], and times its conjugate.
  [[nodiscard]] lane_complex times(const T* w) const noexcept { return {re * w[0] - im * w[1], re * w[1] + im * w[0]}; }
  [[nodiscard]] lane_complex times_conj(const T* w) const noexcept { return {re * w[0] + im * w[1], im * w[0] - re * w[1]}; }
  [[nodiscard]] lane_complex conj() const noexcept { return {re, -im}; }
};

/// Transposes Count rows of Count numbers: to[r to_stride + c] = from[c from_stride + r]. The rows are interleaved with each
/// other log2(Count) times, as two halves of a pack of cards, and lie transposed then; no number travels alone.
template <class T, std::size_t Count>
void transpose(const T* from, std::size_t from_stride, T* to, std::size_t to_stride) noexcept {
  using vector = typename lanes_of<T, Count>::type;
  std::array<vector, Count> rows, shuffled;
  for (std::size_t c = 0; c < Count; ++c) std::memcpy(&rows[c], from + c * from_stride, sizeof(vector));
  if constexpr (Count > 1) {
    const auto interleave = []<std::size_t... I>(const vector& a, const vector& b, auto half, std::index_sequence<I...>) {
      return __builtin_shufflevector(a, b, (half() * Count / 2 + I / 2 + I % 2 * Count)...);
    };
    for (std::size_t round = 1; round < Count; round *= 2) {
      for (std::size_t c = 0; c < Count / 2; ++c) {
        constexpr std::make_index_sequence<Count> all;
        shuffled[2 * c] = interleave(rows[c], rows[c + Count / 2], std::integral_constant<std::size_t, 0>{}, all);
        shuffled[2 * c + 1] = interleave(rows[c], rows[c + Count / 2], std::integral_constant<std::size_t, 1>{}, all);
      }
      rows = shuffled;
    }
  }
  for (std::size_t r = 0; r < Count; ++r) std::memcpy(to + r * to_stride, &rows[r], sizeof(vector));
}

}  // namespace rosin
