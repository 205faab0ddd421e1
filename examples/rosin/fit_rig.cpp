// SPDX-License-Identifier: MIT
#include "fit_rig.hpp"
#include "digits.hpp"
#include "pluck_input.hpp"

namespace tool {

namespace {

using layout = rosin::pluck_layout;

void derive_units(const rosin::rig& rig, rig_calibration& c) {
  const auto& v = c.values;
  if (!v.length_m) {
    c.warnings.push_back("no length_m: nothing in N m^2 or N s/m; stiffness is given as inharmonicity, velocities cannot be had");
    return;
  }
  const double f0 = c.fit.value[layout::fundamental], b = c.fit.value[layout::inharmonicity], L = v.length_m->value;
  const double length = v.length_m->sd / L;
  if (rig.string.impedance_Ns_m) {
    c.impedance_Ns_m = doubtful{v.impedance_Ns_m->value, 0, v.impedance_Ns_m->sd};
  } else if (v.tension_N) {
    const double z = v.tension_N->value / (2 * L * f0);
    c.impedance_Ns_m =
        doubtful{z, z * c.fit.sd[layout::fundamental] / f0, z * std::hypot(v.tension_N->sd / v.tension_N->value, length)};
  }
  if (!c.impedance_Ns_m) {
    c.warnings.push_back("neither tension_N nor impedance_Ns_m: no bending stiffness in N m^2, and velocities cannot be had");
    return;
  }
  const double tension = c.impedance_Ns_m->value * 2 * L * f0, per = tension * L * L / (std::numbers::pi * std::numbers::pi);
  const double of_tension = rig.string.impedance_Ns_m
                                ? std::hypot(c.impedance_Ns_m->systematic_sd / c.impedance_Ns_m->value, length)
                                : v.tension_N->sd / v.tension_N->value;
  c.bending_stiffness_Nm2 =
      doubtful{b * per, c.fit.sd[layout::inharmonicity] * per, std::abs(b) * per * std::hypot(of_tension, 2 * length)};
}

/// The mean over the plucks, with the scatter between them where that is more than each one's error.
doubtful offset_of(const rig_calibration& c, int which) {
  double weights = 0, sum = 0, scatter = 0;
  for (std::size_t t = 0; t < c.takes.size(); ++t) {
    const auto p = c.fit.layout.at(t, which);
    const double w = 1 / std::max(1e-24, c.fit.sd[p] * c.fit.sd[p]);
    weights += w;
    sum += w * c.fit.value[p];
  }
  const double mean = sum / weights, n = static_cast<double>(c.takes.size());
  for (std::size_t t = 0; t < c.takes.size(); ++t) scatter += std::pow(c.fit.value[c.fit.layout.at(t, which)] - mean, 2);
  const double between = n > 1 ? std::sqrt(scatter / (n - 1) / n) : std::abs(mean);
  return {mean, std::max(std::sqrt(1 / weights), between), 0};
}

void judge(rig_calibration& c) {
  if (!c.fit.converged) {
    c.warnings.push_back("the fit did not settle: its errors are not to be trusted");
    c.incomplete = true;
  }
  for (const auto& name : c.fit.unidentified) c.warnings.push_back("these plucks cannot tell " + name);
  const double worst = *std::max_element(c.fit.residual_ratio.begin(), c.fit.residual_ratio.end());
  if (c.fit.misfit > 4)
    c.warnings.push_back("the plucks hold more than the model explains (" + in_digits(c.fit.misfit, "%.0f") +
                         " times the noise's power at the partials; residual " + in_digits(100 * worst, "%.2g") +
                         " % of the signal): standard deviations are widened accordingly");
  if (c.fit.horizon_periods < 1e6)
    c.warnings.push_back("the model holds for the first " + in_digits(c.fit.horizon_periods, "%.0f") +
                         " periods only: the rest was not used");
  const auto& L = c.fit.layout;
  for (std::size_t t = 0; t < c.takes.size(); ++t) {
    const double off = c.fit.value[L.at(t, layout::strength)] - std::log(c.takes[t].strength_N),
                 sd = c.takes[t].strength_tolerance / 2;
    if (std::abs(off) > 3 * sd)
      c.warnings.push_back(c.takes[t].name + ": its strength is " + in_digits(100 * (std::exp(off) - 1), "%+.1f") +
                           " % off the declared force, " + in_digits(std::abs(off) / sd, "%.1f") + " standard deviations");
  }
  for (int channel = 0; channel < 2; ++channel) {
    const double off = c.fit.value[layout::gain_near + channel], sd = c.fit.sd[layout::gain_near + channel];
    if (std::abs(off) > 0.15)
      c.warnings.push_back(std::string("the gain of channel ") + (channel == 0 ? "near" : "far") + " is " +
                           in_digits(100 * (std::exp(off) - 1), "%+.1f") + " % off its nominal value (+- " +
                           in_digits(100 * sd, "%.2g") + " %)");
  }
}

void predict(rig_calibration& c, bool draw) {
  for (const auto* set : {&c.takes, &c.held_out}) {
    if (set == &c.takes && !draw) continue;
    for (const auto& take : *set) {
      std::size_t nearest = 0;
      for (std::size_t i = 1; i < c.declared.size(); ++i)
        if (std::abs(c.declared[i] - take.position) < std::abs(c.declared[nearest] - take.position)) nearest = i;
      const double position = c.at[nearest].position + take.position - c.declared[nearest];
      auto one = predict_pluck(c.fit, take, position, c.ac_coupled_Hz);
      if (one) (set == &c.takes ? c.drawn : c.predicted).push_back(*std::move(one));
      else c.warnings.push_back(take.name + ": cannot be predicted: " + one.error());
    }
  }
}

/// Z before the fit, from nominal values; 0: unknown.
double nominal_impedance(const rosin::rig_values& v) {
  if (v.impedance_Ns_m) return v.impedance_Ns_m->value;
  return v.tension_N && v.length_m ? v.tension_N->value / (2 * v.length_m->value * v.fundamental_Hz.value) : 0.0;
}

/// Plucks on terminations that give way, as declared or to be found.
rosin::outcome<rosin::pluck_fit_result> fit_on_moving_ends(const rosin::rig& rig, rig_calibration& c) {
  rosin::end_options how;
  for (std::size_t e = 0; e < 2; ++e) {
    const auto declared = declared_end(rig, e, nominal_impedance(c.values), c.warnings);
    if (!declared) return rosin::failure{declared.error()};
    how.known[e] = declared->admittance;
    how.free_ends[e] = c.ends.fitted[e] = to_be_fitted(rig, e);
  }
  auto found = rosin::fit_ends(c.takes, guess_of(rig, c.values), {}, how);
  if (!found) return rosin::failure{found.error()};
  c.ends.modes = found->modes;
  const Eigen::Index n = found->plucks.layout.size(), m = found->covariance.rows() - n;
  c.ends.covariance = found->covariance.bottomRightCorner(m, m);
  for (const double declared : found->plucks.layout.positions())
    c.ends.with_waveform.emplace_back(rosin::waveform_jacobian(found->plucks, declared) * found->covariance.topRightCorner(n, m));
  for (const auto& mode : c.ends.modes)
    if (mode.end_uncertain)
      c.warnings.push_back("the plucks cannot tell at which end the resonance at " + in_digits(mode.mode.frequency_Hz, "%.0f") +
                           " Hz sits; it is taken to be at " + (mode.end == 0 ? "near" : "far"));
  return std::move(found->plucks);
}

}  // namespace

rosin::outcome<rig_calibration> calibrate(const rosin::rig& rig, provenance& from, bool draw) {
  rig_calibration out;
  out.title = rig.title.value_or(rig.file);
  out.values = rosin::values_of(rig);
  out.assumed = out.values.assumed;
  out.ac_coupled_Hz = {rig.channel("near")->ac_coupled_Hz.value_or(0), rig.channel("far")->ac_coupled_Hz.value_or(0)};
  rig_plucks plucks = read_plucks(rig, from);
  out.takes = std::move(plucks.takes), out.held_out = std::move(plucks.held_out);
  out.warnings = std::move(plucks.warnings), out.incomplete = plucks.incomplete;
  if (out.takes.empty())
    return failed(
        rig.file + ": no pluck to calibrate from; record a pluck made by a breaking wire at the contact, or give a calibration",
        out.warnings);
  auto fit = any_end_moves(rig) ? fit_on_moving_ends(rig, out) : rosin::fit_plucks(out.takes, guess_of(rig, out.values));
  if (!fit) return failed(fit.error(), out.warnings);
  out.fit = *std::move(fit);
  derive_units(rig, out);
  out.declared = out.fit.layout.positions();
  const double z = out.impedance_Ns_m ? out.impedance_Ns_m->value : std::numeric_limits<double>::quiet_NaN();
  const double z_sd = out.impedance_Ns_m ? std::hypot(out.impedance_Ns_m->sd, out.impedance_Ns_m->systematic_sd) / z : 0;
  for (const auto declared : out.declared)
    out.at.push_back(rosin::calibration_from(out.fit, declared, z, z_sd, out.ac_coupled_Hz));
  out.offset_N = {offset_of(out, layout::offset_near), offset_of(out, layout::offset_far)};
  judge(out);
  predict(out, draw);
  return out;
}

}  // namespace tool
