// SPDX-License-Identifier: MIT
#include "frame_input.hpp"

#include "recorder.hpp"

#include <rosin/adapt/frames_sndfile.hpp>
#include <rosin/hardware/paced_source.hpp>
#include <rosin/hardware/serial_source.hpp>

#include <unistd.h>

#include <future>
#include <thread>

namespace tool {

namespace {

/// Found by others but not in this build.
[[maybe_unused]] rosin::failure not_built(const std::string& what, const std::string& package) {
  return rosin::failure{what + ": this rosin was built without it (" + package + " was not there)"};
}

rosin::outcome<frame_input> paced(rosin::outcome<rosin::sndfile_source> from, double faster) {
  if (!from) return rosin::failure{from.error()};
  if (faster > 0) return frame_input{rosin::paced_source<rosin::sndfile_source>{*std::move(from), faster}};
  return frame_input{*std::move(from)};
}

rosin::outcome<frame_input> open_serial(const std::string& device, const input_options& given) {
  auto link = rosin::byte_link::open(device, given.baud);
  if (!link) return rosin::failure{link.error()};
  auto from = rosin::serial_source::open(*std::move(link), std::chrono::milliseconds{static_cast<int>(given.patience_s * 1000)},
                                         stop_flag());
  if (!from) return rosin::failure{from.error()};
  return frame_input{*std::move(from)};
}

[[maybe_unused]] std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',') out.emplace_back();
    else out.back() += c;
  }
  return out;
}

rosin::outcome<frame_input> open_now(const input_options& given) {
  const rosin::frame_format wanted{given.rate_Hz, given.channels, given.bits, given.float_format, true};
  const std::string& s = given.source;
  if (s == "-")
    return paced(rosin::sndfile_source::open_pipe(STDIN_FILENO, given.bare ? std::optional{wanted} : std::nullopt), given.faster);
  if (s.starts_with("serial:")) return open_serial(s.substr(7), given);
#ifdef ROSIN_TOOL_ALSA
  if (s.starts_with("alsa:")) return open_alsa(s.substr(5), wanted);
#else
  if (s.starts_with("alsa:")) return not_built(s, "libasound2-dev");
#endif
#ifdef ROSIN_TOOL_JACK
  if (s.starts_with("jack:")) return open_jack(split(s.substr(5)));
#else
  if (s.starts_with("jack:")) return not_built(s, "libjack-jackd2-dev");
#endif
  return paced(rosin::sndfile_source::open(s.starts_with("file:") ? s.substr(5) : s), given.faster);
}

}  // namespace

/// A pipe's header, or a sound card that others use, may be waited for without end; Ctrl-C ends that, too: the thread that waits
/// is left behind.
rosin::outcome<frame_input> open_input(const input_options& given) {
  auto promise = std::make_shared<std::promise<rosin::outcome<frame_input>>>();
  auto made = promise->get_future();
  std::thread{[promise, given] { promise->set_value(open_now(given)); }}.detach();
  while (made.wait_for(std::chrono::milliseconds{20}) != std::future_status::ready)
    if (stopped()) return rosin::failure{given.source + ": stopped before a frame came"};
  return made.get();
}

void add_input_options(CLI::App& command, input_options& given) {
  command.add_option("--source", given.source, "A file, - for standard input, serial:DEVICE, alsa:DEVICE or jack:PORT,PORT")
      ->required()
      ->type_name("SOURCE");
  command.add_option("--rate", given.rate_Hz, "Sampling rate, where the source does not tell it (alsa:, --bare)")
      ->type_name("HZ")
      ->check(positive())
      ->capture_default_str();
  command.add_option("--channels", given.channels, "Number of channels, the same")
      ->check(between(1, 64, "INT"))
      ->capture_default_str();
  command.add_option("--bits", given.bits, "Bits of a sample, the same")
      ->check(CLI::IsMember({16, 24, 32}))
      ->capture_default_str();
  command.add_flag("--float", given.float_format, "Samples are 32-bit floating point, the same");
  command.add_flag("--bare", given.bare, "Standard input has no header, only samples (little endian)");
  command.add_option("--baud", given.baud, "Speed of a serial line")->capture_default_str();
  command
      .add_option("--faster", given.faster, "A file plays in real time (1) or so many times as fast; 0: as fast as it is read")
      ->check(not_negative())
      ->capture_default_str();
}

}  // namespace tool
