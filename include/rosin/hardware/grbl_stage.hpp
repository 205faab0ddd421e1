// tier: hosted
// SPDX-License-Identifier: MIT
//
// The sled, where its driver understands G-code in GRBL's dialect (GRBL 1.1, grblHAL, FluidNC): one axis, X, in millimetres. A
// line is answered by "ok", "error:N" or "ALARM:N"; single bytes act at once, also while the sled moves:
//
//     ?  status report     !  feed hold     ~  go on     0x18  reset: the end of all motion
//
// What the controller would do without a word (go slower than asked, cut a ramp short) is refused here, from its own settings:
// $110 largest speed in mm/min, $120 acceleration in mm/s^2, $130 travel, $20 soft limits, $13 reports in inches. For a stroke
// the acceleration is written to $120, only where it differs: it lives in memory that wears out.
//
// Every wait has one deadline, which other traffic on the line does not put off, and ends early when `stop` becomes true. Then,
// and when the line fails, stop() still slows the sled down.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/frames.hpp>
#include <rosin/hardware/line_witness.hpp>

#include <cmath>
#include <limits>
#include <map>
#include <thread>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A MotionStage.
class grbl_stage {
public:
  using milliseconds = std::chrono::milliseconds;

  /// Wakes the controller up and reads its settings; one that moves or looks for its switch is left in peace. `patience`: for any
  /// answer. `stop`, if any, has to outlive the stage.
  [[nodiscard]] static outcome<grbl_stage> open(byte_link link, milliseconds patience = std::chrono::seconds{3},
                                                const std::atomic<bool>* stop = nullptr) {
    grbl_stage out{std::move(link), patience, stop};
    if (auto bad = out.wait_while_busy()) return *bad;
    if (auto bad = out.reset(out.soon())) return *bad;
    if (auto bad = out.read_settings()) return *bad;
    out.witness_.reset();
    return out;
  }

  /// Why the stroke cannot be made as asked, if so; nothing moves.
  [[nodiscard]] std::optional<failure> refused(const stroke& way) {
    const double mm_min = way.speed_m_s * 60e3;
    if (!(way.speed_m_s > 0) || !(way.acceleration_m_s2 > 0) || !std::isfinite(way.distance_m) || way.distance_m == 0)
      return problem("a stroke needs a distance, and a speed and an acceleration above zero");
    if (way.steady_m() < 0)
      return problem("a stroke of " + grbl_number(way.distance_m * 1e3) + " mm never reaches " + grbl_number(way.speed_m_s) +
                     " m/s at " + grbl_number(way.acceleration_m_s2) + " m/s2");
    for (const int which : {110, 120, 130})
      if (std::isnan(setting(which)) && (which != 130 || setting(20) == 1))
        return problem("the controller does not tell its setting $" + std::to_string(which) + ", so nobody knows what it can do");
    if (mm_min > setting(110))
      return problem("a speed of " + grbl_number(mm_min) + " mm/min is beyond the sled's " + grbl_number(setting(110)) +
                     " mm/min");
    const auto now = status();
    if (!now) return failure{now.error()};
    if (now->state != motion_state::idle)
      return problem("the sled is not ready" + (now->reason.empty() ? "" : ": " + now->reason));
    const double to_mm = (now->position_m + way.distance_m) * 1e3;
    if (setting(20) == 1 && place_of_machine_ && (to_mm > 0.0005 || to_mm < -setting(130) - 0.0005))
      return problem("the stroke would end at " + grbl_number(to_mm) + " mm, outside of " + grbl_number(-setting(130)) +
                     " to 0 mm");
    from_m_ = now->position_m;
    return std::nullopt;
  }
  [[nodiscard]] std::optional<failure> start(const stroke& way) {
    if (auto bad = refused(way)) return bad;
    const double acceleration = way.acceleration_m_s2 * 1e3;
    if (std::abs(acceleration - setting(120)) > 0.0005) {
      if (auto bad = ran("$120=" + grbl_number(acceleration))) return bad;
      settings_[120] = acceleration;
    }
    auto bad = ran("G21G91G1X" + grbl_number(way.distance_m * 1e3) + "F" + grbl_number(way.speed_m_s * 60e3));
    if (!bad) has_to_begin_.emplace(milliseconds{500});
    return bad;
  }
  [[nodiscard]] outcome<motion_status> status() { return status(soon()); }
  [[nodiscard]] std::optional<failure> hold() { return link_.write("!"); }
  [[nodiscard]] std::optional<failure> resume() { return link_.write("~"); }
  /// Slows down first, so that the position stays known; what is left of the stroke is dropped. Does not look at `stop`. Where the
  /// sled has not come to rest in time (the patience, if nothing is said), it goes on slowing down, and stays held.
  [[nodiscard]] std::optional<failure> stop(std::optional<milliseconds> at_most = std::nullopt) {
    const deadline until{at_most.value_or(patience_)};
    if (auto bad = link_.write("!", until)) return bad;
    for (;;) {
      const auto now = status(until);
      if (until.over()) return problem("the sled is still slowing down; it stays held, and opening it again drops the stroke");
      if (!now) return failure{now.error()};
      if (now->state == motion_state::idle) return std::nullopt;
      if (now->state == motion_state::alarm || (now->state == motion_state::holding && now->speed_m_s == 0)) return reset(until);
      std::this_thread::sleep_for(milliseconds{5});
    }
  }
  /// Ends an alarm. Where the sled stands is not certain any more.
  [[nodiscard]] std::optional<failure> unlock() {
    if (!alarm_.empty())  // after some, the controller waits for a reset and for nothing else
      if (auto bad = reset(soon())) return bad;
    alarm_.clear();
    return ran("$X");
  }
  /// Looks for the switch. Most controllers say nothing while they do; one that takes longer than this is stopped.
  [[nodiscard]] std::optional<failure> home(std::chrono::duration<double> at_most = std::chrono::seconds{120}) {
    const deadline until{std::chrono::duration_cast<milliseconds>(at_most), stop_};
    if (auto bad = drain()) return bad;
    alarm_.clear();
    const auto done = command("$H", until);
    if (done) return std::nullopt;
    if (!until.over()) return failure{done.error()};
    if (auto bad = link_.write("\x18")) return bad;
    return problem(until.stopped()
                       ? "stopped while homing"
                       : "is busy (homing): no end of it after " + grbl_number(at_most.count()) + " s; it was stopped");
  }

