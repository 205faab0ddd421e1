// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where does what a model lacks act? Whatever acts on a linear string at one place gives both ends their share of one unknown, at
// every complex frequency s = sigma + i w (damped, so that a cut record has a transform):
//
//     a force at x:      r_near : r_far = A(1 - x) : A(x)      (string_response.hpp; the common determinant cancels)
//     an end that moves: r_near : r_far = own : other
//     a sensor:          r_near : r_far = 1 : 0
//
// At the right place the part of (r_near, r_far) across that direction is noise; the smallest sum of its squares tells the place.
// Nuisances of the fit (release, strength, pitch) may go along: the same part of their columns is fitted to it.
//
// What is looked at begins after the release. From then on a force on the string at x and, half a period later, its opposite at
// 1 - x are one motion: what the release itself does is found at either (where_plucked()).
//
#pragma once

#include <rosin/calibrate/damped_spectrum.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/scene_fit.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What acts where: on the string, at one of its ends, in one of the channels, or where the string is plucked, as does a release
/// that is not clean, or whatever both channels have in common.
enum class acting { on_string, near_end, far_end, near_channel, far_channel, with_release };

struct acting_place {
  acting on = acting::on_string;
  double position = 0.5, sd = 0;  ///< fraction of the length from the near end; on the string only
  double left = 1;                ///< share of the mismatch's power that nothing there explains
  double left_elsewhere = 1;      ///< the same of the best place of another kind
};

/// How far a nuisance is from what is known of it, and that knowledge's standard deviation; sd 0: nothing is known.
struct nuisance_doubt {
  double off = 0, sd = 0;
};

/// What the model leaves of a take's first part, and what moves with its nuisances: the same samples of both channels.
struct unexplained_part {
  std::array<Eigen::VectorXd, 2> force_N;
  std::vector<std::array<Eigen::VectorXd, 2>> nuisances{};
  double rate_Hz = 0;
  std::vector<Eigen::Index> parameters{};  ///< which these are
  std::vector<nuisance_doubt> doubts{};    ///< one for each nuisance, or none
};

namespace detail {

/// What a fit leaves of the ringing part of a take, and how it moves with every parameter that is free there.
template <class Real = double>
unexplained_part left_by(const line_problem<scene_plucks>& problem, const Eigen::VectorXd& v, std::size_t take) {
  unexplained_part out{residual_of(problem, v, take), {}, problem.rate_Hz(take), {}, {}};
  for (Eigen::Index p = 0; p < problem.model().size(); ++p) {
    if (!problem.model().is_free(p) || !problem.model().concerns(p, take)) continue;
    const double h = problem.model().step(p, v);
    Eigen::VectorX<Real> up = v;
    up[p] += h;
    auto moved = residual_of(problem, up, take);
    for (std::size_t c = 0; c < 2; ++c) moved[c] = (moved[c] - out.force_N[c]) / h;
    out.nuisances.push_back(std::move(moved));
    out.parameters.push_back(p);
  }
  return out;
}
ROSIN_INSTANTIATE(unexplained_part left_by(const line_problem<scene_plucks>&, const Eigen::VectorXd&, std::size_t))

/// What the channels make of forces on the ends: sensors, crosstalk, gains.
[[nodiscard]] inline Eigen::Vector2cd recorded_of(const pluck_scene& scene, const std::array<double, 2>& gain,
                                                  std::complex<double> s, std::complex<double> near, std::complex<double> far) {
  const std::complex<double> a = near * scene.sensors[0](s), b = far * scene.sensors[1](s);
  return {gain[0] * (a + scene.crosstalk * b), gain[1] * (b + scene.crosstalk * a)};
}

}  // namespace detail

