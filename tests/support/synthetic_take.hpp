// SPDX-License-Identifier: MIT
//
// What two force transducers see of a plucked string, as a sum of its modes (pinned ends, mode n at
// n f0 sqrt(1 + B n^2), amplitude F 2 / (n pi) sin(n pi beta) at the near end, alternating at the far end), with white
// noise. Also the rig that belongs to it.
//
#pragma once

#include <rosin/acquire/recording.hpp>
#include <rosin/acquire/rig.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <vector>

namespace test {

struct pluck {
  double rate_Hz = 48000, fundamental_Hz = 330, position = 0.3, force_N = 1, inharmonicity = 6e-5, quality = 800;
  double release_s = 0.02, duration_s = 0.4, noise_N = 4e-4;
  double near_gain = 1, far_gain = 1, rate_in_header_Hz = 0;
  std::uint64_t seed = 1;
};

/// Adds what the ends feel of mode n after the release, one rotation a sample.
inline void add_mode(const pluck& p, int n, double weight, std::size_t first, std::vector<std::vector<double>>& out) {
  constexpr double pi = 3.14159265358979323846;
  const double omega = 2 * pi * n * p.fundamental_Hz * std::sqrt(1 + p.inharmonicity * n * n);
  const double amplitude = weight * p.force_N * 2 / (n * pi) * std::sin(n * pi * p.position), far_sign = n % 2 == 1 ? 1.0 : -1.0;
  const double t = static_cast<double>(first) / p.rate_Hz - p.release_s;
  std::complex<double> now = amplitude * std::exp(omega * t * std::complex<double>{-0.5 / p.quality, 1});
  const std::complex<double> turn = std::exp(omega / p.rate_Hz * std::complex<double>{-0.5 / p.quality, 1});
  for (std::size_t i = first; i < out[0].size(); ++i, now *= turn) {
    out[0][i] += now.real();
    out[1][i] += far_sign * now.real();
  }
}

/// near and far in newtons.
inline std::vector<std::vector<double>> pluck_forces(const pluck& p) {
  std::mt19937_64 random{p.seed};
  std::normal_distribution<double> noise;
  const auto frames = static_cast<std::size_t>(p.duration_s * p.rate_Hz);
  const auto first = std::min(frames, static_cast<std::size_t>(std::ceil(p.release_s * p.rate_Hz)));
  std::vector<std::vector<double>> out(2, std::vector<double>(frames, 0.0));
  for (std::size_t i = 0; i < first; ++i) {
    out[0][i] = p.force_N * (1 - p.position);
    out[1][i] = p.force_N * p.position;
  }
  const int modes = static_cast<int>(0.4 * p.rate_Hz / p.fundamental_Hz);
  for (int n = 1; n <= modes; ++n) add_mode(p, n, std::pow(std::cos(1.5707963267948966 * n / (modes + 1)), 2), first, out);
  for (std::size_t i = 0; i < frames; ++i) {
    out[0][i] = p.near_gain * out[0][i] + p.noise_N * noise(random);
    out[1][i] = p.far_gain * out[1][i] + p.noise_N * noise(random);
  }
  return out;
}

/// An AC coupling of first order that has settled to the level at which the record begins.
inline void high_pass(std::vector<double>& x, double cutoff_Hz, double rate_Hz) {
  const double decay = std::exp(-6.283185307179586 * cutoff_Hz / rate_Hz);
  double before = x[0], out = 0;
  for (double& v : x) {
    out = decay * out + v - before;
    before = v;
    v = out;
  }
}

/// A converter of so many bits.
inline void quantise(std::vector<double>& values, double full_scale, int bits) {
  const double half = std::ldexp(1.0, bits - 1);
  for (double& v : values) v = std::min(std::max(std::nearbyint(v / full_scale * half), -half), half - 1) / half * full_scale;
}

inline rosin::rig two_force_rig(const pluck& p) {
  rosin::rig r;
  r.file = "rig.toml";
  r.string.fundamental_Hz = p.fundamental_Hz;
  r.string.length_m = 0.65;
  r.string.tension_N = 70;
  r.channels.resize(2);
  r.channels[0].name = "near";
  r.channels[1].name = "far";
  r.channels[1].index = 1;
  for (auto& c : r.channels) c.per_full_scale = 2.0;
  for (auto& c : r.channels) c.gain_tolerance = 0.05;
  r.contact_position = p.position;
  rosin::take t;
  t.name = "pluck-1";
  t.kind = rosin::take_kind::pluck;
  t.file = "pluck-1.wav";
  t.force_N = p.force_N;
  r.takes.push_back(t);
  return r;
}

inline rosin::take_signals signals(const rosin::rig& r, const pluck& p, std::vector<std::vector<double>> channels) {
  rosin::take_signals out;
  out.name = r.takes.front().name;
  out.file = r.takes.front().file;
  out.sample_rate_Hz = p.rate_in_header_Hz > 0 ? p.rate_in_header_Hz : p.rate_Hz;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    quantise(channels[i], 2.0, 16);
    out.signals.push_back({r.channels.at(i), std::move(channels[i]), 2.0});
  }
  return out;
}

inline rosin::take_signals pluck_signals(const rosin::rig& r, const pluck& p) { return signals(r, p, pluck_forces(p)); }

}  // namespace test
