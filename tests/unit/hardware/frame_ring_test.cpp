// SPDX-License-Identifier: MIT
#include <rosin/hardware/frame_ring.hpp>

#include <doctest/doctest.h>

#include <array>
#include <random>
#include <thread>
#include <vector>

TEST_CASE("what does not fit is lost whole, and the reader learns of it at its place") {
  rosin::frame_ring<double> ring{1, 4};
  std::array<double, 8> out{};
  CHECK(ring.write(3, [](std::size_t i, std::size_t) { return static_cast<double>(i); }));
  CHECK_FALSE(ring.write(2, [](std::size_t, std::size_t) { return -1.0; }));
  ring.lost(5);
  auto got = ring.read(std::span{out}.first(2));
  CHECK(got.frames == 2);
  CHECK(got.lost == 0);
  CHECK(ring.write(2, [](std::size_t i, std::size_t) { return 10.0 + static_cast<double>(i); }));
  got = ring.read(out);  // up to the gap
  CHECK(got.frames == 1);
  CHECK(out[0] == 2);
  got = ring.read(out);
  CHECK(got.lost == 7);
  CHECK(got.frames == 2);
  CHECK(out[1] == 11);
  ring.lost(3);
  CHECK(ring.read(out).lost == 0);
  CHECK(ring.trailing() == 3);
}

TEST_CASE("two threads: every frame comes in order or is announced") {
  rosin::frame_ring<double> ring{2, 97};
  static constexpr std::uint64_t total = 300000;
  std::jthread writer{[&] {
    std::mt19937 random{1};
    for (std::uint64_t at = 0; at < total;) {
      const std::uint64_t count = std::min<std::uint64_t>(total - at, 1 + random() % 40);
      while (random() % 20 != 0 && ring.room() < count) std::this_thread::yield();
      if (random() % 50 == 0) ring.lost(count);
      else ring.write(count, [&](std::size_t i, std::size_t c) { return static_cast<double>(at + i) * (c == 0 ? 1 : -1); });
      at += count;
      if (random() % 20 == 0) std::this_thread::yield();
    }
    while (!ring.write(1, [](std::size_t, std::size_t c) { return static_cast<double>(total) * (c == 0 ? 1 : -1); })) {
      ring.lost(static_cast<std::uint64_t>(-1));  // that one was tried again: it is not missing
      std::this_thread::yield();
    }
  }};
  std::array<double, 66> out{};
  std::uint64_t at = 0, got = 0;
  bool right = true;
  while (at <= total) {
    const auto part = ring.read(out);
    at += part.lost;
    for (std::size_t i = 0; i < part.frames; ++i, ++at)
      right = right && out[2 * i] == static_cast<double>(at) && out[2 * i + 1] == -static_cast<double>(at);
    got += part.frames;
    if (!right) break;
    if (part.frames == 0) std::this_thread::yield();
  }
  CHECK(right);
  CHECK(at == total + 1);
  CHECK(got > 1000);
}
