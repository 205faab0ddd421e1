// SPDX-License-Identifier: MIT
#include <rosin/diagnose/stretching_pluck.hpp>

#include <rosin/simulate/burdened_signals.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

const rosin::ringing_string elastic{659.69, 6.49e-5, {900, 0, 0}, -1};
constexpr rosin::band seen{40e3, 50e3};

}  // namespace

TEST_CASE("a string that is not stretched rings as its partials do") {
  const auto force = rosin::stretching_pluck(elastic, 0.3, 0.01, seen, 200).run(0, 3e-6, 1 / 128e3, 4, 2000);
  const auto lines = rosin::pluck_lines(elastic, 0.3, 0, seen, 200);
  for (const std::size_t i : {50U, 333U, 1999U})
    for (std::size_t c = 0; c < 2; ++c) {
      double sum = 0;
      for (const auto& l : lines) sum += (l.residue[c] * std::exp(l.pole * (static_cast<double>(i) / 128e3 + 3e-6))).real();
      CHECK(force[c][i] == test::approx(sum).epsilon(2e-3).scale(0.3));
    }
}

TEST_CASE(
    "a single mode under its own tension rises in pitch as Duffing's equation says: df/f = (3/8) e, half of it shared with a "
    "turn of phase") {
  // q'' + w^2 (1 + s q^2) q = 0 oscillates at w (1 + 3 s A^2 / 8): amplitude A of the slope, s the stretch.
  const rosin::ringing_string pure{100, 0, {1e9, 0, 0}, -1};
  const double h = 1 / 64e3, stretch = 0.5, slope = 0.02;
  const rosin::stretching_pluck one(pure, 0.5, slope, {150, 150}, 1);  // only the first partial
  const auto force = one.run(stretch, 0, h, 1, 64000)[0];
  const double amplitude = slope * 2 / std::numbers::pi;
  int crossings = 0;
  double first = 0, last = 0;
  for (std::size_t i = 1; i < force.size(); ++i)
    if (force[i - 1] < 0 && force[i] >= 0) {
      last = static_cast<double>(i - 1) + force[i - 1] / (force[i - 1] - force[i]);
      if (crossings++ == 0) first = last;
    }
  const double f = (crossings - 1) / ((last - first) * h);
  CHECK(f / 100 - 1 == test::approx(3 * stretch * amplitude * amplitude / 8).epsilon(0.02));
}

TEST_CASE("a string with the mean stretch rings nearly as the stretched one does: what is left to take out is small") {
  const double slope = 0.02, stretch = 40, sample_s = 1 / 128e3;  // the pitch rises by some tenths of a per cent
  const auto all = [](double stop) { return rosin::band{stop, stop}; };
  const double relative = rosin::mean_stretch(elastic, 0.3, slope, stretch, 6);
  CHECK(relative > 0.002);
  const auto stretched = rosin::stretching_pluck(elastic, 0.3, slope, all(50e3), 200).run(stretch, 0, sample_s, 4, 1900);
  const auto mean =
      rosin::stretching_pluck(rosin::tightened(elastic, relative), 0.3, slope, all(50e3), 200).run(0, 0, sample_s, 4, 1900);
  const auto slack = rosin::stretching_pluck(elastic, 0.3, slope, all(50e3), 200).run(0, 0, sample_s, 4, 1900);
  double from_mean = 0, from_slack = 0;
  for (std::size_t i = 0; i < mean[0].size(); ++i)
    from_mean += std::pow(stretched[0][i] - mean[0][i], 2), from_slack += std::pow(stretched[0][i] - slack[0][i], 2);
  CHECK(std::sqrt(from_mean) < 0.15 * std::sqrt(from_slack));
}

TEST_CASE(
    "the strain of a released string: as much as was held, and half of it once a period has mixed what moves with what is "
    "stretched") {
  const rosin::ringing_string ideal{500, 0, {1e9, 0, 0}, -1};
  const double rate = 200e3, slope = 0.01, at = 0.3;
  const rosin::stretching_pluck pluck(ideal, at, slope, {90e3, 90e3}, 400);
  // Held at 0.3: slopes F (1 - at) / T and -F at / T.
  const double held = 0.5 * slope * slope * (at * (1 - at) * (1 - at) + (1 - at) * at * at);
  CHECK(pluck.held_strain() == test::approx(held).epsilon(0.01));
  const auto strain = pluck.unstretched_strain(0, 1 / rate, 400);  // one period
  CHECK(strain[0] == test::approx(held).epsilon(0.01));
  double mean = 0;
  for (const double s : strain) mean += s / 400;
  CHECK(mean == test::approx(held / 2).epsilon(0.02));
  for (std::size_t i = 0; i < 200; ++i)
    CHECK(strain[i] == test::approx(strain[i + 200]).epsilon(0.01).scale(held));  // twice a period
}

