// tier: hosted
// SPDX-License-Identifier: MIT
//
// A rod that gives way under bristles that bend. What the sensors' noise bends bristles by grows with frequency, as s / s0, and
// what models of bristles leave does, too: over the whole band both hide the modes of rods, which lie low. So these are sought in
// the lower part of it, where all that is unknown is as small as the velocity's two versions agree there:
//
//     d(t) = (v_near - v_far) / 2 through the window of the narrower band
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_stick_effects.hpp>

#include <list>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Takes in a narrower band. `takes` has views into `versions`, which stay where they are when this is moved.
struct narrow_takes {
  std::vector<contact_take> takes;
  std::list<std::vector<double>> versions;
};

template <class = void>
[[nodiscard]] narrow_takes in_band(const std::vector<contact_take>& takes, double edge_Hz) {
  narrow_takes out;
  for (contact_take t : takes) {
    const double before_Hz = t.edge_Hz > 0 ? t.edge_Hz : 0.45 * t.rate_Hz;
    if (edge_Hz < before_Hz) {
      t.edge_Hz = edge_Hz, t.velocity_sd_m_s *= std::sqrt(edge_Hz / before_Hz);
      const auto known = [&](std::size_t i) {
        return std::isfinite(t.velocity_near_m_s[i]) && std::isfinite(t.velocity_far_m_s[i]);
      };
      std::size_t begin = 0, end = std::min(t.velocity_near_m_s.size(), t.velocity_far_m_s.size());
      while (begin < end && !known(begin)) ++begin;
      while (end > begin && !known(end - 1)) --end;
      if (begin < end) {
        std::vector<double> apart;
        for (std::size_t i = begin; i < end; ++i) apart.push_back(0.5 * (t.velocity_near_m_s[i] - t.velocity_far_m_s[i]));
        const auto smooth = contact_signal<>(apart, t.rate_Hz).through(smooth_window{edge_Hz}, [](double) { return 1.0; });
        auto &near = out.versions.emplace_back(t.velocity_near_m_s.begin(), t.velocity_near_m_s.end()),
             &far = out.versions.emplace_back(t.velocity_far_m_s.begin(), t.velocity_far_m_s.end());
        for (std::size_t i = begin; i < end; ++i)
          near[i] = t.velocity_m_s[i] + smooth[i - begin], far[i] = t.velocity_m_s[i] - smooth[i - begin];
        t.velocity_near_m_s = near, t.velocity_far_m_s = far;
      }
    }
    out.takes.push_back(std::move(t));
  }
  return out;
}
ROSIN_INSTANTIATE(narrow_takes in_band(const std::vector<contact_take>&, double))

/// The rod of a model that has bristles; `of_samples` says of how many, since its band is its own.
template <class = void>
[[nodiscard]] contact_hypothesis rod_beside_bristles(const stick_bench& whole, const std::vector<contact_take>& takes) {
  constexpr double edge_Hz = 12e3;
  const narrow_takes low = in_band(takes, edge_Hz);
  stick_bench bench(low.takes, whole.model());
  if (!bench.usable()) return detail::nothing(whole, {.effect = "rod-resonance"});
  contact_hypothesis h = rod_hypothesis(bench);
  constexpr std::array faults{contact_faults::bristly_rod_frequency, contact_faults::bristly_rod_q,
                              contact_faults::bristly_rod_mass};
  for (std::size_t i = 0; i < h.parameters.size(); ++i)
    h.parameters[i].sd = std::hypot(h.parameters[i].sd, faults[i] * h.parameters[i].value);
  h.statistic = "stick-fluctuation in a narrow band";
  h.of_samples = bench.independent();
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis rod_beside_bristles(const stick_bench&, const std::vector<contact_take>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
