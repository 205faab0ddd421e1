// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke that ends with the bow lifted: from then on the string rings freely between its ends, and every partial is a damped
// line in both forces. So pitch, inharmonicity and loss of the very string that was bowed, at the tension and temperature it had
// then, come out of the take itself; no gain, no level and no place of a contact enters.
//
//     contact_ends: from when on the contact's (reconstructed) force is nothing
//     fit_free_decay: partials by number, each sought where those below foretell it (partials.hpp); f_n = n f0 sqrt(1 + b n^2) and the
//     loss law through all of them, both ends together (pickup_pitch.hpp, pickup_loss.hpp)
//
#pragma once

#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_loss.hpp>
#include <rosin/calibrate/pickup_pitch.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/outcome.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The first sample after which a contact's force stays below a twentieth of its strongest rms, both over a period; none where it
/// does not end, or there is no force at all. `level_known` false: sensors are AC coupled, and only what the force varies by in a
/// period counts.
[[nodiscard]] inline std::optional<std::size_t> contact_ends(std::span<const double> force_N, double rate_Hz,
                                                             double fundamental_Hz, bool level_known = true) {
  const auto period = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rate_Hz / fundamental_Hz)));
  std::vector<double> power;
  for (std::size_t first = 0; first + period <= force_N.size(); first += period) {
    double sum = 0, mean = 0;
    for (const double f : force_N.subspan(first, period)) sum += f * f, mean += f / static_cast<double>(period);
    power.push_back(level_known ? sum : sum - static_cast<double>(period) * mean * mean);
  }
  if (power.empty()) return std::nullopt;
  const double limit = *std::max_element(power.begin(), power.end()) / 400;
  const auto last = std::find_if(power.rbegin(), power.rend(), [&](double p) { return p > limit; });
  const auto blocks = static_cast<std::size_t>(power.rend() - last);
  if (blocks == 0 || blocks == power.size()) return std::nullopt;
  return blocks * period;
}

struct free_decay {
  double begin_s = 0, end_s = 0;                   ///< of what was fitted
  double fundamental_Hz = 0, fundamental_sd = 0;   ///< of the string without stiffness: mode n at n f0 sqrt(1 + b n^2)
  double inharmonicity = 0, inharmonicity_sd = 0;  ///< b
  loss_estimate loss{};
  std::array<std::vector<partial>, 2> partials{};  ///< at either end

  /// Pitch and Q of partial n, as the laws have them.
  [[nodiscard]] double frequency_Hz(int n) const noexcept { return partial_frequency(fundamental_Hz, inharmonicity, n); }
  [[nodiscard]] double quality(int n) const noexcept { return 1 / loss.law.inverse_q(frequency_Hz(n)); }
};

struct free_decay_options {
  double inharmonicity = 0;  ///< to be expected
  double highest_Hz = 20e3;
  double search_range = 0.02;  ///< how far the pitch may be from the expected one, as a part of it
};

namespace detail {

/// Those of one end, from the first on until three in a row are missing.
template <class = void>
std::vector<partial> decaying_partials(const baseband_bank& bank, double nominal_Hz, const free_decay_options& o, double begin_s,
                                       double end_s) {
  std::vector<partial> found;
  std::vector<numbered_frequency> lines;
  double f0 = nominal_Hz, b = o.inharmonicity;
  for (int n = 1, missing = 0; missing < 3 && partial_frequency(f0, b, n) < o.highest_Hz; ++n) {
    const double tolerance = (lines.size() < 3 ? o.search_range * n : 0.02) * f0;
    const auto track = track_partial(bank, n, partial_frequency(f0, b, n), std::min(tolerance, 0.3 * f0), begin_s, end_s);
    ++missing;
    if (!track) continue;
    const partial p = summary_of(*track);
    if (!(p.signal_to_noise > 100 && p.decay_per_s > 2 * p.decay_sd && p.frequency_sd < 0.01 * f0)) continue;
    missing = 0;
    found.push_back(p);
    lines.push_back({n, p.frequency_Hz, p.frequency_sd});
    if (lines.size() < 3) f0 = p.frequency_Hz / (n * std::sqrt(1 + b * n * n));
    else {
      const auto fit = fit_pitch(lines, f0, b);
      f0 = fit.value[0], b = fit.value[1];
    }
  }
  return found;
}

}  // namespace detail

/// The string rings freely from begin_s of the recording to its end. Fails where it does not.
template <class = void>
[[nodiscard]] outcome<free_decay> fit_free_decay(const std::array<std::span<const double>, 2>& end_N, double rate_Hz,
                                                 double nominal_Hz, double begin_s, const free_decay_options& options = {}) {
  if (!(rate_Hz > 0 && nominal_Hz > 0 && 4 * nominal_Hz < rate_Hz))
    return failure{"free decay: rate and pitch to be expected must be above 0, and four times the pitch below the rate"};
  free_decay out;
  std::vector<numbered_frequency> lines;
  std::vector<measured_decay> decays;
  for (std::size_t e = 0; e < 2; ++e) {
    const double whole_s = static_cast<double>(end_N[e].size()) / rate_Hz;
    if (!(begin_s >= 0 && whole_s - begin_s > 40 / nominal_Hz)) return failure{"free decay: it lasts for less than 40 periods"};
    const baseband_bank bank{end_N[e], rate_Hz, 0.45 * nominal_Hz};
    out.begin_s = begin_s + bank.settling_s(), out.end_s = whole_s - bank.settling_s() / 2;
    out.partials[e] = detail::decaying_partials(bank, nominal_Hz, options, out.begin_s, out.end_s);
    for (const auto& p : out.partials[e]) {
      lines.push_back({p.number, p.frequency_Hz, p.frequency_sd});
      decays.push_back({p.frequency_Hz, p.decay_per_s, p.decay_sd});
    }
  }
  if (std::min(out.partials[0].size(), out.partials[1].size()) < 3)
    return failure{"free decay: fewer than three partials are damped lines"};
  const auto pitch = fit_pitch(lines, nominal_Hz, options.inharmonicity);
  out.fundamental_Hz = pitch.value[0], out.inharmonicity = pitch.value[1];
  out.fundamental_sd = std::sqrt(pitch.covariance(0, 0)), out.inharmonicity_sd = std::sqrt(pitch.covariance(1, 1));
  out.loss = fit_loss(decays);
  return out;
}
ROSIN_INSTANTIATE(outcome<free_decay> fit_free_decay(const std::array<std::span<const double>, 2>&, double, double, double,
                                                     const free_decay_options&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
