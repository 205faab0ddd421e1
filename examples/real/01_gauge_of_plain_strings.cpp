// SPDX-License-Identifier: MIT
//
// Hidden physics: bending stiffness. The starting model is the ideal flexible string, partial n at n f0. What that leaves
// over grows like n^3; a stiff string, n f0 sqrt(1 + b n^2), takes it away, and b is a measurement of the wire:
//
//     d = (8 L^2 f0 / pi) sqrt(rho b / E)
//
// Each note alone gives the gauge that is printed on the packet. Withheld: the upper half of the partials is foretold from
// the lower half, with and without stiffness.
//
//     01_gauge_of_plain_strings FOLDER [FIGURE.svg]      FOLDER: E4_A4_mp_1.flac ..., string_note_mp_take
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/calibrate/pickup_string.hpp>

#include <filesystem>
#include <set>

namespace {

constexpr double scale_m = 0.6477, density_kg_m3 = 7850, modulus_Pa = 2.0e11;  // 25.5 inches; steel

struct plain_string {
  const char* name;
  int open;  ///< semitones above C0
  double gauge_m;
  const char* colour;
};
constexpr plain_string strings[] = {{"E4", 52, 0.010 * 0.0254, "#1b6ca8"}, {"G", 43, 0.017 * 0.0254, "#d9731a"}};

/// "Bb4" -> semitones above C0.
int semitones(const std::string& note) {
  const int natural[] = {9, 11, 0, 2, 4, 5, 7};
  return natural[note[0] - 'A'] + (note[1] == 'b' ? -1 : 0) + 12 * (note.back() - '0');
}

double cents(double f, double law) { return 1200 * std::log2(f / law); }

/// Root mean square deviation, in cents, of the upper half of the partials from the law that the lower half gives.
double upper_half_off(const std::vector<rosin::partial>& partials, double f0, bool stiff) {
  std::vector<rosin::numbered_frequency> low;
  Eigen::VectorXd pitch(static_cast<Eigen::Index>((partials.size() + 1) / 2));
  for (Eigen::Index i = 0; i < pitch.size(); ++i) {
    const auto& p = partials[static_cast<std::size_t>(i)];
    low.push_back({p.number, p.frequency_Hz, p.frequency_sd});
    pitch[i] = p.frequency_Hz / p.number;
  }
  const auto law = rosin::fit_pitch(low, f0, 0);
  double sum = 0;
  for (std::size_t i = low.size(); i < partials.size(); ++i) {
    const double n = partials[i].number;
    sum += std::pow(cents(partials[i].frequency_Hz,
                          stiff ? rosin::partial_frequency(law.value[0], law.value[1], n) : n * rosin::detail::median_of(pitch)),
                    2);
  }
  return std::sqrt(sum / static_cast<double>(partials.size() - low.size()));
}

struct gauge {
  int fret;
  double error, sd;  ///< per cent of the documented one
};

std::optional<gauge> measure(const std::filesystem::path& file, const plain_string& s, real::panel& deviations) {
  const std::string name = file.stem().string();
  const int fret = semitones(name.substr(name.find('_') + 1, name.find("_mp") - name.find('_') - 1)) - s.open;
  const auto heard = real::read_channel(file.string());
  const double nominal_Hz = 440 * std::pow(2, (s.open + fret - 57) / 12.0);
  const auto fit = rosin::fit_pickup(heard.samples, heard.rate_Hz, nominal_Hz);
  if (!fit) return std::printf("%-12s %s\n", name.c_str(), fit.error().c_str()), std::nullopt;
  const double length_m = scale_m * std::pow(2, -fret / 12.0);
  rosin::pickup_string_facts wire;
  wire.length_m = {length_m, 0};
  wire.density_kg_m3 = {density_kg_m3, 0};
  wire.youngs_modulus_Pa = {modulus_Pa, 0};
  const auto si = rosin::string_from(wire, {fit->fundamental_Hz, 0}, {fit->inharmonicity, fit->inharmonicity_sd});
  if (!si.diameter_from_sound_m) return std::printf("%-12s no stiffness heard\n", name.c_str()), std::nullopt;
  const auto [d, sd] = *si.diameter_from_sound_m;
  const double error = 100 * (d / s.gauge_m - 1);
  std::printf("%-12s %2d %3zu  %9.3e +- %.0e  %.4f mm  %+5.2f +- %4.2f %%  %7.2f %7.2f cents\n", name.c_str(), fret,
              fit->partials.size(), fit->inharmonicity, fit->inharmonicity_sd, 1e3 * d, error, 100 * sd / s.gauge_m,
              upper_half_off(fit->partials, fit->fundamental_Hz, false),
              upper_half_off(fit->partials, fit->fundamental_Hz, true));
  if (fret == 1) {
    deviations.all.push_back({std::string{s.name} + ", flexible string", s.colour, {}, {}, false});
    deviations.all.push_back({std::string{s.name} + ", stiff", s.name[0] == 'G' ? "#8c1d40" : "#5f8f3f", {}, {}, false});
    for (const auto& p : fit->partials)
      for (std::size_t stiff = 0; stiff < 2; ++stiff) {
        auto& points = deviations.all[deviations.all.size() - 2 + stiff];
        points.x.push_back(p.number);
        points.y.push_back(
            cents(p.frequency_Hz, rosin::partial_frequency(fit->fundamental_Hz, stiff ? fit->inharmonicity : 0, p.number)));
      }
  }
  return gauge{fret, error, 100 * sd / s.gauge_m};
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return std::printf("usage: %s FOLDER [FIGURE.svg]\n", words[0]), 2;
  real::panel deviations{"Partials at fret 1 against n f0", "number of the partial", "deviation, cents", {}};
  real::panel errors{"Gauge from single notes", "fret", "error, per cent", {}};
  std::printf("note      fret, partials, b                diameter    error               withheld: flexible, stiff\n");
  const std::set<std::filesystem::path> files{std::filesystem::directory_iterator{words[1]}, {}};
  for (const plain_string& s : strings) {
    real::series shown{s.name, s.colour, {}, {}, false};
    double sum = 0, weight = 0;
    int within = 0, notes = 0, long_enough = 0, of_these = 0;
    for (const auto& file : files) {
      if (!file.stem().string().starts_with(std::string{s.name} + "_")) continue;
      ++notes;
      const auto g = measure(file, s, deviations);
      if (!g) continue;
      shown.x.push_back(g->fret);
      shown.y.push_back(g->error);
      within += std::abs(g->error) <= 2 ? 1 : 0;
      if (1.96 * g->sd <= 2) ++long_enough, of_these += std::abs(g->error) <= 2 ? 1 : 0;
      sum += g->error / (g->sd * g->sd);
      weight += 1 / (g->sd * g->sd);
    }
    if (notes == 0) return std::printf("%s: no notes of the %s string\n", words[1], s.name), 1;
    std::printf(
        "%s: %d of %d notes within 2 %%; of those that ring long enough to tell so (95 %% sure) %d of %d; all together %+.2f "
        "%%\n",
        s.name, within, notes, of_these, long_enough, sum / weight);
    errors.all.push_back(std::move(shown));
  }
  return count < 3 || real::write_figure(words[2], {deviations, errors}) ? 0 : 1;
}
