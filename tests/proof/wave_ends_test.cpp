// SPDX-License-Identifier: MIT
//
// A string that ends on what was measured, running free: the travelling waves on every type of termination against the modal
// simulator (the rig of burdened_signals.hpp, which steps the ends as oscillators beside the string). The bridge has twenty
// modes, as a violin has; the waves are given those, the table that a hammer and a laser would make of them, and the impulse
// response of a reflection. Waveforms over twenty periods under the bow; pitch and decay of the partials when the string is left
// to itself.
//
#include "support/apart.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/propagate/termination_modes.hpp>
#include <rosin/propagate/termination_table.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/wave_stroke.hpp>

#include <random>

namespace {

const rosin::modal_rig& rig = test::violin_e_string;
const double impedance = rig.string.impedance_Ns_m();
constexpr double position = 0.21;
const rosin::wave_settings settings{.pass_Hz = 20e3, .stop_Hz = 30e3};
using ends = std::array<rosin::modal_termination, 2>;

/// Twenty modes, 0.2 to 6 kHz, light about a hill at 2.5 kHz.
rosin::modal_termination violin_bridge() {
  std::mt19937 random{5};
  const auto chance = [&] { return static_cast<double>(random() % 10000) / 10000; };
  rosin::modal_termination out;
  for (int i = 0; i < 20; ++i) {
    const double f = 200 * std::pow(30.0, (i + chance()) / 20), hill = std::exp(-std::pow(std::log(f / 2500) / 0.6, 2)),
                 q = 20 + 40 * chance();
    out.modes.push_back({f, q, impedance / ((0.4 - 0.3 * chance()) * (1 - hill) + 0.02 * hill)});
  }
  return out;
}

/// The bridge as a table of 1 Hz steps, by modes again.
rosin::modal_termination measured(const rosin::modal_termination& end) {
  std::vector<rosin::measured_admittance> table;
  for (double f = 1; f <= 12e3; f += 1) table.push_back({f, end.relative_admittance(f) / impedance});
  const auto completed = rosin::complete_admittance(table, impedance);
  REQUIRE(completed);
  const auto like = rosin::as_modes(*completed, {.to_Hz = 20e3});
  REQUIRE_MESSAGE(like, like.error());
  MESSAGE("a table of ", table.size(), " points by ", like->end.modes.size(), " modes; reflection off by ", like->mismatch);
  return like->end;
}

/// Strikes for 0.2 ms, then lets go.
struct strike {
  using scalar = double;
  double t = 0;
  rosin::contact_force<double> operator()(const rosin::load_line<double>& line) noexcept {
    t += line.step_s;
    return {.force_N = t < 2e-4 ? std::pow(std::sin(3.14159265358979 * t / 2e-4), 2) : 0.0};
  }
  void reset() noexcept { t = 0; }
};

/// Pitch and decay rate of partial n, from where its phase and size have gone between two windows.
std::complex<double> pole_of(const std::vector<double>& x, double rate_Hz, double near_Hz) {
  const auto size = static_cast<std::size_t>(0.03 * rate_Hz), apart = static_cast<std::size_t>(0.02 * rate_Hz);
  const std::complex<double> turn(0, -2 * std::numbers::pi * near_Hz / rate_Hz);
  std::array<std::complex<double>, 2> level{};
  for (std::size_t w = 0; w < 2; ++w)
    for (std::size_t n = 0; n < size; ++n) {
      const double window = std::pow(std::sin(std::numbers::pi * static_cast<double>(n) / static_cast<double>(size)), 4);
      const std::size_t at = static_cast<std::size_t>(0.01 * rate_Hz) + w * apart + n;
      level[w] += window * x[at] * std::exp(turn * static_cast<double>(at));
    }
  const double time = static_cast<double>(apart) / rate_Hz;
  return std::log(level[1] / level[0]) / time + std::complex<double>(0, 2 * std::numbers::pi * near_Hz);
}

template <class Law, class Rod>
rosin::modal_take by_modes(const ends& on, const Law& law, const Rod& rod, double duration_s) {
  rosin::rig_burden burden;
  burden.string.ends = on;
  auto take = rosin::simulate_stroke(rig, burden, law, rod, {position, duration_s}, settings.as_modal());
  REQUIRE(take);
  return *std::move(take);
}
template <class Law, class Rod>
rosin::modal_take by_waves(const ends& on, const Law& law, const Rod& rod, double duration_s) {
  const auto design = rosin::design_wave(rig, position, settings, on);
  REQUIRE_MESSAGE(design, design.error());
  auto take = rosin::simulate_wave_stroke(*design, rig, law, rod, duration_s, settings);
  REQUIRE_MESSAGE(take, take.error());
  return *std::move(take);
}

}  // namespace

