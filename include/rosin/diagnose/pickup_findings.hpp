// tier: hosted
// SPDX-License-Identifier: MIT
//
// What came out of the plucks of a single pickup, as effects with values and evidence, the strongest first. Parts of the
// likelihood that were searched by themselves (structure, law, strays) add up: so the evidence of several effects together is the
// sum of theirs, and what was tried alone is set against that sum.
//
#pragma once

#include <rosin/diagnose/pickup_greedy.hpp>
#include <rosin/diagnose/pickup_strays.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct pickup_question {
  double fundamental_Hz = 0;
  std::vector<std::string> declared;  ///< effects that the model contains
  std::vector<std::string> without;   ///< effects that the catalogue is not to know
  double longest_s = 1.5;             ///< of a take that is judged

  [[nodiscard]] bool is_declared(const std::string& effect) const {
    return std::find(declared.begin(), declared.end(), effect) != declared.end();
  }
  /// Whether it may be found.
  [[nodiscard]] bool asks_for(const std::string& effect) const {
    return !is_declared(effect) && std::find(without.begin(), without.end(), effect) == without.end();
  }
};

struct found_value {
  std::string name;
  double value = 0, sd = 0;
};

struct pickup_finding {
  std::string effect;
  std::vector<found_value> values;
  double gain = 0;  ///< natural logarithm of the evidence
  std::vector<std::string> alike;
};

/// One recording that was predicted.
struct judged_ringing {
  std::string take, channel;
  double rate_Hz = 0, start_s = 0, noise = 0, recorded = 0;
  std::vector<double> before, after;  ///< residuals
  double own_poles = 0;               ///< rms of what is left with each partial's pole as the fitted takes have it
};

struct pickup_diagnosis {
  std::vector<std::size_t> heard;  ///< which of the signals could be fitted
  structure_hypothesis structure;
  std::vector<structure_hypothesis> structures;
  double glide_per_power = 0, glide_per_power_sd = 0;
  line_table table;
  law_search law;
  stray_lines strays;
  std::vector<pickup_finding> missing;
  std::vector<std::pair<std::vector<std::string>, double>> ranking;  ///< natural logarithms, the best 0
  std::vector<judged_ringing> judged;
  double before = 0, after = 0, floor = 0, own_poles = 0;
  bool mismatched = false, explained = true;
  std::size_t worst = 0;  ///< of judged
  std::array<double, 2> time_s{}, band_Hz{};
  std::vector<std::string> warnings;
};

namespace detail {

/// Fills `missing` and `ranking` from structure, law and strays.
class pickup_namer {
public:
  pickup_namer(pickup_diagnosis& d, const pickup_question& ask) : d_{d}, ask_{ask} {}

