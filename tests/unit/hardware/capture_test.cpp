// SPDX-License-Identifier: MIT
#include <rosin/hardware/capture.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>

namespace {

/// Counts; loses five frames before each hundredth, ends after a thousand.
struct counting_source {
  bool live = true;
  std::uint64_t at = 0;
  rosin::frame_format format() const { return {1000, 1, 16, false, live}; }
  rosin::frame_read read(std::span<double> out, std::chrono::milliseconds) {
    if (at >= 1000) return {0, 0, true, "pulled"};
    rosin::frame_read got{std::min<std::size_t>(out.size(), 10), at % 100 == 0 && at > 0 ? 5U : 0U, false, {}};
    for (std::size_t i = 0; i < got.frames; ++i) out[i] = static_cast<double>(at + i);
    at += got.frames;
    return got;
  }
};
static_assert(rosin::FrameSource<counting_source>);

}  // namespace

TEST_CASE("a patient source loses nothing, however slow the reader; gaps keep their place; the end says why") {
  rosin::capture<counting_source> from{counting_source{false}, 0.05};
  std::vector<double> block(7);
  double next = 0;
  std::uint64_t lost = 0;
  bool right = true;
  std::string why;
  for (;;) {
    const auto got = from.read(block, std::chrono::seconds{5});
    lost += got.lost;
    right = right && (got.lost == 0 || std::fmod(next, 100) == 0);
    for (std::size_t i = 0; i < got.frames; ++i) right = right && block[i] == next++;
    why += got.problem;
    if (got.ended) break;
    if (next < 50) std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  CHECK(right);
  CHECK(next == 1000);
  CHECK(lost == 45);
  CHECK(why == "pulled");
}

TEST_CASE("a live source overruns where nobody listens: said, counted, and what was there before stays") {
  rosin::capture<counting_source> from{counting_source{true}, 0.1};
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  std::vector<double> block(1000);
  std::uint64_t lost = 0, frames = 0;
  std::string why;
  for (bool over = false; !over;) {
    const auto got = from.read(block, std::chrono::seconds{5});
    lost += got.lost;
    frames += got.frames;
    why += got.problem;
    over = got.ended;
  }
  CHECK(frames + lost == 1045);
  CHECK(frames == 100);
  CHECK(why.find("overrun") != std::string::npos);
  CHECK(from.fullest() > 0.9);
}

namespace {

/// Never comes back from a read until it is let go.
struct stuck_source {
  std::shared_ptr<std::atomic<bool>> free;
  rosin::frame_format format() const { return {1000, 1, 16, false, false}; }
  rosin::frame_read read(std::span<double>, std::chrono::milliseconds) {
    while (!*free) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    return {0, 0, true, {}};
  }
};
/// Gives its own number, a frame a millisecond.
struct clock_source {
  bool live = true;
  double at = 0;
  rosin::frame_format format() const { return {1000, 1, 16, false, live}; }
  rosin::frame_read read(std::span<double> out, std::chrono::milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
    out[0] = at++;
    return {1, 0, false, {}};
  }
};

}  // namespace

TEST_CASE("a source that does not come back is left behind") {
  const auto free = std::make_shared<std::atomic<bool>>(false);
  const auto begin = std::chrono::steady_clock::now();
  { const rosin::capture<stuck_source> from{stuck_source{free}}; }
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{900});
  *free = true;
}

TEST_CASE("what a live source gave before may be skipped; what a file gave stays") {
  for (const bool live : {true, false}) {
    rosin::capture<clock_source> from{clock_source{live}};
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
    from.skip();
    std::vector<double> block(1000);
    const auto got = from.read(block, std::chrono::seconds{1});
    REQUIRE(got.frames > 0);
    if (live) CHECK(block[0] > 20);
    else CHECK(block[0] == 0);
  }
}
