// SPDX-License-Identifier: MIT
//
// Hidden physics: a finger that touches the string. The starting model is a free string whose partials fall off smoothly,
//
//     level of partial n, dB = A - S log2(n) - C sin^2(n pi beta)
//
// with C = 0. A touch at beta takes out what moves there. A, S, C follow by least squares for every beta between 0.04 and 1/2, on
// top of the noise that is heard midway between partials; the best beta is where the finger was. Natural harmonics at the twelfth
// fret: one half. Two strings sound at once; where the partials of one come within 12 Hz of the other's, they are left out.
//
// The recording can be installed by anybody (Debian, sonic-pi-samples, guit_harmonics.flac: "B and E strings", CC0).
//
//     05_touched_node RECORDING [FIGURE.svg]
//
#include "figure.hpp"

#include <rosin/calibrate/partial_baseband.hpp>
#include <rosin/calibrate/partial_search.hpp>

#include <Eigen/Dense>

#include <numbers>

namespace {

constexpr double from_s = 0.6, lasts_s = 1.0, near_Hz = 12;
constexpr int highest = 12;

struct sounding_string {
  const char* name;
  double open_Hz;  ///< standard tuning; what sounds is found within 2 %
  const char* colour;
};
constexpr sounding_string strings[] = {{"B", 246.94, "#1b6ca8"}, {"E", 329.63, "#d9731a"}};

struct levels {
  std::vector<double> number, dB, noise;  ///< noise: power
};

/// Pitch of the open string from its strongest partial below the third.
double tuned(const std::vector<double>& x, double rate_Hz, double open_Hz) {
  const rosin::detail::peak_finder peaks{x, rate_Hz, open_Hz};
  const auto one = peaks.strongest(0.98 * open_Hz, 1.02 * open_Hz), two = peaks.strongest(1.96 * open_Hz, 2.04 * open_Hz);
  if (!one && !two) return open_Hz;
  return two && (!one || two->power > one->power) ? two->frequency_Hz / 2 : one->frequency_Hz;
}

levels partial_levels(const real::channel& heard, double f0, double other_Hz) {
  const rosin::baseband_bank bank{heard.samples, heard.rate_Hz, 20};
  const auto power = [&](double f) {
    const auto z = bank.around(f);
    double sum = 1e-20;
    const auto a = static_cast<std::size_t>(from_s * z.rate_Hz), b = static_cast<std::size_t>((from_s + lasts_s) * z.rate_Hz);
    for (std::size_t j = a; j < std::min(b, z.samples.size()); ++j) sum += std::norm(z.samples[j]) / static_cast<double>(b - a);
    return sum;
  };
  levels l;
  for (int n = 1; n <= highest; ++n) {
    const double f = n * f0, away = std::abs(f - other_Hz * std::max(1.0, std::round(f / other_Hz)));
    if (away < near_Hz) continue;
    l.number.push_back(n), l.dB.push_back(10 * std::log10(power(f))),
        l.noise.push_back(std::min(power(f - f0 / 2), power(f + f0 / 2)));
  }
  return l;
}

struct touch {
  double beta, off_dB;    ///< root mean square left over
  Eigen::Vector3d value;  ///< A, S, C
};

touch best_with(const levels& l, double beta) {
  const auto rows = static_cast<Eigen::Index>(l.dB.size());
  Eigen::Vector3d x{l.dB.front(), 6, beta > 0 ? 20.0 : 0.0};
  Eigen::MatrixXd J(rows, 3);
  Eigen::VectorXd off(rows);
  double damping = 1;
  touch best{beta, 1e9, x};
  for (int round = 0; round < 60; ++round) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector3d slope{1, -std::log2(l.number[k]),
                                  beta > 0 ? -std::pow(std::sin(l.number[k] * std::numbers::pi * beta), 2) : 0.0};
      const double string = std::pow(10, slope.dot(x) / 10), all = string + l.noise[k];
      off[i] = l.dB[k] - 10 * std::log10(all);
      J.row(i) = string / all * slope.transpose();
    }
    const double left = off.norm() / std::sqrt(static_cast<double>(rows));
    if (left < best.off_dB) best = {beta, left, x}, damping = std::max(damping / 4, 1e-6);
    else damping *= 4;
    x = best.value;
    const Eigen::Matrix3d normal = J.transpose() * J + damping * Eigen::Matrix3d::Identity();
    x += normal.ldlt().solve(J.transpose() * off);
    x[2] = std::max(x[2], 0.0);  // a finger does not give
  }
  return best;
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return std::printf("usage: %s RECORDING [FIGURE.svg]\n", words[0]), 2;
  const auto heard = real::read_channel(words[1]);
  if (static_cast<double>(heard.samples.size()) < (from_s + lasts_s) * heard.rate_Hz)
    return std::printf("%s: too short\n", words[1]), 1;
  const auto begin = heard.samples.begin() + static_cast<std::ptrdiff_t>(from_s * heard.rate_Hz);
  const std::vector<double> middle(begin, begin + static_cast<std::ptrdiff_t>(lasts_s * heard.rate_Hz));
  const double pitch[] = {tuned(middle, heard.rate_Hz, strings[0].open_Hz), tuned(middle, heard.rate_Hz, strings[1].open_Hz)};
  real::panel shown{"Partials of the open string", "number", "level, dB", {}},
      search{"Where was the finger?", "place of the touch / length", "left over, dB", {}};
  bool half = true;
  for (std::size_t s = 0; s < 2; ++s) {
    const levels l = partial_levels(heard, pitch[s], pitch[1 - s]);
    const touch free = best_with(l, 0);
    touch best = free;
    real::series curve{strings[s].name, strings[s].colour, {}, {}, true};
    for (double beta = 0.04; beta <= 0.5001; beta += 0.001) {
      const touch t = best_with(l, beta);
      curve.x.push_back(beta), curve.y.push_back(t.off_dB);
      if (t.off_dB < best.off_dB) best = t;
    }
    std::printf(
        "%s string: open pitch %.2f Hz (%+.1f cents), %zu partials; free string leaves %.1f dB, touched %.1f dB: at %.3f, C = "
        "%.1f dB\n",
        strings[s].name, pitch[s], 1200 * std::log2(pitch[s] / strings[s].open_Hz), l.dB.size(), free.off_dB, best.off_dB,
        best.beta, best.value[2]);
    if (count > 3)
      for (std::size_t i = 0; i < l.dB.size(); ++i)
        std::printf("  %2.0f  %6.1f dB, noise %6.1f\n", l.number[i], l.dB[i], 10 * std::log10(l.noise[i]));
    half = half && std::abs(best.beta - 0.5) < 0.03;
    shown.all.push_back({strings[s].name, strings[s].colour, l.number, l.dB, false});
    search.all.push_back(std::move(curve));
  }
  std::printf("touched at one half, within 0.03: %s\n", half ? "yes" : "no");
  return (count < 3 || real::write_figure(words[2], {shown, search})) && half ? 0 : 1;
}
