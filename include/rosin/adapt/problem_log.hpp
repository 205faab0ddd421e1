// tier: hosted
// SPDX-License-Identifier: MIT
//
// All that is wrong with a file, not only the first thing: each problem on a line of its own, in the order of the file,
// as "rig.toml:12: string.tension_N: must be larger than 0, is -3". A name nobody knows comes with the nearest one that
// is known (edit distance of Levenshtein, case ignored).
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class problem_log {
public:
  explicit problem_log(std::string file) : file_{std::move(file)} {}

  /// line 0: the file as a whole. The same problem twice counts once.
  void add(int line, const std::string& where, const std::string& reason) {
    const std::string place = line > 0 ? file_ + ":" + std::to_string(line) : file_;
    std::pair problem{line, printable(place + ": " + (where.empty() ? "" : where + ": ") + reason)};
    if (std::find(problems_.begin(), problems_.end(), problem) == problems_.end()) problems_.push_back(std::move(problem));
  }

  [[nodiscard]] bool empty() const noexcept { return problems_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return problems_.size(); }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

  /// One failure that holds them all, by line.
  [[nodiscard]] failure to_failure() const {
    auto sorted = problems_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string all;
    for (const auto& [line, text] : sorted) all += (all.empty() ? "" : "\n") + text;
    return failure{all};
  }

private:
  /// What a file holds ends up in the message: no line breaks, no escape sequences of a terminal, no endless names.
  [[nodiscard]] static std::string printable(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return text.size() <= 1000 ? text : text.substr(0, 1000) + " ...";
  }

  std::string file_;
  std::vector<std::pair<int, std::string>> problems_;
};

/// Number of insertions, deletions and replacements between two names, capitals taken as small letters.
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

/// "; did you mean NAME?", or all the names where none is near.
template <class Names>
[[nodiscard]] std::string suggestion(std::string_view unknown, const Names& known) {
  const std::string_view start = unknown.substr(0, 80);  // a name may be of any length; a suggestion need not be
  std::string best, all;
  std::size_t distance = std::max<std::size_t>(2, start.size() / 3) + 1;
  for (const auto& name : known) {
    const std::string text{name};
    all += (all.empty() ? "" : ", ") + text;
    const std::size_t d = edit_distance(start, text);
    const bool starts_alike = start.size() >= 4 && text.starts_with(start);
    if (const std::size_t apart = starts_alike ? std::min<std::size_t>(d, 1) : d; apart < distance) {
      distance = apart;
      best = text;
    }
  }
  if (!best.empty()) return "; did you mean " + best + "?";
  return all.empty() ? std::string{} : "; known here: " + all;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
