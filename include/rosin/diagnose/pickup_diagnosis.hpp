// tier: hosted
// SPDX-License-Identifier: MIT
//
// What plucks heard by a single pickup or microphone say of physics that was left out.
//
//     listen -> structure (glide, pairs) -> table of partials -> law (stiffness, losses, loads, supports) -> strays (hum, other strings)
//
// and once more from the beginning where that says where to listen: without the hum, which bends the partials that it comes near,
// and for partials where a law foretells them that were not found near multiples.
//
// The likelihood falls into these parts, since frequency and decay of every partial are free in the first and everything else is
// free in the second; so each part is searched by itself. Takes set aside are then predicted sample by sample
// (pickup_prediction.hpp), of which only pitch and the partials' amplitudes and phases are free. The same with each partial's own
// measured pole says how far any law could go.
//
#pragma once

#include <rosin/condition/low_pass.hpp>
#include <rosin/diagnose/pickup_findings.hpp>
#include <rosin/diagnose/pickup_prediction.hpp>
#include <rosin/propagate/band.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

template <class Real = double>
class pickup_examination {
public:
  pickup_examination(const std::vector<pickup_signal>& fitted, const std::vector<pickup_signal>& held, const pickup_question& ask)
      : fitted_{fitted}, held_{held}, ask_{ask} {}

  [[nodiscard]] outcome<pickup_diagnosis> run() {
    if (const auto why = examine(fitted_, held_)) return *why;
    foretold_ = d_.law.found.empty() ? std::vector<numbered_frequency>{} : not_found();
    if (!foretold_.empty() || !d_.strays.hum.empty())
      if (examine(without_hum(fitted_, ringings_, d_.heard, d_.structure.glide),
                  without_hum(held_, held_ringings_, held_heard_, held_glide_)))
        foretold_.clear(), (void)examine(fitted_, held_);  // what could be heard before
    pickup_namer{d_, ask_}.name_all();
    judge();
    return std::move(d_);
  }

private:
  [[nodiscard]] std::optional<failure> examine(const std::vector<pickup_signal>& fitted, const std::vector<pickup_signal>& held) {
    d_ = {}, ringings_.clear(), held_ringings_.clear(), held_heard_.clear(), held_glide_.clear(), held_tables_.clear();
    hear(fitted, ringings_, &d_.heard);
    if (ringings_.empty()) return failure{d_.warnings.empty() ? "no pluck to listen to" : d_.warnings.back()};
    find_structure();
    d_.table = table_of(ringings_, d_.structure);
    if (d_.table.lines.size() < 4) return failure{"partials: fewer than four are damped lines"};
    hear(held, held_ringings_, &held_heard_);
    prepare_held();
    find_law();
    find_stray_lines();
    return std::nullopt;
  }
  /// Partials that the law foretells among those of the table.
  [[nodiscard]] std::vector<numbered_frequency> not_found() const {
    std::vector<numbered_frequency> out;
    for (const auto& l : by_law(d_.law.best.law, 0))
      if (d_.table.find(l.number) == nullptr) out.push_back({l.number, l.pole.imag() / full_turn, 0});
    return out;
  }
  [[nodiscard]] std::vector<pickup_signal> without_hum(std::vector<pickup_signal> signals,
                                                       const std::vector<pickup_ringing>& heard,
                                                       const std::vector<std::size_t>& which,
                                                       const std::vector<glide_found>& glide) const {
    std::vector<predicted_line> hum;
    for (const auto& l : d_.strays.hum) hum.push_back({0, {0, full_turn * l.frequency_Hz}});
    for (std::size_t i = 0; i < heard.size() && !hum.empty(); ++i) {
      pickup_signal& s = signals[which[i]];
      take_out_lines(s, examined(s, heard[i]), hum, by_table(0), glide_in(glide, i));
    }
    return signals;
  }
  [[nodiscard]] static judged_stretch examined(const pickup_signal& s, const pickup_ringing& r) {
    return stretch_of(s, r.start_s, std::min(r.stop_s, r.start_s + 2));
  }
  void hear(const std::vector<pickup_signal>& signals, std::vector<pickup_ringing>& out, std::vector<std::size_t>* which) {
    for (std::size_t i = 0; i < signals.size(); ++i) {
      auto r = listen(signals[i], ask_.fundamental_Hz, foretold_);
      if (!r) d_.warnings.push_back(signals[i].take + ", channel " + signals[i].channel + ": not used: " + r.error());
      else out.push_back(*std::move(r)), which->push_back(i);
    }
  }

