// SPDX-License-Identifier: MIT
#include "corrected_model.hpp"
#include "diagnose_parts.hpp"
#include "digits.hpp"

#include <fstream>
#include <limits>

namespace tool {

namespace {

/// The effects of the catalogue that a diagnosis names, in the order in which its calibration holds them.
std::vector<rosin::pluck_effect> effects_of(const json& diagnosis, const std::vector<rosin::pluck_effect>& catalogue,
                                            corrected_model& out) {
  std::vector<rosin::pluck_effect> found;
  const json& calibration = diagnosis.at("calibration");
  for (const json& m : diagnosis.at("missing")) {
    const std::string name = m.at("effect");
    const auto& where = m.at("where");
    const std::string place = where.value("end", where.value("channel", std::string{}));
    const auto is_it = [&](const rosin::pluck_effect& c) {
      return c.name == name && place == (c.place < 0 ? "" : c.place == 0 ? "near" : "far");
    };
    auto e = std::find_if(catalogue.begin(), catalogue.end(), [&](const auto& c) {
      return is_it(c) && calibration.contains(c.id() + " " + c.parameters.front().name);
    });
    if (e == catalogue.end()) e = std::find_if(catalogue.begin(), catalogue.end(), is_it);
    if (e != catalogue.end()) found.push_back(*e), out.effects.push_back(name);
    else if (name == "tension-drift")
      out.tension_drift = m.at("parameters").at("relative").at("value"), out.effects.push_back(name);
    else if (name == "finite-contact-width" && m.at("parameters").contains("width_m"))
      out.contact_width_m = m["parameters"]["width_m"].at("value"), out.effects.push_back(name);
    else out.passed_over.push_back(name);
  }
  return found;
}

/// A value of the calibration; NaN where it is not there.
std::array<double, 2> value_of(const json& calibration, const std::string& name) {
  const auto it = calibration.find(name);
  if (it == calibration.end() || !it->is_object()) return {std::numeric_limits<double>::quiet_NaN(), 0};
  return {it->value("value", std::numeric_limits<double>::quiet_NaN()), it->value("sd", 0.0)};
}

/// Whether its inputs have the checksum of the rig file that is used now; empty where they do, or tell none.
std::string doubt_of(const json& diagnosis, const rosin::rig& rig, const provenance& from) {
  const json inputs = diagnosis.value("provenance", json::object()).value("inputs", json::array());
  const auto of_rig =
      std::find_if(from.inputs.begin(), from.inputs.end(), [&](const input_file& f) { return f.path == rig.file; });
  const auto is_it = [&](const json& f) { return f.value("sha256", std::string{}) == of_rig->sha256; };
  if (of_rig == from.inputs.end() || inputs.empty() || std::any_of(inputs.begin(), inputs.end(), is_it)) return {};
  return "was made of another rig file, or of " + rig.file + " before it was changed; what it says holds for that one";
}

/// A diagnosis may have left a pluck out that contradicts the others, and fitted one that was to be held out.
void keep_calibrated(const json& calibration, plucks_to_diagnose& plucks) {
  plucks.takes.insert(plucks.takes.end(), plucks.held.begin(), plucks.held.end());
  plucks.held.clear();
  std::erase_if(plucks.takes, [&](const rosin::pluck_take& t) { return !calibration.contains("release_s of " + t.name); });
}

/// With what the diagnosis had to free besides (loosened_plucks.hpp).
void loosen(const json& calibration, plucks_to_diagnose& plucks) {
  auto& options = plucks.options;
  const std::size_t places = rosin::pluck_layout(plucks.takes, options).positions().size(), takes = plucks.takes.size();
  options.uneven_loss = calibration.contains("loss_cosine_1");
  options.own_places = takes > places && calibration.contains("position " + std::to_string(takes));
}

}  // namespace

rosin::outcome<corrected_model> read_model(const std::string& path, const rosin::rig& rig, provenance& from) {
  if (const auto why = from.add_input(path)) return *why;
  const auto text = rosin::read_file(path);
  if (!text) return rosin::failure{text.error()};
  const json document = json::parse(*text, nullptr, false);
  const auto wrong = [&](const std::string& what) { return rosin::failure{path + ": " + what}; };
  if (!document.is_object() || !document.contains("missing") || !document.contains("calibration") ||
      !document["calibration"].is_object() || !document["missing"].is_array())
    return wrong("is no diagnosis (rosin diagnose --json writes one)");
  const rosin::rig_values values = rosin::values_of(rig);
  if (!values.impedance_Ns_m) return wrong(rig.file + " does not tell the string's impedance: length_m and tension_N are needed");
  auto plucks = plucks_of(rig, values, from);
  if (!plucks) return rosin::failure{plucks.error()};
  const json& calibration = document["calibration"];
  if (!calibration.contains("fundamental_Hz")) return wrong("calibration has no \"fundamental_Hz\"");
  keep_calibrated(calibration, *plucks);
  loosen(calibration, *plucks);
  if (plucks->takes.empty()) return wrong("calibration has none of the plucks that " + rig.file + " names");
  corrected_model out{path, {}, 0, 0, {}, {}, from, {}};
  const rosin::pluck_layout layout(plucks->takes, plucks->options, plucks->guess.ends);
  const double rate = plucks->takes.front().rate_Hz,
               pitch = value_of(calibration, layout.name(rosin::pluck_layout::fundamental))[0];
  const rosin::string_facts facts{
      pitch, rate, 0.45 * rate, values.impedance_Ns_m->value, values.length_m ? values.length_m->value : 0, plucks->takes.size()};
  try {
    out.doubt = doubt_of(document, rig, from);
    auto effects = effects_of(document, rosin::catalogue_without({}, facts, {0.3 * rate, 0.45 * rate}), out);
    Eigen::Index count = layout.size();
    for (const auto& e : effects) count += static_cast<Eigen::Index>(e.parameters.size());
    Eigen::VectorXd value = Eigen::VectorXd::Zero(count), sd = value;
    for (Eigen::Index p = 0; p < layout.size(); ++p) {
      auto [v, s] = value_of(calibration, layout.name(p));
      const bool optional = p >= rosin::pluck_layout::causality && p <= rosin::pluck_layout::loss_drag;
      if (optional && !std::isfinite(v)) v = s = 0;  // older models have none
      if (!std::isfinite(v))
        return wrong("calibration has no \"" + layout.name(p) + "\": it was made of other takes or terminations than " +
                     rig.file + " names");
      value[p] = v, sd[p] = s;
    }
    Eigen::Index at = layout.size();
    for (const auto& e : effects)
      for (const auto& q : e.parameters) {
        const auto [v, s] = value_of(calibration, e.id() + " " + q.name);
        if (q.take < 0 && !q.late && !std::isfinite(v)) return wrong("calibration has no \"" + e.id() + " " + q.name + "\"");
        // of single takes: nothing that a stroke needs; a correction: 0 if not told
        const double physical = q.take < 0 && std::isfinite(v) ? v : 0;
        value[at] = q.logarithmic && physical > 0 ? std::log(physical) : physical;
        sd[at++] = !std::isfinite(v) ? 0 : q.logarithmic && v > 0 ? s / v : s;
      }
    rosin::pluck_diagnosis d{
        {plucks->takes, plucks->guess, plucks->options, layout}, {}, {}, {}, {}, {}, {}, {}, true, true, 0, 0, 0, {}};
    d.declared.layout = layout, d.declared.value = value.head(layout.size());
    d.best.effects = std::move(effects), d.best.value = value, d.best.sd = sd;
    for (const std::size_t c : {0U, 1U})
      if (const double noise_N = value_of(calibration, channel_noise[c])[0]; noise_N > 0) d.best.quality.noise[c] = noise_N;
    d.best.covariance = sd.array().square().matrix().asDiagonal();
    out.plucks = std::make_shared<const rosin::pluck_diagnosis>(std::move(d));
  } catch (const json::exception& error) {
    return wrong(std::string{"is no diagnosis: "} + error.what());
  }
  return out;
}

rosin::outcome<processed> process_with_model(const corrected_model& model, const rosin::rig& rig, const std::string& take,
                                             const rosin::band& limits, std::vector<std::string>& warnings) {
  provenance own{model.from};
  std::vector<std::string> said;
  const auto values = rosin::values_of(rig);
  auto strokes = reconstruct_strokes(rig, values, *model.plucks, model.tension_drift, own, said, take, limits);
  // A string that motion stretches is tighter under the bow than at rest. Where it carries something, or its ends move, that is known
  // in the mean only: by as much as the force's two versions say.
  const bool stretches = std::find(model.effects.begin(), model.effects.end(), "tension-modulation") != model.effects.end();
  if (const auto drift =
          stretches && model.tension_drift == 0 && !strokes.empty() ? drift_of(strokes, *model.plucks) : rosin::tension_drift{};
      drift.relative > 3 * drift.sd && drift.delta_after < drift.delta_before) {
    said.clear();
    strokes = reconstruct_strokes(rig, values, *model.plucks, drift.relative, own, said, take, limits);
    said.push_back(take + ": its tension is " + in_digits(100 * drift.relative, "%+.3g") +
                   " % off the plucks': their motion stretches the string");
  }
  if (strokes.empty())
    return rosin::failure{model.file + ": " + (said.empty() ? take + " could not be reconstructed" : said.back())};
  warnings.insert(warnings.end(), said.begin(), said.end());
  diagnosed_stroke& s = strokes.front();
  if (model.contact_width_m > 0)
    if (const auto edge_Hz = see_as_wide(rig, *model.plucks, model.contact_width_m, s))
      warnings.push_back(take + ": force of both places of a contact of " + in_digits(1e3 * model.contact_width_m, "%.3g") +
                         " mm and their mean velocity, up to " + in_digits(1e-3 * *edge_Hz, "%.3g") +
                         " kHz, where they can be told apart; the two versions part as a point's do");
  processed out;
  out.used = s.calibration, out.force_N = std::move(s.force_N), out.motion = std::move(s.motion), out.sd = std::move(s.sd);
  out.why_not_periodic = "not sought with --model";
  return out;
}

}  // namespace tool
