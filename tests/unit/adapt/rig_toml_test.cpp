// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_toml.hpp>

#include <doctest/doctest.h>

#include <support/rig_text.hpp>
#include <support/temporary_folder.hpp>

TEST_CASE("everything in the file arrives where it belongs") {
  const auto r = rosin::parse_rig(test::rig_text, "runs/12/rig.toml");
  CHECK(r.error() == "");
  REQUIRE(r);
  CHECK(r->folder == "runs/12");
  CHECK(r->title == "E string, glass rod, run 12");
  CHECK(r->string.fundamental_Hz == 660);
  CHECK(r->string.impedance_Ns_m == 0.175);
  CHECK(r->string.quality == 1000.0);
  CHECK_FALSE(r->string.diameter_m);
  REQUIRE(r->channels.size() == 4);
  CHECK(r->channel("near")->per_full_scale == 1.65);
  CHECK(r->channel("far")->ac_coupled_Hz == 0.5);
  CHECK_FALSE(r->channel("far")->gain_tolerance);
  CHECK(r->channel("magnet")->quantity == rosin::quantity::string_velocity);
  CHECK(r->channel("magnet")->position == 0.3);
  CHECK(r->channel("sled")->index == 4);
  CHECK(r->contact_position == 0.3);
  CHECK(r->torsion->impedance_ratio == 3.5);
  CHECK(r->near->kind == rosin::termination::form::fit);
  REQUIRE(r->far->modes.size() == 1);
  CHECK(r->far->modes[0].mass_kg == 0.12);
  CHECK(r->model->physics == std::vector<std::string>{"bending-stiffness", "torsion"});
  CHECK(r->model->friction == rosin::friction_model::velocity_curve);
  CHECK(r->friction->terms.at(1).coefficient == 0.45);
  CHECK(r->friction->constant == 0.35);
  CHECK(r->simulate->bits == 16);
  CHECK(r->simulate->seed == 1);
  CHECK_FALSE(r->simulate->nominal_scatter);
  const auto scattered = rosin::parse_rig(test::changed("seed = 1", "nominal_scatter = true"), "rig.toml");
  REQUIRE(scattered);
  CHECK(scattered->simulate->nominal_scatter);
  REQUIRE(r->takes.size() == 3);
  CHECK(r->takes[0].kind == rosin::take_kind::pluck);
  CHECK(r->takes[0].force_N == 1.0);
  CHECK(r->takes[0].line == 45);
  CHECK(r->position_of(r->takes[0]) == 0.25);
  CHECK(r->takes[1].kind == rosin::take_kind::quiet);
  CHECK(r->takes[2].speed_m_s == 0.2);
  CHECK(r->takes[2].speed_profile_m_s == rosin::profile{{0, 0}, {0.02, 0.2}});
  CHECK(r->takes[2].hold_out);
}