template <class Real = double>
class place_search {
public:
  /// gain: recorded / true of each channel; noise: white, of each channel.
  place_search(const pluck_scene& scene, std::array<double, 2> gain, const band& limits, const unexplained_part& left,
               std::array<double, 2> noise)
      : scene_{scene}, gain_{gain}, sure_{1 / noise[0], 1 / noise[1]}, line_{line_over(
                                                                           static_cast<std::size_t>(left.force_N[0].size()),
                                                                           left.rate_Hz, limits.pass_Hz)} {
    const auto first = static_cast<std::size_t>(0.3 * scene.string.fundamental_Hz * static_cast<double>(line_.samples) /
                                                line_.rate_Hz),
               bins = line_.bins();
    const std::size_t stride = std::max<std::size_t>(1, (bins - std::min(bins, first)) / most_bins);
    for (std::size_t k = first; k < bins; k += stride) bins_.push_back(k), at_.emplace_back(scene, line_.at(k));
    residual_ = spectra(left.force_N);
    for (const auto& n : left.nuisances) nuisances_.push_back(spectra(n));
    power_ = residual_.squaredNorm();
    // of one channel
    noise_power_ = static_cast<double>(bins_.size()) * line_.weighted_samples() / (line_.rate_Hz * line_.rate_Hz);
    alike_ = std::max(1.0, faded / static_cast<double>(stride));
    doubts_ = left.doubts;
  }

  /// The place that leaves least.
  [[nodiscard]] acting_place operator()() const {
    std::vector<acting_place> all{on_string()};
    for (const acting on : {acting::near_end, acting::far_end, acting::near_channel, acting::far_channel})
      all.push_back({on, on == acting::far_end || on == acting::far_channel ? 1.0 : 0.0, 0, across(on, 0) / power_});
    std::nth_element(all.begin(), all.begin() + 1, all.end(), [](const auto& a, const auto& b) { return a.left < b.left; });
    all[0].left_elsewhere = all[1].left;
    return all[0];
  }
  /// The same of places on the string, between two of them.
  [[nodiscard]] acting_place on_string(double from = 0, double to = 1) const {
    constexpr int grid = 64;
    const int first = 1 + static_cast<int>(from * grid), last = static_cast<int>(to * grid) - 1;
    int low = first;
    double least = 1e300;
    for (int i = first; i <= last; ++i)
      if (const double l = across(acting::on_string, static_cast<double>(i) / grid); l < least) least = l, low = i;
    return refined(std::max(static_cast<double>(low - 1) / grid, at_end),
                   std::min(static_cast<double>(low + 1) / grid, 1 - at_end));
  }

  /// How much of each nuisance is in what is left, the action at that place taken out.
  [[nodiscard]] Eigen::VectorXd nuisances(const acting_place& at) const {
    const auto [left, moved] = parts_across(at.on, at.position);
    return fitted(left, moved);
  }
  /// Power across the shares of a place, nuisances as they are and as far as they are from what is known of them, over noise.
  [[nodiscard]] double misfit(const acting_place& at) const {
    return parts_across(at.on, at.position).first.squaredNorm() / noise_power_;
  }
  /// Their covariance, noise being all that lies across.
  [[nodiscard]] Eigen::MatrixXd covariance(const acting_place& at) const {
    return row_variance() * inverse_normal(parts_across(at.on, at.position).second);
  }
  /// There is more than noise, which is taken for white.
  [[nodiscard]] bool is_mismatch() const { return 2 * noise_power_ < most_noise * power_; }
  /// No other kind of place does nearly as well, and it accounts for nearly all that the nuisances by themselves do not, which
  /// is no small part of the mismatch: where they could take up most of it, the fit was led astray, and so is the place.
  [[nodiscard]] bool is_clear(const acting_place& at) const {
    const double beside = power_beside_nuisances();
    return beside > least_beside * power_ && at.left < clearly_less * at.left_elsewhere &&
           at.left * power_ < most_left * beside + 1.5 * noise_power_;
  }
  /// What acts at that place is nearly all of it. Of the noise one of two unknowns is left.
  [[nodiscard]] bool is_accounted_for(const acting_place& at) const { return at.left < most_left + 1.5 * noise_power_ / power_; }

  /// The line of frequencies for so many samples: of the last, exp(-12) is left.
  [[nodiscard]] static damped_line_of_frequencies line_over(std::size_t samples, double rate_Hz, double highest_Hz) {
    return {rate_Hz, faded * rate_Hz / static_cast<double>(samples), samples, highest_Hz};
  }

private:
  static constexpr double faded = 12, most_noise = 0.25, most_left = 0.1, clearly_less = 0.3, least_beside = 0.1;
  static constexpr double at_end = 0.005;  // nearer to an end than that is what acts in its channel
  static constexpr std::size_t most_bins = 2000;
  using spectrum_pair = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 2>;

