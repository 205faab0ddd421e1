// SPDX-License-Identifier: MIT
//
// Hidden physics: a finger that touches the string. The starting model is a free string whose partials fall off smoothly and die
// the sooner the higher they are,
//
//     level of partial n, dB = A - S log2(n) - D n^2 - C sin^2(n pi beta),     S, D, C >= 0
//
// with C = 0. A touch at beta takes out what moves there. A, S, D, C follow by least squares for every beta between 0.04 and 1/2,
// on top of the noise that is heard between partials; the best beta is where the finger was. One finger lay across both strings, so
// both are asked together, too. Near one half a touch takes the even partials as a loss does, by n^2: how far from it the finger may
// have been is told by an interval (95 %, likelihood ratio). Natural harmonics at the twelfth fret: one half.
// Two strings sound at once; where the partials of one come within 12 Hz of the other's, they are left out.
//
// The recording can be installed by anybody (Debian, sonic-pi-samples, guit_harmonics.flac: "B and E strings", CC0).
//
//     05_touched_node RECORDING [FIGURE.svg]
//
#include "figure.hpp"

#include <rosin/calibrate/partial_search.hpp>

#include <Eigen/Dense>
#include <boost/math/distributions/fisher_f.hpp>

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

bool clear_of(double f, double pitch_Hz, double by_Hz) {
  return std::abs(f - pitch_Hz * std::max(1.0, std::round(f / pitch_Hz))) >= by_Hz;
}

levels partial_levels(const real::channel& heard, double f0, double other_Hz) {
  const rosin::baseband_bank bank{heard.samples, heard.rate_Hz, 20};
  const auto power_dB = [&](double f) { return 10 * std::log10(real::mean_power(bank.around(f), from_s, from_s + lasts_s)); };
  levels l;
  for (int n = 1; n <= highest; ++n) {
    const double f = n * f0;
    if (!clear_of(f, other_Hz, near_Hz)) continue;
    double noise_dB = 0, heard_at = 0;
    for (const double aside : {-0.65, -0.5, -0.35, 0.35, 0.5, 0.65})
      if (clear_of(f + aside * f0, f0, 20) && clear_of(f + aside * f0, other_Hz, 20))
        noise_dB += power_dB(f + aside * f0), ++heard_at;
    l.number.push_back(n), l.dB.push_back(power_dB(f)), l.noise.push_back(std::pow(10, noise_dB / heard_at / 10));
  }
  return l;
}

struct touch {
  double beta, squares;   ///< dB^2 left over, their sum
  Eigen::Vector4d value;  ///< A, S, D, C
};

touch fitted_from(Eigen::Vector4d x, const levels& l, double beta) {
  const auto rows = static_cast<Eigen::Index>(l.dB.size());
  Eigen::MatrixXd J(rows, 4);
  Eigen::VectorXd off(rows);
  double damping = 1;
  touch best{beta, 1e9, x};
  for (int round = 0; round < 200; ++round) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double n = l.number[k];
      const Eigen::Vector4d slope{1, -std::log2(n), -n * n, beta > 0 ? -std::pow(std::sin(n * std::numbers::pi * beta), 2) : 0.0};
      const double string = std::pow(10, slope.dot(x) / 10), all = string + l.noise[k];
      off[i] = l.dB[k] - 10 * std::log10(all);
      J.row(i) = string / all * slope.transpose();
    }
    if (off.squaredNorm() < best.squares) best = {beta, off.squaredNorm(), x}, damping = std::max(damping / 4, 1e-6);
    else damping *= 4;
    x = best.value;
    const Eigen::Matrix4d normal = J.transpose() * J + damping * Eigen::Matrix4d::Identity();
    x += normal.ldlt().solve(J.transpose() * off);
    x.tail<3>() = x.tail<3>().cwiseMax(0.0);  // partials fall off, and a finger does not give
  }
  return best;
}

touch best_with(const levels& l, double beta) {
  touch best{beta, 1e9, {}};
  for (const double slope : {1.0, 12.0})
    for (const double loss : {0.01, 0.3})
      for (const double finger : {20.0, 60.0})
        if (const touch t = fitted_from({l.dB[1], slope, loss, beta > 0 ? finger : 0.0}, l, beta); t.squares < best.squares)
          best = t;
  return best;
}

/// The best place, and the least and the greatest whose squares (over their variance) are no more than chance would make them.
struct place {
  std::size_t best, from, to;
};

place told_by(const std::vector<double>& squares, double freedom) {
  const auto best = static_cast<std::size_t>(std::min_element(squares.begin(), squares.end()) - squares.begin());
  const double limit = squares[best] + boost::math::quantile(boost::math::fisher_f{1, freedom}, 0.95);
  place at{best, 0, squares.size() - 1};
  while (squares[at.from] > limit) ++at.from;
  while (squares[at.to] > limit) --at.to;
  return at;
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
  std::vector<double> beta, together;
  for (double at = 0.04; at <= 0.5001; at += 0.001) beta.push_back(at), together.push_back(0);
  double freedom = -1;  // one place for both
  for (std::size_t s = 0; s < 2; ++s) {
    const levels l = partial_levels(heard, pitch[s], pitch[1 - s]);
    const double rows = static_cast<double>(l.dB.size()), free = rows - 5;
    const auto rms = [&](double squares) { return std::sqrt(squares / rows); };
    std::vector<double> squares;
    for (const double at : beta) squares.push_back(best_with(l, at).squares);
    const double variance = *std::min_element(squares.begin(), squares.end()) / free;
    real::series curve{strings[s].name, strings[s].colour, beta, {}, true};
    for (std::size_t i = 0; i < beta.size(); ++i) {
      curve.y.push_back(rms(squares[i]));
      squares[i] /= variance, together[i] += squares[i];
    }
    freedom += rows - 4;
    const place at = told_by(squares, free);
    std::printf(
        "%s string: open pitch %.2f Hz (%+.1f cents), %.0f partials; free string leaves %.1f dB, touched %.2f dB:\n"
        "  at %.3f (%.3f to %.3f), at 0.500 %.2f dB\n",
        strings[s].name, pitch[s], 1200 * std::log2(pitch[s] / strings[s].open_Hz), rows, rms(best_with(l, 0).squares),
        curve.y[at.best], beta[at.best], beta[at.from], beta[at.to], curve.y.back());
    if (count > 3)
      for (std::size_t i = 0; i < l.dB.size(); ++i)
        std::printf("  %2.0f  %6.1f dB, noise %6.1f\n", l.number[i], l.dB[i], 10 * std::log10(l.noise[i]));
    shown.all.push_back({strings[s].name, strings[s].colour, l.number, l.dB, false});
    search.all.push_back(std::move(curve));
  }
  const place at = told_by(together, freedom);
  const bool half = beta[at.to] > 0.4995 && beta[at.from] > 0.4;  // the next nodes of natural harmonics: 2/5, 1/3
  std::printf("one finger across both: at %.3f (%.3f to %.3f); one half, and no other node: %s\n", beta[at.best], beta[at.from],
              beta[at.to], half ? "yes" : "no");
  return (count < 3 || real::write_figure(words[2], {shown, search})) && half ? 0 : 1;
}
