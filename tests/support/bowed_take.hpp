// SPDX-License-Identifier: MIT
//
// What a bowing machine records of a stroke of Helmholtz motion: normal force with an offset, speed of the bow, and sawteeth at the ends,
// whose means share the friction's. The bow is set on, drawn, and lifted while it moves on.
//
#pragma once

#include <rosin/acquire/recording.hpp>

#include <cmath>
#include <cstdint>
#include <random>

namespace test {

struct stroke {
  double rate_Hz = 50000, fundamental_Hz = 130, position = 0.12, speed_m_s = 0.1, normal_force_N = 0.6, friction = 0.4;
  double onset_s = 0.1, rise_s = 0.05, lift_s = 0.7, duration_s = 0.9;
  double offset_N = 0.03, gauge_noise_N = 2e-3, speed_noise_m_s = 1e-5, noise_N = 1e-3;
  double sounds_Hz = 130;
};

inline rosin::take bowed_take(const stroke& s) {
  rosin::take out;
  out.name = "whole_1", out.kind = rosin::take_kind::bow, out.file = "whole_1.csv", out.contact_position = s.position;
  return out;
}

inline rosin::rig bowing_machine(const stroke& s) {
  rosin::rig r;
  r.file = "rig.toml";
  r.string.fundamental_Hz = s.fundamental_Hz, r.string.length_m = 0.7, r.string.tension_N = 150;
  const auto channel = [&](const char* name, rosin::quantity what) {
    rosin::sensor_channel c;
    c.name = name, c.index = static_cast<int>(r.channels.size()), c.quantity = what, c.per_full_scale = 1;
    r.channels.push_back(c);
  };
  channel("normal", rosin::quantity::normal_force);
  channel("bow", rosin::quantity::bow_speed);
  channel("near", rosin::quantity::termination_force);
  channel("far", rosin::quantity::termination_force);
  r.takes.push_back(bowed_take(s));
  return r;
}

/// normal, bow, near, far
inline std::vector<std::vector<double>> bowed_columns(const stroke& s) {
  std::mt19937_64 random{1};
  std::normal_distribution<double> noise;
  const auto frames = static_cast<std::size_t>(s.duration_s * s.rate_Hz);
  std::vector<std::vector<double>> out(4, std::vector<double>(frames));
  double decay = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const double t = static_cast<double>(i) / s.rate_Hz;
    const double press = t < s.onset_s || t > s.lift_s ? 0.0 : std::min(1.0, (t - s.onset_s) / 0.005);
    const double speed = t < s.onset_s ? 0.0 : s.speed_m_s * std::min(1.0, (t - s.onset_s) / s.rise_s);
    const double phase = t * s.sounds_Hz - std::floor(t * s.sounds_Hz), rises = std::min(1.0, speed / s.speed_m_s);
    decay = t > s.lift_s ? decay * std::exp(-10 / s.rate_Hz) : rises;
    const double saw = decay * s.speed_m_s / s.position * (phase - 0.5), drag = press * rises * s.friction * s.normal_force_N;
    out[0][i] = s.offset_N + press * s.normal_force_N + s.gauge_noise_N * noise(random);
    out[1][i] = speed + s.speed_noise_m_s * noise(random);
    out[2][i] = (1 - s.position) * drag + saw + s.noise_N * noise(random);
    out[3][i] = s.position * drag - saw + s.noise_N * noise(random);
  }
  return out;
}

inline rosin::take_signals signals_from(const stroke& s, std::vector<std::vector<double>> columns) {
  rosin::recording read;
  read.file = "whole_1.csv", read.sample_rate_Hz = s.rate_Hz, read.channels = std::move(columns), read.bits = 64,
  read.float_format = true;
  read.is_table = true;
  return *rosin::signals_of(bowing_machine(s), bowed_take(s), read);
}
inline rosin::take_signals bowed_signals(const stroke& s) { return signals_from(s, bowed_columns(s)); }

}  // namespace test
