// SPDX-License-Identifier: MIT
#include <rosin/hardware/deadline.hpp>

#include <doctest/doctest.h>

#include <thread>

TEST_CASE("a deadline is over when its time is, or at once when somebody asks for an end; slices are short") {
  using std::chrono::milliseconds;
  const rosin::deadline soon{milliseconds{30}};
  CHECK_FALSE(soon.over());
  CHECK(soon.slice() <= milliseconds{30});
  std::this_thread::sleep_for(milliseconds{31});
  CHECK(soon.over());
  CHECK_FALSE(soon.stopped());
  CHECK(soon.slice() == milliseconds{0});
  std::atomic<bool> stop{false};
  const rosin::deadline late{milliseconds{100000}, &stop};
  CHECK(late.slice() == milliseconds{50});
  stop = true;
  CHECK(late.over());
  CHECK(late.stopped());
}
