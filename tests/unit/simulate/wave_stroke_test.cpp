// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_stroke.hpp>

#include "support/apart.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/profiled_rod.hpp>

namespace simulate_wave_stroke {

namespace {

const rosin::modal_rig& rig = test::violin_e_string;

/// A force that does not depend on the string: steps of random height, each held for a while.
struct imposed_force {
  using scalar = double;
  std::uint64_t state = 1;
  double force = 0;
  int count = 0;
  rosin::contact_force<double> operator()(const rosin::load_line<double>& line) noexcept {
    if (count++ % static_cast<int>(1.6e-5 / line.step_s) == 0) {
      state = state * 6364136223846793005U + 1442695040888963407U;
      force = static_cast<double>(state >> 11U) / 9007199254740992.0 - 0.3;
    }
    return {.force_N = force};
  }
  void reset() noexcept { *this = {}; }
};

}  // namespace

TEST_CASE("under a given force the string moves, and pulls at its ends, as its modes do") {
  for (const double position : {0.3, 0.12}) {
    CAPTURE(position);
    const rosin::wave_settings settings{.oversampling = 4, .pass_Hz = 20e3, .stop_Hz = 30e3};
    const auto modes = rosin::simulate_stroke(rig, imposed_force{}, rosin::steady_rod{}, {position, 0.02}, settings.as_modal());
    const auto waves = rosin::simulate_wave_stroke(rig, imposed_force{}, rosin::steady_rod{}, {position, 0.02}, settings);
    REQUIRE(modes);
    REQUIRE_MESSAGE(waves, waves.error());
    REQUIRE(waves->size() == modes->size());
    CHECK(test::apart(waves->contact_force_N, modes->contact_force_N) < 1e-6);
    CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 2e-3);
    CHECK(test::apart(waves->torsion_velocity_m_s, modes->torsion_velocity_m_s) < 5e-3);
    CHECK(test::apart(waves->force_near_N, modes->force_near_N) < 2e-3);
    CHECK(test::apart(waves->force_far_N, modes->force_far_N) < 2e-3);
  }
}

TEST_CASE("the whole model's balance of energy, by the modes under the force that the waves found") {
  const rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  const auto take = rosin::simulate_wave_stroke(rig, law, rosin::steady_rod{.start_s = 0.001},
                                                {.position = 0.2, .duration_s = 0.04, .account = true}, {.oversampling = 4});
  REQUIRE(take);
  REQUIRE(take->energy);
  CHECK(take->slips > 5);
  CHECK(std::abs(take->energy->string_error()) < 1e-10);
  CHECK(std::abs(take->energy->error()) < 3e-3);
  CHECK(take->energy->friction_J > 0.8 * take->energy->rod_J);
}

TEST_CASE("how many steps of the far side are computed together changes nothing, on rigid ends and on those that move") {
  const rosin::wave_settings settings{.sample_rate_Hz = 64e3, .oversampling = 4};
  const std::array<rosin::modal_termination, 2> moving{rosin::modal_termination{{{1200, 20, 3}}},
                                                       rosin::modal_termination{{{460, 30, 2}}}};
  for (const auto& [position, ends] : {std::pair{0.12, std::array<rosin::modal_termination, 2>{}}, std::pair{0.85, moving}}) {
    const auto design = rosin::design_wave(rig, position, settings, ends);
    REQUIRE(design);
    REQUIRE(!design->kernels.direct.empty());
    CHECK(design->kernels.far_block > 2 * design->kernels.block);
    auto together = *design;
    together.kernels.far_block = together.kernels.block;
    const auto blocks = rosin::simulate_wave_stroke(*design, rig, imposed_force{}, rosin::steady_rod{}, 0.01, settings);
    const auto steps = rosin::simulate_wave_stroke(together, rig, imposed_force{}, rosin::steady_rod{}, 0.01, settings);
    CHECK(test::apart(blocks->centre_velocity_m_s, steps->centre_velocity_m_s) < 1e-10);
    CHECK(test::apart(blocks->force_near_N, steps->force_near_N) < 1e-10);
    CHECK(test::apart(blocks->force_far_N, steps->force_far_N) < 1e-10);
  }
}

