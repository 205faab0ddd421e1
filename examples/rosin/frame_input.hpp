// SPDX-License-Identifier: MIT
//
// Where `rosin record` and `rosin live` get their frames from, by name:
//
//     take.wav            a file, as fast as it is wanted (--faster 1: in real time)
//     -                   standard input: a WAV file, or bare samples with --bare
//     serial:/dev/ttyACM0 packets of a microcontroller
//     alsa:hw:1           a sound card          jack:system:capture_1,system:capture_2   ports of a JACK server
//
#pragma once

#include "command_line.hpp"

#include <rosin/hardware/capture.hpp>

#include <memory>

namespace tool {

struct input_options {
  std::string source;
  double rate_Hz = 48000, faster = 0, patience_s = 10;
  int channels = 2, bits = 16, baud = 921600;
  bool float_format = false, bare = false;
};
void add_input_options(CLI::App& command, input_options& given);

/// Any source; a FrameSource itself.
class frame_input {
public:
  template <class Source>
  requires(!std::same_as<Source, frame_input>) && rosin::FrameSource<Source> explicit frame_input(Source source)
      : from_{std::make_unique<held<Source>>(std::move(source))} {}

  [[nodiscard]] rosin::frame_format format() const { return from_->format(); }
  [[nodiscard]] rosin::frame_read read(std::span<double> to, std::chrono::milliseconds patience) {
    return from_->read(to, patience);
  }

private:
  struct any {
    virtual ~any() = default;
    [[nodiscard]] virtual rosin::frame_format format() const = 0;
    [[nodiscard]] virtual rosin::frame_read read(std::span<double> to, std::chrono::milliseconds patience) = 0;
  };
  template <class Source>
  struct held final : any {
    explicit held(Source s) : source{std::move(s)} {}
    [[nodiscard]] rosin::frame_format format() const override { return source.format(); }
    [[nodiscard]] rosin::frame_read read(std::span<double> to, std::chrono::milliseconds patience) override {
      return source.read(to, patience);
    }
    Source source;
  };
  std::unique_ptr<any> from_;
};

[[nodiscard]] rosin::outcome<frame_input> open_input(const input_options& given);

/// Only in a build that found them.
[[nodiscard]] rosin::outcome<frame_input> open_alsa(const std::string& device, const rosin::frame_format& wanted);
[[nodiscard]] rosin::outcome<frame_input> open_jack(const std::vector<std::string>& ports);

}  // namespace tool
