// SPDX-License-Identifier: MIT
//
// Figures of a report: panels above one another, drawn by gnuplot as SVG that goes into the page.
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tool {

/// The colours of all reports: what is measured at the near and far end, what is modelled, what slips, what is declared.
namespace colour {
inline constexpr const char *near = "#1b6ca8", *pale_near = "#8fc1e3", *far = "#d9731a", *model = "#222222", *mean = "#3b3b8f",
                            *slip = "#8c1d40", *declared = "#5f8f3f", *faint = "#9aa0a6";
}

struct curve {
  std::string name;  ///< in the key; empty: not named there
  std::vector<double> x, y;
  std::string colour;
  double width = 1.3;
  int dash = 1;  ///< gnuplot's dash type; 1: solid
};

/// A rectangle of a map; 1 is pale, 100 and more dark.
struct cell {
  double from_x = 0, to_x = 0, from_y = 0, to_y = 0, value = 1;
};

struct panel {
  std::string title, x_label, y_label;
  std::vector<curve> curves;
  std::vector<std::pair<double, double>> heavy;  ///< intervals of x drawn as heavy line along the top
  std::optional<std::pair<double, double>> x_range, y_range;
  int height = 260;
  std::vector<cell> cells{};                              ///< a map in place of curves, its key at the right
  std::vector<std::pair<double, std::string>> y_marks{};  ///< in place of numbers
};

struct figure {
  std::string caption;
  std::vector<panel> panels;
  int width = 920;

  /// Panels above one another have one axis in common: only the lowest says what it is.
  void share_axis() {
    for (std::size_t i = 0; i + 1 < panels.size(); ++i) {
      panels[i].x_label.clear();
      panels[i].height -= 30;
    }
  }
};

/// Why there can be no figures (no gnuplot on the PATH), if so.
[[nodiscard]] std::optional<rosin::failure> cannot_draw();

/// Each figure as an <svg> element.
[[nodiscard]] rosin::outcome<std::vector<std::string>> draw(const std::vector<figure>& figures);

}  // namespace tool
