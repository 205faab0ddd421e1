// SPDX-License-Identifier: MIT
//
// The page of a diagnosis: a sentence, the picture of the mismatch, the picture after, the parameters, the runners-up, what was
// not done.
//
#include "diagnose_pickup_page.hpp"
#include "digits.hpp"
#include "report_page.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace tool {

namespace {

const char* ink(std::size_t c) { return c == 0 ? colour::near : colour::far; }
std::string end_name(std::size_t c) { return c == 0 ? "near end" : "far end"; }

/// The first four periods and what noise alone would leave, in mN over ms of the take.
panel residual_panel(const residual_picture& r, const residual_series& s, std::size_t c, double half_height) {
  panel p{std::string(c == 0 ? "(a) " : "(b) ") + end_name(c),
          "time in " + r.take + " / ms",
          "residual / mN",
          {},
          {},
          {},
          std::pair{-half_height, half_height},
          220};
  curve left{"recorded - model", {}, {}, ink(c), 1.2};
  const auto end = static_cast<std::size_t>(4 * r.rate_Hz / r.fundamental_Hz);
  for (std::size_t i = 0; i < std::min(end, s.force_N[c].size()); ++i) {
    left.x.push_back(1e3 * (s.begin_s + static_cast<double>(i) / r.rate_Hz));
    left.y.push_back(1e3 * s.force_N[c][i]);
  }
  const double from = 1e3 * r.before.begin_s, to = from + 4e3 / r.fundamental_Hz, two_sd = 2e3 * r.noise_N[c];
  p.x_range = std::pair{from, to};
  p.curves = {left,
              {"noise, two standard deviations", {from, to}, {two_sd, two_sd}, colour::model, 1, 2},
              {"", {from, to}, {-two_sd, -two_sd}, colour::model, 1, 2}};
  return p;
}

/// Whether the stretch that is drawn holds the place where the residual is largest.
bool is_drawn(const residual_picture& r, const rig_diagnosis& d) {
  return d.time_s && d.take == r.take && (*d.time_s)[0] < r.before.begin_s + 4 / r.fundamental_Hz;
}

double half_height_of(const residual_picture& r) {
  double most = 2.5 * std::max(r.noise_N[0], r.noise_N[1]);
  const auto end = static_cast<std::size_t>(4 * r.rate_Hz / r.fundamental_Hz);
  for (const auto& s : r.before.force_N)
    for (std::size_t i = 0; i < std::min(end, s.size()); ++i) most = std::max(most, std::abs(s[i]));
  return 1.1e3 * most;
}

figure residual_figure(const residual_picture& r, const residual_series& s, const rig_diagnosis& d) {
  figure f;
  for (std::size_t c = 0; c < 2; ++c) {
    panel p = residual_panel(r, s, c, half_height_of(r));
    if (is_drawn(r, d) && (d.channel.empty() || d.channel == (c == 0 ? "near" : "far")))
      p.heavy = {{1e3 * (*d.time_s)[0], 1e3 * (*d.time_s)[1]}};
    f.panels.push_back(p);
  }
  f.share_axis();
  return f;
}

/// N per root Hz over the whole stretch: Hann windows of four periods that overlap by half, averaged.
std::vector<double> density(const std::vector<double>& x, double rate_Hz, std::size_t window, std::size_t bins) {
  std::vector<double> out(bins, 0.0);
  window = std::min(window, x.size());
  if (window < 8) return out;
  std::vector<double> hann(window);
  for (std::size_t i = 0; i < window; ++i)
    hann[i] = 1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(window));
  double count = 0;
  for (std::size_t at = 0; at + window <= x.size(); at += window / 2, ++count)
    for (std::size_t k = 0; k < bins; ++k) {
      const auto turn = std::polar(1.0, -std::numbers::pi * static_cast<double>(k) / static_cast<double>(bins));
      std::complex<double> sum = 0;
      for (std::size_t i = window; i-- > 0;) sum = sum * turn + hann[i] * x[at + i];
      out[k] += std::norm(sum);
    }
  for (double& v : out) v = std::sqrt(2 * v / (count * 1.5 * static_cast<double>(window) * rate_Hz));
  return out;
}

