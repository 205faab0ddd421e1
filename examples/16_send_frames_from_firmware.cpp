// SPDX-License-Identifier: MIT
//
// Both ends of a serial line: a microcontroller packs frames, without heap or library; the computer unpacks them and knows what
// the line has lost.
//
#include <rosin/hardware/frame_packet.hpp>
#include <rosin/hardware/packet_decoder.hpp>

#include <cstdio>

int main() {
  // in the firmware: 64 frames of two channels, 24 bits, at 128 kHz; `stream` differs from start to start
  rosin::packet_encoder<rosin::packet_room(64, 2, 24)> packets{{.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
  std::array<std::int32_t, 128> from_converter{};

  rosin::packet_decoder decoder;  // on the computer
  for (int i = 0; i < 10; ++i) {
    for (std::size_t k = 0; k < 128; ++k) from_converter[k] = 64 * i + static_cast<std::int32_t>(k / 2);
    const std::size_t bytes = packets.encode(from_converter.data(), 64);
    if (i == 4) continue;  // this one never arrives
    decoder.push({packets.data(), bytes});
  }
  std::uint64_t frames = 0, lost = 0;
  while (const auto packet = decoder.next()) {
    frames += packet->samples.size() / 2;
    lost += packet->lost;
  }
  std::printf("%llu frames arrived, %llu are missing\n", static_cast<unsigned long long>(frames),
              static_cast<unsigned long long>(lost));
  return lost == 64 && frames == 576 ? 0 : 1;
}
