// SPDX-License-Identifier: MIT
#include "reconstruct_channels.hpp"

#include "digits.hpp"

#include <rosin/condition/overlap_save.hpp>

namespace tool {

namespace {

/// Mean over these samples.
double mean_of(const std::vector<double>& x, rosin::sample_range known) {
  double sum = 0;
  for (std::size_t i = known.begin; i < known.end; ++i) sum += x[i];
  return sum / static_cast<double>(std::max<std::size_t>(1, known.end - known.begin));
}

std::vector<double> from_profile(const rosin::profile& points, std::size_t samples, double rate_Hz) {
  std::vector<double> out(samples, points.front().second);
  std::size_t next = 1;
  for (std::size_t i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / rate_Hz;
    while (next < points.size() && points[next].first <= t) ++next;
    const auto& a = points[next - 1];
    if (next == points.size() || t < a.first) out[i] = a.second;
    else out[i] = a.second + (points[next].second - a.second) * (t - a.first) / std::max(1e-300, points[next].first - a.first);
  }
  return out;
}

const rosin::take_signal* calibrated_channel(const checked_take& read, rosin::quantity what) {
  for (const auto& s : read.signals.signals)
    if (s.sensor.quantity == what && s.sensor.per_full_scale) return &s;
  return nullptr;
}

/// The channel through the same low-pass as the result; NaN at the edges.
std::vector<double> band_limited(const std::vector<double>& x, const take_reconstruction& r) {
  const auto reach = static_cast<int>(std::min(2000.0, 8 * r.rate_Hz / (r.limits.stop_Hz - r.limits.pass_Hz)));
  const rosin::fir kernel = rosin::sample_response([](double) { return 1.0; }, r.limits, r.rate_Hz, -reach, reach);
  rosin::block_convolver<double> convolver(1, std::vector<rosin::fir>{kernel});
  std::vector<double> out(x.size());
  const std::array<std::span<const double>, 1> in{x};
  std::array<std::span<double>, 1> to{out};
  convolver.process(in, to);
  const auto valid = convolver.valid(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    if (i < valid.begin || i >= valid.end) out[i] = nan;
  return out;
}

/// channel = scale * result, means out.
channel_comparison compare(const std::string& name, const std::string& what, const std::vector<double>& channel,
                           const std::vector<double>& result) {
  double n = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  const auto each = [&](auto use) {
    for (std::size_t i = 0; i < channel.size(); ++i)
      if (std::isfinite(channel[i]) && std::isfinite(result[i])) use(result[i], channel[i]);
  };
  each([&](double x, double y) { mx += x, my += y, ++n; });
  if (n > 0) mx /= n, my /= n;
  each([&](double x, double y) { xx += (x - mx) * (x - mx), yy += (y - my) * (y - my), xy += (x - mx) * (y - my); });
  channel_comparison out{name, what, xx > 0 ? xy / xx : 0, 1, xx * yy > 0 ? xy / std::sqrt(xx * yy) : 0};
  std::vector<double> scaled = result;
  for (double& v : scaled) v *= out.scale;
  out.delta = rosin::consistency_delta(channel, scaled);
  return out;
}

}  // namespace

void add_rod_and_normal_force(const rosin::rig&, const rosin::take& take, const checked_take& read, take_reconstruction& r) {
  const std::size_t n = r.force_N.size();
  if (const auto* sled = calibrated_channel(read, rosin::quantity::bow_speed)) {
    r.rod_m_s = sled->values;
    r.rod_from = "channel " + sled->sensor.name;
  } else if (!take.speed_profile_m_s.empty()) {
    r.rod_m_s = from_profile(take.speed_profile_m_s, n, r.rate_Hz);
    r.rod_from = "the declared profile";
  } else if (take.speed_m_s) {
    r.rod_m_s.assign(n, *take.speed_m_s);
    r.rod_from = "speed_m_s";
  }
  if (const auto* gauge = calibrated_channel(read, rosin::quantity::normal_force)) {
    const auto& motion = read.check.motion;
    r.normal_force_N = mean_of(gauge->values, r.bowed());
    r.normal_from = "channel " + gauge->sensor.name;
    if (motion && motion->normal_channel == gauge->sensor.name && motion->steady_normal_force_N) {
      r.normal_force_N = motion->steady_normal_force_N;
      r.normal_from += " where the stroke is steady";
      if (motion->normal_offset_N)
        r.assumed.push_back(rosin::detail::sentence("offset of channel " + gauge->sensor.name, motion->normal_offset_N->value,
                                                    "its level while the bow is off the string (N)"));
    }
  } else if (!take.normal_force_profile_N.empty()) {
    r.normal_force_N = mean_of(from_profile(take.normal_force_profile_N, n, r.rate_Hz), r.bowed());
    r.normal_from = "the declared profile";
  } else if (take.normal_force_N) {
    r.normal_force_N = take.normal_force_N;
    r.normal_from = "normal_force_N";
  }
  const auto differs = [&](const std::string& what, double measured, const std::optional<double>& declared) {
    if (declared && std::abs(measured - *declared) > 0.05 * *declared)
      r.warnings.push_back(what + " is " + in_digits(measured) + " in the mean, declared as " + in_digits(*declared));
  };
  if (r.rod_from.starts_with("channel")) differs("the sled's speed", mean_of(r.rod_m_s, r.bowed()), take.speed_m_s);
  if (r.normal_from.starts_with("channel")) differs("the normal force", *r.normal_force_N, take.normal_force_N);
}

void add_comparisons(const rosin::rig& rig, const rosin::take& take, const checked_take& read, take_reconstruction& r) {
  const double contact = rig.position_of(take).value_or(0);
  for (const auto& s : read.signals.signals) {
    if (s.sensor.quantity != rosin::quantity::string_velocity) continue;
    if (s.sensor.position && std::abs(*s.sensor.position - contact) > 0.02) {
      r.warnings.push_back("channel " + s.sensor.name + " measures at " + in_digits(*s.sensor.position) + ", the contact is at " +
                           in_digits(contact) + ": not compared");
      continue;
    }
    const auto limited = band_limited(s.values, r);
    const auto one = compare(s.sensor.name, "velocity at the contact", limited, r.velocity_m_s);
    r.comparisons.push_back(one);
    if (std::abs(one.correlation) < 0.9)
      r.warnings.push_back("channel " + s.sensor.name + " agrees badly with the reconstructed velocity (correlation " +
                           in_digits(one.correlation) + ")");
    if (one.scale == 0 || !r.magnet_m_s.empty()) continue;
    r.magnet_m_s = limited;
    for (double& v : r.magnet_m_s) v /= one.scale;
  }
}

}  // namespace tool
