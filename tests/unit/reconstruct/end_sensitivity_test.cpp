// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/end_sensitivity.hpp>

#include <doctest/doctest.h>

#include <random>

namespace reconstruct_end_sensitivity {

namespace {

using moving = rosin::with_moving_ends<rosin::full_physics>;
constexpr double rate_Hz = 48e3;
const rosin::band limits{10e3, 20e3};
const rosin::bow_point at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {800, 0, 0}}, 0.3);

/// Reconstruction with these modes, one at each end.
rosin::bow_motion<double> reconstructed(const std::array<rosin::admittance_mode, 2>& modes,
                                        const std::array<std::vector<double>, 2>& force) {
  const auto near = rosin::motion_of_end(rosin::modal_termination{{modes[0]}}, force[0], limits, rate_Hz).times_impedance_N;
  const auto far = rosin::motion_of_end(rosin::modal_termination{{modes[1]}}, force[1], limits, rate_Hz).times_impedance_N;
  return rosin::reconstructor<double, moving>(at, limits, rate_Hz)({force[0], force[1], near, far});
}

}  // namespace

TEST_CASE("the columns are what a change of the modes does to the reconstruction") {
  std::mt19937 random{4};
  std::normal_distribution<double> gauss;
  std::array<std::vector<double>, 2> force{std::vector<double>(4000), std::vector<double>(4000)};
  for (auto& x : force)
    for (double& v : x) v = gauss(random);
  const std::array<rosin::admittance_mode, 2> modes{rosin::admittance_mode{900, 20, 40}, rosin::admittance_mode{2400, 12, 25}};
  const std::vector<rosin::mode_of_end> list{{1, modes[1]}, {0, modes[0]}};
  rosin::reconstruction_sensitivity s;
  for (auto* part : {&s.force, &s.difference, &s.velocity}) part->setZero(4000, rosin::waveform_parameters);
  const std::vector<double> unused(4000, 0.0);
  rosin::append_end_sensitivity<moving>(s, at, list, {force[0], force[1], unused, unused}, limits, rate_Hz);
  REQUIRE(s.force.cols() == rosin::waveform_parameters + 6);
  for (std::size_t k = 0; k < 2; ++k)
    for (int p = 0; p < 3; ++p) {
      auto up = modes, down = modes;
      const double h = 1e-4;
      for (auto* m : {&up[list[k].end], &down[list[k].end]})
        (p == 0 ? m->frequency_Hz : p == 1 ? m->q : m->per_mass_per_s) *= std::exp(m == &up[list[k].end] ? h : -h);
      const auto a = reconstructed(up, force), b = reconstructed(down, force);
      double off = 0, size = 0;
      for (std::size_t i = a.known.begin + 100; i + 100 < a.known.end; i += 7) {
        const auto row = static_cast<Eigen::Index>(i), column = rosin::waveform_parameters + 3 * static_cast<Eigen::Index>(k) + p;
        const double f = (a.force_N(i) - b.force_N(i)) / (2 * h), v = (a.velocity_m_s(i) - b.velocity_m_s(i)) / (2 * h);
        off += std::pow(f - s.force(row, column), 2) + std::pow(0.2 * (v - s.velocity(row, column)), 2);
        size += f * f + 0.04 * v * v;
      }
      CHECK(std::sqrt(off / size) < 0.01);
    }
}

}  // namespace reconstruct_end_sensitivity
