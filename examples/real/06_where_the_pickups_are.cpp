// SPDX-License-Identifier: MIT
//
// Hidden physics: the place of the sensor. The starting model hears all partials alike; they should then lie on a straight line
// of level against the logarithm of their number. A pickup x from the bridge hears partial n as sin(n pi x / L), two at once as
//
//     sin(n pi x1 / L) + sin(n pi x2 / L)
//
// and a pluck at q leaves sin(n pi q / L). Stopping the string changes L, not x: x is common to all notes of all strings, q is
// free in each. Nothing is said of how many pickups are switched on: one is tried, then two. Each string is fitted alone, so that
// five answers can be compared; then all of them together, and together without each in turn.
//
//     06_where_the_pickups_are FOLDER [FIGURE.svg]       FOLDER: E4_A4_mp_1.flac ..., string_note_mp_take
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

#include <filesystem>
#include <numbers>
#include <set>

namespace {

constexpr double scale_m = 0.6477, step_m = 0.002, from_m = 0.02, to_m = 0.22;
constexpr double smear = 0.03, outlier_dB = 15;  // no node is perfect; a partial that is off by more says nothing more

struct plucked_string {
  const char* name;
  int open;  ///< semitones above C0
  const char* colour;
};
constexpr plucked_string strings[] = {
    {"E2", 28, "#222222"}, {"A", 33, "#8c1d40"}, {"D", 38, "#5f8f3f"}, {"G", 43, "#d9731a"}, {"E4", 52, "#1b6ca8"}};

int semitones(const std::string& note) {
  const int natural[] = {9, 11, 0, 2, 4, 5, 7};
  return natural[note[0] - 'A'] + (note[1] == 'b' ? -1 : 0) + 12 * (note.back() - '0');
}

double comb_dB(double sines) { return 20 * std::log10(std::abs(sines) + smear); }

/// Levels at the moment of the pluck, and the combs of all places of a pluck.
struct note {
  double length_m = 0;
  std::vector<double> number, dB, log_number;
  std::vector<std::vector<double>> plucks;
};

/// Squares left over by a straight line through dB - comb of the pickups - comb of the pluck, the best pluck taken.
double left_over(const note& t, const std::vector<double>& pickups_dB) {
  const double count = static_cast<double>(t.dB.size());
  double least = 1e300;
  std::vector<double> y(t.dB.size());
  for (const auto& pluck : t.plucks) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0, sum = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const double x = t.log_number[i];
      y[i] = t.dB[i] - pickups_dB[i] - pluck[i];
      sx += x, sy += y[i], sxx += x * x, sxy += x * y[i];
    }
    const double b = (count * sxy - sx * sy) / (count * sxx - sx * sx), a = (sy - b * sx) / count;
    for (std::size_t i = 0; i < y.size(); ++i)
      sum += std::min(std::pow(y[i] - a - b * t.log_number[i], 2), outlier_dB * outlier_dB);
    least = std::min(least, sum);
  }
  return least;
}

/// Root mean square over all notes of a string with pickups at `places`; none: all partials are heard alike.
double left_over(const std::vector<note>& notes, const std::vector<double>& places_m) {
  double sum = 0, count = 0;
  for (const note& t : notes) {
    std::vector<double> comb(t.number.size(), 0.0);
    for (std::size_t i = 0; i < comb.size() && !places_m.empty(); ++i) {
      double sines = 0;
      for (const double x : places_m)
        sines += std::sin(t.number[i] * std::numbers::pi * x / t.length_m) / static_cast<double>(places_m.size());
      comb[i] = comb_dB(sines);
    }
    sum += left_over(t, comb);
    count += static_cast<double>(comb.size());
  }
  return std::sqrt(sum / count);
}

std::vector<note> read_notes(const std::set<std::filesystem::path>& files, const plucked_string& s) {
  std::vector<note> notes;
  for (const auto& file : files) {
    const std::string name = file.stem().string(), begin = std::string{s.name} + "_";
    if (!name.starts_with(begin)) continue;
    const int at = semitones(name.substr(begin.size(), name.find("_mp") - begin.size()));
    const auto heard = real::read_channel(file.string());
    const auto fit =
        rosin::fit_pickup(heard.samples, heard.rate_Hz, 440 * std::pow(2, (at - 57) / 12.0), {.partials_at_most = 40});
    if (!fit) continue;
    note t;
    t.length_m = scale_m * std::pow(2, -(at - s.open) / 12.0);
    for (const auto& p : fit->partials) {
      t.number.push_back(p.number);
      t.log_number.push_back(std::log2(p.number));
      t.dB.push_back(20 * std::log10(p.amplitude) + 20 / std::numbers::ln10 * p.decay_per_s * fit->start_s);
    }
    for (double q = from_m; q < std::min(0.3, t.length_m / 2); q += 2 * step_m) {
      t.plucks.emplace_back();
      for (const double n : t.number) t.plucks.back().push_back(comb_dB(std::sin(n * std::numbers::pi * q / t.length_m)));
    }
    notes.push_back(std::move(t));
  }
  return notes;
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return std::printf("usage: %s FOLDER [FIGURE.svg]\n", words[0]), 2;
  const std::set<std::filesystem::path> files{std::filesystem::directory_iterator{words[1]}, {}};
  real::panel one{"One pickup: what is left over", "distance from the bridge, m", "dB", {}};
  real::panel two{"Two pickups at once: the best pair of each string", "nearer pickup, m", "farther pickup, m", {}};
  std::printf("string      notes  no place      one pickup          two pickups\n");
  const auto fitted = [&](const std::string& name, const std::vector<note>& notes, const char* colour) {
    real::series curve{name, colour ? colour : "", {}, {}, true};
    double least = 1e300, at = 0, least_pair = 1e300, near = 0, far = 0;
    for (double x = from_m; x < to_m; x += step_m) {
      const double left = left_over(notes, {x});
      curve.x.push_back(x), curve.y.push_back(left);
      if (left < least) least = left, at = x;
      for (double other = x + 0.01; other < to_m; other += step_m)
        if (const double pair = left_over(notes, {x, other}); pair < least_pair) least_pair = pair, near = x, far = other;
    }
    std::printf("%-10s  %5zu  %5.2f dB   %5.2f dB at %3.0f mm   %5.2f dB at %3.0f and %3.0f mm\n", name.c_str(), notes.size(),
                left_over(notes, {}), least, 1e3 * at, least_pair, 1e3 * near, 1e3 * far);
    if (!colour) return;
    one.all.push_back(std::move(curve));
    two.all.push_back({name, colour, {near}, {far}, false});
  };
  std::vector<std::vector<note>> each;
  for (const plucked_string& s : strings) {
    each.push_back(read_notes(files, s));
    if (each.back().empty()) return std::printf("%s: no notes of the %s string\n", words[1], s.name), 1;
    fitted(s.name, each.back(), s.colour);
  }
  const auto together = [&](std::size_t without) {
    std::vector<note> all;
    for (std::size_t i = 0; i < each.size(); ++i)
      if (i != without) all.insert(all.end(), each[i].begin(), each[i].end());
    return all;
  };
  fitted("all", together(each.size()), "#7a7a7a");
  for (std::size_t i = 0; i < each.size(); ++i) fitted(std::string{"all but "} + strings[i].name, together(i), nullptr);
  return count < 3 || real::write_figure(words[2], {one, two}) ? 0 : 1;
}
