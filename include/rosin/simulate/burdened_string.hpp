// tier: hosted
// SPDX-License-Identifier: MIT
//
// A string that carries what an ideal rig leaves out: point loads (beads, fingers), supports that yield, and a tension that
// its own motion raises. With u_e the displacement of support e,
//
//     y(x, t) = sum q_n sin(k_n x) + (1 - x/L) u_1 + (x/L) u_2,
//     m (q_n'' + (w_n/Q_n) q_n' + w_n^2 q_n) = sum f_p sin(k_n x_p) - a_n1 u_1'' - a_n2 u_2'',   a_n = mu L / (n pi) (+-1),
//     u = sum u_k (moving_support.hpp),  F_end = sum (T k_n + B k_n^3) q_n - (T/L) (u - u_other).
//
// Unknown in every step besides the contacts' forces are the loads' f and g = -u'' of the ends; whatever is linear in
// them goes into one small matrix that is inverted beforehand:
//
//     load:   f + alpha v(f, g) = -beta     (moving_load.hpp)
//     end:    D g + F_end(f, g) = r         (moving_support.hpp).
//
// Ends that resist turning (`clamping`) have the modes of modal_string.hpp instead of the sines.
//
// Nothing here is shared with the closed forms that a diagnosis fits.
//
#pragma once

#include <rosin/propagate/termination.hpp>
#include <rosin/simulate/moving_load.hpp>
#include <rosin/simulate/moving_support.hpp>
#include <rosin/simulate/port_bank.hpp>

namespace rosin {

/// A stop beside the string that a pluck may swing against: a stiff spring that only pushes.
struct obstacle {
  double position = 0.5;     ///< distance from the near end / length
  double gap_m = 0;          ///< from the string at rest, positive towards the pluck's side
  double stiffness_N_m = 0;  ///< 0: there is none
};

/// All that the string itself carries.
struct string_burden {
  std::vector<point_load> loads{};
  std::array<yielding_support, 2> supports{};  ///< near, far
  /// the same as terminations are declared: any number of modes, masses against the string's Z
  std::array<modal_termination, 2> ends{};
  double axial_stiffness_N = 0;                ///< E A; 0: the tension is steady
  std::array<double, 2> sensed_stiffness_N{};  ///< what near and far sensor read per unit of the string's strain
  obstacle stop{};                             ///< in the way of plucks
  /// of near and far end against turning, 0 to 1 (modal_string.hpp): on ends that do not move, with a steady tension
  std::array<double, 2> clamping{};
};

class burdened_string {
public:
  /// Forces may act on the string at `contacts` (distance from the near end / length).
  template <class = void>
  burdened_string(const modal_rig& rig, const string_burden& burden, const std::vector<double>& contacts, double mode_limit_Hz,
                  double step_s)
      : stretch_{rig.string.tension_N / rig.string.length_m}, step_{step_s}, contacts_{static_cast<int>(contacts.size())},
        clamping_{burden.clamping}, limit_Hz_{mode_limit_Hz}, bank_{rig, burden.axial_stiffness_N, mode_limit_Hz, step_s,
                                                                    burden.clamping},
        positions_{contacts}, sensed_N_{burden.sensed_stiffness_N[0], burden.sensed_stiffness_N[1]} {
    for (const auto& load : burden.loads) loads_.push_back({load}), positions_.push_back(load.position);
    for (int e = 0; e < 2; ++e) add_end(burden, e, rig.string.impedance_Ns_m());
    set_ports(rig);
    set_system();
    read();
  }

