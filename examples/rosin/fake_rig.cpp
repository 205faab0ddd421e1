// SPDX-License-Identifier: MIT
#include "fake_rig.hpp"
#include "commands.hpp"
#include "provenance.hpp"
#include "recorder.hpp"
#include "rig_input.hpp"

#include <iostream>
#include <memory>

namespace tool {

namespace {

/// From rest to the first frame in a second: a string is deflected slowly before its wire breaks.
std::vector<std::int32_t> lead_in(const std::vector<std::int32_t>& take, std::size_t channels, double rate_Hz) {
  const auto count = static_cast<std::size_t>(rate_Hz);
  std::vector<std::int32_t> out(count * channels);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < channels; ++c)
      out[i * channels + c] =
          static_cast<std::int32_t>(std::lround(take[c] * (static_cast<double>(i) / static_cast<double>(count))));
  return out;
}

/// A line of its own under a name of the user's choice; the name is gone when the rig is.
class named_line {
public:
  named_line(rosin::pseudo_terminal pair, std::string name) : pair_{std::move(pair)}, name_{std::move(name)} {}
  named_line(const named_line&) = delete;
  named_line& operator=(const named_line&) = delete;
  ~named_line() { ::unlink(name_.c_str()); }
  [[nodiscard]] const rosin::byte_link& device() const noexcept { return pair_.device(); }

private:
  rosin::pseudo_terminal pair_;
  std::string name_;
};

rosin::outcome<std::unique_ptr<named_line>> make_line(const std::string& name) {
  auto pair = rosin::pseudo_terminal::open();
  if (!pair) return rosin::failure{pair.error()};
  std::error_code ignored;
  if (std::filesystem::is_symlink(name, ignored)) std::filesystem::remove(name, ignored);
  if (::symlink(pair->path().c_str(), name.c_str()) != 0) return rosin::failure{name + ": " + std::strerror(errno)};
  return std::make_unique<named_line>(*std::move(pair), name);
}

/// The digitiser: packets at the pace of the clock, into a line that nobody may be reading. What it cannot take is lost, as on
/// a real one, and the packets' numbers say so.
class digitiser {
public:
  static constexpr std::size_t room = 16384;

  digitiser(fake_player& from, const rosin::byte_link& to, const fake_rig_options& given)
      : from_{from}, to_{to}, given_{given}, block_(static_cast<std::size_t>(given.packet_frames * from.channels())),
        encoder_{{.stream = static_cast<std::uint8_t>(::getpid()),
                  .channels = static_cast<std::uint8_t>(from.channels()),
                  .bits = static_cast<std::uint8_t>(from.bits()),
                  .rate_mHz = static_cast<std::uint32_t>(std::lround(1000 * from.rate_Hz()))}} {
    ::fcntl(to.fd(), F_SETFL, ::fcntl(to.fd(), F_GETFL) | O_NONBLOCK);
  }
  void send_until(double time_s) {
    while (static_cast<double>(sent_) < time_s * from_.rate_Hz()) {
      from_.next(block_);
      sent_ += static_cast<std::uint64_t>(given_.packet_frames);
      std::string packet{reinterpret_cast<const char*>(encoder_.data()),
                         encoder_.encode(block_.data(), static_cast<std::uint16_t>(given_.packet_frames))};
      harm(packet);
      put(packet);
    }
  }

private:
  void harm(std::string& packet) {
    if (given_.harm <= 0 || std::uniform_real_distribution<>{}(random_) >= given_.harm) return;
    const auto kind = random_() % 4;
    if (kind == 0) packet.clear();
    if (kind == 1) packet.resize(packet.size() / 2);
    if (kind == 2) packet[packet.size() / 3] = static_cast<char>(packet[packet.size() / 3] ^ 0x10);
    if (kind == 3) packet += packet;
  }
  /// A line that stands still for a moment gets what it missed; where nobody reads, nothing but the packet that was begun is
  /// kept.
  void put(const std::string& packet) {
    const auto now = std::chrono::steady_clock::now();
    if (rest_.empty()) progress_ = now;
    if (rest_.size() < 64 * room) rest_ += packet;
    const ssize_t done = ::write(to_.fd(), rest_.data(), rest_.size());
    if (done > 0) {
      rest_.erase(0, static_cast<std::size_t>(done));
      progress_ = now;
    } else if (now - progress_ > std::chrono::seconds{1}) {
      rest_.resize(std::min(rest_.size(), rest_.find('\0') + 1));
    }
  }

