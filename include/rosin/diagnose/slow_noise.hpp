// tier: hosted
// SPDX-License-Identifier: MIT
//
// Noise of sensors and amplifiers grows towards low frequencies, far beyond the white noise that every fit weighs recordings by:
// held forces and first periods then seem to tell what they do not. Below the pitch nothing of a string rings. So what a model
// leaves there, of all of a recording, is taken out where it is noise: well above the white noise at most frequencies, there to
// the end as at the beginning (what a pluck brings about dies away), in every take, no stronger after strong plucks than after weak
// ones, and not the foot of what is left at the partials; and between the first partials, too, as far up as there is more than white
// noise. A line that stands out stays: that is hum.
//
//     slow(n) = sum_k c_k cos(pi k (n + 1/2) / N),   k = 1 ... 2 N f_edge / rate
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_judgement.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/math/median.hpp>

#include <numeric>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// What a model leaves of a take at low frequencies, of both channels.
class slow_rest {
public:
  static constexpr int most_partials = 8;  ///< so many gaps beside partials are looked at

  template <class Real = double>
  slow_rest(const line_problem<scene_plucks>& problem, const Eigen::VectorXd& v, std::size_t take) {
    const double rate = problem.rate_Hz(take), pitch_Hz = v[0], edge_Hz = most_partials * pitch_Hz;
    for (const std::size_t part : {0U, 1U}) {
      const auto& s = problem.part(take, part);
      if (s.count() == 0) continue;
      const auto lines = problem.lines(v, take, part);
      const Eigen::MatrixX<Real> model = line_runner(lines, 1 / rate).sum(lines, s.count());
      const auto begin = static_cast<Eigen::Index>(std::lround(s.begin_s * rate));
      if (left_.rows() == 0) first_ = begin;
      const Eigen::Index at = begin - first_, n = static_cast<Eigen::Index>(s.count());
      left_.conservativeResizeLike(Eigen::MatrixX<Real>::Zero(at + n, 2));
      for (Eigen::Index c = 0; c < 2; ++c) left_.block(at, c, n, 1) = s.data[static_cast<std::size_t>(c)] - model.col(c);
      if (part == 1) released_ = at;
    }
    const double size = static_cast<double>(left_.rows());
    per_partial_ = 2 * size * pitch_Hz / rate;
    content_ = Eigen::MatrixX<Real>::Zero(static_cast<Eigen::Index>(2 * size * edge_Hz / rate), 2);
    if (content_.rows() == 0) return;
    eigen_fft<double> fft(2 * static_cast<std::size_t>(left_.rows()));
    for (Eigen::Index c = 0; c < 2; ++c) {
      Eigen::VectorX<Real> padded = Eigen::VectorX<Real>::Zero(2 * left_.rows());
      padded.head(left_.rows()) = left_.col(c);
      Eigen::VectorX<std::complex<Real>> bins(left_.rows() + 1);
      fft.forward(padded.data(), bins.data());
      for (Eigen::Index k = 0; k < content_.rows(); ++k)
        content_(k, c) = 2 / size * (bins[k + 1] * std::conj(half_sample(k))).real();
    }
  }