  /// At rest under these forces at the contacts.
  template <class Real = double>
  void rest_under(const Eigen::VectorXd& force) {
    const int n = unknowns(), l = load_count();
    // x: the loads' forces, the supports' displacements
    const auto miss = [&](const Eigen::VectorX<Real>& x, const Eigen::VectorX<Real>& f) {
      const Eigen::VectorX<Real> y = deflection(f, x);
      Eigen::VectorX<Real> r(n);
      for (int i = 0; i < l; ++i) r[i] = x[i] + loads_[static_cast<std::size_t>(i)].load.stiffness_N_m * y[contacts_ + i];
      for (int i = l; i < n; ++i) r[i] = end(i - l).stiffness() * x[i] - y[contacts_ + i];
      return r;
    };
    Eigen::VectorX<Real> x = Eigen::VectorX<Real>::Zero(n);
    if (n > 0) {
      const Eigen::VectorX<Real> none = Eigen::VectorX<Real>::Zero(contacts_), base = miss(x, force);
      Eigen::MatrixX<Real> a(n, n);
      for (int i = 0; i < n; ++i) a.col(i) = miss(Eigen::VectorX<Real>::Unit(n, i), none);
      x = a.partialPivLu().solve(-base);
    }
    Eigen::VectorX<Real> all = Eigen::VectorX<Real>::Zero(contacts_ + n);
    all << force, x.head(l), Eigen::VectorX<Real>::Zero(n - l);
    const Eigen::VectorX<Real> y = deflection(force, x);
    for (int i = 0; i < l; ++i) loads_[static_cast<std::size_t>(i)].y = y[contacts_ + i];
    for (int i = l; i < n; ++i) ends_[static_cast<std::size_t>(i - l)].rest_at(x[i]);
    bank_.rest_under(all);
    last_ = all.head(points());
    read();
  }

  /// Velocities that the contacts would have at the end of this step without force there; centre and twist together.
  [[nodiscard]] Eigen::VectorXd free_velocity() {
    if (unknowns() == 0) return free_.head(contacts_);
    answer_ = solve_ * known_side();
    return free_.head(contacts_) + across_ * answer_;
  }
  /// Their response to forces at the contacts in the same step, m/(N s).
  [[nodiscard]] const Eigen::MatrixXd& mobility() const noexcept { return contact_mobility_; }

  /// What the modes left out add to the motion of the contacts, times the rate of the force there: centre, twist; m/N.
  [[nodiscard]] Eigen::VectorXd centre_left_out_m_N() const { return (rest_ - rest_twist_).head(contacts_); }
  [[nodiscard]] Eigen::VectorXd twist_left_out_m_N() const { return rest_twist_.head(contacts_); }

  /// What the motion adds to the tension, and what else is to be added to it (port_bank.hpp).
  [[nodiscard]] double raised_N() const noexcept { return bank_.raised_N(); }
  void add_tension(double across_N) noexcept { bank_.add_tension(across_N); }

  struct reading {
    Eigen::Vector2d end_N;                   ///< forces on near and far end
    Eigen::VectorXd surface_m_s, twist_m_s;  ///< at the contacts, of the modes alone; the centre moves with the difference
  };
  /// After free_velocity(): ends the step with these forces at the contacts and begins the next.
  template <class Real = double>
  reading advance(const Eigen::VectorXd& force) {
    Eigen::VectorX<Real> all(contacts_ + unknowns());
    all.head(contacts_) = force;
    if (unknowns() > 0) all.tail(unknowns()) = answer_ - solve_ * (drive_ * force);
    const Eigen::VectorX<Real> v = free_ + mobility_ * all;
    move(v, all);
    const Eigen::VectorX<Real> rate = (force - last_.head(contacts_)) / step_;
    reading out{free_end_ + end_gain_ * all, v.head(contacts_) - rest_.head(contacts_).cwiseProduct(rate),
                Eigen::VectorX<Real>(contacts_)};
    Eigen::Vector2d u = Eigen::Vector2d::Zero();
    for (const auto& m : ends_) u[m.side] = m.sum(&moving_mode::u);
    out.end_N += stretch_ * Eigen::Vector2d{u[1] - u[0], u[0] - u[1]};
    if (!sensed_N_.isZero()) out.end_N += sensed_N_ * bank_.strain();
    for (int i = 0; i < contacts_; ++i) out.twist_m_s[i] = bank_.twist(i, all);
    bank_.advance(all);
    last_ = all.head(points());
    read();
    return out;
  }

