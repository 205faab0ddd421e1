// SPDX-License-Identifier: MIT
//
// Hidden physics: the contact. A model that knows the string alone says that the partials of a bowed note lie where those of the
// plucked one lie, stretched by the bending stiffness. Stick and slip once a period lock them: exact multiples, b = 0.
//
// Pitch wanders under a human bow, so frequencies cannot be read from a spectrum finely enough. The phase of partial n minus
// n/m times that of the loudest, m, does not wander: what is left of its slope is what is missing to a multiple. The plucked
// notes of the same instrument stand against it.
//
//     04_bowed_notes_are_periodic FIGURE.svg NOMINAL_HZ BOWED.wav ... -- NOMINAL_HZ PLUCKED.wav ...
//
#include "figure.hpp"

#include <rosin/calibrate/pickup_fit.hpp>

#include <complex>
#include <map>

namespace {

constexpr int highest = 30;
constexpr double heard_dB = 35, from = 0.3, to = 0.7;  // the middle of the stroke

struct locked_phase {
  std::vector<double> radians;
  double power = 0;
};

locked_phase phase_of(const rosin::baseband_record& z, std::size_t a, std::size_t b) {
  locked_phase p;
  double turned = 0;
  for (std::size_t j = a; j < b; ++j) {
    if (j > a)
      turned += std::arg(z.samples[j] * std::conj(z.samples[j - 1])) + rosin::detail::full_turn * z.centre_Hz / z.rate_Hz;
    p.radians.push_back(turned);
    p.power += std::norm(z.samples[j]);
  }
  return p;
}

/// Slope of y over equidistant samples, with the standard deviation of a straight line through what wanders slowly: the
/// residual counted as if it had three independent values.
std::pair<double, double> slope_of(const std::vector<double>& y, double rate_Hz) {
  const double n = static_cast<double>(y.size()), middle = (n - 1) / 2;
  double sxy = 0, sxx = 0, sum = 0, off = 0;
  for (std::size_t j = 0; j < y.size(); ++j) {
    const double x = static_cast<double>(j) - middle;
    sxy += x * y[j], sxx += x * x, sum += y[j];
  }
  for (std::size_t j = 0; j < y.size(); ++j) off += std::pow(y[j] - sum / n - sxy / sxx * (static_cast<double>(j) - middle), 2);
  return {sxy / sxx * rate_Hz, std::sqrt(off / n / 3 / (sxx / n)) * rate_Hz};
}

std::vector<rosin::numbered_frequency> bowed_partials(const real::channel& heard, double nominal_Hz) {
  const double lasts = static_cast<double>(heard.samples.size()) / heard.rate_Hz;
  const auto at = [&](double part) { return heard.samples.begin() + static_cast<std::ptrdiff_t>(part * lasts * heard.rate_Hz); };
  const std::vector<double> middle(at(from), at(to));
  const double f0 = rosin::find_partials(middle, heard.rate_Hz, nominal_Hz, 0.06, highest).fundamental_Hz;
  const rosin::baseband_bank bank{heard.samples, heard.rate_Hz, 0.4 * nominal_Hz};
  std::map<int, locked_phase> all;
  int loudest = 1;
  for (int n = 1; n <= highest; ++n) {
    all[n] = phase_of(bank.around(n * f0), static_cast<std::size_t>(from * lasts * bank.rate()),
                      static_cast<std::size_t>(to * lasts * bank.rate()));
    if (n <= 8 && all[n].power > all[loudest].power) loudest = n;
  }
  const auto& main = all[loudest];
  const double base_Hz = slope_of(main.radians, bank.rate()).first / rosin::detail::full_turn / loudest;
  std::vector<rosin::numbered_frequency> found;
  for (const auto& [n, p] : all) {
    if (p.power < main.power * std::pow(10, -heard_dB / 10)) continue;
    std::vector<double> off(p.radians.size());
    for (std::size_t j = 0; j < off.size(); ++j) off[j] = p.radians[j] - main.radians[j] * n / loudest;
    const auto [slope, sd] = slope_of(off, bank.rate());
    found.push_back({n, n * base_Hz + slope / rosin::detail::full_turn, std::max(sd / rosin::detail::full_turn, 1e-4)});
  }
  return found;
}

std::vector<rosin::numbered_frequency> plucked_partials(const real::channel& heard, double nominal_Hz) {
  const auto fit = rosin::fit_pickup(heard.samples, heard.rate_Hz, nominal_Hz, {.partials_at_most = highest});
  std::vector<rosin::numbered_frequency> found;
  if (!fit) return std::printf("  %s\n", fit.error().c_str()), found;
  for (const auto& p : fit->partials) found.push_back({p.number, p.frequency_Hz, p.frequency_sd});
  return found;
}

void tell(const std::string& file, const std::vector<rosin::numbered_frequency>& partials, double nominal_Hz,
          real::series& shown) {
  if (partials.size() < 4) return std::printf("%-28s too few partials\n", file.c_str()), void();
  const auto fit = rosin::fit_pitch(partials, nominal_Hz, 0);
  double off = 0;
  for (const auto& p : partials) {
    const double cents = 1200 * std::log2(p.frequency_Hz / p.number / fit.value[0]);
    off += cents * cents / static_cast<double>(partials.size());
  }
  shown.x.push_back(fit.value[0]), shown.y.push_back(std::sqrt(off));
  std::printf("%-28s %2zu partials  f0 %8.3f Hz  b = %10.2e +- %.1e  off n f0: %6.3f cents\n", file.c_str(), partials.size(),
              fit.value[0], fit.value[1], std::sqrt(fit.covariance(1, 1)), std::sqrt(off));
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) return std::printf("usage: %s FIGURE.svg NOMINAL_HZ BOWED.wav ... -- NOMINAL_HZ PLUCKED.wav ...\n", words[0]), 2;
  real::panel p{"How far partials are from n f0", "pitch, Hz", "root mean square deviation, cents", {}, true, true};
  p.all = {{"bowed", "#1b6ca8", {}, {}, false}, {"plucked", "#d9731a", {}, {}, false}};
  bool bowed = true;
  for (int i = 2; i + 1 < count; i += 2) {
    if (std::string{words[i]} == "--") bowed = false, ++i;
    const double nominal_Hz = std::atof(words[i]);
    const auto heard = real::read_channel(words[i + 1]);
    tell(std::string{bowed ? "bowed   " : "plucked "} + words[i + 1],
         bowed ? bowed_partials(heard, nominal_Hz) : plucked_partials(heard, nominal_Hz), nominal_Hz, p.all[bowed ? 0 : 1]);
  }
  return real::write_figure(words[1], {p}) ? 0 : 1;
}