  /// Waits until the stroke is over; the reason where it did not come to its end.
  [[nodiscard]] std::optional<failure> wait(double at_most_s) {
    const deadline until{std::chrono::duration_cast<milliseconds>(std::chrono::duration<double>{at_most_s}), stop_};
    for (;;) {
      const auto now = status();
      if (!now) return failure{now.error()};
      if (now->state == motion_state::alarm) return problem(now->reason);
      if (now->state == motion_state::idle) return std::nullopt;
      if (until.over()) return problem(until.stopped() ? "stopped" : "the stroke is not over in time");
      std::this_thread::sleep_for(milliseconds{20});
    }
  }
  /// A setting of the controller; NaN where it told none.
  [[nodiscard]] double setting(int which) const {
    const auto at = settings_.find(which);
    return at == settings_.end() ? std::numeric_limits<double>::quiet_NaN() : at->second;
  }

private:
  grbl_stage(byte_link link, milliseconds patience, const std::atomic<bool>* stop)
      : link_{std::move(link)}, patience_{patience}, stop_{stop} {}

  [[nodiscard]] deadline soon() const noexcept { return deadline{patience_, stop_}; }
  [[nodiscard]] failure problem(const std::string& what) const { return failure{link_.name() + ": " + what}; }
  /// Why a wait for an answer ended.
  [[nodiscard]] failure no_answer(const deadline& until) const {
    if (until.stopped()) return problem("stopped while waiting for an answer");
    if (!witness_) return problem(heard_ ? "the sled talks, but does not answer" : "the sled does not answer: it says nothing");
    if (witness_->silent())
      return problem("the sled does not answer: it says nothing (is it switched on, is this its line, is it homing?)");
    if (witness_->controller()) return problem("the controller talks, but does not answer");
    return problem("this is no G-code controller: " + witness_->in_words());
  }

