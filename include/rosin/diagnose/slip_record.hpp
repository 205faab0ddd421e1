// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a law of friction is driven by and asked for: force and motion of one take, smoothed through the window that its sticking
// is looked at through, and the samples that slip, clear of those that stick.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_stick.hpp>
#include <rosin/friction/slip_samples.hpp>

namespace rosin {

/// The slips of one take with all that drives a law.
struct slip_record {
  std::vector<double> force_N, relative_m_s;  ///< smoothed; surface less rod
  contact_phases phases;
  slip_samples slips;
  double normal_N = 0, rate_Hz = 0;
  std::vector<double> load{};  ///< normal force over normal_N at every sample; empty: it is steady
};

/// Smoothed force and motion of each take and their slips, a few samples clear of sticking.
template <class = void>
[[nodiscard]] std::vector<slip_record> slip_records(stick_bench& bench, const std::vector<contact_take>& takes) {
  std::vector<slip_record> out;
  for (std::size_t t = 0; t < bench.records().size(); ++t) {
    auto& record = bench.records()[t];
    slip_record r{record.force_through([](double) { return 1.0; }),
                  bench.relative_m_s()[t],
                  {},
                  {},
                  takes[t].normal_force_N,
                  takes[t].rate_Hz};
    const std::size_t begin = record.begin();
    r.phases = find_phases(std::span(r.relative_m_s).subspan(0, record.end()).subspan(begin), takes[t].rod_speed_m_s,
                           {.least = 0.1, .most = 0.5, .fluctuations = 5});
    for (auto* list : {&r.phases.sticks, &r.phases.slips})
      for (auto& s : *list) s.begin += begin, s.end += begin;
    for (std::size_t margin = record.reach() - 1; margin + 3 > record.reach() && r.slips.sample.size() < 600; --margin)
      r.slips = slips_of(r.force_N, r.relative_m_s, r.phases, takes[t].rod_speed_m_s, takes[t].normal_force_N, begin, margin);
    out.push_back(std::move(r));
  }
  return out;
}
ROSIN_INSTANTIATE(std::vector<slip_record> slip_records(stick_bench&, const std::vector<contact_take>&))

}  // namespace rosin