  [[nodiscard]] spectrum_pair spectra(const std::array<Eigen::VectorXd, 2>& x) const {
    spectrum_pair out(static_cast<Eigen::Index>(bins_.size()), 2);
    for (std::size_t c = 0; c < 2; ++c) {
      const auto all = damped_spectrum(line_, {x[c].data(), static_cast<std::size_t>(x[c].size())});
      for (std::size_t k = 0; k < bins_.size(); ++k)
        out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(c)) = sure_[c] * all[bins_[k]];
    }
    return out;
  }

  /// Shares of both channels, whitened.
  [[nodiscard]] Eigen::Vector2cd shares(acting on, double x, std::size_t i) const {
    if (on == acting::near_channel) return {1, 0};
    if (on == acting::far_channel) return {0, 1};
    const std::complex<double> s = line_.at(bins_[i]);
    std::array<std::complex<double>, 2> n{at_[i].own_end(), at_[i].other_end()};
    if (on == acting::far_end) std::swap(n[0], n[1]);
    if (on == acting::on_string)
      n = scene_.plain_string() ? std::array{at_[i].end_force(0, x), at_[i].end_force(1, x)}
                                : close_loop(scene_, x, s).times_determinant;
    const Eigen::Vector2cd seen = detail::recorded_of(scene_, gain_, s, n[0], n[1]);
    return {seen[0] * sure_[0], seen[1] * sure_[1]};
  }

  /// Of the noise in one row of parts_across(), as if neighbours did not tell the same.
  [[nodiscard]] double row_variance() const { return 0.5 * alike_ * noise_power_ / static_cast<double>(bins_.size()); }

  /// What lies across the shares of a place: of the mismatch, and of each nuisance (a column each); real parts, then imaginary
  /// ones, then what is known of the nuisances.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::MatrixXd> parts_across(acting on, double x) const {
    const auto rows = static_cast<Eigen::Index>(bins_.size()), columns = static_cast<Eigen::Index>(nuisances_.size());
    const auto known = static_cast<Eigen::Index>(doubts_.size());
    std::pair<Eigen::VectorX<Real>, Eigen::MatrixX<Real>> out{Eigen::VectorX<Real>::Zero(2 * rows + known),
                                                              Eigen::MatrixX<Real>::Zero(2 * rows + known, columns)};
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Eigen::Vector2cd n = shares(on, x, static_cast<std::size_t>(i)).normalized();
      const auto part = [&](const spectrum_pair& r) { return n[1] * r(i, 0) - n[0] * r(i, 1); };
      const auto put = [&](auto&& column, std::complex<double> z) { column[i] = z.real(), column[rows + i] = z.imag(); };
      put(out.first, part(residual_));
      for (Eigen::Index k = 0; k < columns; ++k) put(out.second.col(k), part(nuisances_[static_cast<std::size_t>(k)]));
    }
    for (Eigen::Index k = 0; k < known; ++k)
      if (const auto& [off, sd] = doubts_[static_cast<std::size_t>(k)]; sd > 0)
        out.second(2 * rows + k, k) = std::sqrt(row_variance()) / sd, out.first[2 * rows + k] = off * out.second(2 * rows + k, k);
    return out;
  }
  /// (J^T J)^-1, what no column tells left small; zero for a column that is (of one channel's gain, across the other).
  [[nodiscard]] static Eigen::MatrixXd inverse_normal(const Eigen::MatrixXd& moved) {
    const Eigen::VectorX<Real> scale = moved.colwise().norm().unaryExpr([](double norm) { return norm > 0 ? 1 / norm : 0; });
    const Eigen::MatrixX<Real> unit = moved * scale.asDiagonal();
    Eigen::MatrixX<Real> normal = unit.transpose() * unit;
    normal.diagonal().array() += 1e-10;
    return scale.asDiagonal() * normal.ldlt().solve(Eigen::MatrixX<Real>(scale.asDiagonal()));
  }
  /// Least squares of the first by the second.
  [[nodiscard]] static Eigen::VectorXd fitted(const Eigen::VectorXd& left, const Eigen::MatrixXd& moved) {
    return inverse_normal(moved) * (moved.transpose() * left);
  }
  /// Power of both channels, with the nuisances' part taken out.
  [[nodiscard]] double power_beside_nuisances() const {
    const auto parts = [](const spectrum_pair& r) {
      Eigen::VectorX<Real> out(4 * r.rows());
      out << r.col(0).real(), r.col(0).imag(), r.col(1).real(), r.col(1).imag();
      return out;
    };
    const Eigen::VectorX<Real> left = parts(residual_);
    Eigen::MatrixX<Real> moved(left.size(), static_cast<Eigen::Index>(nuisances_.size()));
    for (std::size_t k = 0; k < nuisances_.size(); ++k) moved.col(static_cast<Eigen::Index>(k)) = parts(nuisances_[k]);
    return nuisances_.empty() ? left.squaredNorm() : (left - moved * fitted(left, moved)).squaredNorm();
  }
  /// Power across the shares of a place, with the nuisances' part taken out.
  [[nodiscard]] double across(acting on, double x) const {
    const auto [left, moved] = parts_across(on, x);
    return moved.cols() > 0 ? (left - moved * fitted(left, moved)).squaredNorm() : left.squaredNorm();
  }

  /// By golden sections; the standard deviation from the curvature, misfit counted as noise.
  [[nodiscard]] acting_place refined(double low, double high) const {
    const double ratio = (std::sqrt(5.0) - 1) / 2;
    double a = high - ratio * (high - low), b = low + ratio * (high - low);
    double at_a = across(acting::on_string, a), at_b = across(acting::on_string, b);
    while (high - low > 1e-6)
      if (at_a < at_b) high = b, b = a, at_b = at_a, a = high - ratio * (high - low), at_a = across(acting::on_string, a);
      else low = a, a = b, at_a = at_b, b = low + ratio * (high - low), at_b = across(acting::on_string, b);
    const double x = (low + high) / 2, h = 2e-4, least = across(acting::on_string, x);
    const double bend = (across(acting::on_string, x - h) + across(acting::on_string, x + h) - 2 * least) / (h * h);
    const double unit = alike_ * std::max(least, noise_power_) / static_cast<double>(bins_.size());  // of one bin
    return {acting::on_string, x, bend > 0 ? std::sqrt(unit / bend) : 0.5, least / power_};
  }

  pluck_scene scene_;
  std::array<double, 2> gain_, sure_;
  damped_line_of_frequencies line_;
  double power_ = 0, noise_power_ = 0, alike_ = 1;  // so many neighbouring bins tell the same
  std::vector<std::size_t> bins_;
  std::vector<string_at> at_;
  spectrum_pair residual_;
  std::vector<spectrum_pair> nuisances_;
  std::vector<nuisance_doubt> doubts_;
};

