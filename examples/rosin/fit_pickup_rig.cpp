// SPDX-License-Identifier: MIT
#include "fit_pickup_rig.hpp"
#include "digits.hpp"
#include "progress.hpp"

#include <algorithm>

namespace tool {

namespace {

using rosin::measured_value;

std::optional<measured_value> fact(const std::optional<rosin::nominal>& given) {
  if (!given) return std::nullopt;
  return measured_value{given->value, given->sd};
}
std::optional<measured_value> fact(const std::optional<double>& given, double relative) {
  if (!given) return std::nullopt;
  return measured_value{*given, *given * relative};
}

rosin::pickup_string_facts facts_of(const rosin::rig& rig, const rosin::rig_values& values, std::vector<std::string>& assumed) {
  rosin::pickup_string_facts facts;
  facts.length_m = fact(values.length_m);
  if (rig.string.tension_N) facts.tension_N = fact(values.tension_N);
  facts.diameter_m = fact(rig.string.diameter_m, 0.01);
  facts.density_kg_m3 = fact(rig.string.density_kg_m3, 0.005);
  facts.youngs_modulus_Pa = fact(rig.string.youngs_modulus_Pa, 0.03);
  if (facts.diameter_m) assumed.push_back("standard deviation of diameter_m = 1 %, none given");
  if (facts.density_kg_m3) assumed.push_back("standard deviation of density_kg_m3 = 0.5 %, none given");
  if (facts.youngs_modulus_Pa) assumed.push_back("standard deviation of youngs_modulus_Pa = 3 %, none given");
  return facts;
}

bool rings(rosin::quantity what) {
  return what == rosin::quantity::termination_force || what == rosin::quantity::string_velocity ||
         what == rosin::quantity::string_displacement || what == rosin::quantity::sound;
}

json or_null(const std::optional<measured_value>& m) { return m ? with_sd(m->value, m->sd) : json(nullptr); }

json partials_json(const rosin::pickup_fit& fit) {
  json out = json::array();
  for (const auto& p : fit.partials)
    out.push_back({{"number", p.number},
                   {"frequency_Hz", with_sd(p.frequency_Hz, p.frequency_sd)},
                   {"decay_per_s", with_sd(p.decay_per_s, p.decay_sd)},
                   {"inverse_quality", with_sd(p.inverse_q(), p.decay_sd / (std::numbers::pi * p.frequency_Hz))},
                   {"amplitude", with_sd(p.amplitude, p.amplitude_sd)},
                   {"split_Hz", p.doubled ? json(p.split_Hz) : json(nullptr)},
                   {"weight", p.weight},
                   {"misfit", p.misfit}});
  return out;
}

void fit_take(const rosin::rig& rig, const rosin::take& take, const checked_take& read, const rosin::pickup_string_facts& facts,
              pickup_calibration& out) {
  for (const auto& signal : read.signals.signals) {
    if (!rings(signal.sensor.quantity)) continue;
    const auto fit = rosin::fit_pickup(signal.values, read.signals.sample_rate_Hz, rig.string.fundamental_Hz);
    const std::string where = take.name + ", channel " + signal.sensor.name + ": ";
    if (!fit) {
      out.warnings.push_back(where + "not fitted: " + fit.error());
      out.incomplete = true;
      continue;
    }
    for (const auto& warning : fit->warnings) out.warnings.push_back(where + warning);
    out.results.push_back(
        {take.name, signal.sensor.name, read.signals.sample_rate_Hz, *fit,
         rosin::string_from(facts, {fit->fundamental_Hz, fit->fundamental_sd}, {fit->inharmonicity, fit->inharmonicity_sd})});
  }
}

}  // namespace

rosin::outcome<pickup_calibration> calibrate_pickups(const rosin::rig& rig, provenance& from) {
  pickup_calibration out;
  out.title = rig.title.value_or(rig.file);
  const auto values = rosin::values_of(rig);
  out.assumed = values.assumed;
  const auto facts = facts_of(rig, values, out.assumed);
  progress bar{"fitting", rig.takes.size()};
  for (const auto& take : rig.takes) {
    bar.step();
    if (take.kind != rosin::take_kind::pluck || take.hold_out) continue;
    if (const auto read = read_telling(rig, take, from, out.warnings)) fit_take(rig, take, *read, facts, out);
    else out.incomplete = true;
  }
  if (!out.results.empty()) return out;
  const bool any = std::any_of(rig.takes.begin(), rig.takes.end(),
                               [](const auto& t) { return t.kind == rosin::take_kind::pluck && !t.hold_out; });
  return failed(rig.file + (any ? ": no pluck that could be fitted"
                                : ": take: none of kind pluck (hold_out aside), so there is nothing to fit"),
                out.warnings);
}

json to_json(const pickup_calibration& c, const provenance& from) {
  json out{{"schema", 1}, {"format", "calibration"}, {"kind", "pickup-plucks"}, {"provenance", from.to_json()}, {"rig", c.title}};
  out["results"] = json::array();
  for (const auto& r : c.results) {
    const auto& f = r.fit;
    out["results"].push_back(
        {{"take", r.take},
         {"channel", r.channel},
         {"sampling_rate_Hz", r.rate_Hz},
         {"from_s", f.start_s},
         {"fundamental_Hz", with_sd(f.fundamental_Hz, f.fundamental_sd)},
         {"inharmonicity", with_sd(f.inharmonicity, f.inharmonicity_sd)},
         {"covariance", {{f.covariance(0, 0), f.covariance(0, 1)}, {f.covariance(1, 0), f.covariance(1, 1)}}},
         {"inverse_quality", with_sd(f.loss.value[0], f.loss.sd[0])},
         {"loss_internal_s", with_sd(f.loss.value[1], f.loss.sd[1])},
         {"loss_air_sqrt_Hz", with_sd(f.loss.value[2], f.loss.sd[2])},
         {"loss_scatter", f.loss.relative_scatter},
         {"frequency_scatter_Hz", f.scatter_Hz},
         {"pitch_glide", with_sd(f.glide.relative, f.glide_sd)},
         {"tension_N", or_null(r.string.tension_N)},
         {"impedance_Ns_m", or_null(r.string.impedance_Ns_m)},
         {"bending_stiffness_Nm2", or_null(r.string.bending_stiffness_Nm2)},
         {"expected_inharmonicity", or_null(r.string.expected_inharmonicity)},
         {"diameter_from_sound_m", or_null(r.string.diameter_from_sound_m)},
         {"partials", partials_json(f)}});
  }
  out["warnings"] = c.warnings;
  out["assumed"] = c.assumed;
  return out;
}

std::vector<calibration_row> rows_of(const pickup_result& r) {
  std::vector<calibration_row> rows;
  const std::string group = "take " + r.take + ", channel " + r.channel;
  const auto add = [&](const std::string& name, double value, double sd, const std::string& unit, double scale = 1) {
    rows.push_back({group, name, unit, rounded(scale * value, scale * sd), in_digits(scale * sd, "%.2g"), ""});
  };
  const auto derived = [&](const std::string& name, const std::optional<measured_value>& m, const std::string& unit,
                           double scale = 1) {
    if (m) add(name, m->value, m->sd, unit, scale);
  };
  const auto& f = r.fit;
  add("pitch f0, without stiffness", f.fundamental_Hz, f.fundamental_sd, "Hz");
  add("inharmonicity pi^2 B/(T L^2)", f.inharmonicity, f.inharmonicity_sd, "1e-6", 1e6);
  derived("bending stiffness B", r.string.bending_stiffness_Nm2, "1e-5 N m^2", 1e5);
  derived("inharmonicity of the declared wire", r.string.expected_inharmonicity, "1e-6", 1e6);
  derived("diameter of a plain wire that sounds so", r.string.diameter_from_sound_m, "mm", 1e3);
  derived("tension", r.string.tension_N, "N");
  derived("wave impedance Z", r.string.impedance_Ns_m, "N s/m");
  for (const double at : {1.0, 3.0, 10.0}) {
    const double hz = at * f.fundamental_Hz;
    if (f.partials.empty() || hz > f.partials.back().frequency_Hz) continue;
    add("1/Q at " + in_digits(hz, "%.0f") + " Hz", f.loss.law.inverse_q(hz), f.loss.inverse_q_sd(hz), "1e-6", 1e6);
  }
  rows.push_back({group, "partials found", "", std::to_string(f.partials.size()), "", ""});
  return rows;
}

}  // namespace tool