  fake_player& from_;
  const rosin::byte_link& to_;
  fake_rig_options given_;
  std::vector<std::int32_t> block_;
  rosin::packet_encoder<room> encoder_;
  std::uint64_t sent_ = 0;
  std::string rest_;
  std::chrono::steady_clock::time_point progress_;
  std::mt19937 random_{1};
};

/// Lines of standard input, without waiting.
class hand {
public:
  std::optional<std::string> next() {
    std::array<std::uint8_t, 256> bytes{};
    if (open_) {
      const auto got = in_.read(bytes, std::chrono::milliseconds{0});
      text_.append(reinterpret_cast<const char*>(bytes.data()), got.bytes);
      open_ = !got.gone;
    }
    const auto end = text_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = text_.substr(0, end);
    text_.erase(0, end + 1);
    return line;
  }

private:
  rosin::byte_link in_{::dup(STDIN_FILENO), "standard input"};
  std::string text_;
  bool open_ = true;
};

/// The whole of it, step by step.
class rehearsal {
public:
  rehearsal(fake_player player, std::unique_ptr<named_line> line, std::unique_ptr<named_line> sled, const fake_rig_options& given)
      : player_{std::move(player)}, line_{std::move(line)}, sled_line_{std::move(sled)}, converter_{player_, line_->device(),
                                                                                                    given} {
    sled_.settings[22] = given.homing_s > 0 ? 1 : 0;
    sled_.home_s = given.homing_s;
  }

  [[nodiscard]] std::optional<rosin::failure> until(double time_s) {
    while (const auto name = fingers_.next())
      if (!player_.play(*name)) std::cerr << "rosin: there is no take " << *name << std::endl;
    if (sled_line_)
      if (auto bad = move_sled(time_s)) return bad;
    converter_.send_until(time_s);
    return std::nullopt;
  }

private:
  [[nodiscard]] std::optional<rosin::failure> move_sled(double time_s) {
    std::array<std::uint8_t, 256> bytes{};
    const auto got = sled_line_->device().read(bytes, std::chrono::milliseconds{0});
    const int before = sled_.strokes();
    const std::string answer = sled_.receive({reinterpret_cast<const char*>(bytes.data()), got.bytes}, time_s);
    if (sled_.strokes() > before && !player_.bow()) std::cerr << "rosin: all bowed takes have been played" << std::endl;
    return sled_line_->device().write(answer, std::chrono::milliseconds{500});
  }

  fake_player player_;
  std::unique_ptr<named_line> line_, sled_line_;
  digitiser converter_;
  rosin::grbl_simulator sled_;
  hand fingers_;
};

exit_code run(const fake_rig_options& given) {
  stop_on_signals();
  auto player = fake_player::load(given);
  if (!player) return fail(player.error());
  auto line = make_line(given.line);
  if (!line) return fail(line.error());
  std::unique_ptr<named_line> sled_line;
  if (!given.sled.empty()) {
    auto made = make_line(given.sled);
    if (!made) return fail(made.error());
    sled_line = *std::move(made);
  }
  rehearsal all{*std::move(player), *std::move(line), std::move(sled_line), given};
  std::cout << "ready: " << given.line << (given.sled.empty() ? "" : " " + given.sled) << std::endl;
  const auto start = std::chrono::steady_clock::now();
  while (!stopped()) {
    const std::chrono::duration<double> now = std::chrono::steady_clock::now() - start;
    if (given.seconds > 0 && now.count() > given.seconds) break;
    if (const auto bad = all.until(now.count())) return fail(bad->message);
    std::this_thread::sleep_for(std::chrono::microseconds{500});
  }
  return exit_code::ok;
}

}  // namespace

