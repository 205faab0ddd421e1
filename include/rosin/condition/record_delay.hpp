// tier: hosted
// SPDX-License-Identifier: MIT
//
// A whole record later (or earlier) by any real number of samples, on the same time axis: out(n) = in(n - delay). The
// windowed sinc of fractional_delay_design.hpp looks to both sides, so nothing comes on top of the delay asked for.
//
// For a record that repeats, condition/fourier_shift.hpp is exact; sample by sample, see condition/fractional_delay.hpp.
//
#pragma once

#include <rosin/condition/fractional_delay_design.hpp>
#include <rosin/condition/overlap_save.hpp>
#include <rosin/core/outcome.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace rosin {

/// One delay for records of any length.
template <class T>
class record_delay {
public:
  [[nodiscard]] static outcome<record_delay> make(double delay_samples, const delay_limits& limits = {}) {
    const outcome<delay_kernel> kernel = design_kaiser_delay(delay_samples, limits);
    if (!kernel) return failure{kernel.error()};
    return record_delay{delay_samples, *kernel};
  }

  /// Samples: the delay asked for, exactly.
  [[nodiscard]] double latency() const noexcept { return delay_; }
  [[nodiscard]] std::size_t taps() const noexcept { return taps_; }

  /// The outputs that keep the limits; the others lack samples from beyond the ends, which count as zero.
  [[nodiscard]] sample_range valid(std::size_t length) const noexcept { return convolver_.valid(length); }

  /// Spans of one length that do not overlap. Allocates nothing.
  void process(std::span<const T> in, std::span<T> out) noexcept { convolver_.process(std::array{in}, std::array{out}); }

private:
  record_delay(double delay_samples, const delay_kernel& kernel)
      : delay_{delay_samples}, taps_{kernel.taps.size()}, convolver_(1, std::vector<delay_kernel>{kernel}) {}

  double delay_;
  std::size_t taps_;
  block_convolver<T> convolver_;
};

}  // namespace rosin
