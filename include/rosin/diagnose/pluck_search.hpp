// tier: hosted
// SPDX-License-Identifier: MIT
//
// The search for what plucks miss. Effects are added one by one, each time the one that explains most, as long as it is worth it:
//
//     significance   the gain in ln L, divided by the misfit that is left (model error counts as noise), is at least 14;
//     worth          a further effect (any, where terminations are declared to move: these count as found) takes away at least
//                    two thirds of what the model so far leaves beyond the noise, and that is at least a hundredth (in
//                    amplitude) of what there was to explain: no model of a bead is exact either. Of less than that it takes
//                    away nearly all, and gains 300. Two that are not worth it alone may be together, to a ninth.
//
// Two effects found one after the other may stand in one another's place (pluck_exchange.hpp). What was found first may have been a
// wrong beginning, which hides the others: where it leaves most, and more than noise is left in the end, the search begins anew,
// in the first periods alone or without it.
//
// The first threshold holds the false-alarm rate of the whole search over the catalogue (its largest gain on plucks without
// an effect is 3 to 7). Evidence is  ln L - (k / 2) ln n.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_judgement.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

inline std::vector<std::string> ids_of(const scene_fit& f) {
  std::vector<std::string> ids;
  for (const pluck_effect& e : f.effects) ids.push_back(e.id());
  return ids;
}

inline int free_parameters(const scene_fit& f) {
  int k = 0;
  for (const pluck_effect& e : f.effects) k += static_cast<int>(e.parameters.size());
  return k;
}

/// The share of a mismatch's power that the best of `fits` leaves, as far as it looks.
template <class = void>
double share_left(const scene_data& data, const scene_fit& before, const std::vector<scene_fit>& fits,
                  std::array<double, 2> noise) {
  if (fits.empty()) return 1;
  const scene_fit plain =
      fit_scene(data, before.effects, before.value, {{1000, fits.front().horizon_periods, true, data.compared()}}, noise);
  double expected = 0;
  for (const double n : fits.front().quality.samples) expected += n;
  return (cost_of(fits.front(), noise) - expected) / std::max(1e-9, cost_of(plain, noise) - expected);
}

/// What searches in the same recordings know of one another.
struct search_memory {
  double stop_above = 1e300;       ///< a first effect that leaves more (inflation) is followed by no other
  known_starts starts{};           ///< of supports
  std::vector<scene_fit> first{};  ///< each effect alone, over all of the recordings, where a search began with all of them

  [[nodiscard]] bool is_hopeless(const scene_fit& f) const { return f.quality.inflation() > stop_above; }
  /// What the best of them leaves.
  [[nodiscard]] double first_leaves() const {
    return first.empty() || first.front().horizon_periods < 1e8 ? 1e300 : first.front().quality.inflation();
  }
};

/// Adds effects to the declared model one by one, as long as it is worth it.
class effect_search {
public:
  template <class = void>
  effect_search(pluck_diagnosis& d, const std::vector<pluck_effect>& all, search_memory& memory)
      : d_{d}, all_{all}, memory_{memory}, weigh_{d.declared.noise_N} {
    now_.value = d.declared.value, now_.sd = d.declared.sd, now_.covariance = d.declared.covariance;
    now_.horizon_periods = d.declared.horizon_periods, now_.converged = true;
    now_.quality.residual_ratio = d.declared.residual_ratio;
    if (d.data.layout.has_ends()) correct_ends();
  }

