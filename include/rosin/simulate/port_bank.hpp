// tier: hosted
// SPDX-License-Identifier: MIT
//
// Modes stepped exactly as in modal_bank (forces straight within a step), with ports of any shape: points of the string, or
// the inertia that a moving end lends it. Asked for, the string's own motion raises its tension (Kirchhoff and Carrier),
//
//     T + (E A / 4) sum k_n^2 q_n^2,
//
// a force on every mode that is carried on to the end of the step from what the modes do at its beginning. What motion across
// this plane adds to the tension may be given, step by step.
//
#pragma once

#include <rosin/simulate/modal_bank.hpp>

#include <Eigen/Dense>

namespace rosin {

class port_bank {
public:
  /// `clamping`: of the ends (modal_string.hpp).
  template <class = void>
  port_bank(const modal_rig& rig, double axial_stiffness_N, double limit_Hz, double step_s,
            const std::array<double, 2>& clamping = {})
      : length_{rig.string.length_m}, axial_{axial_stiffness_N}, step_{step_s} {
    modes_ = transverse_modes(rig, limit_Hz, clamping);
    transverse_ = static_cast<Eigen::Index>(modes_.size());
    const auto turning = torsional_modes(rig, limit_Hz);
    modes_.insert(modes_.end(), turning.begin(), turning.end());
    const auto n = static_cast<Eigen::Index>(modes_.size());
    for (auto* a : {&mass, &omega, &number, &re_, &im_, &own_, &turn_re_, &turn_im_, &push_re_, &push_im_, &once_re_, &once_im_,
                    &q_re_, &q_im_, &k_, &felt_, &now_re_, &now_im_, &drive_})
      a->setZero(n);
    end_.setZero(n, 2), end_damping_.setZero(n);
    for (Eigen::Index i = 0; i < n; ++i)
      set_mode(i, modes_[static_cast<std::size_t>(i)], rig.damping == damping_convention::kelvin_voigt && i < transverse_);
  }

  Eigen::ArrayXd mass, omega, number;  ///< of every mode, transverse first

  template <class = void>
  [[nodiscard]] Eigen::Index size() const noexcept {
    return mass.size();
  }
  [[nodiscard]] Eigen::Index transverse() const noexcept { return transverse_; }
  /// The shapes of all modes, or of the transverse ones alone: sin(k_n x) between pinned ends.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd at(double position, bool turns) const {
    Eigen::VectorX<Real> s = Eigen::VectorX<Real>::Zero(size());
    for (Eigen::Index i = 0; i < (turns ? size() : transverse_); ++i) s[i] = modes_[static_cast<std::size_t>(i)].shape(position);
    return s;
  }
  /// Inertia that an end lends to the transverse modes when it moves: the integral of mu (1 - x/L) sin, or of mu (x/L) sin.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd at_end(int side) const {
    Eigen::VectorX<Real> s = Eigen::VectorX<Real>::Zero(size());
    for (Eigen::Index i = 0; i < transverse_; ++i)
      s[i] = (side == 1 && static_cast<int>(number[i]) % 2 == 0 ? -2 : 2) * mass[i] / (number[i] * pi);
    return s;
  }

  template <class Real = double>
  void set_ports(Eigen::MatrixXd shape) {
    shape_ = std::move(shape);
    mobility = shape_.transpose() * once_re_.matrix().asDiagonal() * shape_;
    end_gain = end_.transpose() * (felt(once_re_, once_im_)).matrix().asDiagonal() * shape_;
    const Eigen::ArrayX<Real> give = 1 / (mass * omega.square());
    compliance =
        shape_.topRows(transverse_).transpose() * give.head(transverse_).matrix().asDiagonal() * shape_.topRows(transverse_);
    twist_compliance = shape_.bottomRows(size() - transverse_).transpose() *
                       give.tail(size() - transverse_).matrix().asDiagonal() * shape_.bottomRows(size() - transverse_);
    share = end_.transpose() * give.matrix().asDiagonal() * shape_;
  }

  Eigen::MatrixXd mobility;                      ///< velocities at the ports for forces at the end of the same step
  Eigen::MatrixXd end_gain;                      ///< forces on the ends for the same
  Eigen::MatrixXd compliance, twist_compliance;  ///< static, of these modes only
  Eigen::MatrixXd share;                         ///< static forces on the ends, of these modes only

  /// Velocities at the ports and forces on the ends at the end of the step under way if no force acts there.
  template <class = void>
  void read_free(Eigen::VectorXd& velocity, Eigen::Vector2d& end) {
    now_re_ = re_, now_im_ = im_;
    if (axial_ > 0) now_re_ += once_re_ * own_, now_im_ += once_im_ * own_;
    velocity.noalias() = shape_.transpose() * now_re_.matrix();
    now_im_ *= q_im_, now_re_ *= felt_;
    now_im_ += now_re_;
    end.noalias() = end_.transpose() * now_im_.matrix();
    if (axial_ > 0) end += pull_;
  }
  /// Of the twist alone under these forces.
  template <class = void>
  [[nodiscard]] double twist(Eigen::Index port, const Eigen::VectorXd& force) const {
    const auto turning = size() - transverse_;
    return (shape_.col(port).tail(turning).array() *
            (re_.tail(turning) + once_re_.tail(turning) * (shape_.bottomRows(turning) * force).array()))
        .sum();
  }
  /// What this motion adds to the tension, N; and what else is to be added to it from the next step on (E A above 0 only).
  [[nodiscard]] double raised_N() const noexcept { return raised_; }
  void add_tension(double across_N) noexcept { across_ = across_N; }
  /// Of the string as it stands, mean: sum k_n^2 q_n^2 / 4.
  template <class = void>
  [[nodiscard]] double strain() const {
    return (k_ * (q_re_ * re_ + q_im_ * im_)).square().sum() / 4;
  }
  template <class = void>
  void advance(const Eigen::VectorXd& force) {
    drive_.matrix().noalias() = shape_ * force;
    if (axial_ > 0) {
      drive_ += own_;
      raise_tension(re_ + once_re_ * drive_, im_ + once_im_ * drive_);
    }
    now_re_ = turn_re_ * re_ - turn_im_ * im_ + push_re_ * drive_;
    im_ = turn_im_ * re_ + turn_re_ * im_ + push_im_ * drive_;
    re_.swap(now_re_);
  }
  /// After advance() with these forces: from now on they are gone, at once, and not over a step.
  template <class = void>
  void let_go(const Eigen::VectorXd& force) {
    drive_.matrix().noalias() = shape_ * force;
    re_ -= (push_re_ - turn_re_ * once_re_ + turn_im_ * once_im_) * drive_;
    im_ -= (push_im_ - turn_im_ * once_re_ - turn_re_ * once_im_) * drive_;
  }
  /// At rest under these forces.
  template <class Real = double>
  void rest_under(const Eigen::VectorXd& force) {
    const Eigen::ArrayX<Real> f = (shape_ * force).array(), stiffness = mass * omega.square();
    own_.setZero(), pull_.setZero();
    Eigen::ArrayX<Real> q = f / stiffness;
    for (int i = 0; i < 50 && axial_ > 0; ++i) {  // the tension rises by a few per mille: each turn gains as many digits
      raise_tension(Eigen::ArrayX<Real>::Zero(size()), q / q_im_);
      q = (f + own_) / stiffness;
    }
    // A step under a steady force changes nothing: the free state is the state less what the force adds at the step's end.
    re_ = -once_re_ * (f + own_);
    im_ = q / q_im_ - once_im_ * (f + own_);
  }

