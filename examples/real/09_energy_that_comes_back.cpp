// SPDX-License-Identifier: MIT
//
// Hidden physics: an obstacle. The starting model is a linear string: partials die at rates of their own, whatever the strength
// of the pluck. A string that strikes the fingerboard moves energy from low partials into high ones for as long as it strikes:
// after a hard pluck they do not die as after a soft one, or grow again.
//
// Told for soft and hard plucks of the same note: how much the partials 21 to 40 lose from 0.02 to 0.2 s, and how far they come
// back from their lowest level within half a second.
//
//     09_energy_that_comes_back FIGURE.svg NOMINAL_HZ RECORDING [NOMINAL_HZ RECORDING]...
//
#include "figure.hpp"

#include <rosin/calibrate/partial_baseband.hpp>
#include <rosin/calibrate/pickup_fit.hpp>

namespace {

constexpr int low = 21, high = 40;
constexpr double hop_s = 0.02, look_s = 0.5;
constexpr double named_dB = 6;  // beats of two polarisations bring back 5

real::series level_of(const real::channel& heard, double nominal_Hz, const std::string& name, const char* colour) {
  const rosin::baseband_bank bank{heard.samples, heard.rate_Hz, 0.45 * nominal_Hz};
  const double begin = rosin::detail::sound_begins_s(heard.samples, heard.rate_Hz);
  real::series s{name, colour, {}, {}, true};
  for (double t = hop_s; t < look_s; t += hop_s) s.x.push_back(t), s.y.push_back(1e-20);
  for (int n = low; n <= high; ++n) {
    const auto z = bank.around(n * nominal_Hz);
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      const auto a = static_cast<std::size_t>((begin + s.x[i] - hop_s) * z.rate_Hz),
                 b = static_cast<std::size_t>((begin + s.x[i] + hop_s) * z.rate_Hz);
      for (std::size_t j = a; j < b; ++j) s.y[i] += std::norm(z.samples[j]) / static_cast<double>(b - a);
    }
  }
  for (double& v : s.y) v = 10 * std::log10(v);
  return s;
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return std::printf("usage: %s FIGURE.svg NOMINAL_HZ RECORDING...\n", words[0]), 2;
  const char* colours[] = {"#8fc1e3", "#1b6ca8", "#e8b58a", "#d9731a", "#a9c79a", "#5f8f3f"};
  real::panel p{"Partials 21 to 40", "time, s", "level, dB", {}};
  std::printf("recording                lost from 0.02 to 0.2 s   comes back\n");
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string file = words[i + 1];
    const std::size_t slash = file.rfind('/') == std::string::npos ? 0 : file.rfind('/') + 1;
    auto s = level_of(real::read_channel(file), std::atof(words[i]), file.substr(slash, file.rfind('.') - slash),
                      colours[(i / 2 - 1) % 6]);
    double lowest = s.y.front(), back = 0;
    for (const double v : s.y) lowest = std::min(lowest, v), back = std::max(back, v - lowest);
    std::printf("%-24s %8.1f dB               %8.1f dB   %s\n", s.name.c_str(), s.y[0] - s.y[9], back,
                back > named_dB ? "struck something" : "");
    p.all.push_back(std::move(s));
  }
  return real::write_figure(words[1], {p}) ? 0 : 1;
}
