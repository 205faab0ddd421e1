// tier: hosted
// SPDX-License-Identifier: MIT
//
// Plucks of a string together with effects of the catalogue, as the fit sees them: the parameters of pluck_layout, then those of
// the effects. Poles depend on what all takes share only, so they are kept: a take's position, release or gain costs no new
// search.
//
#pragma once

#include <rosin/calibrate/pluck_problem.hpp>
#include <rosin/diagnose/pluck_effect.hpp>
#include <rosin/diagnose/scene_lines.hpp>

#include <memory>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Strings met so far, the newest last: their poles, each search begun from the nearest, and their lines for each place of a
/// pluck.
class string_memory {
public:
  template <class = void>
  [[nodiscard]] const std::vector<damped_line>& lines(const Eigen::VectorXd& key, const pluck_scene& scene, double position,
                                                      const band& limits, int most) {
    entry& e = of(key, scene, limits.stop_Hz, most);
    for (const auto& [place, lines] : e.lines)
      if (place == position) return lines;
    return e.lines.emplace_back(position, string_lines(scene, position, most, e.poles, limits.stop_Hz)).second;
  }

private:
  struct entry {
    Eigen::VectorXd key;
    std::vector<std::complex<double>> poles;
    std::vector<std::pair<double, std::vector<damped_line>>> lines;
  };

  template <class = void>
  entry& of(const Eigen::VectorXd& key, const pluck_scene& scene, double highest_Hz, int most) {
    for (auto& e : kept_)
      if (e.key == key) return e;
    std::vector<std::complex<double>> start;
    double nearest = 0.02;
    for (const auto& e : kept_) {
      const double apart = ((e.key - key).array() / (e.key.array().abs() + 1e-9)).abs().maxCoeff();
      if (apart < nearest) nearest = apart, start = e.poles;
    }
    if (kept_.size() > std::max<std::size_t>(80, 4 * static_cast<std::size_t>(key.size())))
      kept_.erase(kept_.begin(), kept_.begin() + 40);
    return kept_.emplace_back(entry{key, string_poles(scene, highest_Hz, most, start), {}});
  }

  std::vector<entry> kept_;
};

}  // namespace detail

/// Fitted value of a parameter from its physical one, and back.
[[nodiscard]] inline double to_fitted(const effect_parameter& p, double physical) {
  return p.logarithmic ? std::log(physical) : physical;
}
[[nodiscard]] inline double to_physical(const effect_parameter& p, double fitted) {
  return p.logarithmic ? std::exp(fitted) : fitted;
}

/// Which parameters a fit moves. Corrections: late parameters, and how far declared terminations are off. Of a take that is only
/// predicted, what is its own - release, strength, and the sensors' zeros, which creep from take to take and remember, behind a
/// high-pass, for how long the string had been held - and its place, where none of those that were fitted was made there.
enum class freedom { all, no_corrections, release_only, release_and_place };

class scene_plucks : public pluck_layout {
public:
  scene_plucks(const pluck_layout& layout, std::array<double, 2> corner_Hz, std::vector<pluck_effect> effects,
               freedom free = freedom::all)
      : pluck_layout{layout},
        corner_Hz_{corner_Hz}, effects_{std::move(effects)}, free_{free}, strings_{std::make_shared<detail::string_memory>()} {
    for (const auto& e : effects_)
      for (const auto& p : e.parameters) added_.push_back(p);
  }

  [[nodiscard]] const std::vector<pluck_effect>& effects() const { return effects_; }
  [[nodiscard]] Eigen::Index plain_size() const { return pluck_layout::size(); }
  [[nodiscard]] Eigen::Index size() const { return plain_size() + static_cast<Eigen::Index>(added_.size()); }
  [[nodiscard]] const effect_parameter& added(Eigen::Index p) const { return added_[static_cast<std::size_t>(p - plain_size())]; }
  /// Index of the first parameter of an effect.
  [[nodiscard]] Eigen::Index first_of(std::size_t effect) const {
    Eigen::Index at = plain_size();
    for (std::size_t i = 0; i < effect; ++i) at += static_cast<Eigen::Index>(effects_[i].parameters.size());
    return at;
  }
  [[nodiscard]] bool is_free(Eigen::Index p) const {
    if (free_ == freedom::release_only || free_ == freedom::release_and_place) {
      if (p >= plain_size()) return added(p).take >= 0;
      if (p < at(0, 0)) return p >= first_position && free_ == freedom::release_and_place;
      return p < first_of_uneven();
    }
    if (free_ != freedom::all && (p >= plain_size() ? added(p).late : p >= first_of_uneven() && !is_own_loss(p))) return false;
    return p >= plain_size() ? !added(p).by_score : pluck_layout::is_free(p);
  }
  [[nodiscard]] bool is_scale(Eigen::Index p) const { return p < plain_size() && pluck_layout::is_scale(p); }
  [[nodiscard]] bool concerns(Eigen::Index p, std::size_t take) const {
    if (p < plain_size()) return pluck_layout::concerns(p, take);
    return added(p).take < 0 || added(p).take == static_cast<int>(take);
  }
  template <class = void>
  [[nodiscard]] double step(Eigen::Index p, const Eigen::VectorXd& v) const {
    return p < plain_size() ? pluck_layout::step(p, v) : added(p).step;
  }
  [[nodiscard]] knowledge prior(Eigen::Index p, const std::vector<pluck_take>& takes, const pluck_guess& guess) const {
    return p < plain_size() ? pluck_layout::prior(p, takes, guess) : knowledge{0, 0};
  }
  [[nodiscard]] std::string name(Eigen::Index p) const { return p < plain_size() ? pluck_layout::name(p) : added(p).name; }
  template <class = void>
  [[nodiscard]] bool plausible(const Eigen::VectorXd& v, const Eigen::VectorXd& start, double highest_Hz) const {
    bool ok = pluck_layout::plausible(v.head(plain_size()), start.head(plain_size()), highest_Hz);
    for (Eigen::Index p = plain_size(); p < size(); ++p)
      ok = ok && v[p] >= to_fitted(added(p), added(p).low) - 1e-12 && v[p] <= to_fitted(added(p), added(p).high) + 1e-12;
    return ok;
  }

