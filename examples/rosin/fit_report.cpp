// SPDX-License-Identifier: MIT
#include "fit_report.hpp"

#include "digits.hpp"

namespace tool {

namespace {

/// x (in `scale` units) and y between two samples.
curve piece(const std::string& name, const std::vector<double>& y, std::size_t begin, std::size_t end, double rate_Hz,
            double zero_s, const char* ink, double width = 1.3, int dash = 1) {
  curve c{name, {}, {}, ink, width, dash};
  for (std::size_t i = begin; i < std::min(end, y.size()); ++i) {
    c.x.push_back(1e3 * (static_cast<double>(i) / rate_Hz - zero_s));
    c.y.push_back(y[i]);
  }
  return c;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = 1e3 * (a[i] - b[i]);
  return out;
}

}  // namespace

figure pluck_figure(const pluck_prediction& p, double fundamental_Hz, bool held_out) {
  const double period = p.rate_Hz / fundamental_Hz, release = p.release_s * p.rate_Hz;
  const auto begin = static_cast<std::size_t>(std::max(0.0, release - 0.4 * period)),
             end = static_cast<std::size_t>(release + 3 * period);
  figure f;
  const std::string model = held_out ? "predicted" : "fitted";
  for (std::size_t c = 0; c < 2; ++c) {
    panel one{c == 0 ? "(a) near end" : "(b) far end", "time after the release / ms", "force / N", {}, {}, {}, {}, 240};
    one.curves.push_back(
        piece("recorded", p.recorded_N[c], begin, end, p.rate_Hz, p.release_s, c == 0 ? colour::near : colour::far, 2));
    one.curves.push_back(piece(model, p.model_N[c], begin, end, p.rate_Hz, p.release_s, colour::model, 1.2, 2));
    f.panels.push_back(one);
  }
  panel rest{"(c) recorded - " + model, "time after the release / ms", "difference / mN", {}, {}, {}, {}, 210};
  rest.curves.push_back(
      piece("near", difference(p.recorded_N[0], p.model_N[0]), begin, end, p.rate_Hz, p.release_s, colour::near, 1));
  rest.curves.push_back(
      piece("far", difference(p.recorded_N[1], p.model_N[1]), begin, end, p.rate_Hz, p.release_s, colour::far, 1));
  f.panels.push_back(rest);
  f.share_axis();
  f.caption = "Pluck " + p.name + ", released at " + in_digits(1e3 * p.release_s, "%.3f") + " ms with " +
              in_digits(p.strength_N, "%.3f") + " N: forces on the terminations (solid) and the stiff string's (dashed), " +
              model + ", both up to " + in_digits(1e-3 * p.limits.stop_Hz, "%.0f") + " kHz. Over all of the take " +
              (held_out ? "(only release, strength and offset free) " : "") + "the residual is " +
              in_digits(100 * p.residual_ratio, "%.2g") + " % of the signal.";
  return f;
}

namespace {

figure partials_figure(const pickup_result& r) {
  panel pitch{
      "(a) partials against the law of a stiff string", "number of the partial", "f_n / (n f0) - 1  / 1e-3", {}, {}, {}, {}, 250};
  panel loss{"(b) loss", "frequency / kHz", "1/Q  / 1e-3", {}, {}, {}, {}, 250};
  curve seen{"measured, one standard deviation", {}, {}, colour::near, 2, 1},
      law{"f0 n sqrt(1 + b n^2)", {}, {}, colour::model, 1.2, 2};
  curve q{"measured, one standard deviation", {}, {}, colour::near, 2, 1},
      q_law{"1/Q0 + internal f + air / sqrt(f)", {}, {}, colour::model, 1.2, 2};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto bar = [&](curve& c, double x, double y, double sd, double tick) {
    for (const auto& [dx, dy] : {std::pair{0.0, -sd}, {0.0, sd}, {nan, nan}, {-tick, 0.0}, {tick, 0.0}, {nan, nan}}) {
      c.x.push_back(x + dx);
      c.y.push_back(y + dy);
    }
  };
  const auto& f = r.fit;
  const double f0 = f.fundamental_Hz, top = f.partials.empty() ? f0 : f.partials.back().frequency_Hz;
  for (const auto& p : f.partials) {
    const double n = p.number;
    if (p.weight > 0) bar(seen, n, 1e3 * (p.frequency_Hz / (n * f0) - 1), 1e3 * p.frequency_sd / (n * f0), 0.15);
    bar(q, 1e-3 * p.frequency_Hz, 1e3 * p.inverse_q(), 1e3 * p.decay_sd / (std::numbers::pi * p.frequency_Hz), 1.5e-6 * top);
    law.x.push_back(n);
    law.y.push_back(1e3 * (std::sqrt(1 + f.inharmonicity * n * n) - 1));
  }
  for (double hz = f0; hz <= top; hz += 0.25 * f0) {
    q_law.x.push_back(1e-3 * hz);
    q_law.y.push_back(1e3 * f.loss.law.inverse_q(hz));
  }
  pitch.curves = {seen, law};
  loss.curves = {q, q_law};
  return {"Take " + r.take + ", channel " + r.channel +
              ": partials and their loss. Partials far off the law (others' resonances) are left out of (a).",
          {pitch, loss}};
}

}  // namespace

exit_code write_fit_report(const std::string& path, bool force, const rig_calibration& c, const provenance& from) {
  report_page page;
  page.title = c.title + ": calibration";
  const double f0 = c.fit.value[rosin::pluck_layout::fundamental];
  const double worst = *std::max_element(c.fit.residual_ratio.begin(), c.fit.residual_ratio.end());
  page.summary = set_of(c).from + ": the string rings at " + in_digits(c.fit.string().partial_Hz(1), "%.2f") +
                 " Hz, the contact lies at " + in_digits(c.at.front().position, "%.4f") +
                 " of its length, and the model leaves " + in_digits(100 * worst, "%.2g") + " % of the worst pluck unexplained" +
                 (c.fit.misfit < 2 ? ", which is noise." : ", more than noise alone.");
  page.warnings = c.warnings;
  page.assumed = c.assumed;
  page.calibration = rows_of(c);
  for (std::size_t i = 0; i < c.drawn.size() && i < 3; ++i) page.figures.push_back(pluck_figure(c.drawn[i], f0, false));
  for (std::size_t i = 0; i < c.predicted.size() && i < 2; ++i) page.figures.push_back(pluck_figure(c.predicted[i], f0, true));
  if (c.drawn.size() > 3)
    page.notes.push_back("The first three of " + std::to_string(c.drawn.size()) + " fitted plucks are drawn.");
  return write_page(path, force, std::move(page), from);
}

exit_code write_fit_report(const std::string& path, bool force, const pickup_calibration& c, const provenance& from) {
  report_page page;
  page.title = c.title + ": pitch, stiffness and loss";
  page.summary = std::to_string(c.results.size()) + " recording" + (c.results.size() == 1 ? "" : "s") +
                 " of single channels fitted: partials, inharmonicity and loss, each with its error. Gains and forces cannot be "
                 "had from them.";
  page.warnings = c.warnings;
  page.assumed = c.assumed;
  for (const auto& one : c.results) {
    for (auto& row : rows_of(one)) page.calibration.push_back(std::move(row));
    if (page.figures.size() < 6) page.figures.push_back(partials_figure(one));
  }
  if (c.results.size() > page.figures.size())
    page.notes.push_back("The first " + std::to_string(page.figures.size()) + " are drawn.");
  return write_page(path, force, std::move(page), from);
}

}  // namespace tool
