// SPDX-License-Identifier: MIT
//
// What was found, in the names and units of the format "diagnosis", and as sentences.
//
#include "diagnose_rig.hpp"
#include "digits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace tool {

namespace {

/// Relative errors that no recording tells, since they belong to the rig's nominal values.
struct nominal_errors {
  double impedance = 0.01, stiffness = 0.012, axial = 0.045, sensed = 0.03, scale = 0.01;
};

nominal_errors errors_of(const rosin::rig_values& v) {
  nominal_errors e;
  if (v.impedance_Ns_m) e.impedance = v.impedance_Ns_m->sd / v.impedance_Ns_m->value;
  if (v.tension_N && v.length_m) {
    const double t = v.tension_N->sd / v.tension_N->value, l = v.length_m->sd / v.length_m->value;
    e.stiffness = std::hypot(t, 2 * l), e.axial = std::hypot(3 * t, 2 * e.scale), e.sensed = std::hypot(2 * t, 2 * e.scale);
  }
  return e;
}

std::string value_of(const missing_effect& m, const std::string& name, double factor = 1, const char* form = "%.3g") {
  for (const auto& p : m.parameters)
    if (p.name == name) return in_digits(factor * p.value, form);
  return "?";
}

std::string resonance_of(const missing_effect& m) {
  for (const auto& p : m.parameters)
    if (p.name == "frequency_Hz")
      return p.value < 1000 ? in_digits(p.value, "%.4g") + " Hz" : in_digits(p.value / 1000, "%.4g") + " kHz";
  return "?";
}

}  // namespace

std::array<double, 2> interval_of(const diagnosed_value& v) {
  static const std::set<std::string> shares{"position", "clamping"};
  static const std::set<std::string> positive{"mass_kg",
                                              "resistance_Ns_m",
                                              "frequency_Hz",
                                              "q",
                                              "cutoff_Hz",
                                              "corner_Hz",
                                              "duration_s",
                                              "width_m",
                                              "axial_stiffness_N",
                                              "bending_stiffness_Nm2",
                                              "bristle_stiffness_N_m",
                                              "speed_ratio",
                                              "impedance_ratio"};
  constexpr double all = std::numeric_limits<double>::infinity();
  const bool share = shares.contains(v.name);
  const double least = v.value >= 0 && (share || positive.contains(v.name)) ? 0 : -all, most = v.value <= 1 && share ? 1 : all;
  return {std::max(v.value - 1.96 * v.sd, least), std::min(v.value + 1.96 * v.sd, most)};
}

diagnosed_value in_si(const std::string& name, double v, double sd, const rosin::rig_values& values, double f0) {
  const nominal_errors e = errors_of(values);
  const auto with = [&](const char* as, double x, double random, double relative) {
    return diagnosed_value{as, x, std::hypot(random, relative * x)};
  };
  if (name == "per_mass_per_kg") return with("mass_kg", 1 / v, sd / (v * v), e.impedance);
  if (name == "conductance_m_sN") return with("resistance_Ns_m", 1 / v, sd / (v * v), e.impedance);
  if (name == "inharmonicity" && values.impedance_Ns_m && values.length_m) {
    const double L = values.length_m->value,
                 per = values.impedance_Ns_m->value * 2 * L * f0 * L * L / (std::numbers::pi * std::numbers::pi);
    return with("bending_stiffness_Nm2", v * per, sd * per, e.stiffness);
  }
  if (name == "mass_kg" || name == "resistance_Ns_m" || name == "gap_m") return with(name.c_str(), v, sd, e.impedance);
  if (name == "axial_stiffness_N") return with(name.c_str(), v, sd, e.axial);
  if (name == "sensed_axial_stiffness_N") return with(name.c_str(), v, sd, e.sensed);
  if (name ==
      "clamping") {  // what shows is flat where nothing turns, t^2/2 + t^3/3 with t = 1 - clamping: the interval is one of that
    const double t = 1 - v, far = t * t * (0.5 + t / 3) + 1.96 * sd * t * (1 + t);
    double low = std::max(t, std::sqrt(2 * far));
    for (int i = 0; i < 30; ++i) low -= (low * low * (0.5 + low / 3) - far) / (low * (1 + low) + 1e-12);
    return {name, v, std::isfinite(low) ? std::min(1.0, std::max(0.0, low - t) / 1.96) : sd};
  }
  if (name == "gap_m") return with(name.c_str(), v, sd, std::hypot(e.scale, e.impedance));
  if (name == "quadratic_per_N" || name == "amplitude_N") return with(name.c_str(), v, sd, e.scale);
  return {name, v, sd};
}

