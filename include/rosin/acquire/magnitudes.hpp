// tier: hosted
// SPDX-License-Identifier: MIT
//
// A value of the rig file that is off by a power of ten: millimetres, grams, kilohertz, gigapascals, a slipped digit. No single value
// proves it, but together they contradict one another, and what real strings have:
//
//     Z = T / (2 L f),   rho pi d^2 / 4 = T / (2 L f)^2,   B = E pi d^4 / 64,   c = 2 L f of 40 to 1000 m/s, ...
//
// In logarithms each is a sum that has to be near a number. So "all is as declared" and "this value is 10^k of what was meant" are
// weighed like any hypotheses: by how far each of these sums is off, in standard deviations, and by a prior of one in a thousand for
// a slip (two slips at once among the values of the string: one in a million). A deviation counts up to seven standard deviations: a
// string may be odd in one way. The power that makes everything consistent is named, if it is ten times as likely as the values
// declared (an error: a thousand times). Ranges are those of the strings of instruments, from harpsichord to double bass, of nylon,
// gut, steel and tungsten, and of plucks and strokes of rigs for them; each standard deviation is a factor of two to ten.
//
#pragma once

#include <rosin/acquire/finding.hpp>
#include <rosin/acquire/rig.hpp>
#include <rosin/core/number_text.hpp>

#include <algorithm>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A value that is likely 10^-power times what is declared.
struct magnitude_slip {
  std::string key;  ///< "string.length_m", "take \"bow-1\".speed_m_s"
  double declared = 0, likely = 0;
  double log_odds = 0;  ///< natural logarithm of the odds against "as declared"
  std::string why;      ///< what contradicts it
};

namespace detail {

struct declared_magnitude {
  std::string key;
  double value = 0;
  bool of_string = false;
};

/// The sum of exponents times logarithms (of base 10), plus `constant`, is about `mean`.
struct magnitude_relation {
  std::vector<std::pair<std::size_t, double>> terms;
  double constant, mean, sd;
  std::string what, unit;  ///< the quantity whose logarithm the sum is
};

/// What is declared, how it hangs together, and what one or two corrections make of it.
class magnitude_model {
public:
  explicit magnitude_model(const rig& r) {
    add_string(r.string);
    for (const take& t : r.takes) add_take(t);
  }

  /// The slips, the likeliest first; each is judged with those before it mended.
  [[nodiscard]] std::vector<magnitude_slip> slips() {
    std::vector<magnitude_slip> out;
    for (std::size_t round = 0; round < values_.size(); ++round) {
      const correction best = likeliest();
      if (best.gain < std::log(10.0)) break;
      for (const auto& [at, power] : best.steps) {
        magnitude_slip s{values_[at].key, values_[at].value, values_[at].value * std::pow(10.0, power), best.gain, {}};
        s.why = why(best);
        out.push_back(std::move(s));
      }
      for (const auto& [at, power] : best.steps) values_[at].value *= std::pow(10.0, power);
    }
    return out;
  }

private:
  struct correction {
    std::vector<std::pair<std::size_t, int>> steps;
    double gain = 0;
  };

  std::vector<declared_magnitude> values_;
  std::vector<magnitude_relation> relations_;

  std::optional<std::size_t> declare(const std::string& key, const std::optional<double>& value, bool of_string) {
    if (!value || !(*value > 0)) return std::nullopt;
    values_.push_back({key, *value, of_string});
    return values_.size() - 1;
  }
  using term = std::pair<std::optional<std::size_t>, double>;
  /// Where all that it is about is declared.
  void relate(const std::vector<term>& terms, double factor, double usual, double sd, const std::string& what,
              const std::string& unit) {
    magnitude_relation relation{{}, std::log10(factor), std::log10(usual), sd, what, unit};
    for (const auto& [at, exponent] : terms) {
      if (!at) return;
      relation.terms.emplace_back(*at, exponent);
    }
    relations_.push_back(std::move(relation));
  }

  std::optional<std::size_t> tension_;

  void add_string(const string_section& s) {
    const auto value = [&](const char* key, const std::optional<double>& x) {
      return declare(std::string{"string."} + key, x, true);
    };
    const auto f = value("fundamental_Hz", s.fundamental_Hz), L = value("length_m", s.length_m),
               T = value("tension_N", s.tension_N), Z = value("impedance_Ns_m", s.impedance_Ns_m),
               d = value("diameter_m", s.diameter_m), rho = value("density_kg_m3", s.density_kg_m3),
               E = value("youngs_modulus_Pa", s.youngs_modulus_Pa), B = value("bending_stiffness_Nm2", s.bending_stiffness_Nm2);
    constexpr double pi = 3.14159265358979323846;
    tension_ = T;
    relate({{f, 1}}, 1, 300, 0.5, "fundamental", "Hz");
    relate({{L, 1}}, 1, 0.6, 0.4, "length", "m");
    relate({{T, 1}}, 1, 80, 0.45, "tension", "N");
    relate({{Z, 1}}, 1, 0.4, 0.5, "impedance", "N s/m");
    relate({{d, 1}}, 1, 7e-4, 0.35, "diameter", "m");
    relate({{rho, 1}}, 1, 4000, 0.35, "density", "kg/m3");
    relate({{E, 1}}, 1, 3e10, 0.7, "Young's modulus", "Pa");
    relate({{L, 1}, {f, 1}}, 2, 200, 0.35, "wave speed 2 length fundamental", "m/s");
    relate({{T, 1}, {L, -2}, {f, -2}}, 0.25, 2e-3, 0.7, "mass per length tension / (2 length fundamental)^2", "kg/m");
    relate({{T, 1}, {L, -1}, {f, -1}, {Z, -1}}, 0.5, 1, 0.02, "ratio of tension / (2 length fundamental) to impedance", "");
    relate({{rho, 1}, {d, 2}, {L, 2}, {f, 2}, {T, -1}}, pi, 1, 0.05,
           "ratio of the wire's mass, from diameter and density, to that from tension, length and fundamental", "");
    if (!T)
      relate({{rho, 1}, {d, 2}, {L, 2}, {f, 2}}, pi, 80, 0.45, "tension from diameter, density, length and fundamental", "N");
    relate({{E, 1}, {d, 4}, {B, -1}}, pi / 64, 1, 0.15, "ratio of Young's modulus pi diameter^4 / 64 to bending stiffness", "");
    relate({{T, 1}, {d, -2}}, 4 / pi, 4e8, 0.5, "tensile stress", "Pa");
    relate({{B, 1}, {T, -1}, {L, -2}}, pi * pi, 1e-4, 1, "inharmonicity pi^2 bending stiffness / (tension length^2)", "");
  }

