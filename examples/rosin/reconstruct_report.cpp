// SPDX-License-Identifier: MIT
#include "reconstruct_report.hpp"
#include "digits.hpp"
#include "reconstruct_slips.hpp"

namespace tool {

namespace {

/// A stretch of the take and what its time axis says.
struct window {
  std::size_t begin = 0, end = 0;
  double rate_Hz = 1, zero_s = 0;
  [[nodiscard]] double ms(std::size_t i) const { return 1e3 * (static_cast<double>(i) / rate_Hz - zero_s); }
  [[nodiscard]] std::string label() const {
    return zero_s > 0 ? "time after " + in_digits(1e3 * zero_s, "%.2f") + " ms / ms" : "time / ms";
  }
  [[nodiscard]] std::pair<double, double> range() const { return {ms(begin), ms(end)}; }
};

window window_of(const take_reconstruction& r, std::size_t begin, std::size_t end) {
  begin = std::max(begin, r.known.begin), end = std::min(end, r.known.end);
  return {begin, std::max(begin + 2, end), r.rate_Hz, std::floor(1e5 * static_cast<double>(begin) / r.rate_Hz) * 1e-5};
}

curve curve_of(const std::string& name, const std::vector<double>& y, const window& w, const char* ink, double width = 1.3,
               int dash = 1) {
  curve c{name, {}, {}, ink, width, dash};
  for (std::size_t i = w.begin; i < std::min(w.end, y.size()); ++i) {
    c.x.push_back(w.ms(i));
    c.y.push_back(y[i]);
  }
  return c;
}

panel panel_of(const std::string& title, const std::string& y_label, const window& w, std::vector<curve> curves) {
  return {title, w.label(), y_label, std::move(curves), {}, w.range(), {}, 250};
}

void mark_slips(panel& p, const take_reconstruction& r, const window& w) {
  for (const auto& [begin, end] : r.slips)
    if (end > w.begin && begin < w.end) p.heavy.emplace_back(w.ms(std::max(begin, w.begin)), w.ms(std::min(end, w.end)));
}

panel velocity_panel(const std::string& letter, const take_reconstruction& r, const window& w) {
  panel p = panel_of(letter + " velocity of the string under the bow", "velocity / (m/s)", w,
                     {curve_of("from near, Eq. (1)", r.velocity_near_m_s, w, colour::pale_near, 3),
                      curve_of("from far", r.velocity_far_m_s, w, colour::far, 1)});
  if (!r.rod_m_s.empty()) p.curves.push_back(curve_of("rod", r.rod_m_s, w, colour::declared, 1.2, 3));
  mark_slips(p, r, w);
  return p;
}

panel force_panel(const std::string& letter, const take_reconstruction& r, const window& w) {
  panel p = panel_of(letter + " friction force", "force / N", w,
                     {curve_of("from near, Eq. (3)", r.force_near_N, w, colour::pale_near, 3),
                      curve_of("from far", r.force_far_N, w, colour::far, 1)});
  mark_slips(p, r, w);
  return p;
}

std::string slips_sentence(const take_reconstruction& r) {
  return r.rod_m_s.empty() ? "" : " Heavy line: the string slips (" + slipping_means(r) + ").";
}

/// Samples of so many periods of the string.
std::size_t periods(const take_reconstruction& r, double count) {
  const double period = r.period_s > 0 ? r.period_s : 1 / r.calibration.fundamental_Hz;
  return static_cast<std::size_t>(count * period * r.rate_Hz);
}

window steady_window(const take_reconstruction& r) {
  const std::size_t begin = r.steady_end > r.steady_begin ? r.steady_begin : (r.known.begin + r.known.end) / 2;
  return window_of(r, begin, begin + periods(r, 4));
}

figure steady_figure(const take_reconstruction& r, const window& w) {
  figure f;
  f.panels = {
      panel_of("(a) forces on the terminations", "force / N", w,
               {curve_of("near", r.result.force_N[0], w, colour::near), curve_of("far", r.result.force_N[1], w, colour::far)}),
      velocity_panel("(b)", r, w), force_panel("(c)", r, w)};
  f.share_axis();
  f.caption = "Four periods where the motion repeats best, from " + in_digits(r.time_s(w.begin), "%.4f") +
              " s on: (a) what was recorded, gains taken out; (b) and (c) both " + "versions, up to " +
              in_digits(1e-3 * r.limits.stop_Hz, "%.0f") + " kHz, Delta " + in_digits(r.delta_velocity, "%.4f") + " and " +
              in_digits(r.delta_force, "%.4f") + " over the whole take." + slips_sentence(r);
  if (r.ac_coupled) f.caption += " AC coupled sensors: the force's mean is unknown.";
  return f;
}

figure plane_figure(const take_reconstruction& r, const window& w) {
  panel p{"force against velocity",
          "velocity of the string / (m/s)",
          r.ac_coupled ? "force, mean unknown / N" : "force / N",
          {},
          {},
          {},
          {},
          430};
  curve loop{"mean of both versions", {}, {}, colour::mean, 1.1, 1}, rod{"rod", {}, {}, colour::declared, 1.4, 3};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t i = w.begin; i < w.end; ++i) {
    loop.x.push_back(r.velocity_m_s[i]);
    loop.y.push_back(r.force_N[i]);
    if (std::isfinite(r.force_N[i])) low = std::min(low, r.force_N[i]), high = std::max(high, r.force_N[i]);
  }
  p.curves.push_back(loop);
  if (!r.rod_m_s.empty()) {
    rod.x = {r.rod_m_s[w.begin], r.rod_m_s[w.begin]};
    rod.y = {low, high};
    p.curves.push_back(rod);
  }
  std::string caption =
      "The same four periods in the plane of velocity and force (the string's centre; torsion of the surface is not in it).";
  if (!r.rod_m_s.empty()) caption += " The string sticks along the dotted line of the rod's speed and slips to the left of it.";
  if (r.normal_force_N && !r.ac_coupled)
    caption += " Divided by the normal force of " + in_digits(*r.normal_force_N) + " N (" + r.normal_from +
               ") the force is the friction coefficient.";
  return {caption, {p}, 680};
}

/// The first slips: from one period before the first of them that is long enough to be one.
std::optional<figure> transient_figure(const take_reconstruction& r) {
  for (const auto& [begin, end] : r.slips) {
    if (end - begin < 3) continue;
    const std::size_t before = std::min(begin, periods(r, 2));
    const window w = window_of(r, begin - before, begin + periods(r, 7));
    figure f;
    f.panels = {velocity_panel("(a)", r, w), force_panel("(b)", r, w)};
    f.share_axis();
    f.caption = "The transient: the first slips of the take." + slips_sentence(r);
    return f;
  }
  return std::nullopt;
}

/// One period's grid laid over the take's samples.
curve periodic_curve(const std::vector<double>& near, const std::vector<double>& far, const take_reconstruction& r,
                     const window& w) {
  curve c{"frequency domain", {}, {}, colour::model, 1.2, 2};
  const auto& source = r.result.periodic->source;
  const auto N = near.size();
  const double step = source.period / static_cast<double>(N);
  for (double at = static_cast<double>(source.begin), n = 0; at < static_cast<double>(w.end); at += step, ++n) {
    if (at < static_cast<double>(w.begin)) continue;
    const auto i = static_cast<std::size_t>(n) % N;
    c.x.push_back(1e3 * (at / r.rate_Hz - w.zero_s));
    c.y.push_back(0.5 * (near[i] + far[i]));
  }
  return c;
}

std::optional<figure> domains_figure(const take_reconstruction& r) {
  if (!r.result.periodic || !r.domains_differ) return std::nullopt;
  const auto& m = r.result.motion;
  const auto& p = *r.result.periodic;
  const std::size_t begin = std::max(p.source.begin, m.known.begin);
  const window w = window_of(r, begin, begin + periods(r, 2));
  std::vector<double> v(m.force_near_N.size()), f(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) v[i] = m.velocity_m_s(i), f[i] = m.force_N(i);
  figure out;
  out.panels = {
      panel_of("(a) velocity", "velocity / (m/s)", w,
               {curve_of("time domain", v, w, colour::near, 1.8), periodic_curve(p.velocity_near_m_s, p.velocity_far_m_s, r, w)}),
      panel_of("(b) force", "force / N", w,
               {curve_of("time domain", f, w, colour::near, 1.8), periodic_curve(p.force_near_N, p.force_far_N, r, w)})};
  out.share_axis();
  out.caption =
      "Time domain against frequency domain (seven periods averaged as a Fourier series, two of them shown): Delta of the "
      "force " +
      in_digits(*r.domains_differ, "%.4f") + "; the part of the take that does not repeat there is " +
      in_digits(100 * p.source.remainder, "%.2g") + " %.";
  return out;
}

std::optional<figure> torsion_figure(const take_reconstruction& r, const window& w) {
  if (r.torsion_m_s.empty()) return std::nullopt;
  panel p = panel_of("string's centre and its rolling", "velocity / (m/s)", w,
                     {curve_of("centre", r.velocity_m_s, w, colour::near),
                      curve_of("surface by rotation", r.torsion_m_s, w, colour::slip, 1.1)});
  if (!r.rod_m_s.empty()) p.curves.push_back(curve_of("rod", r.rod_m_s, w, colour::declared, 1.2, 3));
  return figure{
      "Velocity of the string's centre, and of its surface by rotation: a model of torsion with the declared speed, impedance "
      "and Q, driven by the reconstructed force. "
      "Where the string sticks, both together make the rod's speed.",
      {p},
      920};
}

std::optional<figure> magnet_figure(const take_reconstruction& r, const window& w) {
  if (r.magnet_m_s.empty()) return std::nullopt;
  const auto& c = r.comparisons.front();
  panel p = panel_of("velocity at the contact", "velocity / (m/s)", w,
                     {curve_of("reconstructed", r.velocity_m_s, w, colour::near, 1.8),
                      curve_of("channel " + c.channel + ", scaled", r.magnet_m_s, w, colour::model, 1.1, 2)});
  return figure{"The reconstructed velocity against a sensor at the contact, in the same band, after one scale factor: Delta " +
                    in_digits(c.delta, "%.4f") + ", correlation " + in_digits(c.correlation, "%.5f") + ".",
                {p},
                920};
}

}  // namespace

exit_code write_reconstruction_report(const std::string& path, bool force, const take_reconstruction& r,
                                      const std::optional<rig_calibration>& fitted, const provenance& from) {
  report_page page;
  page.title = r.title + ": " + r.take;
  page.summary = summary_of(r);
  page.warnings = r.warnings;
  page.assumed = r.assumed;
  page.result = facts_of(r);
  const window steady = steady_window(r);
  page.figures = {steady_figure(r, steady), plane_figure(r, steady)};
  for (auto& f : figures_of(slips_of(r), r, steady.begin, steady.begin + periods(r, 8))) page.figures.push_back(std::move(f));
  for (auto f : {transient_figure(r), domains_figure(r), torsion_figure(r, steady), magnet_figure(r, steady)})
    if (f) page.figures.push_back(*std::move(f));
  if (fitted) {
    if (!fitted->drawn.empty()) page.figures.push_back(pluck_figure(fitted->drawn.front(), r.calibration.fundamental_Hz, false));
    page.calibration = rows_of(*fitted);
  } else {
    page.notes.push_back("The calibration was read from " + r.calibration.from +
                         ": its plucks and table stand in that fit's own report.");
  }
  return write_page(path, force, std::move(page), from);
}

}  // namespace tool