  void find_structure() {
    structure_question q{ask_.asks_for("tension-modulation"),
                         ask_.asks_for("second-polarization"),
                         ask_.is_declared("tension-modulation"),
                         ask_.is_declared("second-polarization"),
                         {}};
    for (const std::size_t i : d_.heard) q.power_known.push_back(fitted_[i].tells_slopes());
    d_.structures = structures_of(ringings_, q);
    d_.structure = d_.structures.front();
    if (!d_.structure.glides) return;
    mean_of_several k;
    for (std::size_t i = 0; i < ringings_.size(); ++i)
      if (const auto& g = d_.structure.glide[i]; g.relative > 0) {
        const double power = ringings_[i].strength();
        k.add(g.relative / power, std::hypot(g.sd, 0.01 * g.relative) / power);
      }
    // so far off were simulated strings
    d_.glide_per_power = k.mean(), d_.glide_per_power_sd = std::hypot(k.sd(), 0.05 * k.mean());
  }
  /// The glide that a ringing has by its strength, and by the decays that are known of the string.
  [[nodiscard]] glide_found glide_of(const pickup_ringing& r) const {
    const auto one =
        std::find_if(d_.structure.glide.begin(), d_.structure.glide.end(), [](const auto& g) { return g.relative > 0; });
    const bool by_power = one->shape.number.size() > 1 || one->shape.number[0] > 0;
    glide_shape shape = by_power ? shape_by_power(r) : one->shape;
    for (std::size_t i = 0; i < shape.number.size() && by_power; ++i)
      if (const string_line* line = d_.table.find(shape.number[i])) shape.rate_per_s[i] = 2 * line->decay_per_s;
    return {std::move(shape), d_.glide_per_power * r.strength(), 0, 0, 1};
  }
  void prepare_held() {
    structure_hypothesis still = d_.structure;
    still.glides = false;
    for (const auto& r : held_ringings_) {
      held_glide_.push_back(d_.structure.glides ? glide_of(r) : glide_found{});
      held_tables_.push_back(table_of({d_.structure.glides ? steady(r, held_glide_.back()) : r}, still));
    }
  }

  void find_law() {
    std::vector<law_effect> catalogue =
        law_effects(d_.table.lines.front().frequency_Hz / d_.table.lines.front().number, d_.table.lines.back().number);
    std::vector<law_parameter> parameters = ideal_string(ask_.fundamental_Hz);
    pickup_law start{ask_.fundamental_Hz, 0, 1e-3};
    fitted_law declared = fit_law(d_.table, parameters, start);
    for (const auto& e : catalogue)
      if (ask_.is_declared(e.name)) declared = with_effect(d_.table, declared, e);
    std::erase_if(catalogue, [&](const auto& e) { return !ask_.asks_for(e.name); });
    std::vector<std::vector<string_line>> held;
    for (const auto& t : held_tables_) held.push_back(t.lines);
    greedy_limits limits;
    limits.pitch_Hz = ask_.fundamental_Hz;
    d_.law = search_law(d_.table, declared, catalogue, held.empty() ? line_table{} : combined(held), limits);
  }

