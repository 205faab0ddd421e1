// tier: freestanding
// SPDX-License-Identifier: MIT
//
// The window in frequency that limits every kernel and every result to a band:
//
//     W(f) = 1 - a^4 (35 - 84 a + 70 a^2 - 20 a^3),   a = clip((|f| - pass) / (stop - pass), 0, 1)
//
// One to `pass`, zero from `stop` on, and three derivatives vanish at both edges: kernels designed with it reach the
// same error with two to four times fewer taps than with a raised cosine. It is evaluated as b^4 (35 - ...), b = 1 - a,
// the same polynomial (W(a) + W(1 - a) = 1), so that nothing cancels where the window is small.
//
#pragma once

namespace rosin {

/// Even in f. A band with stop_Hz <= pass_Hz has no transition: one up to and including pass_Hz, zero above.
struct band {
  double pass_Hz;
  double stop_Hz;

  [[nodiscard]] constexpr double operator()(double frequency_Hz) const noexcept {
    const double f = frequency_Hz < 0 ? -frequency_Hz : frequency_Hz;
    if (f <= pass_Hz) return 1;
    if (f >= stop_Hz) return 0;
    const double b = (stop_Hz - f) / (stop_Hz - pass_Hz);
    return b * b * b * b * (35 - b * (84 - b * (70 - b * 20)));
  }
};

}  // namespace rosin
