// SPDX-License-Identifier: MIT
//
// A reconstruction as table, as JSON, and in words.
//
#include "digits.hpp"
#include "reconstruct_slips.hpp"

namespace tool {

namespace {

std::string processing(const take_reconstruction& r) {
  std::string out = r.how.frequency_domain ? "frequency domain" : "time domain";
  return out + (r.how.paper ? ", the paper's processing (no force factor, no near field, no loss)"
                            : ", with force factor, near field and loss of the stiff string");
}

/// What the shift means: tension, place, gain.
struct tuning_in_words {
  double tension = 0, contact = 0, gain = 0;
};
tuning_in_words words_of(const take_reconstruction& r) {
  const auto& s = r.result.tuning->shift;
  const double one_way = r.before.at.delay_s[0] + r.before.at.delay_s[1], sum = s[0] + s[1];
  return {-2 * sum / one_way, (s[0] - r.before.position * sum) / one_way, s[5]};
}

double mean_square(const std::vector<double>& x, rosin::sample_range known) {
  double sum = 0;
  for (std::size_t i = known.begin; i < known.end; ++i) sum += x[i] * x[i];
  return sum / static_cast<double>(std::max<std::size_t>(1, known.end - known.begin));
}

std::pair<double, double> extremes(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = begin; i < end && i < x.size(); ++i)
    if (std::isfinite(x[i])) low = std::min(low, x[i]), high = std::max(high, x[i]);
  return {low, high};
}

/// Where the motion is steady, or all that is known while the bow is on.
rosin::sample_range main_part(const take_reconstruction& r) {
  if (r.steady_end > r.steady_begin) return {std::max(r.steady_begin, r.known.begin), std::min(r.steady_end, r.known.end)};
  return r.bowed();
}

double slipping_fraction(const take_reconstruction& r, rosin::sample_range in) {
  double count = 0;
  for (const auto& [begin, end] : r.slips)
    for (std::size_t i = std::max(begin, in.begin); i < std::min(end, in.end); ++i) ++count;
  return count / static_cast<double>(std::max<std::size_t>(1, in.end - in.begin));
}

json tuning_json(const take_reconstruction& r) {
  if (!r.result.tuning) return nullptr;
  const auto& t = *r.result.tuning;
  const auto w = words_of(r);
  return {{"delta_before", t.delta_before},
          {"delta_after", t.delta_after},
          {"sigmas", t.sigmas},
          {"iterations", t.iterations},
          {"shift_delay_near_s", t.shift[0]},
          {"shift_delay_far_s", t.shift[1]},
          {"shift_ln_gain_ratio", t.shift[5]},
          {"as_tension_relative", w.tension},
          {"as_contact_fraction", w.contact},
          {"tuned_on_s", {r.time_s(r.result.tuned_on.begin), r.time_s(r.result.tuned_on.end)}}};
}

std::string tuning_text(const take_reconstruction& r) {
  if (!r.result.tuning) return "off";
  const auto& t = *r.result.tuning;
  const auto w = words_of(r);
  return "delays " + in_digits(1e9 * t.shift[0], "%+.1f") + " and " + in_digits(1e9 * t.shift[1], "%+.1f") + " ns, gain ratio " +
         in_digits(100 * t.shift[5], "%+.4f") + " %, " + in_digits(t.sigmas, "%.1f") + " standard deviations; as tension " +
         in_digits(100 * w.tension, "%+.4f") + " %, as contact " + in_digits(w.contact, "%+.6f") + " of the length; Delta " +
         in_digits(t.delta_before, "%.5f") + " -> " + in_digits(t.delta_after, "%.5f");
}

std::string dc_text(const take_reconstruction& r) {
  if (!r.ac_coupled) return "measured (DC coupled sensors)";
  if (!r.dc.available) return "unknown: AC coupled sensors; force_N has no mean of its own";
  return "unknown: AC coupled sensors; estimated as " + in_digits(r.dc.level_N, "%+.3f") + " +- " + in_digits(r.dc.sd_N, "%.3f") +
         " N to be added (" +
         (r.dc_from == "thermal-law" ? "the slips follow the contact's temperature, whose heat knows where zero is"
                                     : "a friction coefficient of 0.65 +- 0.15 in mid-slip times the normal force") +
         "); not added in the file";
}

}  // namespace