  template <class = void>
  [[nodiscard]] pluck_scene scene(const Eigen::VectorXd& v, int take) const {
    pluck_scene s;
    s.string = string(v);
    const auto moving = ends(v);
    for (std::size_t c = 0; c < 2; ++c) s.sensors[c].corner_Hz = corner_Hz_[c], s.ends[c].modes = moving[c].modes;
    Eigen::Index at = plain_size();
    for (const auto& e : effects_) {
      std::vector<double> values;
      for (const auto& p : e.parameters) values.push_back(to_physical(p, v[at++]));
      if (e.apply) e.apply(s, values.data(), take);
      if (e.retune) e.retune(s, *this, v, static_cast<std::size_t>(take), values.front());
    }
    return s;
  }

  /// Of the string's own lines, whatever moves them.
  template <class = void>
  [[nodiscard]] rosin::own_losses own_losses_at(const Eigen::VectorXd& v, std::size_t take, const band& limits, int most) const {
    const pluck_scene s = scene(v, static_cast<int>(take));
    rosin::own_losses own = own_losses_of(v, s.string);
    if (s.plain_string()) own.follow(detail::string_lines(s, v[position(take)], most, {}, limits.stop_Hz));
    else own.follow(strings_->lines(key(v, s), s, v[position(take)], limits, most));
    return own;
  }
  template <class = void>
  [[nodiscard]] std::vector<damped_line> lines(const Eigen::VectorXd& v, std::size_t take, std::size_t part, double begin_s,
                                               const band& limits, int most) const {
    const pluck_scene s = scene(v, static_cast<int>(take));
    const double position_now = v[position(take)], released = release_s(v, take), newtons = std::exp(v[at(take, strength)]);
    std::vector<damped_line> out;
    // of the lines, by a high-pass: r s / (s + w) of a line r / (s - p) leaves Re(r w / (p + w)) exp(-w t)
    std::array<double, 2> remembered{};
    if (part == 1) {
      out = s.plain_string() ? detail::string_lines(s, position_now, most, {}, limits.stop_Hz)
                             : strings_->lines(key(v, s), s, position_now, limits, most);
      if (has_own_losses(v)) {
        rosin::own_losses own = own_losses_of(v, s.string);
        own.follow(out);
        for (damped_line& line : out) own.apply_to(line);
      }
      out = recorded_lines(std::move(out), s, position_now, limits);
      for (damped_line& line : out) {
        for (std::size_t c = 0; c < 2; ++c)
          remembered[c] +=
              2 * std::numbers::pi * s.sensors[c].corner_Hz * (line.residue[c] * plain::reciprocal(line.pole)).real();
        const std::complex<double> turned = newtons * std::exp(line.pole * (begin_s - released));
        for (auto& r : line.residue) r *= turned;
      }
    }
    for (damped_line& line : out)
      for (std::size_t c = 0; c < 2; ++c) line.residue[c] *= gain(v, c);
    const auto still = held_forces(s, position_now);
    for (std::size_t c = 0; c < 2; ++c) {
      const double held = newtons * gain(v, c) * (still[c] + s.crosstalk * still[1 - c] - remembered[c]);
      out.push_back(slow_line(v, take, part, begin_s, c, s.sensors[c].corner_Hz, held));
    }
    for (const hum_phasor& h : s.hum) {
      damped_line line{{0, 2 * std::numbers::pi * h.frequency_Hz}, h.amplitude_N};
      for (auto& r : line.residue) r *= std::exp(line.pole * begin_s);
      out.push_back(line);
    }
    return out;
  }

private:
  /// What the poles depend on: not on what modes lose of their own, which moves each by itself.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd key(const Eigen::VectorXd& v, const pluck_scene& s) const {
    const Eigen::Index series = loss_scatter() - first_of_uneven(), more = v.size() - first_of_ends();
    constexpr Eigen::Index of_loss = loss_drag + 1 - causality;
    Eigen::VectorX<Real> k(gain_near + of_loss + series + more + 1);
    k << v.head(gain_near), v.segment<of_loss>(causality), v.segment(first_of_uneven(), series), v.tail(more),
        s.string.fundamental_Hz;
    // what may be about 0: how near a string is tells by their size
    k.segment(gain_near, of_loss + series + plain_size() - first_of_ends()).array() += 1;
    return k;
  }

  std::array<double, 2> corner_Hz_;
  std::vector<pluck_effect> effects_;
  freedom free_;
  std::vector<effect_parameter> added_;
  std::shared_ptr<detail::string_memory> strings_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
