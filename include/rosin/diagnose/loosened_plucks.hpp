// tier: hosted
// SPDX-License-Identifier: MIT
//
// What plucks leave may be no physics that was left out, but what no declared model is exact to: a loss that is uneven by some
// hundredths (loss_unevenness), a wire that is not set down twice at quite the same place. Neither is given a name. They are freed
// where that accounts for what a search has left, or for what its weaker effects were taken for, and then the search begins anew.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_exchange.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Of a pluck, as what is freed is worth no more: a loss that is 5 % uneven.
inline constexpr double most_loosened = 0.02;
/// Of the length: how far apart plucks may be that were meant to be made at one place.
inline constexpr double most_places_apart = 2e-3;

/// Where the parameters of one layout of the same takes stand in another, effects behind it; -1: nowhere.
[[nodiscard]] inline std::vector<Eigen::Index> places_in(const pluck_layout& to, const pluck_layout& from, Eigen::Index size) {
  std::vector<Eigen::Index> out(static_cast<std::size_t>(size), -1);
  const auto moves = [&](Eigen::Index first, Eigen::Index count, Eigen::Index where) {
    for (Eigen::Index i = 0; i < count; ++i) out[static_cast<std::size_t>(first + i)] = where + i;
  };
  moves(0, pluck_layout::first_position, 0);
  for (std::size_t t = from.takes(); t-- > 0;) {  // a place that is shared stands for its first take
    moves(from.position(t), 1, to.position(t));
    moves(from.at(t, 0), pluck_layout::take_size, to.at(t, 0));
  }
  const auto uneven = [](const pluck_layout& l) { return l.loss_scatter() - l.first_of_uneven(); };
  if (uneven(from) == uneven(to)) moves(from.first_of_uneven(), uneven(from), to.first_of_uneven());
  if (from.own_losses() == to.own_losses())
    moves(from.loss_scatter(), from.first_of_ends() - from.loss_scatter(), to.loss_scatter());
  if (from.size() - from.first_of_ends() == to.size() - to.first_of_ends())
    moves(from.first_of_ends(), from.size() - from.first_of_ends(), to.first_of_ends());
  moves(from.size(), size - from.size(), to.size());
  return out;
}

/// Values by another layout; what that alone has is 0, but for places, which begin where they were shared.
template <class Real = double>
[[nodiscard]] Eigen::VectorXd carried_over(const pluck_layout& to, const pluck_layout& from, const Eigen::VectorXd& v) {
  const auto places = places_in(to, from, v.size());
  Eigen::VectorX<Real> out = Eigen::VectorX<Real>::Zero(to.size() + v.size() - from.size());
  for (Eigen::Index p = 0; p < v.size(); ++p)
    if (places[static_cast<std::size_t>(p)] >= 0) out[places[static_cast<std::size_t>(p)]] = v[p];
  for (std::size_t t = 0; t < from.takes(); ++t) out[to.position(t)] = v[from.position(t)];
  return out;
}
ROSIN_INSTANTIATE(Eigen::VectorXd carried_over(const pluck_layout&, const pluck_layout&, const Eigen::VectorXd&))

[[nodiscard]] inline scene_data with_options(scene_data data, const pluck_options& options) {
  data.options = options;
  data.layout = pluck_layout(data.takes, options, data.guess.ends);
  return data;
}

/// The largest share by which the constant part of the loss is off at a partial.
[[nodiscard]] inline double largest_unevenness(const ringing_string& string, double highest_Hz) {
  double most = 0;
  for (double f = string.fundamental_Hz; f <= highest_Hz; f += string.fundamental_Hz)
    most = std::max(most, std::abs(string.loss.uneven(std::log(f / string.loss.reference_Hz))));
  return most;
}