TEST_CASE("on ends that move the string does what its modes do on them") {
  const double z = rig.string.impedance_Ns_m();
  rosin::rig_burden burden;
  burden.string.ends[0].modes = {{460, 30, z / 0.1}, {2400, 12, z / 0.004}, {5100, 8, z / 0.003}};
  burden.string.ends[1].modes = {{7000, 20, z / 0.01}};
  const rosin::wave_settings settings{.oversampling = 4, .pass_Hz = 20e3, .stop_Hz = 30e3};
  for (const double position : {0.12}) {
    CAPTURE(position);
    const auto modes =
        rosin::simulate_stroke(rig, burden, imposed_force{}, rosin::steady_rod{}, {position, 0.012}, settings.as_modal());
    const auto rigid = rosin::simulate_stroke(rig, imposed_force{}, rosin::steady_rod{}, {position, 0.012}, settings.as_modal());
    const auto design = rosin::design_wave(rig, position, settings, burden.string.ends);
    REQUIRE((modes && rigid));
    REQUIRE_MESSAGE(design, design.error());
    const auto waves = rosin::simulate_wave_stroke(*design, rig, imposed_force{}, rosin::steady_rod{}, 0.012, settings);
    REQUIRE_MESSAGE(waves, waves.error());
    CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 2e-3);
    CHECK(test::apart(waves->force_near_N, modes->force_near_N) < 2e-3);
    CHECK(test::apart(waves->force_far_N, modes->force_far_N) < 2e-3);
    CHECK(test::apart(rigid->centre_velocity_m_s, modes->centre_velocity_m_s) > 0.03);
    CHECK(test::apart(rigid->force_near_N, modes->force_near_N) > 0.02);
  }
}

TEST_CASE("a rod that travels along the string: waves do what the modes do, near an end too, over a short way and a long one") {
  for (const auto& way : {rosin::profiled_rod::break_points{{0, 0.12}, {0.006, 0.13}, {0.02, 0.1}},
                          {{0, 0.3}, {0.02, 0.2}},
                          {{0, 0.9}, {0.02, 0.86}}}) {
    CAPTURE(way[0].second);
    const rosin::profiled_rod rod{{}, {}, {}, way};
    const rosin::wave_settings settings{.oversampling = 4, .pass_Hz = 20e3, .stop_Hz = 30e3};
    const auto modes = rosin::simulate_stroke(rig, imposed_force{}, rod, {.duration_s = 0.02}, settings.as_modal());
    const auto waves = rosin::simulate_wave_stroke(rig, imposed_force{}, rod, {.duration_s = 0.02}, settings);
    const auto still = rosin::simulate_wave_stroke(rig, imposed_force{}, rosin::steady_rod{}, {way[0].second, 0.02}, settings);
    REQUIRE((modes && still));
    REQUIRE_MESSAGE(waves, waves.error());
    CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 2e-3);
    CHECK(test::apart(waves->torsion_velocity_m_s, modes->torsion_velocity_m_s) < 6e-3);
    CHECK(test::apart(waves->force_near_N, modes->force_near_N) < 2e-3);
    CHECK(test::apart(waves->force_far_N, modes->force_far_N) < 2e-3);
    CHECK(test::apart(still->centre_velocity_m_s, modes->centre_velocity_m_s) > 0.2);
  }
}

TEST_CASE("strings without stiffness and with much loss do what their modes do, too") {
  for (const auto& like : {std::pair{100.0, 0.0}, {700.0, 0.0}, {100.0, 4e-5}}) {
    CAPTURE(like.first);
    const rosin::modal_rig string{.string = {.length_m = 0.65,
                                             .tension_N = 70,
                                             .fundamental_Hz = 196,
                                             .bending_stiffness_Nm2 = like.second,
                                             .loss = {.quality = like.first}}};
    const rosin::wave_settings settings{
        .sample_rate_Hz = 48e3, .oversampling = 8, .band_Hz = 60e3, .pass_Hz = 15e3, .stop_Hz = 22e3};
    const auto modes =
        rosin::simulate_stroke(string, imposed_force{}, rosin::steady_rod{}, {0.2, 0.04}, settings.as_modal(150e3));
    const auto waves = rosin::simulate_wave_stroke(string, imposed_force{}, rosin::steady_rod{}, {0.2, 0.04}, settings);
    const auto travels = rosin::simulate_wave_stroke(string, imposed_force{}, rosin::profiled_rod{{}, {}, {}, {{0, 0.2}}},
                                                     {.duration_s = 0.04}, settings);
    REQUIRE(modes);
    REQUIRE_MESSAGE(waves, waves.error());
    REQUIRE_MESSAGE(travels, travels.error());
    CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 5e-3);
    CHECK(test::apart(travels->centre_velocity_m_s, modes->centre_velocity_m_s) < 1e-2);
  }
}

