// tier: hosted
// SPDX-License-Identifier: MIT
//
// A recording that survives: samples go to the file system as soon as they are there (a killed program loses what it still
// had in its hands, see capture.hpp, and nothing else), a thread asks for them to be put on the disk every half second (a
// power cut loses less than a second), and the head (wav_header.hpp) is right all the time. While it is written its file is locked
// (file_lock.hpp): so a take that is being recorded can be told from one that was broken off.
//
// The file is a policy, so that the tests can pull the plug:
//
//     outcome<File> File::create(path);  fails where something is there already
//     optional<failure> append(bytes), write_at(offset, bytes), sync();   sync() is called from another thread than append()
//
#pragma once

#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/durable_text.hpp>
#include <rosin/hardware/file_lock.hpp>
#include <rosin/hardware/wav_header.hpp>

#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A file of the system, locked as long as it is open.
class posix_file {
public:
  [[nodiscard]] static outcome<posix_file> create(const std::string& path) {
    auto out = opened(path, O_RDWR | O_CREAT | O_EXCL);
    if (!out) return out;
    if (!out->lock(std::chrono::seconds{2})) return failure{path + ": another program has taken hold of it"};
    if (auto bad = sync_folder_of(path)) return *bad;
    return out;
  }
  /// Not locked yet.
  [[nodiscard]] static outcome<posix_file> existing(const std::string& path) { return opened(path, O_RDWR); }
  /// False: somebody else writes it.
  [[nodiscard]] bool lock(std::chrono::milliseconds patience) const { return file_lock::lock(fd_.get(), deadline{patience}); }

  [[nodiscard]] std::optional<failure> append(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
      const ssize_t done = ::write(fd_.get(), bytes.data(), bytes.size());
      if (done > 0) bytes = bytes.subspan(static_cast<std::size_t>(done));
      else if (errno != EINTR) return why();
    }
    return std::nullopt;
  }
  [[nodiscard]] std::optional<failure> write_at(std::uint64_t offset, std::span<const std::uint8_t> bytes) {
    const ssize_t done = ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    return done == static_cast<ssize_t>(bytes.size()) ? std::nullopt : std::optional{why()};
  }
  [[nodiscard]] std::optional<failure> sync() {
    return ::fdatasync(fd_.get()) == 0 || errno == EINVAL ? std::nullopt : std::optional{why()};
  }
  [[nodiscard]] std::optional<failure> cut(std::uint64_t bytes) {
    return ::ftruncate(fd_.get(), static_cast<off_t>(bytes)) == 0 ? std::nullopt : std::optional{why()};
  }

private:
  posix_file(int fd, std::string path) : fd_{fd}, path_{std::move(path)} {}
  [[nodiscard]] static outcome<posix_file> opened(const std::string& path, int how) {
    posix_file out{::open(path.c_str(), how | O_CLOEXEC, 0666), path};
    if (out.fd_.get() < 0) return out.why();
    return out;
  }
  [[nodiscard]] failure why() const { return failure{path_ + ": " + std::strerror(errno)}; }

  detail::owned_fd fd_;
  std::string path_;
};

/// A take on its way to the disk; a FrameSink.
template <class File = posix_file>
class take_file {
public:
  /// The head is on the disk when this returns.
  [[nodiscard]] static outcome<take_file> create(const std::string& path, const frame_format& format,
                                                 std::chrono::milliseconds cadence = std::chrono::milliseconds{500}) {
    auto file = File::create(path);
    if (!file) return failure{file.error()};
    auto state = std::make_unique<shared>(*std::move(file), format);
    if (auto bad = state->file.append(make_wav_head(format, std::nullopt))) return *bad;
    if (auto bad = state->file.sync()) return *bad;
    return take_file{std::move(state), cadence};
  }

  [[nodiscard]] std::optional<failure> write(std::span<const double> interleaved) {
    if (auto bad = state_->sync_failure()) return bad;
    const std::size_t bytes = sample_bytes(state_->format);
    buffer_.resize(interleaved.size() * bytes);
    for (std::size_t i = 0; i < interleaved.size(); ++i) put_sample(&buffer_[i * bytes], interleaved[i], state_->format);
    if (auto bad = state_->file.append(buffer_)) return bad;
    state_->data_bytes += buffer_.size();
    return std::nullopt;
  }

  /// What was written is on the disk when this returns; may be called from another thread.
  [[nodiscard]] std::optional<failure> sync() { return state_->file.sync(); }