  /// After advance() with these forces at the contacts: they are gone at once. Returns by how much the forces on the ends fall
  /// with them, which is the share of the modes left out.
  template <class Real = double>
  Eigen::Vector2d let_go(const Eigen::VectorXd& force) {
    Eigen::VectorX<Real> all = Eigen::VectorX<Real>::Zero(contacts_ + unknowns());
    all.head(contacts_) = force;
    bank_.let_go(all);
    last_.head(contacts_) -= force;
    read();
    return rest_end_ * all;
  }

private:
  void add_end(const string_burden& burden, int side, double impedance_Ns_m) {
    const auto e = static_cast<std::size_t>(side);
    moving_support end{side, {}};
    if (burden.supports[e].mass_kg > 0) end.modes.push_back({burden.supports[e]});
    for (const auto& m : burden.ends[e].modes)
      if (m.per_mass_per_s > 0) end.modes.push_back({{impedance_Ns_m / m.per_mass_per_s, m.frequency_Hz, m.q}});
    if (!end.modes.empty()) ends_.push_back(std::move(end));
  }

  [[nodiscard]] int points() const noexcept { return static_cast<int>(positions_.size()); }
  [[nodiscard]] int load_count() const noexcept { return static_cast<int>(loads_.size()); }
  [[nodiscard]] int unknowns() const noexcept { return load_count() + static_cast<int>(ends_.size()); }
  [[nodiscard]] const moving_support& end(int i) const noexcept { return ends_[static_cast<std::size_t>(i)]; }
  /// How far point i rises for 1 m at the end.
  [[nodiscard]] double lift(int i, const moving_support& e) const noexcept {
    const double x = positions_[static_cast<std::size_t>(i)];
    return e.side == 0 ? 1 - x : x;
  }

  template <class Real = double>
  void set_ports(const modal_rig& rig) {
    const int p = points(), all = contacts_ + unknowns();
    Eigen::MatrixX<Real> shape(bank_.size(), all);
    for (int j = 0; j < p; ++j) shape.col(j) = bank_.at(positions_[static_cast<std::size_t>(j)], j < contacts_);
    for (int j = p; j < all; ++j) shape.col(j) = bank_.at_end(end(j - p).side);
    bank_.set_ports(std::move(shape));
    set_left_out(rig);
    mobility_ = bank_.mobility;
    end_gain_ = bank_.end_gain + rest_end_;
    for (int i = 0; i < p; ++i) {
      mobility_(i, i) += rest_[i] / step_;
      for (int j = p; j < all; ++j) mobility_(i, j) -= step_ / 2 * lift(i, end(j - p));
    }
    last_ = Eigen::VectorX<Real>::Zero(p);
  }

  /// Modes above the limit answer quasi-statically: compliance at the points, share of the forces at the ends.
  template <class Real = double>
  void set_left_out(const modal_rig& rig) {
    const int p = points(), all = contacts_ + unknowns();
    const double string_mass = rig.string.linear_density_kg_m() * rig.string.length_m;
    rest_ = Eigen::VectorX<Real>::Zero(p), rest_twist_ = rest_, rest_end_ = -bank_.share;
    for (int j = 0; j < p; ++j) {
      const double x = positions_[static_cast<std::size_t>(j)];
      const auto held = static_end_forces(rig.string, x, clamping_);
      rest_end_.col(j) += Eigen::Vector2d{held[0], held[1]};
      rest_[j] = clamping_ == std::array<double, 2>{}
                     ? static_compliance_m_N(rig.string, x) - bank_.compliance(j, j)
                     : residual_compliance_m_N(rig.string, x, limit_Hz_);  // so high, no end is heard
      if (j >= contacts_ || !rig.torsion.present()) continue;
      rest_twist_[j] =
          x * (1 - x) / (rig.torsion.impedance_ratio * rig.torsion.speed_ratio * stretch_) - bank_.twist_compliance(j, j);
      rest_[j] += rest_twist_[j];
    }
    for (int j = p; j < all; ++j) {
      const int side = end(j - p).side;
      rest_end_(side, j) += string_mass / 3, rest_end_(1 - side, j) += string_mass / 6;
    }
  }