  void find_stray_lines() {
    if (!ask_.asks_for("mains-hum") && !ask_.asks_for("sympathetic-string")) return;
    std::vector<stray_lines> each;
    for (std::size_t i = 0; i < ringings_.size(); ++i)
      each.push_back(strays_of(fitted_[d_.heard[i]], ringings_[i], glide_in(d_.structure.glide, i)));
    for (std::size_t i = 0; i < held_ringings_.size(); ++i)
      each.push_back(strays_of(held_[held_heard_[i]], held_ringings_[i], glide_in(held_glide_, i)));
    d_.strays = each.front();
    keep_common(&stray_lines::hum, each);
    keep_common(&stray_lines::others, each);
    if (!ask_.asks_for("mains-hum")) d_.strays.hum.clear();
    if (!ask_.asks_for("sympathetic-string")) d_.strays.others.clear();
    if (d_.strays.hum.empty()) d_.strays.mains_Hz = 0;
  }
  [[nodiscard]] stray_lines strays_of(const pickup_signal& s, const pickup_ringing& r, const glide_found* glide) const {
    const auto& law = d_.law.best.law;
    std::vector<double> own;
    const int highest = d_.table.lines.back().number;
    for (int n = 1; n < highest + 12; ++n)
      for (const double b : {0.0, 0.25, 0.5, 1.0}) own.push_back(partial_frequency(law.fundamental_Hz, b * law.inharmonicity, n));
    for (const auto& l : d_.table.lines) own.push_back(l.frequency_Hz);
    for (const auto& l : by_law(law, 0)) own.push_back(l.pole.imag() / full_turn);
    return find_strays(left_by_lines(examined(s, r), by_table(0), glide), s.rate_Hz, own,
                       std::max(5.0, 0.06 * law.fundamental_Hz), d_.table.lines.back().frequency_Hz);
  }
  /// What not every recording has goes.
  void keep_common(std::vector<stray_line> stray_lines::*kind, const std::vector<stray_lines>& each) {
    std::erase_if(d_.strays.*kind, [&](const stray_line& l) {
      return std::any_of(each.begin() + 1, each.end(), [&](const stray_lines& s) {
        const double reach = std::max(s.resolution_Hz, d_.strays.resolution_Hz);
        return std::none_of((s.*kind).begin(), (s.*kind).end(),
                            [&](const stray_line& m) { return std::abs(m.frequency_Hz - l.frequency_Hz) < reach; });
      });
    });
  }
  /// Null where nothing glides.
  [[nodiscard]] const glide_found* glide_in(const std::vector<glide_found>& glide, std::size_t i) const {
    return d_.structure.glides ? &glide[i] : nullptr;
  }

  [[nodiscard]] std::vector<predicted_line> by_law(const pickup_law& law, double offset) const {
    std::vector<predicted_line> out;
    for (int n = 1; n <= d_.table.lines.back().number; ++n) {
      const auto s = pickup_pole(law, n);
      out.push_back({n, {s.real(), s.imag() * (1 + offset)}});
    }
    return out;
  }
  [[nodiscard]] static std::vector<predicted_line> lines_in(const line_table& table, double offset) {
    std::vector<predicted_line> out;
    for (const auto& l : table.lines) out.push_back({l.number, {-l.decay_per_s, full_turn * l.frequency_Hz * (1 + offset)}});
    return out;
  }
  [[nodiscard]] std::vector<predicted_line> by_table(double offset) const { return doubled(lines_in(d_.table, offset)); }
  /// With the second line of each, as the structure has it.
  [[nodiscard]] std::vector<predicted_line> doubled(std::vector<predicted_line> lines) const {
    const std::size_t count = lines.size();
    for (std::size_t i = 0; i < count; ++i) {
      auto other = lines[i];
      const string_line* own = d_.table.find(other.number);
      if (d_.structure.paired) other.pole *= 1 + d_.structure.pair.detuning;
      else if (d_.structure.doubled && own != nullptr) other.pole += std::complex<double>{0, full_turn * own->split_Hz};
      if (other.pole != lines[i].pole) lines.push_back(other);
    }
    return lines;
  }
  [[nodiscard]] std::vector<predicted_line> with_strays(std::vector<predicted_line> lines) const {
    for (const auto& l : d_.strays.hum) lines.push_back({0, {0, full_turn * l.frequency_Hz}});
    for (const auto& l : d_.strays.others) lines.push_back({0, {std::min(0.0, std::log(l.change)), full_turn * l.frequency_Hz}});
    return lines;
  }

