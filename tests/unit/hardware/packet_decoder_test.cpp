// SPDX-License-Identifier: MIT
#include <rosin/hardware/packet_decoder.hpp>

#include <doctest/doctest.h>

#include <random>

namespace {

using bytes = std::vector<std::uint8_t>;

/// Packets whose samples are their own frame numbers, of 1 to 40 frames.
struct device {
  explicit device(unsigned seed) : random{seed} {}
  bytes packet() {
    std::array<std::int32_t, 80> samples{};
    const auto frames = static_cast<std::uint16_t>(1 + random() % 40);
    for (unsigned i = 0; i < frames; ++i) {
      samples[2 * i] = static_cast<std::int32_t>((sent + i) % 8000000);
      samples[2 * i + 1] = -samples[2 * i];
    }
    sent += frames;
    const std::size_t size = encoder.encode(samples.data(), frames);
    return {encoder.data(), encoder.data() + size};
  }
  std::mt19937 random;
  std::uint64_t sent = 0;
  rosin::packet_encoder<600> encoder{{.stream = 3, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
};

void push_in_pieces(rosin::packet_decoder& to, const bytes& line, std::mt19937& random) {
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t piece = std::min<std::size_t>(line.size() - at, 1 + random() % 60);
    to.push(std::span{line}.subspan(at, piece));
    at += piece;
  }
}

/// Every frame either comes, with the number it was sent with, or is announced as lost.
std::uint64_t check_account(rosin::packet_decoder& from) {
  std::uint64_t at = 0;
  while (const auto packet = from.next()) {
    at += packet->lost;
    for (std::size_t i = 0; i < packet->samples.size(); i += 2, ++at) {
      REQUIRE(packet->samples[i] * 0x1p23 == static_cast<double>(at % 8000000));
      REQUIRE(packet->samples[i + 1] == -packet->samples[i]);
    }
  }
  return at;
}

}  // namespace

TEST_CASE("a clean line, cut into pieces at random") {
  device d{1};
  rosin::packet_decoder decoder;
  for (int i = 0; i < 500; ++i) push_in_pieces(decoder, d.packet(), d.random);
  CHECK(check_account(decoder) == d.sent);
  CHECK(decoder.counts().packets == 500);
  CHECK(decoder.counts().corrupted + decoder.counts().lost_frames + decoder.counts().doubled == 0);
}

TEST_CASE("lost, cut, doubled and corrupted packets: every missing frame is announced, no wrong one comes") {
  device d{2};
  rosin::packet_decoder decoder;
  std::uint64_t lost = 0, doubled = 0, damaged = 0, gaps = 0;
  bool in_gap = false;
  for (int i = 0; i < 4000; ++i) {
    const std::uint64_t before = d.sent;
    bytes packet = d.packet();
    const std::uint64_t frames = d.sent - before;
    const auto fate = i == 0 || i == 3999 ? 99UL : d.random() % 20;
    if (fate == 1) packet.resize(1 + d.random() % (packet.size() - 2));  // cut: runs into the next
    else if (fate == 2) packet[d.random() % (packet.size() - 1)] ^= static_cast<std::uint8_t>(1U << d.random() % 8);
    else if (fate == 3) {  // a burst
      for (std::size_t k = packet.size() / 3; k < packet.size() / 2; ++k)
        packet[k] = static_cast<std::uint8_t>(1 + d.random() % 255);
    }
    const bool gone = fate == 0 || fate == 2 || fate == 3;
    if (fate != 0) push_in_pieces(decoder, packet, d.random);
    if (fate == 1) {  // and takes the next with it
      const std::uint64_t first = d.sent;
      push_in_pieces(decoder, d.packet(), d.random);
      lost += frames + (d.sent - first);
      ++damaged;
    } else if (gone) {
      lost += frames;
      damaged += fate == 0 ? 0 : 1;
    } else if (fate == 4) {
      push_in_pieces(decoder, packet, d.random);
      ++doubled;
    }
    const bool missing = gone || fate == 1;
    gaps += missing && !in_gap ? 1 : 0;
    in_gap = missing;
  }
  CHECK(check_account(decoder) == d.sent);
  CHECK(decoder.counts().lost_frames == lost);
  CHECK(decoder.counts().frames == d.sent - lost);
  CHECK(decoder.counts().gaps == gaps);
  CHECK(decoder.counts().doubled == doubled);
  CHECK(decoder.counts().corrupted >= damaged);  // a flipped bit may make a zero: then one packet becomes two pieces
  CHECK(decoder.counts().corrupted <= 2 * damaged);
  CHECK(lost > 1000);
}

TEST_CASE("the frame counter may wrap; a device that starts anew is named; whoever joins late begins with a whole packet") {
  rosin::packet_decoder decoder;
  rosin::packet_encoder<100> first{{.stream = 1, .channels = 1, .bits = 16, .rate_mHz = 48000000}, 0xfffffffeU};
  const std::array<std::int32_t, 3> samples{1, 2, 3};
  std::size_t size = first.encode(samples.data(), 3);
  decoder.push({first.data() + 5, size - 5});  // joined in the middle
  CHECK_FALSE(decoder.next());
  CHECK(decoder.counts().corrupted == 0);
  for (int i = 0; i < 2; ++i) {
    size = first.encode(samples.data(), 3);
    decoder.push({first.data(), size});
    const auto packet = decoder.next();
    REQUIRE(packet);
    CHECK(packet->lost == 0);
    CHECK(packet->format.sample_rate_Hz == 48000);
  }
  first.skip(5);  // the device itself could not send
  size = first.encode(samples.data(), 3);
  decoder.push({first.data(), size});
  CHECK(decoder.next()->lost == 5);
  rosin::packet_encoder<100> second{{.stream = 2, .channels = 1, .bits = 16, .rate_mHz = 48000000}};
  size = second.encode(samples.data(), 3);
  decoder.push({second.data(), size});
  const auto packet = decoder.next();
  REQUIRE(packet);
  CHECK(packet->restarted);
  CHECK(decoder.counts().restarts == 1);
}

TEST_CASE("noise makes no packet and no memory") {
  rosin::packet_decoder decoder;
  std::mt19937 random{3};
  bytes noise(300000);
  for (auto& b : noise) b = static_cast<std::uint8_t>(random());
  decoder.push(noise);
  std::fill(noise.begin(), noise.end(), std::uint8_t{1});  // no zero at all
  decoder.push(noise);
  CHECK_FALSE(decoder.next());
  CHECK(decoder.counts().packets == 0);
  device d{4};
  const bytes packet = d.packet(), zero{0};
  decoder.push(zero);
  decoder.push(packet);
  CHECK(decoder.next());
}
