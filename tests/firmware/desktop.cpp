// SPDX-License-Identifier: MIT
//
// The desktop's side of the firmware test, with the same emitted header:
//
//   desktop record TAKE.wav NEAR FAR   TAKE (16 bit, two channels, header of 44 bytes), newtons per full scale, to forces.f32
//   desktop compare                    forces.f32 reconstructed here in double against the target's bow.f32
//
#include "rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

template <class T>
std::vector<T> read(const char* name, long skip = 0) {
  std::vector<T> out;
  std::FILE* file = std::fopen(name, "rb");
  if (file == nullptr) return out;
  std::fseek(file, skip, SEEK_SET);
  for (T x; std::fread(&x, sizeof x, 1, file) == 1;) out.push_back(x);
  std::fclose(file);
  return out;
}

int record(const char* take, std::array<double, 2> full_scale_N) {
  std::vector<float> newtons;
  for (const std::int16_t x : read<std::int16_t>(take, 44))
    newtons.push_back(static_cast<float>(full_scale_N[newtons.size() % 2] * x / 32768));
  std::FILE* file = std::fopen("forces.f32", "wb");
  const bool written = file != nullptr && std::fwrite(newtons.data(), sizeof(float), newtons.size(), file) == newtons.size();
  return written && std::fclose(file) == 0 && newtons.size() > 10000 ? 0 : 1;
}

template <class T, std::size_t Taps, std::size_t Line, std::size_t Short>
rosin::passage_reconstructor<double, Taps, Line, Short> in_double(const rosin::passage_reconstructor<T, Taps, Line, Short>&) {
  rosin::passage_coefficients<double, Taps, Short> wide;
  const auto& c = rig::coefficients;
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t j = 0; j < Taps; ++j) wide.passage[p].taps[j] = static_cast<double>(c.passage[p].taps[j]);
    wide.passage[p].count = c.passage[p].count, wide.passage[p].newest_age = c.passage[p].newest_age;
  }
  for (std::size_t j = 0; j < wide.admittance.size(); ++j) {
    wide.admittance[j] = static_cast<double>(c.admittance[j]);
    wide.near_field[j] = static_cast<double>(c.near_field[j]);
  }
  wide.latency = c.latency, wide.reach = c.reach, wide.version = c.version;
  return rosin::passage_reconstructor<double, Taps, Line, Short>{wide};
}

/// Largest difference of a column against its rms; frames that are unknown here have to be unknown there.
int compare() {
  const auto forces = read<float>("forces.f32"), bow = read<float>("bow.f32");
  const std::size_t frames = bow.size() / 4;
  if (frames < 5000 || forces.size() < 2 * frames) return std::puts("bow.f32 is too short"), 1;
  auto stream = in_double(rig::reconstructor{rig::coefficients});
  double largest[4]{}, square[4]{};
  std::size_t flags_differ = 0, known = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    const auto f = stream(
        {static_cast<double>(forces[2 * i] - rig::offset.near_N), static_cast<double>(forces[2 * i + 1] - rig::offset.far_N)});
    const double here[4]{f.force_near_N, f.force_far_N, f.velocity_near_m_s, f.velocity_far_m_s};
    for (std::size_t k = 0; k < 4; ++k) {
      const double there = static_cast<double>(bow[4 * i + k]);
      flags_differ += std::isnan(here[k]) != std::isnan(there);
      if (std::isnan(here[k]) || std::isnan(there)) continue;
      largest[k] = std::max(largest[k], std::abs(here[k] - there));
      square[k] += here[k] * here[k];
    }
    known += stream.known();
  }
  double worst = 0;
  for (std::size_t k = 0; k < 4; ++k) worst = std::max(worst, largest[k] / std::sqrt(square[k] / static_cast<double>(known)));
  std::printf("%zu frames, %zu known; largest difference from the desktop %.2g of the rms, %zu flags differ\n", frames, known,
              worst, flags_differ);
  return worst < 1e-5 && flags_differ == 0 && known + 1000 > frames ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "record" && argc == 5) return record(argv[2], {std::atof(argv[3]), std::atof(argv[4])});
  return mode == "compare" ? compare() : 2;
}