TEST_CASE("the root: schema, title, tables") {
  constexpr test::bad_key rows[] = {
      {"schema = 1\n", "", "rig.toml:1: schema: is missing"},
      {"schema = 1", "schema = 2", "rig.toml:1: schema: is 2; this version reads schema 1"},
      {"schema = 1", "schema = \"1\"", "rig.toml:1: schema: must be a whole number"},
      {"title = \"E string, glass rod, run 12\"", "title = 12", "rig.toml:2: title: must be a text in quotes"},
      {"title = ", "titel = ", "rig.toml:2: titel: unknown key; did you mean title?"},
      {"[contact]\nposition = 0.30", "[contact]\nposition = 0.0",
       "rig.toml:19: contact.position: must be larger than 0 and less than 1, is 0"},
      {"[contact]\nposition = 0.30\n", "[contact]\n", "rig.toml:18: contact.position: is missing"},
      {"[contact]\nposition = 0.30", "[contact]\nposition = 0.3\nposition_tolerance = 1",
       "rig.toml:20: contact.position_tolerance: must be at least 0 and at most 0.5, is 1"},
      {"[torsion]", "[torison]", "rig.toml:21: torison: unknown key; did you mean torsion?"},
      {"[torsion]\nspeed_ratio = 7.0\nimpedance_ratio = 3.5\nq = 15", "", ""},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("missing tables") {
  const std::string take = "[[take]]\nname = 'a'\nkind = 'quiet'\nfile = 'a.wav'\n";
  CHECK(test::problems_of("schema = 1\n" + take) == "rig.toml:1: string: is missing\nrig.toml:1: channels: is missing");
  CHECK(test::problems_of("schema = 1\nstring = 5\nchannels = {}\n" + take) ==
        "rig.toml:2: string: must be a table\nrig.toml:3: channels: names no channel");
}

TEST_CASE("all problems at once, in the order of the file") {
  std::string text = test::changed("tension_N = 72.5", "tension_N = -1");
  text = test::changed("speed_ratio = 7.0\n", "", text);
  text = test::changed("force_N = 1.0", "force = 1.0", text);
  CHECK(test::problems_of(text) ==
        "rig.toml:6: string.tension_N: must be larger than 0 and at most 1000000, is -1\n"
        "rig.toml:21: torsion.speed_ratio: is missing\n"
        "rig.toml:44: take[0].force_N: is missing\n"
        "rig.toml:48: take[0].force: unknown key; did you mean force_N?");
}

TEST_CASE("what is not TOML is named with its line") {
  CHECK(test::problems_of("schema = \n").starts_with("rig.toml:1: "));
  CHECK(test::problems_of("schema = 1\nschema = 1\n").starts_with("rig.toml:2: "));
  CHECK(test::problems_of("a = \"\xff\"").starts_with("rig.toml:1: "));
  const std::string zeros{"schema = 1\n[\0\0 'x']]\n", 19};
  CHECK(test::problems_of(zeros) == "rig.toml:2: holds a control character, so it is no TOML");
  CHECK(test::problems_of("").find("schema: is missing") != std::string::npos);
}

TEST_CASE("a rig without force transducers needs little: a fundamental, a channel, a take") {
  const auto r = rosin::parse_rig(
      "schema = 1\n[string]\nfundamental_Hz = 196\n[channels]\npickup = { index = 0, quantity = 'string-velocity' }\n"
      "[[take]]\nname = 'g'\nkind = 'pluck'\nfile = 'g.flac'\nposition_unknown = true\nstrength = 3\n",
      "rig.toml");
  CHECK(r.error() == "");
  REQUIRE(r);
  CHECK_FALSE(r->has_both_forces());
  CHECK(r->takes[0].strength == 3.0);
  CHECK_FALSE(r->position_of(r->takes[0]));
}

TEST_CASE("load_rig: folder or file, and the recordings have to be there") {
  const test::temporary_folder folder;
  CHECK(rosin::load_rig(folder.str()).error() == folder / "rig.toml" + ": cannot be read: No such file or directory");
  folder.write("rig.toml", test::rig_text);
  folder.write("quiet.wav", "x");
  const std::string missing = rosin::load_rig(folder.str()).error();
  CHECK(missing == folder / "rig.toml" + ":45: take \"pluck-1\".file: " + (folder / "pluck-1.wav") + ": no such file\n" +
                       (folder / "rig.toml") + ":58: take \"bow-1\".file: " + (folder / "bow-1.wav") + ": no such file");
  CHECK(rosin::load_rig(folder.str(), rosin::take_files::to_be_made));
  folder.write("pluck-1.wav", "x");
  folder.write("bow-1.wav", "x");
  CHECK(rosin::load_rig(folder / "rig.toml"));
}

TEST_CASE("an admittance from a file") {
  const test::temporary_folder folder;
  folder.write("rig.toml", test::changed("near = \"fit\"", "near = \"bridge.csv\""));
  const auto load = [&] { return rosin::load_rig(folder.str(), rosin::take_files::to_be_made); };
  const auto with = [&](std::string_view text) {
    folder.write("bridge.csv", text);
    const std::string said = load().error();
    const auto at = said.find("bridge.csv: ");
    return at == std::string::npos ? said : said.substr(at, said.find(" (neither") - at);
  };
  CHECK(load().error().find(":27: terminations.near: ") != std::string::npos);
  CHECK(load().error().find("bridge.csv: cannot be read") != std::string::npos);
  CHECK(with("frequency_Hz,admittance_re\n1,2\n") ==
        "bridge.csv: must have the columns frequency_Hz, admittance_re, admittance_im");
  const std::string head = "frequency_Hz,admittance_re,admittance_im\n";
  CHECK(with(head + "100,0.01,0\n") == "bridge.csv: needs at least two rows");
  CHECK(with(head + "100,0.01,0\n100,0.01,0\n") == "bridge.csv: row 2: frequency_Hz must ascend and not be negative");
  CHECK(with(head + "100,0.01,0\n200,-0.01,0\n") == "");  // noise: what is made of it, termination_table.hpp decides
  CHECK(with(head + "100,0.01,0\n200,,0\n") == "bridge.csv: row 2: must hold three numbers");
  CHECK(with(head + "100,0.01,0\n200,0.02,-0.5\n") == "");
  const auto r = load();
  REQUIRE(r);
  CHECK(r->near->kind == rosin::termination::form::table);
  CHECK(r->near->admittance.at(1).im_m_sN == -0.5);
}
