// SPDX-License-Identifier: MIT
#include <rosin/hardware/take_file.hpp>

#include <doctest/doctest.h>

#include <rosin/adapt/audio_sndfile.hpp>
#include <support/temporary_folder.hpp>

#include <random>

#include <sys/resource.h>
#include <sys/wait.h>
#include <csignal>

namespace {

const rosin::frame_format format{128000, 2, 24};
using bytes = std::vector<std::uint8_t>;

/// A disk that remembers what is in the cache only, write by write, since the last sync.
struct pretended_disk {
  struct pending {
    std::uint64_t offset;
    bytes what;
  };
  std::mutex mutex;
  bytes safe;
  std::vector<pending> cache;
  std::uint64_t size = 0;
  std::chrono::steady_clock::time_point last_sync;
  static inline pretended_disk* the;  ///< where create() writes

  /// What may lie there after the power failed: of each write since the last sync, all, a part or nothing.
  bytes after_power_cut(std::mt19937& random) {
    const std::scoped_lock lock{mutex};
    bytes out = safe;
    for (const auto& [offset, what] : cache) {
      const std::size_t part = random() % 3 == 0 ? 0 : random() % 2 == 0 ? what.size() : random() % (what.size() + 1);
      if (part == 0 || offset > out.size())
        continue;  // a file has no holes: what comes behind a missing piece is not there either
      out.resize(std::max<std::size_t>(out.size(), offset + part));
      std::copy_n(what.begin(), part, out.begin() + static_cast<std::ptrdiff_t>(offset));
    }
    return out;
  }
};

struct pretended_file {
  pretended_disk* disk;
  static rosin::outcome<pretended_file> create(const std::string&) { return pretended_file{pretended_disk::the}; }
  std::optional<rosin::failure> append(std::span<const std::uint8_t> what) {
    const std::scoped_lock lock{disk->mutex};
    disk->cache.push_back({disk->size, {what.begin(), what.end()}});
    disk->size += what.size();
    return std::nullopt;
  }
  std::optional<rosin::failure> write_at(std::uint64_t offset, std::span<const std::uint8_t> what) {
    const std::scoped_lock lock{disk->mutex};
    disk->cache.push_back({offset, {what.begin(), what.end()}});
    return std::nullopt;
  }
  std::optional<rosin::failure> sync() {
    const std::scoped_lock lock{disk->mutex};
    disk->safe.resize(std::max<std::size_t>(disk->safe.size(), disk->size));
    for (const auto& [offset, what] : disk->cache)
      std::copy(what.begin(), what.end(), disk->safe.begin() + static_cast<std::ptrdiff_t>(offset));
    disk->cache.clear();
    disk->last_sync = std::chrono::steady_clock::now();
    return std::nullopt;
  }
};

/// Frame n is n, -n in steps of the converter.
std::vector<double> numbered(std::uint64_t from, std::size_t count) {
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) {
    out.push_back(static_cast<double>((from + i) % 8000000) * 0x1p-23);
    out.push_back(-out.back());
  }
  return out;
}
bool is_numbered(const rosin::recording& r) {
  for (std::size_t i = 0; i < r.frames(); ++i)
    if (r.channels[0][i] * 0x1p23 != static_cast<double>(i % 8000000) || r.channels[1][i] != -r.channels[0][i]) return false;
  return true;
}

}  // namespace

TEST_CASE("what was written is what a reader finds, while it is written and at the end; nothing is overwritten") {
  const test::temporary_folder folder;
  auto take = rosin::take_file<>::create(folder / "a.wav", format);
  REQUIRE(take.has_value());
  REQUIRE_FALSE(take->write(numbered(0, 1001)));
  auto read = rosin::read_audio(folder / "a.wav");
  REQUIRE(read.has_value());
  CHECK(read->frames() == 1001);
  REQUIRE_FALSE(take->write(numbered(1001, 500)));
  REQUIRE_FALSE(take->finish());
  CHECK(take->frames() == 1501);
  read = rosin::read_audio(folder / "a.wav");
  REQUIRE(read.has_value());
  CHECK(read->frames() == 1501);
  CHECK(is_numbered(*read));
  CHECK_FALSE(rosin::take_file<>::create(folder / "a.wav", format));
}

