// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Temperature of the rosin in the contact (Smith and Woodhouse 2000). A layer of
// thickness delta on an area A = pi a^2 is heated by friction, cooled by fresh rosin that slides in, and conducts heat
// into the rod, whose surface is renewed by sliding too, and into the string, whose is not:
//
//     A rho c delta Theta' = P - |v_r| a delta rho c Theta - A q_rod - A q_string
//
// Conduction into a half space remembers: q = K / sqrt(pi D) int Theta'(t') (t - t')^(-1/2) dt'. Here the kernel is a
// sum of 14 exponentials, tau_j = 30 ns 4^j, and a constant, within 0.3 % from 1 us to 0.1 s: each is one state.
// Sliding shortens the rod's memory by exp(-r t), r = 3 |v_r| / (8 a); in steady sliding that gives
// K Theta sqrt(r / D). Within a step Theta runs straight; the step is implicit in Theta, explicit in the heating.
//
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace rosin {

/// A half space's thermal data.
template <class T>
struct half_space {
  T conductivity_W_mK{}, density_kg_m3{}, heat_J_kgK{};

  /// K / sqrt(pi D), D = K / (rho c).
  [[nodiscard]] T conduction() const noexcept {
    using std::sqrt;
    return sqrt(conductivity_W_mK * density_kg_m3 * heat_J_kgK / T(3.14159265358979323846));
  }
};

/// A rod thick with rosin, a steel string seen through rosin (conductivity: the geometric mean), a layer that is sheared.
/// Handbook values for the materials; thickness and area of the layer are guesses of the right size.
template <class T = double>
struct contact_heat_parameters {
  T layer_m = T(2e-6);
  T layer_density_kg_m3 = T(1070), layer_heat_J_kgK = T(1600);
  T area_per_newton_m2 = T(1e-7);
  half_space<T> rod{T(0.2), T(1070), T(1600)};
  half_space<T> string{T(3.2), T(7850), T(460)};

  [[nodiscard]] T layer_capacity_J_m2K() const noexcept { return layer_m * layer_density_kg_m3 * layer_heat_J_kgK; }
  /// The same with nothing lost to the string, as steady sliding is usually evaluated.
  [[nodiscard]] contact_heat_parameters without_string() const noexcept {
    contact_heat_parameters alone = *this;
    alone.string = {};
    return alone;
  }
};

template <class T = double>
class contact_heat {
public:
  static constexpr std::size_t states = 15;  // 14 exponentials and the constant

  explicit contact_heat(const contact_heat_parameters<T>& parameters = {}) noexcept : given_{parameters} {
    T tau = T(3e-8);
    for (std::size_t j = 0; j + 1 < states; ++j, tau *= 4) {
      rate_[j] = 1 / tau;
      weight_[j] = T(1.38629436111989061883) / sqrt_(T(3.14159265358979323846) * tau);  // ln 4 / sqrt(pi tau)
    }
    rate_.back() = 0;
    weight_.back() = 2 / sqrt_(T(2) * T(3.14159265358979323846) * tau / 4);
  }

  /// One step with friction power P and slip speed |v_r|, both >= 0; returns the new temperature above the surroundings.
  T operator()(T power_W, T slip_m_s, T normal_N, T step_s) noexcept {
    using std::exp;
    if (step_s != step_) set_step(step_s);
    if (normal_N > 0) resize(normal_N);
    const T r = renewal(slip_m_s);
    if (r > 0) set_answers(sliding_, r, exp(-r * step_s));
    const answers& on_rod = r > 0 ? sliding_ : still_;
    const memory rod = recall(rod_, on_rod), string = recall(string_, still_);
    const T capacity = given_.layer_capacity_J_m2K() / step_s;
    const T rise = (capacity * rise_ + power_W / area_ - rod_conduction_ * rod.past - string_conduction_ * string.past) /
                   (capacity + swept(slip_m_s) + leak() + rod_conduction_ * rod.now + string_conduction_ * string.now);
    remember(rod_, rise, on_rod);
    remember(string_, rise, still_);
    return rise_ = rise;
  }

  /// Heat lost per kelvin in endless steady sliding, W/K: what the steps above settle to.
  [[nodiscard]] T steady_loss_W_K(T slip_m_s, T normal_N) const noexcept {
    contact_heat sized = *this;
    sized.resize(normal_N);
    const T r = sized.renewal(slip_m_s);
    T rod = 0;
    for (std::size_t j = 0; j < states; ++j) rod += r > 0 ? weight_[j] * r / (rate_[j] + r) : T(0);
    return sized.area_ *
           (sized.swept(slip_m_s) + sized.leak() + given_.rod.conduction() * rod + given_.string.conduction() * weight_.back());
  }

  [[nodiscard]] T temperature_rise_K() const noexcept { return rise_; }
  void reset() noexcept {
    rise_ = 0;
    rod_.fill(0);
    string_.fill(0);
  }

private:
  using kernel = std::array<T, states>;
  /// Flux = past + now Theta_new, in units of K / sqrt(pi D).
  struct memory {
    T past = 0, now = 0;
  };
  /// Answers of all exponentials, after a step, to a Theta that rose by 1 K (weighted), and to renewal against 1 K (the same).
  struct answers {
    kernel decay{}, rise{}, renewal{};
    T risen = 0, now = 0;  ///< sum of rise, and of rise + renewal
  };
  void set_answers(answers& a, T r, T fade) const noexcept {
    for (std::size_t j = 0; j < states; ++j) {
      const T total = rate_[j] + r, held = total > 0 ? weight_[j] * (1 - decay_[j] * fade) / total : weight_[j] * step_;
      a.decay[j] = decay_[j] * fade, a.rise[j] = held / step_, a.renewal[j] = held * r;
    }
    a.risen = 0, a.now = 0;
    for (std::size_t j = 0; j < states; ++j) a.risen += a.rise[j], a.now += a.rise[j] + a.renewal[j];
  }
  [[nodiscard]] memory recall(const kernel& state, const answers& a) const noexcept {
    static_assert(states % 3 == 0);
    T one = -a.risen * rise_, two = 0, three = 0;  // so that no sum waits for the one before
    for (std::size_t j = 0; j < states; j += 3)
      one += a.decay[j] * state[j], two += a.decay[j + 1] * state[j + 1], three += a.decay[j + 2] * state[j + 2];
    return {one + two + three, a.now};
  }
  void remember(kernel& state, T rise, const answers& a) const noexcept {
    for (std::size_t j = 0; j < states; ++j) state[j] = a.decay[j] * state[j] + a.rise[j] * (rise - rise_) + a.renewal[j] * rise;
  }
  [[nodiscard]] static T sqrt_(T x) noexcept {
    using std::sqrt;
    return sqrt(x);
  }
  void set_step(T step_s) noexcept {
    using std::exp;
    step_ = step_s;
    for (std::size_t j = 0; j < states; ++j) decay_[j] = exp(-rate_[j] * step_s);
    set_answers(still_, T(0), T(1));
  }
  void resize(T normal_N) noexcept {
    if (normal_N == normal_) return;
    normal_ = normal_N;
    area_ = given_.area_per_newton_m2 * normal_N;
    radius_ = sqrt_(area_ / T(3.14159265358979323846));
  }
  /// All per unit area: 1/s, W/(m2 K), W/(m2 K).
  [[nodiscard]] T renewal(T slip_m_s) const noexcept { return 3 * slip_m_s / (8 * radius_); }
  [[nodiscard]] T swept(T slip_m_s) const noexcept { return slip_m_s * radius_ * given_.layer_capacity_J_m2K() / area_; }
  [[nodiscard]] T leak() const noexcept { return 4 * given_.string.conductivity_W_mK / (T(3.14159265358979323846) * radius_); }

  contact_heat_parameters<T> given_;
  kernel rate_{}, weight_{}, decay_{}, rod_{}, string_{};
  answers still_{}, sliding_{};
  T rod_conduction_ = given_.rod.conduction(), string_conduction_ = given_.string.conduction();
  T step_ = 0, normal_ = 0, area_ = 1, radius_ = 1, rise_ = 0;
};

}  // namespace rosin