rosin::outcome<fake_player> fake_player::load(const fake_rig_options& given) {
  CLI::App nobody;
  provenance from{nobody};
  auto folder = open_rig(given.rig, from);
  if (!folder) return rosin::failure{folder.error()};
  fake_player out;
  for (const auto& t : folder->rig.takes) {
    const auto read = rosin::load_recording(folder->rig, t, table_formats());
    if (!read) return rosin::failure{read.error()};
    if (read->is_table)
      return rosin::failure{read->file + ": is a table of numbers, no converter made it: only sound files are played"};
    const int bits = read->float_format || read->bits > 24 ? 32 : read->bits > 16 ? 24 : 16;
    if (out.takes_.empty())
      out.rate_Hz_ = read->sample_rate_Hz, out.channels_ = static_cast<int>(read->channels.size()), out.bits_ = bits;
    if (out.rate_Hz_ != read->sample_rate_Hz || out.bits_ != bits)
      return rosin::failure{read->file + ": its rate or width is not that of the first take"};
    frames samples;
    const double top = std::ldexp(1.0, bits - 1);
    for (std::size_t i = 0; i < read->frames(); ++i)
      for (const auto& c : read->channels)
        samples.push_back(static_cast<std::int32_t>(std::clamp(std::nearbyint(c[i] * top), -top, top - 1)));
    if (t.kind == rosin::take_kind::quiet) out.idle_ = samples;
    out.takes_.push_back({t.name, t.kind == rosin::take_kind::bow, std::move(samples)});
  }
  if (out.idle_.empty()) out.idle_.assign(static_cast<std::size_t>(out.channels_), 0);
  if (!given.loop.empty()) {
    out.loop_ = true;
    if (!out.play(given.loop)) return rosin::failure{folder->rig.file + ": there is no take " + given.loop};
  }
  return out;
}

bool fake_player::play(const std::string& name) {
  const auto one = std::find_if(takes_.begin(), takes_.end(), [&](const auto& t) { return t.name == name; });
  if (one == takes_.end()) return false;
  playing_ = one->bowed || loop_ ? frames{} : lead_in(one->samples, static_cast<std::size_t>(channels_), rate_Hz_);
  playing_.insert(playing_.end(), one->samples.begin(), one->samples.end());
  at_ = 0;
  return true;
}

bool fake_player::bow() {
  while (bows_ < takes_.size() && !takes_[bows_].bowed) ++bows_;
  return bows_ < takes_.size() && play(takes_[bows_++].name);
}

void fake_player::next(std::span<std::int32_t> interleaved) {
  for (auto& x : interleaved) {
    if (at_ == playing_.size() && loop_) at_ = 0;
    if (at_ < playing_.size()) {
      x = playing_[at_++];
    } else {
      x = idle_[idle_at_];
      idle_at_ = (idle_at_ + 1) % idle_.size();
    }
  }
}

void add_fake_rig(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<fake_rig_options>();
  CLI::App* command =
      app.add_subcommand("fake-rig", "Plays recordings as if a digitiser sent them, and a sled besides: a rehearsal");
  command->add_option("RIG", given->rig, "Folder of the rig that is played")->required();
  command->add_option("--line", given->line, "Name for the serial line on which the frames come")->required()->type_name("PATH");
  command->add_option("--sled", given->sled, "Name for the serial line of the sled; each stroke plays the next bowed take")
      ->type_name("PATH");
  command->add_option("--homing", given->homing_s, "The sled has a home switch, and needs so long to find it")
      ->type_name("S")
      ->check(not_negative());
  command->add_option("--loop", given->loop, "This take, again and again without a gap")->type_name("TAKE");
  command->add_option("--harm", given->harm, "Share of the packets that get lost, cut, corrupted or doubled")
      ->check(between(0.0, 1.0))
      ->capture_default_str();
  command->add_option("--packet", given->packet_frames, "Frames in a packet")
      ->check(between(1, 500, "INT"))
      ->capture_default_str();
  command->add_option("--seconds", given->seconds, "Ends after this time; at Ctrl-C if left out")->type_name("S");
  command->footer(
      "A line on standard input with the name of a take plays it: this is the hand that pulls the wire.\n"
      "Exit status: 0 done, 2 bad input, or a line that broke.");
  command->callback([given, &result] { result = run(*given); });
}

}  // namespace tool
