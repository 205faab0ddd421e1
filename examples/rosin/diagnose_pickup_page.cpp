// SPDX-License-Identifier: MIT
#include "diagnose_pickup_page.hpp"

#include "digits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tool {

namespace {

const diagnosed_value* find(const missing_effect& m, const std::string& name) {
  for (const auto& p : m.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

/// "0.021 g", or "0.3 % of the string's mass" where that is all that can be said.
std::string either(const missing_effect& m, const std::string& si, double factor, const std::string& unit,
                   const std::string& ratio, const std::string& of) {
  if (const auto* v = find(m, si)) return in_digits(factor * v->value) + " " + unit;
  if (const auto* v = find(m, ratio)) return in_digits(v->value) + " " + of;
  return "?";
}

std::string value(const missing_effect& m, const std::string& name, double factor = 1, const char* form = "%.3g") {
  const auto* v = find(m, name);
  return v != nullptr ? in_digits(factor * v->value, form) : "?";
}

double cents(double f, double against) { return 1200 * std::log2(f / against); }

/// Level in dB over time, in pieces of 20 ms.
curve level(const std::string& name, const std::vector<double>& x, const pickup_picture& p, const char* ink, int dash) {
  curve c{name, {}, {}, ink, 1.5, dash};
  const auto block = std::max<std::size_t>(8, static_cast<std::size_t>(0.02 * p.rate_Hz));
  for (std::size_t j = 0; j + block <= x.size(); j += block) {
    double sum = 0;
    for (std::size_t i = j; i < j + block; ++i) sum += x[i] * x[i];
    c.x.push_back(p.begin_s + static_cast<double>(j + block / 2) / p.rate_Hz);
    c.y.push_back(10 * std::log10(std::max(sum / static_cast<double>(block), 1e-300) / (p.noise * p.noise)));
  }
  return c;
}

figure residual_figure(const pickup_picture& p, const rig_diagnosis& d) {
  figure f;
  panel levels{"(a) what is left of " + p.take + ", channel " + p.channel,
               "time in the take / s",
               "dB above the noise",
               {},
               {},
               {},
               {},
               270};
  levels.curves = {level("declared model", p.before, p, colour::near, 1)};
  if (d.after) levels.curves.push_back(level("corrected model", p.after, p, colour::model, 1));
  levels.curves.push_back(
      {"noise", {p.begin_s, levels.curves[0].x.empty() ? p.begin_s : levels.curves[0].x.back()}, {0, 0}, colour::slip, 1.4, 2});
  if (d.time_s) levels.heavy = {{(*d.time_s)[0], (*d.time_s)[1]}};
  f.panels = {levels};
  f.caption = "Residual of a recording to which nothing but amplitudes, phases and one pitch was fitted.";
  if (d.time_s)
    f.caption += " The bar marks where it is largest; over the whole stretch it is " + in_digits(d.residual_over_noise) +
                 " times the noise.";
  return f;
}

figure wave_figure(const pickup_picture& p, bool corrected) {
  figure f;
  const auto count = std::min(p.before.size(), static_cast<std::size_t>(8 * p.rate_Hz / p.fundamental_Hz));
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) most = std::max({most, std::abs(p.before[i]), 3 * p.noise});
  const auto wave = [&](const char* title, const std::vector<double>& x, const char* ink) {
    panel w{title, "time in the take / ms", "residual", {}, {}, {}, std::pair{-1.1 * most, 1.1 * most}, 200};
    curve c{"", {}, {}, ink, 1.1};
    for (std::size_t i = 0; i < count; ++i)
      c.x.push_back(1e3 * (p.begin_s + static_cast<double>(i) / p.rate_Hz)), c.y.push_back(x[i]);
    w.curves = {c};
    return w;
  };
  f.panels = {wave("(a) recorded - declared model", p.before, colour::near)};
  if (corrected) f.panels.push_back(wave("(b) recorded - corrected model", p.after, colour::model));
  f.share_axis();
  f.caption = "The first eight periods of the stretch that was foretold, in the unit of the channel, on the same axes.";
  return f;
}

/// A bar from - sd to + sd with a short dash across.
void add_bar(curve& c, double x, double y, double sd, double width) {
  const double gap = std::nan("");
  const double half = std::max(sd, 0.0);
  for (const auto& [u, v] : {std::pair{x, y - half}, {x, y + half}, {gap, gap}, {x - width, y}, {x + width, y}, {gap, gap}})
    c.x.push_back(u), c.y.push_back(v);
}

figure law_figure(const pickup_picture& p, bool corrected) {
  panel pitch{"(a) partials against the declared law", "partial", "cents", {}, {}, {}, {}, 250},
      loss{"(b) loss", "partial", "1000 / Q", {}, {}, {}, {}, 250};
  curve seen{"measured", {}, {}, colour::near, 1.6}, lost = seen, law{"corrected law", {}, {}, colour::model, 1.2},
                                                     law_lost = law;
  curve flat{"declared law", {}, {}, colour::declared, 1.3, 2}, flat_lost = flat;
  for (const auto& q : p.partials) {
    const double quality = std::numbers::pi * q.frequency_Hz / 1000;
    add_bar(seen, q.number, cents(q.frequency_Hz, q.declared_Hz), 1200 / std::log(2.0) * q.frequency_sd / q.frequency_Hz, 0.25);
    add_bar(lost, q.number, q.decay_per_s / quality, q.decay_sd / quality, 0.25);
    for (auto* c : {&law, &law_lost, &flat, &flat_lost}) c->x.push_back(q.number);
    law.y.push_back(cents(q.corrected_Hz, q.declared_Hz)), flat.y.push_back(0);
    law_lost.y.push_back(q.corrected_per_s / quality), flat_lost.y.push_back(q.declared_per_s / quality);
  }
  pitch.curves = {flat, seen}, loss.curves = {flat_lost, lost};
  if (corrected) pitch.curves.push_back(law), loss.curves.push_back(law_lost);
  double top = 0;
  for (const auto& q : p.partials) top = std::max(top, 1000 * 1.4 * q.decay_per_s / (std::numbers::pi * q.frequency_Hz));
  loss.y_range = std::pair{0.0, top};
  figure f;
  f.panels = {pitch, loss};
  f.share_axis();
  f.caption =
      "What the fitted takes say of each partial (bars: one standard deviation), and the laws. Glide and second lines, where "
      "found, are taken out before.";
  return f;
}

}  // namespace

std::string pickup_statement(const missing_effect& m) {
  const auto& e = m.effect;
  const std::string mass = either(m, "mass_kg", 1e3, "g", "mass_over_string", "of the string's mass");
  if (e == "bending-stiffness")
    return "The string is stiff: B = " +
           either(m, "bending_stiffness_Nm2", 1, "N m2", "inharmonicity", "T L2 / pi2 (inharmonicity)") + ".";
  if (e == "frequency-dependent-loss")
    return "Losses grow with frequency: 1/Q rises by " + value(m, "loss_internal_s", 1e6) + " per million hertz.";
  if (e == "air-loss") return "Air takes part in the loss: " + value(m, "loss_air_sqrt_Hz") + " / sqrt(f) in 1/Q.";
  if (e == "resistive-end")
    return "An end takes up energy at all frequencies alike: " +
           either(m, "resistance_Ns_m", 1, "N s/m", "conductance_times_impedance",
                  "of the string's impedance times its conductance") +
           ".";
  if (e == "point-mass")
    return "Something heavy sits on the string at " + value(m, "position") + " of its length (or its mirror image): " + mass +
           ".";
  if (e == "point-damper")
    return "Something damps the string at " + value(m, "position") + " of its length (or its mirror image): " +
           either(m, "resistance_Ns_m", 1, "N s/m", "resistance_over_impedance", "of its impedance") + ".";
  if (e == "support-resonance")
    return "An end gives way: it resonates at " + value(m, "frequency_Hz", 1, "%.4g") + " Hz (Q " + value(m, "q") + ", " + mass +
           ").";
  if (e == "tension-modulation")
    return find(m, "axial_stiffness_N") != nullptr
               ? "Motion stretches the string: E A = " + value(m, "axial_stiffness_N") + " N."
               : "Motion stretches the string: it starts sharp by " + value(m, "pitch_rise", 1200 / std::log(2.0)) +
                     " cents in the loudest take.";
  if (e == "second-polarization" && find(m, "detuning_scatter") != nullptr)
    return "The string moves in two planes, and its ends hold these differently: partials are pairs, mostly " +
           value(m, "detuning_scatter", 1200 / std::log(2.0)) + " cents apart, each of its own.";
  if (e == "second-polarization")
    return "The string moves in two planes, detuned by " + value(m, "detuning", 1200 / std::log(2.0)) + " cents (coupling " +
           value(m, "coupling") + ").";
  if (e == "mains-hum") return "Mains hum at " + value(m, "frequency_Hz", 1, "%.5g") + " Hz and multiples.";
  if (e == "sympathetic-string") return "Another string rings along at " + value(m, "frequency_Hz", 1, "%.5g") + " Hz.";
  return "Missing: " + e + ".";
}

std::vector<figure> pickup_figures(const rig_diagnosis& d) {
  const pickup_picture& p = *d.pickup;
  return {wave_figure(p, d.after.has_value()), residual_figure(p, d), law_figure(p, d.after.has_value())};
}

}  // namespace tool
