// SPDX-License-Identifier: MIT
#include <rosin/acquire/checks.hpp>

#include <doctest/doctest.h>

#include <support/synthetic_take.hpp>

#include "support/approx.hpp"

namespace acquire_checks {

namespace {

rosin::take_check check(const test::pluck& p) {
  const auto r = test::two_force_rig(p);
  return rosin::check_take(r, r.takes[0], test::pluck_signals(r, p));
}

std::string kinds(const rosin::take_check& c) {
  std::string out;
  for (const auto& f : c.findings) out += f.kind + "(" + f.channel + ":" + name_of(f.level) + ") ";
  return out;
}

}  // namespace

TEST_CASE("sound plucks raise no alarm, wherever they are plucked, soft or hard, in noise") {
  for (const double position : {0.06, 0.2, 0.3333, 0.47, 0.5, 0.7, 0.9})
    for (const double noise : {0.0, 5e-4, 0.01}) {
      test::pluck p;
      p.position = position;
      p.noise_N = noise;
      p.force_N = noise > 1e-3 ? 1.4 : 0.4;
      CAPTURE(position);
      CAPTURE(noise);
      CHECK(kinds(check(p)) == "");
    }
}

TEST_CASE("release, pitch and noise are measured on the way") {
  test::pluck p;
  const auto c = check(p);
  REQUIRE(c.release_s);
  CHECK(*c.release_s == test::approx(p.release_s).epsilon(2e-3));
  REQUIRE(c.pitch_Hz);
  CHECK(*c.pitch_Hz == test::approx(330).epsilon(1e-3));
  REQUIRE(c.channels.size() == 2);
  REQUIRE(c.channels[0].noise_rms);
  CHECK(*c.channels[0].noise_rms == test::approx(4e-4).epsilon(0.08));
}

TEST_CASE("a fundamental that is off by a power of ten is told by the ringing, and nothing else is said") {
  for (const double factor : {1e-3, 1e-2, 0.1, 10.0}) {
    CAPTURE(factor);
    test::pluck p;
    auto r = test::two_force_rig(p);
    const auto x = test::pluck_signals(r, p);
    r.string.fundamental_Hz *= factor;
    const auto c = rosin::check_take(r, r.takes[0], x);
    CHECK(kinds(c) == "power-of-ten(near:error) ");
    REQUIRE(c.pitch_Hz);
    CHECK(*c.pitch_Hz == test::approx(330).epsilon(1e-2));
  }
}

TEST_CASE("a scale or a force that is off by a power of ten: the value that would agree is said") {
  test::pluck p;
  auto r = test::two_force_rig(p);
  const auto x = test::pluck_signals(r, p);
  const double right = *r.takes[0].force_N;
  for (const double factor : {0.01, 0.1, 10.0}) {
    CAPTURE(factor);
    r.takes[0].force_N = factor * right;
    const auto c = rosin::check_take(r, r.takes[0], x);
    REQUIRE(!c.findings.empty());
    CHECK(c.findings[0].what.find(": off by a power of ten; force_N = " + rosin::detail::figure(right)) != std::string::npos);
  }
}

TEST_CASE("swapped channels, DC and AC coupled") {
  for (const double position : {0.1, 0.3, 0.42, 0.8}) {
    CAPTURE(position);
    test::pluck p;
    p.position = position;
    const auto r = test::two_force_rig(p);
    auto x = test::pluck_forces(p);
    std::swap(x[0], x[1]);
    CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == "swapped-channels(:error) ");
    for (auto& channel : x) test::high_pass(channel, 0.5, p.rate_Hz);
    CHECK(rosin::check_take(r, r.takes[0], test::signals(r, p, x)).found("swapped-channels"));
  }
}