  void judge() {
    std::map<int, string_line> reference;
    for (const auto& l : d_.table.lines) reference.emplace(l.number, l);
    for (std::size_t i = 0; i < held_ringings_.size(); ++i)
      d_.judged.push_back(judged(i, std::expm1(offset_between(held_tables_[i].lines, reference))));
    const auto overall = [&](const auto& level) {
      double sum = 0;
      for (const auto& j : d_.judged) sum += std::pow(level(j) / j.recorded, 2) / static_cast<double>(d_.judged.size());
      return std::sqrt(sum);
    };
    d_.before = overall([](const auto& j) { return rms_level(j.before); });
    d_.after = overall([](const auto& j) { return rms_level(j.after); });
    d_.floor = overall([](const auto& j) { return j.noise; });
    d_.own_poles = overall([](const auto& j) { return j.own_poles; });
    decide();
  }
  /// Up to the partials of the table: of those above nothing is foretold.
  [[nodiscard]] pickup_signal in_band(pickup_signal s) const {
    const double f0 = d_.law.declared.law.fundamental_Hz, top = d_.table.lines.back().frequency_Hz;
    s.values = low_pass<double>(s.values, s.rate_Hz, band{top + 0.1 * f0, top + 0.9 * f0});
    return s;
  }
  [[nodiscard]] judged_ringing judged(std::size_t i, double offset) const {
    const auto& r = held_ringings_[i];
    const auto s = in_band(held_[held_heard_[i]]);
    const auto stretch = stretch_of(s, r.start_s, std::min(r.stop_s, r.start_s + ask_.longest_s));
    const glide_found* glide = glide_in(held_glide_, i);
    judged_ringing j{s.take, s.channel, s.rate_Hz, r.start_s, 0, rms_level(stretch.x), {}, {}, 0};
    const auto plain = by_law(d_.law.declared.law, offset);
    j.before = left_by_lines(stretch, ask_.is_declared("second-polarization") ? doubled(plain) : plain,
                             ask_.is_declared("tension-modulation") ? glide : nullptr);
    j.after = left_by_lines(stretch, with_strays(doubled(by_law(d_.law.best.law, offset))), glide);
    j.own_poles = rms_level(left_by_lines(stretch, with_strays(by_table(offset)), glide));
    const auto by_itself = left_by_lines(stretch, with_strays(doubled(lines_in(held_tables_[i], 0))), glide);
    j.noise = std::min(quietest_piece(by_itself, s.rate_Hz), rms_level(j.after));
    return j;
  }

  void decide() {
    const double excess = std::sqrt(std::max(0.0, d_.after * d_.after - d_.floor * d_.floor)),
                 was = std::sqrt(std::max(0.0, d_.before * d_.before - d_.floor * d_.floor));
    d_.mismatched = !d_.missing.empty() || was > 0.5 * d_.floor;
    d_.explained = !d_.mismatched || (!d_.missing.empty() && excess < std::max(0.5 * d_.floor, 0.12 * was));
    double most = 0;
    for (std::size_t i = 0; i < d_.judged.size(); ++i)
      if (const double x = rms_level(d_.judged[i].before) / std::max(d_.judged[i].noise, 1e-300); x > most)
        most = x, d_.worst = i;
    if (!d_.judged.empty()) locate(d_.judged[d_.worst]);
  }
  void locate(const judged_ringing& j) {
    const auto block = std::max<std::size_t>(64, static_cast<std::size_t>(0.05 * j.rate_Hz));
    double most = 0;
    std::span<const double> x{j.before};
    std::size_t at = 0;
    for (std::size_t k = 0; k + block <= x.size(); k += block / 2)
      if (const double p = rms_level(x.subspan(k, block)); p > most) most = p, at = k;
    d_.time_s = {j.start_s + static_cast<double>(at) / j.rate_Hz, j.start_s + static_cast<double>(at + block) / j.rate_Hz};
    const double f0 = d_.law.declared.law.fundamental_Hz;
    const baseband_bank bank{x, j.rate_Hz, std::min(64.0, 0.45 * f0)};
    most = 0;
    for (int n = 1; n <= d_.table.lines.back().number; ++n)
      if (const double p = energy_of(bank.around(pickup_pole(d_.law.best.law, n).imag() / full_turn).samples); p > most)
        most = p, d_.band_Hz = {(n - 0.5) * f0, (n + 0.5) * f0};
  }

  const std::vector<pickup_signal>& fitted_;
  const std::vector<pickup_signal>& held_;
  const pickup_question& ask_;
  pickup_diagnosis d_;
  std::vector<pickup_ringing> ringings_, held_ringings_;
  std::vector<std::size_t> held_heard_;
  std::vector<glide_found> held_glide_;
  std::vector<line_table> held_tables_;
  std::vector<numbered_frequency> foretold_;  ///< where to listen besides
};

}  // namespace detail

/// `held`: recordings that are predicted only; never empty.
template <class = void>
[[nodiscard]] outcome<pickup_diagnosis> diagnose_pickups(const std::vector<pickup_signal>& fitted,
                                                         const std::vector<pickup_signal>& held, const pickup_question& ask) {
  return detail::pickup_examination(fitted, held, ask).run();
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
