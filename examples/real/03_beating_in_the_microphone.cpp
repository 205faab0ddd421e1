// SPDX-License-Identifier: MIT
//
// Hidden physics: the second polarisation. The starting model has one damped line a partial. A string swings in two planes,
// which the bridge holds differently: two lines, a fraction of a hertz apart, that beat and decay one after the other.
//
// The two lines are found on the pickup. The microphone, which hears the two planes in another mixture, is withheld: of it only
// the complex amplitudes are fitted, the poles stay those of the pickup. Against chance stand lines mirrored about the
// louder one: as many numbers, the wrong physics.
//
//     03_beating_in_the_microphone FIGURE.svg NOMINAL_HZ PAIR [NOMINAL_HZ PAIR]...     PAIR: PAIR_1.flac microphone, PAIR_2.flac
//     pickup
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

#include <complex>

namespace {

constexpr int highest = 8;
constexpr double tolerance_Hz = 3;

struct share {
  double one, two, mirrored, own;  ///< energy left over in the microphone, per cent
};
struct verdict {
  std::vector<share> all;
};

/// The same two lines, the weaker one on the other side of the louder one.
rosin::line_model mirrored(rosin::line_model m, double lasts_s) {
  auto &a = m.parts[0], &b = m.parts[1];
  auto& weak = a.energy(lasts_s) < b.energy(lasts_s) ? a : b;
  const auto& loud = &weak == &a ? b : a;
  weak.detuning_rad_s = 2 * loud.detuning_rad_s - weak.detuning_rad_s;
  return m;
}

real::panel beats(const std::string& title, const std::vector<std::complex<double>>& heard, double rate_Hz,
                  const rosin::line_model& one, const rosin::line_model& two) {
  real::panel p{title, "time, s", "level in the microphone, dB", {}};
  p.all = {{"microphone", "#8fc1e3", {}, {}, true},
           {"one line of the pickup", "#d9731a", {}, {}, true},
           {"two lines of the pickup", "#222222", {}, {}, true}};
  Eigen::VectorXcd row(9);
  const std::size_t step = std::max<std::size_t>(1, heard.size() / 400);
  const double top = 20 * std::log10(std::abs(heard.front()));
  for (std::size_t j = 0; j < heard.size(); j += step) {
    const double t = static_cast<double>(j) / rate_Hz;
    const double level[] = {std::abs(heard[j]), std::abs(rosin::detail::line_row(one, t, false, row)),
                            std::abs(rosin::detail::line_row(two, t, false, row))};
    for (std::size_t i = 0; i < 3; ++i)
      if (20 * std::log10(level[i]) > top - 60) p.all[i].x.push_back(t), p.all[i].y.push_back(20 * std::log10(level[i]));
  }
  return p;
}

verdict compare(const std::string& pair, double nominal_Hz, std::vector<real::panel>& panels) {
  const auto pickup = real::read_channel(pair + "_2.flac"), microphone = real::read_channel(pair + "_1.flac");
  const auto fit = rosin::fit_pickup(pickup.samples, pickup.rate_Hz, nominal_Hz);
  if (!fit) return std::printf("%s: %s\n", pair.c_str(), fit.error().c_str()), verdict{};
  const double half_width = std::min(64.0, 0.45 * nominal_Hz),
               end = static_cast<double>(pickup.samples.size()) / pickup.rate_Hz - 0.1;
  const rosin::baseband_bank seen{pickup.samples, pickup.rate_Hz, half_width},
      sounded{microphone.samples, microphone.rate_Hz, half_width};
  std::vector<rosin::partial_track> tracks;
  for (int n = 1; n <= highest; ++n)
    if (auto t = rosin::track_partial(seen, n, rosin::partial_frequency(fit->fundamental_Hz, fit->inharmonicity, n), tolerance_Hz,
                                      fit->start_s, end))
      tracks.push_back(std::move(*t));
  if (fit->glide.relative != 0) rosin::take_out_glide(tracks, fit->glide, 1.5 * tolerance_Hz);
  verdict v;
  for (const auto& t : tracks) {
    if (t.fit.model.parts.size() < 2) continue;
    const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
    const auto whole = sounded.around(t.fit.model.centre_Hz);
    const auto from = whole.samples.begin() + static_cast<std::ptrdiff_t>(std::ceil(fit->start_s * whole.rate_Hz));
    const std::vector<std::complex<double>> heard(from, from + static_cast<std::ptrdiff_t>(t.samples.size()));
    auto one = rosin::fit_line(t.samples, t.rate_Hz,
                               {{rosin::detail::strongest(t.fit.model, lasts)}, t.fit.model.centre_Hz, t.fit.model.glide})
                   .model;
    auto two = t.fit.model, wrong = mirrored(two, lasts);
    const double percent = 100 / rosin::detail::energy_of(heard);
    const share s{
        percent * rosin::solve_amplitudes(heard, t.rate_Hz, one), percent * rosin::solve_amplitudes(heard, t.rate_Hz, two),
        percent * rosin::solve_amplitudes(heard, t.rate_Hz, wrong), percent * rosin::fit_line(heard, t.rate_Hz, two).residual};
    std::printf("%-14s %d  %8.2f Hz  split %5.3f Hz   %6.2f  %6.2f  %6.2f  %6.2f %%\n", pair.substr(pair.rfind('/') + 1).c_str(),
                t.number, two.centre_Hz,
                std::abs(two.parts[0].detuning_rad_s - two.parts[1].detuning_rad_s) / rosin::detail::full_turn, s.one, s.two,
                s.mirrored, s.own);
    v.all.push_back(s);
    if (t.number == 4 && panels.size() < 2)
      panels.push_back(beats(pair.substr(pair.rfind('/') + 1) + ", partial 4", heard, t.rate_Hz, one, two));
  }
  return v;
}

double median(const std::vector<share>& all, double share::*which) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) v[static_cast<Eigen::Index>(i)] = all[i].*which;
  return rosin::detail::median_of(v);
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return std::printf("usage: %s FIGURE.svg NOMINAL_HZ PAIR...\n", words[0]), 2;
  std::vector<real::panel> panels;
  std::vector<share> all;
  std::printf("note      partial                    left over in the microphone: one line, two, mirrored, fitted there\n");
  for (int i = 2; i + 1 < count; i += 2) {
    const auto v = compare(words[i + 1], std::atof(words[i]), panels);
    all.insert(all.end(), v.all.begin(), v.all.end());
  }
  const auto better =
      std::count_if(all.begin(), all.end(), [](const share& s) { return s.two < s.mirrored && s.two < s.one / 2; });
  std::printf(
      "%zu double partials; median left over: one line %.2f %%, two %.2f %%, mirrored %.2f %%, fitted to the microphone %.2f "
      "%%\n",
      all.size(), median(all, &share::one), median(all, &share::two), median(all, &share::mirrored), median(all, &share::own));
  const auto chance = std::count_if(all.begin(), all.end(), [](const share& s) { return s.two >= s.mirrored; });
  std::printf("two lines leave less than half of one, and less than mirrored: %td of %zu; not less than mirrored: %td\n", better,
              all.size(), chance);
  return real::write_figure(words[1], panels) ? 0 : 1;
}
