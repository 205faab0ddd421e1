// SPDX-License-Identifier: MIT
#include "pluck_input.hpp"
#include "progress.hpp"

namespace tool {

namespace {

std::optional<rosin::pluck_take> pluck_of(const rosin::rig& rig, const rosin::take& take, const checked_take& read,
                                          std::vector<std::string>& warnings) {
  const auto position = rig.position_of(take);
  if (!position) {
    warnings.push_back(take.name + ": left out: its position is unknown; give [contact].position or contact_position");
    return std::nullopt;
  }
  if (!take.force_N) {
    warnings.push_back(take.name + ": left out: the force of its release (force_N) is unknown");
    return std::nullopt;
  }
  rosin::pluck_take out{take.name, read.signals.sample_rate_Hz, {read.signals.near_N(), read.signals.far_N()},
                        *take.force_N, rosin::force_tolerance_of(take), *position};
  return out;
}

void keep_one_rate(rig_plucks& out) {
  if (out.takes.empty()) return;
  const double rate = out.takes.front().rate_Hz;
  std::erase_if(out.takes, [&](const rosin::pluck_take& t) {
    if (t.rate_Hz == rate) return false;
    out.warnings.push_back(t.name + ": left out: recorded at " + rosin::detail::figure(t.rate_Hz, "%.0f") + " Hz, the first pluck at " +
                           rosin::detail::figure(rate, "%.0f") + " Hz");
    return out.incomplete = true;
  });
}

}  // namespace

rig_plucks read_plucks(const rosin::rig& rig, provenance& from) {
  rig_plucks out;
  const auto plucks = std::count_if(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::pluck; });
  progress bar{"reading plucks", static_cast<std::size_t>(plucks)};
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::pluck) continue;
    bar.step();
    const auto read = read_take(rig, take, from);
    if (!read) {
      out.warnings.push_back(take.name + ": left out: " + read.error());
      out.incomplete = true;
      continue;
    }
    for (const auto& f : read->check.findings)
      if (f.level != rosin::severity::note) out.warnings.push_back(sentence(rig, f));
    if (rosin::has_error(read->check.findings)) {
      out.warnings.push_back(take.name + ": left out for the error above");
      out.incomplete = true;
      continue;
    }
    auto pluck = pluck_of(rig, take, *read, out.warnings);
    if (!pluck) out.incomplete = true;
    else (take.hold_out ? out.held_out : out.takes).push_back(*std::move(pluck));
  }
  keep_one_rate(out);
  return out;
}

rosin::pluck_guess guess_of(const rosin::rig& rig, const rosin::rig_values& values) {
  const auto& near = *rig.channel("near");
  const auto& far = *rig.channel("far");
  rosin::pluck_guess guess{values.fundamental_Hz.value, 0, values.quality, {rosin::gain_tolerance_of(near), rosin::gain_tolerance_of(far)},
                           {near.ac_coupled_Hz.value_or(0), far.ac_coupled_Hz.value_or(0)}};
  if (values.bending_stiffness_Nm2 && values.tension_N && values.length_m)
    guess.inharmonicity = std::pow(std::numbers::pi / values.length_m->value, 2) * values.bending_stiffness_Nm2->value / values.tension_N->value;
  return guess;
}

}  // namespace tool
