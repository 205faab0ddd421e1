// SPDX-License-Identifier: MIT
//
#include "diagnose_contact_picture.hpp"

#include <rosin/diagnose/contact_cycle.hpp>

namespace tool {

namespace {

/// The stretch of so many seconds in which most is left, summed over its samples; a few that stand out far count as four times
/// the median.
struct loud_stretch {
  double begin_s = 0, sum = 0;
};
loud_stretch loudest(const rosin::contact_trace& trace, double length_s) {
  std::vector<double> sizes;
  for (const double x : trace.left) sizes.push_back(std::abs(x));
  loud_stretch best;
  if (sizes.empty()) return best;
  std::vector<double> ordered = sizes;
  std::nth_element(ordered.begin(), ordered.begin() + static_cast<std::ptrdiff_t>(ordered.size() / 2), ordered.end());
  const double most = 4 * ordered[ordered.size() / 2];
  for (std::size_t i = 0, k = 0; i < sizes.size(); i = k) {
    double sum = 0;
    for (k = i; k < sizes.size() && trace.time_s[k] < trace.time_s[i] + length_s; ++k) sum += std::min(most, sizes[k]);
    if (sum > best.sum) best = {trace.time_s[i], sum};
  }
  return best;
}

}  // namespace

contact_picture contact_picture_of(const std::vector<rosin::contact_trace>& before, const std::string& statistic,
                                   double length_s) {
  contact_picture out;
  out.statistic = statistic;
  loud_stretch most;
  for (const auto& trace : before)
    if (const auto here = loudest(trace, length_s); here.sum > most.sum) most = here, out.before = {trace}, out.take = trace.take;
  out.shown_s = {most.begin_s, most.begin_s + length_s};
  return out;
}

void add_after(const std::vector<rosin::contact_trace>& after, contact_picture& picture) {
  for (const auto& trace : after)
    if (trace.take == picture.take) picture.after = {trace};
}

void show_contact(rig_diagnosis& d, double noise, bool alone) {
  d.contact->noise = noise;
  if (!d.contact->before.empty()) d.contact->cycle_before = rosin::left_by_part(d.contact->before.front());
  if (!d.contact->after.empty()) d.contact->cycle_after = rosin::left_by_part(d.contact->after.front());
  if (alone && !d.contact->before.empty()) d.take = d.contact->take, d.time_s = d.contact->shown_s;
}

}  // namespace tool