std::string slipping_means(const take_reconstruction& r) {
  return std::string(r.torsion_m_s.empty() ? "the string's centre" : "the surface, rolling included,") +
         " slower than half the rod until back at three quarters; rod: " + r.rod_from;
}

std::vector<std::pair<std::string, std::string>> facts_of(const take_reconstruction& r) {
  const auto part = main_part(r);
  const auto [low, high] = extremes(r.force_N, part.begin, part.end);
  const auto& sd = r.result.sd;
  std::vector<std::pair<std::string, std::string>> out{
      {"processing", processing(r)},
      {"band", "pass " + in_digits(r.limits.pass_Hz, "%.0f") + " Hz, stop " + in_digits(r.limits.stop_Hz, "%.0f") + " Hz"},
      {"known", in_digits(r.time_s(r.known.begin), "%.6f") + " to " + in_digits(r.time_s(r.known.end), "%.6f") + " s of " +
                    in_digits(r.sampled_s, "%.6f") + " s"},
      {"calibration", r.calibration.from + "; contact at " + in_digits(r.result.used.position, "%.6f") + ", delays " +
                          in_digits(1e6 * r.result.used.at.delay_s[0], "%.4f") + " and " +
                          in_digits(1e6 * r.result.used.at.delay_s[1], "%.4f") + " us, gains " +
                          in_digits(r.result.used.gain[0], "%.5f") + " and " + in_digits(r.result.used.gain[1], "%.5f")},
      {"fine tuning", tuning_text(r)},
      {"Delta of the two versions, Eq. (12)",
       "force " + in_digits(r.delta_force, "%.5f") + ", velocity " + in_digits(r.delta_velocity, "%.5f")},
      {"force, random sd", in_digits(1e3 * std::sqrt(mean_square(r.force_sd_N, r.known)), "%.3g") + " mN rms (sensor noise " +
                               in_digits(1e3 * sd.force_noise_N, "%.3g") + ", versions disagree " +
                               in_digits(1e3 * sd.force_model_N, "%.3g") + ", rest calibration)"},
      {"velocity, random sd", in_digits(1e3 * std::sqrt(mean_square(r.velocity_sd_m_s, r.known)), "%.3g") +
                                  " mm/s rms (sensor noise " + in_digits(1e3 * sd.velocity_noise_m_s, "%.3g") +
                                  ", versions disagree " + in_digits(1e3 * sd.velocity_model_m_s, "%.3g") +
                                  ", rest calibration)"},
      {"common scale, systematic sd",
       "force " + in_digits(100 * sd.force_scale, "%.2f") + " %, velocity " + in_digits(100 * sd.velocity_scale, "%.2f") + " %"},
      {"force's DC level", dc_text(r)},
      {"force in the steady part",
       in_digits(low, "%.4f") + " to " + in_digits(high, "%.4f") + " N" +
           (r.normal_force_N ? ", normal force " + in_digits(*r.normal_force_N, "%.4f") + " N (" + r.normal_from + ")" : "")}};
  if (r.period_s > 0)
    out.emplace_back("repeats every", in_digits(1e3 * r.period_s, "%.5f") + " ms (" + in_digits(1 / r.period_s, "%.2f") +
                                          " Hz), best from " + in_digits(r.time_s(r.steady_begin), "%.4f") + " s on, remainder " +
                                          in_digits(100 * r.result.periodic->source.remainder, "%.2g") + " %");
  if (r.domains_differ)
    out.emplace_back("time against frequency domain", "Delta of the force " + in_digits(*r.domains_differ, "%.5f"));
  if (!r.rod_m_s.empty())
    out.emplace_back("slips", std::to_string(r.slips.size()) + " in all; " +
                                  (r.period_s > 0 ? in_digits(r.slips_per_period(), "%.2f") + " a period and " : "") +
                                  in_digits(100 * slipping_fraction(r, part), "%.1f") + " % of the time in the steady part (" +
                                  slipping_means(r) + ")");
  if (r.lifted) out.emplace_back("free decay at the end", decay_text(r));
  for (auto& fact : facts_of(slips_of(r), r)) out.push_back(std::move(fact));
  for (const auto& c : r.comparisons)
    out.emplace_back("channel " + c.channel + " against the result", c.what + ": channel = " + in_digits(c.scale, "%.5g") +
                                                                         " x result, Delta " + in_digits(c.delta, "%.4f") +
                                                                         ", correlation " + in_digits(c.correlation, "%.5f"));
  return out;
}