TEST_CASE("bowed on a violin's bridge, as modes and as a table: the first twenty periods") {
  const rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.03, 0.2}}, {{0, 0.6}}};
  const auto bridge = violin_bridge();
  const double twenty_periods_s = 20 / rig.string.fundamental_Hz;
  const auto modes = by_modes({bridge, {}}, law, rod, twenty_periods_s), rigid = by_modes({}, law, rod, twenty_periods_s);
  CHECK(modes.slips > 5);
  MESSAGE("on rigid ends: Delta of force ", test::delta(rigid.contact_force_N, modes.contact_force_N), ", of velocity ",
          test::delta(rigid.centre_velocity_m_s, modes.centre_velocity_m_s));
  const auto table = measured(bridge);
  for (const auto* end : {&bridge, &table}) {
    const auto waves = by_waves({*end, {}}, law, rod, twenty_periods_s);
    const double force = test::delta(waves.contact_force_N, modes.contact_force_N),
                 velocity = test::delta(waves.centre_velocity_m_s, modes.centre_velocity_m_s);
    MESSAGE((end == &table ? "table" : "modes"), ": Delta of force ", force, ", of velocity ", velocity, ", ", waves.slips,
            " slips, ", modes.slips, " by modes");
    CHECK(waves.slips == modes.slips);
    CHECK(force < 0.02);
    CHECK(velocity < 0.02);
  }
}

TEST_CASE("left to itself: pitch and decay of the partials") {
  const auto bridge = violin_bridge();
  const auto wanted = by_modes({bridge, {}}, strike{}, rosin::steady_rod{}, 0.07),
             rigid = by_modes({}, strike{}, rosin::steady_rod{}, 0.07);
  const auto table = measured(bridge);
  for (const auto* end : {&bridge, &table}) {
    const auto waves = by_waves({*end, {}}, strike{}, rosin::steady_rod{}, 0.07);
    CHECK(test::delta(waves.force_near_N, wanted.force_near_N) < 0.02);
    double worst_cents = 0, worst_decay = 0, moved_cents = 0, moved_decay = 0;
    for (int n = 1; n <= 12; ++n) {
      const double f = n * rig.string.fundamental_Hz, rate = settings.sample_rate_Hz;
      const auto pole = pole_of(wanted.force_far_N, rate, f), found = pole_of(waves.force_far_N, rate, f),
                 stiff = pole_of(rigid.force_far_N, rate, f);
      const auto cents = [&](auto p) { return std::abs(1200 * std::log2(p.imag() / pole.imag())); };
      worst_cents = std::max(worst_cents, cents(found)), moved_cents = std::max(moved_cents, cents(stiff));
      worst_decay = std::max(worst_decay, std::abs(found.real() - pole.real()) / -pole.real()),
      moved_decay = std::max(moved_decay, std::abs(stiff.real() - pole.real()) / -pole.real());
    }
    MESSAGE((end == &table ? "table" : "modes"), ": twelve partials within ", worst_cents, " cents and ", 100 * worst_decay,
            " % of their decay; the bridge moves them by ", moved_cents, " cents and ", 100 * moved_decay, " %");
    CHECK(worst_cents < 0.01);
    CHECK(worst_decay < 0.003);
    CHECK(moved_cents > 1);
    CHECK(moved_decay > 0.3);
  }
}

TEST_CASE("an end that reflects by an impulse response: the waves do what its modes do") {
  std::vector<double> taps;  // a bridge that lets 3 % through, softly
  for (int n = 0; n < 12; ++n) taps.push_back(-0.97 * 0.4 * std::pow(0.6, n) / (1 - std::pow(0.6, 12)));
  const auto end = rosin::reflecting_end(taps, 192e3);
  REQUIRE_MESSAGE(end, end.error());
  const auto like = rosin::as_modes(*end, {.to_Hz = 30e3, .tolerance = 3e-3, .refuse = 0.02});
  REQUIRE_MESSAGE(like, like.error());
  const auto modes = by_modes({like->end, {}}, strike{}, rosin::steady_rod{}, 0.03),
             waves = by_waves({like->end, {}}, strike{}, rosin::steady_rod{}, 0.03);
  MESSAGE(like->end.modes.size(), " modes, reflection off by ", like->mismatch, "; Delta of the far force ",
          test::delta(waves.force_far_N, modes.force_far_N));
  CHECK(test::delta(waves.force_far_N, modes.force_far_N) < 0.02);
  CHECK(test::delta(waves.force_near_N, modes.force_near_N) < 0.02);
}
