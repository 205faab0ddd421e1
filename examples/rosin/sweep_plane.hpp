// SPDX-License-Identifier: MIT
//
// A plane of strokes: two quantities in steps, one point an experiment, and the file that keeps what was found.
//
#pragma once

#include <rosin/core/outcome.hpp>
#include <rosin/report/output_file.hpp>
#include <rosin/simulate/regime.hpp>

#include <map>
#include <string>
#include <vector>

namespace tool {

/// From `first` to `last` in `count` steps of one ratio; "0.02:0.2:12" on the command line.
struct sweep_axis {
  std::string name;  ///< position, force_N or acceleration_m_s2
  double first = 0, last = 0;
  std::size_t count = 0;

  [[nodiscard]] double at(std::size_t i) const noexcept;
};
[[nodiscard]] rosin::outcome<sweep_axis> parse_axis(const std::string& name, const std::string& text);

struct sweep_result {
  std::string regime;  ///< a name of bowed_regime, or "impossible"
  double transient_periods = 0, slips_per_period = 0;
  std::size_t unconverged = 0;
};

/// Both axes, what holds for all points (one line, compared when a file is gone on with), and the points known so far.
struct sweep_plane {
  sweep_axis x, y;
  std::string conditions;
  std::map<std::size_t, sweep_result> points;  ///< by index: x.count * iy + ix

  [[nodiscard]] std::size_t size() const noexcept { return x.count * y.count; }
  [[nodiscard]] std::string header() const;
  [[nodiscard]] std::string line(std::size_t index, const sweep_result& r) const;
};

/// Reads a file that a sweep has written; a last line that was cut short is left out.
[[nodiscard]] rosin::outcome<sweep_plane> read_plane(const std::string& file);

/// All of several files of one plane.
[[nodiscard]] rosin::outcome<sweep_plane> merge_planes(const std::vector<std::string>& files);

/// The whole file as text, points in order.
[[nodiscard]] std::string plane_text(const sweep_plane& plane);

/// A picture: colour is the regime, its depth how short the transient was.
[[nodiscard]] std::string plane_svg(const sweep_plane& plane);

}  // namespace tool
