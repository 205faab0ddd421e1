// SPDX-License-Identifier: MIT
#include "sweep_plane.hpp"

#include <rosin/core/number_text.hpp>
#include <rosin/report/input_file.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>

namespace tool {

namespace {

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> out;
  std::istringstream in{text};
  for (std::string part; std::getline(in, part, by);) out.push_back(part);
  return out;
}

template <class Number>
bool read_number(const std::string& text, Number& to) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string number(double x) { return rosin::number_text(x, "%.9g"); }

std::string axis_text(const sweep_axis& a) {
  return a.name + " " + number(a.first) + ":" + number(a.last) + ":" + std::to_string(a.count);
}

rosin::outcome<sweep_axis> axis_from_line(const std::string& text) {
  const auto space = text.find(' ');
  if (space == std::string::npos) return rosin::failure{"is no axis"};
  return parse_axis(text.substr(0, space), text.substr(space + 1));
}

bool read_point(const std::string& line, std::size_t& index, sweep_result& to) {
  const auto fields = split(line, ',');
  if (fields.size() != 7 || !read_number(fields[0], index)) return false;
  to.regime = fields[3];
  return read_number(fields[4], to.transient_periods) && read_number(fields[5], to.slips_per_period) &&
         read_number(fields[6], to.unconverged);
}

struct look {
  const char *regime, *colour, *says;
};
constexpr std::array<look, 6> looks{{{"helmholtz", "#1b6ca8", "Helmholtz"},
                                     {"multiple-slip", "#d9a31a", "double, multiple slip"},
                                     {"raucous", "#8c1d40", "raucous"},
                                     {"low-frequency", "#5f8f3f", "anomalous low frequency"},
                                     {"none", "#c9ced3", "no oscillation"},
                                     {"impossible", "#ffffff", "not simulated"}}};

void draw_ticks(std::ostream& out, const sweep_axis& axis, bool across, double left, double top, double width, double height) {
  for (std::size_t i = 0; i < axis.count; i += std::max<std::size_t>(1, axis.count / 6)) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(axis.count);
    const std::string label = rosin::number_text(axis.at(i), "%.2g");
    if (across)
      out << "<text x='" << left + share * width << "' y='" << top + height + 18 << "' text-anchor='middle'>" << label
          << "</text>\n";
    else
      out << "<text x='" << left - 6 << "' y='" << top + (1 - share) * height + 4 << "' text-anchor='end'>" << label
          << "</text>\n";
  }
}

}  // namespace

double sweep_axis::at(std::size_t i) const noexcept {
  return count > 1 ? first * std::pow(last / first, static_cast<double>(i) / static_cast<double>(count - 1)) : first;
}

rosin::outcome<sweep_axis> parse_axis(const std::string& name, const std::string& text) {
  sweep_axis out{name, 0, 0, 0};
  const auto parts = split(text, ':');
  const bool read = parts.size() == 3 && read_number(parts[0], out.first) && read_number(parts[1], out.last) &&
                    read_number(parts[2], out.count);
  if (!read) return rosin::failure{name + ": \"" + text + "\" is not FIRST:LAST:COUNT, e.g. 0.02:0.2:12"};
  if (!(out.first > 0 && out.last > 0 && std::isfinite(out.first) && std::isfinite(out.last)))
    return rosin::failure{name + ": both ends must be above 0"};
  if (out.count < 1 || out.count > 4096) return rosin::failure{name + ": 1 to 4096 steps"};
  return out;
}

std::string sweep_plane::header() const {
  return "# rosin sweep, schema 1\n# x: " + axis_text(x) + "\n# y: " + axis_text(y) + "\n# " + conditions + "\nindex," + x.name +
         "," + y.name + ",regime,transient_periods,slips_per_period,unconverged\n";
}

std::string sweep_plane::line(std::size_t index, const sweep_result& r) const {
  return std::to_string(index) + "," + number(x.at(index % x.count)) + "," + number(y.at(index / x.count)) + "," + r.regime +
         "," + number(r.transient_periods) + "," + number(r.slips_per_period) + "," + std::to_string(r.unconverged) + "\n";
}

