// tier: hosted
// SPDX-License-Identifier: MIT
//
// The transverse echoes of a string's ends as kernels: sampled in frequency, then given the poles of the
// partials that are asked for (wave_loop.hpp). The kernel of the longer side spans a whole period: then there are
// taps enough to set every pole exactly.
//
#pragma once

#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/propagate/transmission.hpp>
#include <rosin/simulate/modal_string.hpp>
#include <rosin/simulate/wave_loop.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Round trips of a wave to either end.
struct echo_plan {
  std::array<double, 2> delay_s{};  ///< there and back, at low frequency
  double stiffness_s2 = 0;
  band limits{};
  double rate_Hz = 0;
  std::ptrdiff_t earliest = 1;  ///< least lag a tap may have
  std::vector<std::complex<double>> poles{};
};

/// Below the first partial nothing fixes the loss; there it fades as w^2, as that of any sum of partials does, so that the
/// kernel has no corner at 0 Hz and hardly any tails.
[[nodiscard]] inline double loss_share(double frequency_Hz, double first_partial_Hz) noexcept {
  const double x = frequency_Hz / first_partial_Hz;
  return x / std::sqrt(std::sqrt(1 + x * x * x * x));
}

/// The transverse wave, there and back from a pinned end.
struct pinned_echo {
  transmission pass{};
  double first_partial_Hz = 0;
  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const {
    const auto rate = propagation_rate(frequency_Hz, pass.stiffness_s2, pass.loss);
    const double share = frequency_Hz > 0 ? loss_share(frequency_Hz, first_partial_Hz) : 0;
    return -std::exp(-pass.delay_s * std::complex<double>{share * (frequency_Hz > 0 ? rate.real() : 0), rate.imag()});
  }
};

/// First and last lag of the response to a passage of between `least` and `most` samples: the fastest waves come early, the
/// slowest in an Airy front, and what a constant Q loses spreads it to 1 / (1 + (t / w)^2), w = loss * most, cut off at `widths`
/// of these; the low-pass rings a little around all.
struct passage_span {
  double first, last;
  passage_span(double least, double most, double stiffness_s2, const band& limits, double rate_Hz, double loss, double widths) {
    const double fastest = slowness_ratio(2 * std::numbers::pi * limits.stop_Hz, stiffness_s2);
    const double ringing = 6.5 * rate_Hz / (limits.stop_Hz - limits.pass_Hz), spread = ringing + widths * loss * most;
    const double front = 8 * std::cbrt(1.5 * stiffness_s2 * (most / rate_Hz)) * rate_Hz;
    first = std::min(least * fastest - std::min(ringing, least / 2), least - std::min(spread, least / 2));
    last = most + std::max(spread, front);
  }
};

/// `echo(j)` gives the transfer function of side j's echo. Fails where the kernels cannot hold what is asked for.
template <class Echo>
[[nodiscard]] outcome<wave_loop> design_loop(const echo_plan& plan, const Echo& echo) {
  const std::size_t far = plan.delay_s[0] <= plan.delay_s[1] ? 1 : 0;
  const double period = (plan.delay_s[0] + plan.delay_s[1]) * plan.rate_Hz;
  const double loss = plan.poles.empty() ? 0 : -plan.poles.front().real() / std::abs(plan.poles.front());  // 1 / 2Q
  wave_loop loop;
  for (std::size_t j = 0; j < 2; ++j) {
    const double delay = plan.delay_s[j] * plan.rate_Hz;
    const passage_span span{delay, delay, plan.stiffness_s2, plan.limits, plan.rate_Hz, loss, 100};
    const auto first = std::max(static_cast<std::ptrdiff_t>(span.first), plan.earliest);
    auto last = static_cast<std::ptrdiff_t>(std::ceil(std::max(span.last, delay + 0.05 * period)));
    if (j == far) last = std::max(last, first + static_cast<std::ptrdiff_t>(std::ceil(1.08 * period)) + 4);
    if (last < first) return failure{"echo: an end is too near for the rate of the steps"};
    const int from = static_cast<int>(first), to = static_cast<int>(last);
    loop.echo[j == far ? 1 : 0] = sample_echo(echo(j), plan.limits, plan.rate_Hz, from, to, delay);
  }
  set_poles(loop, plan.poles, 1 / plan.rate_Hz, plan.delay_s[far] * plan.rate_Hz);
  if (far == 0) std::swap(loop.echo[0], loop.echo[1]);
  const double gain = largest_gain(loop, period);
  if (!(gain < 1))
    return failure{"echo: the loop would not be stable (gain " + number_text(gain) + "); raise the rate of the steps"};
  return loop;
}

/// Poles of the partials of which a round of the string leaves a hundredth or more; the others are hardly partials.
[[nodiscard]] inline std::vector<std::complex<double>> poles_of(const std::vector<string_mode>& modes) {
  std::vector<std::complex<double>> poles;
  for (const auto& mode : modes)
    if (std::numbers::pi * mode.number * mode.inverse_quality < 4.6) poles.push_back(mode.pole());
  return poles;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
