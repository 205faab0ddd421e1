// SPDX-License-Identifier: MIT
//
// A digitiser that rosin does not know becomes a source by two functions; then it can be metered, triggered and recorded like
// any other. Here its driver is a function that makes a signal up.
//
#include <rosin/hardware/capture.hpp>
#include <rosin/hardware/level_meter.hpp>
#include <rosin/hardware/take_file.hpp>

#include <cmath>
#include <cstdio>

/// What the maker of the digitiser gives: 100 frames of two channels, 16 bits; and how many it had to drop before them.
struct vendor_block {
  short samples[200];
  unsigned dropped;
};
vendor_block vendor_fetch() {
  static int n = 0;
  vendor_block out{{}, n == 4000 ? 50U : 0U};
  for (int i = 0; i < 100; ++i, ++n) {
    out.samples[2 * i] = static_cast<short>(8000 * std::sin(0.05 * n));
    out.samples[2 * i + 1] = static_cast<short>(n % 100);
  }
  return out;
}

class my_digitiser {
public:
  rosin::frame_format format() const { return {.sample_rate_Hz = 96000, .channels = 2, .bits = 16}; }

  rosin::frame_read read(std::span<double> interleaved, std::chrono::milliseconds) {
    if (interleaved.size() < 200) return {};
    const vendor_block block = vendor_fetch();
    for (std::size_t i = 0; i < 200; ++i) interleaved[i] = block.samples[i] / 32768.0;
    return {.frames = 100, .lost = block.dropped, .ended = false, .problem = {}};
  }
};
static_assert(rosin::FrameSource<my_digitiser>);

int main() {
  const std::string path = (std::filesystem::temp_directory_path() / "rosin-own-digitiser.wav").string();
  std::filesystem::remove(path);

  rosin::capture<my_digitiser> source{my_digitiser{}};
  auto take = rosin::take_file<>::create(path, source.format());
  if (!take) {
    std::printf("%s\n", take.error().c_str());
    return 1;
  }
  rosin::level_meter meter{source.format()};
  std::vector<double> block(2 * 960);
  std::uint64_t lost = 0;
  while (take->frames() < 96000) {
    const auto got = source.read(block, std::chrono::milliseconds{100});
    const auto frames = std::span{block}.first(2 * got.frames);
    if (got.lost > 0)
      std::printf("%llu frames are missing at frame %llu\n", static_cast<unsigned long long>(got.lost),
                  static_cast<unsigned long long>(take->frames()));
    lost += got.lost;
    meter.push(frames);
    if (const auto why = take->write(frames)) {
      std::printf("%s\n", why->message.c_str());
      return 1;
    }
  }
  if (take->finish()) return 1;
  std::printf("%llu frames in %s, peaks at %.1f and %.1f dB\n", static_cast<unsigned long long>(take->frames()), path.c_str(),
              rosin::decibels(meter.levels()[0].peak), rosin::decibels(meter.levels()[1].peak));
  return lost > 0 ? 0 : 1;  // this driver drops frames on purpose
}
