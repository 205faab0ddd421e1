// SPDX-License-Identifier: MIT
#include "recorder.hpp"

#include "digits.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <future>
#include <iostream>
#include <utility>

namespace tool {

namespace {

std::atomic<bool> stop_asked{false};

/// Wall clock and this thread's share of a processor, for how long something took.
class stop_watch {
public:
  [[nodiscard]] double wall_s() const noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
  }
  [[nodiscard]] double processor_s() const noexcept { return processor_now_s() - processor_s_; }

private:
  [[nodiscard]] static double processor_now_s() noexcept {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double processor_s_ = processor_now_s();
};

/// One line on the terminal, ten times a second; nothing in a pipe, nothing where the terminal stands still.
class meters_line {
public:
  ~meters_line() {
    if (shown_) std::fputs("\r\x1b[K", stderr);
  }
  void draw(const std::string& state, const std::vector<rosin::channel_level>& levels, const std::string& more) {
    const auto now = std::chrono::steady_clock::now();
    pollfd terminal{STDERR_FILENO, POLLOUT, 0};
    if (!shown_ || now - drawn_ < std::chrono::milliseconds{100} || ::poll(&terminal, 1, 0) != 1) return;
    drawn_ = now;
    std::string line = "\r\x1b[K" + state;
    for (const auto& l : levels) {
      constexpr int width = 12;
      const int peak = std::clamp(static_cast<int>((rosin::decibels(l.peak) + 60) / 60 * width), 0, width);
      const int rms = std::clamp(static_cast<int>((rosin::decibels(l.rms) + 60) / 60 * width), 0, peak);
      line += " [" + std::string(static_cast<std::size_t>(rms), '=') + std::string(static_cast<std::size_t>(peak - rms), '-') +
              std::string(static_cast<std::size_t>(width - peak), ' ') +
              (l.clipped > 0 ? "\x1b[7mCLIP\x1b[0m]" : in_digits(rosin::decibels(l.peak), "%4.0f") + "]");
    }
    std::fputs((line + " " + more).c_str(), stderr);
    std::fflush(stderr);
  }
  /// Above the line that is rewritten.
  void say(const std::string& what) const { std::cerr << (shown_ ? "\r\x1b[K" : "") << "rosin: " << what << std::endl; }

private:
  bool shown_ = ::isatty(STDERR_FILENO) == 1;
  std::chrono::steady_clock::time_point drawn_{};
};

/// One take in the making.
class session {
public:
  session(const take_plan& take, const rosin::frame_format& format, const recorder_options& how, rig_file_writer* files,
          const recorder_hooks& hooks)
      : how_{how}, files_{files}, hooks_{hooks}, meter_{format}, trigger_{format, how.trigger} {
    report_.take = take;
    report_.format = format;
    most_ = how.seconds > 0 ? static_cast<std::uint64_t>(std::llround(how.seconds * format.sample_rate_Hz)) : ~std::uint64_t{0};
  }