curve spectrum(const std::string& name, const std::vector<double>& x, const residual_picture& r, const char* colour, double width,
               int dash) {
  curve c{name, {}, {}, colour, width, dash};
  const auto window = static_cast<std::size_t>(4 * r.rate_Hz / r.fundamental_Hz);
  const std::size_t bins = std::clamp<std::size_t>(window / 2, 64, 1024);
  const std::vector<double> y = density(x, r.rate_Hz, window, bins);
  for (std::size_t k = 1; k < bins; ++k) {
    const double hz = 0.5 * r.rate_Hz * static_cast<double>(k) / static_cast<double>(bins);
    if (hz > r.limits.pass_Hz) break;
    c.x.push_back(1e-3 * hz);
    c.y.push_back(20 * std::log10(std::max(1e-12, y[k])));
  }
  return c;
}

figure spectrum_figure(const residual_picture& r, const rig_diagnosis& d, bool corrected) {
  figure f;
  for (std::size_t c = 0; c < 2; ++c) {
    panel p{std::string(c == 0 ? "(a) " : "(b) ") + end_name(c), "frequency / kHz", "dB re 1 N / root Hz", {}, {}, {}, {}, 230};
    p.curves.push_back(spectrum(corrected ? "as declared" : "left", r.before.force_N[c], r, ink(c), 1.5, 1));
    if (corrected) p.curves.push_back(spectrum("corrected", r.after.force_N[c], r, colour::model, 1.2, 1));
    const double level = 20 * std::log10(r.noise_N_per_root_Hz[c]);
    p.curves.push_back({"noise", {0, 1e-3 * r.limits.pass_Hz}, {level, level}, colour::slip, 1.6, 2});
    double top = level + 10;
    for (const auto& k : p.curves) top = std::max(top, *std::max_element(k.y.begin(), k.y.end()) + 8);
    p.y_range = std::pair{level - 15, top};
    p.x_range = std::pair{0.0, 1e-3 * r.limits.pass_Hz};
    if (d.band_Hz && d.take == r.take && d.channel == (c == 0 ? "near" : "far"))
      p.heavy = {{1e-3 * (*d.band_Hz)[0], 1e-3 * std::min((*d.band_Hz)[1], r.limits.pass_Hz)}};
    f.panels.push_back(p);
  }
  f.share_axis();
  const double seconds = static_cast<double>(r.before.force_N[0].size()) / r.rate_Hz;
  f.caption = "Spectrum of what is left over the first " + in_digits(1e3 * seconds, "%.0f") +
              " ms (Hann windows of four periods), and the level of the noise.";
  if (!f.panels[0].heavy.empty() || !f.panels[1].heavy.empty())
    f.caption += " The bar marks the band that holds most of it where the residual is largest.";
  return f;
}

/// What is left at the samples that stick, or slip; a gap wherever they do not.
curve left_curve(const rosin::contact_trace& trace, const std::array<double, 2>& shown_s, const char* colour) {
  curve c{"left", {}, {}, colour, 1.4};
  double step = 1e9;
  for (std::size_t i = 1; i < trace.time_s.size(); ++i) step = std::min(step, trace.time_s[i] - trace.time_s[i - 1]);
  for (std::size_t i = 0; i < trace.time_s.size(); ++i) {
    if (trace.time_s[i] < shown_s[0] || trace.time_s[i] > shown_s[1]) continue;
    const double x = 1e3 * trace.time_s[i];
    if (!c.x.empty() && x - c.x.back() > 2.5e3 * step) c.x.push_back(x), c.y.push_back(std::nan(""));
    c.x.push_back(x), c.y.push_back(trace.left[i]);
  }
  return c;
}

