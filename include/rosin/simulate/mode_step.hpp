// tier: hosted
// SPDX-License-Identifier: MIT
//
// A damped oscillator over one step, exactly, under a force that is linear in it: with pole p = -s + i w_d and z = q' + i (...)
// as in modal_bank.hpp,
//
//     z(h) = e^{p h} z(0) + b (phi_a f(0) + phi_b f(h)) / mass,    b = 1 + i s / w_d.
//
#pragma once

#include <rosin/simulate/modal_string.hpp>

#include <cmath>
#include <complex>

namespace rosin {

/// phi_a and phi_b of the equation above: responses to the force at a step's begin and end.
struct step_response {
  std::complex<double> decay, begin, end;
};

[[nodiscard]] inline step_response respond_over_step(std::complex<double> pole, double step_s) {
  const auto x = pole * step_s;
  const auto decay = std::exp(x);
  std::complex<double> first = 0, second = 0;  // (e^x - 1) / x, (e^x - 1 - x) / x^2
  if (std::abs(x) < 0.3) {
    for (int k = 16; k >= 1; --k) second = (1.0 + second * x) / (k + 1.0);
    first = 1.0 + second * x;
  } else {
    first = (decay - 1.0) / x;
    second = (first - 1.0) / x;
  }
  return {decay, step_s * (first - second), step_s * second};
}

/// The same for a mode, b / mass included.
[[nodiscard]] inline step_response respond_over_step(const string_mode& mode, double step_s) {
  const auto p = mode.pole();
  const auto b = (1.0 - std::complex<double>{0, 1} * p.real() / p.imag()) / mode.mass_kg;
  const auto r = respond_over_step(p, step_s);
  return {r.decay, b * r.begin, b * r.end};
}

/// One mode by itself.
class driven_mode {
public:
  /// Does not move.
  driven_mode() = default;
  driven_mode(const string_mode& mode, double step_s) : response_{respond_over_step(mode, step_s)} {
    const auto p = mode.pole();
    const double w2 = mode.omega_rad_s * mode.omega_rad_s;
    from_velocity_ = p.real() / w2, from_companion_ = p.imag() / w2;
  }
  /// Velocity for 1 N at the end of the same step.
  [[nodiscard]] double mobility() const noexcept { return response_.end.real(); }
  /// Velocity at the end of the step under way if no force acts there.
  [[nodiscard]] double free() const noexcept { return free_.real(); }
  struct state {
    double velocity = 0, displacement = 0;
  };
  /// Ends the step with this force.
  state advance(double force_N) noexcept {
    const auto now = free_ + response_.end * force_N;
    free_ = response_.decay * now + response_.begin * force_N;
    return {now.real(), from_velocity_ * now.real() + from_companion_ * now.imag()};
  }
  /// At rest at that displacement, under the force that holds it there.
  void rest_at(double displacement, double force_N) noexcept {
    free_ = std::complex<double>{0, displacement / from_companion_} - response_.end * force_N;
  }

private:
  step_response response_{};
  std::complex<double> free_{};
  double from_velocity_ = 0, from_companion_ = 0;
};

}  // namespace rosin