  void add_take(const take& t) {
    const auto value = [&](const char* key, const std::optional<double>& x) {
      return declare("take \"" + t.name + "\"." + key, x, false);
    };
    if (t.kind == take_kind::pluck) {
      const auto force = value("force_N", t.force_N);
      relate({{force, 1}}, 1, 0.7, 0.6, "force of the pluck", "N");
      relate({{force, 1}, {tension_, -1}}, 1, 0.01, 0.6, "ratio of the pluck's force to the tension", "");
    } else if (t.kind == take_kind::bow) {
      const auto force = value("normal_force_N", t.normal_force_N), speed = value("speed_m_s", t.speed_m_s);
      relate({{force, 1}}, 1, 0.6, 0.6, "normal force", "N");
      relate({{force, 1}, {tension_, -1}}, 1, 0.01, 0.6, "ratio of the normal force to the tension", "");
      relate({{speed, 1}}, 1, 0.15, 0.6, "speed of the bow", "m/s");
    }
  }

  [[nodiscard]] double sum(const magnitude_relation& relation, const std::vector<std::pair<std::size_t, int>>& steps) const {
    double out = relation.constant;
    for (const auto& [at, exponent] : relation.terms) {
      out += exponent * std::log10(values_[at].value);
      for (const auto& [changed, power] : steps)
        if (changed == at) out += exponent * power;
    }
    return out;
  }
  [[nodiscard]] double loss(const magnitude_relation& relation, const std::vector<std::pair<std::size_t, int>>& steps) const {
    const double z = (sum(relation, steps) - relation.mean) / relation.sd;
    return std::min(z * z, 49.0) / 2;
  }
  [[nodiscard]] double gain(const std::vector<std::pair<std::size_t, int>>& steps) const {
    double out = -std::log(1000.0) * static_cast<double>(steps.size());
    for (const auto& relation : relations_) out += loss(relation, {}) - loss(relation, steps);
    return out;
  }

  [[nodiscard]] correction likeliest() const {
    static constexpr std::array powers{-9, -6, -3, -2, -1, 1, 2, 3, 6, 9};
    correction best;
    const auto attempt = [&](const std::vector<std::pair<std::size_t, int>>& steps) {
      if (const double g = gain(steps); g > best.gain) best = {steps, g};
    };
    for (std::size_t i = 0; i < values_.size(); ++i)
      for (const int power : powers) {
        attempt({{i, power}});
        for (std::size_t j = 0; values_[i].of_string && j < i; ++j)
          for (const int other : powers) attempt({{j, other}, {i, power}});
      }
    return best;
  }

  /// The relation that the correction mends most.
  [[nodiscard]] std::string why(const correction& c) const {
    const auto relief = [&](const magnitude_relation& r) { return loss(r, {}) - loss(r, c.steps); };
    const auto worst = std::max_element(relations_.begin(), relations_.end(),
                                        [&](const auto& a, const auto& b) { return relief(a) < relief(b); });
    const auto digits = [](double x) { return number_text(x, "%.3g"); };
    const std::string unit = worst->unit.empty() ? "" : " " + worst->unit, is = digits(std::pow(10.0, sum(*worst, {})));
    if (worst->sd < 0.2) return "the " + worst->what + " is " + is + " instead of 1";
    return "the " + worst->what + " would be " + is + unit + ", and is between " +
           digits(std::pow(10.0, worst->mean - 2 * worst->sd)) + " and " + digits(std::pow(10.0, worst->mean + 2 * worst->sd)) +
           unit + " in nearly all cases";
  }
};

/// What is said of a likely value.
[[nodiscard]] inline std::string likely_text(const magnitude_slip& s) {
  return s.key + " is " + number_text(s.declared) + ", and " + number_text(s.likely) + " would agree with all the rest: " + s.why;
}

}  // namespace detail

/// The declared values that are likely off by a power of ten.
[[nodiscard]] inline std::vector<magnitude_slip> find_magnitude_slips(const rig& r) { return detail::magnitude_model{r}.slips(); }

/// The same as findings of the rig file as a whole.
[[nodiscard]] inline std::vector<finding> check_magnitudes(const rig& r) {
  std::vector<finding> out;
  for (const auto& s : find_magnitude_slips(r))
    out.push_back({s.log_odds > std::log(1000.0) ? severity::error : severity::warning, "power-of-ten", "", "", 0, 0,
                   detail::likely_text(s), "check its unit and digits"});
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
