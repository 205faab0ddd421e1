// SPDX-License-Identifier: MIT
//
// Hidden physics: a resonance, and whose it is. A resonance of a sensor colours what is heard and leaves the string alone; one of
// the body at the string's end takes energy out of the string: the partial near it decays faster, in every sensor alike, and
// those below and above it are pulled apart. The starting model is one loss law for all partials.
//
// Each note gives its own law from partials 2 to 6 (a constant 1/Q); partial 1 is held against it, on the pickup, and on the
// microphone, which is withheld. The pitch of partial 1 is held against the stiff string's.
//
//     08_whose_resonance FIGURE.svg NOMINAL_HZ PAIR [NOMINAL_HZ PAIR]...     PAIR: PAIR_1.flac microphone, PAIR_2.flac pickup
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

#include <numbers>
#include <optional>

namespace {

struct first_partial {
  double frequency_Hz, loss, expected, shift_Hz;  ///< loss: 1/Q
};

std::optional<first_partial> look(const std::string& file, double nominal_Hz) {
  const auto heard = real::read_channel(file);
  const auto fit = rosin::fit_pickup(heard.samples, heard.rate_Hz, nominal_Hz, {.partials_at_most = 16});
  if (!fit || fit->partials.front().number != 1) return std::nullopt;
  const auto loss = [](const rosin::partial& p) { return p.decay_per_s / std::numbers::pi / p.frequency_Hz; };
  std::vector<double> others;
  for (const auto& p : fit->partials)
    if (p.number >= 2 && p.number <= 6) others.push_back(loss(p));
  if (others.size() < 3) return std::nullopt;
  const double usual =
      rosin::detail::median_of(Eigen::Map<const Eigen::VectorXd>(others.data(), static_cast<Eigen::Index>(others.size())));
  const auto& p = fit->partials.front();
  return first_partial{p.frequency_Hz, loss(p), usual,
                       p.frequency_Hz - rosin::partial_frequency(fit->fundamental_Hz, fit->inharmonicity, 1)};
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return std::printf("usage: %s FIGURE.svg NOMINAL_HZ PAIR...\n", words[0]), 2;
  real::panel p{
      "Loss of partial 1 against the note's others", "frequency of partial 1, Hz", "1/Q over that of partials 2 to 6", {}};
  p.all = {{"pickup", "#1b6ca8", {}, {}, false}, {"microphone (withheld)", "#d9731a", {}, {}, false}};
  std::printf("note             f1, Hz    Q      Q of 2-6  ratio   shift, Hz | microphone: Q  ratio\n");
  for (int i = 2; i + 1 < count; i += 2) {
    const std::string pair = words[i + 1];
    const auto pickup = look(pair + "_2.flac", std::atof(words[i])), microphone = look(pair + "_1.flac", std::atof(words[i]));
    if (!pickup) continue;
    std::printf("%-14s  %7.2f  %5.0f   %5.0f    %5.2f   %+6.2f    |", pair.substr(pair.rfind('/') + 1).c_str(),
                pickup->frequency_Hz, 1 / pickup->loss, 1 / pickup->expected, pickup->loss / pickup->expected, pickup->shift_Hz);
    p.all[0].x.push_back(pickup->frequency_Hz), p.all[0].y.push_back(pickup->loss / pickup->expected);
    if (microphone) {
      std::printf("   %5.0f   %5.2f", 1 / microphone->loss, microphone->loss / microphone->expected);
      p.all[1].x.push_back(microphone->frequency_Hz), p.all[1].y.push_back(microphone->loss / microphone->expected);
    }
    std::printf("\n");
  }
  return real::write_figure(words[1], {p}) ? 0 : 1;
}
