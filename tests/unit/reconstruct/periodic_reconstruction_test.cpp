// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/periodic_reconstruction.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "support/approx.hpp"

namespace reconstruct_periodic_reconstruction {

namespace {

constexpr double rate_Hz = 128e3, played_Hz = 648.37;  // a period of 197.418 samples: nothing integral about it
const rosin::bow_point at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {900, 2e-9, 0}}, 0.3);
using complex = std::complex<double>;

/// A contact force with harmonics 1 ... 25, unit N.
complex force_harmonic(int h) { return h <= 25 ? std::polar(0.2 / h, 0.7 * h * h) : complex(0); }

/// The waves between two ends with reflections R1, R2, solved as a loop: U1 = f/(2 Zf) + R2 D2^2 U2, and the other way round.
struct ends_and_velocity {
  complex near, far;
};
template <class R1, class R2>
ends_and_velocity forces_on_ends(complex f, double f_Hz, const R1& r1, const R2& r2) {
  const double w = 2 * std::numbers::pi * f_Hz;
  const complex g = rosin::propagation_rate(f_Hz, at.stiffness_s2, at.loss);
  const complex D1 = std::exp(-g * at.delay_s[0]), D2 = std::exp(-g * at.delay_s[1]);
  const complex loop1 = r1(f_Hz) * D1 * D1, loop2 = r2(f_Hz) * D2 * D2;
  const double Zw = at.impedance_Ns_m * rosin::wave_impedance_ratio(w, at.stiffness_s2);
  const complex kick = f / (2 * Zw * rosin::force_factor(w, at.stiffness_s2));
  const complex U1 = kick * (1.0 + loop2) / (1.0 - loop1 * loop2), U2 = kick * (1.0 + loop1) / (1.0 - loop1 * loop2);
  return {Zw * (1.0 - r1(f_Hz)) * D1 * U1, Zw * (1.0 - r2(f_Hz)) * D2 * U2};
}

template <class R1, class R2>
std::array<std::vector<double>, 3> played(std::size_t n, const R1& r1, const R2& r2) {
  std::array<std::vector<double>, 3> x;  // near, far, force
  for (auto& channel : x) channel.assign(n, 0.0);
  for (int h = 1; h <= 25; ++h) {
    const complex f = force_harmonic(h);
    const ends_and_velocity e = forces_on_ends(f, h * played_Hz, r1, r2);
    for (std::size_t i = 0; i < n; ++i) {
      const complex turn = std::polar(1.0, 2 * std::numbers::pi * h * played_Hz * static_cast<double>(i) / rate_Hz);
      x[0][i] += (e.near * turn).real();
      x[1][i] += (e.far * turn).real();
      x[2][i] += (f * turn).real();
    }
  }
  return x;
}

/// Largest error of one period's force against the truth, N.
double worst_error(const rosin::periodic_motion& m) {
  double worst = 0;
  for (int n = 0; n < m.samples_per_period; ++n) {
    const double t = static_cast<double>(m.source.begin) / rate_Hz + n / (played_Hz * m.samples_per_period);
    double truth = 0;
    for (int h = 1; h <= 25; ++h) truth += (force_harmonic(h) * std::polar(1.0, 2 * std::numbers::pi * h * played_Hz * t)).real();
    const auto i = static_cast<std::size_t>(n);
    worst = std::max({worst, std::abs(m.force_near_N[i] - truth), std::abs(m.force_far_N[i] - truth)});
  }
  return worst;
}

}  // namespace

TEST_CASE("a periodic force comes back through rigid ends, as in the time domain") {
  const auto x = played(6000, rosin::rigid_end{}, rosin::rigid_end{});
  const rosin::band limits{30e3, 52e3};
  const auto motion = rosin::reconstruct_periodic(at, x[0], x[1], limits, rate_Hz);
  REQUIRE_MESSAGE(motion, motion.error());
  CHECK(motion->source.period == test::approx(rate_Hz / played_Hz).epsilon(5e-7));
  CHECK(motion->source.remainder < 1e-4);
  CHECK(motion->samples_per_period == 198);
  CHECK(motion->regularised.empty());
  CHECK(worst_error(*motion) < 2e-4);
  CHECK(motion->delta < 2e-4);

  const rosin::bow_motion<double> whole = rosin::reconstructor<double>(at, limits, rate_Hz)(x[0], x[1]);
  double worst = 0;
  for (std::size_t i = whole.known.begin; i < whole.known.end; ++i) worst = std::max(worst, std::abs(whole.force_N(i) - x[2][i]));
  CHECK(worst < 1e-4);
}

TEST_CASE("an end that gives way is undone with its reflection function, and not without") {
  const auto soft = [](double f) {  // a resonance at 3 kHz: R = -(1 - ZY) / (1 + ZY)
    const complex s(0, 2 * std::numbers::pi * f), w0 = 2 * std::numbers::pi * 3000.0;
    const complex zy = 0.175 * (s / 0.005) / (s * s + s * w0 / 20.0 + w0 * w0);
    return -(1.0 - zy) / (1.0 + zy);
  };
  const auto x = played(6000, rosin::rigid_end{}, soft);
  const rosin::band limits{30e3, 52e3};
  const auto right = rosin::reconstruct_periodic(at, x[0], x[1], limits, rate_Hz, rosin::rigid_end{}, soft);
  REQUIRE_MESSAGE(right, right.error());
  CHECK(worst_error(*right) < 5e-4);
  const auto wrong = rosin::reconstruct_periodic(at, x[0], x[1], limits, rate_Hz);
  REQUIRE(wrong);
  CHECK(worst_error(*wrong) > 20 * worst_error(*right));
}

TEST_CASE("where an end hardly feels a force the quotient is damped, and the band is named") {
  const auto free_around_2kHz = [](double f) { return std::abs(f - 1945) < 400 ? complex(0.999) : complex(-1); };
  const auto x = played(6000, rosin::rigid_end{}, rosin::rigid_end{});
  const auto motion = rosin::reconstruct_periodic(at, x[0], x[1], {30e3, 52e3}, rate_Hz, rosin::rigid_end{}, free_around_2kHz);
  REQUIRE(motion);
  REQUIRE(motion->regularised.size() == 1);
  CHECK(motion->regularised[0].pass_Hz < 3 * played_Hz);
  CHECK(motion->regularised[0].stop_Hz > 3 * played_Hz);
  for (const double f : motion->force_near_N) CHECK(std::abs(f) < 100);
}

}  // namespace reconstruct_periodic_reconstruction
