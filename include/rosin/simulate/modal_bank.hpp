// tier: hosted
// SPDX-License-Identifier: MIT
//
// Modes that are stepped together under point forces, exactly: with the force linear over a step of length h, a mode
// with pole p = -s + i w_d, velocity q' = Re(z) and displacement q = (w_d Im(z) - s Re(z)) / w^2 goes on by
//
//     z(h) = e^{p h} z(0) + b (phi_a f(0) + phi_b f(h)) shape(x) / mass,    b = 1 + i s / w_d,
//     phi_b = (e^{p h} - 1 - p h) / (p^2 h),    phi_a = (e^{p h} - 1) / p - phi_b.
//
// Stored is the free state at the coming step, e^{p h} z + b phi_a f: one pass through memory then gives the
// next one and all that must be known before the new force is: velocities at the ports and forces on the ends. The
// driving-point mobility of this scheme is the sampled, triangle-weighted one of the modes, hence positive real: no step
// can create energy. Several ports (contact, point masses, dampers) make the one bank serve several point forces.
// Ports may move from step to step (move_to): a mode's force f sin(k x) then runs straight between its values at the steps.
//
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <rosin/simulate/mode_step.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What acts at the end of a step, besides the force that is still to be found.
template <int Ports>
struct bank_reading {
  std::array<double, static_cast<std::size_t>(Ports)> velocity{};  ///< at the ports, m/s
  double near = 0, far = 0;                                        ///< forces on the ends, N
};

template <int Ports>
class modal_bank {
public:
  static constexpr std::size_t ports = static_cast<std::size_t>(Ports);
  using values = std::array<double, ports>;

  modal_bank(std::span<const string_mode> modes, damping_convention damping, const values& positions, double step_s) {
    std::vector<const string_mode*> odd, even;
    for (const auto& m : modes) (m.parity() > 0 ? odd : even).push_back(&m);
    append(odd, damping, positions, step_s);
    odd_ = lanes_.size();
    append(even, damping, positions, step_s);
  }

  /// Velocity at port i for 1 N at port j at the end of the same step.
  [[nodiscard]] double mobility(std::size_t i, std::size_t j) const noexcept { return mobility_[i][j]; }
  /// Forces on the ends for 1 N at port j at the end of the same step.
  [[nodiscard]] double near_gain(std::size_t j) const noexcept { return near_gain_[j]; }
  [[nodiscard]] double far_gain(std::size_t j) const noexcept { return far_gain_[j]; }
  /// Static displacement at port j for 1 N there, and static force on the near end, of these modes only.
  [[nodiscard]] double compliance(std::size_t j) const noexcept { return compliance_[j]; }
  [[nodiscard]] double near_share(std::size_t j) const noexcept { return near_share_[j]; }
  [[nodiscard]] double far_share(std::size_t j) const noexcept { return far_share_[j]; }

  /// Kinetic and elastic energy of all modes at the end of the step under way; exact where the last force was zero.
  [[nodiscard]] double energy_J() const noexcept {
    double energy = 0;
    for (const auto& [mode, lane_index, i] : placed_) {
      const lane& l = lanes_[lane_index];
      const auto p = mode.pole();
      const double elastic = (p.imag() * l.im[i] + p.real() * l.re[i]) / mode.omega_rad_s;  // w q
      energy += mode.mass_kg / 2 * (l.re[i] * l.re[i] + elastic * elastic);
    }
    return energy;
  }

  /// State at the end of the step under way if no force acts there.
  [[nodiscard]] const bank_reading<Ports>& free() const noexcept { return free_; }

  /// The ports from now on, for the step under way as well: after advance() and before anything is read. Precondition: the modes
  /// are numbered from 1 without gaps.
  void move_to(const values& positions) noexcept {
    mobility_ = {}, near_gain_ = {}, far_gain_ = {}, compliance_ = {}, near_share_ = {}, far_share_ = {}, free_.velocity = {};
    move_lanes(0, odd_, 1, 1, positions);
    move_lanes(odd_, lanes_.size(), 2, -1, positions);
  }

  /// Ends the step with these forces and begins the next.
  void advance(const values& force) noexcept {
    accumulator odd, even;
    for (std::size_t i = 0; i < odd_; ++i) step(lanes_[i], force, odd);
    for (std::size_t i = odd_; i < lanes_.size(); ++i) step(lanes_[i], force, even);
    for (std::size_t p = 0; p < ports; ++p) free_.velocity[p] = total(odd.velocity[p]) + total(even.velocity[p]);
    const double o = total(odd.end), e = total(even.end);
    free_.near = o + e;
    free_.far = o - e;
  }

private:
  static constexpr int width = 8;
  using pack = Eigen::Array<double, width, 1>;

  struct lane {
    pack re = pack::Zero(), im = pack::Zero();            // state
    pack turn_re = pack::Zero(), turn_im = pack::Zero();  // e^{p h}
    pack push_re = pack::Zero(), push_im = pack::Zero();  // e^{p h} b phi_b + b phi_a
    pack end_re = pack::Zero(), end_im = pack::Zero();    // state to force on the near end
    std::array<pack, ports> shape{};
  };
  struct answers {  // of a lane's modes to a force at the end of the same step, and to one that stays, for a shape of 1
    pack velocity = pack::Zero(), end = pack::Zero(), deflection = pack::Zero(), end_at_rest = pack::Zero();
  };
  struct placed_mode {
    string_mode mode;
    std::size_t lane;
    Eigen::Index index;
  };
  struct values_of_lanes {
    std::array<pack, ports> mobility{};
    pack end = pack::Zero(), compliance = pack::Zero(), share = pack::Zero(), velocity = pack::Zero();
    values_of_lanes() noexcept { mobility.fill(pack::Zero()); }
  };
  struct accumulator {
    std::array<pack, ports> velocity{};
    pack end = pack::Zero();
    accumulator() noexcept { velocity.fill(pack::Zero()); }
  };