  template <class Real = double>
  void set_system() {
    const int l = load_count(), n = unknowns(), c = contacts_;
    contact_mobility_ = mobility_.topLeftCorner(c, c);
    if (n == 0) return;
    across_ = mobility_.block(0, c, c, n);
    Eigen::MatrixX<Real> a(n, n);
    drive_.setZero(n, c);
    for (int i = 0; i < l; ++i) {
      const double by = loads_[static_cast<std::size_t>(i)].alpha(step_);
      a.row(i) = by * mobility_.block(c + i, c, 1, n);
      a(i, i) += 1;
      drive_.row(i) = by * mobility_.block(c + i, 0, 1, c);
    }
    for (int i = l; i < n; ++i) {
      const auto& e = end(i - l);
      a.row(i) = end_gain_.block(e.side, c, 1, n);
      a(i, i) += e.inertia_and_force(step_)[0] + stretch_ * step_ * step_ / 6;
      if (n - l == 2) a(i, 2 * l + 1 - i) -= stretch_ * step_ * step_ / 6;
      drive_.row(i) = end_gain_.block(e.side, 0, 1, c);
    }
    solve_ = a.inverse();
    contact_mobility_ -= across_ * solve_ * drive_;
  }

  [[nodiscard]] Eigen::VectorXd known_side() const {
    const int l = load_count(), n = unknowns();
    Eigen::VectorXd b(n);
    for (int i = 0; i < l; ++i) {
      const moving_load& m = loads_[static_cast<std::size_t>(i)];
      b[i] = -m.alpha(step_) * free_[contacts_ + i] - m.beta(step_);
    }
    for (int i = l; i < n; ++i) {
      const auto& e = end(i - l);
      b[i] = e.inertia_and_force(step_)[1] + stretch_ * e.ahead(step_) - free_end_[e.side];
      if (n - l == 2) b[i] -= stretch_ * end(1 - (i - l)).ahead(step_);
    }
    return b;
  }

  void move(const Eigen::VectorXd& v, const Eigen::VectorXd& force) {
    for (int i = 0; i < load_count(); ++i) loads_[static_cast<std::size_t>(i)].move(step_, v[contacts_ + i]);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
      const auto [inertia, held] = ends_[i].inertia_and_force(step_);
      ends_[i].move(step_, held - inertia * force[points() + static_cast<Eigen::Index>(i)]);
    }
  }

  /// The free state at the end of the coming step: modes, what the modes left out take back, and where the ends carry the string.
  void read() {
    bank_.read_free(free_, free_end_);
    for (int i = 0; i < points(); ++i) {
      free_[i] -= rest_[i] / step_ * last_[i];
      for (const auto& e : ends_) free_[i] += lift(i, e) * (e.sum(&moving_mode::v) - step_ / 2 * e.sum(&moving_mode::g));
    }
  }

  /// Statically: rise of the points, then force on the yielding ends less nothing but the string's.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd deflection(const Eigen::VectorXd& force, const Eigen::VectorXd& x) const {
    const int p = points(), n = unknowns(), l = load_count();
    Eigen::VectorX<Real> f(p), y(contacts_ + n);
    f << force, x.head(l);
    y.head(p) = bank_.compliance.topLeftCorner(p, p) * f + rest_.cwiseProduct(f);
    for (int i = 0; i < p; ++i)
      for (int e = l; e < n; ++e) y[i] += lift(i, end(e - l)) * x[e];
    for (int e = l; e < n; ++e) {
      y[contacts_ + e] = -stretch_ * (x[e] - (n - l == 2 ? x[2 * l + 1 - e] : 0.0));
      for (int i = 0; i < p; ++i) y[contacts_ + e] += lift(i, end(e - l)) * f[i];
    }
    return y;
  }

  double stretch_, step_;
  int contacts_;
  std::array<double, 2> clamping_;
  double limit_Hz_;
  port_bank bank_;
  std::vector<double> positions_;
  std::vector<moving_load> loads_;
  std::vector<moving_support> ends_;
  Eigen::MatrixXd mobility_, end_gain_, rest_end_, solve_, across_, drive_, contact_mobility_;
  Eigen::VectorXd rest_, rest_twist_, free_, last_, answer_;
  Eigen::Vector2d free_end_ = Eigen::Vector2d::Zero(), sensed_N_;
};

}  // namespace rosin
