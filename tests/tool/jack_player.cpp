// SPDX-License-Identifier: MIT
//
// jack_player FILE: plays a recording round and round on ports player:1, player:2, ... of the JACK server that
// JACK_DEFAULT_SERVER names, until standard input ends. Says "ready" once it plays.
#include <rosin/adapt/audio_sndfile.hpp>

#include <jack/jack.h>

#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

namespace {

struct player {
  std::vector<jack_port_t*> ports;
  std::vector<std::vector<double>> channels;
  std::size_t at = 0;

  static int process(jack_nframes_t frames, void* self) {
    auto& p = *static_cast<player*>(self);
    const std::size_t length = p.channels.front().size();
    for (std::size_t c = 0; c < p.ports.size(); ++c) {
      auto* out = static_cast<float*>(jack_port_get_buffer(p.ports[c], frames));
      for (jack_nframes_t i = 0; i < frames; ++i) out[i] = static_cast<float>(p.channels[c][(p.at + i) % length]);
    }
    p.at = (p.at + frames) % length;
    return 0;
  }
};

}  // namespace

int main(int count, char** words) {
  if (count != 2) return 2;
  const auto played = rosin::read_audio(words[1]);
  if (!played) return std::fprintf(stderr, "%s\n", played.error().c_str()), 1;
  jack_set_error_function([](const char*) {});
  jack_set_info_function([](const char*) {});
  jack_client_t* client = nullptr;
  for (int i = 0; i < 200 && client == nullptr; ++i) {  // the server may still be on its way
    client = jack_client_open("player", JackNoStartServer, nullptr);
    if (client == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  if (client == nullptr) return std::fprintf(stderr, "no server\n"), 1;
  player p;
  for (std::size_t c = 0; c < played->channels.size(); ++c) {
    p.channels.push_back(played->channels[c]);
    p.ports.push_back(jack_port_register(client, std::to_string(c + 1).c_str(), JACK_DEFAULT_AUDIO_TYPE, JackPortIsOutput, 0));
  }
  jack_set_process_callback(client, &player::process, &p);
  if (jack_activate(client) != 0) return 1;
  std::puts("ready");
  std::fflush(stdout);
  while (std::getchar() != EOF) {
  }
  jack_client_close(client);
}
