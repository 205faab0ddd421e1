// tier: hosted
// SPDX-License-Identifier: MIT
//
// The books of a stroke, kept by another hand than the simulation's: from the contact's force alone the motion of every mode is
// followed anew, and with it the work that it received and the work of its drag,
//
//     received = int g q' dt,     lost = m w / Q int q'^2 dt,     g = f(t) sin(k x(t)),
//
// neither of them from the other or from the energy, so that received = stored + lost is a check. g runs straight over a step, as
// in modal_bank.hpp; then q' is known at every instant from z = q' + i (...) and g at the step's ends, and both integrals are
// quadratic forms of (Re z, Im z, g_begin, g_end), found once per mode by Gauss quadrature. All that has to be summed along the
// take are the products of these four.
//
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <rosin/simulate/modal_low_pass.hpp>
#include <rosin/simulate/mode_step.hpp>
#include <rosin/simulate/stroke_energy.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a step does to one mode, as quadratic forms of (Re z, Im z, g_begin, g_end) at its begin.
struct step_energy {
  Eigen::Matrix4d received = Eigen::Matrix4d::Zero(), lost = Eigen::Matrix4d::Zero();

  template <class = void>
  step_energy(const string_mode& mode, double step_s) {
    constexpr int panels = 8;
    const double drag = mode.mass_kg * mode.omega_rad_s * mode.inverse_quality;
    for (int i = 0; i < panels; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const double u = (i + gauss4::node[j]) / panels, weight = gauss4::weight[j] / panels * step_s;
        const auto r = respond_over_step(mode, u * step_s);
        const Eigen::Vector4d velocity{r.decay.real(), -r.decay.imag(), r.begin.real() + (1 - u) * r.end.real(),
                                       u * r.end.real()};
        received += weight * Eigen::Vector4d{0, 0, 1 - u, u} * velocity.transpose();
        lost += weight * drag * velocity * velocity.transpose();
      }
  }
};

/// Follows all modes of one kind, numbered from 1 without gaps, while a force acts at a place that may change.
class energy_account {
public:
  template <class = void>
  energy_account(std::vector<string_mode> modes, double step_s) : modes_{std::move(modes)}, step_{step_s} {
    for (std::size_t n = 0; n < modes_.size(); ++n) {
      if (n % width == 0) lanes_.emplace_back();
      const auto r = respond_over_step(modes_[n], step_s);
      const auto i = static_cast<Eigen::Index>(n % width);
      auto& l = lanes_.back();
      l.turn_re[i] = r.decay.real(), l.turn_im[i] = r.decay.imag();
      l.begin_re[i] = r.begin.real(), l.begin_im[i] = r.begin.imag(), l.end_re[i] = r.end.real(), l.end_im[i] = r.end.imag();
    }
  }

  /// Goes on by as many steps as there are forces; `position`: at these steps, or one for all.
  template <class = void>
  void follow(std::span<const double> force_N, std::span<const double> position) {
    for (std::size_t first = 0; first < force_N.size(); first += block) {
      const auto count = std::min(block, force_N.size() - first);
      for (std::size_t i = 0; i < count; ++i) set_shape(i, position.size() == 1 ? position[0] : position[first + i]);
      for (auto& l : lanes_) run(l, force_N.subspan(first, count));
    }
  }

  template <class = void>
  [[nodiscard]] motion_energy total() const {
    motion_energy sum;
    for (std::size_t n = 0; n < modes_.size(); ++n) {
      const auto& l = lanes_[n / width];
      const auto i = static_cast<Eigen::Index>(n % width);
      const auto p = modes_[n].pole();
      const double elastic = (p.imag() * l.x[1][i] + p.real() * l.x[0][i]) / modes_[n].omega_rad_s;  // w q
      sum.stored_J += modes_[n].mass_kg / 2 * (l.x[0][i] * l.x[0][i] + elastic * elastic);
      const step_energy of{modes_[n], step_};
      std::size_t at = 0;
      for (Eigen::Index a = 0; a < 4; ++a)
        for (Eigen::Index b = a; b < 4; ++b, ++at) {
          sum.received_J += (a == b ? of.received(a, a) : of.received(a, b) + of.received(b, a)) * l.products[at][i];
          sum.lost_J += (a == b ? of.lost(a, a) : 2 * of.lost(a, b)) * l.products[at][i];
        }
    }
    return sum;
  }

private:
  static constexpr std::size_t width = 8, block = 128;
  using pack = Eigen::Array<double, static_cast<int>(width), 1>;

  struct lane {
    pack turn_re = pack::Zero(), turn_im = pack::Zero(), begin_re = pack::Zero(), begin_im = pack::Zero(), end_re = pack::Zero(),
         end_im = pack::Zero();
    std::array<pack, 3> x{pack::Zero(), pack::Zero(), pack::Zero()};  ///< Re z, Im z, g, as they are now
    std::array<pack, 10> products{};
    lane() { products.fill(pack::Zero()); }
  };
  /// sin and cos of n k x for the eight modes that are next, and what leads to the eight after them.
  struct shape_at {
    pack sine, cosine;
    double turn_sine = 0, turn_cosine = 1;
  };

  template <class = void>
  void set_shape(std::size_t i, double position) {
    constexpr double pi = 3.14159265358979323846;
    auto& s = shapes_[i];
    if (position == at_) return void(s = first_);
    at_ = position;
    for (std::size_t n = 0; n < width; ++n) {
      const double angle = pi * position * static_cast<double>(n + 1);
      s.sine[static_cast<Eigen::Index>(n)] = std::sin(angle), s.cosine[static_cast<Eigen::Index>(n)] = std::cos(angle);
    }
    s.turn_sine = std::sin(pi * position * static_cast<double>(width)),
    s.turn_cosine = std::cos(pi * position * static_cast<double>(width));
    first_ = s;
  }

  template <class = void>
  void run(lane& l, std::span<const double> force_N) {
    auto [re, im, g] = l.x;
    auto sums = l.products;
    for (std::size_t i = 0; i < force_N.size(); ++i) {
      auto& s = shapes_[i];
      const pack now = s.sine * force_N[i];
      sums[0] += re * re, sums[1] += re * im, sums[2] += re * g, sums[3] += re * now, sums[4] += im * im;
      sums[5] += im * g, sums[6] += im * now, sums[7] += g * g, sums[8] += g * now, sums[9] += now * now;
      const pack next = l.turn_re * re - l.turn_im * im + l.begin_re * g + l.end_re * now;
      im = l.turn_im * re + l.turn_re * im + l.begin_im * g + l.end_im * now;
      re = next, g = now;
      const pack sine = s.sine * s.turn_cosine + s.cosine * s.turn_sine;
      s.cosine = s.cosine * s.turn_cosine - s.sine * s.turn_sine;
      s.sine = sine;
    }
    l.x = {re, im, g}, l.products = sums;
  }

  std::vector<string_mode> modes_;
  double step_, at_ = -1;
  std::vector<lane> lanes_;
  std::array<shape_at, block> shapes_{};
  shape_at first_{};
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
