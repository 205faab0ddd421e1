// SPDX-License-Identifier: MIT
#include "report_page.hpp"

#include <iostream>

namespace tool {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

constexpr const char* style = R"(
:root { color-scheme: light; }
body { margin: 0 auto; padding: 1.5rem 1.2rem 3rem; max-width: 960px; background: #fcfcfa; color: #1d1d1f; font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.5rem; margin: 0 0 .3rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .5rem; }
.summary { font-size: 1.08rem; margin: .4rem 0 1rem; }
.warnings { background: #fff4d6; border-left: 4px solid #c98a00; padding: .5rem .9rem; margin: 1rem 0; } .warnings ul { margin: .2rem 0; padding-left: 1.1rem; }
figure { margin: 1.6rem 0; } figure svg { width: 100%; height: auto; display: block; border: 1px solid #e6e6e2; background: #fff; }
figcaption { font-size: .9rem; color: #444; margin-top: .4rem; }
table { border-collapse: collapse; font-size: .9rem; width: 100%; } td, th { padding: .18rem .6rem; text-align: left; border-bottom: 1px solid #ebebe6; vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; } tr.group td { font-weight: 600; padding-top: .8rem; border-bottom: 1px solid #b9b9b2; }
.small { font-size: .82rem; color: #555; } .small li { overflow-wrap: anywhere; } code { font-size: .8rem; overflow-wrap: anywhere; }
)";

void write_list(std::ostream& out, const std::vector<std::string>& lines) {
  out << "<ul>\n";
  for (const auto& line : lines) out << "<li>" << escaped(line) << "</li>\n";
  out << "</ul>\n";
}

void write_calibration(std::ostream& out, const std::vector<calibration_row>& rows) {
  out << "<h2>Calibration</h2>\n<table>\n<tr><th></th><th class=\"n\">value</th><th class=\"n\">random sd</th><th "
         "class=\"n\">systematic sd</th><th>unit</th></tr>\n";
  std::string group;
  for (const auto& r : rows) {
    if (r.group != group) out << "<tr class=\"group\"><td colspan=\"5\">" << escaped(group = r.group) << "</td></tr>\n";
    out << "<tr><td>" << escaped(r.name) << "</td><td class=\"n\">" << escaped(r.value) << "</td><td class=\"n\">"
        << escaped(r.random) << "</td><td class=\"n\">" << escaped(r.systematic) << "</td><td>" << escaped(r.unit)
        << "</td></tr>\n";
  }
  out << "</table>\n<p class=\"small\">One standard deviation each. Random: changes from fit to fit. Systematic: common to all, "
         "from the declared "
         "forces, gains, tension and length.</p>\n";
}

void write_result(std::ostream& out, const report_page& page) {
  out << "<h2>Result</h2>\n<table>\n";
  for (const auto& [what, value] : page.result)
    out << "<tr><td>" << escaped(what) << "</td><td>" << escaped(value) << "</td></tr>\n";
  out << "</table>\n";
}

void write_body(std::ostream& out, const report_page& page, const std::vector<std::string>& svg, const provenance& from) {
  out << "<h1>" << escaped(page.title) << "</h1>\n<p class=\"summary\">" << escaped(page.summary) << "</p>\n";
  if (!page.warnings.empty()) {
    out << "<div class=\"warnings\"><strong>Warnings</strong>\n";
    write_list(out, page.warnings);
    out << "</div>\n";
  }
  for (std::size_t i = 0; i < svg.size(); ++i)
    out << "<figure style=\"max-width:" << page.figures[i].width << "px\">\n"
        << svg[i] << "\n<figcaption><strong>Figure " << i + 1 << ".</strong> " << escaped(page.figures[i].caption)
        << "</figcaption>\n</figure>\n";
  if (!page.result.empty()) write_result(out, page);
  if (!page.calibration.empty()) write_calibration(out, page.calibration);
  if (!page.notes.empty()) {
    out << "<h2>Notes</h2>\n";
    write_list(out, page.notes);
  }
  out << "<h2>Assumed</h2>\n<div class=\"small\">";
  if (page.assumed.empty()) out << "<p>Nothing: every value was given.</p>\n";
  else write_list(out, page.assumed);
  out << "</div>\n<h2>Provenance</h2>\n<div class=\"small\">";
  write_list(out, from.comment_lines());
  out << "</div>\n";
}

}  // namespace

exit_code write_page(const std::string& path, bool force, report_page page, const provenance& from) {
  const auto svg = draw(page.figures);
  if (!svg) {
    std::string why = rosin::one_line("the figures are missing: " + svg.error());
    why.erase(why.find_last_not_of(' ') + 1);
    page.warnings.push_back(std::move(why));
    std::cerr << "rosin: warning: " << page.warnings.back() << '\n';
  }
  const auto why = rosin::write_file(path, force ? rosin::overwrite::allow : rosin::overwrite::refuse, [&](std::ostream& out) {
    out << "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
           "content=\"width=device-width, initial-scale=1\">\n<title>"
        << escaped(page.title) << "</title>\n<style>" << style << "</style>\n</head>\n<body>\n";
    write_body(out, page, svg ? *svg : std::vector<std::string>{}, from);
    out << "</body>\n</html>\n";
  });
  if (why) return fail(why->message);
  return svg ? exit_code::ok : exit_code::finding;
}

}  // namespace tool
