// SPDX-License-Identifier: MIT
//
// Any bytes as a recording: either channels of one length that go through all checks of a take, or a failure that names
// the file.
//
#include <rosin/acquire/checks.hpp>
#include <rosin/adapt/audio_sndfile.hpp>

#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

/// A file in memory under a path of its own.
class memory_file {
public:
  memory_file() : descriptor_{memfd_create("recording", 0)}, path_{"/proc/self/fd/" + std::to_string(descriptor_)} {}
  memory_file(const memory_file&) = delete;
  memory_file& operator=(const memory_file&) = delete;
  ~memory_file() { close(descriptor_); }

  [[nodiscard]] const std::string& holding(const unsigned char* data, std::size_t size) const {
    require(ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size));
    return path_;
  }

private:
  int descriptor_;
  std::string path_;
};

rosin::rig rig_for(const rosin::recording& from) {
  rosin::rig r;
  r.string.fundamental_Hz = from.sample_rate_Hz / 64;
  r.string.length_m = 0.3;
  r.string.tension_N = 70;
  r.contact_position = 0.3;
  r.channels.resize(std::min<std::size_t>(from.channels.size(), 2));
  for (std::size_t i = 0; i < r.channels.size(); ++i) {
    r.channels[i].name = i == 0 ? "near" : "far";
    r.channels[i].index = static_cast<int>(i);
    r.channels[i].per_full_scale = 2.0;
  }
  if (r.channels.size() == 1) r.channels[0].quantity = rosin::quantity::sound;
  r.takes.resize(3);
  for (std::size_t i = 0; i < 3; ++i) r.takes[i].kind = static_cast<rosin::take_kind>(i);
  r.takes[0].force_N = 1;
  return r;
}

void check_all(const rosin::recording& from) {
  require(from.sample_rate_Hz > 0 && from.frames() > 0);
  for (const auto& c : from.channels) require(c.size() == from.frames());
  if (from.frames() > 50000) return;  // long ones teach nothing new and cost time
  const auto r = rig_for(from);
  for (const auto& t : r.takes) {
    const auto signals = rosin::signals_of(r, t, from);
    require(signals.has_value());
    for (const auto& finding : rosin::check_take(r, t, *signals).findings)
      require(!finding.what.empty() && !finding.advice.empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const memory_file file;
  const std::string& path = file.holding(data, size);
  const auto header = rosin::read_audio_format(path);
  const auto audio = rosin::read_audio(path);
  if (audio) {
    require(header.has_value() && static_cast<std::size_t>(header->channels) == audio->channels.size());
    check_all(*audio);
  } else {
    require(audio.error().starts_with(path + ": "));
  }
  return 0;
}