figure contact_figure(const contact_picture& p) {
  const bool sticks = p.statistic == "stick-fluctuation";
  figure f;
  double most = 2.5 * p.noise;
  const auto add = [&](const rosin::contact_trace& trace, const char* title, const char* colour) {
    panel one{title, "time in " + p.take + " / ms", sticks ? "of the rod's speed" : "coefficient of friction", {}, {}, {}, {},
              230};
    const std::pair range{1e3 * p.shown_s[0], 1e3 * p.shown_s[1]};
    one.curves = {
        left_curve(trace, p.shown_s, colour),
        {"noise, two standard deviations", {range.first, range.second}, {2 * p.noise, 2 * p.noise}, colour::model, 1, 2},
        {"", {range.first, range.second}, {-2 * p.noise, -2 * p.noise}, colour::model, 1, 2}};
    std::vector<double> sizes;
    for (const double y : one.curves.front().y)
      if (std::isfinite(y)) sizes.push_back(std::abs(y));
    std::sort(sizes.begin(), sizes.end());
    if (!sizes.empty()) most = std::max(most, 1.2 * sizes[(sizes.size() - 1) * 97 / 100]);
    one.x_range = range;
    f.panels.push_back(one);
  };
  add(p.before.front(), "(a) as declared", colour::near);
  if (!p.after.empty()) add(p.after.front(), "(b) corrected", colour::far);
  for (auto& one : f.panels) one.y_range = std::pair{-1.1 * most, 1.1 * most};
  f.share_axis();
  f.caption = (sticks ? "Where the string sticks: its surface's velocity less the rod's, in "
                      : "Where the string slips: the force over the normal force less what the law of friction has, in ") +
              p.take + ", the stretch in which most of it is left by the contact as declared" +
              (p.after.empty() ? "." : ", and by the corrected one.");
  return f;
}

/// What is left in each tenth of a stick, or of a slip.
figure cycle_figure(const contact_picture& p, double noise) {
  const bool sticks = p.statistic == "stick-fluctuation";
  panel one{"",
            sticks ? "part of the stick: 0 begun, 1 about to slip" : "part of the slip: 0 begun, 1 about to stick",
            sticks ? "of the rod's speed" : "friction",
            {},
            {},
            std::pair{0.0, 1.0},
            {},
            230};
  double most = 2 * noise;
  const auto add = [&](const char* name, const std::vector<double>& left, const char* colour) {
    curve c{name, {}, {}, colour, 1.6};
    for (std::size_t k = 0; k < left.size(); ++k)
      for (const std::size_t edge : {k, k + 1}) {
        c.x.push_back(static_cast<double>(edge) / static_cast<double>(left.size())), c.y.push_back(left[k]);
        most = std::max(most, left[k]);
      }
    if (!left.empty()) one.curves.push_back(c);
  };
  add("as declared", p.cycle_before, colour::near);
  add("corrected", p.cycle_after, colour::far);
  one.curves.push_back({"noise", {0, 1}, {noise, noise}, colour::model, 1, 2});
  one.y_range = std::pair{0.0, 1.15 * most};
  return {std::string{"Which part of the cycle it stands in: rms of what is left in each tenth of "} +
              (sticks ? "a stick" : "a slip") + ", over all of " + p.take + ".",
          {one}};
}

/// The map's first echoes, octave by octave.
figure map_figure(const residual_picture& r) {
  constexpr int most_echoes = 16;
  figure f;
  const auto& edges = r.map->band_Hz;
  for (std::size_t c = 0; c < 2; ++c) {
    panel p{
        std::string(c == 0 ? "(a) " : "(b) ") + end_name(c), "time in " + r.take + " / ms", "band / kHz", {}, {}, {}, {}, 230};
    const auto& m = r.map->channels[c];
    for (std::size_t row = 0; row < m.echo.size() && m.echo[row] <= most_echoes; ++row)
      for (std::size_t b = 0; b + 1 < edges.size(); ++b)
        p.cells.push_back({1e3 * m.time_s[row], 1e3 * m.time_s[row + 1], static_cast<double>(b), static_cast<double>(b + 1),
                           m.over_noise(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(b))});
    for (std::size_t b = 0; b < edges.size(); ++b)
      p.y_marks.emplace_back(static_cast<double>(b), in_digits(1e-3 * edges[b], "%.2g"));
    if (p.cells.empty()) return {};
    p.x_range = std::pair{p.cells.front().from_x, p.cells.back().to_x};
    p.y_range = std::pair{0.0, static_cast<double>(edges.size() - 1)};
    f.panels.push_back(p);
  }
  f.share_axis();
  f.caption =
      "What the declared model leaves of " + r.take +
      ", from each arrival of a wave at that end to the next (the first: the direct wave) and octave by octave: rms over that of "
      "the noise.";
  return f;
}

