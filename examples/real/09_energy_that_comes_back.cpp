// SPDX-License-Identifier: MIT
//
// Hidden physics: an obstacle. The starting model is a linear string: what lies between partials 20 and 41 dies at a rate of its
// own, whatever the strength of the pluck. A string that strikes something moves energy from low partials into high ones for as long
// as it strikes: they hardly die, or grow again.
//
// Told for soft and hard plucks of the same note: how much that band loses from 0.02 to 0.2 s, and how far it comes back from its
// lowest level within half a second. As a second opinion, its strokes: how far its loudest millisecond after 0.05 s stands out of the
// tenth of a second about it. The whole band is taken, not its partials, so that the pitch need not be known well.
//
//     09_energy_that_comes_back FIGURE.svg NOMINAL_HZ RECORDING [NOMINAL_HZ RECORDING]...
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

namespace {

constexpr double low = 20.5, high = 40.5;
constexpr double hop_s = 0.02, look_s = 0.5;
constexpr double back_dB = 6, lost_dB = 10;  // beats of two polarisations bring back 5; soft plucks lose 16 and more

struct loud {
  double time_s = 0, above_dB = 0;
};

struct heard_band {
  real::series level;  ///< dB against s from the pluck, means of 40 ms
  loud stroke;
};

heard_band listen(const real::channel& heard, double nominal_Hz, const std::string& name, const char* colour) {
  const double begin = rosin::detail::sound_begins_s(heard.samples, heard.rate_Hz);
  const auto z =
      rosin::baseband_bank{heard.samples, heard.rate_Hz, (high - low) / 2 * nominal_Hz}.around((low + high) / 2 * nominal_Hz);
  heard_band out{{name, colour, {}, {}, true}, {}};
  for (double t = hop_s; t < look_s; t += hop_s)
    out.level.x.push_back(t), out.level.y.push_back(10 * std::log10(real::mean_power(z, begin + t - hop_s, begin + t + hop_s)));
  for (double t = 0.05; t < look_s; t += 0.001) {
    std::vector<double> about;
    for (double u = t - 0.05; u < t + 0.05; u += 0.001) about.push_back(real::mean_power(z, begin + u, begin + u + 0.001));
    std::nth_element(about.begin(), about.begin() + 50, about.end());
    const double above = 10 * std::log10(real::mean_power(z, begin + t, begin + t + 0.001) / about[50]);
    if (above > out.stroke.above_dB) out.stroke = {t, above};
  }
  return out;
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return std::printf("usage: %s FIGURE.svg NOMINAL_HZ RECORDING...\n", words[0]), 2;
  const char* colours[] = {"#8fc1e3", "#1b6ca8", "#e8b58a", "#d9731a", "#a9c79a", "#5f8f3f", "#c9a9c7", "#8c1d40"};
  real::panel p{"Partials 21 to 40", "time, s", "level, dB", {}};
  std::printf("recording                lost from 0.02 to 0.2 s   comes back   loudest stroke\n");
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string file = words[i + 1];
    const std::size_t slash = file.rfind('/') == std::string::npos ? 0 : file.rfind('/') + 1;
    auto [s, stroke] = listen(real::read_channel(file), std::atof(words[i]), file.substr(slash, file.rfind('.') - slash),
                              colours[(i / 2 - 1) % 8]);
    const double lost = s.y[0] - s.y[9];
    double lowest = s.y.front(), back = 0;
    for (const double v : s.y) lowest = std::min(lowest, v), back = std::max(back, v - lowest);
    std::printf("%-24s %8.1f dB               %8.1f dB  %5.1f dB at %.3f s   %s\n", s.name.c_str(), lost, back, stroke.above_dB,
                stroke.time_s, back > back_dB || lost < lost_dB ? "struck something" : "");
    p.all.push_back(std::move(s));
  }
  return real::write_figure(words[1], {p}) ? 0 : 1;
}
