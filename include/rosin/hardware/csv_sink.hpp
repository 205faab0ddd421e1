// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames as lines of text while they come: a column for the time and one for each channel, an empty field where a value is
// unknown (NaN). Into a file, or a descriptor that is open already (standard output, a pipe). What has been written is handed on
// after each call, so whoever follows the file or reads the pipe is never late.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/frames.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace rosin {

/// A FrameSink.
class csv_sink {
public:
  [[nodiscard]] static outcome<csv_sink> create(const std::string& path, double rate_Hz,
                                                const std::vector<std::string>& columns) {
    byte_link file{::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666), path};
    if (file.fd() < 0) return failure{path + ": " + std::strerror(errno)};
    return csv_sink{std::move(file), rate_Hz, columns};
  }
  /// Takes the descriptor over. Whoever reads it may be slow, for at most ten seconds a block, or until `stop` becomes true.
  csv_sink(byte_link to, double rate_Hz, const std::vector<std::string>& columns, const std::atomic<bool>* stop = nullptr)
      : to_{std::move(to)}, rate_Hz_{rate_Hz}, width_{columns.size()}, stop_{stop} {
    text_ = "time_s";
    for (const auto& name : columns) text_ += "," + name;
    text_ += '\n';
  }

  [[nodiscard]] std::optional<failure> write(std::span<const double> interleaved) {
    for (std::size_t i = 0; i + width_ <= interleaved.size(); i += width_) {
      put(static_cast<double>(frame_++) / rate_Hz_, 9);
      for (std::size_t c = 0; c < width_; ++c) {
        text_ += ',';
        if (!std::isnan(interleaved[i + c])) put(interleaved[i + c], 7);
      }
      text_ += '\n';
    }
    return flush();
  }
  [[nodiscard]] std::optional<failure> finish() { return flush(); }

private:
  void put(double x, int digits) {
    std::array<char, 40> form{};
    const auto end = std::to_chars(form.data(), form.data() + form.size(), x, std::chars_format::general, digits);
    text_.append(form.data(), end.ptr);
  }
  [[nodiscard]] std::optional<failure> flush() {
    auto bad = to_.write(text_, deadline{std::chrono::seconds{10}, stop_});
    text_.clear();
    return bad;
  }

  byte_link to_;
  double rate_Hz_;
  std::size_t width_;
  const std::atomic<bool>* stop_;
  std::uint64_t frame_ = 0;
  std::string text_;
};

static_assert(FrameSink<csv_sink>);

}  // namespace rosin
