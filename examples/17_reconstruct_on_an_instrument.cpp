// SPDX-License-Identifier: MIT
//
// From a pluck and a bridge admittance file to the friction force on an instrument. The string ends on a bridge that moves; its
// admittance was measured with a small hammer. Here both are simulated, so that the truth can be told.
//
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/calibrate/moving_string.hpp>
#include <rosin/propagate/termination_table.hpp>
#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <iostream>

namespace {

constexpr double rate_Hz = 40e3;
const rosin::string_parameters string{
    .length_m = 0.33, .tension_N = 50, .fundamental_Hz = 440, .bending_stiffness_Nm2 = 2e-5, .loss = {.quality = 900}};
const rosin::modal_termination body{{{290, 30, string.impedance_Ns_m() / 0.15},
                                     {550, 35, string.impedance_Ns_m() / 0.10},
                                     {2400, 10, string.impedance_Ns_m() / 0.03}}};

/// What both ends feel of a force at 0.12 of the length, through the closed form of moving_string.hpp.
std::array<std::vector<double>, 2> felt(const std::vector<double>& force_N) {
  const double sigma = 12 * rate_Hz / static_cast<double>(force_N.size());
  const rosin::damped_line_of_frequencies line(rate_Hz, sigma, force_N.size(), 0.49 * rate_Hz);
  const auto spectrum = rosin::damped_spectrum(line, force_N);
  std::array<std::vector<std::complex<double>>, 2> bins;
  for (auto& b : bins) b.resize(line.samples / 2 + 1);
  for (std::size_t k = 0; k < line.bins(); ++k) {
    const std::complex<double> s = line.at(k);
    std::complex<double> z = 0;
    for (const auto& m : body.modes) z += m(s);
    const rosin::passage_at p(s, string.stiffness_s2(), string.loss);
    const double one_way = 0.5 / string.fundamental_Hz;
    const auto a = rosin::moving_string(p, {0.12 * one_way * p.gamma_per_s, 0.88 * one_way * p.gamma_per_s}, {z, 0.0});
    for (std::size_t e = 0; e < 2; ++e) bins[e][k + line.first] = a.force[e] * spectrum[k] * rate_Hz;
  }
  std::array<std::vector<double>, 2> out{std::vector<double>(line.samples), std::vector<double>(line.samples)};
  rosin::eigen_fft<double> fft(line.samples);
  for (std::size_t e = 0; e < 2; ++e) {
    fft.inverse(bins[e].data(), out[e].data());
    for (std::size_t n = 0; n < out[e].size(); ++n) out[e][n] *= std::exp(sigma * static_cast<double>(n) / rate_Hz);
    out[e].resize(force_N.size() / 2);  // the later half would be rounding errors, grown
  }
  return out;
}

/// A force that jumps about like a bow's, from rest.
std::vector<double> jumping_force(std::size_t samples) {
  std::vector<double> force(samples, 0.0);
  for (std::size_t n = 400; n < samples; ++n) {
    const double t = static_cast<double>(n - 400) / rate_Hz, turn = 2 * std::numbers::pi * 438 * t;
    force[n] = std::min(1.0, t / 0.01) *
               (0.3 * std::sin(turn) + 0.2 * std::sin(2 * turn + 1) + 0.15 * std::sin(5 * turn) + 0.1 * std::sin(9 * turn));
  }
  return force;
}

}  // namespace

int main() {
  std::vector<rosin::measured_admittance> file;
  for (double f = 5; f < 12e3; f += 2) file.push_back({f, body.relative_admittance(f) / string.impedance_Ns_m()});

  const auto bridge = rosin::complete_admittance(file, string.impedance_Ns_m());
  if (!bridge) return std::cerr << bridge.error() << '\n', 1;

  const std::vector<double> truth = jumping_force(32768);
  const auto [near, far] = felt(truth);
  const rosin::band limits{10e3, 16e3};
  const rosin::end_motion moved = rosin::motion_of_end(*bridge, near, limits, rate_Hz);
  const std::vector<double> nut_at_rest(near.size(), 0.0);
  const rosin::bow_point contact = rosin::contact_at(string, 0.12);
  rosin::reconstructor<double, rosin::with_moving_ends<rosin::full_physics>> on_bridge(contact, limits, rate_Hz);
  const auto found = on_bridge({near, far, moved.times_impedance_N, nut_at_rest});
  const auto rigid = rosin::reconstructor<double>(contact, limits, rate_Hz)(near, far);

  double missed = 0, missed_rigid = 0, all = 0;
  for (std::size_t n = found.known.begin + 200; n + 200 < found.known.end; ++n) {
    missed += std::pow(found.force_N(n) - truth[n], 2), missed_rigid += std::pow(rigid.force_N(n) - truth[n], 2),
        all += truth[n] * truth[n];
  }
  std::cout << "force missed by " << 100 * std::sqrt(missed / all) << " %; by " << 100 * std::sqrt(missed_rigid / all)
            << " % with a rigid bridge\n";
  return missed < 0.02 * 0.02 * all && missed < missed_rigid / 9 ? 0 : 1;
}
