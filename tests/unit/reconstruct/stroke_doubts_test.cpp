// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/stroke_doubts.hpp>

#include <doctest/doctest.h>

namespace reconstruct_stroke_doubts {

namespace {

/// Helmholtz motion as in a book: it sticks for four fifths of a period, slips for one.
struct stroke {
  std::vector<double> force_N, velocity_m_s, rod_m_s;
  rosin::stroke_view view;

  explicit stroke(double rod = 0.1, double normal_N = 1) {
    for (std::size_t i = 0; i < 20000; ++i) {
      const bool slips = i % 200 >= 160;
      velocity_m_s.push_back(slips ? -0.4 : 0.1);
      force_N.push_back(slips ? 0.4 : 0.4 + 0.4 * static_cast<double>(i % 200) / 160);
      rod_m_s.push_back(rod);
    }
    view.normal_force_N = normal_N, view.period_samples = 200, view.slips = 100;
  }
  [[nodiscard]] std::string kinds() {
    view.force_N = force_N, view.velocity_m_s = velocity_m_s, view.rod_m_s = rod_m_s;
    std::string out;
    for (const auto& d : rosin::doubts_of_stroke(view)) out += d.kind + " ";
    return out;
  }
  [[nodiscard]] bool says(const std::string& text) {
    (void)kinds();
    for (const auto& d : rosin::doubts_of_stroke(view))
      if (d.what.find(text) != std::string::npos) return true;
    return false;
  }
};

}  // namespace

TEST_CASE("a stroke as it should be raises no doubt") {
  CHECK(stroke{}.kinds() == "");
  CHECK(stroke{0.1, 0.7}.kinds() == "");
  CHECK(stroke{0.1, 3}.kinds() == "");
}

TEST_CASE("a rod whose speed is in other units") {
  stroke fast{100};
  fast.view.slips = 0;
  CHECK(fast.kinds() == "speed-contradicts no-slip ");
  CHECK(fast.says("with a speed = 0.1 it would be 1"));
  stroke slow{0.01};
  CHECK(slow.kinds() == "speed-contradicts ");
  CHECK(slow.says("with a speed = 0.1 it would be 1"));
}

TEST_CASE("a string that follows the rod all the time, and one that never does") {
  stroke s;
  s.velocity_m_s.assign(s.velocity_m_s.size(), 0.1), s.view.slips = 0;
  CHECK(s.kinds() == "no-slip ");
  CHECK(s.says("follows the rod"));
  s.velocity_m_s.assign(s.velocity_m_s.size(), 0.0);
  CHECK(s.kinds() == "speed-contradicts no-slip ");
}

TEST_CASE("friction above what the normal force allows, or next to none") {
  stroke s{0.1, 0.08};
  CHECK(s.kinds() == "force-contradicts ");
  CHECK(s.says("with a normal force = 0.8 it would be "));
  stroke weak{0.1, 1000};
  CHECK(weak.kinds() == "force-contradicts ");
  CHECK(weak.says("with a normal force = 1 it would be "));
  stroke coupled{0.1, 0.1};
  coupled.view.level_known = false;
  for (double& f : coupled.force_N) f -= 0.5;
  CHECK(coupled.kinds() == "force-contradicts ");
}

TEST_CASE("a level that drifts, unless the normal force is known to change") {
  stroke s;
  for (std::size_t i = 0; i < s.force_N.size(); ++i) s.force_N[i] += 0.4 * static_cast<double>(i) / 20000.0;
  CHECK(s.kinds() == "drifting-level ");
  s.view.normal_steady = false;
  CHECK(s.kinds() == "");
}

}  // namespace reconstruct_stroke_doubts