TEST_CASE("power cuts at random moments: always a readable file, and nothing older than the last sync is missing") {
  const test::temporary_folder folder;
  std::mt19937 random{1};
  for (int trial = 0; trial < 40; ++trial) {
    pretended_disk disk;
    pretended_disk::the = &disk;
    auto take = rosin::take_file<pretended_file>::create("", format, std::chrono::milliseconds{4});
    REQUIRE(take.has_value());
    std::uint64_t at = 0;
    const unsigned long blocks = 1 + random() % 60;
    for (unsigned long i = 0; i < blocks; ++i) {
      const std::size_t count = 1 + random() % 300;
      REQUIRE_FALSE(take->write(numbered(at, count)));
      at += count;
      if (random() % 4 == 0) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    const bool done = trial % 8 == 7;
    if (done) REQUIRE_FALSE(take->finish());
    const bytes left = disk.after_power_cut(random);
    std::size_t safe = 0;
    {
      const std::scoped_lock lock{disk.mutex};
      safe = disk.safe.size();
    }
    folder.write("a.wav", {reinterpret_cast<const char*>(left.data()), left.size()});
    if (safe < rosin::wav_head_bytes + 6) continue;
    const auto read = rosin::read_audio(folder / "a.wav");
    REQUIRE_MESSAGE(read.has_value(), read.error());
    CHECK(is_numbered(*read));
    CHECK(read->frames() >= (std::min(safe, left.size()) - rosin::wav_head_bytes) / 6);
    if (done) CHECK(read->frames() == at);
  }
}

TEST_CASE("syncs come at the cadence") {
  pretended_disk disk;
  pretended_disk::the = &disk;
  auto take = rosin::take_file<pretended_file>::create("", format, std::chrono::milliseconds{20});
  REQUIRE(take.has_value());
  double longest = 0;
  for (int i = 0; i < 60; ++i) {
    REQUIRE_FALSE(take->write(numbered(0, 10)));
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
    const std::scoped_lock lock{disk.mutex};
    longest = std::max(longest, std::chrono::duration<double>(std::chrono::steady_clock::now() - disk.last_sync).count());
  }
  CHECK(longest < 0.5);
  CHECK(longest > 0.005);
}

TEST_CASE("killed at a random moment: what was written is there, readable, and can be mended") {
  const test::temporary_folder folder;
  std::mt19937 random{2};
  for (int trial = 0; trial < 6; ++trial) {
    const std::string path = folder / ("k" + std::to_string(trial) + ".wav");
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
      auto file = rosin::posix_file::create(path);
      if (!file || file->append(rosin::make_wav_head(format, std::nullopt))) ::_exit(1);
      bytes block(6 * 37);
      for (std::uint64_t at = 0;; at += 37) {
        const auto samples = numbered(at, 37);
        for (std::size_t i = 0; i < samples.size(); ++i) rosin::put_sample(&block[3 * i], samples[i], format);
        if (file->append(block) || ::write(ends[1], &at, sizeof at) != sizeof at) ::_exit(1);
      }
    }
    ::close(ends[1]);
    const std::uint64_t until = 10 + random() % 2000;
    std::uint64_t at = 0, last = 0;
    for (std::uint64_t i = 0; i < until && ::read(ends[0], &at, sizeof at) == sizeof at; ++i) last = at;
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::close(ends[0]);
    auto read = rosin::read_audio(path);
    REQUIRE_MESSAGE(read.has_value(), read.error());
    CHECK(is_numbered(*read));
    CHECK(read->frames() >= last + 37);
    const auto frames = read->frames();
    const auto mended = rosin::mend_take(path);
    REQUIRE(mended.has_value());
    CHECK(*mended);
    read = rosin::read_audio(path);
    REQUIRE(read.has_value());
    CHECK(read->frames() == frames);
    CHECK_FALSE(*rosin::mend_take(path));
  }
}

TEST_CASE("a full disk is said at once, and what was recorded stays") {
  const test::temporary_folder folder;
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{60000, before.rlim_max};
  auto take = rosin::take_file<>::create(folder / "a.wav", format);
  REQUIRE(take.has_value());
  ::setrlimit(RLIMIT_FSIZE, &little);
  std::optional<rosin::failure> why;
  std::uint64_t at = 0;
  for (; at < 20000 && !why; at += 100) why = take->write(numbered(at, 100));
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  REQUIRE(why);
  CHECK(why->message.find("a.wav: File too large") != std::string::npos);
  CHECK(at * 6 < 60000 + 700);
  const auto read = rosin::read_audio(folder / "a.wav");
  REQUIRE(read.has_value());
  CHECK(read->frames() == (60000 - rosin::wav_head_bytes) / 6);
  CHECK(is_numbered(*read));
}

TEST_CASE("a take that is being written is left alone, and can be told from one that was broken off") {
  const test::temporary_folder folder;
  const std::string path = folder / "a.wav";
  {
    auto take = rosin::take_file<>::create(path, format);
    REQUIRE(take.has_value());
    REQUIRE_FALSE(take->write(numbered(0, 1000)));
    const std::string before = folder.read("a.wav");
    CHECK_FALSE(*rosin::mend_take(path));
    CHECK(folder.read("a.wav") == before);
    CHECK(rosin::file_lock::held(path));
    REQUIRE_FALSE(take->write(numbered(1000, 1000)));
  }
  CHECK_FALSE(rosin::file_lock::held(path));
  CHECK(rosin::find_take_remains(path)->head_is_due);
  CHECK(*rosin::mend_take(path));
  CHECK(rosin::read_audio(path)->frames() == 2000);
  CHECK_FALSE(rosin::find_take_remains(path)->head_is_due);
}

TEST_CASE("frames behind what the head tells, which somebody has mended too early, are found again") {
  const test::temporary_folder folder;
  {
    auto take = rosin::take_file<>::create(folder / "a.wav", format);
    REQUIRE(take.has_value());
    REQUIRE_FALSE(take->write(numbered(0, 1500)));
    REQUIRE_FALSE(take->finish());
  }
  std::string file = folder.read("a.wav");
  const auto early = rosin::make_wav_head(format, 6 * 1001);
  std::copy(early.begin(), early.end(), file.begin());
  const std::string path = folder.write("a.wav", file);
  CHECK(rosin::read_audio(path)->frames() == 1001);
  CHECK(*rosin::mend_take(path));
  const auto read = rosin::read_audio(path);
  REQUIRE(read.has_value());
  CHECK(read->frames() == 1500);
  CHECK(is_numbered(*read));
}

TEST_CASE("what is no unfinished take is left alone") {
  const test::temporary_folder folder;
  CHECK_FALSE(*rosin::mend_take(folder.write("short", "RIFF")));
  const auto other = folder.write("other", std::string(500, 'x'));
  CHECK_FALSE(*rosin::mend_take(other));
  CHECK(folder.read("other") == std::string(500, 'x'));
}
