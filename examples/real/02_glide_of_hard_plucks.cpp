// SPDX-License-Identifier: MIT
//
// Hidden physics: tension modulation. The starting model is a string whose tension does not know how wide it swings: every
// partial keeps its pitch. A real string is stretched by its own motion, so all partials are sharp together, in proportion
// to the energy that is left:
//
//     pitch(t) = base + sum_n K_n P_n(t),     P_n: power of partial n at the pickup
//
// A pickup hears each partial by another factor, so each K_n >= 0 is a number of its own, the same for all takes of a string.
// They are fitted to the soft plucks alone. The hard plucks are then foretold: of them only the base, from 2.5 s on, is used,
// because no peg stands still between takes. One K for all of them, "power alone", is told beside it. What the pickup hears of the
// first six partials 0.1 s after a hard pluck is told, too: where two plucks are heard alike and glide differently, what stretched the
// string was not heard.
//
//     02_glide_of_hard_plucks NOMINAL_HZ FIGURE.svg SOFT.flac... -- HARD.flac...
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

#include <array>
#include <complex>

namespace {

constexpr int first_partial = 2, last_partial = 6;  // below, the pickup hears too little; above, they die too soon
constexpr double hop_s = 0.05, late_s = 2.5, heard_dB = 25;

constexpr int stretching = 6;  // partials whose motion stretches the string
using powers = Eigen::Matrix<double, stretching, 1>;

struct moment {
  double time_s, cents, weight;
  powers power;
  std::size_t partial;
};

/// Pitch of each partial that is loud enough, against n times the nominal pitch, every 50 ms. The motion turns out of the pickup's
/// plane and back; what is heard of it later was there before, so powers are the greatest from there on.
std::vector<moment> pitch_track(const std::string& file, double nominal_Hz) {
  const auto heard = real::read_channel(file);
  const auto fit = rosin::fit_pickup(heard.samples, heard.rate_Hz, nominal_Hz, {.partials_at_most = 16});
  if (!fit) std::printf("%s: %s\n", file.c_str(), fit.error().c_str()), std::exit(1);
  const double begin = rosin::detail::sound_begins_s(heard.samples, heard.rate_Hz);
  const rosin::baseband_bank bank{heard.samples, heard.rate_Hz, 0.45 * nominal_Hz};
  std::vector<rosin::baseband_record> band;
  for (int n = 1; n <= 12; ++n) band.push_back(bank.around(rosin::partial_frequency(fit->fundamental_Hz, fit->inharmonicity, n)));
  std::vector<moment> track;
  for (double t = 0.1; t + hop_s < static_cast<double>(heard.samples.size()) / heard.rate_Hz - begin - 0.3; t += hop_s) {
    std::array<double, 12> power{}, pitch{};
    double loudest = 0;
    for (std::size_t i = 0; i < band.size(); ++i) {
      const auto& z = band[i].samples;
      const auto a = static_cast<std::size_t>((begin + t - hop_s) * band[i].rate_Hz),
                 b = static_cast<std::size_t>((begin + t + hop_s) * band[i].rate_Hz);
      std::complex<double> turn = 0;
      for (std::size_t j = a; j < b; ++j)
        turn += z[j + 1] * std::conj(z[j]), power[i] += std::norm(z[j]) / static_cast<double>(b - a);
      pitch[i] = band[i].centre_Hz + std::arg(turn) * band[i].rate_Hz / rosin::detail::full_turn;
      loudest = std::max(loudest, power[i]);
    }
    for (std::size_t i = first_partial - 1; i < last_partial; ++i)
      if (power[i] > loudest * std::pow(10, -heard_dB / 10))
        track.push_back({t, 1200 * std::log2(pitch[i] / nominal_Hz / static_cast<double>(i + 1)), std::sqrt(power[i] / loudest),
                         Eigen::Map<const powers>(power.data()), i});
  }
  powers later = powers::Zero();
  for (auto m = track.rbegin(); m != track.rend(); ++m) m->power = later = later.cwiseMax(m->power);
  return track;
}

/// Means over what is counted, for each partial by itself, and the sums of least squares about them.
struct centred {
  std::array<double, last_partial> cents{};
  std::array<powers, last_partial> power;
  Eigen::Matrix<double, stretching, stretching> normal = Eigen::Matrix<double, stretching, stretching>::Zero();
  powers right = powers::Zero();
};

template <class Counted>
centred centre(const std::vector<moment>& track, Counted counted) {
  centred c;
  c.power.fill(powers::Zero());
  std::array<double, last_partial> weight{};
  for (const moment& m : track)
    if (counted(m))
      c.cents[m.partial] += m.weight * m.cents, c.power[m.partial] += m.weight * m.power, weight[m.partial] += m.weight;
  for (std::size_t i = 0; i < weight.size(); ++i) c.cents[i] /= weight[i], c.power[i] /= weight[i];  // NaN: never heard there
  for (const moment& m : track)
    if (counted(m)) {
      const powers dp = m.power - c.power[m.partial];
      c.normal += m.weight * dp * dp.transpose();
      c.right += m.weight * (m.cents - c.cents[m.partial]) * dp;
    }
  return c;
}

/// Least squares with no K below zero, one after the other until nothing moves.
powers not_negative(const centred& sums) {
  powers K = powers::Zero();
  for (int round = 0; round < 20000; ++round)
    for (Eigen::Index i = 0; i < stretching; ++i)
      K[i] = std::max(0.0, K[i] + (sums.right[i] - sums.normal.row(i).dot(K)) / sums.normal(i, i));
  return K;
}

void told_at_first(const std::vector<moment>& track, const std::array<double, last_partial>& base) {
  double cents = 0, weight = 0;
  for (const moment& m : track)
    if (m.time_s == track.front().time_s && std::isfinite(base[m.partial]))
      cents += m.weight * (m.cents - base[m.partial]), weight += m.weight;
  std::printf("     at %.2f s: %.1f cents; power of partials 1 to 6, dB:", track.front().time_s, cents / weight);
  for (const double p : track.front().power) std::printf(" %.1f", 10 * std::log10(p));
  std::printf("\n");
}

powers all_alike(const centred& sums) { return powers::Constant(sums.right.sum() / sums.normal.sum()); }

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> all{words, words + count};
  const auto divider = std::find(all.begin(), all.end(), "--");
  if (count < 6 || divider == all.end())
    return std::printf("usage: %s NOMINAL_HZ FIGURE.svg SOFT.flac... -- HARD.flac...\n", words[0]), 2;
  const double nominal_Hz = std::atof(words[1]);
  const auto whole = [](const moment&) { return true; };
  const auto late = [](const moment& m) { return m.time_s >= late_s; };

