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

/// Draws the figures and writes the page. Where figures cannot be drawn the page comes without them, with the reason in it and on
/// standard error: exit_code::finding. Where it cannot be written, that is said: exit_code::bad_input.
[[nodiscard]] exit_code write_page(const std::string& path, bool force, report_page page, const provenance& from);

}  // namespace tool
