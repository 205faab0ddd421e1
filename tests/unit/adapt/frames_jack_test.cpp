// SPDX-License-Identifier: MIT
#include <rosin/adapt/frames_jack.hpp>

#include <doctest/doctest.h>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <csignal>
#include <cstdlib>

namespace {

/// A real server with its dummy driver, under a name of its own; nothing where there is no jackd.
class jack_server {
public:
  jack_server() : name_{"rosin-test-" + std::to_string(::getpid())} {
    jack_set_error_function([](const char*) {});
    jack_set_info_function([](const char*) {});
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int quiet = ::open("/dev/null", O_RDWR);
    ::dup2(quiet, 1);
    ::dup2(quiet, 2);
    ::setenv("JACK_NO_AUDIO_RESERVATION", "1", 1);
    ::execlp("jackd", "jackd", "-n", name_.c_str(), "-S", "-r", "-d", "dummy", "-r", "48000", "-p", "256", nullptr);
    ::_exit(127);
  }
  ~jack_server() { stop(); }
  void stop() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGTERM);
    ::waitpid(pid_, nullptr, 0);
    pid_ = 0;
  }
  /// Empty where it never came up.
  std::unique_ptr<jack_client_t, int (*)(jack_client_t*)> client(const char* who) const {
    const auto options = static_cast<jack_options_t>(JackNoStartServer | JackServerName);
    for (int i = 0; i < 100; ++i) {
      if (auto* c = jack_client_open(who, options, nullptr, name_.c_str())) return {c, &jack_client_close};
      std::this_thread::sleep_for(std::chrono::milliseconds{50});
    }
    return {nullptr, &jack_client_close};
  }
  const std::string& name() const { return name_; }

private:
  std::string name_;
  pid_t pid_ = 0;
};

/// Plays the numbers 1, 2, 3 ... of the server's clock on one port and their negatives on the other, once it is told to.
struct player {
  jack_client_t* client = nullptr;
  std::array<jack_port_t*, 2> ports{};
  std::atomic<bool> go{false};
  jack_nframes_t start = 0;
  static int process(jack_nframes_t frames, void* self) {
    auto& p = *static_cast<player*>(self);
    auto* a = static_cast<float*>(jack_port_get_buffer(p.ports[0], frames));
    auto* b = static_cast<float*>(jack_port_get_buffer(p.ports[1], frames));
    const bool on = p.go;
    const jack_nframes_t now = jack_last_frame_time(p.client);
    if (!on) p.start = now + frames;
    for (jack_nframes_t i = 0; i < frames; ++i) {
      a[i] = on ? static_cast<float>(now - p.start + i + 1) : 0.0F;
      b[i] = -a[i];
    }
    return 0;
  }
};

bool there_is_jackd() { return std::system("command -v jackd >/dev/null 2>&1") == 0; }

}  // namespace

TEST_CASE("from another client of a real server with its dummy driver: every frame, in order; then the server goes away") {
  if (!there_is_jackd()) {
    MESSAGE("no jackd: not tried");
    return;
  }
  jack_server server;
  player plays;
  const auto client = server.client("player");
  REQUIRE(client);
  plays.client = client.get();
  jack_set_process_callback(client.get(), &player::process, &plays);
  for (std::size_t c = 0; c < 2; ++c)
    plays.ports[c] = jack_port_register(client.get(), c == 0 ? "near" : "far", JACK_DEFAULT_AUDIO_TYPE, JackPortIsOutput, 0);
  REQUIRE(jack_activate(client.get()) == 0);
  auto from = rosin::jack_source::open("rosin", {"player:near", "player:far"}, server.name());
  REQUIRE_MESSAGE(from.has_value(), from.error());
  CHECK(from->format().sample_rate_Hz == 48000);
  CHECK(from->format().channels == 2);
  plays.go = true;
  std::vector<double> block(2 * 100);
  double next = 1;
  bool right = true;
  while (next < 30000 && right) {
    const auto got = from->read(block, std::chrono::seconds{2});
    REQUIRE(got.frames > 0);
    for (std::size_t i = 0; i < got.frames; ++i) {
      if (block[2 * i] == 0 && next == 1) continue;       // before it began
      if (i == 0) next += static_cast<double>(got.lost);  // a busy machine may be late; then it has to say so
      right = right && block[2 * i] == next && block[2 * i + 1] == -next;
      ++next;
    }
  }
  CHECK(right);
  const auto other = rosin::jack_source::open("other", {"nobody:out"}, server.name());
  REQUIRE_FALSE(other.has_value());
  CHECK(other.error() == "jack: there is no port nobody:out to listen to");

  server.stop();
  rosin::frame_read last;
  for (int i = 0; i < 200 && !last.ended; ++i) last = from->read(block, std::chrono::milliseconds{50});
  CHECK(last.ended);
  CHECK(last.problem == "jack: the server is gone");
}

TEST_CASE("no server") {
  const auto none = rosin::jack_source::open("rosin", {"a:b"}, "rosin-no-such-server");
  REQUIRE_FALSE(none.has_value());
  CHECK(none.error().find("jack: there is no server") == 0);
}