TEST_CASE("on ends that move a contact that could travel but stays does what one that stays does") {
  const double z = rig.string.impedance_Ns_m();
  const std::array<rosin::modal_termination, 2> ends{rosin::modal_termination{{{460, 30, z / 0.1}, {2400, 12, z / 0.004}}},
                                                     rosin::modal_termination{{{7000, 20, z / 0.01}}}};
  const rosin::wave_settings settings{.oversampling = 4, .pass_Hz = 20e3, .stop_Hz = 30e3};
  const auto design = rosin::design_travelling_wave(rig, {0.1, 0.14}, settings, ends);
  REQUIRE_MESSAGE(design, design.error());
  const auto travels =
      rosin::simulate_wave_stroke(*design, rig, imposed_force{}, rosin::profiled_rod{{}, {}, {}, {{0, 0.12}}}, 0.012, settings);
  const auto stays = rosin::simulate_wave_stroke(rig, imposed_force{}, rosin::steady_rod{}, {0.12, 0.012}, settings, ends);
  REQUIRE((travels && stays));
  CHECK(test::apart(travels->centre_velocity_m_s, stays->centre_velocity_m_s) < 2e-3);
  CHECK(test::apart(travels->force_near_N, stays->force_near_N) < 2e-3);
  CHECK(test::apart(travels->force_far_N, stays->force_far_N) < 2e-3);
}

TEST_CASE("bowing while travelling: slips and forces as by the modes, and the balance of energy") {
  const rosin::velocity_curve law{rosin::two_exponential_curve<double>{}};
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.03, 0.2}}, {{0, 0.6}}, {{0, 0.21}, {0.03, 0.19}}};
  const rosin::wave_settings settings{.pass_Hz = 20e3, .stop_Hz = 30e3};
  const auto modes = rosin::simulate_stroke(rig, law, rod, {.duration_s = 0.02}, settings.as_modal());
  const auto waves = rosin::simulate_wave_stroke(rig, law, rod, {.duration_s = 0.02, .account = true}, settings);
  REQUIRE(modes);
  REQUIRE_MESSAGE(waves, waves.error());
  CHECK(waves->unconverged == 0);
  CHECK(modes->slips > 2);
  CHECK(waves->slips == modes->slips);
  CHECK(test::apart(waves->contact_force_N, modes->contact_force_N) < 0.02);
  CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 0.04);
  REQUIRE(waves->energy);
  CHECK(std::abs(waves->energy->error()) < 5e-3);
}

TEST_CASE("kernels of one place do not serve a rod that travels, nor those of a way one that stays") {
  const rosin::wave_settings settings{.oversampling = 2};
  const auto place = rosin::design_wave(rig, 0.2, settings);
  const auto way = rosin::design_travelling_wave(rig, {0.2, 0.21}, settings);
  REQUIRE((place && way));
  const rosin::velocity_curve law{rosin::two_exponential_curve<double>{}};
  CHECK(rosin::simulate_wave_stroke(*place, rig, law, rosin::profiled_rod{{}, {}, {}, {{0, 0.2}}}, 0.01, settings)
            .error()
            .find("travels") != std::string::npos);
  CHECK(rosin::simulate_wave_stroke(*way, rig, law, rosin::profiled_rod{}, 0.01, settings).error().find("stays") !=
        std::string::npos);
  CHECK(rosin::simulate_wave_stroke(rig, law, rosin::profiled_rod{{}, {}, {}, {{0, 0.9}, {0.01, 1.1}}}, {.duration_s = 0.01},
                                    settings)
            .error()
            .find("position") != std::string::npos);
  const rosin::profiled_rod moves{{}, {}, {}, {{0, 0.2}, {0.01, 0.21}}};
  for (const double duration_s : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::nan("")})
    CHECK(rosin::simulate_wave_stroke(rig, law, moves, {.duration_s = duration_s}, settings).error().find("must last") !=
          std::string::npos);
  CHECK(rosin::simulate_wave_stroke(rig, law, moves, {.duration_s = 0.01}, {.sample_rate_Hz = -1}).error().find("sample rate") !=
        std::string::npos);
  CHECK(rosin::simulate_wave_stroke(rig, law, rosin::profiled_rod{{}, {}, {}, {{0, 0.3}, {0.01, 0.29}, {0.018, 1.1}}},
                                    {.duration_s = 0.01}, settings));  // it leaves the string after the take
}

