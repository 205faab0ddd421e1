// SPDX-License-Identifier: MIT
//
// Frames as recorded into force and velocity under the bow while they come, with a calibration of `rosin fit`.
//
#pragma once

#include "calibration_file.hpp"
#include "take_plan.hpp"

#include <rosin/friction/slip_watch.hpp>
#include <rosin/hardware/frames.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>

#include <functional>
#include <memory>
#include <mutex>

namespace tool {

struct live_options {
  double pass_Hz = 0, stop_Hz = 0, error = 1e-3;
  std::vector<std::string> out;  ///< .wav, .csv, or - for lines on standard output
  bool force = false;
};
void add_live_options(CLI::App& command, live_options& given);

/// Anything that takes frames.
struct frame_output {
  std::function<std::optional<rosin::failure>(std::span<const double>)> write;
  std::function<std::optional<rosin::failure>()> finish;
};
[[nodiscard]] rosin::outcome<frame_output> open_output(const std::string& path, bool force, double rate_Hz,
                                                       const std::vector<std::string>& columns);

class live_chain {
public:
  [[nodiscard]] static rosin::outcome<live_chain> design(const rosin::rig& rig, const take_plan& take,
                                                         const calibration_set& calibration, const rosin::frame_format& format,
                                                         const live_options& how);

  /// The reason where an output took no more; it gets nothing further, the others go on.
  [[nodiscard]] std::optional<rosin::failure> push(std::span<const double> interleaved);
  /// Rows for the frames whose result is beyond the end.
  [[nodiscard]] std::optional<rosin::failure> finish();

  [[nodiscard]] std::string shows() const;
  [[nodiscard]] json to_json() const;
  [[nodiscard]] const std::vector<std::string>& remarks() const noexcept { return remarks_; }
  [[nodiscard]] std::string summary() const;

private:
  using reconstructor = rosin::passage_reconstructor<double, 2048, 8192, 8>;
  using frame = rosin::termination_frame<double>;
  /// One end's sensor: what becomes newtons of the recorded sample.
  struct end {
    std::size_t index = 0;
    double newtons = 1, offset_N = 0, half_step = 0, last = 0, integral = 0;
    [[nodiscard]] double operator()(double sample) noexcept;
  };
  live_chain() = default;
  void place(const rosin::rig& rig, const calibration_set& set, rosin::calibration& at, double declared);
  void set_ends(const rosin::rig& rig, const calibration_set& set, double rate_Hz);
  [[nodiscard]] std::optional<rosin::failure> open(const take_plan& take, const rosin::frame_format& format,
                                                   const live_options& how);
  [[nodiscard]] std::optional<rosin::failure> give(std::size_t count);

  std::array<end, 2> ends_;
  std::unique_ptr<reconstructor> run_;
  std::unique_ptr<rosin::slip_watch<double>> watch_;
  std::vector<frame_output> outputs_;
  std::vector<std::string> remarks_;
  std::vector<frame> in_;
  std::vector<rosin::bow_frame<double>> result_;
  std::vector<double> rows_;
  std::size_t width_ = 2, skip_ = 0, latency_ = 0;
  double rate_Hz_ = 0, speed_m_s_ = 0;
  std::uint64_t known_ = 0;
  double largest_N_ = 0, sum_N_ = 0;
  rosin::bow_frame<double> latest_;
};

}  // namespace tool
