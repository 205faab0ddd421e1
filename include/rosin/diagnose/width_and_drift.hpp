// tier: hosted
// SPDX-License-Identifier: MIT
//
// A contact of some width under a string whose tension has changed since the plucks. Either makes the two versions of the force
// part, so that neither shows alone: the drift that they part least at is off by what the width does, and with delays that are off
// no width lets both places stick. Both are sought at once, as the pair at which both places (wide_record.hpp) move with the rod.
// That is known along a valley: a wider contact on a slacker string does nearly as well, to 0.001 of the tension for a tenth of
// the width.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_width.hpp>
#include <rosin/diagnose/tension_drift.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A take at another tension; what sits on the string stays.
[[nodiscard]] inline contact_take at_tension(contact_take take, double relative) {
  detail::tighten(take, relative);
  return take;
}

/// Torsion does not feel the tension: it is another multiple of the transverse waves.
[[nodiscard]] inline torsion_values at_tension(torsion_values torsion, double relative) {
  torsion.speed_ratio /= std::sqrt(1 + relative), torsion.impedance_ratio /= std::sqrt(1 + relative);
  return torsion;
}

struct width_and_drift {
  double half_delay_s = 0;  ///< half of the travel time over the width
  double relative = 0;      ///< tension in the strokes / in the plucks - 1
  double sd = 0;            ///< of the latter, by how the strokes differ
  double gain = 0;          ///< samples more that stick at both places than at any width without a drift
};

namespace detail {

/// The strokes of one rig, and what a width and a drift cost there.
class width_and_drift_search {
public:
  width_and_drift_search(const std::vector<contact_take>& takes, const torsion_values& torsion)
      : takes_{takes}, torsion_{torsion} {
    for (const auto& t : stick_bench::stick_takes(takes)) records_.emplace_back(t);
  }

  [[nodiscard]] std::size_t size() const noexcept { return records_.size(); }
  template <class = void>
  [[nodiscard]] double cost(std::size_t t, double half_delay_s, double relative) const {
    wide_record wide(at_tension(takes_[t], relative), records_[t]);
    return width_cost(wide.at(half_delay_s, records_[t].window(), at_tension(torsion_, relative), torsion_damping::constant_q, 1),
                      records_[t]);
  }
  template <class = void>
  [[nodiscard]] double cost(double half_delay_s, double relative) const {
    double sum = 0;
    for (std::size_t t = 0; t < records_.size(); ++t) sum += cost(t, half_delay_s, relative);
    return sum;
  }
  [[nodiscard]] double longest_half_delay_s() const {
    double longest = 2e-5;
    for (const auto& t : takes_) longest = std::min(longest, 0.2 * std::min(t.delay_s[0], t.delay_s[1]));
    return longest;
  }
  /// The drift that costs least at this width, near `start` or, if that is not known, anywhere.
  template <class = void>
  [[nodiscard]] double drift_at(double half_delay_s, std::optional<double> start) const {
    const auto at = [&](double relative) { return cost(half_delay_s, relative); };
    return least_near(at, start ? *start : least_on_grid(at), step);
  }
  template <class = void>
  [[nodiscard]] double drift_of(std::size_t take, double half_delay_s, double start) const {
    return least_near([&](double relative) { return cost(take, half_delay_s, relative); }, start, step);
  }
  template <class = void>
  [[nodiscard]] double width_at(double relative) const {
    double best = 0, least = 1e300;
    for (double d = shortest_s; d < longest_half_delay_s(); d *= 1.2)
      if (const double c = cost(d, relative); c < least) least = c, best = d;
    return std::exp(least_near([&](double log_d) { return cost(std::exp(log_d), relative); }, std::log(best), 0.2));
  }

  static constexpr double shortest_s = 3e-7;  ///< half delay that is tried

private:
  static constexpr double step = 0.002, most = 0.03;  ///< of drifts on the grid

  template <class Cost>
  [[nodiscard]] static double least_on_grid(const Cost& at) {
    double best = 0, least = at(0);
    for (double r = -most; r <= most; r += step)
      if (const double c = at(r); c < least) least = c, best = r;
    return best;
  }
  template <class Cost>
  [[nodiscard]] static double least_near(const Cost& at, double start, double reach) {
    constexpr int bits = 10;
    std::uintmax_t calls = 14;
    return boost::math::tools::brent_find_minima(at, start - reach, start + reach, bits, calls).first;
  }

  const std::vector<contact_take>& takes_;
  torsion_values torsion_;
  std::vector<stick_record> records_;
};

}  // namespace detail

/// Nothing where the terminations' forces or the rod's speed are not given, or the bow is too near an end. Torsion: as declared, at
/// the plucks' tension.
template <class = void>
[[nodiscard]] std::optional<width_and_drift> find_width_and_drift(const std::vector<contact_take>& takes,
                                                                  const torsion_values& torsion) {
  for (const auto& t : takes)
    if (t.near_N.size() != t.force_N.size() || t.far_N.size() != t.force_N.size() || t.rod_speed_m_s == 0) return std::nullopt;
  if (takes.empty()) return std::nullopt;
  const detail::width_and_drift_search search(takes, torsion);
  if (search.longest_half_delay_s() <= search.shortest_s) return std::nullopt;
  width_and_drift out;
  out.half_delay_s = search.width_at(0);
  const double plain = search.cost(out.half_delay_s, 0);
  std::optional<double> start;
  for (int round = 0; round < 3; ++round) {
    start = out.relative = search.drift_at(out.half_delay_s, start);
    out.half_delay_s = search.width_at(out.relative);
  }
  out.gain = plain - search.cost(out.half_delay_s, out.relative);
  double square = 0;
  for (std::size_t t = 0; t < search.size(); ++t)
    square += std::pow(search.drift_of(t, out.half_delay_s, out.relative) - out.relative, 2);
  out.sd = std::sqrt(square / static_cast<double>(search.size()));
  return out;
}
ROSIN_INSTANTIATE(std::optional<width_and_drift> find_width_and_drift(const std::vector<contact_take>&, const torsion_values&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