  [[nodiscard]] outcome<std::string> next_line(const deadline& until) {
    for (;;) {
      if (auto line = lines_.next()) return *std::move(line);
      if (until.over() || (witness_ && witness_->digitiser())) return no_answer(until);
      if (auto bad = fetch(until.slice())) return *bad;
    }
  }
  [[nodiscard]] std::optional<failure> fetch(milliseconds patience) {
    std::array<std::uint8_t, 1024> bytes{};
    const auto got = link_.read(bytes, patience);
    const auto came = std::span{bytes}.first(got.bytes);
    heard_ = heard_ || got.bytes > 0;
    if (witness_) witness_->push(came);
    lines_.push(came);
    return got.gone && got.bytes == 0 ? std::optional{failure{got.problem}} : std::nullopt;
  }
  /// Alarms, settings and the offset of the work's coordinates are told between the lines.
  void note(const std::string& line) {
    if (const auto alarm = grbl_alarm(line)) alarm_ = *alarm;
    if (const auto value = parse_grbl_setting(line)) settings_[value->first] = value->second;
    if (const auto report = parse_grbl_status(line); report && report->offset) offset_ = report->offset;
  }
  [[nodiscard]] failure started_anew() {
    offset_.reset();
    return problem("the controller started anew in the middle (its supply, its line, a button?): it may stand anywhere");
  }
  /// What came unasked: late or doubled answers are of no use, a reason to worry is one.
  [[nodiscard]] std::optional<failure> drain() {
    for (int reads = 0; reads < 64; ++reads) {
      if (auto bad = fetch(milliseconds{0})) return bad;
      bool any = false;
      while (const auto line = lines_.next()) {
        any = true;
        note(*line);
        if (is_grbl_greeting(*line)) return started_anew();
        if (const auto error = grbl_error(*line)) return problem(*error);
      }
      if (!any) break;
    }
    heard_ = false;
    return std::nullopt;
  }
  /// Sends a line, waits for its answer.
  [[nodiscard]] outcome<bool> command(const std::string& line, const deadline& until, bool alarm_answers = true) {
    if (auto bad = link_.write(line + "\n", until)) return *bad;
    for (;;) {
      const auto answer = next_line(until);
      if (!answer) return failure{answer.error()};
      note(*answer);
      if (*answer == "ok") return true;
      if (is_grbl_greeting(*answer)) return started_anew();
      if (const auto error = grbl_error(*answer)) return problem(line + ": " + *error);
      if (const auto alarm = grbl_alarm(*answer); alarm && alarm_answers) return problem(line + ": " + *alarm);
    }
  }
  [[nodiscard]] std::optional<failure> ran(const std::string& line) {
    if (auto bad = drain()) return bad;
    const auto done = command(line, soon());
    return done ? std::nullopt : std::optional{failure{done.error()}};
  }
  [[nodiscard]] std::optional<failure> reset(const deadline& until) {
    lines_.clear();
    offset_.reset();
    has_to_begin_.reset();
    if (auto bad = link_.write("\x18", until)) return bad;
    for (;;) {
      const auto line = next_line(until);
      if (!line) return failure{line.error()};
      note(*line);
      if (is_grbl_greeting(*line)) return std::nullopt;
    }
  }
  /// A board that boots when its line is opened greets twice, and forgets what it was told in between.
  [[nodiscard]] std::optional<failure> read_settings() {
    outcome<bool> told{false};
    const deadline until = soon();
    do told = command("$$", until, false);
    while (!told && told.error() == started_anew().message && !until.over());
    return told ? std::nullopt : std::optional{failure{told.error()}};
  }
  /// Who answers a "?" tells whether a reset would end somebody's motion.
  [[nodiscard]] std::optional<failure> wait_while_busy() {
    const deadline until = soon();
    for (std::string busy;; std::this_thread::sleep_for(milliseconds{50})) {
      const auto now = status(busy.empty() ? deadline{std::min(patience_ / 4, milliseconds{400}), stop_} : until);
      if (until.stopped()) return no_answer(until);
      if (!now && busy.empty()) return std::nullopt;
      if (now && now->state != motion_state::running && !(now->state == motion_state::holding && now->speed_m_s != 0))
        return std::nullopt;
      if (now) busy = now->reason;  // some say so once, and then nothing until they are done
      if (until.over()) return problem("the sled is busy (" + busy + ")");
    }
  }

  [[nodiscard]] outcome<motion_status> status(const deadline& until) {
    if (!witness_)
      if (auto bad = drain()) return *bad;
    if (auto bad = link_.write("?", until)) return *bad;
    for (;;) {
      const auto line = next_line(until);
      if (!line && !alarm_.empty() && !until.stopped()) return motion_status{motion_state::alarm, place_m_, 0, alarm_};
      if (!line) return failure{line.error()};
      note(*line);
      if (grbl_alarm(*line)) return motion_status{motion_state::alarm, place_m_, 0, alarm_};
      if (const auto error = grbl_error(*line); error && !witness_) return problem(*error);
      if (is_grbl_greeting(*line)) return started_anew();
      if (const auto report = parse_grbl_status(*line)) return in_metres(*report);
    }
  }
  [[nodiscard]] outcome<motion_status> in_metres(const grbl_report& r) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    if (!r.state) return problem("the controller is in a state that is not known: " + r.word);
    const double unit_m = setting(13) == 1 ? 25.4e-3 : 1e-3;
    place_of_machine_ = r.machine || offset_;
    place_m_ = unit_m * (r.machine ? *r.machine : *r.work + offset_.value_or(0));
    motion_status out{*r.state, place_m_, r.at_rest ? 0 : unit_m / 60 * r.feed.value_or(nan), {}};
    if (out.state == motion_state::idle || out.state == motion_state::alarm) out.speed_m_s = unit_m / 60 * r.feed.value_or(0);
    if (out.state == motion_state::alarm) out.reason = alarm_.empty() ? "locked: home the sled, or unlock it" : alarm_;
    if (out.state == motion_state::running) out.reason = r.homing ? "homing" : "it moves";
    if (out.state == motion_state::holding) out.reason = "it is held";
    // Idle between the answer to a stroke and its beginning is not its end.
    if (out.state != motion_state::idle || std::abs(place_m_ - from_m_) > 1e-6) has_to_begin_.reset();
    if (has_to_begin_ && !has_to_begin_->over()) out.state = motion_state::running;
    return out;
  }

  byte_link link_;
  milliseconds patience_;
  const std::atomic<bool>* stop_;
  grbl_lines lines_;
  std::optional<line_witness> witness_{std::in_place};  ///< until it is known who talks
  std::string alarm_;
  std::map<int, double> settings_;
  std::optional<double> offset_;  ///< of the work's coordinate, in the reports' unit
  std::optional<deadline> has_to_begin_;
  double place_m_ = 0, from_m_ = 0;
  bool heard_ = false, place_of_machine_ = false;
};

static_assert(MotionStage<grbl_stage>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
