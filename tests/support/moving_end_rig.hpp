// SPDX-License-Identifier: MIT
//
// A stiff string between terminations that move, by component modes (Hurty 1960, Craig and Bampton 1968), for tests: another
// method than anything in the library. With u_1, u_2 the motion of the ends,
//
//     y(x, t) = sum_n a_n(t) sin(n pi x / L) + u_1 (1 - x / L) + u_2 x / L,     u_j = sum_k q_jk,   M_k q'' + (M_k w_k / Q_k) q' + M_k w_k^2 q = F_j
//
// mass, damping and stiffness matrices follow from the energies; the coupled system is solved by its complex modes, exactly for a
// force that is linear over each step. The force on an end is the balance of the string's momentum against 1 - x / L (or x / L).
//
#pragma once

#include <rosin/friction/friction_law.hpp>
#include <rosin/simulate/modal_bank.hpp>
#include <rosin/simulate/modal_decimator.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <Eigen/Dense>

#include <array>
#include <complex>
#include <random>
#include <vector>

namespace test {

struct end_mode {
  double frequency_Hz, q, mass_kg;
};

struct moving_end_rig {
  rosin::string_parameters string;
  std::array<std::vector<end_mode>, 2> ends;
};

struct moving_take {
  double rate_Hz = 0;
  std::vector<double> near_N, far_N, force_N, velocity_m_s;
};

/// How finely: modes of the string up to a frequency, steps of the contact per sample.
struct moving_settings {
  double rate_Hz = 128e3, mode_limit_Hz = 90e3;
  int oversampling = 4;
};

class moving_end_string {
public:
  moving_end_string(const moving_end_rig& rig, double position, const moving_settings& s)
      : step_s_{1 / (s.rate_Hz * s.oversampling)}, position_{position} {
    const auto modes = rosin::transverse_modes(rig.string, s.mode_limit_Hz);
    const auto N = static_cast<Eigen::Index>(modes.size()), near = static_cast<Eigen::Index>(rig.ends[0].size());
    const Eigen::Index n = N + near + static_cast<Eigen::Index>(rig.ends[1].size());
    const double mass = rig.string.linear_density_kg_m() * rig.string.length_m,
                 per_length = rig.string.tension_N / rig.string.length_m;
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n), C = M, K = M;
    Eigen::MatrixXd weigh = Eigen::MatrixXd::Zero(n, 2), pull = weigh;  // momentum and tension against 1 - x / L, x / L
    shape_ = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < N; ++i) {
      const auto& m = modes[static_cast<std::size_t>(i)];
      M(i, i) = m.mass_kg, K(i, i) = m.mass_kg * m.omega_rad_s * m.omega_rad_s,
           C(i, i) = m.mass_kg * m.omega_rad_s * m.inverse_quality;
      const double across = mass / (m.number * std::numbers::pi);
      weigh.row(i) << across, across * m.parity();
      shape_[i] = m.shape(position);
    }
    for (Eigen::Index i = N; i < n; ++i) {
      const int end = i < N + near ? 0 : 1;
      weigh(i, end) = mass / 3, weigh(i, 1 - end) = mass / 6;
      pull(i, end) = per_length, pull(i, 1 - end) = -per_length;
      shape_[i] = end == 0 ? 1 - position : position;
    }
    for (Eigen::Index i = N; i < n; ++i) {
      const auto end = static_cast<std::size_t>(i < N + near ? 0 : 1);
      M.row(i) += weigh.col(static_cast<Eigen::Index>(end)).transpose();
      M.col(i).head(N) = M.row(i).head(N).transpose();
      K.row(i) += pull.col(static_cast<Eigen::Index>(end)).transpose();
      const end_mode& m = rig.ends[end][static_cast<std::size_t>(i - (end == 0 ? N : N + near))];
      const double w = 2 * std::numbers::pi * m.frequency_Hz;
      M(i, i) += m.mass_kg, K(i, i) += m.mass_kg * w * w, C(i, i) += m.mass_kg * w / m.q;
    }
    rest_m_N_ = rosin::residual_compliance_m_N(rig.string, position, s.mode_limit_Hz);
    solve(M, C, K, weigh, pull);
  }

  [[nodiscard]] double step_s() const { return step_s_; }
  [[nodiscard]] double rest_m_N() const { return rest_m_N_; }
  [[nodiscard]] rosin::load_line<double> line(const rosin::rod_state& rod) const {
    return {free_[0] - rest_m_N_ / step_s_ * force_, at_once_[0] + rest_m_N_ / step_s_, rod.velocity_m_s, rod.normal_force_N,
            step_s_};
  }
  /// Deflected by a force, at rest.
  void hold(double force_N) {
    state_ = -(push_.array() * force_N / poles_.array()).matrix() - end_.cwiseProduct(push_) * force_N;
    read();
    force_ = force_N;
    apply(force_N);
  }
  /// Ends the step with this force: velocity (without what the truncated modes add), near, far.
  std::array<double, 3> apply(double force_N) {
    const std::array<double, 3> now{free_[0] + at_once_[0] * force_N, free_[1] + at_once_[1] * force_N,
                                    free_[2] + at_once_[2] * force_N};
    state_ += end_.cwiseProduct(push_) * force_N;
    state_ = decay_.cwiseProduct(state_) + begin_.cwiseProduct(push_) * force_N;
    read();
    force_ = force_N;
    return now;
  }

