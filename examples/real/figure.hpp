// SPDX-License-Identifier: MIT
//
// What the programs of this folder share: one channel of a recording, how loud a line of it is, and a plain SVG with one or two panels side by side.
//
#pragma once

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/calibrate/partial_baseband.hpp>
#include <rosin/report/output_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace real {

struct channel {
  std::vector<double> samples;
  double rate_Hz = 0;
};

/// The first channel of a file; a program of this folder ends here if there is none.
inline channel read_channel(const std::string& path) {
  auto read = rosin::read_audio(path);
  if (!read) {
    std::printf("%s\n", read.error().c_str());
    std::exit(1);
  }
  return {std::move(read->channels.front()), read->sample_rate_Hz};
}

/// Of a line between two instants of the recording; never quite zero, so that it has a level.
inline double mean_power(const rosin::baseband_record& z, double from_s, double to_s) {
  double sum = 1e-20;
  const auto a = static_cast<std::size_t>(from_s * z.rate_Hz), b = static_cast<std::size_t>(to_s * z.rate_Hz);
  for (std::size_t j = a; j < std::min(b, z.samples.size()); ++j) sum += std::norm(z.samples[j]) / static_cast<double>(b - a);
  return sum;
}

/// Points, joined or not.
struct series {
  std::string name, colour;
  std::vector<double> x, y;
  bool joined = false;
};

struct panel {
  std::string title, x_label, y_label;
  std::vector<series> all;
  bool log_x = false, log_y = false;
};

inline std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", v);
  return text;
}

/// One axis: from values to pixels, ticks at round numbers.
struct axis {
  double low = std::numeric_limits<double>::infinity(), high = -low, from, to;
  bool log = false;

  void take(double v) {
    const double u = log ? std::log10(v) : v;
    if (!std::isfinite(u)) return;
    low = std::min(low, u);
    high = std::max(high, u);
  }
  void widen() {
    const double more = high > low ? 0.05 * (high - low) : 0.5;
    low -= more;
    high += more;
  }
  [[nodiscard]] double operator()(double v) const {
    return from + ((log ? std::log10(v) : v) - low) / (high - low) * (to - from);
  }
  [[nodiscard]] std::vector<double> ticks() const {
    std::vector<double> at;
    if (log && high - low > 0.9) {
      for (double e = std::ceil(low); e <= high; ++e) at.push_back(std::pow(10, e));
      if (at.size() >= 2) return at;
      at.clear();
    }
    const double a = log ? std::pow(10, low) : low, b = log ? std::pow(10, high) : high;
    double step = std::pow(10, std::floor(std::log10(b - a)));
    for (const double part : {2.0, 2.5, 2.0}) step = (b - a) / step < 4 ? step / part : step;
    for (double v = std::ceil(a / step) * step; v <= b; v += step) at.push_back(std::abs(v) < step / 1e6 ? 0 : v);
    return at;
  }
};

inline void write_panel(std::ostream& out, const panel& p, double left) {
  axis x{.from = left + 62, .to = left + 440, .log = p.log_x}, y{.from = 300, .to = 36, .log = p.log_y};
  for (const series& s : p.all)
    for (std::size_t i = 0; i < s.x.size(); ++i) x.take(s.x[i]), y.take(s.y[i]);
  x.widen(), y.widen();
  const auto text = [&](double at_x, double at_y, const std::string& words, const char* more) {
    out << "<text x='" << number(at_x) << "' y='" << number(at_y) << "' " << more << ">" << words << "</text>\n";
  };
  out << "<rect x='" << x.from << "' y='36' width='378' height='264' fill='none' stroke='#888'/>\n";
  for (const double v : x.ticks()) {
    out << "<line x1='" << number(x(v)) << "' x2='" << number(x(v)) << "' y1='36' y2='300' stroke='#ddd'/>\n";
    text(x(v), 315, number(v), "text-anchor='middle'");
  }
  for (const double v : y.ticks()) {
    out << "<line x1='" << x.from << "' x2='" << x.to << "' y1='" << number(y(v)) << "' y2='" << number(y(v))
        << "' stroke='#ddd'/>\n";
    text(x.from - 5, y(v) + 4, number(v), "text-anchor='end'");
  }
  text((x.from + x.to) / 2, 24, p.title, "text-anchor='middle' font-weight='bold'");
  text((x.from + x.to) / 2, 333, p.x_label, "text-anchor='middle'");
  const std::string turned = "text-anchor='middle' transform='rotate(-90 " + number(left + 14) + " 168)'";
  text(left + 14, 168, p.y_label, turned.c_str());
  double key = x.from, row = 352;
  for (const series& s : p.all) {
    if (s.joined) {
      out << "<polyline fill='none' stroke-width='1.4' stroke='" << s.colour << "' points='";
      for (std::size_t i = 0; i < s.x.size(); ++i) out << number(x(s.x[i])) << ',' << number(y(s.y[i])) << ' ';
      out << "'/>\n";
    } else {
      for (std::size_t i = 0; i < s.x.size(); ++i)
        out << "<circle r='3' cx='" << number(x(s.x[i])) << "' cy='" << number(y(s.y[i])) << "' fill='" << s.colour << "'/>\n";
    }
    if (s.name.empty()) continue;
    const std::string look = "fill='" + s.colour + "'";
    const double wide = 5.6 * static_cast<double>(s.name.size()) + 28;
    if (key > x.from && key + wide > x.to + 28) key = x.from, row += 16;
    text(key, row, (s.joined ? "\u2014 " : "\u2022 ") + s.name, look.c_str());
    key += wide;
  }
}

/// Writes the panels side by side; false, in words, if that is not possible.
inline bool write_figure(const std::string& path, const std::vector<panel>& panels) {
  const auto failed = rosin::write_file(path, rosin::overwrite::allow, [&](std::ostream& out) {
    const double width = 460 * static_cast<double>(panels.size());
    out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " << width << " 378' font-family='sans-serif' font-size='11'>\n"
        << "<rect width='100%' height='100%' fill='white'/>\n";
    for (std::size_t i = 0; i < panels.size(); ++i) write_panel(out, panels[i], 460 * static_cast<double>(i));
    out << "</svg>\n";
  });
  if (failed) std::printf("%s\n", failed->message.c_str());
  return !failed;
}

}  // namespace real