/// Whether what was freed is as small as it has to be.
template <class = void>
[[nodiscard]] bool is_slight(const scene_data& data, const Eigen::VectorXd& v) {
  const double highest_Hz = data.options.limits_for(data.takes.front().rate_Hz).stop_Hz;
  if (largest_unevenness(data.layout.string(v), highest_Hz) > pluck_layout::uneven_doubt) return false;
  for (std::size_t t = 0; t < data.takes.size() && data.options.own_places; ++t)
    for (std::size_t other = 0; other < t; ++other)
      if (data.takes[t].position == data.takes[other].position &&
          std::abs(v[data.layout.position(t)] - v[data.layout.position(other)]) > most_places_apart)
        return false;
  return true;
}
ROSIN_INSTANTIATE(bool is_slight(const scene_data&, const Eigen::VectorXd&))

/// The effects that were found, and what is left of them where some are taken out: all of them first, none last.
template <class = void>
[[nodiscard]] std::vector<scene_fit> with_fewer(const scene_fit& found) {
  std::vector<scene_fit> out;
  const std::size_t count = found.effects.size(), sets = std::size_t{1} << std::min<std::size_t>(count, 4);
  for (std::size_t gone = 0; gone < sets; ++gone) {
    scene_fit fewer = found;
    for (std::size_t i = count; i-- > 0;)
      if ((gone >> i) & 1U) fewer = without(fewer, i);
    out.push_back(std::move(fewer));
  }
  return out;
}

/// What is to be freed, how the effects look then, and what that costs besides (in units of price_of).
struct loosened_fit {
  scene_data data;
  scene_fit fit;
  double parameters = 0;
};

template <class = void>
[[nodiscard]] loosened_fit fit_loosened(const scene_data& data, const scene_fit& fewer, double periods, bool uneven, bool own,
                                        std::array<double, 2> noise) {
  pluck_options options = data.options;
  options.uneven_loss = uneven || options.uneven_loss, options.own_places = own || options.own_places;
  loosened_fit out{with_options(data, options), {}, 0};
  out.parameters = static_cast<double>(out.data.layout.size() - data.layout.size());
  out.fit = fit_scene(out.data, fewer.effects, carried_over(out.data.layout, data.layout, fewer.value),
                      {{1000, periods, true, freedom::all}}, noise);
  return out;
}

/// Options with what accounts for most of what these effects leave, or for as much as some of them do and more likely. Of what
/// leaves more than a fiftieth of its first periods without some of its effects nothing else is asked.
template <class = void>
[[nodiscard]] std::optional<pluck_options> what_to_loosen(const scene_data& data, const scene_fit& found,
                                                          std::array<double, 2> noise) {
  constexpr double first_periods = 20;
  if (found.quality.inflation() == 1) return std::nullopt;
  const double was = found.quality.inflation() - 1, periods = found.horizon_periods;
  for (scene_fit& fewer : with_fewer(found)) {
    const bool all = fewer.effects.size() == found.effects.size();
    // `fewer` begins with what `found` leaves; each fit goes on only where the one before leaves little
    for (const double seen : {std::min(first_periods, periods), periods})
      if (!all && fewer.quality.residual_ratio[0] < most_loosened)
        fewer = fit_scene(data, fewer.effects, fewer.value, {{1000, seen, true, freedom::all}}, noise);
    if (!all && !(fewer.quality.residual_ratio[0] < most_loosened)) continue;
    const auto accounts = [&](bool uneven, bool own) -> std::optional<pluck_options> {
      const loosened_fit x = fit_loosened(data, fewer, periods, uneven, own, noise);
      const auto& q = x.fit.quality;
      const double price = price_of(x.fit, noise) + x.parameters * q.inflation() * std::log(q.samples[0] + q.samples[1]);
      const bool better = all ? q.inflation() - 1 < was / 3 : price < price_of(found, noise);
      if (x.parameters == 0 || !better || !is_slight(x.data, x.fit.value)) return std::nullopt;
      return x.data.options;
    };
    if (const auto both = accounts(true, true)) {
      if (const auto uneven = accounts(true, false)) return uneven;
      if (const auto own = accounts(false, true)) return own;
      return both;
    }
  }
  return std::nullopt;
}
ROSIN_INSTANTIATE(std::optional<pluck_options> what_to_loosen(const scene_data&, const scene_fit&, std::array<double, 2>))

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
