// SPDX-License-Identifier: MIT
#include <rosin/hardware/file_lock.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <sys/wait.h>
#include <csignal>
#include <vector>

namespace hardware_file_lock {

using std::chrono::milliseconds;

TEST_CASE("one holder at a time, of a file and of a folder, be they two threads or two programs") {
  const test::temporary_folder folder;
  for (const std::string& path : {folder.write("a", "x"), folder.str()}) {
    CHECK_FALSE(rosin::file_lock::held(path));
    {
      const auto mine = rosin::file_lock::take(path, milliseconds{0});
      REQUIRE(mine.has_value());
      CHECK(rosin::file_lock::held(path));
      const auto second = rosin::file_lock::take(path, milliseconds{20});
      CHECK(second.error() == path + ": another program is changing it, for longer than can be waited for");
    }
    CHECK_FALSE(rosin::file_lock::held(path));
    CHECK(rosin::file_lock::take(path, milliseconds{0}));
  }
  int both = 0, most = 0;
  std::vector<std::jthread> threads(4);
  std::atomic<int> inside{0};
  for (auto& t : threads)
    t = std::jthread{[&] {
      for (int i = 0; i < 50; ++i) {
        const auto mine = rosin::file_lock::take(folder.str(), std::chrono::seconds{20});
        most = std::max(most, ++inside), ++both;
        --inside;
      }
    }};
  threads.clear();
  CHECK(most == 1);
  CHECK(both == 200);
}

TEST_CASE("the lock of a killed program is free at once") {
  const test::temporary_folder folder;
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const auto mine = rosin::file_lock::take(folder.str(), milliseconds{0});
    if (::write(ends[1], "x", 1) != 1) ::_exit(1);
    for (;;) ::pause();
  }
  char ready = 0;
  REQUIRE(::read(ends[0], &ready, 1) == 1);
  CHECK(rosin::file_lock::held(folder.str()));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  CHECK_FALSE(rosin::file_lock::held(folder.str()));
  for (const int end : ends) ::close(end);
}

TEST_CASE("a stop ends the wait, and what is not there is named; of a pipe nobody holds the lock") {
  const test::temporary_folder folder;
  const auto mine = rosin::file_lock::take(folder.str(), milliseconds{0});
  const std::atomic<bool> stop{true};
  const auto begin = std::chrono::steady_clock::now();
  CHECK_FALSE(rosin::file_lock::take(folder.str(), std::chrono::seconds{60}, &stop));
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds{10});
  CHECK(rosin::file_lock::take(folder / "none", milliseconds{0}).error() == folder / "none" + ": No such file or directory");
  CHECK_FALSE(rosin::file_lock::held(folder / "none"));
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  CHECK_FALSE(rosin::file_lock::held(folder / "pipe"));
}

}  // namespace hardware_file_lock