/// The place, told for the release if it is where the string is plucked or the mirror image of that.
[[nodiscard]] inline acting_place where_plucked(acting_place found, double contact) noexcept {
  constexpr double near = 1e-3;
  if (found.on == acting::on_string &&
      std::min(std::abs(found.position - contact), std::abs(1 - found.position - contact)) < near)
    found.on = acting::with_release, found.position = contact;
  return found;
}

/// Where what a fit leaves of one of its takes acts, over the first periods; nothing where that is mostly noise, or no single place
/// explains nearly all of it, or one of another kind does nearly as well.
template <class = void>
[[nodiscard]] std::optional<acting_place> place_of_residual(const scene_data& data, const scene_fit& fit, std::size_t take) {
  constexpr double most_periods = 24, least_periods = 2;
  const auto problem = data.problem(
      fit.effects, fit.value,
      {1000, std::min(most_periods, fit.horizon_periods), true, data.layout.has_ends() ? freedom::no_corrections : freedom::all},
      {1, 1});  // an end that is free would take up what acts there
  const pluck_scene scene = problem.model().scene(fit.value, static_cast<int>(take));
  if (static_cast<double>(problem.part(take, 1).count()) < least_periods * problem.rate_Hz(take) / scene.string.fundamental_Hz)
    return std::nullopt;
  const std::array<double, 2> gain{pluck_layout::gain(fit.value, 0), pluck_layout::gain(fit.value, 1)};
  const place_search search(scene, gain, problem.limits(), detail::left_by(problem, fit.value, take), fit.quality.noise);
  if (!search.is_mismatch()) return std::nullopt;
  const acting_place found = where_plucked(search(), fit.value[data.layout.position(take)]);
  return search.is_clear(found) ? std::optional(found) : std::nullopt;
}
ROSIN_INSTANTIATE(std::optional<acting_place> place_of_residual(const scene_data&, const scene_fit&, std::size_t))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