  /// False: the take is over.
  [[nodiscard]] bool take_in(const rosin::frame_read& got, std::span<const double> frames) {
    const stop_watch watch;
    if (!got.problem.empty()) problem(got.problem);
    meter_.push(frames);
    const bool before = trigger_.fired();
    if (!before && got.lost > 0) trigger_ = {report_.format, how_.trigger};  // the time before has to be without gaps
    const auto part = trigger_.push(frames);
    if (trigger_.fired()) {
      report_.triggered = true;
      if (before && got.lost > 0 && report_.frames > 0 && !missing(got.lost)) return false;
      if (!keep(part)) return false;
    }
    tell_unrest(got.frames);
    note_time(watch, got.frames);
    if (got.ended) report_.over = true;
    if (got.ended && report_.frames == 0 && !trigger_.fired()) problem("the source ended before the trigger was reached");
    return !got.ended && report_.frames < most_ && !asked_to_end();
  }
  void draw() {
    const std::string time = trigger_.fired()   ? in_digits(report_.duration_s(), "%7.1f s")
                             : trigger_.armed() ? "  waits"
                                                : "  moves";
    line_.draw(report_.take.name + time, meter_.levels(), hooks_.shows ? hooks_.shows() : "");
  }
  [[nodiscard]] take_report finish() {
    if (named_.valid()) (void)named_.get();  // where it failed, it is tried again below
    bool sound = true;
    if (file_)
      if (const auto bad = file_->finish()) sound = false, problem(bad->message);
    for (const auto& level : meter_.levels()) report_.clipped.push_back(level.clipped);
    if (files_ != nullptr) leave_folder(sound);
    const std::chrono::duration<double> all = std::chrono::steady_clock::now() - start_;
    report_.busy = busy_s_ / std::max(1e-9, all.count());
    return std::move(report_);
  }

private:
  void problem(const std::string& what) {
    line_.say((report_.frames > 0 ? "at " + in_digits(report_.duration_s(), "%.4f") + " s: " : "") + what);
    if (report_.problems.size() < 1000) report_.problems.push_back(what);
  }
  /// Once, where nothing can trigger because it is never at rest.
  void tell_unrest(std::size_t frames) {
    constexpr double patience_s = 5;
    if (trigger_.armed()) return;
    const double before = static_cast<double>(std::exchange(unarmed_, unarmed_ + frames)) / report_.format.sample_rate_Hz,
                 now = static_cast<double>(unarmed_) / report_.format.sample_rate_Hz;
    if (before < patience_s && now >= patience_s)
      line_.say("waits for rest: a channel departs from its mean by " + in_digits(trigger_.unrest(), "%.3f") +
                " of full scale; the trigger is armed once all stay within " + in_digits(how_.trigger.threshold / 2, "%.3f") +
                ", half of --trigger");
  }
  [[nodiscard]] bool asked_to_end() {
    if (stopped()) return true;
    if (!hooks_.over || report_.frames == 0) return false;
    const auto why = hooks_.over(report_.duration_s());
    if (why && !why->empty()) problem(*why);
    return why.has_value();
  }
  /// Silence in the file where frames are missing, so that time goes on counting right.
  [[nodiscard]] bool missing(std::uint64_t count) {
    problem(std::to_string(count) + " frames are missing");
    if (static_cast<double>(count) > 600 * report_.format.sample_rate_Hz)
      return problem("that is too much to leave a gap for"), false;
    report_.gaps.push_back({report_.frames, count});
    const auto width = static_cast<std::size_t>(report_.format.channels);
    const std::vector<double> silence(4096 * width, 0.0), unknown(4096 * width, nan);
    for (std::uint64_t left = count; left > 0;) {
      const auto n = std::min<std::uint64_t>(left, 4096);
      if (!write(std::span{silence}.first(n * width), std::span{unknown}.first(n * width))) return false;
      left -= n;
    }
    return true;
  }
  [[nodiscard]] bool keep(std::span<const double> part) { return part.empty() || write(part, part); }
  [[nodiscard]] bool write(std::span<const double> to_file, std::span<const double> to_others) {
    const auto width = static_cast<std::size_t>(report_.format.channels);
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(to_file.size() / width, most_ - report_.frames));
    if (count == 0) return false;
    const bool first = report_.frames == 0;
    if (files_ != nullptr) {
      const stop_watch watch;
      if (first && !open()) return false;
      const auto bad = file_->write(to_file.first(count * width));
      const double took = watch.wall_s();
      writing_s_ += took, writing_processor_s_ += watch.processor_s();
      report_.worst_write_s = std::max(report_.worst_write_s, took);
      if (bad) return failed(*bad);
    }
    report_.frames += count;
    if (first && files_ != nullptr) named_ = std::async(std::launch::async, [this] { return name(); });
    if (first && hooks_.begun) hooks_.begun();
    if (hooks_.frames)
      if (const auto bad = hooks_.frames(to_others.first(count * width))) return failed(*bad);
    return true;
  }
  /// Into the rig file, once there is something on the disk that it can name.
  [[nodiscard]] std::optional<rosin::failure> name() {
    if (auto bad = file_->sync()) return bad;
    return files_->put();
  }
  void leave_folder(bool sound) {
    if (report_.frames == 0) {
      std::error_code ignored;
      if (file_) std::filesystem::remove(files_->folder() + "/" + report_.take.file(), ignored);
      return files_->give_up();
    }
    if (const auto bad = files_->finish(remarks(), sound)) problem(bad->message);
  }
  [[nodiscard]] bool open() {
    auto made = rosin::take_file<>::create(files_->folder() + "/" + report_.take.file(), report_.format);
    if (!made) return failed(rosin::failure{made.error()});
    file_.emplace(*std::move(made));
    return true;
  }
  bool failed(const rosin::failure& why) {
    problem(why.message + (report_.frames > 0 ? "; what was recorded before stays" : ""));
    report_.over = true;
    return false;
  }
  void note_time(const stop_watch& watch, std::size_t frames) {
    const double all = watch.wall_s(), worked = watch.processor_s() - std::exchange(writing_processor_s_, 0.0);
    busy_s_ += all;
    report_.worst_block_processor_s = std::max(report_.worst_block_processor_s, worked);
    const double took = all - std::exchange(writing_s_, 0.0);
    if (took <= report_.worst_block_s) return;
    report_.worst_block_s = took;
    report_.worst_block_of_s = static_cast<double>(frames) / report_.format.sample_rate_Hz;
  }
  [[nodiscard]] std::vector<std::string> remarks() const {
    std::vector<std::string> out;
    for (const auto& g : report_.gaps)
      out.push_back("gap: " + std::to_string(g.length) + " frames are missing from frame " + std::to_string(g.frame) +
                    " on; silence stands for them");
    return out;
  }

