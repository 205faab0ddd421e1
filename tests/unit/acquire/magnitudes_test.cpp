// SPDX-License-Identifier: MIT
#include <rosin/acquire/magnitudes.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace acquire_magnitudes {

namespace {

/// A rig of instruments' strings: length, tension, fundamental, diameter and density of a plain wire of that mass.
rosin::rig rig_of(double length_m, double tension_N, double fundamental_Hz, double density_kg_m3) {
  rosin::rig r;
  const double c = 2 * length_m * fundamental_Hz;
  r.string.fundamental_Hz = fundamental_Hz, r.string.length_m = length_m, r.string.tension_N = tension_N;
  r.string.impedance_Ns_m = tension_N / c;
  r.string.density_kg_m3 = density_kg_m3, r.string.diameter_m = std::sqrt(tension_N / (c * c) * 4 / 3.14159265 / density_kg_m3);
  rosin::take pluck, bow;
  pluck.name = "p", pluck.kind = rosin::take_kind::pluck, pluck.force_N = 0.5;
  bow.name = "b", bow.kind = rosin::take_kind::bow, bow.normal_force_N = 1, bow.speed_m_s = 0.1;
  r.takes = {pluck, bow};
  return r;
}

rosin::rig violin() { return rig_of(0.325, 78, 659, 7850); }

/// Nothing but what a rig needs.
rosin::rig bare(rosin::rig r) {
  r.string.impedance_Ns_m.reset(), r.string.diameter_m.reset(), r.string.density_kg_m3.reset();
  return r;
}

std::string keys(const rosin::rig& r) {
  std::string out;
  for (const auto& s : rosin::find_magnitude_slips(r)) out += s.key + "=" + rosin::number_text(s.likely) + " ";
  return out;
}

}  // namespace

TEST_CASE("strings of instruments are what they are") {
  struct one {
    double length_m, tension_N, fundamental_Hz, density_kg_m3;
  };
  for (const one& s :
       {one{0.325, 78, 659, 7850}, one{0.33, 45, 196, 1300}, one{0.69, 140, 220, 7850}, one{0.69, 130, 65.4, 9000},
        one{1.06, 300, 41.2, 8500}, one{0.65, 70, 330, 1070}, one{0.65, 110, 110, 8000}, one{0.052, 700, 4186, 7850},
        one{1.9, 1100, 55, 8800}, one{0.12, 50, 1400, 8500}, one{2.5, 60, 30, 7850}, one{0.6, 60, 200, 19300}}) {
    CAPTURE(s.length_m);
    CAPTURE(s.fundamental_Hz);
    CHECK(keys(rig_of(s.length_m, s.tension_N, s.fundamental_Hz, s.density_kg_m3)) == "");
    CHECK(keys(bare(rig_of(s.length_m, s.tension_N, s.fundamental_Hz, s.density_kg_m3))) == "");
  }
}

TEST_CASE("each value off by a power of ten is named with its likely value, where the others contradict it") {
  const auto is_named = [](auto member, const std::string& key, double factor) {
    auto r = violin();
    auto& value = r.string.*member;
    const double right = *value;
    value = right * factor;
    const auto found = rosin::find_magnitude_slips(r);
    CAPTURE(key);
    CAPTURE(factor);
    REQUIRE(found.size() == 1);
    CHECK(found[0].key == key);
    CHECK(found[0].likely == test::approx(right).epsilon(1e-9));
    CHECK(found[0].log_odds > std::log(1000.0));
    CHECK(!found[0].why.empty());
  };
  for (const double factor : {1e-3, 1e-2, 1e-1, 10., 100., 1e3}) {
    is_named(&rosin::string_section::length_m, "string.length_m", factor);
    is_named(&rosin::string_section::tension_N, "string.tension_N", factor);
    is_named(&rosin::string_section::impedance_Ns_m, "string.impedance_Ns_m", factor);
    is_named(&rosin::string_section::density_kg_m3, "string.density_kg_m3", factor);
    is_named(&rosin::string_section::diameter_m, "string.diameter_m", factor);
  }
  auto r = violin();
  r.string.fundamental_Hz = 0.659;
  CHECK(keys(r) == "string.fundamental_Hz=659 ");
}

TEST_CASE("without a wire and an impedance, what strings usually are still tells") {
  auto r = bare(violin());
  r.string.length_m = 325;
  CHECK(keys(r) == "string.length_m=0.325 ");
  r = bare(violin());
  r.string.fundamental_Hz = 0.659;
  CHECK(keys(r) == "string.fundamental_Hz=659 ");
  r = bare(violin());
  r.string.tension_N = 7800;
  CHECK(keys(r) == "string.tension_N=78 ");
  r = bare(violin());
  r.string.length_m = 325, r.string.fundamental_Hz = 0.659;  // each alone would make the other one worse
  const auto both = keys(r);
  CHECK(both.find("string.length_m=0.325 ") != std::string::npos);
  CHECK(both.find("string.fundamental_Hz=659 ") != std::string::npos);
}

TEST_CASE("a modulus in GPa, a speed in mm/s, a normal force in mN") {
  auto r = violin();
  r.string.youngs_modulus_Pa = 210;
  CHECK(keys(r) == "string.youngs_modulus_Pa=2.1e+11 ");
  r = violin();
  r.takes[1].speed_m_s = 100;
  CHECK(keys(r) == "take \"b\".speed_m_s=0.1 ");
  r = violin();
  r.takes[1].normal_force_N = 1000;
  CHECK(keys(r) == "take \"b\".normal_force_N=1 ");
  r = violin();
  r.takes[0].force_N = 500;
  CHECK(keys(r) == "take \"p\".force_N=0.5 ");
}

TEST_CASE("values that disagree by no power of ten are nobody's slip of that kind") {
  auto r = violin();
  *r.string.impedance_Ns_m *= 1.5;
  CHECK(keys(r) == "");
  r = violin();
  *r.string.density_kg_m3 *= 1.4;
  CHECK(keys(r) == "");
}

TEST_CASE("as findings: an error with key, value, likely value and reason") {
  auto r = violin();
  r.string.length_m = 325;
  const auto f = rosin::check_magnitudes(r);
  REQUIRE(f.size() == 1);
  CHECK(f[0].level == rosin::severity::error);
  CHECK(f[0].kind == "power-of-ten");
  CHECK(f[0].what.find("string.length_m is 325, and 0.325 would agree with all the rest: the ") == 0);
}

}  // namespace acquire_magnitudes
