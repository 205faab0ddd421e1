// SPDX-License-Identifier: MIT
#include "challenge_forces.hpp"
#include "challenge_rig.hpp"
#include "compare_columns.hpp"
#include "reconstruct_take.hpp"

#include <rosin/report/csv.hpp>

#include <fstream>

namespace tool {

namespace {

namespace fs = std::filesystem;

/// Of one stroke; its reason if it cannot be reconstructed.
rosin::outcome<double> error_of(const rosin::rig& rig, const rosin::take& take, const checked_take& read,
                                const calibration_set& calibration, const take_options& how, const rosin::table& truth) {
  const auto made = reconstruct_take(rig, take, read, calibration, how);
  if (!made) return rosin::failure{made.error()};
  const auto* force = truth.find("force_N");
  if (force == nullptr || force->values.size() != made->force_N.size())
    return rosin::failure{take.name + ": the true force is of another length"};
  const auto c = compare_columns("force_N", made->force_N, force->values, made->rate_Hz, compared_band(made->rate_Hz));
  if (!(c.rms_truth > 0)) return rosin::failure{take.name + ": too little of it is known"};
  return c.delta_scaled;
}

/// Whether a diagnosis changes anything; one that could not be made does not.
bool corrects(const std::string& diagnosis) {
  std::ifstream in{diagnosis};
  const json d = json::parse(in, nullptr, false);
  return d.is_object() && d.contains("missing") && !d["missing"].empty();
}

/// What all strokes of a rig are reconstructed with; no model if the diagnosis changes nothing.
struct both_ways {
  calibration_set declared;
  std::optional<corrected_model> model;
};

rosin::outcome<both_ways> prepare(const rosin::rig& rig, const std::string& diagnosis, provenance& from) {
  const auto fitted = calibrate(rig, from, false);
  if (!fitted) return rosin::failure{fitted.error()};
  both_ways out{set_of(*fitted), std::nullopt};
  if (!corrects(diagnosis)) return out;
  auto model = read_model(diagnosis, rig, from);
  if (!model) return rosin::failure{model.error()};
  out.model = *std::move(model);
  return out;
}

rosin::outcome<json> errors_of(const rosin::rig& rig, const rosin::take& take, const both_ways& how, const fs::path& true_file,
                               provenance& from) {
  const auto known = rosin::read_csv(true_file.string());
  if (!known) return rosin::failure{known.error()};
  const auto read = read_sound_take(rig, take, from);
  if (!read) return rosin::failure{read.error()};
  take_options options;
  const auto before = error_of(rig, take, *read, how.declared, options, *known);
  if (!before) return rosin::failure{before.error()};
  if (!how.model) return json{{"before", *before}, {"after", *before}};
  options.model = *how.model, options.fine_tune = false;
  const auto after = error_of(rig, take, *read, how.declared, options, *known);
  if (!after) return rosin::failure{after.error()};
  return json{{"before", *before}, {"after", *after}};
}

}  // namespace

json force_errors(const fs::path& rig, const fs::path& truth, const std::string& diagnosis, provenance from) {
  const auto folder = open_rig(rig.string(), from);
  if (!folder) return json::object();
  json out = json::object();
  std::optional<rosin::outcome<both_ways>> how;
  for (const auto& take : folder->rig.takes) {
    const auto file = true_forces(truth, rig.filename().string(), take.name);
    if (take.kind != rosin::take_kind::bow || !fs::exists(file)) continue;
    if (!how) how = prepare(folder->rig, diagnosis, from);
    const auto errors =
        *how ? errors_of(folder->rig, take, **how, file, from) : rosin::outcome<json>{rosin::failure{how->error()}};
    out[take.name] = errors ? *errors : json{{"error", errors.error()}};
  }
  return out;
}

}  // namespace tool