std::string statement_of(const missing_effect& m) {
  const auto v = [&](const char* name, double factor = 1, const char* form = "%.3g") { return value_of(m, name, factor, form); };
  if (m.effect == "bending-stiffness") return "The string is stiff: B = " + v("bending_stiffness_Nm2") + " N m^2.";
  if (m.effect == "frequency-dependent-loss")
    return "Loss grows with frequency: 1/Q rises by " + v("loss_internal_s", 1e3) + " per kHz.";
  if (m.effect == "air-loss") return "Loss falls with frequency as that of the air does.";
  if (m.effect == "tension-modulation") return "Large motion stretches the string: E A = " + v("axial_stiffness_N") + " N.";
  if (m.effect == "second-polarization")
    return "The string also moves across the sensors' plane, tuned " + v("detuning", 1e3) + " per mille apart.";
  if (m.effect == "point-mass")
    return "A mass of " + v("mass_kg", 1e6) + " mg sits on the string at " + v("position", 1, "%.4f") + " of its length.";
  if (m.effect == "point-damper")
    return "Something damps the string at " + v("position", 1, "%.4f") + " of its length: " + v("resistance_Ns_m") + " N s/m.";
  if (m.effect == "support-resonance")
    return "The " + m.end + " termination is not rigid: it resonates at " + resonance_of(m) + " (Q " + v("q") + ", " +
           v("mass_kg", 1e3) + " g).";
  if (m.effect == "sympathetic-string")
    return "Another string rings along at the " + m.end + " termination: " + v("frequency_Hz", 1, "%.5g") + " Hz (Q " + v("q") +
           ").";
  if (m.effect == "resistive-end") return "The " + m.end + " termination takes energy: " + v("resistance_Ns_m") + " N s/m.";
  if (m.effect == "massive-end") return "The " + m.end + " termination moves like a mass of " + v("mass_kg", 1e3) + " g.";
  if (m.effect == "clamped-end")
    return (m.end.empty() ? "Both terminations hold" : "The " + m.end + " termination holds") +
           " the string against turning: clamped to " + v("clamping", 100) + " %.";
  if (m.effect == "ac-coupling") return "Both channels are AC coupled at " + v("cutoff_Hz") + " Hz.";
  if (m.effect == "sensor-resonance")
    return "The " + m.channel + " transducer itself resonates at " + resonance_of(m) + " (Q " + v("q") + ").";
  if (m.effect == "channel-skew") {
    const bool late =
        std::none_of(m.parameters.begin(), m.parameters.end(), [](const auto& p) { return p.name == "skew_s" && p.value < 0; });
    return "The far channel comes " + v("skew_s", late ? 1e6 : -1e6) + (late ? " us late" : " us early") +
           " against the near one.";
  }
  if (m.effect == "channel-crosstalk") return v("fraction", 100) + " % of each channel leaks into the other.";
  if (m.effect == "sensor-nonlinearity") return "The " + m.channel + " channel is curved: f + " + v("quadratic_per_N") + " f^2.";
  if (m.effect == "phantom-partials")
    return "The " + m.channel + " transducer feels the string's tension, too: " + v("sensed_axial_stiffness_N") +
           " N per unit of strain.";
  if (m.effect == "clock-drift") return "The far channel's clock is " + v("relative", 1e6) + " ppm fast against the near one's.";
  if (m.effect == "mains-hum") return "Mains hum at " + v("frequency_Hz", 1, "%.4g") + " Hz, " + v("amplitude_N", 1e3) + " mN.";
  if (m.effect == "slow-release") return "The wire lets go over " + v("duration_s", 1e6) + " us.";
  if (m.effect == "finite-pluck-width") return "The wire grips the string over " + v("width_m", 1e3) + " mm.";
  if (m.effect == "torsion")
    return "Torsion is not as declared: " + v("speed_ratio") + " times as fast, " + v("impedance_ratio") +
           " times the impedance, Q " + v("q") + ".";
  if (m.effect == "rod-resonance")
    return "The rod gives way: it resonates at " + resonance_of(m) + " (Q " + v("q") + ", " + v("mass_kg", 1e3) + " g).";
  if (m.effect == "finite-contact-width") return "The bow touches the string over " + v("width_m", 1e3) + " mm.";
  if (m.effect == "speed-ripple")
    return "The speed of the bow ripples at " + v("frequency_Hz", 1, "%.4g") + " Hz by " + v("relative", 100) + " %.";
  if (m.effect == "normal-force-ripple")
    return "The normal force ripples at " + v("frequency_Hz", 1, "%.4g") + " Hz by " + v("relative", 100) + " %.";
  if (m.effect == "thermal-friction") return "Friction follows the temperature of the contact, not the sliding speed.";
  if (m.effect == "elasto-plastic-friction")
    return "The contact yields elastically before it slides: " + v("bristle_stiffness_N_m") + " N/m.";
  if (m.effect == "rattle")
    return "The string meets an obstacle at " + v("position", 1, "%.4f") + " of its length, " + v("gap_m", 1e3) +
           " mm from where it rests.";
  if (m.effect == "creep") return "The string creeps while it sticks.";
  return "Missing: " + m.effect + ".";
}

std::string kind_in_words(const std::string& kind) {
  if (kind == "sensor-or-string") return "sensor or string: the force's two versions disagree";
  if (kind == "common-mode") return "common mode: the force's two versions agree, but it is no clean release";
  return "contact: plucks and both versions of the force are right, the motion under the bow is not as declared";
}

namespace {

std::string in_words(const open_contact& open) {
  const std::string size = in_digits(open.size, "%.3g"), floor = ", where " + in_digits(open.floor, "%.2g") + " is unsure.";
  if (open.statistic == "force-consistency") return "In " + open.take + " the force's two versions part by " + size + floor;
  if (open.statistic == "friction-residual")
    return "Friction under the bow is off its law by " + size + " of the normal force" + floor;
  return "What sticks to the rod moves by " + size + " of its speed" + floor;
}

}  // namespace

std::string sentence(const rig_diagnosis& d) {
  if (d.verdict == "no-mismatch") return "Simulation and recordings agree to within the noise.";
  std::string out;
  for (const auto& m : d.missing) out += (out.empty() ? "" : " ") + m.statement;
  if (d.verdict == "explained") return out;
  if (d.left_in_strokes) return out + " That does not account for all of it. " + in_words(*d.left_in_strokes);
  const std::string where = d.take.empty() ? ""
                                           : " It shows in " + d.take + (d.channel.empty() ? "" : ", channel " + d.channel) +
                                                 (d.acts.empty() ? "." : "; both ends together say that it acts " + d.acts + ".");
  return (out.empty() ? "" : out + " ") +
         std::string(out.empty() ? "Recordings and simulation differ, and nothing in the catalogue accounts for it."
                                 : "That does not account for all of it.") +
         where;
}

}  // namespace tool