/// The pluck as a force at its place, by both ends.
figure force_figure(const residual_picture& r) {
  const pluck_force_picture& force = *r.force;
  const double release_s = r.echoes[0].release_s, from = 1e3 * (release_s - 0.4 / r.fundamental_Hz),
               to = 1e3 * (release_s + 1.5 / r.fundamental_Hz);
  panel both{"(a) both versions", "", "force / N", {}, {}, std::pair{from, to}, {}, 230},
      apart{"(b) their difference, and their mean less the release",
            "time in " + r.take + " / ms",
            "mN",
            {},
            {},
            std::pair{from, to},
            {},
            230};
  curve near{"near", {}, {}, colour::near, 1.6}, far{"far", {}, {}, colour::far, 1.2},
      step{"release", {}, {}, colour::model, 1, 2}, parting{"near - far", {}, {}, colour::slip, 1.3},
      shape{"mean - release", {}, {}, colour::mean, 1.3};
  for (std::size_t i = 0; i < force.near_N.size(); ++i) {
    const double ms = 1e3 * (force.begin_s + static_cast<double>(i) / r.rate_Hz);
    if (ms < from || ms > to) continue;
    for (curve* c : {&near, &far, &step, &parting, &shape}) c->x.push_back(ms);
    near.y.push_back(force.near_N[i]), far.y.push_back(force.far_N[i]), step.y.push_back(force.step_N[i]);
    parting.y.push_back(1e3 * (force.near_N[i] - force.far_N[i]));
    shape.y.push_back(1e3 * (0.5 * (force.near_N[i] + force.far_N[i]) - force.step_N[i]));
  }
  both.curves = {near, far, step}, apart.curves = {parting, shape};
  figure f;
  f.panels = {both, apart};
  f.share_axis();
  f.caption = "The plucking force of " + r.take +
              " as either end has it by the declared model. Over eight periods the versions part by " +
              in_digits(1e3 * force.parting_N) + " mN rms (" + in_digits(1e3 * force.parting_noise_N) +
              " from noise), their mean is off a release by " + in_digits(1e3 * force.shape_N) + " mN (" +
              in_digits(1e3 * force.shape_noise_N) + ").";
  return f;
}

void add_figures(const rig_diagnosis& d, report_page& page) {
  if (d.pickup) page.figures = pickup_figures(d);
  if (d.contact && !d.contact->before.empty()) page.figures.push_back(contact_figure(*d.contact));
  if (d.contact && !d.contact->cycle_before.empty()) page.figures.push_back(cycle_figure(*d.contact, d.contact->noise));
  if (!d.residual) return;
  const residual_picture& r = *d.residual;
  const bool told = d.time_s && d.take == r.take,
             corrected = d.after && told && std::any_of(d.missing.begin(), d.missing.end(), [&](const auto&) {
                           return r.before.force_N != r.after.force_N;
                         });
  figure before = residual_figure(r, r.before, d);
  before.caption = "What the declared model leaves of " + r.take + " " + r.stretch + ", both ends, up to " +
                   in_digits(1e-3 * r.limits.stop_Hz, "%.0f") + " kHz.";
  const std::string where = !told || is_drawn(r, d) ? r.bar
                                                    : "It is largest later, at " + in_digits(1e3 * (*d.time_s)[0], "%.1f") +
                                                          " ms in channel " + d.channel + r.bar.substr(r.bar.find(';'));
  if (told) before.caption += " " + where + " " + in_digits(d.residual_over_noise) + " times the noise.";
  else before.caption += " It is within the noise: the plucks show no mismatch.";
  page.figures.push_back(before);
  if (corrected) {
    figure after = residual_figure(r, r.after, d);
    after.caption = "The same, same axes, with the model corrected by what was found.";
    page.figures.push_back(after);
  }
  page.figures.push_back(spectrum_figure(r, d, corrected));
  if (r.map && told) page.figures.push_back(map_figure(r));
  if (r.force && told) page.figures.push_back(force_figure(r));
}

std::string list_of(const std::vector<std::string>& names, const char* none) {
  std::string out;
  for (const auto& n : names) out += (out.empty() ? "" : ", ") + n;
  return out.empty() ? none : out;
}

/// Two digits more than the standard deviation leaves certain, and no row of zeros.
std::string value_and_interval(const diagnosed_value& p) {
  if (!(std::isfinite(p.sd) && p.sd > 0)) return in_digits(p.value, "%.6g");
  const double certain = std::ceil(std::log10(std::max(1e-300, std::abs(p.value)) / p.sd));
  const std::string form = "%." + std::to_string(static_cast<int>(std::clamp(certain, 0.0, 10.0)) + 2) + "g";
  const auto text = [&](double x) { return in_digits(x, form.c_str()); };
  const auto [least, most] = interval_of(p);
  return text(p.value) + "   (95 %: " + text(least) + " to " + text(most) + ")";
}