std::string summary_of(const take_reconstruction& r) {
  const auto part = main_part(r);
  const auto [low, high] = extremes(r.force_N, part.begin, part.end);
  std::string out = r.take + ": ";
  if (r.period_s > 0 && !r.rod_m_s.empty() && !r.slips.empty())
    out += "motion with " + in_digits(r.slips_per_period(), "%.2g") +
           (std::abs(r.slips_per_period() - 1) < 0.05 ? " slip" : " slips") + " a period of " +
           in_digits(1e3 * r.period_s, "%.4g") + " ms; ";
  out += "friction runs from " + in_digits(low, "%.3f") + " to " + in_digits(high, "%.3f") + " N" +
         (r.ac_coupled ? " about an unknown mean" : "") + ", random error " +
         in_digits(1e3 * std::sqrt(mean_square(r.force_sd_N, r.known)), "%.2g") + " mN, common scale +- " +
         in_digits(100 * r.result.sd.force_scale, "%.2g") +
         " %; its two versions differ by Delta = " + in_digits(r.delta_force, "%.4f") + ".";
  return out;
}

rosin::table table_of(const take_reconstruction& r, const provenance& from) {
  rosin::table t;
  t.comments = from.comment_lines();
  t.comments.push_back("rig " + r.title);
  t.comments.push_back("take " + r.take + ", " + std::to_string(r.force_N.size()) + " samples at " +
                       in_digits(r.rate_Hz, "%.10g") + " Hz");
  for (const auto& [what, value] : facts_of(r)) t.comments.push_back(what + ": " + value);
  if (!r.torsion_m_s.empty())
    t.comments.emplace_back("torsion_velocity_m_s: a model driven by the force, with the declared [torsion]");
  t.comments.emplace_back(
      "..._sd_...: random, one standard deviation; ..._scale_sd_...: systematic, common to all samples; empty: cannot be known");
  for (const auto& line : r.warnings) t.comments.push_back("warning: " + line);
  for (const auto& line : r.assumed) t.comments.push_back("assumed: " + line);
  const std::size_t n = r.force_N.size();
  std::vector<double> time(n), force_scale(n), velocity_scale(n);
  for (std::size_t i = 0; i < n; ++i) {
    time[i] = r.time_s(i);
    force_scale[i] = std::abs(r.force_N[i]) * r.result.sd.force_scale;
    velocity_scale[i] = std::abs(r.velocity_m_s[i]) * r.result.sd.velocity_scale;
  }
  t.add("time_s", time, 12);
  t.add("force_N", r.force_N);
  t.add("velocity_m_s", r.velocity_m_s);
  t.add("force_near_N", r.force_near_N);
  t.add("force_far_N", r.force_far_N);
  t.add("velocity_near_m_s", r.velocity_near_m_s);
  t.add("velocity_far_m_s", r.velocity_far_m_s);
  t.add("force_sd_N", r.force_sd_N, 5);
  t.add("velocity_sd_m_s", r.velocity_sd_m_s, 5);
  t.add("torsion_velocity_m_s", r.torsion_m_s.empty() ? std::vector<double>(n, nan) : r.torsion_m_s);
  t.add("force_scale_sd_N", force_scale, 5);
  t.add("velocity_scale_sd_m_s", velocity_scale, 5);
  const auto place = slips_of(r).place_m;
  t.add("place_on_rod_m", place.empty() ? std::vector<double>(n, nan) : place);
  return t;
}