  template <class = void>
  void name_all() {
    if (d_.structure.glides && ask_.asks_for("tension-modulation")) {
      double rise = 0;
      for (const auto& g : d_.structure.glide) rise = std::max(rise, g.relative);
      d_.missing.push_back(
          {"tension-modulation", {{"pitch_rise", rise, rise * d_.glide_per_power_sd / d_.glide_per_power}}, worth_of(true), {}});
    }
    if ((d_.structure.paired || d_.structure.doubled) && ask_.asks_for("second-polarization"))
      d_.missing.push_back(polarization());
    for (const auto& f : d_.law.found) {
      pickup_finding out{f.effect.name, {}, f.gain, f.alike};
      for (const auto& p : f.effect.parameters)
        out.values.push_back({p.name, d_.law.best.law.*p.member, d_.law.best.sd_of(p.name)});
      d_.missing.push_back(std::move(out));
    }
    std::stable_sort(d_.missing.begin(), d_.missing.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
    name_strays();  // last, as they say nothing of the string
    rank();
  }

private:
  /// Of the glide or of the pairs, within the structure that was chosen: what the best without it lacks.
  [[nodiscard]] double worth_of(bool glide) const {
    double best = 0;
    for (const auto& h : d_.structures)
      if (glide ? !h.glides : !h.paired && !h.doubled) best = std::max(best, h.evidence);
    return d_.structure.evidence - best;
  }
  template <class Real = double>
  [[nodiscard]] pickup_finding polarization() const {
    if (d_.structure.paired)
      return {"second-polarization",
              {{"detuning", d_.structure.pair.detuning, d_.structure.pair.sd},
               {"coupling", d_.structure.pair.coupling, d_.structure.pair.coupling_sd}},
              worth_of(false),
              {}};
    std::vector<double> relative;
    for (const auto& l : d_.table.lines)
      if (l.split_Hz != 0) relative.push_back(l.split_Hz / l.frequency_Hz);
    if (relative.empty()) return {"second-polarization", {}, worth_of(false), {}};
    const Eigen::VectorX<Real> v =
        Eigen::Map<const Eigen::VectorX<Real>>(relative.data(), static_cast<Eigen::Index>(relative.size()));
    const double middle = median_of(v), scatter = 1.48 * median_of((v.array() - middle).abs());
    return {"second-polarization",
            {{"detuning", middle, scatter / std::sqrt(static_cast<double>(v.size()))}, {"detuning_scatter", scatter, 0}},
            worth_of(false),
            {}};
  }
  void name_strays() {
    if (!d_.strays.hum.empty()) {
      double gain = 0;
      const stray_line* first = &d_.strays.hum.front();
      for (const auto& l : d_.strays.hum) gain += l.over_floor;
      d_.missing.push_back({"mains-hum",
                            {{"frequency_Hz", d_.strays.mains_Hz, 0.1 * d_.strays.resolution_Hz},
                             {"amplitude", first->amplitude, first->amplitude / std::sqrt(2 * first->over_floor)}},
                            gain,
                            {}});
    }
    std::vector<stray_line> rest = d_.strays.others;
    std::sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.frequency_Hz < b.frequency_Hz; });
    for (int strings = 0; !rest.empty() && strings < 4; ++strings) {
      const stray_line lowest = rest.front();
      double gain = 0;
      std::erase_if(rest, [&](const stray_line& l) {
        const double n = std::round(l.frequency_Hz / lowest.frequency_Hz);
        if (std::abs(l.frequency_Hz - n * lowest.frequency_Hz) >
            std::max(n * 0.3 * d_.strays.resolution_Hz, 0.003 * l.frequency_Hz))
          return false;
        gain += l.over_floor;
        return true;
      });
      d_.missing.push_back(
          {"sympathetic-string",
           {{"frequency_Hz", lowest.frequency_Hz, 0.1 * d_.strays.resolution_Hz}, {"amplitude", lowest.amplitude, 0}},
           gain,
           {}});
    }
  }
  [[nodiscard]] static bool is_stray(const pickup_finding& m) {
    return m.effect == "mains-hum" || m.effect == "sympathetic-string";
  }
  void rank() {
    double all = d_.structure.evidence + d_.law.gain;
    std::vector<std::string> names;
    for (const auto& m : d_.missing) {
      names.push_back(m.effect);
      if (is_stray(m)) all += m.gain;
    }
    d_.ranking.emplace_back(names, 0.0);
    if (!names.empty()) d_.ranking.emplace_back(std::vector<std::string>{}, -all);
    const auto add = [&](const std::string& name, double gain) {
      if (names.size() != 1 || names[0] != name)
        d_.ranking.emplace_back(std::vector<std::string>{name}, std::min(-0.1, gain - all));
    };
    for (const auto& [name, gain] : d_.law.alone) add(name, gain);
    for (const auto& h : d_.structures)
      if (h.glides != (h.paired || h.doubled)) add(h.glides ? "tension-modulation" : "second-polarization", h.evidence);
    for (const auto& m : d_.missing)
      if (is_stray(m)) add(m.effect, m.gain);
    std::stable_sort(d_.ranking.begin(), d_.ranking.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  }

  pickup_diagnosis& d_;
  const pickup_question& ask_;
};

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