private:
  void solve(const Eigen::MatrixXd& M, const Eigen::MatrixXd& C, const Eigen::MatrixXd& K, const Eigen::MatrixXd& weigh,
             const Eigen::MatrixXd& pull) {
    const Eigen::Index n = M.rows();
    const Eigen::LLT<Eigen::MatrixXd> mass(M);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    A.topRightCorner(n, n).setIdentity();
    A.bottomLeftCorner(n, n) = -mass.solve(K);
    A.bottomRightCorner(n, n) = -mass.solve(C);
    Eigen::VectorXd drive = Eigen::VectorXd::Zero(2 * n);
    drive.tail(n) = mass.solve(shape_);
    // Displacements in units of velocity: otherwise the eigenvectors are badly scaled.
    const double unit = std::sqrt(A.bottomLeftCorner(n, n).norm());
    A.topRightCorner(n, n) *= unit, A.bottomLeftCorner(n, n) /= unit;
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3, 2 * n);
    out.row(0).tail(n) = shape_.transpose();
    for (Eigen::Index e = 0; e < 2; ++e) {
      out.row(1 + e) = -weigh.col(e).transpose() * A.bottomRows(n);
      out.row(1 + e).head(n) -= pull.col(e).transpose() / unit;
      direct_[static_cast<std::size_t>(1 + e)] = (e == 0 ? 1 - position_ : position_) - weigh.col(e).dot(drive.tail(n));
    }
    const Eigen::EigenSolver<Eigen::MatrixXd> modes(A);
    const Eigen::VectorXcd push = modes.eigenvectors().partialPivLu().solve(drive.cast<std::complex<double>>());
    keep(modes.eigenvalues(), push, out.cast<std::complex<double>>() * modes.eigenvectors());
  }

  /// One of each pair of modes, counted twice.
  void keep(const Eigen::VectorXcd& poles, const Eigen::VectorXcd& push, const Eigen::MatrixXcd& out) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < poles.size(); ++i)
      if (poles[i].imag() >= 0) kept.push_back(i);
    const auto n = static_cast<Eigen::Index>(kept.size());
    for (Eigen::VectorXcd* v : {&poles_, &push_, &decay_, &begin_, &end_, &state_}) v->setZero(n);
    out_.resize(3, n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index i = kept[static_cast<std::size_t>(k)];
      const auto r = rosin::respond_over_step(poles[i], step_s_);
      poles_[k] = poles[i], push_[k] = push[i], decay_[k] = r.decay, begin_[k] = r.begin, end_[k] = r.end;
      out_.col(k) = (poles[i].imag() > 0 ? 2.0 : 1.0) * out.col(i);
    }
    for (Eigen::Index o = 0; o < 3; ++o)
      at_once_[static_cast<std::size_t>(o)] =
          direct_[static_cast<std::size_t>(o)] + (out_.row(o) * end_.cwiseProduct(push_))(0).real();
  }
  void read() {
    for (Eigen::Index o = 0; o < 3; ++o) free_[static_cast<std::size_t>(o)] = (out_.row(o) * state_)(0).real();
  }

  double step_s_, position_, rest_m_N_ = 0, force_ = 0;
  Eigen::VectorXd shape_;
  Eigen::VectorXcd poles_, push_, decay_, begin_, end_, state_;
  Eigen::MatrixXcd out_;
  std::array<double, 3> direct_{}, at_once_{}, free_{};
};

/// A take of `duration_s`; `force_at(string, t)` finds the force of each step. All signals through one low-pass.
template <class Force>
[[nodiscard]] moving_take run_moving_ends(moving_end_string& string, const moving_settings& s, double duration_s,
                                          Force force_at) {
  const rosin::modal_settings sampling{.sample_rate_Hz = s.rate_Hz, .oversampling = s.oversampling};
  const rosin::modal_decimator decimate{sampling.low_pass(), string.step_s(), s.oversampling};
  const auto steps =
      static_cast<std::size_t>(duration_s * s.rate_Hz) * static_cast<std::size_t>(s.oversampling) + 1 + 2 * decimate.reach();
  std::array<std::vector<double>, 4> all;
  for (auto& x : all) x.resize(steps);
  for (std::size_t i = 0; i < steps; ++i) {
    const double t = (static_cast<double>(i) - static_cast<double>(decimate.reach())) * string.step_s();
    all[3][i] = force_at(string, t);
    const auto now = string.apply(all[3][i]);
    for (std::size_t o = 0; o < 3; ++o) all[o][i] = now[o];
  }
  moving_take take{s.rate_Hz, decimate.points(all[1]), decimate.points(all[2]), decimate.lines(all[3]), decimate.points(all[0])};
  rosin::detail::add_scaled(take.velocity_m_s, string.rest_m_N(), decimate.slopes(all[3]));
  return take;
}

/// Bowed from rest.
template <rosin::FrictionLaw Law>
[[nodiscard]] moving_take bow_moving_ends(const moving_end_rig& rig, double position, Law law, const rosin::steady_rod& rod,
                                          double duration_s, const moving_settings& s = {}) {
  moving_end_string string(rig, position, s);
  return run_moving_ends(string, s, duration_s,
                         [&](const moving_end_string& now, double t) { return law(now.line(rod(t))).force_N; });
}

/// Held by a force that is gone from `release_s` on.
[[nodiscard]] inline moving_take pluck_moving_ends(const moving_end_rig& rig, double position, double force_N, double release_s,
                                                   double duration_s, const moving_settings& s = {}) {
  moving_end_string string(rig, position, s);
  string.hold(force_N);
  return run_moving_ends(string, s, duration_s,
                         [&](const moving_end_string&, double t) { return t < release_s ? force_N : 0.0; });
}

/// What a transducer makes of a force: white noise and a converter of 16 bits.
inline void record(std::vector<double>& force_N, double noise_N, double full_scale_N, unsigned seed) {
  std::mt19937_64 random{seed};
  std::normal_distribution<double> gauss;
  const double step = full_scale_N / 32768;
  for (double& x : force_N) x = step * std::nearbyint((x + noise_N * gauss(random)) / step);
}

}  // namespace test