json to_json(const take_reconstruction& r, const provenance& from) {
  const auto part = main_part(r);
  const auto [low, high] = extremes(r.force_N, part.begin, part.end);
  const auto& u = r.result.used;
  json out{{"schema", 1},
           {"format", "reconstruction-summary"},
           {"provenance", from.to_json()},
           {"rig", r.title},
           {"take", r.take},
           {"samples", r.force_N.size()},
           {"sampling_rate_Hz", r.rate_Hz},
           {"band_Hz", {r.limits.pass_Hz, r.limits.stop_Hz}},
           {"domain", r.how.frequency_domain ? "frequency" : "time"},
           {"physics", r.how.paper ? "paper" : "full"},
           {"known_samples", {r.known.begin, r.known.end}}};
  out["calibration"] = {{"from", r.calibration.from},
                        {"position", u.position},
                        {"delay_near_s", u.at.delay_s[0]},
                        {"delay_far_s", u.at.delay_s[1]},
                        {"stiffness_s2", u.at.stiffness_s2},
                        {"impedance_Ns_m", u.at.impedance_Ns_m},
                        {"gain_near", u.gain[0]},
                        {"gain_far", u.gain[1]}};
  out["fine_tuning"] = tuning_json(r);
  out["delta"] = {{"force", r.delta_force},
                  {"velocity", r.delta_velocity},
                  {"time_against_frequency_domain", r.domains_differ ? json(*r.domains_differ) : json(nullptr)}};
  const auto& sd = r.result.sd;
  out["force"] = {{"random_sd_N", number_or_null(std::sqrt(mean_square(r.force_sd_N, r.known)))},
                  {"noise_sd_N", sd.force_noise_N},
                  {"model_sd_N", sd.force_model_N},
                  {"scale_relative_sd", sd.force_scale},
                  {"steady_minimum_N", number_or_null(low)},
                  {"steady_maximum_N", number_or_null(high)}};
  out["velocity"] = {{"random_sd_m_s", number_or_null(std::sqrt(mean_square(r.velocity_sd_m_s, r.known)))},
                     {"noise_sd_m_s", sd.velocity_noise_m_s},
                     {"model_sd_m_s", sd.velocity_model_m_s},
                     {"scale_relative_sd", sd.velocity_scale}};
  out["dc_level"] = r.dc.available
                        ? json{{"estimate_N", r.dc.level_N}, {"sd_N", r.dc.sd_N}, {"from", r.dc_from}, {"added", false}}
                        : json(nullptr);
  out["period_s"] = r.period_s > 0 ? json(r.period_s) : json(nullptr);
  out["steady_s"] = {r.time_s(part.begin), r.time_s(part.end)};
  out["slips"] = json::array();
  for (const auto& [begin, end] : r.slips) out["slips"].push_back({r.time_s(begin), r.time_s(end)});
  out["loops"] = to_json(slips_of(r));
  out["free_decay"] = decay_json(r);
  out["comparisons"] = json::array();
  for (const auto& c : r.comparisons)
    out["comparisons"].push_back(
        {{"channel", c.channel}, {"what", c.what}, {"scale", c.scale}, {"delta", c.delta}, {"correlation", c.correlation}});
  out["warnings"] = r.warnings;
  out["assumed"] = r.assumed;
  return out;
}

}  // namespace tool
