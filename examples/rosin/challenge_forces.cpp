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
rosin::outcome<double> error_of(const rosin::rig& rig, const rosin::take& take, const checked_take& read, const calibration_set& calibration, const take_options& how,
                                const rosin::table& truth) {
  const auto made = reconstruct_take(rig, take, read, calibration, how);
  if (!made) return rosin::failure{made.error()};
  const auto* force = truth.find("force_N");
  if (force == nullptr || force->values.size() != made->force_N.size()) return rosin::failure{take.name + ": the true force is of another length"};
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

}  // namespace

json force_errors(const fs::path& rig, const fs::path& truth, const std::string& diagnosis, provenance from) {
  const auto folder = open_rig(rig.string(), from);
  if (!folder) return json::object();
  json out = json::object();
  std::optional<calibration_set> declared;
  for (const auto& take : folder->rig.takes) {
    const auto file = true_forces(truth, rig.filename().string(), take.name);
    if (take.kind != rosin::take_kind::bow || !fs::exists(file)) continue;
    const auto measure = [&]() -> rosin::outcome<json> {
      const auto known = rosin::read_csv(file.string());
      if (!known) return rosin::failure{known.error()};
      const auto read = read_sound_take(folder->rig, take, from);
      if (!read) return rosin::failure{read.error()};
      if (!declared) {
        const auto fitted = calibrate(folder->rig, from, false);
        if (!fitted) return rosin::failure{fitted.error()};
        declared = set_of(*fitted);
      }
      take_options how;
      const auto before = error_of(folder->rig, take, *read, *declared, how, *known);
      if (!before) return rosin::failure{before.error()};
      if (!corrects(diagnosis)) return json{{"before", *before}, {"after", *before}};
      auto model = read_model(diagnosis, folder->rig, from);
      if (!model) return rosin::failure{model.error()};
      how.model = *std::move(model), how.fine_tune = false;
      const auto after = error_of(folder->rig, take, *read, *declared, how, *known);
      if (!after) return rosin::failure{after.error()};
      return json{{"before", *before}, {"after", *after}};
    };
    const auto errors = measure();
    out[take.name] = errors ? *errors : json{{"error", errors.error()}};
  }
  return out;
}

}  // namespace tool
