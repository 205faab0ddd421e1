// SPDX-License-Identifier: MIT
//
// A report: one page that needs nothing else, with a sentence on top, warnings, figures and tables.
//
#pragma once

#include "calibration_file.hpp"
#include "report_figure.hpp"

namespace tool {

struct report_page {
  std::string title, summary;
  std::vector<std::string> warnings, notes, assumed;
  std::vector<figure> figures;
  std::vector<calibration_row> calibration;
  std::vector<std::pair<std::string, std::string>> result;  ///< what it is, what it came to
};

/// Draws the figures and writes the page.
[[nodiscard]] std::optional<rosin::failure> write_page(const std::string& path, bool force, const report_page& page,
                                                       const provenance& from);

}  // namespace tool
