// SPDX-License-Identifier: MIT
#include "fit_prediction.hpp"

#include <limits>

namespace tool {

namespace {

constexpr double pi = std::numbers::pi;

std::vector<double> filtered(const std::vector<double>& x, const rosin::fir& kernel) {
  std::vector<double> out(x.size(), std::numeric_limits<double>::quiet_NaN());
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  for (std::ptrdiff_t i = kernel.last(); i < n + kernel.first; ++i) {
    double sum = 0;
    for (int j = kernel.first; j <= kernel.last(); ++j)
      sum += kernel.taps[static_cast<std::size_t>(j - kernel.first)] * x[static_cast<std::size_t>(i - j)];
    out[static_cast<std::size_t>(i)] = sum;
  }
  return out;
}

/// What a take of this calibration is made of: partials of 1 N through gain and coupling, and what the coupling does to a step.
struct pluck_shape {
  std::vector<rosin::damped_line> lines;
  std::array<double, 2> held{}, corner{};  // before the release; rad/s

  pluck_shape(const rosin::pluck_fit_result& fit, double position, const rosin::band& limits, int most,
              const std::array<double, 2>& ac_coupled_Hz) {
    lines = rosin::pluck_lines(fit.string(), fit.own(), position, 0, limits, most);
    for (std::size_t c = 0; c < 2; ++c) {
      const double gain = std::exp(fit.value[rosin::pluck_layout::gain_near + static_cast<int>(c)]);
      corner[c] = 2 * pi * ac_coupled_Hz[c];
      if (corner[c] == 0) held[c] = gain * rosin::static_forces(position)[c];
      for (auto& line : lines) line.residue[c] *= gain * (corner[c] > 0 ? line.pole / (line.pole + corner[c]) : 1.0);
    }
  }

  /// Signal and its time derivative per newton, from sample `begin` on.
  void run(std::size_t begin, std::size_t count, double rate_Hz, double release_s, std::array<std::vector<double>, 2>& signal,
           std::array<std::vector<double>, 2>& slope) const {
    std::vector<rosin::damped_line> now = lines, rate_of_change = lines;
    for (std::size_t n = 0; n < lines.size(); ++n)
      for (std::size_t c = 0; c < 2; ++c) {
        now[n].residue[c] *= std::exp(lines[n].pole * (static_cast<double>(begin) / rate_Hz - release_s));
        rate_of_change[n].residue[c] = now[n].residue[c] * lines[n].pole;
      }
    const rosin::line_runner run(lines, 1 / rate_Hz);
    const Eigen::MatrixXd sum = run.sum(now, count), slopes = run.sum(rate_of_change, count);
    for (std::size_t c = 0; c < 2; ++c) {
      signal[c].assign(sum.data() + c * count, sum.data() + (c + 1) * count);
      slope[c].assign(slopes.data() + c * count, slopes.data() + (c + 1) * count);
    }
  }
};

/// Least squares for strength, shift of the release and one slow term a channel.
struct free_part {
  Eigen::Vector4d at = Eigen::Vector4d::Zero();  // strength, strength * shift, slow near, slow far
  double residual_ratio = 1;
};

free_part solve(const pluck_prediction& p, const pluck_shape& shape, std::size_t begin, std::size_t before,
                const std::array<std::vector<double>, 2>& signal, const std::array<std::vector<double>, 2>& slope) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double power = 0;
  const auto add = [&](std::size_t c, double y, double value, double derivative, double slow) {
    if (!std::isfinite(y)) return;
    Eigen::Vector4d row{value, -derivative, 0, 0};
    row[static_cast<Eigen::Index>(2 + c)] = slow;
    normal += row * row.transpose();
    right += row * y;
    power += y * y;
  };
  for (std::size_t c = 0; c < 2; ++c) {
    if (shape.corner[c] == 0)
      for (std::size_t i = 0; i < before; ++i) add(c, p.recorded_N[c][i], shape.held[c], 0, 1);
    for (std::size_t i = 0; i < signal[c].size(); ++i)
      add(c, p.recorded_N[c][begin + i], signal[c][i], slope[c][i],
          std::exp(-shape.corner[c] * static_cast<double>(i) / p.rate_Hz));
  }
  free_part out;
  out.at = normal.ldlt().solve(right);
  const double left = std::max(0.0, power - 2 * out.at.dot(right) + out.at.dot(normal * out.at));
  out.residual_ratio = power > 0 ? std::sqrt(left / power) : 1;
  return out;
}

void draw_model(pluck_prediction& p, const pluck_shape& shape, double slow_from_s) {
  const std::size_t n = p.recorded_N[0].size();
  const auto begin = std::min(n, static_cast<std::size_t>(std::ceil(p.release_s * p.rate_Hz)));
  std::array<std::vector<double>, 2> signal, slope;
  shape.run(begin, n - begin, p.rate_Hz, p.release_s, signal, slope);
  for (std::size_t c = 0; c < 2; ++c) {
    p.model_N[c].resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double moving = i < begin ? shape.held[c] : signal[c][i - begin];
      const double slow = std::exp(-shape.corner[c] * (static_cast<double>(i) / p.rate_Hz - slow_from_s));
      const bool unknown = shape.corner[c] > 0 && i < begin;  // what was before is lost in the amplifier
      p.model_N[c][i] = unknown ? std::numeric_limits<double>::quiet_NaN() : p.strength_N * moving + p.offset_N[c] * slow;
    }
  }
}

}  // namespace