  /// The true sizes into the head, all of it on the disk.
  [[nodiscard]] std::optional<failure> finish() {
    thread_ = {};
    if (state_->data_bytes % 2 == 1)
      if (auto bad = state_->file.append(std::array<std::uint8_t, 1>{})) return bad;
    if (auto bad = state_->file.sync()) return bad;
    if (auto bad = state_->file.write_at(0, make_wav_head(state_->format, state_->data_bytes))) return bad;
    return state_->file.sync();
  }
  [[nodiscard]] std::uint64_t frames() const noexcept {
    return state_->data_bytes / (sample_bytes(state_->format) * static_cast<std::size_t>(state_->format.channels));
  }
  [[nodiscard]] const File& file() const noexcept { return state_->file; }

private:
  struct shared {
    shared(File f, const frame_format& is) : file{std::move(f)}, format{is} {}
    File file;
    frame_format format;
    std::uint64_t data_bytes = 0;
    std::mutex mutex;
    std::condition_variable_any wake;
    std::optional<failure> bad;
    [[nodiscard]] std::optional<failure> sync_failure() {
      const std::scoped_lock lock{mutex};
      return bad;
    }
  };

  take_file(std::unique_ptr<shared> state, std::chrono::milliseconds cadence)
      : state_{std::move(state)}, thread_{[s = state_.get(), cadence](const std::stop_token& stop) {
          sync_each(*s, cadence, stop);
        }} {}

  static void sync_each(shared& s, std::chrono::milliseconds cadence, const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (auto bad = s.file.sync()) {
        const std::scoped_lock lock{s.mutex};
        s.bad = bad;
        return;
      }
      std::unique_lock lock{s.mutex};
      s.wake.wait_for(lock, stop, cadence, [] { return false; });
    }
  }

  std::unique_ptr<shared> state_;
  std::vector<std::uint8_t> buffer_;
  std::jthread thread_;  ///< last: it uses the state
};

static_assert(FrameSink<take_file<>>);

/// What there is of a take.
struct take_remains {
  frame_format format;
  std::uint64_t bytes = 0;   ///< of whole frames that are in the file
  bool head_is_due = false;  ///< the head does not tell of all of them
};

/// Empty: the file has no head of a take_file, or none yet.
[[nodiscard]] inline std::optional<take_remains> find_take_remains(const std::string& path) {
  std::ifstream in{path, std::ios::binary};
  wav_head head{};
  if (!in.read(reinterpret_cast<char*>(head.data()), head.size())) return std::nullopt;
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value |= std::uint64_t{head[at + i]} << (8 * i);
    return value;
  };
  const auto bits = static_cast<int>(number(70, 2));
  const frame_format f{static_cast<double>(number(60, 4)), static_cast<int>(number(58, 2)), bits, number(80, 2) == 3, true};
  if (f.channels == 0 || sample_bytes(f) * 8 != static_cast<std::size_t>(bits)) return std::nullopt;
  const std::uint64_t told = head[1] == 'F' ? number(28, 8) : number(100, 4),
                      present = static_cast<std::uint64_t>(in.seekg(0, std::ios::end).tellg()) - wav_head_bytes,
                      frame = sample_bytes(f) * static_cast<std::size_t>(f.channels), whole = present / frame * frame;
  if (head == make_wav_head(f, std::nullopt)) return take_remains{f, whole, true};
  if (head != make_wav_head(f, told)) return std::nullopt;
  return present > told + told % 2 ? take_remains{f, whole, true} : take_remains{f, std::min(whole, told), false};
}

/// Gives a take whose recording was broken off the head that it would have got; whole frames stay. True: there was something
/// to mend. What is no unfinished take, or is being written, is left alone.
[[nodiscard]] inline outcome<bool> mend_take(const std::string& path) {
  if (const auto found = find_take_remains(path); !found || !found->head_is_due) return false;
  auto file = posix_file::existing(path);
  if (!file) return failure{file.error()};
  if (!file->lock(std::chrono::milliseconds{100})) return false;
  const auto found = find_take_remains(path);  // who had the lock may have come to an end
  if (!found || !found->head_is_due) return false;
  if (auto bad = file->cut(wav_head_bytes + found->bytes)) return *bad;
  if (found->bytes % 2 == 1)
    if (auto bad = file->write_at(wav_head_bytes + found->bytes, std::array<std::uint8_t, 1>{})) return *bad;
  if (auto bad = file->sync()) return *bad;
  if (auto bad = file->write_at(0, make_wav_head(found->format, found->bytes))) return *bad;
  if (auto bad = file->sync()) return *bad;
  return true;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