  /// In pairs; Eigen's own sum makes GCC 12 warn of its AVX-512 header.
  [[nodiscard]] static double total(const pack& x) noexcept {
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
  }

  static void step(lane& l, const values& force, accumulator& sum) noexcept {
    pack drive = l.shape[0] * force[0];
    for (std::size_t p = 1; p < ports; ++p) drive += l.shape[p] * force[p];
    const pack re = l.turn_re * l.re - l.turn_im * l.im + l.push_re * drive;
    const pack im = l.turn_im * l.re + l.turn_re * l.im + l.push_im * drive;
    l.re = re;
    l.im = im;
    for (std::size_t p = 0; p < ports; ++p) sum.velocity[p] += l.shape[p] * re;
    sum.end += l.end_re * re + l.end_im * im;
  }

  void append(const std::vector<const string_mode*>& modes, damping_convention damping, const values& positions, double h) {
    for (std::size_t n = 0; n < modes.size(); ++n) {
      if (n % width == 0) {
        lanes_.emplace_back();
        lanes_.back().shape.fill(pack::Zero());
        answers_.emplace_back();
      }
      placed_.push_back({*modes[n], lanes_.size() - 1, static_cast<Eigen::Index>(n % width)});
      set(lanes_.back(), placed_.back().index, *modes[n], damping, positions, h);
    }
  }

  void set(lane& l, Eigen::Index i, const string_mode& m, damping_convention damping, const values& positions, double h) {
    const auto p = m.pole();
    const auto r = respond_over_step(m, h);
    const auto push = r.decay * r.end + r.begin;
    const double w2 = m.omega_rad_s * m.omega_rad_s, in_stress = damping == damping_convention::kelvin_voigt ? 1 : 0;
    const std::complex<double> end{m.end_stiffness_N_m * (p.real() / w2 + in_stress * m.inverse_quality / m.omega_rad_s),
                                   m.end_stiffness_N_m * p.imag() / w2};
    l.turn_re[i] = r.decay.real(), l.turn_im[i] = r.decay.imag();
    l.push_re[i] = push.real(), l.push_im[i] = push.imag();
    l.end_re[i] = end.real(), l.end_im[i] = end.imag();
    for (std::size_t k = 0; k < ports; ++k) l.shape[k][i] = m.shape(positions[k]);
    auto& once = answers_.back();
    once.velocity[i] = r.end.real();
    once.end[i] = end.real() * r.end.real() + end.imag() * r.end.imag();
    once.deflection[i] = 1 / (m.mass_kg * w2);
    once.end_at_rest[i] = m.end_stiffness_N_m / (m.mass_kg * w2);
    for (std::size_t j = 0; j < ports; ++j) {
      const double s = l.shape[j][i];
      for (std::size_t k = 0; k < ports; ++k) mobility_[j][k] += s * l.shape[k][i] * once.velocity[i];
      near_gain_[j] += s * once.end[i], far_gain_[j] += s * once.end[i] * m.parity();
      compliance_[j] += s * s * once.deflection[i];
      near_share_[j] += s * once.end_at_rest[i], far_share_[j] += s * once.end_at_rest[i] * m.parity();
    }
  }

  /// sin(n pi x) for every second n from `number` on, by turning eight at a time; and all sums over modes anew.
  void move_lanes(std::size_t first, std::size_t last, int number, double parity, const values& positions) noexcept {
    constexpr double pi = 3.14159265358979323846;
    for (std::size_t j = 0; j < ports && first < last; ++j) {
      pack sine, cosine;
      for (int n = 0; n < width; ++n) {
        const double angle = pi * std::fmod((number + 2 * n) * positions[j], 2.0);
        sine[n] = std::sin(angle), cosine[n] = std::cos(angle);
      }
      const double angle = pi * std::fmod(2 * width * positions[j], 2.0), turn_sine = std::sin(angle),
                   turn_cosine = std::cos(angle);
      for (std::size_t i = first; i < last; ++i) {
        lanes_[i].shape[j] = sine;
        const pack turned = sine * turn_cosine + cosine * turn_sine;
        cosine = cosine * turn_cosine - sine * turn_sine;
        sine = turned;
      }
    }
    for (std::size_t j = 0; j < ports; ++j) sum_again(first, last, parity, j);
  }

  void sum_again(std::size_t first, std::size_t last, double parity, std::size_t j) noexcept {
    values_of_lanes sum;
    for (std::size_t i = first; i < last; ++i) {
      const lane& l = lanes_[i];
      const answers& once = answers_[i];
      const pack& s = l.shape[j];
      for (std::size_t k = 0; k < ports; ++k) sum.mobility[k] += s * l.shape[k] * once.velocity;
      sum.end += s * once.end, sum.compliance += s * s * once.deflection, sum.share += s * once.end_at_rest,
          sum.velocity += s * l.re;
    }
    for (std::size_t k = 0; k < ports; ++k) mobility_[j][k] += total(sum.mobility[k]);
    near_gain_[j] += total(sum.end), far_gain_[j] += parity * total(sum.end);
    compliance_[j] += total(sum.compliance);
    near_share_[j] += total(sum.share), far_share_[j] += parity * total(sum.share);
    free_.velocity[j] += total(sum.velocity);
  }

  std::vector<lane> lanes_;
  std::vector<answers> answers_;
  std::vector<placed_mode> placed_;
  std::size_t odd_ = 0;
  bank_reading<Ports> free_{};
  std::array<values, ports> mobility_{};
  values near_gain_{}, far_gain_{}, compliance_{}, near_share_{}, far_share_{};
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