void add_fit(const rig_diagnosis& d, report_page& page) {
  page.result.emplace_back("verdict", d.verdict);
  if (!d.kind.empty()) page.result.emplace_back("kind of mismatch", kind_in_words(d.kind));
  const std::string where = d.metric == "pluck-residual" ? " of " + list_of(d.held_out, "the fitted plucks") : std::string{};
  page.result.emplace_back(d.metric + where + ", as declared", in_digits(100 * d.before) + " %");
  if (d.after) page.result.emplace_back(d.metric + where + ", corrected", in_digits(100 * *d.after) + " %");
  if (d.noise_floor > 0) page.result.emplace_back("the same from noise alone", in_digits(100 * d.noise_floor) + " %");
}

void add_missing(const rig_diagnosis& d, report_page& page) {
  for (const auto& m : d.missing) {
    const std::string place = !m.end.empty() ? ", " + m.end + " end" : !m.channel.empty() ? ", channel " + m.channel : "";
    page.result.emplace_back("missing: " + m.effect + place, m.probability > 0.9999
                                                                 ? "probability above 0.9999"
                                                                 : "probability " + in_digits(m.probability, "%.4g"));
    for (const auto& p : m.parameters) page.result.emplace_back("    " + p.name, value_and_interval(p));
    if (!m.indistinguishable_from.empty())
      page.result.emplace_back("    cannot be told here from", list_of(m.indistinguishable_from, ""));
  }
}

void add_ranking(const rig_diagnosis& d, report_page& page) {
  std::size_t shown = 0;
  for (const auto& r : d.ranking) {
    if (++shown > 8 && !r.left) continue;
    std::string names;
    for (const auto& e : r.effects) names += (names.empty() ? "" : " + ") + e;
    page.result.emplace_back((shown == 1 ? "likeliest: " : "runner-up: ") + (names.empty() ? "as declared" : names),
                             "log10 of the evidence " + in_digits(r.log10_evidence, "%.4g") +
                                 (r.left ? ", leaves " + in_digits(100 * *r.left) + " %" : ""));
  }
  if (shown > 8)
    page.notes.push_back(std::to_string(d.ranking.size()) +
                         " models were tried; the likeliest are in the table, all of them in the JSON file.");
  if (!d.pickup)
    page.notes.emplace_back(
        "Effects of the strokes are judged on the strokes, the others on the plucks: evidence compares exactly only within one "
        "kind.");
}

void add_limits(const rig_diagnosis& d, report_page& page) {
  if (d.verdict == "unexplained" && !d.left_in_strokes)
    page.notes.emplace_back(
        "What was found, if anything, does not bring the takes that were set aside down to the noise. The place of what is left "
        "stands above; nothing is named for it.");
  for (const auto& m : d.missing)
    if (!m.indistinguishable_from.empty())
      page.notes.push_back("These recordings cannot tell " + m.effect + " from " + list_of(m.indistinguishable_from, "") +
                           ". Plucks at another place, longer or harder ones, may.");
  if (d.held_out.size() == 1)
    page.notes.emplace_back(
        "A single take was predicted; more plucks, at several places and of several strengths, would make the answer surer.");
  if (d.metric != "pluck-residual")
    page.notes.emplace_back(
        "The mismatch is between the strokes and the model; the plucks' figures show that these are right, which has to come "
        "first.");
}

}  // namespace

exit_code write_diagnosis_report(const std::string& path, bool force, const rig_diagnosis& d, const provenance& from) {
  report_page page;
  page.title = d.title + ": diagnosis";
  page.summary = sentence(d);
  if (d.verdict == "no-mismatch") page.summary += " Nothing of the catalogue is missing from the declared model.";
  page.warnings = d.warnings;
  page.assumed = d.assumed;
  add_fit(d, page);
  add_missing(d, page);
  add_ranking(d, page);
  add_limits(d, page);
  add_figures(d, page);
  return write_page(path, force, std::move(page), from);
}

}  // namespace tool
