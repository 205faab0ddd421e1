// SPDX-License-Identifier: MIT
//
// A calibration as rows of a table: value, random and systematic standard deviation, each with digits that mean something.
//
#include "calibration_file.hpp"
#include "digits.hpp"

namespace tool {

namespace {

using layout = rosin::pluck_layout;

struct table_of_rows {
  std::vector<calibration_row> rows;
  std::string group;

  /// scale: from SI to the unit shown.
  void add(const std::string& name, const doubtful& d, const std::string& unit, double scale = 1) {
    rows.push_back({group, name, unit, rounded(scale * d.value, scale * std::max(d.sd, d.systematic_sd)),
                    d.sd > 0 ? in_digits(scale * d.sd, "%.2g") : "",
                    d.systematic_sd > 0 ? in_digits(scale * d.systematic_sd, "%.2g") : ""});
  }
  void text(const std::string& name, const std::string& value, const std::string& unit = "") {
    rows.push_back({group, name, unit, value, "", ""});
  }
};

void string_rows(table_of_rows& t, const rig_calibration& c) {
  const auto one = [&](int p) { return doubtful{c.fit.value[p], c.fit.sd[p], 0}; };
  t.group = "string";
  t.add("pitch f0 = c/(2L), without stiffness", one(layout::fundamental), "Hz");
  const double b = c.fit.value[layout::inharmonicity];
  t.add("first partial", {c.fit.string().partial_Hz(1), c.fit.sd[layout::fundamental], 0}, "Hz");
  t.add("inharmonicity pi^2 B/(T L^2)", {b, c.fit.sd[layout::inharmonicity], 0}, "1e-6", 1e6);
  if (c.bending_stiffness_Nm2) t.add("bending stiffness B", *c.bending_stiffness_Nm2, "1e-5 N m^2", 1e5);
  if (c.impedance_Ns_m) t.add("wave impedance Z", *c.impedance_Ns_m, "N s/m");
  const double q = 1 / c.fit.value[layout::inverse_quality];
  t.add("Q at low frequency", {q, q * q * c.fit.sd[layout::inverse_quality], 0}, "");
  t.add("loss growing with frequency (1/Q per Hz)", one(layout::internal_loss), "ns", 1e9);
  if (c.fit.layout.is_free(layout::causality)) t.add("dispersion by loss (1: as causality asks)", one(layout::causality), "");
}

void position_rows(table_of_rows& t, const rig_calibration& c) {
  for (std::size_t i = 0; i < c.at.size(); ++i) {
    t.group = "contact declared at " + in_digits(c.declared[i], "%.6g");
    const auto& at = c.at[i];
    const double L = c.values.length_m ? c.values.length_m->value : 0;
    const double sd = c.fit.sd[layout::first_position + static_cast<Eigen::Index>(i)];
    t.add("position, distance from near end / length", {at.position, sd, 0}, "");
    if (L > 0) t.add("distance from the declared place", {(at.position - c.declared[i]) * L, sd * L, 0}, "mm", 1e3);
    t.add("delay to the near end", {at.at.delay_s[0], std::sqrt(std::max(0.0, at.covariance(0, 0))), 0}, "us", 1e6);
    t.add("delay to the far end", {at.at.delay_s[1], std::sqrt(std::max(0.0, at.covariance(1, 1))), 0}, "us", 1e6);
  }
}

void end_rows(table_of_rows& t, const rig_calibration& c) {
  for (const std::size_t e : {0U, 1U}) {
    if (!c.ends.fitted[e]) continue;
    t.group = std::string("termination ") + (e == 0 ? "near" : "far");
    bool any = false;
    for (const auto& m : c.ends.modes) {
      if (m.end != e) continue;
      any = true;
      t.add(m.end_uncertain ? "resonance (or at the other end)" : "resonance", {m.mode.frequency_Hz, m.frequency_sd_Hz, 0}, "Hz");
      t.add("its Q", {m.mode.q, m.q_sd, 0}, "");
      const double relative = c.impedance_Ns_m ? c.impedance_Ns_m->value / m.mode.per_mass_per_s : 1 / m.mode.per_mass_per_s;
      t.add(c.impedance_Ns_m ? "its mass" : "its mass / Z", {relative, relative * m.per_mass_relative_sd, 0},
            c.impedance_Ns_m ? "g" : "ms", 1e3);
    }
    if (!any) t.text("rigid", "as far as these plucks tell");
  }
}

void channel_rows(table_of_rows& t, const rig_calibration& c) {
  t.group = "channels";
  const double ratio_sd = std::sqrt(std::max(0.0, c.at.front().covariance(5, 5))), scale = c.at.front().scale_relative_sd;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "near" : "far";
    const double gain = c.at.front().gain[i];
    t.add("gain " + name + ", recorded / true", {gain, gain * ratio_sd / 2, gain * scale}, "");
  }
  const double ratio = c.at.front().gain[0] / c.at.front().gain[1];
  t.add("gain near / gain far", {ratio, ratio * ratio_sd, 0}, "");
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "near" : "far";
    t.text("noise " + name + ", rms to half the sampling rate", in_digits(1e3 * c.fit.noise_N[i], "%.3f"), "mN");
    if (c.ac_coupled_Hz[i] == 0) t.add("offset " + name, c.offset_N[i], "mN", 1e3);
    else t.text("high-pass " + name + " (declared)", in_digits(c.ac_coupled_Hz[i]), "Hz");
  }
}

void take_rows(table_of_rows& t, const rig_calibration& c) {
  const auto& L = c.fit.layout;
  for (std::size_t i = 0; i < c.takes.size(); ++i) {
    t.group = "take " + c.takes[i].name;
    t.add("release", {c.fit.value[L.at(i, layout::release)], c.fit.sd[L.at(i, layout::release)], 0}, "ms", 1e3);
    const double force = std::exp(c.fit.value[L.at(i, layout::strength)]);
    t.add("force (declared " + in_digits(c.takes[i].strength_N, "%.2g") + " N)",
          {force, 0, force * c.fit.sd[L.at(i, layout::strength)]}, "N");
    t.text("residual / signal", in_digits(100 * c.fit.residual_ratio[i], "%.3g"), "%");
  }
  for (const auto& p : c.predicted) {
    t.group = "take " + p.name + ", held out: predicted";
    t.text("release", in_digits(1e3 * p.release_s, "%.5f"), "ms");
    t.text("force", in_digits(p.strength_N, "%.4f"), "N");
    t.text("residual / signal", in_digits(100 * p.residual_ratio, "%.3g"), "%");
  }
}

}  // namespace

std::string rounded(double value, double sd) {
  if (!(sd > 0) || !std::isfinite(sd)) return in_digits(value, "%.6g");
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(sd))), 0, 12);
  return rosin::number_text(value, "%." + std::to_string(decimals) + "f");
}

std::vector<calibration_row> rows_of(const rig_calibration& c) {
  table_of_rows t;
  string_rows(t, c);
  position_rows(t, c);
  end_rows(t, c);
  channel_rows(t, c);
  take_rows(t, c);
  t.group = "fit";
  t.text("power at the partials / what noise explains", in_digits(c.fit.misfit, "%.3g"));
  if (c.fit.loss_scatter > 0)
    t.text("scatter of the modes' losses about the law, %", in_digits(100 * c.fit.loss_scatter, "%.3g"));
  return t.rows;
}

}  // namespace tool
