// SPDX-License-Identifier: MIT
#include <rosin/math/at_once.hpp>

#include <doctest/doctest.h>

#include <stdexcept>
#include <string>

TEST_CASE("each piece of work is done once, however many threads there are") {
  for (const int threads : {-1, 0, 1, 2, 7, 100}) {
    CAPTURE(threads);
    std::vector<int> done(50, 0);
    rosin::at_once(done.size(), threads, [&](std::size_t i) { ++done[i]; });
    CHECK(done == std::vector<int>(50, 1));
  }
  rosin::at_once(0, 4, [](std::size_t) { FAIL("nothing is to be done"); });
}

TEST_CASE("no number of threads stands for all cores") {
  CHECK(rosin::threads_for(3) == 3);
  CHECK(rosin::threads_for(0) == std::max(1U, std::thread::hardware_concurrency()));
}

TEST_CASE("more than one thread is at work, where more are allowed") {
  std::atomic<int> waiting{0};
  rosin::at_once(2, 2, [&](std::size_t) {
    for (++waiting; waiting < 2;) std::this_thread::yield();  // for ever, if one thread did both
  });
  CHECK(waiting == 2);
}

TEST_CASE("what is thrown first is thrown on, after all is done") {
  std::atomic<int> done{0};
  const auto work = [&](std::size_t i) {
    ++done;
    if (i == 3 || i == 5) throw std::runtime_error(std::to_string(i));
  };
  CHECK_THROWS_WITH(rosin::at_once(20, 3, work), "3");
  CHECK(done == 20);
}
