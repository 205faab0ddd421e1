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

#include <rosin/core/finite_math.hpp>
#include <rosin/math/lanes.hpp>
#include <rosin/reconstruct/passage_sums.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Which of the two versions of force and velocity is made; of one alone both fields of a frame hold it.
enum class bow_version { both, near, far };

/// Everything the run-time part has to be given (passage_design.hpp, or the header that `rosin fit --emit-header` writes). Taps
/// stand in order of arrival, oldest sample first; where their number is no multiple of 4, zeros stand before them.
template <class T, std::size_t Taps, std::size_t Short>
struct passage_coefficients {
  static constexpr std::size_t short_taps = (2 * Short + 4) / 4 * 4;
  std::array<streaming_kernel<T, Taps>, 4> passage{};    ///< near back, near out, far back, far out
  std::array<T, short_taps> admittance{}, near_field{};  ///< y and n, 2 Short + 1 taps each
  std::size_t latency = 0;                               ///< frames
  std::size_t reach = 0;                                 ///< frames that one output depends on
  bow_version version = bow_version::both;
};

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
      : admittance_{padded<short_room>(c.admittance, short_taps)},
        near_field_{padded<short_room>(c.near_field, short_taps)}, latency_{c.latency}, reach_{c.reach}, version_{c.version} {
    for (std::size_t p = 0; p < 4; ++p) passage_[p] = passage(c.passage[p]);
  }

  /// Total on any input. What rests on a NaN, an infinity (or what is on the way to one, above 1e26 N in float) or on frames
  /// before the first is NaN, never made up.
  output_type operator()(const input_type& frame) noexcept {
    const bool sound = count(frame);
    lines_.push(std::array<std::array<T, 1>, 2>{{{sound ? frame.near_N : T(0)}, {sound ? frame.far_N : T(0)}}});
    std::array<typename lanes_of<T, register_lanes<T>>::type, 4> sum;
    std::array<std::array<T, 1>, 4> wave;
#pragma GCC unroll 4
    for (std::size_t p = 0; p < 4; ++p) {  // the newest sample apart: a register that holds it would wait for it
      const std::size_t older = passage_[p].older;
      const T* x = samples(p, older);
      sum[p] = detail::passage_dot(passage_[p].taps.data(), x, older);
      wave[p][0] = passage_[p].taps[older] * x[older];
    }
    const std::array<T, 4> older = detail::four_sums_of_lanes<T, register_lanes<T>>(sum);
    for (std::size_t p = 0; p < 4; ++p) wave[p][0] += older[p];
    const output_type latest = moved_on(mixed(wave));
    return known() ? latest : unknown();
  }

  /// The same for many frames, quicker from `chunk` on. Both spans have one length and do not overlap.
  void process(std::span<const input_type> in, std::span<output_type> out) noexcept {
    const std::size_t whole = in.size() / chunk * chunk;
    for (std::size_t n = 0; n < whole; n += chunk) run_chunk(in.data() + n, out.data() + n);
    for (std::size_t n = whole; n < in.size(); ++n) out[n] = (*this)(in[n]);
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
  /// Counts the sound frames since the last that was not, as far as they matter.
  bool count(const input_type& frame) noexcept {
    const bool sound = strangeness(frame) == T(0);
    finite_ = sound ? finite_ + (known() ? 0 : 1) : 0;
    return sound;
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

  /// Takes one frame into the windows and gives what is in their middle. They move within registers, and are stored as they are
  /// loaded.
  output_type moved_on(const std::array<std::array<T, 1>, signals>& m) noexcept {
    forces_.push(std::array<std::array<T, 1>, 2>{{m[force_near], m[force_far]}});
    using vector = typename lanes_of<T, register_lanes<T>>::type;
    const auto through = [&](std::size_t which, signal from, const std::array<T, short_room>& taps, const vector& before) {
      return detail::shift_dot(window_[which].data(), taps.data(), short_room, m[from][0], before);
    };
    const vector near_field = through(2, force, near_field_, vector{});
    const vector near = through(0, round_near, admittance_, near_field), far = through(1, round_far, admittance_, near_field);
    constexpr std::size_t width = register_lanes<T>;
    return {*forces_.at(0, Short), *forces_.at(1, Short), detail::sum_of_lanes<T, width>(near),
            detail::sum_of_lanes<T, width>(far)};
  }

  void run_chunk(const input_type* in, output_type* out) noexcept {
    const bool sound = all_sound(in);
    std::array<row, 2> forces;
    for (std::size_t i = 0; i < chunk; ++i) forces[0][i] = in[i].near_N, forces[1][i] = in[i].far_N;
    for (std::size_t i = 0; i < chunk && !sound; ++i)
      if (strangeness(in[i]) != T(0)) forces[0][i] = forces[1][i] = 0;
    lines_.push(forces);
    std::array<row, 4> wave;
    for (std::size_t p = 0; p < 4; ++p)
      detail::passage_fir(passage_[p].oldest(), samples(p, passage_[p].count + chunk - 2), passage_[p].count, wave[p].data());
    put_chunk(mixed(wave), out);
    for (std::size_t i = 0; i < chunk && !(sound && known()); ++i) {
      count(in[i]);
      if (!known()) out[i] = unknown();
    }
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
  doubled_lines<T, 2, Short + 5 * chunk> forces_;              ///< under the bow, until the velocities are there
  std::array<std::array<T, short_room + chunk>, 3> window_{};  ///< of the short filters, oldest first; room for a chunk
  std::size_t finite_ = 0;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
