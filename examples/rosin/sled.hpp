// SPDX-License-Identifier: MIT
//
// The sled during a take: one stroke, started when the take runs, watched until it is over.
//
#pragma once

#include "take_plan.hpp"

#include <rosin/hardware/grbl_stage.hpp>

#include <atomic>
#include <memory>
#include <mutex>

namespace tool {

struct sled_options {
  std::string device;
  double distance_m = 0, acceleration_m_s2 = 2, rest_s = 0.1;
  int baud = 115200;
  double home_s = 120;  ///< homing may take so long
  bool home = false, unlock = false;
};
void add_sled_options(CLI::App& command, sled_options& given);

class sled {
public:
  /// Wakes it up, homes it if that is asked for, and looks whether the stroke can be made.
  [[nodiscard]] static rosin::outcome<sled> open(const sled_options& given, double speed_m_s);

  /// Returns at once.
  void begin();
  /// Once the stroke is over and a rest has passed: "" or what went wrong.
  [[nodiscard]] std::optional<std::string> over();
  [[nodiscard]] std::string shows() const;
  /// Slows down and stops, within a second: "" or what went wrong with that.
  std::string stop();
  ~sled();
  sled(sled&& other) noexcept;
  sled& operator=(sled&& other) noexcept;

private:
  struct shared;
  explicit sled(std::unique_ptr<shared> s);
  std::unique_ptr<shared> state_;
};

}  // namespace tool