rosin::outcome<pluck_prediction> predict_pluck(const rosin::pluck_fit_result& fit, const rosin::pluck_take& take, double position,
                                               const std::array<double, 2>& ac_coupled_Hz) {
  const rosin::pluck_options options;
  rosin::pluck_guess guess{fit.value[rosin::pluck_layout::fundamental]};
  const auto start = rosin::find_start({take}, guess);
  if (!start) return rosin::failure{start.error()};
  pluck_prediction out;
  out.name = take.name;
  out.rate_Hz = take.rate_Hz;
  out.release_s = start->release_s.front();
  out.limits = options.limits_for(take.rate_Hz, fit.string());
  const rosin::band_kernels kernels;
  const rosin::fir& kernel = kernels.of(out.limits, take.rate_Hz);
  for (std::size_t c = 0; c < 2; ++c) out.recorded_N[c] = filtered(take.force_N[c], kernel);

  const pluck_shape shape(fit, position, out.limits, options.most_partials, ac_coupled_Hz);
  const double periods = std::min(fit.horizon_periods, 1e6), guard = kernel.last() + 2;
  double slow_from_s = 0;
  free_part found;
  for (int pass = 0; pass < 6; ++pass) {
    const double release = out.release_s * out.rate_Hz, last = release + periods * out.rate_Hz / guess.fundamental_Hz;
    const auto before = static_cast<std::size_t>(std::max(0.0, std::floor(release - guard)));
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::ceil(release + guard)));
    const auto end = static_cast<std::size_t>(std::min(static_cast<double>(out.recorded_N[0].size()), last));
    if (begin + 16 > end) return rosin::failure{take.name + ": ends too soon after the release"};
    std::array<std::vector<double>, 2> signal, slope;
    shape.run(begin, end - begin, out.rate_Hz, out.release_s, signal, slope);
    found = solve(out, shape, begin, before, signal, slope);
    const double shift = std::abs(found.at[0]) > 0 ? found.at[1] / found.at[0] : 0;
    slow_from_s = static_cast<double>(begin) / out.rate_Hz;
    out.release_s += std::clamp(shift, -0.5 / out.rate_Hz, 0.5 / out.rate_Hz);
    if (std::abs(shift) * out.rate_Hz < 1e-6) break;
  }
  out.strength_N = found.at[0];
  out.offset_N = {found.at[2], found.at[3]};
  out.residual_ratio = found.residual_ratio;
  draw_model(out, shape, slow_from_s);
  return out;
}

}  // namespace tool