TEST_CASE("a take that begins after the release is recognised before anything is said of polarity, order, gains or place") {
  for (const double position : {0.1, 0.2, 0.35, 0.5, 0.8})
    for (const int late : {3, 10, 20, 31, 50, 64, 80, 100, 120, 139, 290, 2000})  // a period is 145 samples
      for (const int turned : {0, 1, 2}) {
        CAPTURE(position);
        CAPTURE(late);
        CAPTURE(turned);
        test::pluck p;
        p.position = position;
        const auto r = test::two_force_rig(p);
        auto x = test::pluck_forces(p);
        for (auto& channel : x)
          channel.erase(channel.begin(), channel.begin() + late + static_cast<int>(p.release_s * p.rate_Hz));
        if (turned == 1)
          for (auto& channel : x)
            for (double& v : channel) v = -v;
        if (turned == 2) std::swap(x[0], x[1]);
        const auto c = rosin::check_take(r, r.takes[0], test::signals(r, p, x));
        CHECK((c.found("begins-late") || c.found("short-lead")));
        for (const char* kind :
             {"inverted-channel", "swapped-channels", "wrong-position", "wrong-scale", "undeclared-ac-coupling"})
          CHECK_FALSE(c.found(kind));
        CHECK(c.pitch_Hz);
      }
}

TEST_CASE("less than a period before the release is said; a fraction of it is too little") {
  for (const auto& c :
       {std::pair{5, "begins-late(:error) "}, {20, "begins-late(:error) "}, {90, "short-lead(:warning) "}, {160, ""}}) {
    const int lead = c.first;
    CAPTURE(lead);
    test::pluck p;
    const auto r = test::two_force_rig(p);
    auto x = test::pluck_forces(p);
    for (auto& channel : x) channel.erase(channel.begin(), channel.begin() + static_cast<int>(p.release_s * p.rate_Hz) - lead);
    CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == c.second);
  }
}

TEST_CASE("inverted channels are named, one or both") {
  test::pluck p;
  p.far_gain = -1;
  CHECK(kinds(check(p)) == "inverted-channel(far:error) ");
  p.near_gain = -1;
  CHECK(kinds(check(p)) == "inverted-channel(near:error) inverted-channel(far:error) ");
}

TEST_CASE("a wrong sample rate shows in the pitch") {
  test::pluck p;
  for (const double header : {44100.0, 96000.0, 24000.0}) {
    CAPTURE(header);
    p.rate_in_header_Hz = header;
    const auto c = check(p);
    REQUIRE(c.found("wrong-pitch"));
    CHECK(rosin::has_error(c.findings));
  }
  p.rate_in_header_Hz = 48000;  // no converter's rate: something heavy on the string, perhaps
  auto r = test::two_force_rig(p);
  r.string.fundamental_Hz *= 1.1;
  const auto low = rosin::check_take(r, r.takes[0], test::pluck_signals(r, p));
  CHECK(low.found("wrong-pitch"));
  CHECK_FALSE(rosin::has_error(low.findings));
  p.rate_in_header_Hz = 48000 * 1.004;  // within what a tuning may be off
  CHECK(kinds(check(p)) == "");
}

TEST_CASE("an octave at one end is a doubt, at both another string") {
  constexpr std::size_t half = 73;  // of a period, in samples
  test::pluck p;
  p.fundamental_Hz = p.rate_Hz / (2 * half), p.inharmonicity = 0;
  const auto r = test::two_force_rig(p);
  auto x = test::pluck_forces(p);
  const auto ringing = static_cast<std::size_t>(p.release_s * p.rate_Hz) + 4 * half;
  for (const bool both : {false, true}) {
    for (std::size_t i = ringing; i + half < x[0].size(); ++i)
      x[both ? 0 : 1][i] = 0.5 * (x[both ? 0 : 1][i] + x[both ? 0 : 1][i + half]);  // odd partials go
    const auto c = rosin::check_take(r, r.takes[0], test::signals(r, p, x));
    CHECK(c.found("wrong-pitch"));
    CHECK(rosin::has_error(c.findings) == both);
  }
}

TEST_CASE("a pluck that is damped or missing") {
  test::pluck p;
  p.quality = 8;
  CHECK(check(p).found("does-not-ring"));
  test::pluck none;
  none.release_s = 10;
  CHECK(check(none).found("no-release"));
  CHECK(rosin::has_error(check(none).findings));
}

