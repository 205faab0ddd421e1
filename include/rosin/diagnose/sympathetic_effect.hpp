// tier: hosted
// SPDX-License-Identifier: MIT
//
// Another string on the same support rings along: under the end there is a comb of resonances,
//
//     Z Y(s) = sum_n  (Z / M) n^p s / (s^2 + s w_n / Q + w_n^2),     w_n = n w_1 sqrt((1 + b n^2) / (1 + b)),
//
// p = 2 where a stiff support carries both strings (Y = s / K - s^2 Z_2 / K^2 + ...; the impedance Z_2 of the other string is
// that comb with p = 0). Its lines are too narrow for a scan of starting points; they are sought in what the fit so far leaves
// over: peaks between the string's own partials that are multiples of one pitch.
//
#pragma once

#include <rosin/calibrate/partial_search.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effect.hpp>

#include <algorithm>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Peaks of a residual away from the string's own partials.
struct foreign_peaks {
  std::vector<peak_finder::peak> peaks;  ///< by frequency
  double near_Hz = 0, bin_Hz = 0;        ///< so close to a partial of the string nothing is believed
};

template <class = void>
foreign_peaks peaks_between(const Eigen::VectorXd& residual, double rate_Hz, const std::vector<double>& own_Hz) {
  constexpr double over_floor = 25, highest_partial = 24;
  if (own_Hz.empty()) return {};
  const double spacing = own_Hz.front();
  std::vector<double> faded(static_cast<std::size_t>(residual.size()));  // so that the foot of a misfitted partial is narrow
  for (std::size_t i = 0; i < faded.size(); ++i)
    faded[i] = residual[static_cast<Eigen::Index>(i)] *
               std::pow(std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(faded.size())), 2);
  const peak_finder all{faded, rate_Hz, spacing};
  foreign_peaks out{{}, 0.03 * spacing + 4 * all.bin_Hz(), all.bin_Hz()};
  for (double f = 0.1 * spacing; f < std::min(highest_partial * spacing, own_Hz.back()); f += 0.1 * spacing) {
    const auto p = all.strongest(f, f + 0.1 * spacing);
    if (!p || p->power < over_floor * all.floor_at(p->frequency_Hz)) continue;
    const auto above = std::lower_bound(own_Hz.begin(), own_Hz.end(), p->frequency_Hz - out.near_Hz);
    if (above == own_Hz.end() || *above > p->frequency_Hz + out.near_Hz) out.peaks.push_back(*p);
  }
  return out;
}

/// Peaks that are partials of one pitch.
struct comb_of_peaks {
  double pitch_Hz = 0, inharmonicity = 0, worth = 0;  ///< peaks in it, less half of those that are missing

  [[nodiscard]] double partial_Hz(double n) const { return n * pitch_Hz * std::sqrt(1 + inharmonicity * n * n); }
};

/// Upwards from a first guess: each peak where those below foretell it; (f / n)^2 is a straight line over n^2.
inline comb_of_peaks comb_at(const foreign_peaks& found, double pitch_Hz, const std::vector<double>& own_Hz) {
  comb_of_peaks comb{pitch_Hz, 0, 0};
  double weight = 0, x = 0, y = 0, xx = 0, xy = 0;
  int count = 0, passed = 0, missing = 0;
  for (int n = 1; n <= 30; ++n) {
    const double f = comb.partial_Hz(n), reach = 2 * found.bin_Hz + 0.001 * f;
    const auto p =
        std::find_if(found.peaks.begin(), found.peaks.end(), [&](const auto& q) { return std::abs(q.frequency_Hz - f) < reach; });
    if (p == found.peaks.end()) {
      passed += std::none_of(own_Hz.begin(), own_Hz.end(), [&](double g) { return std::abs(f - g) < found.near_Hz; }) ? 1 : 0;
      continue;
    }
    const double u = n * n, v = std::pow(p->frequency_Hz / n, 2);
    weight += u, x += u * u, y += u * v, xx += u * u * u, xy += u * u * v;
    missing = passed, ++count;  // those above the last one do not count
    const double slope = count < 3 ? 0 : std::clamp((weight * xy - x * y) / (weight * xx - x * x), 0.0, 1e-3 * y / weight),
                 start = (y - slope * x) / weight;
    comb.pitch_Hz = std::sqrt(start), comb.inharmonicity = slope / start;
  }
  comb.worth = count < 3 ? 0 : count - 0.5 * missing;
  return comb;
}

