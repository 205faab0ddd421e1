// SPDX-License-Identifier: MIT
#include <rosin/hardware/grbl_stage.hpp>

#include <doctest/doctest.h>

#include <rosin/hardware/grbl_simulator.hpp>
#include <rosin/hardware/pseudo_terminal.hpp>

#include <atomic>
#include <mutex>
#include <thread>

#include "support/approx.hpp"

namespace {

/// The simulated controller behind a pseudo-terminal, in its own thread.
class sled_on_a_line {
public:
  explicit sled_on_a_line(rosin::grbl_simulator sled = {})
      : simulator{std::move(sled)}, line_{*rosin::pseudo_terminal::open()}, thread_{[this](const std::stop_token& stop) {
          run(stop);
        }} {}
  rosin::byte_link link() const { return *rosin::byte_link::open(line_.path(), 115200); }

  std::mutex mutex;
  rosin::grbl_simulator simulator;
  std::atomic<bool> silent{false};

private:
  void run(const std::stop_token& stop) {
    const auto begin = std::chrono::steady_clock::now();
    std::array<std::uint8_t, 256> bytes{};
    while (!stop.stop_requested()) {
      const auto got = line_.device().read(bytes, std::chrono::milliseconds{2});
      const std::scoped_lock lock{mutex};
      const std::chrono::duration<double> now = std::chrono::steady_clock::now() - begin;
      const auto answer = simulator.receive({reinterpret_cast<const char*>(bytes.data()), got.bytes}, now.count());
      if (!silent && line_.device().write(answer)) return;
    }
  }
  rosin::pseudo_terminal line_;
  std::jthread thread_;
};

std::string reason(const std::optional<rosin::failure>& why) { return why ? why->message : ""; }
bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("a stroke: speed, acceleration and distance arrive as asked") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  CHECK(stage->setting(130) == 400);
  CHECK(reason(stage->start({-0.1, 0.4, 4})).empty());
  double fastest = 0;
  for (int i = 0; i < 200; ++i) {
    const auto now = stage->status();
    REQUIRE(now.has_value());
    fastest = std::max(fastest, now->speed_m_s);
    if (now->state == rosin::motion_state::idle) break;
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  CHECK(fastest == test::approx(0.4).epsilon(0.01));
  CHECK(reason(stage->wait(2)).empty());
  CHECK(stage->status()->position_m == test::approx(-0.1));
  CHECK(stage->setting(120) == 4000);
  const std::scoped_lock lock{sled.mutex};
  CHECK(sled.simulator.settings.at(120) == 4000);
  CHECK(sled.simulator.strokes() == 1);
}

TEST_CASE("what the sled cannot do as asked is refused before it moves") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  CHECK(says(reason(stage->start({-0.1, 1.5, 40})), "beyond the sled's 60000.000 mm/min"));
  CHECK(says(reason(stage->start({-0.01, 0.4, 4})), "never reaches"));
  CHECK(says(reason(stage->start({-0.41, 0.4, 4})), "outside of -400.000 to 0 mm"));
  CHECK(says(reason(stage->start({0.1, 0.4, 4})), "outside"));
  CHECK(says(reason(stage->start({0.0, 0.4, 4})), "needs a distance"));
  CHECK(says(reason(stage->start({0.1, 0.4, 0})), "needs a distance"));
  CHECK(sled.simulator.strokes() == 0);
}

TEST_CASE("feed hold and going on; stopping for good keeps the position") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  REQUIRE(reason(stage->start({-0.2, 0.4, 8})).empty());
  CHECK(says(reason(stage->start({-0.1, 0.4, 8})), "not ready"));
  std::this_thread::sleep_for(std::chrono::milliseconds{120});
  REQUIRE(reason(stage->hold()).empty());
  std::this_thread::sleep_for(std::chrono::milliseconds{120});
  CHECK(stage->status()->state == rosin::motion_state::holding);
  CHECK(stage->status()->speed_m_s == 0);
  REQUIRE(reason(stage->resume()).empty());
  CHECK(stage->status()->state == rosin::motion_state::running);
  REQUIRE(reason(stage->wait(2)).empty());
  CHECK(stage->status()->position_m == test::approx(-0.2));
  REQUIRE(reason(stage->start({-0.2, 0.4, 8})).empty());
  std::this_thread::sleep_for(std::chrono::milliseconds{120});
  REQUIRE(reason(stage->stop()).empty());
  const auto after = stage->status();
  CHECK(after->state == rosin::motion_state::idle);
  CHECK(after->position_m < -0.21);
  CHECK(after->position_m > -0.39);
  CHECK(reason(stage->start({0.05, 0.2, 8})).empty());
}

TEST_CASE("a limit switch: the alarm is told with its reason, and unlocking is a decision") {
  rosin::grbl_simulator with_switch;
  with_switch.settings[20] = 0;
  with_switch.switch_mm = 20;
  sled_on_a_line sled{with_switch};
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  REQUIRE(reason(stage->start({0.1, 0.4, 8})).empty());
  CHECK(says(reason(stage->wait(2)), "ALARM:1 (hard limit"));
  CHECK(says(reason(stage->start({-0.05, 0.4, 8})), "not ready: ALARM:1"));
  REQUIRE(reason(stage->unlock()).empty());
  CHECK(reason(stage->start({-0.05, 0.4, 8})).empty());
}

TEST_CASE("a controller that is dumb, or is none, or goes away") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link(), std::chrono::milliseconds{200});
  REQUIRE(stage.has_value());
  sled.silent = true;
  CHECK(says(reason(stage->start({-0.1, 0.4, 4})), "does not answer"));
  const auto other = rosin::grbl_stage::open(sled.link(), std::chrono::milliseconds{100});
  REQUIRE_FALSE(other.has_value());
  CHECK(says(other.error(), "does not answer"));
}
