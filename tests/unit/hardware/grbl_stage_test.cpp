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
  std::string says_itself;
  std::atomic<bool> silent{false}, chatter{false};

private:
  void run(const std::stop_token& stop) {
    const auto begin = std::chrono::steady_clock::now();
    std::array<std::uint8_t, 256> bytes{};
    while (!stop.stop_requested()) {
      const auto got = line_.device().read(bytes, std::chrono::milliseconds{2});
      const std::scoped_lock lock{mutex};
      const std::chrono::duration<double> now = std::chrono::steady_clock::now() - begin;
      std::string answer = simulator.receive({reinterpret_cast<const char*>(bytes.data()), got.bytes}, now.count());
      answer = std::exchange(says_itself, {}) + answer;
      if (chatter) answer += "[MSG:still here]\r\n";
      if (!silent && line_.device().write(answer, std::chrono::milliseconds{20})) continue;
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

TEST_CASE("a controller that goes dumb, or talks without answering, is waited for no longer than was said") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link(), std::chrono::milliseconds{400});
  REQUIRE(stage.has_value());
  SUBCASE("dumb") {
    sled.silent = true;
    CHECK(says(reason(stage->start({-0.1, 0.4, 4})), "does not answer: it says nothing"));
  }
  SUBCASE("talks") {
    {
      const std::scoped_lock lock{sled.mutex};
      sled.simulator.settings[22] = 1;
      sled.simulator.home_s = 1e3;
    }
    sled.chatter = true;
    const auto begin = std::chrono::steady_clock::now();
    CHECK(says(reason(stage->home(std::chrono::milliseconds{300})), "is busy (homing): no end of it after 0.300 s"));
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{900});
  }
  SUBCASE("stopped") {
    std::atomic<bool> stop{false};
    { const auto gone = *std::move(stage); }
    auto other = rosin::grbl_stage::open(sled.link(), std::chrono::seconds{60}, &stop);
    REQUIRE(other.has_value());
    sled.silent = true;
    const auto begin = std::chrono::steady_clock::now();
    std::jthread signal{[&] {
      std::this_thread::sleep_for(std::chrono::milliseconds{100});
      stop = true;
    }};
    CHECK(says(reason(other->unlock()), "stopped while waiting"));
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{900});
  }
}

TEST_CASE("what is no controller is told, with what it is, in time, though it never stops talking") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  std::string saying;
  const char* told = "";
  SUBCASE("nothing") { told = "does not answer: it says nothing (is it switched on"; }
  SUBCASE("a receiver of satellites") {
    saying = "$GPGGA,123519,4807.038,N\r\n";
    told = "this is no G-code controller: something else talks ($GPGGA,123519";
  }
  SUBCASE("a digitiser") {
    rosin::packet_encoder<512> encoder{{.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
    const std::array<std::int32_t, 128> samples{};
    saying = std::string(1, '\0');
    for (int i = 0; i < 3; ++i) saying.append(reinterpret_cast<const char*>(encoder.data()), encoder.encode(samples.data(), 64));
    told = "packets of frames come, as from a digitiser";
  }
  std::jthread device{[&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!saying.empty()) (void)pair->device().write(saying, std::chrono::milliseconds{10});
      std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
  }};
  const auto begin = std::chrono::steady_clock::now();
  const auto stage = rosin::grbl_stage::open(*rosin::byte_link::open(pair->path(), 115200), std::chrono::milliseconds{400});
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{1500});
  REQUIRE_FALSE(stage.has_value());
  CHECK(says(stage.error(), told));
}