  template <class = void>
  void run(int most_effects) {
    const auto found = [&] { return static_cast<int>(now_.effects.size()); };
    while (found() < most_effects && add_one(found()) && !memory_.is_hopeless(now_)) {
    }
    d_.best = exchanged(d_.data, now_, all_, 1, noise_, [&](const scene_fit& rest, const scene_fit& fit, std::size_t which) {
      return is_worth(compare(rest, fit), fit.effects[which], 1);
    });
    if (d_.found_gain.size() > d_.best.effects.size()) d_.found_gain.resize(d_.best.effects.size());
    if (d_.best.effects.empty()) d_.best = d_.base;
    rank_all();
    std::sort(d_.ranking.begin(), d_.ranking.end(), [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
    for (double top = d_.ranking.front().log_evidence; auto& h : d_.ranking) h.log_evidence -= top;
  }
  /// What no fit could take for anything else, the mean of both channels.
  [[nodiscard]] double noise() const { return rms_of(noise_); }
  /// The effect found first, where it leaves most of what there was and more than noise is left in the end.
  [[nodiscard]] std::string doubtful_beginning() const {
    constexpr double most = 0.5, much = 1.5;
    return first_leaves_ > most && d_.best.quality.inflation() > much ? first_ : "";
  }

private:
  /// A model against the one before: gain in ln L, divided by the misfit that is left, and what either leaves beyond the noise.
  struct comparison {
    double temper = 1, gain = 0, left = 0, was = 0, samples = 0;
  };
  /// Declared terminations, as far off as they may be: what takes them further is none of theirs.
  template <class = void>
  void correct_ends() {
    scene_fit tried = fit_scene(d_.data, {}, now_.value, {{1000, 1e9, true, freedom::all}}, weigh_);
    if (d_.data.layout.ends_within_doubt(tried.value)) now_ = std::move(tried);
  }
  /// They count as an effect that was found: what their motion does, over so many periods, is what there was to explain.
  template <class = void>
  [[nodiscard]] scene_fit without_ends(double periods) const {
    scene_data rigid{d_.data.takes, d_.data.guess, d_.data.options, pluck_layout(d_.data.takes, d_.data.options)};
    rigid.guess.ends = {};
    return fit_scene(rigid, {}, now_.value.head(rigid.layout.size()), {{1000, periods, true}}, weigh_);
  }
  /// What there was to explain, in the units of the noise as it is known by now.
  [[nodiscard]] double all_there_was() const {
    return cost_of(nothing_found_, noise_) - nothing_found_.quality.samples[0] - nothing_found_.quality.samples[1];
  }
  /// Whether an effect takes away enough. Beside a strong one its own model's faults are worth something to others as well; but
  /// these leave most of them, and more than noise. What a declared end is off by is no other mode of it.
  [[nodiscard]] bool is_worth(const comparison& c, const pluck_effect& e, int round) const {
    if (round == 0 && !d_.data.layout.has_ends()) return true;
    constexpr double beyond_doubt = 300, all_but_noise = 2;
    const bool much = c.was > 1e-4 * all_there_was(), nearly_all = c.left < c.was / (c.temper < all_but_noise ? 15 : 30),
               at_known_end = e.at_end && e.place >= 0 && !d_.data.guess.ends[static_cast<std::size_t>(e.place)].modes.empty();
    return c.left < c.was / 3 && (much || (!at_known_end && nearly_all && c.gain > beyond_doubt));
  }

  /// Each effect alone is tried once only, whatever a search leaves out.
  template <class = void>
  [[nodiscard]] std::vector<scene_fit> remembered(const std::vector<pluck_effect>& catalogue) const {
    std::vector<scene_fit> fits = memory_.first;
    std::erase_if(fits, [&](const scene_fit& f) {
      return std::none_of(catalogue.begin(), catalogue.end(), [&](const auto& e) { return e.id() == f.effects.back().id(); });
    });
    put_in_order(d_.data, now_, fits, weigh_);
    return fits;
  }
  template <class = void>
  [[nodiscard]] std::vector<scene_fit> candidates(int round) {
    const std::vector<pluck_effect> catalogue = still_to_add(all_, now_.effects);
    const bool begins = round == 0 && d_.data.most_periods > 1e8;
    if (begins && !memory_.first.empty())
      if (auto fits = remembered(catalogue); !fits.empty()) return fits;
    std::vector<scene_fit> fits = newly_tried(catalogue, round);
    if (begins && memory_.first.empty()) memory_.first = fits;
    return fits;
  }
  template <class = void>
  [[nodiscard]] std::vector<scene_fit> newly_tried(const std::vector<pluck_effect>& catalogue, int round) const {
    const bool strong =
        round == 0 ? now_.horizon_periods < 1e8 || now_.quality.residual_ratio[0] > 0.05 : now_.quality.residual_ratio[0] > 0.1;
    std::vector<scene_fit> fits = one_more_effect(d_.data, now_, catalogue, strong, weigh_, memory_.starts);
    // Over all of a record, what is small per period may have turned partials too far for a score test: once more from the first
    // periods.
    const double tolerated = round == 0 ? 1.5 : 9, much = 0.25;
    if (strong || fits.empty() || !(fits.front().quality.inflation() > tolerated)) return fits;
    const double left = share_left(d_.data, now_, fits, weigh_);
    if (!(left > much)) return fits;
    std::vector<scene_fit> again = one_more_effect(d_.data, now_, catalogue, true, weigh_, memory_.starts);
    return !again.empty() && share_left(d_.data, now_, again, weigh_) < left ? again : fits;
  }
  template <class = void>
  void leave_alone() {
    d_.base = fit_scene(d_.data, {}, now_.value, {{1000, now_.horizon_periods, true, freedom::all}}, weigh_);
    noise_ = d_.base.quality.noise;
    rank(d_.base);
  }
  [[nodiscard]] comparison compare(const scene_fit& before, const scene_fit& tried) const {
    comparison c;
    c.temper = std::max(d_.data.least_temper, tried.quality.inflation());
    c.samples = tried.quality.samples[0] + tried.quality.samples[1];
    const double without = cost_of(before, noise_), with = cost_of(tried, noise_);
    c.gain = 0.5 * (without - with + before.losses_price - tried.losses_price) / c.temper;
    c.left = std::max(0.0, with - c.samples), c.was = std::max(1e-9, without - c.samples);
    return c;
  }
  void rank(const scene_fit& f) { d_.ranking.push_back({ids_of(f), 0, {}, f}); }
  /// All by one noise and one misfit, those of the best, and as if they had looked as far.
  void rank_all() {
    const auto samples = [](const scene_fit& f) { return std::max(1.0, f.quality.samples[0] + f.quality.samples[1]); };
    const auto there = [&](const pluck_hypothesis& h) { return h.ids == ids_of(d_.best); };
    if (std::none_of(d_.ranking.begin(), d_.ranking.end(), there)) rank(d_.best);
    const double n = samples(d_.best), temper = std::max(d_.data.least_temper, d_.best.quality.inflation());
    for (auto& h : d_.ranking)
      h.log_evidence = -0.5 * (cost_of(h.fit, noise_) * n / samples(h.fit) + h.fit.losses_price) / temper -
                       0.5 * free_parameters(h.fit) * std::log(n);
  }
  /// Whether the last effects of two fits are two models of the same effect.
  [[nodiscard]] static bool is_variant(const scene_fit& a, const scene_fit& b) {
    return a.effects.back().name == b.effects.back().name && a.effects.back().place == b.effects.back().place;
  }
  template <class = void>
  void accept(const std::vector<scene_fit>& fits, const comparison& c) {
    const scene_fit& tried = fits.front();
    d_.mismatched = true;
    d_.found_gain.push_back(c.gain);
    d_.alternatives.clear();
    for (const scene_fit& f : fits)
      if (!is_variant(f, tried) && f.horizon_periods == tried.horizon_periods &&
          0.5 * (cost_of(f, noise_) + f.losses_price - cost_of(tried, noise_) - tried.losses_price) / c.temper < 5 &&
          free_parameters(f) <= free_parameters(tried) + 2)
        d_.alternatives.push_back(f.effects.back().id());
    if (first_.empty()) first_ = tried.effects.back().name, first_leaves_ = c.left / c.was;
    weigh_ = noise_;  // by the declared model's, all that is left beside something strong would pass for noise
    now_ = or_with_own_losses(d_.data, tried, weigh_);
  }
  /// Whether one was found and another may follow.
  template <class = void>
  bool add_one(int round) {
    const std::vector<scene_fit> fits = candidates(round);
    if (fits.empty()) {
      if (round == 0) leave_alone();
      return false;
    }
    const scene_fit& tried = fits.front();
    const scene_fit before =
        fit_scene(d_.data, now_.effects, now_.value, {{1000, tried.horizon_periods, true, freedom::all}}, weigh_);
    for (std::size_t c = 0; c < 2; ++c) noise_[c] = std::min({noise_[c], before.quality.noise[c], tried.quality.noise[c]});
    const comparison c = compare(before, tried);
    if (round == 0) d_.base = before, nothing_found_ = d_.data.layout.has_ends() ? without_ends(tried.horizon_periods) : before;
    const bool worth = is_worth(c, tried.effects.back(), round);
    for (const scene_fit& f : fits)
      if (&f == &tried || (worth && !is_variant(f, tried))) rank(f);
    if (round == 0) rank(before);
    // Linear parameters of which there are many (hum) gain half a unit each from noise alone.
    const double chance = std::max(0, static_cast<int>(tried.effects.back().parameters.size()) - 3);
    if (!(c.gain > 14 + 0.5 * chance + 2 * std::sqrt(chance))) {
      if (round == 0 && before.horizon_periods < now_.horizon_periods) leave_alone();  // looked at no longer than it was tried
      return false;
    }
    constexpr double half_way = 2.0 / 3;  // of two that leave a ninth the better leaves no more by itself
    if (!worth) return round == 1 && c.left < half_way * c.was && add_with_another(fits, c);
    accept(fits, c);
    return round == 0 || now_.quality.inflation() != 1.0;
  }
  /// Two that take away too little each, as the other hides what they do, may be worth it together: to a ninth.
  template <class = void>
  bool add_with_another(const std::vector<scene_fit>& first, const comparison& alone) {
    const scene_fit as_was = now_;
    now_ = first.front();
    const std::vector<scene_fit> fits = candidates(2);
    now_ = as_was;
    if (fits.empty()) return false;
    const scene_fit& tried = fits.front();
    const scene_fit before =
        fit_scene(d_.data, now_.effects, now_.value, {{1000, tried.horizon_periods, true, freedom::all}}, weigh_);
    for (std::size_t c = 0; c < 2; ++c) noise_[c] = std::min(noise_[c], tried.quality.noise[c]);
    const comparison both = compare(before, tried);
    if (!(both.left < both.was / 9 && both.was > 1e-4 * all_there_was())) return false;
    rank(tried);
    accept(first, alone);
    accept(fits, both);
    return true;
  }

  pluck_diagnosis& d_;
  const std::vector<pluck_effect>& all_;
  search_memory& memory_;
  std::array<double, 2> weigh_, noise_{1e300, 1e300};
  scene_fit now_, nothing_found_;
  std::string first_;
  double first_leaves_ = 0;  ///< of the power of the mismatch
};
using search_result = std::pair<pluck_diagnosis, double>;

/// `d`, searched, and the noise. What is a doubtful beginning is kept unless a search that begins otherwise leaves a ninth: one of
/// the first periods, where that finds an effect whose model holds no longer; one without it.
template <class = void>
[[nodiscard]] search_result searched(const pluck_diagnosis& d, std::vector<pluck_effect> all, int most_effects,
                                     search_memory& memory, bool once_more = true) {
  search_result out{d, 0};
  effect_search search(out.first, all, memory);
  search.run(most_effects);
  out.second = search.noise();
  const std::string doubtful = search.doubtful_beginning();
  if (!once_more || doubtful.empty() || memory.is_hopeless(out.first.best)) return out;
  const auto excess = [](const search_result& x) { return x.first.best.quality.inflation() - 1; };
  const auto leaves_a_ninth = [&](const search_result& other) { return excess(other) < excess(out) / 9; };
  const auto is_brief = [](const pluck_effect& e) { return e.horizon_periods < 1e8; };
  const auto brief = std::find_if(all.begin(), all.end(), is_brief);
  if (brief != all.end()) {
    pluck_diagnosis early = d;
    early.data.most_periods = brief->horizon_periods;
    auto other = searched(early, all, most_effects, memory, false);
    other.first.data.most_periods = d.data.most_periods;
    const auto& found = other.first.best.effects;
    if (std::any_of(found.begin(), found.end(), is_brief) && leaves_a_ninth(other)) return other;
  }
  std::erase_if(all, [&](const pluck_effect& e) { return e.name == doubtful; });
  auto other = searched(d, std::move(all), most_effects, memory, false);
  return leaves_a_ninth(other) ? other : out;
}
ROSIN_INSTANTIATE(search_result searched(const pluck_diagnosis&, std::vector<pluck_effect>, int, search_memory&, bool))

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
