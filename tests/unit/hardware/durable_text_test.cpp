// SPDX-License-Identifier: MIT
#include <rosin/hardware/durable_text.hpp>

#include <doctest/doctest.h>

#include <rosin/hardware/file_lock.hpp>
#include <support/temporary_folder.hpp>

#include <sys/wait.h>
#include <csignal>
#include <functional>
#include <set>
#include <sstream>

namespace hardware_durable_text {

using text = std::optional<std::string>;

/// A system on which somebody else acts right before two names are exchanged, or on which a call fails.
struct meddled : rosin::posix_calls {
  static inline std::function<void()> before;
  static inline int sync_error = 0, rename_error = 0, exchange_error = 0;
  static int failing(int with) {
    errno = with;
    return -1;
  }
  static int sync(int fd) { return sync_error != 0 ? failing(sync_error) : posix_calls::sync(fd); }
  static int rename(const std::string& from, const std::string& to) {
    return rename_error != 0 ? failing(rename_error) : posix_calls::rename(from, to);
  }
  static int exchange(const std::string& a, const std::string& b) {
    if (auto act = std::exchange(before, nullptr)) act();
    return exchange_error != 0 ? failing(exchange_error) : posix_calls::exchange(a, b);
  }
};

rosin::outcome<std::string> add_x(const text& now) { return now.value_or("") + "x"; }

std::size_t files_in(const test::temporary_folder& folder) {
  const std::filesystem::directory_iterator all{folder.str()};
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

TEST_CASE("the text is there, whole, and nothing else is left; what cannot be written is named") {
  const test::temporary_folder folder;
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", "one"));
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", "two"));
  CHECK(folder.read("a") == "two");
  REQUIRE_FALSE(rosin::change_durably(folder / "a", add_x));
  CHECK(folder.read("a") == "twox");
  CHECK(files_in(folder) == 1);
  const auto why = rosin::replace_durably(folder / "none/a", "x");
  REQUIRE(why);
  CHECK(why->message.find("none/a: cannot be replaced: No such file") != std::string::npos);
  const auto refused =
      rosin::change_durably(folder / "a", [](const text&) { return rosin::outcome<std::string>{rosin::failure{"no"}}; });
  REQUIRE(refused);
  CHECK(refused->message == "no");
  CHECK(files_in(folder) == 1);
}

TEST_CASE("mode and link stay") {
  const test::temporary_folder folder;
  std::filesystem::create_directory(folder / "else");
  folder.write("else/a", "one");
  std::filesystem::permissions(folder / "else/a", std::filesystem::perms{0640});
  std::filesystem::create_symlink("else/a", folder / "a");
  REQUIRE_FALSE(rosin::change_durably(folder / "a", add_x));
  CHECK(std::filesystem::is_symlink(folder / "a"));
  CHECK(folder.read("else/a") == "onex");
  CHECK(std::filesystem::status(folder / "else/a").permissions() == std::filesystem::perms{0640});
}

TEST_CASE("another file that an editor puts there at the last moment is what the change is made on") {
  const test::temporary_folder folder;
  for (const bool exchanges : {true, false}) {
    meddled::exchange_error = exchanges ? 0 : EINVAL;
    folder.write("a", "one");
    meddled::before = [&] {
      folder.write("b", "edited");
      REQUIRE(std::rename((folder / "b").c_str(), (folder / "a").c_str()) == 0);
    };
    REQUIRE_FALSE(rosin::change_durably<meddled>(folder / "a", add_x));
    CHECK(folder.read("a") == "editedx");
    CHECK(files_in(folder) == 1);
  }
  meddled::exchange_error = 0;
  meddled::before = [&] { ::unlink((folder / "a").c_str()); };
  REQUIRE_FALSE(rosin::change_durably<meddled>(folder / "a", add_x));
  CHECK(folder.read("a") == "x");
}

TEST_CASE("an editor's text that the change cannot be made on has its place again") {
  const test::temporary_folder folder;
  folder.write("a", "one");
  meddled::before = [&] { folder.write("a", "half"); };
  const auto why = rosin::change_durably<meddled>(folder / "a", [](const text& now) {
    return *now == "half" ? rosin::outcome<std::string>{rosin::failure{"half a text"}} : add_x(now);
  });
  REQUIRE(why);
  CHECK(folder.read("a") == "half");
  CHECK(files_in(folder) == 1);
}

TEST_CASE("a call that fails is told with its reason; the old text is there, and nothing beside it") {
  const test::temporary_folder folder;
  folder.write("a", "one");
  const auto said = [&] {
    const auto why = rosin::change_durably<meddled>(folder / "a", add_x);
    meddled::sync_error = meddled::rename_error = meddled::exchange_error = 0;
    CHECK(folder.read("a") == "one");
    CHECK(files_in(folder) == 1);
    return why ? why->message.substr(folder.str().size() + 1) : "";
  };
  meddled::sync_error = EIO;
  CHECK(said() == "a: cannot be put on the disk: Input/output error");
  meddled::exchange_error = ESTALE;
  CHECK(said() == "a: cannot be replaced: Stale file handle");
  meddled::rename_error = EACCES;
  CHECK(said() == "a: cannot be replaced: Permission denied");
}

TEST_CASE("what a kill left is cleared away, but for what stands nowhere else") {
  const test::temporary_folder folder;
  folder.write("a", "1\n2\n3\n");
  folder.write("a.part", "1\n2\n3\n4");
  folder.write("a.swap", "1\n3\n");
  CHECK(rosin::clear_remnants(folder / "a").empty());
  CHECK(files_in(folder) == 1);
  folder.write("a.swap", "1\nmine\n");
  CHECK(rosin::clear_remnants(folder / "a") == std::vector{folder / "a.saved-1"});
  folder.write("a.swap", "3\n1\n");
  CHECK(rosin::clear_remnants(folder / "a") == std::vector{folder / "a.saved-2"});
  CHECK(folder.read("a.saved-1") == "1\nmine\n");
  CHECK(folder.read("a") == "1\n2\n3\n");
}

TEST_CASE("a file that is being written is waited for") {
  const test::temporary_folder folder;
  folder.write("a", "x");
  rosin::wait_until_settled(folder / "a");
  struct stat is {};
  REQUIRE(::stat((folder / "a").c_str(), &is) == 0);
  const auto age = std::chrono::system_clock::now().time_since_epoch() - std::chrono::seconds{is.st_mtim.tv_sec} -
                   std::chrono::nanoseconds{is.st_mtim.tv_nsec};
  CHECK(age > std::chrono::milliseconds{50});
  rosin::wait_until_settled(folder / "none");
}

/// Puts lines "<program> <number>" into a file, under the lock of its folder.
pid_t begin_program(const test::temporary_folder& folder, const std::string& name, int lines) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  for (int i = 0; i < lines; ++i) {
    const auto mine = rosin::file_lock::take(folder.str(), std::chrono::seconds{60});
    const auto bad = rosin::change_durably(folder / "a", [&](const text& now) {
      return rosin::outcome<std::string>{now.value_or("") + name + " " + std::to_string(i) + "\n"};
    });
    if (!mine || bad) ::_exit(1);
  }
  ::_exit(0);
}
bool ended_well(pid_t child) {
  int status = 1;
  ::waitpid(child, &status, 0);
  return status == 0;
}
std::multiset<std::string> lines_of(const std::string& whole) {
  std::istringstream in{whole};
  std::multiset<std::string> out;
  for (std::string line; std::getline(in, line);) out.insert(line);
  return out;
}

TEST_CASE("two programs under a lock: each line is there once") {
  const test::temporary_folder folder;
  const std::array children{begin_program(folder, "p", 40), begin_program(folder, "q", 40)};
  for (const pid_t child : children) CHECK(ended_well(child));
  const auto lines = lines_of(folder.read("a"));
  CHECK(lines.size() == 80);
  for (int i = 0; i < 40; ++i)
    for (const char* name : {"p ", "q "}) CHECK(lines.count(name + std::to_string(i)) == 1);
}

TEST_CASE("an editor that knows of no lock: what it has written is never lost") {
  const test::temporary_folder folder;
  folder.write("a", "");
  const std::array children{begin_program(folder, "p", 60), begin_program(folder, "q", 60)};
  std::vector<std::string> mine;  // in its window, whatever else the file says
  for (int i = 0; i < 100; ++i) {
    mine.push_back("e " + std::to_string(i));
    std::string whole = folder.read("a");
    const auto there = lines_of(whole);
    for (const auto& line : mine)
      if (!there.contains(line)) whole += line + "\n";
    folder.write("e", whole);
    REQUIRE(std::rename((folder / "e").c_str(), (folder / "a").c_str()) == 0);
    ::usleep(700);
  }
  for (const pid_t child : children) CHECK(ended_well(child));
  const auto lines = lines_of(folder.read("a"));
  for (const auto& line : mine) CHECK_MESSAGE(lines.contains(line), line);
  CHECK(files_in(folder) == 1);
}

TEST_CASE("killed while it is being replaced again and again: one of the texts is there, never a part") {
  const test::temporary_folder folder;
  const std::string one(30000, '1'), two(50000, '2');
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", one));
  for (int trial = 0; trial < 5; ++trial) {
    const pid_t child = ::fork();
    if (child == 0)
      for (bool first = true;; first = !first)
        if (rosin::replace_durably(folder / "a", first ? two : one)) ::_exit(1);
    ::usleep(static_cast<useconds_t>(3000 + 2311 * trial));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::string left = folder.read("a");
    CHECK((left == one || left == two));
    REQUIRE_FALSE(rosin::replace_durably(folder / "a", one));
    for (const char* remnant : rosin::text_remnants) CHECK_FALSE(std::filesystem::exists(folder / "a" + remnant));
  }
}

}  // namespace hardware_durable_text