  recorder_options how_;
  rig_file_writer* files_;
  const recorder_hooks& hooks_;
  take_report report_;
  std::uint64_t most_ = 0, unarmed_ = 0;
  rosin::level_meter meter_;
  rosin::level_trigger trigger_;
  std::optional<rosin::take_file<>> file_;
  std::future<std::optional<rosin::failure>> named_;
  meters_line line_;
  double busy_s_ = 0, writing_s_ = 0, writing_processor_s_ = 0;  ///< the latter two of the block at hand
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

std::uint64_t take_report::lost() const noexcept {
  std::uint64_t sum = 0;
  for (const auto& g : gaps) sum += g.length;
  return sum;
}

take_report recorder::record(const take_plan& take, rig_file_writer* files, const recorder_hooks& hooks) {
  const rosin::frame_format format = from_.format();
  session one{take, format, how_, files, hooks};
  const auto width = static_cast<std::size_t>(format.channels);
  std::vector<double> block(width * static_cast<std::size_t>(std::max(64.0, format.sample_rate_Hz / 50)));
  ::mlockall(MCL_CURRENT);  // no page of this program has to be fetched again; where that is not allowed, all works as before
  for (;;) {
    const rosin::frame_read got = from_.read(block, std::chrono::milliseconds{20});
    if (!one.take_in(got, std::span{block}.first(got.frames * width))) break;
    one.draw();
  }
  return one.finish();
}

void add_recorder_options(CLI::App& command, recorder_options& given) {
  command.add_option("--seconds", given.seconds, "Length of the take; until Ctrl-C or the source's end if left out")
      ->type_name("S")
      ->check(positive());
  command
      .add_option("--trigger", given.trigger.threshold,
                  "The take begins when a channel departs from its mean by so much of full scale; 0: at once")
      ->check(between(0.0, 2.0))
      ->capture_default_str();
  command.add_option("--before", given.trigger.before_s, "What is kept of the time before the trigger")
      ->type_name("S")
      ->check(between(0.0, 60.0))
      ->capture_default_str();
}

json to_json(const take_report& r) {
  json gaps = json::array();
  for (const auto& g : r.gaps) gaps.push_back({{"frame", g.frame}, {"frames", g.length}});
  return {{"take", r.take.name},
          {"file", r.take.file()},
          {"frames", r.frames},
          {"duration_s", r.duration_s()},
          {"sampling_rate_Hz", r.format.sample_rate_Hz},
          {"channels", r.format.channels},
          {"bits", r.format.bits},
          {"float", r.format.float_format},
          {"lost_frames", r.lost()},
          {"gaps", gaps},
          {"clipped", r.clipped},
          {"problems", r.problems},
          {"worst_block_s", r.worst_block_s},
          {"worst_block_lasts_s", r.worst_block_of_s},
          {"worst_block_processor_s", r.worst_block_processor_s},
          {"worst_write_s", r.worst_write_s},
          {"busy", r.busy}};
}

std::string summary_of(const take_report& r) {
  if (r.frames == 0) return r.take.name + ": nothing was recorded";
  std::string out = r.take.name + ": " + in_digits(r.duration_s(), "%.3f") + " s, " + std::to_string(r.format.channels) +
                    " channels at " + in_digits(r.format.sample_rate_Hz, "%.0f") + " Hz, " +
                    (r.format.float_format ? "floating point" : std::to_string(r.format.bits) + " bits");
  if (!r.gaps.empty()) out += ", " + std::to_string(r.lost()) + " frames missing in " + std::to_string(r.gaps.size()) + " gaps";
  for (std::size_t c = 0; c < r.clipped.size(); ++c)
    if (r.clipped[c] > 0) out += ", channel " + std::to_string(c) + " at full scale " + std::to_string(r.clipped[c]) + " times";
  return out;
}

void stop_on_signals() {
  for (const int s : {SIGINT, SIGTERM}) std::signal(s, [](int) { stop_asked = true; });
  for (const int s : {SIGPIPE, SIGXFSZ}) std::signal(s, SIG_IGN);  // write() says it
}
bool stopped() noexcept { return stop_asked; }
const std::atomic<bool>* stop_flag() noexcept { return &stop_asked; }

std::uint64_t resident_bytes() {
  std::ifstream in{"/proc/self/statm"};
  std::uint64_t size = 0, resident = 0;
  in >> size >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace tool