inline bool is_new(const std::vector<comb_of_peaks>& known, double pitch_Hz) {
  return std::none_of(known.begin(), known.end(), [&](const auto& c) { return std::abs(c.pitch_Hz / pitch_Hz - 1) < 0.01; });
}

/// The best combs among the peaks, at most two, and those of twice and three times as many lines: what shows may be every other
/// one.
inline std::vector<comb_of_peaks> foreign_combs(const foreign_peaks& found, const std::vector<double>& own_Hz) {
  constexpr double lowest_Hz = 40;
  std::vector<comb_of_peaks> all, best, out;
  for (const auto& p : found.peaks)
    for (int m = 1; m <= 6 && p.frequency_Hz / m > lowest_Hz; ++m)
      if (const comb_of_peaks c = comb_at(found, p.frequency_Hz / m, own_Hz); c.worth >= 2.5) all.push_back(c);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.worth > b.worth; });
  for (const auto& c : all)
    if (best.size() < 2 && is_new(best, c.pitch_Hz)) best.push_back(c);
  for (const double part : {1.0, 2.0, 3.0})
    for (const auto& c : best)
      if (c.pitch_Hz / part > lowest_Hz && is_new(out, c.pitch_Hz / part))
        out.push_back({c.pitch_Hz / part, c.inharmonicity / (part * part), c.worth});
  return out;
}

}  // namespace detail

/// Another string that rings along at one end; Z / M is that of its first mode.
template <class Real = double>
pluck_effect sympathetic_string_effect(const string_facts& f, int end) {
  constexpr int most_modes = 100;  // as far as they can be told; a fit takes seconds with these
  const double Z = f.impedance_Ns_m > 0 ? f.impedance_Ns_m : 1.0, highest = f.highest_Hz;
  pluck_effect e{.name = "sympathetic-string",
                 .place = end,
                 .at_end = true,
                 .parameters = {{"frequency_Hz", 30, 3000, 1e-6, true},
                                {"q", 20, 20000, 1e-4, true},
                                {"per_mass_per_kg", 0, 1e4 / Z, 1e-4 / Z},
                                {"slope", -2, 4, 1e-4},
                                {"string_inharmonicity", -1e-5, 3e-3, 1e-8}},
                 .strength = 2,
                 .apply = [Z, end, highest](pluck_scene& s, const double* v, int) {
                   for (int n = 1; n <= most_modes; ++n)
                     if (const double at = n * v[0] * std::sqrt((1 + v[4] * n * n) / (1 + v[4])); at < highest)
                       s.ends[static_cast<std::size_t>(end)].modes.push_back({at, v[1], v[2] * Z * std::pow(n, v[3])});
                 }};
  for (const double ratio : {0.5, 0.749, 1.335})
    e.starts.push_back({ratio * f.fundamental_Hz, 1000, 1e-4 / Z, 2, 0});  // for what can be told of a rig in advance
  e.seek = [Z](const take_residual& rest) {
    std::vector<detail::comb_of_peaks> combs;
    for (const Eigen::VectorX<Real>& channel : rest.residual)
      for (const auto& c : detail::foreign_combs(detail::peaks_between(channel, rest.rate_Hz, rest.own_Hz), rest.own_Hz))
        if (detail::is_new(combs, c.pitch_Hz)) combs.push_back(c);
    std::vector<std::vector<double>> starts;
    for (const auto& c : combs)
      for (const double slope : {0.0, 2.0})
        for (const double q : {300.0, 1200.0}) starts.push_back({c.partial_Hz(1), q, 1e-4 / Z, slope, c.inharmonicity});
    return starts;
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect sympathetic_string_effect(const string_facts&, int))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