TEST_CASE("dialects: greetings, work coordinates with and without their offset, inches, reports that nobody asked for") {
  rosin::grbl_simulator kind;
  double end_m = -0.1;
  bool knows_the_end = true;
  SUBCASE("GRBL, reports in work coordinates whose offset is told") {
    kind.reports_work = true;
    kind.offset_mm = -12.5;
  }
  SUBCASE("the same, not told") {
    kind.reports_work = true;
    knows_the_end = false;
  }
  SUBCASE("in inches") {
    kind.reports_work = true;
    kind.offset_mm = -25.4;
    kind.settings[13] = 1;
  }
  SUBCASE("grblHAL, reporting by itself") {
    kind.greeting = "GrblHAL 1.1f ['$' or '$HELP' for help]";
    kind.report_every_s = 0.002;
  }
  SUBCASE("FluidNC") { kind.greeting = "[MSG:INFO: WiFi on]\r\nGrbl 3.6 [FluidNC v3.6.8 (wifi) '$' for help]"; }
  sled_on_a_line sled{kind};
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  if (knows_the_end) CHECK(says(reason(stage->start({-0.41, 0.4, 4})), "outside of -400.000 to 0 mm"));
  REQUIRE(reason(stage->start({-0.1, 0.4, 8})).empty());
  REQUIRE(reason(stage->wait(3)).empty());
  CHECK(stage->status()->position_m == test::approx(end_m).epsilon(2e-4));
  const std::scoped_lock lock{sled.mutex};
  CHECK(sled.simulator.position_m() == test::approx(end_m));
}

TEST_CASE("homing is waited for, however long the silence; a controller that homes already is left in peace") {
  rosin::grbl_simulator with_switch;
  with_switch.settings[22] = 1;
  with_switch.home_s = 0.6;
  sled_on_a_line sled{with_switch};
  auto stage = rosin::grbl_stage::open(sled.link(), std::chrono::milliseconds{300});
  REQUIRE(stage.has_value());
  CHECK(reason(stage->home()).empty());
  CHECK(reason(stage->start({-0.1, 0.4, 8})).empty());
  SUBCASE("moving") {
    { const auto gone = *std::move(stage); }
    const auto other = rosin::grbl_stage::open(sled.link(), std::chrono::milliseconds{100});
    REQUIRE_FALSE(other.has_value());
    CHECK(says(other.error(), "the sled is busy (it moves)"));
    CHECK(rosin::grbl_stage::open(sled.link(), std::chrono::seconds{3}).has_value());
    const std::scoped_lock lock{sled.mutex};
    CHECK(sled.simulator.position_m() == test::approx(-0.1));
  }
}

TEST_CASE("answers that come late or twice, an error that comes alone, a controller that starts anew") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  const auto unasked = [&](const std::string& text) {
    {
      const std::scoped_lock lock{sled.mutex};
      sled.says_itself = text;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds{30});
  };
  unasked("ok\r\nok\r\n");
  CHECK(reason(stage->start({-0.1, 0.4, 40})).empty());
  CHECK(reason(stage->wait(2)).empty());
  unasked("error:20\r\n");
  const auto odd = stage->status();
  REQUIRE_FALSE(odd.has_value());
  CHECK(says(odd.error(), "error:20 (a command that it does not know)"));
  unasked("ok\r\nok\r\n");
  CHECK(says(reason(stage->home()), "$H: error:5 (homing is not enabled)"));
  unasked("\r\nGrbl 1.1h ['$' for help]\r\n");
  CHECK(says(reason(stage->start({-0.1, 0.4, 40})), "started anew in the middle"));
  CHECK(reason(stage->start({-0.1, 0.4, 40})).empty());
  CHECK(reason(stage->wait(2)).empty());
}

TEST_CASE("a stop that may not wait for the sled to come to rest leaves it held") {
  sled_on_a_line sled;
  auto stage = rosin::grbl_stage::open(sled.link());
  REQUIRE(stage.has_value());
  REQUIRE(reason(stage->start({-0.3, 0.4, 0.6})).empty());
  std::this_thread::sleep_for(std::chrono::milliseconds{500});
  CHECK(says(reason(stage->stop(std::chrono::milliseconds{100})), "still slowing down"));
  std::this_thread::sleep_for(std::chrono::milliseconds{700});
  const auto now = stage->status();
  REQUIRE(now.has_value());
  CHECK(now->state == rosin::motion_state::holding);
  CHECK(now->speed_m_s == 0);
  { const auto gone = *std::move(stage); }
  auto again = rosin::grbl_stage::open(sled.link());
  REQUIRE(again.has_value());
  CHECK(again->status()->state == rosin::motion_state::idle);
  CHECK(again->status()->position_m == test::approx(now->position_m));
}
