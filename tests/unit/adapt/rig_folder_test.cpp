// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_folder.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace {

constexpr std::string_view text = R"(schema = 1
[string]
length_m = 0.314
tension_N = 72.5
fundamental_Hz = 660
[channels]
near = { index = 0, newtons_per_full_scale = 2 }
far = { index = 1, newtons_per_full_scale = 4 }
[contact]
position = 0.3
[[take]]
name = "a"
kind = "pluck"
force_N = 1
file = "a.wav"
[[take]]
name = "b"
kind = "quiet"
file = "b.wav"
)";

struct rig_on_disk {
  test::temporary_folder folder;
  rig_on_disk() {
    folder.write("rig.toml", text);
    write("a.wav", 2);
    write("b.wav", 2);
  }
  void write(const std::string& name, std::size_t channels, double rate = 48000) const {
    rosin::recording r;
    r.sample_rate_Hz = rate;
    r.channels.assign(channels, {0.25, -0.5, 0.125});
    REQUIRE_FALSE(rosin::write_audio(folder / name, r, rosin::overwrite::allow));
  }
  [[nodiscard]] std::string problems() const {
    std::string said = rosin::open_rig_folder(folder.str()).error();
    for (auto at = said.find(folder.str() + "/"); at != std::string::npos; at = said.find(folder.str() + "/"))
      said.erase(at, folder.str().size() + 1);
    return said;
  }
};

}  // namespace

TEST_CASE("a sound folder opens, and its takes are in newtons") {
  const rig_on_disk rig;
  const auto open = rosin::open_rig_folder(rig.folder.str());
  CHECK(open.error() == "");
  REQUIRE(open);
  CHECK(open->notes.empty());
  REQUIRE(open->formats.size() == 2);
  CHECK(open->formats[0].frames == 3);
  const auto take = rosin::load_take(open->rig, open->rig.takes[0]);
  REQUIRE(take);
  CHECK(take->near_N() == std::vector<double>{0.5, -1, 0.25});
  CHECK(take->far_N() == std::vector<double>{1, -2, 0.5});
}

TEST_CASE("recordings of another channel count, too slow, missing or cut: all of it at once, with lines") {
  const rig_on_disk rig;
  rig.write("a.wav", 1);
  CHECK(rig.problems() ==
        "rig.toml:11: take \"a\".file: a.wav: has 1 channel(s), but channels.far.index is 1\n"
        "rig.toml:16: take \"b\".file: b.wav: has 2 channel(s), the first take has 1");
  rig.write("a.wav", 3);
  CHECK(rig.problems() == "rig.toml:16: take \"b\".file: b.wav: has 2 channel(s), the first take has 3");
  rig.write("a.wav", 2, 1000);
  CHECK(rig.problems() == "rig.toml:11: take \"a\".file: a.wav: a sample rate of 1000 Hz cannot hold the fundamental of 660 Hz");
  rig.folder.write("a.wav", "junk");
  rig.folder.write("b.wav", rig.folder.read("b.wav").substr(0, 50));
  const std::string both = rig.problems();
  CHECK(both.starts_with("rig.toml:11: take \"a\".file: a.wav: "));
  CHECK(both.find("\nrig.toml:16: take \"b\".file: b.wav: truncated: ") != std::string::npos);
}

TEST_CASE("channels that nobody named and files that occur twice are worth a note") {
  const rig_on_disk rig;
  rig.write("a.wav", 3);
  rig.write("b.wav", 3);
  auto open = rosin::open_rig_folder(rig.folder.str());
  REQUIRE(open);
  REQUIRE(open->notes.size() == 1);
  CHECK(open->notes[0] == "channel 2 of the recordings is not named in [channels]: it is not used");
  std::string twice{text};
  twice.replace(twice.find("b.wav"), 5, "a.wav");
  rig.folder.write("rig.toml", twice);
  open = rosin::open_rig_folder(rig.folder.str());
  REQUIRE(open);
  CHECK(open->notes.back() == "takes a and b are the same file a.wav");
}

TEST_CASE("a recording whose header does not tell its length is read to its end, and that is worth a note") {
  const rig_on_disk rig;
  std::string bytes = rig.folder.read("a.wav");
  bytes.replace(bytes.find("data") + 4, 4, 4, '\xff');
  rig.folder.write("a.wav", bytes);
  const auto open = rosin::open_rig_folder(rig.folder.str());
  REQUIRE(open);
  REQUIRE(open->notes.size() == 1);
  CHECK(open->notes[0].find("a.wav: its header does not tell how long it is") != std::string::npos);
  CHECK(rosin::load_take(open->rig, open->rig.takes[0])->frames() == 3);
}

TEST_CASE("a take that was changed after the folder was opened") {
  const rig_on_disk rig;
  const auto open = rosin::open_rig_folder(rig.folder.str());
  REQUIRE(open);
  rig.folder.write("a.wav", "junk");
  const auto take = rosin::load_take(open->rig, open->rig.takes[0]);
  REQUIRE_FALSE(take);
  CHECK(take.error().find("rig.toml:11: take \"a\".file: ") != std::string::npos);
}

TEST_CASE("takes in tables: by index, by name, with a column of times; only the beginning is read to open them") {
  constexpr std::string_view tables = R"(schema = 1
[string]
length_m = 0.7
tension_N = 145
fundamental_Hz = 98
[channels]
near = { column = "near, N" }
far = { index = 2, newtons_per_full_scale = 10 }
[files]
time_column = 0
[[take]]
name = "whole_1"
kind = "bow"
file = "whole_1.csv"
contact_position = 0.1
speed_m_s = 0.1
normal_force_N = 1
)";
  const test::temporary_folder folder;
  folder.write("rig.toml", tables);
  std::string text = "t;near, N;far\n";
  for (int i = 0; i < 3000; ++i) text += std::to_string(i) + "e-3;" + std::to_string(i % 7) + ";" + std::to_string(i % 5) + "\n";
  folder.write("whole_1.csv", text);
  auto open = rosin::open_rig_folder(folder.str());
  CHECK(open.error() == "");
  REQUIRE(open);
  CHECK(open->notes.empty());
  CHECK(open->formats[0].sample_rate_Hz == 1000);
  const auto take = rosin::load_take(open->rig, open->rig.takes[0]);
  CHECK(take.error() == "");
  REQUIRE(take);
  CHECK(take->near_N()[6] == 6);
  CHECK(take->far_N()[4] == 40);
  CHECK(take->float_format);
  folder.write("whole_1.csv", text + "3000e-3;1\n");
  CHECK(rosin::open_rig_folder(folder.str()));
  CHECK(rosin::load_take(open->rig, open->rig.takes[0]).error().find("whole_1.csv:3002: has 2 column(s), the first line has 3") !=
        std::string::npos);
  folder.write("whole_1.csv", "t,x,far\n0,1,2\n1e-3,1,2\n2e-3,1,2\n");
  CHECK(rosin::open_rig_folder(folder.str()).error().find("has the columns t, x, far, but channels.near.column is \"near, N\"") !=
        std::string::npos);
}