TEST_CASE("two planes of one tuning are one plane, and apart they are two strings as long as nothing stretches") {
  constexpr double slope = 0.02, stretch = 40, sample_s = 1 / 128e3;
  const auto one = rosin::stretching_pluck(elastic, 0.3, slope, seen, 100).run(stretch, 0, sample_s, 4, 1000);
  const auto alike = rosin::stretching_pluck(elastic, 0.3, slope, seen, 100, {0, 0.2}).run(stretch, 0, sample_s, 4, 1000);
  const auto against = rosin::stretching_pluck(elastic, 0.3, slope, seen, 100, {0, -0.2}).run(stretch, 0, sample_s, 4, 1000);
  auto second = elastic;
  second.fundamental_Hz *= 1.005, second.inharmonicity /= 1.005 * 1.005;
  const auto other = rosin::stretching_pluck(second, 0.3, slope, seen, 100).run(0, 0, sample_s, 4, 1000);
  const auto still = rosin::stretching_pluck(elastic, 0.3, slope, seen, 100).run(0, 0, sample_s, 4, 1000);
  const auto both = rosin::stretching_pluck(elastic, 0.3, slope, seen, 100, {0.005, 0.2}).run(0, 0, sample_s, 4, 1000);
  for (const std::size_t i : {0U, 100U, 517U, 999U})
    for (std::size_t c = 0; c < 2; ++c) {
      CHECK(alike[c][i] == test::approx(one[c][i]).epsilon(1e-9).scale(1));
      CHECK(against[c][i] == test::approx(one[c][i]).epsilon(1e-9).scale(1));
      CHECK(both[c][i] == test::approx((still[c][i] + 0.2 * other[c][i]) / 1.2).epsilon(1e-9).scale(1));
    }
}

namespace {

/// What stretching changes of the force on the near end, by modes that are stepped with their tension and by the model; relative.
class against_modes {
public:
  explicit against_modes(rosin::rig_burden burden) {
    rig_.string = {
        .length_m = 0.305, .tension_N = 64.2, .fundamental_Hz = 567, .bending_stiffness_Nm2 = 3e-5, .loss = {.quality = 1400}};
    const auto simulated = [&](double stiffness_N) {
      burden.string.axial_stiffness_N = stiffness_N;
      return rosin::simulate_pluck(rig_, burden, {.position = 0.2, .force_N = force_N, .release_s = 0.002, .duration_s = 0.012},
                                   settings_)
          ->force_near_N;
    };
    true_change_ = simulated(axial_N);
    const auto without = simulated(1e-9);
    for (std::size_t i = 0; i < without.size(); ++i) true_change_[i] -= without[i];
  }
  [[nodiscard]] double impedance_Ns_m() const { return rig_.string.impedance_Ns_m(); }
  [[nodiscard]] double off(rosin::second_plane other, const std::vector<rosin::string_load>& loads) const {
    const auto& s = rig_.string;
    const double b = std::pow(std::numbers::pi / s.length_m, 2) * s.bending_stiffness_Nm2 / s.tension_N;
    const rosin::stretching_pluck pluck({567, b, s.loss, -1}, 0.2, force_N / s.tension_N, {63e3, 63e3}, 200, other, loads);
    const auto stretched = pluck.run(axial_N / (4 * s.tension_N), 0, 1 / rate, 1, count)[0],
               slack = pluck.run(0, 0, 1 / rate, 1, count)[0];
    const auto low_pass = settings_.low_pass();
    const int reach = static_cast<int>(low_pass.half_width_s() * rate);
    double left = 0, all = 0;
    for (int i = 0; i + 60 < static_cast<int>(count); ++i) {  // through the same low-pass
      double change = 0;
      for (int j = std::max(0, i - reach); j <= std::min(static_cast<int>(count) - 1, i + reach); ++j)
        change += force_N * (stretched[static_cast<std::size_t>(j)] - slack[static_cast<std::size_t>(j)]) *
                  low_pass((i - j) / rate) / rate;
      const double truth = true_change_[released + static_cast<std::size_t>(i)];
      left += std::pow(truth - change, 2), all += truth * truth;
    }
    return std::sqrt(left / all);
  }

private:
  static constexpr double axial_N = 12700, force_N = 0.7, rate = 128e3;
  static constexpr std::size_t released = 256, count = 1000;
  rosin::modal_rig rig_;
  rosin::modal_settings settings_{.sample_rate_Hz = rate, .oversampling = 16, .pass_Hz = 5e3, .stop_Hz = 60e3};
  std::vector<double> true_change_;
};

}  // namespace

TEST_CASE("what stretching changes where there are two planes, against modes that are stepped with their tension") {
  constexpr double detuning = 0.005, coupling = 0.07;
  const against_modes truth({.detuning = detuning, .coupling = coupling});
  CHECK(truth.off({detuning, coupling}, {}) < 0.005);
  CHECK(truth.off({}, {}) > 0.03);
}

TEST_CASE(
    "what stretching changes where a damper or a bead sits on the string, against modes that are stepped with their tension") {
  struct loaded {
    rosin::point_load load;
    double most_off, ignored;
  };
  for (const loaded& now : {loaded{{.position = 0.73, .resistance_Ns_m = 2.8e-3}, 0.005, 0.03},
                            loaded{{.position = 0.73, .mass_kg = 5e-6}, 0.02, 0.5}}) {
    const rosin::point_load& load = now.load;
    CAPTURE(load.mass_kg);
    rosin::rig_burden burden;
    burden.string.loads.push_back(load);
    const against_modes truth(burden);
    const double z = truth.impedance_Ns_m();
    CHECK(truth.off({}, {{load.position, load.resistance_Ns_m / z, load.mass_kg / z}}) < now.most_off);
    CHECK(truth.off({}, {}) > now.ignored);
  }
}