TEST_CASE("a wire that breaks at the very end") {
  test::pluck p;
  const auto whole = test::pluck_forces(p);
  p.release_s = static_cast<double>(whole[0].size()) / p.rate_Hz - 0.003;
  const auto late = check(p);
  CHECK(late.found("short-ringing"));
  CHECK_FALSE(rosin::has_error(late.findings));
}

TEST_CASE("a wrong position, and sensors that do not pass the level, are warnings") {
  test::pluck p;
  auto r = test::two_force_rig(p);
  r.contact_position = 0.4;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::pluck_signals(r, p))) == "wrong-position(:warning) ");
  r.contact_position = 0.3;
  auto x = test::pluck_forces(p);
  for (auto& channel : x) test::high_pass(channel, 0.5, p.rate_Hz);
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) ==
        "undeclared-ac-coupling(near:warning) undeclared-ac-coupling(far:warning) ");
  for (auto& c : r.channels) c.ac_coupled_Hz = 0.5;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == "");
}

TEST_CASE("hum and an offset under a pluck") {
  test::pluck p;
  const auto r = test::two_force_rig(p);
  auto x = test::pluck_forces(p);
  for (std::size_t i = 0; i < x[0].size(); ++i)
    x[0][i] += 0.02 * std::sin(6.283185307179586 * 50 * static_cast<double>(i) / p.rate_Hz);
  const auto hum = rosin::check_take(r, r.takes[0], test::signals(r, p, x));
  CHECK(kinds(hum) == "hum(near:warning) ");
  CHECK(hum.channels[0].hum->amplitude == test::approx(0.02).epsilon(0.03));
  auto y = test::pluck_forces(p);
  for (double& v : y[1]) v += 0.1;
  CHECK(rosin::check_take(r, r.takes[0], test::signals(r, p, y)).found("offset"));
}

TEST_CASE("clipped, frozen, silent") {
  test::pluck p;
  p.force_N = 3;  // beyond full scale
  CHECK(check(p).found("clipping"));
  test::pluck silent;
  silent.near_gain = 0;
  silent.noise_N = 0;
  CHECK(kinds(check(silent)) == "silence(near:error) ");
}

TEST_CASE("a bow take whose ends pull in opposite directions") {
  test::pluck p;
  auto r = test::two_force_rig(p);
  r.takes[0].kind = rosin::take_kind::bow;
  r.takes[0].normal_force_N = 0.3;
  auto x = test::pluck_forces(p);
  for (double& v : x[0]) v += 0.2;
  for (double& v : x[1]) v += 0.1;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == "");
  auto inverted = x;
  for (double& v : inverted[1]) v = -v;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, inverted))) == "inverted-channel(far:error) ");
  for (double& v : inverted[0]) v = -v;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, inverted))) == "bowed-backwards(:warning) ");
}

TEST_CASE("a single pickup is checked for what it can tell") {
  test::pluck p;
  auto r = test::two_force_rig(p);
  r.channels.resize(1);
  r.channels[0].name = "pickup";
  r.channels[0].quantity = rosin::quantity::string_velocity;
  r.channels[0].per_full_scale.reset();
  auto x = test::pluck_forces(p);
  x.resize(1);
  for (std::size_t i = 0; i < 960; ++i) x[0][i] = 0;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == "");
  p.rate_in_header_Hz = 44100;
  CHECK(kinds(rosin::check_take(r, r.takes[0], test::signals(r, p, x))) == "wrong-pitch(pickup:warning) ");
}

TEST_CASE("a quiet take gives the noise") {
  test::pluck p;
  p.force_N = 0;
  auto r = test::two_force_rig(p);
  r.takes[0].kind = rosin::take_kind::quiet;
  const auto c = rosin::check_take(r, r.takes[0], test::pluck_signals(r, p));
  CHECK(kinds(c) == "");
  CHECK(*c.channels[1].noise_rms == test::approx(4e-4).epsilon(0.03));
}

}  // namespace acquire_checks
