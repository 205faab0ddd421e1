// SPDX-License-Identifier: MIT
//
// Hidden physics: the other strings. The starting model has one string, stopped somewhere: all sound lies at multiples of its
// pitch. What is left over once these are cut out is different in each note; what is the same in all of them belongs to the
// instrument. So: the spectrum of every note without the neighbourhood of its own partials, and over all notes the median. The
// lines that stand out of it are compared with the standard tuning, which the program knows, and with the mains, which everybody
// has.
//
//     07_strings_that_ring_along FOLDER [FIGURE.svg]       FOLDER: E4_A4_mp_1.flac ..., string_note_mp_take
//
#include "figure.hpp"

#include <rosin/math/fft.hpp>

#include <complex>
#include <filesystem>
#include <numbers>
#include <set>

namespace {

constexpr double step_Hz = 0.25, lowest_Hz = 60, highest_Hz = 450, mains_Hz = 50;
constexpr double from_s = 0.3, lasts_s = 3.4, stands_out_dB = 8, near_cents = 20;

struct open_string {
  const char* name;
  int above_C0;
};
constexpr open_string tuning[] = {{"E2", 28}, {"A2", 33}, {"D3", 38}, {"G3", 43}, {"B3", 47}, {"E4", 52}};

double pitch_Hz(int above_C0) { return 440 * std::pow(2, (above_C0 - 57) / 12.0); }

int semitones(const std::string& note) {
  const int natural[] = {9, 11, 0, 2, 4, 5, 7};
  return natural[note[0] - 'A'] + (note[1] == 'b' ? -1 : 0) + 12 * (note.back() - '0');
}

double median(std::vector<double> v) {
  const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

/// Adds the levels of one note, in dB, to the columns; the neighbourhood of its own partials stays out.
void add_note(const real::channel& heard, double own_Hz, std::vector<std::vector<double>>& columns) {
  const auto first = static_cast<std::size_t>(from_s * heard.rate_Hz), count = static_cast<std::size_t>(lasts_s * heard.rate_Hz);
  const std::size_t size = rosin::fast_size(static_cast<std::size_t>(heard.rate_Hz / step_Hz));
  std::vector<double> windowed(size, 0.0);
  for (std::size_t i = 0; i < count && first + i < heard.samples.size(); ++i)
    windowed[i] = heard.samples[first + i] *
                  std::pow(std::sin(std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(count)), 4);
  std::vector<std::complex<double>> bins(size / 2 + 1);
  rosin::eigen_fft<double>{size}.forward(windowed.data(), bins.data());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double f = lowest_Hz + step_Hz * static_cast<double>(i), partial = std::max(1.0, std::round(f / own_Hz)) * own_Hz;
    if (std::abs(f - partial) < std::max(6.0, 0.04 * f)) continue;
    columns[i].push_back(
        10 * std::log10(std::norm(bins[static_cast<std::size_t>(std::lround(f * static_cast<double>(size) / heard.rate_Hz))]) +
                        1e-20));
  }
}

/// What a line is called; empty: nothing that is known.
std::string name_of(double f) {
  const double hum = std::round(f / mains_Hz) * mains_Hz;
  if (std::abs(f - hum) <= step_Hz) return "mains, " + real::number(hum) + " Hz";
  for (int n = 1; n <= 4; ++n)
    for (const open_string& s : tuning)
      if (const double cents = 1200 * std::log2(f / (n * pitch_Hz(s.above_C0))); std::abs(cents) < near_cents) {
        char text[64];
        std::snprintf(text, sizeof text, "open %s, partial %d, %+.0f cents", s.name, n, cents);
        return text;
      }
  return {};
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return std::printf("usage: %s FOLDER [FIGURE.svg]\n", words[0]), 2;
  std::vector<std::vector<double>> columns(static_cast<std::size_t>((highest_Hz - lowest_Hz) / step_Hz));
  std::size_t notes = 0;
  for (const auto& file : std::set<std::filesystem::path>{std::filesystem::directory_iterator{words[1]}, {}}) {
    const std::string name = file.stem().string();
    const std::size_t from = name.find('_') + 1, to = name.find("_mp");
    if (from == 0 || to == std::string::npos) continue;
    add_note(real::read_channel(file.string()), pitch_Hz(semitones(name.substr(from, to - from))), columns);
    ++notes;
  }
  real::series common{"median of all notes", "#1b6ca8", {}, {}, true},
      expected{"open strings, first two partials", "#d9731a", {}, {}, false};
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].size() >= 8)
      common.x.push_back(lowest_Hz + step_Hz * static_cast<double>(i)), common.y.push_back(median(columns[i]));
  if (common.x.size() < 200) return std::printf("%s: too few notes (%zu)\n", words[1], notes), 1;
  int lines = 0, strings = 0, mains = 0;
  const std::size_t around = 60, beside = 6;
  for (std::size_t i = beside; i + beside < common.y.size(); ++i) {
    const std::vector<double> near(common.y.begin() + static_cast<std::ptrdiff_t>(i - beside),
                                   common.y.begin() + static_cast<std::ptrdiff_t>(i + beside + 1));
    const auto a = common.y.begin() + static_cast<std::ptrdiff_t>(i > around ? i - around : 0);
    const auto b = common.y.begin() + static_cast<std::ptrdiff_t>(std::min(i + around, common.y.size()));
    const double above = common.y[i] - median({a, b});
    if (*std::max_element(near.begin(), near.end()) > common.y[i] || above < stands_out_dB) continue;
    const std::string what = name_of(common.x[i]);
    std::printf("%7.2f Hz  %5.1f dB above its surroundings   %s\n", common.x[i], above, what.empty() ? "?" : what.c_str());
    ++lines, strings += what.starts_with("open") ? 1 : 0, mains += what.starts_with("mains") ? 1 : 0;
  }
  std::printf("%zu notes: %d lines in common, %d of open strings, %d of the mains, %d unexplained\n", notes, lines, strings,
              mains, lines - strings - mains);
  const double loudest = *std::max_element(common.y.begin(), common.y.end());
  for (const open_string& s : tuning)
    for (int n = 1; n <= 2; ++n)
      if (n * pitch_Hz(s.above_C0) < highest_Hz)
        expected.x.push_back(n * pitch_Hz(s.above_C0)), expected.y.push_back(loudest + 3);
  return count < 3 || real::write_figure(words[2],
                                         {{"What all notes have in common", "frequency, Hz", "level, dB", {common, expected}}})
             ? 0
             : 1;
}
