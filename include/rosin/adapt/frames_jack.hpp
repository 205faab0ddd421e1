// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames from a JACK server: one input port a channel, joined to the ports that are named. The server's callback copies into
// a ring and does nothing else. Cycles that the server left out are seen by its frame counter, so a gap's length is exact.
//
#pragma once

#include <rosin/hardware/frame_ring.hpp>
#include <rosin/hardware/frames.hpp>

#include <jack/jack.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A FrameSource.
class jack_source {
public:
  /// ports: "system:capture_1", ...; an empty name leaves that channel's port free, for another program to join. Returns once
  /// frames come.
  [[nodiscard]] static outcome<jack_source> open(const std::string& client, const std::vector<std::string>& ports,
                                                 const std::string& server = {}) {
    jack_set_error_function([](const char*) {});
    jack_set_info_function([](const char*) {});
    jack_status_t status{};
    auto options = static_cast<jack_options_t>(JackNoStartServer | (server.empty() ? JackNullOption : JackServerName));
    jack_client_t* raw = server.empty() ? jack_client_open(client.c_str(), options, &status)
                                        : jack_client_open(client.c_str(), options, &status, server.c_str());
    if (raw == nullptr)
      return failure{"jack: there is no server that takes us (status " + std::to_string(static_cast<int>(status)) + ")"};
    jack_source out;
    out.state_ = std::make_unique<shared>(ports.size(), static_cast<std::size_t>(jack_get_sample_rate(raw)));
    out.client_.reset(raw);
    if (auto bad = out.start(ports)) return *bad;
    return out;
  }

  [[nodiscard]] frame_format format() const noexcept {
    return {static_cast<double>(jack_get_sample_rate(client_.get())), static_cast<int>(state_->ports.size()), 32, true, true};
  }
  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    const std::size_t width = state_->ports.size();
    std::array<float, 4096> block;
    for (;;) {
      const bool gone = state_->gone.load(std::memory_order_acquire);
      const std::size_t most = std::min(interleaved.size(), block.size()) / width * width;
      const auto got = state_->ring.read(std::span{block}.first(most));
      std::transform(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(got.frames * width), interleaved.begin(),
                     [](float x) { return static_cast<double>(x); });
      if (got.frames > 0) return {got.frames, got.lost, false, got.lost > 0 ? "jack: overrun" : ""};
      if (gone) {  // jackd ends by SIGPIPE, and stays in JACK's list of servers, where a client goes before it has
        std::this_thread::sleep_for(std::chrono::milliseconds{300});
        return {0, 0, true, "jack: the server is gone"};
      }
      if (std::chrono::steady_clock::now() >= deadline) return {};
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }

private:
  struct shared {
    shared(std::size_t channels, std::size_t rate) : ports(channels), buffers(channels), ring{channels, rate} {}
    std::vector<jack_port_t*> ports;
    std::vector<const float*> buffers;
    frame_ring<float> ring;  ///< one second
    std::atomic<bool> gone{false};
    jack_client_t* client = nullptr;
    jack_nframes_t expected = 0;
    std::atomic<bool> joined{false};
    std::atomic<bool> running{false};
    int cycles_to_wait = 2;  ///< until the server has taken over the connections: silence that nobody played
  };
  struct close_client {
    void operator()(jack_client_t* client) const noexcept { jack_client_close(client); }
  };

  static int process(jack_nframes_t frames, void* argument) noexcept {
    auto& s = *static_cast<shared*>(argument);
    if (!s.joined.load(std::memory_order_acquire)) return 0;
    if (s.cycles_to_wait > 0) return --s.cycles_to_wait, 0;
    const jack_nframes_t now = jack_last_frame_time(s.client);
    if (s.running.load(std::memory_order_relaxed) && now != s.expected) s.ring.lost(now - s.expected);
    s.running.store(true, std::memory_order_release);
    s.expected = now + frames;
    for (std::size_t c = 0; c < s.ports.size(); ++c)
      s.buffers[c] = static_cast<const float*>(jack_port_get_buffer(s.ports[c], frames));
    s.ring.write(frames, [&](std::size_t i, std::size_t c) { return s.buffers[c][i]; });
    return 0;
  }

  [[nodiscard]] std::optional<failure> start(const std::vector<std::string>& from) {
    jack_client_t* client = client_.get();
    state_->client = client;
    jack_set_process_callback(client, &jack_source::process, state_.get());
    jack_on_shutdown(
        client, [](void* s) { static_cast<shared*>(s)->gone.store(true, std::memory_order_release); }, state_.get());
    for (std::size_t c = 0; c < from.size(); ++c) {
      state_->ports[c] =
          jack_port_register(client, ("in_" + std::to_string(c + 1)).c_str(), JACK_DEFAULT_AUDIO_TYPE, JackPortIsInput, 0);
      if (state_->ports[c] == nullptr) return failure{"jack: no more ports"};
    }
    if (jack_activate(client) != 0) return failure{"jack: the client cannot be started"};
    for (std::size_t c = 0; c < from.size(); ++c)
      if (!from[c].empty() && jack_connect(client, from[c].c_str(), jack_port_name(state_->ports[c])) != 0)
        return failure{"jack: there is no port " + from[c] + " to listen to"};
    state_->joined.store(true, std::memory_order_release);
    wait_for_frames();
    return std::nullopt;
  }
  /// What is played once a source is open is in it whole. A server that stands still is met by read's patience.
  void wait_for_frames() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{2};
    while (!state_->running.load(std::memory_order_acquire) && !state_->gone.load(std::memory_order_acquire) &&
           std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }

  std::unique_ptr<shared> state_;
  std::unique_ptr<jack_client_t, close_client> client_;  ///< last: closed first
};

static_assert(FrameSource<jack_source>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