  centred soft;
  for (auto file = all.begin() + 3; file != divider; ++file) {
    const centred c = centre(pitch_track(*file, nominal_Hz), whole);
    std::printf("soft %-28s power alone: K = %6.0f cents per unit of power\n", file->c_str(), all_alike(c)[0]);
    soft.normal += c.normal, soft.right += c.right;
  }
  const powers K = not_negative(soft), alike = all_alike(soft);
  std::printf("all soft plucks: K_n =");
  for (const double k : K) std::printf(" %.0f", k);
  std::printf("; power alone: %.0f\n", alike[0]);

  std::vector<real::panel> panels;
  for (auto file = divider + 1; file != all.end(); ++file) {
    const auto track = pitch_track(*file, nominal_Hz);
    const centred base = centre(track, late);
    const std::size_t slash = file->rfind('/') == std::string::npos ? 0 : file->rfind('/') + 1;
    real::panel shown{file->substr(slash), "time, s", "pitch above its late value, cents", {}};
    shown.all = {{"measured, partials 2 to 6", "#8fc1e3", {}, {}, false},
                 {"foretold from the soft plucks", "#8c1d40", {}, {}, true}};
    double before = 0, after = 0, after_alike = 0, weight = 0;
    for (const moment& m : track) {
      const powers dp = m.power - base.power[m.partial];
      const double glide = m.cents - base.cents[m.partial], foretold = K.dot(dp);
      if (!std::isfinite(glide)) continue;
      shown.all[0].x.push_back(m.time_s), shown.all[0].y.push_back(glide);
      if (shown.all[1].x.empty() || shown.all[1].x.back() < m.time_s)
        shown.all[1].x.push_back(m.time_s), shown.all[1].y.push_back(foretold);
      if (late(m)) continue;
      before += m.weight * glide * glide;
      after += m.weight * std::pow(glide - foretold, 2);
      after_alike += m.weight * std::pow(glide - alike.dot(dp), 2);
      weight += m.weight;
    }
    std::printf("hard %-28s left before 2.5 s: %5.2f cents without, %5.2f with K_n, %5.2f with power alone\n", file->c_str(),
                std::sqrt(before / weight), std::sqrt(after / weight), std::sqrt(after_alike / weight));
    told_at_first(track, base.cents);
    panels.push_back(std::move(shown));
  }
  panels.resize(std::min<std::size_t>(panels.size(), 2));
  return real::write_figure(words[2], panels) ? 0 : 1;
}
