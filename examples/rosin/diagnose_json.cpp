// SPDX-License-Identifier: MIT
//
// The format "diagnosis".
//
#include "diagnose_rig.hpp"

namespace tool {

namespace {

json number(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

json with_interval(const diagnosed_value& v) {
  json out{{"value", v.value}};
  if (std::isfinite(v.sd) && v.sd > 0) out["ci95"] = interval_of(v);
  return out;
}

json pair_or_null(const std::optional<std::array<double, 2>>& p) { return p ? json{(*p)[0], (*p)[1]} : json(nullptr); }

json to_json(const missing_effect& m) {
  json where = json::object(), parameters = json::object();
  if (!m.end.empty()) where["end"] = m.end;
  if (!m.channel.empty()) where["channel"] = m.channel;
  if (m.position) where["position"] = *m.position;
  for (const auto& p : m.parameters)
    if (std::isfinite(p.value)) parameters[p.name] = with_interval(p);
  return {{"effect", m.effect},           {"where", where},
          {"probability", m.probability}, {"indistinguishable_from", m.indistinguishable_from},
          {"parameters", parameters},     {"statement", m.statement}};
}

}  // namespace

json to_json(const rig_diagnosis& d, const provenance& from) {
  json out{{"schema", 1}, {"rig", d.title}, {"verdict", d.verdict}};
  out["mismatch"] = d.verdict == "no-mismatch" ? json(nullptr)
                                               : json{{"take", d.take},
                                                      {"channel", d.channel.empty() ? json(nullptr) : json(d.channel)},
                                                      {"time_s", pair_or_null(d.time_s)},
                                                      {"band_Hz", pair_or_null(d.band_Hz)},
                                                      {"position", d.position ? json(*d.position) : json(nullptr)},
                                                      {"residual_over_noise", d.residual_over_noise}};
  out["missing"] = json::array();
  for (const auto& m : d.missing) out["missing"].push_back(to_json(m));
  out["ranking"] = json::array();
  for (const auto& r : d.ranking) out["ranking"].push_back({{"effects", r.effects}, {"log10_evidence", r.log10_evidence}});
  out["calibration"] = json::object();
  for (const auto& v : d.calibration)
    if (std::isfinite(v.value))
      out["calibration"][v.name] = std::isfinite(v.sd) ? json{{"value", v.value}, {"sd", v.sd}} : json{{"value", v.value}};
  out["fit"] = {{"metric", d.metric},
                {"held_out", d.held_out},
                {"before", number(d.before)},
                {"after", d.after ? number(*d.after) : json(nullptr)},
                {"noise_floor", number(d.noise_floor)}};
  out["assumed"] = d.assumed;
  out["warnings"] = d.warnings;
  out["provenance"] = from.to_json();
  return out;
}

}  // namespace tool