rosin::outcome<sweep_plane> read_plane(const std::string& file) {
  auto whole = rosin::read_file(file);
  if (!whole) return rosin::failure{whole.error()};
  std::string text = *std::move(whole);
  text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);  // a line cut short is no line
  const auto lines = split(text, '\n');
  sweep_plane plane;
  if (lines.size() < 5 || lines[0] != "# rosin sweep, schema 1" || lines[1].rfind("# x: ", 0) != 0 ||
      lines[2].rfind("# y: ", 0) != 0)
    return rosin::failure{file + ": is no file of rosin sweep"};
  const auto x = axis_from_line(lines[1].substr(5)), y = axis_from_line(lines[2].substr(5));
  if (!x || !y) return rosin::failure{file + ": " + (x ? y.error() : x.error())};
  plane.x = *x, plane.y = *y, plane.conditions = lines[3].substr(2);
  for (std::size_t n = 5; n < lines.size(); ++n) {
    std::size_t index = 0;
    sweep_result point;
    if (!read_point(lines[n], index, point) || index >= plane.size())
      return rosin::failure{file + ":" + std::to_string(n + 1) + ": is no point of the plane"};
    plane.points[index] = point;
  }
  return plane;
}

rosin::outcome<sweep_plane> merge_planes(const std::vector<std::string>& files) {
  sweep_plane all;
  for (const auto& file : files) {
    const auto part = read_plane(file);
    if (!part) return part;
    if (all.x.count == 0) all = *part;
    if (part->header() != all.header()) return rosin::failure{file + ": is of another plane than " + files.front()};
    all.points.insert(part->points.begin(), part->points.end());
  }
  return all;
}

std::string plane_text(const sweep_plane& plane) {
  std::string out = plane.header();
  for (const auto& [index, point] : plane.points) out += plane.line(index, point);
  return out;
}

std::string plane_svg(const sweep_plane& plane) {
  constexpr double left = 90, top = 20, width = 520, height = 400;
  const double cell_x = width / static_cast<double>(plane.x.count), cell_y = height / static_cast<double>(plane.y.count);
  double longest = 1;
  for (const auto& [index, p] : plane.points) longest = std::max(longest, p.transient_periods);
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 860 480' font-family='sans-serif' font-size='13'>\n<rect "
         "width='860' height='480' fill='#fff'/>\n";
  for (const auto& [index, point] : plane.points) {
    const sweep_result& p = point;
    const auto* found = std::find_if(looks.begin(), looks.end(), [&p](const look& l) { return p.regime == l.regime; });
    const double depth = p.regime == "helmholtz" ? 1 - 0.7 * p.transient_periods / longest : 0.85;
    out << "<rect x='" << left + cell_x * static_cast<double>(index % plane.x.count) << "' y='"
        << top + height - cell_y * static_cast<double>(index / plane.x.count + 1) << "' width='" << cell_x << "' height='"
        << cell_y << "' fill='" << (found != looks.end() ? found->colour : "#000") << "' fill-opacity='" << depth << "'/>\n";
  }
  out << "<rect x='" << left << "' y='" << top << "' width='" << width << "' height='" << height
      << "' fill='none' stroke='#444'/>\n";
  draw_ticks(out, plane.x, true, left, top, width, height);
  draw_ticks(out, plane.y, false, left, top, width, height);
  out << "<text x='" << left + width / 2 << "' y='" << top + height + 44 << "' text-anchor='middle'>" << plane.x.name
      << "</text>\n<text transform='translate(22 " << top + height / 2 << ") rotate(-90)' text-anchor='middle'>" << plane.y.name
      << "</text>\n";
  double row = top + 10;
  for (const auto& l : looks) {
    out << "<rect x='634' y='" << row << "' width='14' height='14' stroke='#888' fill='" << l.colour << "'/><text x='656' y='"
        << row + 12 << "'>" << l.says << "</text>\n";
    row += 24;
  }
  out << "<text x='634' y='" << row + 16 << "'>paler blue: longer transient,</text><text x='634' y='" << row + 34 << "'>up to "
      << longest << " periods</text>\n</svg>\n";
  return out.str();
}

}  // namespace tool
