// tier: hosted
// SPDX-License-Identifier: MIT
//
// One table of partials for a string, from all ringings of it: frequency and decay of every partial with standard deviations.
// Takes may be tuned a little differently (temperature, a finger's pressure): the ratio of their pitches is taken out, from the
// partials that they share. Where takes disagree about a partial by more than their errors, the errors of the mean grow
// accordingly.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_structure.hpp>

#include <map>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct string_line {
  int number = 0;
  double frequency_Hz = 0, frequency_sd = 0, decay_per_s = 0, decay_sd = 0;
  double split_Hz = 0;  ///< to its second line, where pairs are each of their own; signed
};

struct line_table {
  std::vector<string_line> lines;  ///< by number
  std::vector<double> offset;      ///< of each ringing: its pitch / that of the table - 1
  [[nodiscard]] const string_line* find(int number) const noexcept {
    for (const auto& l : lines)
      if (l.number == number) return &l;
    return nullptr;
  }
};

namespace detail {

template <class Real = double>
std::optional<string_line> line_of_pair(const partial_track& t, double detuning) {
  const line_pair p = fit_pair(t, std::abs(detuning));
  const std::size_t main = detuning > 0 ? 0 : 1;  // the stronger
  const double shift = main == 0 ? 0 : p.shift_rad_s;
  std::vector<std::complex<double>> left = t.samples;
  const line_model both{
      {{p.amplitude[0], p.decay_per_s, p.detuning_rad_s}, {p.amplitude[1], p.decay_per_s, p.detuning_rad_s + p.shift_rad_s}},
      t.fit.model.centre_Hz,
      {}};
  const double noise =
      std::max(noise_beside(left_over(t.samples, t.rate_Hz, both), t.rate_Hz, both.parts[main], t.window).at_line,
               1e-24 * energy_of(t.samples));
  const Eigen::MatrixX<Real> information = p.information,
                             covariance = noise / 2 * information.completeOrthogonalDecomposition().pseudoInverse();
  return string_line{t.number,
                     t.fit.model.centre_Hz + (p.detuning_rad_s + shift) / full_turn,
                     std::sqrt(covariance(5, 5)) / full_turn,
                     p.decay_per_s,
                     std::sqrt(covariance(4, 4)),
                     0};
}

template <class = void>
std::optional<string_line> line_of(partial_track t, const structure_hypothesis& h, const pickup_ringing& r) {
  if (h.paired) return line_of_pair(t, h.pair.detuning);
  if (h.doubled)
    t.fit = one_or_two_lines(t.samples, t.rate_Hz, t.fit, 1.5 * r.tolerance_Hz, filled_with_noise(t.window, t.rate_Hz));
  const partial p = summary_of(t);
  string_line out{p.number, p.frequency_Hz, p.frequency_sd, p.decay_per_s, p.decay_sd, 0};
  if (t.fit.model.parts.size() < 2) return out;
  const auto& parts = t.fit.model.parts;
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  const std::size_t main = parts[0].energy(lasts) >= parts[1].energy(lasts) ? 0 : 1;
  out.split_Hz = (parts[1 - main].detuning_rad_s - parts[main].detuning_rad_s) / full_turn;
  return out;
}
ROSIN_INSTANTIATE(std::optional<string_line> line_of(partial_track, const structure_hypothesis&, const pickup_ringing&))

template <class Real = double>
double offset_between(const std::vector<string_line>& lines, const std::map<int, string_line>& reference) {
  std::vector<double> y, v;
  for (const auto& l : lines)
    if (const auto at = reference.find(l.number); at != reference.end()) {
      y.push_back(std::log(l.frequency_Hz / at->second.frequency_Hz));
      v.push_back((std::pow(l.frequency_sd, 2) + std::pow(at->second.frequency_sd, 2)) / std::pow(l.frequency_Hz, 2));
    }
  if (y.size() < 2) return y.empty() ? 0.0 : y[0];
  const auto n = static_cast<Eigen::Index>(y.size());
  const robust_data d{Eigen::Map<Eigen::VectorX<Real>>(y.data(), n), Eigen::Map<Eigen::VectorX<Real>>(v.data(), n),
                      Eigen::VectorX<Real>::Ones(n)};
  const auto constant = [](const Eigen::VectorX<Real>& theta, Eigen::VectorX<Real>& out, Eigen::MatrixX<Real>& J) {
    out.setConstant(theta[0]), J.setOnes();
  };
  return robust_regression(d, constant, Eigen::VectorX<Real>::Constant(1, median_of(d.y))).value[0];
}
ROSIN_INSTANTIATE(double offset_between(const std::vector<string_line>&, const std::map<int, string_line>&))

struct mean_of_several {
  double weights = 0, sum = 0, squares = 0;
  int count = 0;
  void add(double x, double sd) {
    const double w = 1 / (sd * sd);
    weights += w, sum += w * x, squares += w * x * x, ++count;
  }
  [[nodiscard]] double mean() const { return sum / weights; }
  [[nodiscard]] double sd() const {
    const double excess = count > 1 ? std::max(1.0, (squares - sum * sum / weights) / (count - 1)) : 1.0;
    return std::sqrt(excess / weights);
  }
};

template <class = void>
line_table combined(const std::vector<std::vector<string_line>>& each) {
  line_table table;
  std::size_t richest = 0;
  for (std::size_t i = 1; i < each.size(); ++i)
    if (each[i].size() > each[richest].size()) richest = i;
  std::map<int, string_line> reference;
  for (const auto& l : each[richest]) reference.emplace(l.number, l);
  std::map<int, std::array<mean_of_several, 2>> sums;
  std::map<int, mean_of_several> splits;
  for (const auto& lines : each) {
    table.offset.push_back(std::expm1(offset_between(lines, reference)));
    for (const auto& l : lines) {
      const double ratio = 1 + table.offset.back();
      sums[l.number][0].add(l.frequency_Hz / ratio, l.frequency_sd);
      sums[l.number][1].add(l.decay_per_s, l.decay_sd);
      if (l.split_Hz != 0) splits[l.number].add(l.split_Hz, l.frequency_sd);
    }
  }
  for (const auto& [number, s] : sums)
    table.lines.push_back(
        {number, s[0].mean(), s[0].sd(), s[1].mean(), s[1].sd(), splits.count(number) > 0 ? splits[number].mean() : 0.0});
  return table;
}
ROSIN_INSTANTIATE(line_table combined(const std::vector<std::vector<string_line>>&))

/// No glide is exactly as modelled: two hundredths of what it shifted a partial while that was heard stay in its error. Nor is the
/// decay, as amplitudes follow the tension, which falls: four times the glide stays in that one's.
inline void widen(std::vector<string_line>& lines, const glide_found& g) {
  if (!(g.relative > 0)) return;
  for (auto& l : lines) {
    const double heard = 0.7 / std::max(l.decay_per_s, 1e-3);
    l.frequency_sd = std::hypot(l.frequency_sd, 0.02 * l.frequency_Hz * g.relative * g.shape.path_s(l.number, heard) / heard);
    l.decay_sd = std::hypot(l.decay_sd, 4 * g.relative * l.decay_per_s);
  }
}

}  // namespace detail

/// All partials of these ringings that are damped lines, the structure being known. One `glide` each, where it glides.
template <class = void>
[[nodiscard]] line_table table_of(const std::vector<pickup_ringing>& all, const structure_hypothesis& h) {
  const auto still = h.glides ? detail::steady(all, h.glide) : all;
  std::vector<std::vector<string_line>> each;
  for (std::size_t k = 0; k < still.size(); ++k) {
    const auto& r = still[k];
    auto& lines = each.emplace_back();
    for (const auto& t : r.tracks)
      if (const auto l = detail::line_of(t, h, r); l && std::isfinite(l->frequency_sd) && std::isfinite(l->decay_sd) &&
                                                   l->decay_sd > 0 && l->frequency_sd > 0 &&
                                                   l->frequency_sd < 0.02 * r.fundamental_Hz && l->decay_per_s > l->decay_sd)
        lines.push_back(*l);
    if (h.glides) detail::widen(lines, h.glide[k]);
  }
  return detail::combined(each);
}
ROSIN_INSTANTIATE(line_table table_of(const std::vector<pickup_ringing>&, const structure_hypothesis&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