  /// Of the waves in a gap (0: below the pitch, 1: between the first partials, ..., -1: at any partial): power over what white noise
  /// would give it.
  [[nodiscard]] std::vector<double> over(double noise_N, Eigen::Index channel, int gap) const {
    std::vector<double> out;
    for (Eigen::Index k = 0; k < content_.rows(); ++k)
      if (gap_of(k) == gap) out.push_back(std::pow(content_(k, channel) / noise_N, 2) * 0.5 * static_cast<double>(left_.rows()));
    return out;
  }
  /// Leaves out what lies at partials, and in this gap and beyond.
  void keep_below(int gap, Eigen::Index channel) {
    for (Eigen::Index k = 0; k < content_.rows(); ++k)
      if (gap_of(k) < 0 || gap_of(k) >= gap) content_(k, channel) = 0;
  }
  /// Those that stand out among their neighbours, as hum does, are not noise.
  template <class Real = double>
  void spare_lines(double times) {
    constexpr Eigen::Index reach = 8;
    const Eigen::MatrixX<Real> all = content_;
    for (Eigen::Index c = 0; c < 2; ++c)
      for (Eigen::Index k = 0; k < all.rows(); ++k) {
        std::vector<double> around;
        for (Eigen::Index i = std::max<Eigen::Index>(0, k - reach); i < std::min(all.rows(), k + reach + 1); ++i)
          if (std::abs(i - k) > 2) around.push_back(std::pow(all(i, c), 2));
        if (!around.empty() && std::pow(all(k, c), 2) > times * median_of(around) && k > 2)
          content_.block(std::max<Eigen::Index>(0, k - 1), c, std::min<Eigen::Index>(3, all.rows() - k + 1), 1).setZero();
      }
  }
  /// The samples of a record of this length, in one channel.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd slow(Eigen::Index channel, Eigen::Index length) const {
    const Eigen::Index n = left_.rows();
    Eigen::VectorX<std::complex<Real>> bins = Eigen::VectorX<std::complex<Real>>::Zero(n + 1);
    for (Eigen::Index k = 0; k < content_.rows(); ++k)
      bins[k + 1] = static_cast<double>(n) * content_(k, channel) * half_sample(k);
    Eigen::VectorX<Real> whole(2 * n), out(length);
    eigen_fft<double>(2 * static_cast<std::size_t>(n)).inverse(bins.data(), whole.data());
    for (Eigen::Index i = 0; i < length; ++i) out[i] = whole[((i - first_) % (2 * n) + 2 * n) % (2 * n)];
    return out;
  }
  /// Mean squares in the first and the last two fifths of what rings.
  template <class Real = double>
  [[nodiscard]] std::array<double, 2> early_and_late(Eigen::Index channel) const {
    const Eigen::VectorX<Real> x = slow(channel, first_ + left_.rows()).tail(left_.rows() - released_);
    const Eigen::Index part = std::max<Eigen::Index>(1, 2 * x.size() / 5);
    return {x.head(part).squaredNorm() / static_cast<double>(part), x.tail(part).squaredNorm() / static_cast<double>(part)};
  }

private:
  /// By how much a wave turns in half a sample.
  [[nodiscard]] std::complex<double> half_sample(Eigen::Index k) const {
    return std::polar(1.0, 0.5 * std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(left_.rows()));
  }

  /// Of a wave; -1: at a partial.
  [[nodiscard]] int gap_of(Eigen::Index k) const noexcept {
    constexpr double aside = 0.08;
    const double at = static_cast<double>(k + 1) / per_partial_, nearest = std::round(at);
    return nearest >= 1 && std::abs(at - nearest) < aside ? -1 : static_cast<int>(at);
  }

  Eigen::MatrixXd left_, content_;
  double per_partial_ = 1;  ///< waves from one partial to the next
  Eigen::Index first_ = 0, released_ = 0;
};

/// A channel's slow noise by all takes: up to which gap it is more than white noise, and how much more.
struct slow_noise {
  int gaps = 0;  ///< 0: there is none
  double over = 1;
};

template <class = void>
[[nodiscard]] slow_noise slow_noise_of(std::vector<slow_rest> rests, const std::vector<pluck_take>& takes, double noise_N,
                                       Eigen::Index channel) {
  constexpr double white_median = 0.455, much = 3, least_late = 0.2, foot = 10;
  slow_noise found;
  std::array<double, 2> beside_pitch{1, 1};  // below and above
  for (; found.gaps < slow_rest::most_partials; ++found.gaps) {
    std::vector<double> over;
    for (const slow_rest& r : rests) {
      const auto one = r.over(noise_N, channel, found.gaps);
      if (found.gaps == 0 && !one.empty() && median_of(one) < much / 2 * white_median) return {};
      over.insert(over.end(), one.begin(), one.end());
    }
    if (over.size() < 8) break;
    const double here = median_of(over) / white_median;
    if (!(here > (found.gaps == 0 ? much : much / 2))) break;
    if (found.gaps < 2) beside_pitch[static_cast<std::size_t>(found.gaps)] = here;
  }
  found.over = (beside_pitch[0] + beside_pitch[1]) / 2;
  if (found.gaps == 0) return {};
  std::vector<double> at_partials;
  for (const slow_rest& r : rests) {
    const auto one = r.over(noise_N, channel, -1);
    at_partials.insert(at_partials.end(), one.begin(), one.end());
  }
  const double ringing = std::accumulate(at_partials.begin(), at_partials.end(), 0.0);
  if (ringing > foot * found.over * static_cast<double>(at_partials.size())) return {};
  double early = 0, late = 0;
  std::vector<double> power;
  for (slow_rest& r : rests) {
    r.keep_below(1, channel);
    const auto [first, last] = r.early_and_late(channel);
    early += first, late += last;
    power.push_back(first + last);
  }
  if (!(late > least_late * early)) return {};
  const auto by_strength = [](const pluck_take& a, const pluck_take& b) { return a.strength_N < b.strength_N; };
  const auto [weak, strong] = std::minmax_element(takes.begin(), takes.end(), by_strength);
  const double ratio = std::pow(strong->strength_N / weak->strength_N, 2);
  const bool grows = ratio >= 2 && power[static_cast<std::size_t>(strong - takes.begin())] >=
                                       std::max(4.0, 0.7 * ratio) * power[static_cast<std::size_t>(weak - takes.begin())];
  return grows ? slow_noise{} : found;
}

}  // namespace detail

