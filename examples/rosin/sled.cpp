// SPDX-License-Identifier: MIT
#include "sled.hpp"

#include "digits.hpp"
#include "recorder.hpp"

#include <cmath>

namespace tool {

struct sled::shared {
  shared(rosin::grbl_stage s, rosin::stroke w, double rest) : stage{std::move(s)}, way{w}, rest_s{rest} {}

  void run(const std::stop_token& stop) {
    if (const auto bad = stage.start(way)) return end_held(bad->message);
    while (!stop.stop_requested() && !stopped()) {
      const auto now = stage.status();
      if (!now) return end_held(now.error());
      {
        const std::scoped_lock lock{mutex};
        latest = *now;
      }
      if (now->state == rosin::motion_state::alarm) return end("the sled: " + now->reason);
      if (now->state == rosin::motion_state::idle) return end("");
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    end_held("");
  }
  /// Whatever happened, the sled is not left running.
  void end_held(const std::string& why) {
    const auto bad = stage.stop(std::chrono::milliseconds{600});
    end(stopped() ? "" : why);
    const std::scoped_lock lock{mutex};
    if (bad && why.empty()) late = bad->message;
  }
  void end(const std::string& why) {
    const std::scoped_lock lock{mutex};
    problem = why;
    finished = std::chrono::steady_clock::now();
  }

  rosin::grbl_stage stage;
  rosin::stroke way;
  double rest_s;
  std::mutex mutex;
  rosin::motion_status latest;
  std::string problem, late;  ///< late: of stopping, when the take is over
  std::optional<std::chrono::steady_clock::time_point> finished;
  std::jthread thread;
};

sled::sled(std::unique_ptr<shared> s) : state_{std::move(s)} {}
sled::~sled() { stop(); }
sled::sled(sled&&) noexcept = default;
sled& sled::operator=(sled&&) noexcept = default;

rosin::outcome<sled> sled::open(const sled_options& given, double speed_m_s) {
  auto link = rosin::byte_link::open(given.device, given.baud);
  if (!link) return rosin::failure{link.error()};
  auto stage = rosin::grbl_stage::open(*std::move(link), std::chrono::seconds{3}, stop_flag());
  if (!stage) return rosin::failure{stage.error()};
  if (given.unlock)
    if (const auto bad = stage->unlock()) return *bad;
  if (given.home)
    if (const auto bad = stage->home(std::chrono::duration<double>{given.home_s})) return *bad;
  const rosin::stroke way{given.distance_m, speed_m_s, given.acceleration_m_s2};
  if (const auto bad = stage->refused(way)) return *bad;
  return sled{std::make_unique<shared>(*std::move(stage), way, given.rest_s)};
}

void sled::begin() {
  state_->thread = std::jthread{[s = state_.get()](const std::stop_token& stop) { s->run(stop); }};
}

std::optional<std::string> sled::over() {
  const std::scoped_lock lock{state_->mutex};
  if (!state_->finished) return std::nullopt;
  const std::chrono::duration<double> since = std::chrono::steady_clock::now() - *state_->finished;
  if (state_->problem.empty() && since.count() < state_->rest_s) return std::nullopt;
  return state_->problem;
}

std::string sled::shows() const {
  const std::scoped_lock lock{state_->mutex};
  const auto& now = state_->latest;
  const std::string place = "sled " + in_digits(1e3 * now.position_m, "%.0f") + " mm";
  return std::isnan(now.speed_m_s) ? place : place + " " + in_digits(now.speed_m_s, "%.3f") + " m/s";
}

std::string sled::stop() {
  if (!state_ || !state_->thread.joinable()) return {};
  state_->thread.request_stop();
  state_->thread.join();
  return state_->late;
}

void add_sled_options(CLI::App& command, sled_options& given) {
  command
      .add_option("--sled", given.device,
                  "Serial device of a sled that understands GRBL's G-code; it makes a stroke of --speed during the take")
      ->type_name("DEVICE");
  command.add_option("--distance", given.distance_m, "Of the stroke, with its sign")->type_name("M");
  command.add_option("--acceleration", given.acceleration_m_s2, "Of the stroke")
      ->type_name("M/S2")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--rest", given.rest_s, "The take goes on for so long after the stroke")
      ->type_name("S")
      ->check(not_negative())
      ->capture_default_str();
  command.add_option("--sled-baud", given.baud, "Speed of its serial line")->capture_default_str();
  command.add_flag("--home", given.home, "Look for the home switch first; the take begins after that");
  command.add_option("--home-seconds", given.home_s, "The homing may take so long")
      ->type_name("S")
      ->check(positive())
      ->capture_default_str();
  command.add_flag("--unlock", given.unlock, "End an alarm first: you have looked, and the way is free");
}

}  // namespace tool