TEST_CASE("a bowed string on a body: waves and modes agree until the smallest difference has grown") {
  const double z = rig.string.impedance_Ns_m();
  rosin::rig_burden burden;
  burden.string.ends[0].modes = {{460, 30, z / 0.1}, {2400, 12, z / 0.004}, {5100, 8, z / 0.003}};
  const rosin::velocity_curve law{rosin::two_exponential_curve<double>{}};
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.1, 0.3}}, {{0, 0.6}}};
  const rosin::wave_settings settings{.pass_Hz = 20e3, .stop_Hz = 30e3};
  const auto modes = rosin::simulate_stroke(rig, burden, law, rod, {0.12, 0.02}, settings.as_modal());
  const auto design = rosin::design_wave(rig, 0.12, settings, burden.string.ends);
  REQUIRE(modes);
  REQUIRE(design);
  const auto waves = rosin::simulate_wave_stroke(*design, rig, law, rod, 0.02, settings);
  REQUIRE(waves);
  CHECK(modes->slips > 1);
  CHECK(waves->slips == modes->slips);
  CHECK(test::apart(waves->contact_force_N, modes->contact_force_N) < 0.03);
  CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 0.1);
}

TEST_CASE("a stroke in single precision follows the one in double") {
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.005, 0.2}}, {{0, 0.2}}};
  const rosin::wave_settings settings{.sample_rate_Hz = 64000, .oversampling = 4};
  const auto exact = rosin::simulate_wave_stroke<double>(rig, rosin::velocity_curve{rosin::two_exponential_curve<double>{}}, rod,
                                                         {0.3, 0.005}, settings);
  const auto single = rosin::simulate_wave_stroke<float>(rig, rosin::velocity_curve{rosin::two_exponential_curve<float>{}}, rod,
                                                         {0.3, 0.005}, settings);
  REQUIRE(exact);
  REQUIRE(single);
  CHECK(exact->unconverged == 0);
  CHECK(exact->slips > 0);
  CHECK(test::apart(single->contact_force_N, exact->contact_force_N) < 1e-2);
}

TEST_CASE("what makes no sense is refused; a rod off the string does nothing") {
  const rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  CHECK_FALSE(rosin::simulate_wave_stroke(rig, law, rosin::steady_rod{}, {0.3, -1}));
  CHECK_FALSE(rosin::simulate_wave_stroke(rig, law, rosin::steady_rod{}, {1.0, 0.1}));
  const auto still =
      rosin::simulate_wave_stroke(rig, law, rosin::steady_rod{.normal_force_N = 0}, {0.3, 0.005}, {.oversampling = 1});
  REQUIRE(still);
  for (const double f : still->force_near_N) CHECK(f == 0);
}

TEST_CASE("a string whose velocity has no bound is reported, not returned") {
  struct pump {
    using scalar = double;
    rosin::contact_force<double> operator()(const rosin::load_line<double>& line) noexcept {
      return {.force_N = 10 * line.free_velocity_m_s / line.mobility_m_Ns + 1};
    }
    void reset() noexcept {}
  };
  CHECK(rosin::simulate_wave_stroke(rig, pump{}, rosin::steady_rod{}, {0.3, 0.1}, {.oversampling = 1})
            .error()
            .find("without bound") != std::string::npos);
}

}  // namespace simulate_wave_stroke
