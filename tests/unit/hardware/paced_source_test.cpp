// SPDX-License-Identifier: MIT
#include <rosin/hardware/paced_source.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace {

struct counter {
  double next = 0;
  rosin::frame_format format() const { return {10000, 2, 16, false, false}; }
  rosin::frame_read read(std::span<double> out, std::chrono::milliseconds) {
    const std::size_t count = std::min<std::size_t>(out.size() / 2, static_cast<std::size_t>(3000 - next));
    for (std::size_t i = 0; i < count; ++i) out[2 * i] = out[2 * i + 1] = next++;
    return {count, 0, next >= 3000, {}};
  }
};

}  // namespace

TEST_CASE("frames come when their time has come, all of them, in order") {
  for (const double faster : {1.0, 4.0}) {
    rosin::paced_source<counter> from{counter{}, faster};
    CHECK_FALSE(from.format().live);  // it waits, as the file that it is
    std::vector<double> block(600);
    const auto begin = std::chrono::steady_clock::now();
    double next = 0;
    bool right = true, early = false;
    for (bool over = false; !over;) {
      const auto got = from.read(block, std::chrono::milliseconds{100});
      for (std::size_t i = 0; i < got.frames; ++i) right = right && block[2 * i] == next++;
      const std::chrono::duration<double> now = std::chrono::steady_clock::now() - begin;
      early = early || next > (now.count() + 0.002) * 10000 * faster + 20;
      over = got.ended;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    CHECK(right);
    CHECK(next == 3000);
    CHECK_FALSE(early);
    CHECK(took.count() > 0.28 / faster);
    CHECK(took.count() < 0.3 / faster + 1);
  }
}
