// SPDX-License-Identifier: MIT
//
// The format "diagnosis".
//
#include "diagnose_rig.hpp"

#include <algorithm>

namespace tool {

namespace {

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

json rounded(const std::vector<double>& x) {
  json out = json::array();
  for (const double v : x) out.push_back(std::round(1e4 * v) / 1e4);
  return out;
}

json to_json(const rosin::mismatch_map::channel& c) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < c.over_noise.rows(); ++i) {
    json row = json::array();
    for (Eigen::Index k = 0; k < c.over_noise.cols(); ++k) row.push_back(std::round(100 * c.over_noise(i, k)) / 100);
    rows.push_back(row);
  }
  return {{"time_s", c.time_s}, {"wave", c.echo}, {"over_noise", rows}};
}

/// The part of the stick or slip in which most is left.
json cycle_of(const contact_picture& p) {
  const auto most = std::max_element(p.cycle_before.begin(), p.cycle_before.end()) - p.cycle_before.begin();
  const auto parts = static_cast<double>(p.cycle_before.size());
  return {{"phase", p.statistic == "stick-fluctuation" ? "stick" : "slip"},
          {"part", {static_cast<double>(most) / parts, static_cast<double>(most + 1) / parts}},
          {"before", rounded(p.cycle_before)},
          {"after", rounded(p.cycle_after)}};
}

/// What locates the mismatch: of the pluck that shows it most, and of the contact.
json maps_of(const rig_diagnosis& d) {
  json out = json::object();
  if (d.residual && d.residual->map && d.take == d.residual->take) {
    const auto& m = *d.residual->map;
    out["pluck"] = {{"take", d.take}, {"band_Hz", m.band_Hz}, {"near", to_json(m.channels[0])}, {"far", to_json(m.channels[1])}};
    if (const auto& f = d.residual->force)
      out["pluck"]["force"] = {{"parting_N", f->parting_N},
                               {"parting_noise_N", f->parting_noise_N},
                               {"shape_N", f->shape_N},
                               {"shape_noise_N", f->shape_noise_N}};
  }
  if (d.contact && !d.contact->cycle_before.empty())
    out["contact"] = cycle_of(*d.contact), out["contact"]["take"] = d.contact->take;
  return out;
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
                                                      {"residual_over_noise", d.residual_over_noise},
                                                      {"class", d.kind.empty() ? json(nullptr) : json(d.kind)},
                                                      {"wave", d.echo ? json(*d.echo) : json(nullptr)},
                                                      {"maps", maps_of(d)}};
  if (const auto& left = d.left_in_strokes)
    out["mismatch"]["strokes"] = {{"metric", left->statistic},
                                  {"take", left->take.empty() ? json(nullptr) : json(left->take)},
                                  {"left", number_or_null(left->size)},
                                  {"floor", number_or_null(left->floor)}};
  out["missing"] = json::array();
  for (const auto& m : d.missing) out["missing"].push_back(to_json(m));
  out["ranking"] = json::array();
  for (const auto& r : d.ranking) {
    out["ranking"].push_back({{"effects", r.effects}, {"log10_evidence", r.log10_evidence}});
    if (r.left) out["ranking"].back()["left"] = *r.left;
  }
  out["calibration"] = json::object();
  for (const auto& v : d.calibration)
    if (std::isfinite(v.value))
      out["calibration"][v.name] = std::isfinite(v.sd) ? json{{"value", v.value}, {"sd", v.sd}} : json{{"value", v.value}};
  out["fit"] = {{"metric", d.metric},
                {"held_out", d.held_out},
                {"before", number_or_null(d.before)},
                {"after", d.after ? number_or_null(*d.after) : json(nullptr)},
                {"noise_floor", number_or_null(d.noise_floor)}};
  out["assumed"] = d.assumed;
  out["warnings"] = d.warnings;
  out["provenance"] = from.to_json();
  return out;
}

}  // namespace tool