private:
  static constexpr double pi = 3.14159265358979323846;

  template <class = void>
  void set_mode(Eigen::Index i, const string_mode& m, bool in_stress) {
    const auto p = m.pole();
    const auto r = respond_over_step(m, step_);
    const auto push = r.decay * r.end + r.begin, once = r.end;
    mass[i] = m.mass_kg, omega[i] = m.omega_rad_s, number[i] = m.number;
    k_[i] = i < transverse_ ? m.number * pi / length_ : 0;
    turn_re_[i] = r.decay.real(), turn_im_[i] = r.decay.imag();
    push_re_[i] = push.real(), push_im_[i] = push.imag();
    once_re_[i] = once.real(), once_im_[i] = once.imag();
    q_re_[i] = p.real() / (m.omega_rad_s * m.omega_rad_s), q_im_[i] = p.imag() / (m.omega_rad_s * m.omega_rad_s);
    end_(i, 0) = m.end_stiffness_N_m, end_(i, 1) = m.parity() * m.far_over_near * m.end_stiffness_N_m;
    end_damping_[i] = in_stress ? m.inverse_quality / m.omega_rad_s : 0;
    felt_[i] = q_re_[i] + end_damping_[i];
  }
  /// Displacement and its share of the stress, from velocity and its companion.
  template <class = void>
  [[nodiscard]] Eigen::ArrayXd felt(const Eigen::ArrayXd& re, const Eigen::ArrayXd& im) const {
    return q_re_ * re + q_im_ * im + end_damping_ * re;
  }

  template <class Real = double>
  void raise_tension(const Eigen::ArrayXd& re, const Eigen::ArrayXd& im) {
    const Eigen::ArrayX<Real> q = q_re_ * re + q_im_ * im + step_ * re;  // at the end of the step to come
    raised_ = axial_ / 4 * (k_ * q).square().sum();
    own_ = -(raised_ + across_) * length_ / 2 * k_.square() * q;
    pull_ = (raised_ + across_) * Eigen::Vector2d{(k_ * q).sum(), -(k_ * q * (pi * number).cos()).sum()};
  }

  double length_, axial_, step_, raised_ = 0, across_ = 0;
  std::vector<string_mode> modes_;
  Eigen::Index transverse_ = 0;
  Eigen::ArrayXd re_, im_, own_, turn_re_, turn_im_, push_re_, push_im_, once_re_, once_im_, q_re_, q_im_, k_, end_damping_,
      felt_, now_re_, now_im_, drive_;
  Eigen::MatrixXd shape_, end_;
  Eigen::Vector2d pull_ = Eigen::Vector2d::Zero();
};

}  // namespace rosin
