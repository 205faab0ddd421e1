// SPDX-License-Identifier: MIT
#include "pluck_input.hpp"
#include "digits.hpp"
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
  rosin::pluck_take out{take.name,     read.signals.sample_rate_Hz,     {read.signals.near_N(), read.signals.far_N()},
                        *take.force_N, rosin::force_tolerance_of(take), *position};
  return out;
}

std::string left_out(const std::string& take) { return take + ": left out for the error above"; }

/// Until when a take with errors can be used: where they are lost samples and nothing else, until shortly before the first.
std::optional<double> sound_until_s(const checked_take& read) {
  constexpr double aside = 16;  // samples
  std::optional<double> first;
  for (const rosin::finding& f : read.check.findings) {
    if (f.level != rosin::severity::error) continue;
    if (f.kind != "dropouts") return std::nullopt;
    first = std::min(first.value_or(f.start_s), f.start_s);
  }
  if (first) *first -= aside / read.signals.sample_rate_Hz;
  return first;
}

/// A pluck that lost samples, and until when it is whole.
struct begun_pluck {
  rosin::pluck_take take;
  double until_s = 0;
  bool held_out = false;
};

/// Where no pluck to be fitted is whole, what those are before they lost samples, if that is long enough to ring in.
void use_beginnings(std::vector<begun_pluck> begun, double fundamental_Hz, rig_plucks& out) {
  constexpr double least_periods = 20;
  const bool needed = out.takes.empty();
  for (begun_pluck& b : begun) {
    if (!needed || b.until_s * fundamental_Hz < least_periods) {
      out.warnings.push_back(left_out(b.take.name));
      continue;
    }
    for (auto& channel : b.take.force_N) channel.resize(static_cast<std::size_t>(b.until_s * b.take.rate_Hz));
    out.warnings.push_back(b.take.name + ": as no pluck is whole, used until it lost samples, " + in_digits(b.until_s, "%.4f") +
                           " s");
    (b.held_out ? out.held_out : out.takes).push_back(std::move(b.take));
  }
}

void keep_one_rate(rig_plucks& out) {
  if (out.takes.empty()) return;
  const double rate = out.takes.front().rate_Hz;
  std::erase_if(out.takes, [&](const rosin::pluck_take& t) {
    if (t.rate_Hz == rate) return false;
    out.warnings.push_back(t.name + ": left out: recorded at " + in_digits(t.rate_Hz, "%.0f") + " Hz, the first pluck at " +
                           in_digits(rate, "%.0f") + " Hz");
    return out.incomplete = true;
  });
}

}  // namespace

rig_plucks read_plucks(const rosin::rig& rig, provenance& from) {
  rig_plucks out;
  const auto plucks =
      std::count_if(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::pluck; });
  progress bar{"reading plucks", static_cast<std::size_t>(plucks)};
  std::vector<begun_pluck> begun;
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::pluck) continue;
    bar.step();
    const auto read = read_telling(rig, take, from, out.warnings);
    const bool sound = read && !rosin::has_error(read->check.findings);
    const auto until_s = read && !sound ? sound_until_s(*read) : std::nullopt;
    if (read && !sound && !until_s) out.warnings.push_back(left_out(take.name));
    auto pluck = sound || until_s ? pluck_of(rig, take, *read, out.warnings) : std::nullopt;
    if (!pluck || until_s) out.incomplete = true;
    if (pluck && until_s) begun.push_back({*std::move(pluck), *until_s, take.hold_out});
    else if (pluck) (take.hold_out ? out.held_out : out.takes).push_back(*std::move(pluck));
  }
  use_beginnings(std::move(begun), rig.string.fundamental_Hz, out);
  keep_one_rate(out);
  return out;
}

bool all_begin_late(const rosin::rig& rig, provenance& from) {
  bool any = false;
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::pluck || take.hold_out) continue;
    const auto read = read_take(rig, take, from);
    if (!read || !read->check.found("begins-late")) return false;
    for (const rosin::finding& f : read->check.findings)
      if (f.level == rosin::severity::error && f.kind != "begins-late") return false;
    any = true;
  }
  return any;
}

rosin::pluck_guess guess_of(const rosin::rig& rig, const rosin::rig_values& values) {
  const auto& near = *rig.channel("near");
  const auto& far = *rig.channel("far");
  rosin::pluck_guess guess{values.fundamental_Hz.value,
                           0,
                           values.quality,
                           {rosin::gain_tolerance_of(near), rosin::gain_tolerance_of(far)},
                           {near.ac_coupled_Hz.value_or(0), far.ac_coupled_Hz.value_or(0)}};
  if (values.bending_stiffness_Nm2 && values.tension_N && values.length_m)
    guess.inharmonicity =
        std::pow(std::numbers::pi / values.length_m->value, 2) * values.bending_stiffness_Nm2->value / values.tension_N->value;
  guess.position_tolerance = rig.position_tolerance.value_or(rosin::detail::default_position_tolerance);
  return guess;
}

std::vector<std::string> physics_of(const rosin::rig& rig) { return rig.model ? rig.model->physics : std::vector<std::string>{}; }

rosin::pluck_options options_for(const std::vector<std::string>& physics) {
  const auto has = [&](const char* name) { return std::find(physics.begin(), physics.end(), name) != physics.end(); };
  rosin::pluck_options out;
  out.stiffness = has("bending-stiffness"), out.internal_loss = has("frequency-dependent-loss"), out.air_loss = has("air-loss");
  return out;
}

}  // namespace tool
