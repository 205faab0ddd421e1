// SPDX-License-Identifier: MIT
#include <rosin/hardware/serial_source.hpp>

#include <doctest/doctest.h>

#include <rosin/hardware/pseudo_terminal.hpp>

#include <random>
#include <thread>

namespace {

constexpr std::uint64_t frames = 128000;

/// Sends frames that hold their own number, and treats some packets badly. The last one always comes whole.
void play_device(const rosin::byte_link& line, std::uint64_t& harmed) {
  std::mt19937 random{5};
  rosin::packet_encoder<512> encoder{{.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
  std::array<std::int32_t, 128> samples{};
  for (std::uint64_t at = 0; at < frames; at += 64) {
    for (std::uint64_t i = 0; i < 64; ++i) {
      samples[2 * i] = static_cast<std::int32_t>(at + i);
      samples[2 * i + 1] = -samples[2 * i];
    }
    std::string packet{reinterpret_cast<const char*>(encoder.data()), encoder.encode(samples.data(), 64)};
    const auto fate = at == 0 || at + 64 >= frames ? 99UL : random() % 40;
    if (fate == 0) packet.clear();
    if (fate == 1) packet.erase(random() % 100, 50);
    if (fate == 2) packet[random() % 300] = 'x';
    if (fate == 3) packet += packet;
    harmed += fate < 3 ? 1 : 0;
    if (line.write(packet)) return;
  }
}

}  // namespace

TEST_CASE("over a pseudo-terminal with lost, cut, corrupted and doubled packets, every frame comes or is announced as lost") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  auto link = rosin::byte_link::open(pair->path(), 921600);
  REQUIRE(link);
  std::uint64_t harmed = 0;
  std::jthread device{[&] { play_device(pair->device(), harmed); }};
  auto source = rosin::serial_source::open(*std::move(link));
  REQUIRE(source);
  CHECK(source->format().sample_rate_Hz == 128000);
  CHECK(source->format().bits == 24);
  std::vector<double> block(2 * 500);
  std::uint64_t at = 0, lost = 0;
  bool right = true;
  while (at < frames) {
    const auto got = source->read(block, std::chrono::seconds{2});
    REQUIRE(got.frames > 0);
    at += got.lost;
    lost += got.lost;
    for (std::size_t i = 0; i < got.frames; ++i, ++at)
      right = right && block[2 * i] * 0x1p23 == static_cast<double>(at) && block[2 * i + 1] == -block[2 * i];
  }
  device.join();
  CHECK(right);
  CHECK(at == frames);
  CHECK(source->counts().lost_frames == lost);
  CHECK(lost >= 64 * harmed * 9 / 10);
  CHECK(lost % 64 == 0);
  CHECK(source->counts().doubled > 10);
}

TEST_CASE("a line without packets, a device that is pulled and one that changes its mind") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  auto link = rosin::byte_link::open(pair->path(), 921600);
  REQUIRE_FALSE(pair->device().write("hello, this is a modem\r\n"));
  const auto none = rosin::serial_source::open(*std::move(link), std::chrono::milliseconds{60});
  REQUIRE_FALSE(none);
  CHECK(none.error().find("no packet of frames came: something else talks (hello, this is a modem)") != std::string::npos);

  link = rosin::byte_link::open(pair->path(), 921600);
  REQUIRE(link);
  const std::array<std::int32_t, 4> samples{};
  rosin::packet_encoder<100> encoder{{.stream = 1, .channels = 2, .bits = 16, .rate_mHz = 1000000}};
  const auto send = [&](auto& from) {
    return pair->device().write({reinterpret_cast<const char*>(from.data()), from.encode(samples.data(), 2)});
  };
  REQUIRE_FALSE(pair->device().write(std::string(1, '\0')));
  REQUIRE_FALSE(send(encoder));
  auto source = rosin::serial_source::open(*std::move(link));
  REQUIRE(source);
  std::vector<double> block(20);
  CHECK(source->read(block, std::chrono::seconds{1}).frames == 2);
  SUBCASE("pulled") {
    { const auto gone = *std::move(pair); }
    const auto got = source->read(block, std::chrono::seconds{1});
    CHECK(got.ended);
    CHECK(got.problem.find("the device is gone") != std::string::npos);
  }
  SUBCASE("changed") {
    rosin::packet_encoder<100> other{{.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 1000000}, 2};
    REQUIRE_FALSE(send(other));
    const auto got = source->read(block, std::chrono::seconds{1});
    CHECK(got.ended);
    CHECK(got.problem.find("changed in mid-stream") != std::string::npos);
  }
}

TEST_CASE("a line on which the sled is, and a wait that somebody ends") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  std::atomic<bool> stop{false};
  const auto begin = std::chrono::steady_clock::now();
  std::jthread sled{[&](const std::stop_token& over) {
    std::array<std::uint8_t, 16> bytes{};
    while (!over.stop_requested()) {
      const auto got = pair->device().read(bytes, std::chrono::milliseconds{5});
      if (got.bytes == 1 && bytes[0] == '?') (void)pair->device().write("<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n");
    }
  }};
  SUBCASE("swapped") {
    const auto none = rosin::serial_source::open(*rosin::byte_link::open(pair->path(), 921600), std::chrono::seconds{10}, &stop);
    REQUIRE_FALSE(none);
    CHECK(none.error().find("a G-code controller talks (<Idle|") != std::string::npos);
  }
  SUBCASE("stopped") {
    stop = true;
    const auto none = rosin::serial_source::open(*rosin::byte_link::open(pair->path(), 921600), std::chrono::seconds{10}, &stop);
    REQUIRE_FALSE(none);
    CHECK(none.error().find("stopped before") != std::string::npos);
  }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{1500});
}
