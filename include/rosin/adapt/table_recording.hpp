// tier: hosted
// SPDX-License-Identifier: MIT
//
// A table of numbers as a recording: its columns are the channels, in the units they are in. The rate stands in the rig file or
// follows from a column of times, which is then held against even steps: where it jumps, samples are missing, and the row is named.
// Which formats can be read is a list; text and NumPy are in it, and whoever has the libraries adds read_mat (table_mat.hpp) and
// read_hdf5 (table_hdf5.hpp).
//
#pragma once

#include <rosin/acquire/recording.hpp>
#include <rosin/adapt/table_npy.hpp>
#include <rosin/adapt/table_text.hpp>
#include <rosin/core/number_text.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// How files with one ending are read; max_rows: how much of it is wanted.
struct table_format {
  std::string_view ending;
  outcome<number_table> (*read)(const std::string& path, std::size_t max_rows);
};
using table_formats = std::vector<table_format>;

[[nodiscard]] inline table_formats plain_table_formats() {
  return {{".csv", read_table_text}, {".tsv", read_table_text}, {".npy", read_npy}};
}

[[nodiscard]] inline outcome<number_table> read_table(const std::string& path, const table_formats& formats,
                                                      std::size_t max_rows = all_rows) {
  const std::string_view ending = table_ending(path);
  for (const auto& format : formats)
    if (format.ending == ending) return format.read(path, max_rows);
  return failure{path + ": this build reads no " + std::string{ending} + " files: the library for them was not found"};
}

/// What tells the rate of a table.
struct table_clock {
  std::optional<double> rate_Hz;
  std::optional<int> time_column;
};

[[nodiscard]] inline table_clock clock_of(const rig& r, const take& t) noexcept {
  return {t.rate_Hz ? t.rate_Hz : r.files.rate_Hz, r.files.time_column};
}

namespace detail {

/// A column of times: its step, or the row in which it is uneven.
class time_column_reader {
public:
  time_column_reader(const std::vector<double>& times) : times_{&times} {
    std::vector<double> steps;
    for (std::size_t i = 1; i < times.size() && i <= 4096; ++i) steps.push_back(times[i] - times[i - 1]);
    const std::size_t far = std::min<std::size_t>(times.size(), 4097) - 1;
    std::vector<double> spans;  // printed times are rounded, and a step may be less than their last digit
    const std::size_t reach = std::clamp<std::size_t>(far / 8, 1, 512);
    for (std::size_t i = reach; i <= far; i += reach) spans.push_back((times[i] - times[i - reach]) / static_cast<double>(reach));
    step_s_ = median(spans);
    for (double& s : steps) s = std::abs(s - step_s_);
    tolerance_s_ = std::max(0.6 * step_s_, 8 * median(steps));
  }
  [[nodiscard]] bool rises() const noexcept { return step_s_ > 0; }

  /// The first row that does not follow the one before it by a step.
  [[nodiscard]] std::optional<std::size_t> uneven() const noexcept {
    for (std::size_t i = 1; i < times_->size(); ++i)
      if (std::abs((*times_)[i] - (*times_)[i - 1] - step_s_) > tolerance_s_) return i;
    return std::nullopt;
  }
  [[nodiscard]] std::string reason(std::size_t row) const {
    const double moved = (*times_)[row] - (*times_)[row - 1];
    const std::string step = " where a step is " + number_text(step_s_) + " s";
    if (moved < 0) return "the time goes back by " + number_text(-moved) + " s";
    if (moved < step_s_) return "the time moves by " + number_text(moved) + " s" + step + ": a row too many";
    return "the time jumps by " + number_text(moved) + " s" + step + ": " + number_text(std::round(moved / step_s_) - 1) +
           " row(s) are missing";
  }
  /// Over the whole column, and how well the digits of the times tell it; a whole number of hertz where it may be one.
  [[nodiscard]] std::pair<double, double> rate_Hz() const noexcept {
    const double n = static_cast<double>(times_->size() - 1), duration_s = times_->back() - times_->front(),
                 rate = n / duration_s;
    double off = 0;
    for (std::size_t i = 0; i < times_->size(); ++i)
      off = std::max(off, std::abs((*times_)[i] - times_->front() - static_cast<double>(i) / rate));
    const double doubt = rate * (2 * off / duration_s + 1e-9);
    return {std::abs(rate - std::round(rate)) <= doubt && rate > 1 ? std::round(rate) : rate, doubt};
  }

private:
  static double median(std::vector<double> x) {
    const auto middle = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), middle, x.end());
    return *middle;
  }

  const std::vector<double>* times_;
  double step_s_ = 0, tolerance_s_ = 0;
};

}  // namespace detail

/// Samples a second, or why nobody can tell. Of the beginning of a table, too.
[[nodiscard]] inline outcome<double> rate_of(const number_table& from, const std::string& file, const table_clock& clock) {
  if (!clock.time_column) {
    if (clock.rate_Hz) return *clock.rate_Hz;
    return failure{file +
                   ": a table does not tell its rate: rate_Hz of the take or of [files], or [files] time_column, is missing"};
  }
  const auto column = static_cast<std::size_t>(*clock.time_column);
  if (column >= from.data.columns.size())
    return failure{file + ": has " + std::to_string(from.data.columns.size()) + " column(s), but files.time_column is " +
                   std::to_string(column)};
  const auto& times = from.data.columns[column].values;
  const std::string place = ": " + column_text(from.data, column) + ": ";
  if (times.size() < 3) return failure{file + place + "three times at least are needed to tell the rate"};
  const detail::time_column_reader reader{times};
  if (!reader.rises()) return failure{file + place + "does not rise: this is no column of times"};
  if (const auto row = reader.uneven()) return failure{from.place_of(file, *row) + place + reader.reason(*row)};
  const auto [rate, doubt] = reader.rate_Hz();
  if (!(rate >= 1 && rate <= 1e9))
    return failure{file + place + "its steps are those of " + number_text(rate) + " samples a second: times are in s"};
  if (clock.rate_Hz && std::abs(rate - *clock.rate_Hz) > std::max(1e-3 * rate, doubt))
    return failure{file + place + "its steps are those of " + number_text(rate) + " samples a second, but rate_Hz is " +
                   number_text(*clock.rate_Hz)};
  return rate;
}

/// The table in memory as a recording.
[[nodiscard]] inline outcome<recording> recording_of(number_table from, const std::string& file, const table_clock& clock) {
  const auto rate = rate_of(from, file, clock);
  if (!rate) return failure{rate.error()};
  recording out{file, *rate, {}, 64, true, {}, true};
  for (auto& column : from.data.columns) {
    out.columns.push_back(std::move(column.name));
    out.channels.push_back(std::move(column.values));
  }
  return out;
}

[[nodiscard]] inline outcome<recording> read_table_recording(const std::string& path, const table_clock& clock,
                                                             const table_formats& formats) {
  auto table = read_table(path, formats);
  if (!table) return failure{table.error()};
  return recording_of(*std::move(table), path, clock);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
