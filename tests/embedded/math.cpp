// SPDX-License-Identifier: MIT
#include <rosin/math/lanes.hpp>
#include <rosin/math/levenberg_marquardt.hpp>
#include <rosin/math/reweighted_regression.hpp>
#include <rosin/math/robust_loss.hpp>

extern "C" void rosin_lanes(float* data, const float* twiddle) noexcept {
  using lanes = rosin::lane_complex<float, rosin::register_lanes<float>>;
  const lanes a = lanes::load(data), b = lanes::load(data + 2 * rosin::register_lanes<float>);
  plus_i(a + b, (a - b).times(twiddle)).conj().store(data);
  minus_i(a, b.times_conj(twiddle)).store(data + 2 * rosin::register_lanes<float>);
}

// These two headers are hosted for the sake of sizes that are not fixed. What is fixed allocates nothing.
namespace {

struct decay {
  const float* y;
  int count;
  [[nodiscard]] rosin::normal_equations<float, 2> linearise(const Eigen::Vector2f& b) const {
    auto equations = rosin::normal_equations<float, 2>::zero();
    for (int i = 0; i < count; ++i) {
      const float t = static_cast<float>(i), e = std::exp(-b[1] * t), r = y[i] - b[0] * e;
      const Eigen::Vector2f slope(e, -t * b[0] * e);
      equations.hessian += slope * slope.transpose(), equations.gradient += r * slope, equations.cost += r * r;
    }
    return equations;
  }
};

}  // namespace

extern "C" int rosin_fit_decay(const float* y, int count, float* b) {
  const auto found = rosin::levenberg_marquardt(decay{y, count}, Eigen::Vector2f(b[0], b[1]));
  b[0] = found.at[0], b[1] = found.at[1];
  return found.converged() ? found.iterations : -1;
}

extern "C" float rosin_robust_line(const float* y, int count, float scale, float* b) {
  Eigen::Vector2f value(b[0], b[1]);
  const float cost = rosin::reweighted_pass(
      rosin::student_loss<float>{}, scale, 0, count,
      [&](Eigen::Index i) {
        return rosin::regression_row<float, 2>{{1.0F, static_cast<float>(i)}, y[i]};
      },
      value);
  b[0] = value[0], b[1] = value[1];
  return cost;
}