/// Takes that were fitted and held out, without their slow noise.
struct plucks_without_slow_noise {
  std::vector<pluck_take> takes, held;
  double over = 1;  ///< what is left of it at the first partials, in power over white noise
};

/// Nothing where there is none. What was found beyond doubt is not noise; what is in doubt may be.
template <class Real = double>
[[nodiscard]] std::optional<plucks_without_slow_noise> without_slow_noise(const pluck_diagnosis& d,
                                                                          const std::vector<pluck_take>& held) {
  constexpr double beyond_doubt = 200, stands_out = 20;
  scene_fit fit = d.best;
  for (std::size_t i = fit.effects.size(); i-- > 0;)
    if (i >= d.found_gain.size() || d.found_gain[i] < beyond_doubt) fit = detail::without(fit, i);
  const fit_stage all{1000, std::min(fit.horizon_periods, d.data.most_periods_with(fit.effects)), true, freedom::all};
  if (fit.effects.size() < d.best.effects.size()) fit = fit_scene(d.data, fit.effects, fit.value, {all}, fit.quality.noise);
  std::vector<pluck_take> takes = d.data.takes;
  std::vector<detail::slow_rest> rests;
  const auto whole = d.data.problem(fit.effects, fit.value, {1000, 1e9, true, freedom::all}, {1, 1});
  for (std::size_t t = 0; t < takes.size(); ++t) rests.push_back(detail::slow_rest(whole, fit.value, t));
  for (const pluck_take& take : held) {
    const auto seen = detail::see(d.data, fit, take);
    if (!seen) return std::nullopt;
    rests.push_back(detail::slow_rest(
        seen->data.problem(seen->fit.effects, seen->fit.value, {1000, 1e9, true, freedom::all}, {1, 1}), seen->fit.value, 0));
    takes.push_back(take);
  }
  const std::array<detail::slow_noise, 2> slow{detail::slow_noise_of(rests, takes, fit.quality.noise[0], 0),
                                               detail::slow_noise_of(rests, takes, fit.quality.noise[1], 1)};
  if (slow[0].gaps == 0 && slow[1].gaps == 0) return std::nullopt;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    rests[t].spare_lines(stands_out);
    for (const std::size_t c : {0U, 1U}) {
      const auto channel = static_cast<Eigen::Index>(c);
      auto& x = takes[t].force_N[c];
      rests[t].keep_below(slow[c].gaps, channel);
      const Eigen::VectorX<Real> rest = rests[t].slow(channel, static_cast<Eigen::Index>(x.size()));
      Eigen::Map<Eigen::VectorX<Real>>(x.data(), rest.size()) -= rest;
    }
  }
  const auto fitted = static_cast<std::ptrdiff_t>(d.data.takes.size());
  return plucks_without_slow_noise{
      {takes.begin(), takes.begin() + fitted}, {takes.begin() + fitted, takes.end()}, std::max(slow[0].over, slow[1].over)};
}
ROSIN_INSTANTIATE(std::optional<plucks_without_slow_noise> without_slow_noise(const pluck_diagnosis&,
                                                                              const std::vector<pluck_take>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
