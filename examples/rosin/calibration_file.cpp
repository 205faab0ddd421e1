// SPDX-License-Identifier: MIT
#include "calibration_file.hpp"
#include "rig_leftovers.hpp"

#include <fstream>
#include <iostream>
#include <sstream>

namespace tool {

namespace {

using layout = rosin::pluck_layout;

constexpr std::array parameter_names{"delay_near_s",    "delay_far_s",     "stiffness_s2",
                                     "inverse_quality", "loss_internal_s", "ln_gain_ratio"};
static_assert(parameter_names.size() == rosin::waveform_parameters);

json with_both(const doubtful& d) {
  return {{"value", number_or_null(d.value)}, {"sd", number_or_null(d.sd)}, {"systematic_sd", number_or_null(d.systematic_sd)}};
}
json or_null(const std::optional<doubtful>& d) { return d ? with_both(*d) : json(nullptr); }

template <class Matrix>
json matrix(const Matrix& m) {
  json rows = json::array();
  for (Eigen::Index r = 0; r < m.rows(); ++r) {
    json row = json::array();
    for (Eigen::Index c = 0; c < m.cols(); ++c) row.push_back(number_or_null(m(r, c)));
    rows.push_back(row);
  }
  return rows;
}

/// Random part of ln(near / far), and what is common to both gains.
struct gain_errors {
  double ratio_sd, scale_sd;
};
gain_errors gain_errors_of(const rig_calibration& c) {
  return {std::sqrt(std::max(0.0, c.at.front().covariance(5, 5))), c.at.front().scale_relative_sd};
}

json string_json(const rig_calibration& c) {
  const auto& v = c.fit.value;
  const auto& sd = c.fit.sd;
  json out{{"fundamental_Hz", with_sd(v[layout::fundamental], sd[layout::fundamental])},
           {"inharmonicity", with_sd(v[layout::inharmonicity], sd[layout::inharmonicity])},
           {"bending_stiffness_Nm2", or_null(c.bending_stiffness_Nm2)},
           {"impedance_Ns_m", or_null(c.impedance_Ns_m)},
           {"inverse_quality", with_sd(v[layout::inverse_quality], sd[layout::inverse_quality])},
           {"loss_internal_s", with_sd(v[layout::internal_loss], sd[layout::internal_loss])},
           {"loss_air_sqrt_Hz", with_sd(v[layout::air_loss], sd[layout::air_loss])},
           {"loss_causality", with_sd(v[layout::causality], sd[layout::causality])},
           {"loss_drag_Hz", with_sd(v[layout::loss_drag], sd[layout::loss_drag])}};
  return out;
}

json channel_json(const rig_calibration& c, std::size_t channel) {
  const auto p = layout::gain_near + static_cast<int>(channel);
  const auto e = gain_errors_of(c);
  const double gain = std::exp(c.fit.value[p]);
  return {{"gain", with_both({gain, gain * e.ratio_sd / 2, gain * e.scale_sd})},
          {"noise_N", number_or_null(c.fit.noise_N[channel])},
          {"offset_N", with_sd(c.offset_N[channel].value, c.offset_N[channel].sd)},
          {"ac_coupled_Hz", number_or_null(c.ac_coupled_Hz[channel])}};
}

/// Modes that were fitted; masses in kg where Z is known.
json ends_json(const rig_calibration& c) {
  json out{{"near", json::array()},
           {"far", json::array()},
           {"fitted", json::array()},
           {"parameters", json::array()},
           {"covariance", matrix(c.ends.covariance)}};
  for (std::size_t e = 0; e < 2; ++e)
    if (c.ends.fitted[e]) out["fitted"].push_back(e == 0 ? "near" : "far");
  for (const auto& m : c.ends.modes) {
    const std::string name = m.end == 0 ? "near" : "far";
    json one{{"frequency_Hz", with_sd(m.mode.frequency_Hz, m.frequency_sd_Hz)},
             {"q", with_sd(m.mode.q, m.q_sd)},
             {"impedance_per_mass_per_s", with_sd(m.mode.per_mass_per_s, m.mode.per_mass_per_s * m.per_mass_relative_sd)},
             {"end_uncertain", m.end_uncertain}};
    if (c.impedance_Ns_m)
      one["mass_kg"] = with_sd(c.impedance_Ns_m->value / m.mode.per_mass_per_s,
                               c.impedance_Ns_m->value / m.mode.per_mass_per_s * m.per_mass_relative_sd);
    out[name].push_back(one);
    for (const char* parameter : {"ln_frequency", "ln_q", "ln_impedance_per_mass"})
      out["parameters"].push_back(std::string(parameter) + " of " + name + " " + std::to_string(out[name].size()));
  }
  return out;
}

json position_json(const rig_calibration& c, std::size_t i) {
  const rosin::calibration& at = c.at[i];
  return {{"declared", c.declared[i]},
          {"position", with_sd(at.position, c.fit.sd[layout::first_position + static_cast<Eigen::Index>(i)])},
          {"delay_near_s", with_sd(at.at.delay_s[0], std::sqrt(std::max(0.0, at.covariance(0, 0))))},
          {"delay_far_s", with_sd(at.at.delay_s[1], std::sqrt(std::max(0.0, at.covariance(1, 1))))},
          {"stiffness_s2", with_sd(at.at.stiffness_s2, std::sqrt(std::max(0.0, at.covariance(2, 2))))},
          {"covariance", matrix(at.covariance)}};
}

json takes_json(const rig_calibration& c) {
  json out = json::array();
  const auto& L = c.fit.layout;
  for (std::size_t t = 0; t < c.takes.size(); ++t) {
    const double strength = std::exp(c.fit.value[L.at(t, layout::strength)]);
    const auto both = [&](int which) { return with_sd(c.fit.value[L.at(t, which)], c.fit.sd[L.at(t, which)]); };
    out.push_back({{"name", c.takes[t].name},
                   {"role", "fitted"},
                   {"declared_force_N", c.takes[t].strength_N},
                   {"force_N", with_both({strength, 0, strength * c.fit.sd[L.at(t, layout::strength)]})},
                   {"release_s", both(layout::release)},
                   {"offset_near_N", both(layout::offset_near)},
                   {"offset_far_N", both(layout::offset_far)},
                   {"residual", number_or_null(c.fit.residual_ratio[t])}});
  }
  for (const auto& p : c.predicted)
    out.push_back({{"name", p.name},
                   {"role", "held-out"},
                   {"force_N", with_sd(p.strength_N, std::numeric_limits<double>::quiet_NaN())},
                   {"release_s", with_sd(p.release_s, std::numeric_limits<double>::quiet_NaN())},
                   {"residual", number_or_null(p.residual_ratio)}});
  return out;
}

json fit_json(const rig_calibration& c) {
  json names = json::array(), values = json::array(), sds = json::array();
  for (Eigen::Index p = 0; p < c.fit.layout.size(); ++p) {
    names.push_back(c.fit.layout.name(p));
    values.push_back(number_or_null(c.fit.value[p]));
    sds.push_back(number_or_null(c.fit.sd[p]));
  }
  return {{"parameters", names},
          {"value", values},
          {"sd", sds},
          {"covariance", matrix(c.fit.covariance)},
          {"misfit", number_or_null(c.fit.misfit)},
          {"loss_scatter", c.fit.loss_scatter},
          {"ln_loss_of_modes", c.fit.own_losses},
          {"converged", c.fit.converged},
          {"iterations", c.fit.iterations},
          {"band_Hz", {c.fit.limits.pass_Hz, c.fit.limits.stop_Hz}},
          {"periods_used", c.fit.horizon_periods < 1e6 ? json(c.fit.horizon_periods) : json(nullptr)},
          {"unidentified", c.fit.unidentified}};
}

Eigen::MatrixXd matrix_of(const json& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size()), m = n > 0 ? static_cast<Eigen::Index>(rows.at(0).size()) : 0;
  Eigen::MatrixXd out(n, m);
  for (Eigen::Index r = 0; r < n; ++r)
    for (Eigen::Index c = 0; c < m; ++c) out(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
  return out;
}

/// The order of the modes in the covariance is that of "parameters".
fitted_ends ends_of(const json& document) {
  fitted_ends out;
  if (!document.contains("terminations")) return out;
  const json& ends = document.at("terminations");
  for (const json& name : ends.at("fitted")) out.fitted[name == "near" ? 0 : 1] = true;
  std::array<std::size_t, 2> taken{};
  const json& names = ends.at("parameters");
  for (std::size_t i = 0; i < names.size(); i += 3) {
    const std::size_t e = names.at(i).get<std::string>().find(" of near ") != std::string::npos ? 0 : 1;
    const json& m = ends.at(e == 0 ? "near" : "far").at(taken[e]++);
    const double per_mass = m.at("impedance_per_mass_per_s").at("value");
    out.modes.push_back({e,
                         {m.at("frequency_Hz").at("value"), m.at("q").at("value"), per_mass},
                         m.at("frequency_Hz").at("sd"),
                         m.at("q").at("sd"),
                         m.at("impedance_per_mass_per_s").at("sd").get<double>() / per_mass,
                         m.at("end_uncertain")});
  }
  out.covariance = matrix_of(ends.at("covariance"));
  for (const json& place : document.at("positions"))
    if (!out.modes.empty()) out.with_waveform.push_back(matrix_of(place.at("covariance_with_terminations")));
  return out;
}

}  // namespace

calibration_set set_of(const rig_calibration& fitted) {
  std::string names;
  for (const auto& t : fitted.takes) names += (names.empty() ? "" : ", ") + t.name;
  return {"fit of " + names, fitted.rate_Hz(), fitted.fit.value[layout::fundamental], fitted.offset_N, fitted.declared,
          fitted.at,         fitted.ends};
}

json to_json(const rig_calibration& c, const provenance& from) {
  const auto e = gain_errors_of(c);
  json out{{"schema", 1},    {"format", "calibration"},         {"kind", "force-plucks"},  {"provenance", from.to_json()},
           {"rig", c.title}, {"sampling_rate_Hz", c.rate_Hz()}, {"string", string_json(c)}};
  out["channels"] = {{"near", channel_json(c, 0)}, {"far", channel_json(c, 1)}};
  out["gain_ratio"] =
      with_sd(c.at.front().gain[0] / c.at.front().gain[1], c.at.front().gain[0] / c.at.front().gain[1] * e.ratio_sd);
  out["common_scale_relative_sd"] = number_or_null(e.scale_sd);
  out["impedance_relative_sd"] = number_or_null(c.at.front().impedance_relative_sd);
  out["waveform_parameters"] = parameter_names;
  out["positions"] = json::array();
  for (std::size_t i = 0; i < c.at.size(); ++i) {
    out["positions"].push_back(position_json(c, i));
    if (!c.ends.modes.empty()) out["positions"].back()["covariance_with_terminations"] = matrix(c.ends.with_waveform[i]);
  }
  if (c.ends.fitted[0] || c.ends.fitted[1]) out["terminations"] = ends_json(c);
  out["takes"] = takes_json(c);
  out["fit"] = fit_json(c);
  out["warnings"] = c.warnings;
  out["assumed"] = c.assumed;
  return out;
}

rosin::outcome<calibration_set> read_calibration(const std::string& path) {
  const auto text = rosin::read_file(path);
  if (!text) return rosin::failure{text.error()};
  const json document = json::parse(*text, nullptr, false);
  if (document.is_discarded()) return rosin::failure{path + ": is not JSON"};
  try {
    const json none;
    const auto is = [&](const char* key, const json& value) {
      return document.is_object() && document.value(key, none) == value;
    };
    if (!is("format", "calibration") || !is("kind", "force-plucks") || !is("schema", 1))
      return rosin::failure{path + ": is no calibration by force plucks (schema 1), as `rosin fit --json` writes it"};
    calibration_set out;
    out.from = path;
    out.rate_Hz = document.at("sampling_rate_Hz");
    const json& string = document.at("string");
    out.fundamental_Hz = string.at("fundamental_Hz").at("value");
    rosin::calibration common;
    common.at.loss = {1 / string.at("inverse_quality").at("value").get<double>(), string.at("loss_internal_s").at("value"),
                      string.at("loss_air_sqrt_Hz").at("value")};
    for (const auto& [key, to] :
         {std::pair{"loss_causality", &rosin::loss_law::causality}, {"loss_drag_Hz", &rosin::loss_law::drag_Hz}})
      if (string.contains(key)) common.at.loss.*to = string.at(key).at("value");
    common.at.loss.reference_Hz = out.fundamental_Hz;
    common.at.impedance_Ns_m = string.at("impedance_Ns_m").is_null() ? std::numeric_limits<double>::quiet_NaN()
                                                                     : string.at("impedance_Ns_m").at("value").get<double>();
    common.scale_relative_sd = document.at("common_scale_relative_sd");
    common.impedance_relative_sd = document.at("impedance_relative_sd");
    for (std::size_t c = 0; c < 2; ++c) {
      const json& channel = document.at("channels").at(c == 0 ? "near" : "far");
      common.gain[c] = channel.at("gain").at("value");
      common.noise_N[c] = channel.at("noise_N");
      common.ac_coupled_Hz[c] = channel.at("ac_coupled_Hz");
      out.offset_N[c] = {channel.at("offset_N").at("value"), channel.at("offset_N").at("sd"), 0};
    }
    for (const json& place : document.at("positions")) {
      rosin::calibration c = common;
      c.position = place.at("position").at("value");
      c.at.delay_s = {place.at("delay_near_s").at("value"), place.at("delay_far_s").at("value")};
      c.at.stiffness_s2 = place.at("stiffness_s2").at("value");
      for (Eigen::Index i = 0; i < rosin::waveform_parameters; ++i)
        for (Eigen::Index j = 0; j < rosin::waveform_parameters; ++j)
          c.covariance(i, j) = place.at("covariance").at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
      out.declared.push_back(place.at("declared"));
      out.at.push_back(c);
    }
    out.ends = ends_of(document);
    const auto sound = [](const rosin::calibration& c) {
      return c.at.delay_s[0] > 0 && c.at.delay_s[1] > 0 && c.gain[0] > 0 && c.gain[1] > 0 && c.at.loss.quality > 0;
    };
    if (out.at.empty() || !std::all_of(out.at.begin(), out.at.end(), sound))
      return rosin::failure{path + ": delays, gains and Q have to be positive, and one position at least has to be there"};
    return out;
  } catch (const json::exception& error) {
    return rosin::failure{path + ": " + error.what() + ": a number that is needed is not there"};
  }
}

std::optional<rosin::failure> save_json(const std::string& path, const json& document, bool force) {
  if (path == "-") {
    print(document);
    return std::nullopt;
  }
  return rosin::write_file(path, force ? rosin::overwrite::allow : rosin::overwrite::refuse, [&](std::ostream& out) {
    out << document.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
  });
}

}  // namespace tool
