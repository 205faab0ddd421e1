// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_sections.hpp>

#include <doctest/doctest.h>

#include <support/rig_text.hpp>

TEST_CASE("[string]: each key, its type, range and name") {
  constexpr test::bad_key rows[] = {
      {"fundamental_Hz = 660\n", "", "rig.toml:4: string.fundamental_Hz: is missing"},
      {"length_m = 0.314\n", "", "rig.toml:4: string.length_m: is missing"},
      {"tension_N = 72.5\n", "", "rig.toml:4: string.tension_N: is missing"},
      {"tension_N = 72.5", "tension_N = -3", "rig.toml:6: string.tension_N: must be larger than 0 and at most 1000000, is -3"},
      {"tension_N = 72.5", "tension_N = 0", "rig.toml:6: string.tension_N: must be larger than 0 and at most 1000000, is 0"},
      {"tension_N = 72.5", "tension_N = inf", "rig.toml:6: string.tension_N: must be larger than 0 and at most 1000000, is inf"},
      {"tension_N = 72.5", "tension_N = \"72.5\"", "rig.toml:6: string.tension_N: must be a number"},
      {"length_m = 0.314", "length_m = 314e9",
       "rig.toml:5: string.length_m: must be larger than 0 and at most 1000, is 3.14e+11"},
      {"length_m = 0.314", "lenght_m = 0.314",
       "rig.toml:4: string.length_m: is missing\nrig.toml:5: string.lenght_m: unknown key; did you mean length_m?"},
      {"fundamental_Hz = 660", "fundamental_Hz = nan",
       "rig.toml:7: string.fundamental_Hz: must be larger than 0 and at most 100000, is nan"},
      {"bending_stiffness_Nm2 = 4.7e-5", "bending_stiffness_Nm2 = -1",
       "rig.toml:8: string.bending_stiffness_Nm2: must be at least 0 and at most 1000, is -1"},
      {"quality = 1000", "quality = 0", "rig.toml:10: string.quality: must be at least 1 and at most 10000000, is 0"},
      {"quality = 1000", "loss_internal_s = -1e-9",
       "rig.toml:10: string.loss_internal_s: must be at least 0 and at most 1, is -1e-09"},
      {"quality = 1000", "loss_air_sqrt_Hz = true", "rig.toml:10: string.loss_air_sqrt_Hz: must be a number"},
      {"quality = 1000", "diameter_m = 0.26", "rig.toml:10: string.diameter_m: must be larger than 0 and at most 0.1, is 0.26"},
      {"quality = 1000", "density_kg_m3 = 0", "rig.toml:10: string.density_kg_m3: must be larger than 0 and at most 30000, is 0"},
      {"quality = 1000", "youngs_modulus_Pa = 0",
       "rig.toml:10: string.youngs_modulus_Pa: must be larger than 0 and at most 2e+12, is 0"},
      {"quality = 1000", "tension_tolerance = 2",
       "rig.toml:10: string.tension_tolerance: must be at least 0 and at most 0.9, is 2"},
      {"quality = 1000", "fundamental_tolerance = -0.1",
       "rig.toml:10: string.fundamental_tolerance: must be at least 0 and at most 0.5, is -0.1"},
      {"quality = 1000", "length_tolerance = 1",
       "rig.toml:10: string.length_tolerance: must be at least 0 and at most 0.5, is 1"},
      {"quality = 1000", "bending_stiffness_tolerance = 1",
       "rig.toml:10: string.bending_stiffness_tolerance: must be at least 0 and at most 0.99, is 1"},
      {"quality = 1000", "impedance_tolerance = 1",
       "rig.toml:10: string.impedance_tolerance: must be at least 0 and at most 0.9, is 1"},
      {"impedance_Ns_m = 0.175", "impedance_Ns_m = 0",
       "rig.toml:9: string.impedance_Ns_m: must be larger than 0 and at most 10000, is 0"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("an impedance that contradicts tension, length and fundamental") {
  constexpr test::bad_key rows[] = {
      {"impedance_Ns_m = 0.175", "impedance_Ns_m = 0.19",
       "rig.toml:9: string.impedance_Ns_m: is 0.19, but tension / (2 length fundamental) is 0.17491797; one of the four is "
       "wrong"},
      {"impedance_Ns_m = 0.175", "impedance_Ns_m = 0.178", ""},
      {"impedance_Ns_m = 0.175", "impedance_Ns_m = 0.19\ntension_tolerance = 0.1", ""},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("[torsion]: all three or none") {
  constexpr test::bad_key rows[] = {
      {"speed_ratio = 7.0\n", "", "rig.toml:21: torsion.speed_ratio: is missing"},
      {"impedance_ratio = 3.5\n", "", "rig.toml:21: torsion.impedance_ratio: is missing"},
      {"q = 15\n", "", "rig.toml:21: torsion.q: is missing"},
      {"speed_ratio = 7.0", "speed_ratio = 0", "rig.toml:22: torsion.speed_ratio: must be larger than 0 and at most 100, is 0"},
      {"impedance_ratio = 3.5", "impedance_ratio = -1",
       "rig.toml:23: torsion.impedance_ratio: must be larger than 0 and at most 1000, is -1"},
      {"q = 15", "q = 0.1", "rig.toml:24: torsion.q: must be at least 0.5 and at most 1000000, is 0.1"},
      {"q = 15", "Q = 15", "rig.toml:21: torsion.q: is missing\nrig.toml:24: torsion.Q: unknown key; did you mean q?"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("[model]: names of effects and laws") {
  constexpr test::bad_key rows[] = {
      {"\"bending-stiffness\", \"torsion\"", "\"bending-stifness\"",
       "rig.toml:31: model.physics[0]: unknown effect \"bending-stifness\"; did you mean bending-stiffness?"},
      {"\"bending-stiffness\", \"torsion\"", "\"torsion\", 3",
       "rig.toml:31: model.physics[1]: must be the name of an effect, in quotes"},
      {"[\"bending-stiffness\", \"torsion\"]", "\"torsion\"", "rig.toml:31: model.physics: must be a list of effect names"},
      {"friction = \"velocity-curve\"", "friction = \"thermic\"",
       "rig.toml:32: model.friction: unknown name \"thermic\"; did you mean thermal?"},
      {"friction = \"velocity-curve\"", "friction = 1", "rig.toml:32: model.friction: must be a text in quotes"},
      {"friction = \"velocity-curve\"", "frictions = 1", "rig.toml:32: model.frictions: unknown key; did you mean friction?"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("[friction] and [simulate]") {
  constexpr test::bad_key rows[] = {
      {"constant = 0.35", "constant = -1", "rig.toml:35: friction.constant: must be at least 0 and at most 10, is -1"},
      {"{ coefficient = 0.4, speed_m_s = 0.01 }", "7", "rig.toml:36: friction.terms[0]: must be a table"},
      {"coefficient = 0.4, speed_m_s = 0.01", "coefficient = 0.4", "rig.toml:36: friction.terms[0].speed_m_s: is missing"},
      {"coefficient = 0.45", "coefficient = 0",
       "rig.toml:36: friction.terms[1].coefficient: must be larger than 0 and at most 10, is 0"},
      {"coefficient = 0.45", "coefficient = 0.45, x = 1",
       "rig.toml:36: friction.terms[1].x: unknown key; known here: coefficient, speed_m_s"},
      {"constant = 0.35", "static_coefficient = 0.3\ndynamic_coefficient = 0.5",
       "rig.toml:35: friction.static_coefficient: is smaller than dynamic_coefficient"},
      {"constant = 0.35", "break_away_fraction = 1",
       "rig.toml:35: friction.break_away_fraction: must be larger than 0 and less than 1, is 1"},
      {"constant = 0.35", "contact_radius_m = 1",
       "rig.toml:35: friction.contact_radius_m: must be larger than 0 and at most 0.01, is 1"},
      {"constant = 0.35", "layer_thickness_m = 1",
       "rig.toml:35: friction.layer_thickness_m: must be larger than 0 and at most 0.001, is 1"},
      {"constant = 0.35", "ambient_C = 300", "rig.toml:35: friction.ambient_C: must be at least -50 and at most 100, is 300"},
      {"constant = 0.35", "bristle_stiffness_N_m = 0",
       "rig.toml:35: friction.bristle_stiffness_N_m: must be larger than 0 and at most 1e+09, is 0"},
      {"constant = 0.35", "bristle_damping_Ns_m = -1",
       "rig.toml:35: friction.bristle_damping_Ns_m: must be at least 0 and at most 10000, is -1"},
      {"constant = 0.35", "stribeck_speed_m_s = 0",
       "rig.toml:35: friction.stribeck_speed_m_s: must be larger than 0 and at most 100, is 0"},
      {"constant = 0.35", "viscous_Ns_m = -1", "rig.toml:35: friction.viscous_Ns_m: must be at least 0 and at most 10000, is -1"},
      {"rate_Hz = 128000", "rate_Hz = 10", "rig.toml:39: simulate.rate_Hz: must be at least 1000 and at most 10000000, is 10"},
      {"duration_s = 0.5", "duration_s = 0", "rig.toml:40: simulate.duration_s: must be larger than 0 and at most 3600, is 0"},
      {"bits = 16", "bits = 12", "rig.toml:41: simulate.bits: must be 16, 24, 32, or 0 for float, is 12"},
      {"bits = 16", "bits = 16.0", "rig.toml:41: simulate.bits: must be a whole number"},
      {"noise_N = 3e-4", "noise_N = -1", "rig.toml:42: simulate.noise_N: must be at least 0 and at most 100, is -1"},
      {"seed = 1", "seed = -1", "rig.toml:43: simulate.seed: must be 0 ... 9223372036854775807, is -1"},
      {"seed = 1", "nominal_scatter = 1", "rig.toml:43: simulate.nominal_scatter: must be true or false"},
      {"[contact]", "[files]\nrate_Hz = 0\n[contact]", "rig.toml:19: files.rate_Hz: must be at least 1 and at most 1e+09, is 0"},
      {"[contact]", "[files]\ntime_column = -1\n[contact]", "rig.toml:19: files.time_column: must be 0 ... 1023, is -1"},
      {"[contact]", "[bow]\nwidth_m = 0.01\n[contact]", "rig.toml:18: bow.kind: is missing"},
      {"[contact]", "[bow]\nkind = \"hare\"\n[contact]", "rig.toml:19: bow.kind: unknown name \"hare\"; did you mean hair?"},
      {"[contact]", "[bow]\nkind = \"hair\"\nwidth_m = 10\n[contact]",
       "rig.toml:20: bow.width_m: must be at least 0 and at most 0.1, is 10"},
      {"[contact]", "[bow]\nkind = \"hair\"\ntilt = 2\n[contact]",
       "rig.toml:20: bow.tilt: must be at least 0 and at most 1, is 2"},
      {"[contact]", "[bow]\nkind = \"rod\"\nhair_mass_kg = 0.006\n[contact]",
       "rig.toml:20: bow.hair_mass_kg: belongs to a bow of kind \"hair\""},
      {"seed = 1", "sede = 1", "rig.toml:43: simulate.sede: unknown key; did you mean seed?"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("[bow]: a ribbon of hair; left out, a rigid rod") {
  CHECK_FALSE(rosin::parse_rig(test::rig_text, "rig.toml")->bow);
  const auto r = rosin::parse_rig(test::changed("[contact]",
                                                "[bow]\nkind = \"hair\"\nwidth_m = 0.01\nhair_stiffness_N_m = 1.1e5\n"
                                                "hair_mass_kg = 0.0062\nhair_resistance_Ns_m = 10\ntilt = 0.5\n[contact]"),
                                  "rig.toml");
  CHECK(r.error() == "");
  REQUIRE(r);
  REQUIRE(r->bow);
  CHECK(r->bow->kind == rosin::bow_kind::hair);
  CHECK(r->bow->width_m == 0.01);
  CHECK(r->bow->hair_stiffness_N_m == 1.1e5);
  CHECK(r->bow->hair_mass_kg == 0.0062);
  CHECK(r->bow->hair_resistance_Ns_m == 10.0);
  CHECK(r->bow->tilt == 0.5);
}
