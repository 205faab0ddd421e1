// SPDX-License-Identifier: MIT
#include "simulate_takes.hpp"

#include "progress.hpp"

#include <rosin/simulate/wave_stroke.hpp>

namespace tool {

namespace {

using rosin::quantity;
using rosin::take_kind;
using samples = std::vector<double>;

constexpr double loudest_share = 0.7;

/// A bow that travels on a string whose ends move, and nothing else: by waves, since the modes of such a string stand at fixed
/// places.
rosin::outcome<rosin::modal_take> travel_on_moving_ends(const simulation_plan& plan, const true_take& take,
                                                        const rosin::modal_rig& rig) {
  auto rest = plan.burden;
  rest.string.ends = {};
  if (!rest.none())
    return rosin::failure{
        "position_profile: a bow that travels can be simulated on ends that move, on nothing else that a model adds"};
  const auto& s = plan.settings;
  const rosin::wave_settings settings{.sample_rate_Hz = s.sample_rate_Hz,
                                      .oversampling = s.oversampling,
                                      .pass_Hz = s.pass_Hz,
                                      .stop_Hz = s.stop_Hz,
                                      .ripple = s.ripple};
  return std::visit(
      [&](const auto& law) {
        return rosin::simulate_wave_stroke(rig, law, take.rod, {.position = take.position, .duration_s = plan.duration_s},
                                           settings, plan.burden.string.ends);
      },
      plan.friction.law);
}

rosin::outcome<rosin::modal_take> happen(const simulation_plan& plan, const true_take& take) {
  const bool plain = plan.burden.none();
  if (take.declared.kind == take_kind::pluck)
    return plain ? rosin::simulate_pluck(plan.rig, take.pluck, plan.settings)
                 : rosin::simulate_pluck(plan.rig, plan.burden, take.pluck, plan.settings);
  if (take.declared.kind == take_kind::bow) {
    const rosin::modal_stroke stroke{.position = take.position, .duration_s = plan.duration_s, .account = true};
    const auto rig = stretched(plan.rig, plan.tension_drift);
    if (!plain && take.rod.travels()) return travel_on_moving_ends(plan, take, rig);
    return std::visit(
        [&](const auto& law) {
          return plain ? rosin::simulate_stroke(rig, law, take.rod, stroke, plan.settings)
                       : rosin::simulate_stroke(rig, plan.burden, law, take.rod, stroke, plan.settings);
        },
        plan.friction.law);
  }
  const auto size = std::lround(plan.duration_s * plan.settings.sample_rate_Hz);
  return rosin::detail::silent_take(plan.settings.sample_rate_Hz, static_cast<std::size_t>(size));
}

/// From the velocity, by the trapezoidal rule; a pluck starts from its static deflection.
samples displacement(const simulation_plan& plan, const true_take& take, const samples& velocity_m_s) {
  samples out(velocity_m_s.size());
  const auto& clamping = plan.burden.string.clamping;  // a string that is held at its ends is a shorter one
  const double reach = std::sqrt(plan.rig.string.bending_stiffness_Nm2 / plan.rig.string.tension_N) / plan.rig.string.length_m,
               whole = 1 - (clamping[0] + clamping[1]) * reach;
  auto held = plan.rig.string;
  held.length_m *= whole;
  const double start =
      take.declared.kind == take_kind::pluck
          ? take.pluck.force_N * rosin::static_compliance_m_N(held, (take.position - clamping[0] * reach) / whole)
          : 0.0;
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n] = n == 0 ? start : out[n - 1] + (velocity_m_s[n - 1] + velocity_m_s[n]) / 2 / plan.settings.sample_rate_Hz;
  return out;
}

/// What a channel is meant to measure, in the SI unit of its quantity.
samples measured(const simulation_plan& plan, const true_take& take, const rosin::modal_take& truth,
                 const rosin::sensor_channel& c) {
  const bool bowed = take.declared.kind == take_kind::bow;
  switch (c.quantity) {
    case quantity::termination_force:
      return c.name == "near" ? truth.force_near_N : truth.force_far_N;
    case quantity::string_velocity:
      return truth.centre_velocity_m_s;
    case quantity::string_displacement:
      return displacement(plan, take, truth.centre_velocity_m_s);
    case quantity::bow_speed:
      if (bowed) return truth.rod_velocity_m_s;
      break;
    case quantity::normal_force:
      if (bowed) {
        samples out(truth.size());
        for (std::size_t n = 0; n < out.size(); ++n)
          out[n] = take.rod(static_cast<double>(n) / truth.sample_rate_Hz).normal_force_N;
        return out;
      }
      break;
    case quantity::sound:
    case quantity::unused:
      break;
  }
  return samples(truth.size(), 0.0);
}

bool has_scale(const rosin::sensor_channel& c) { return c.per_full_scale || c.quantity == quantity::unused; }

/// The scale of a channel that declares none: the same in all takes.
void fill_range(simulation_plan& plan, const std::vector<simulated_take>& takes) {
  for (auto& channel : plan.channels) {
    if (has_scale(channel.declared)) continue;
    double peak = 0;
    for (std::size_t i = 0; i < takes.size(); ++i)
      for (const double x : measured(plan, plan.takes[i], takes[i].truth, channel.declared)) peak = std::max(peak, std::abs(x));
    channel.gain = peak > 0 ? loudest_share / peak : 1;
  }
}

/// One channel into the recording; a channel that the rig file does not name holds noise.
void record_channel(const simulation_plan& plan, std::size_t i, std::size_t index, const true_channel* channel,
                    simulated_take& out) {
  const auto& take = plan.takes[i];
  const double full = channel != nullptr ? channel->declared.per_full_scale.value_or(1) : 1;
  const double share = channel != nullptr ? channel->noise_share : plan.channels.front().noise_share;
  const rosin::converter with{.gain = channel != nullptr ? channel->gain : 1,
                              .newtons_per_full_scale = full,
                              .noise_N = share * full,
                              .ac_coupled_Hz = channel != nullptr ? channel->declared.ac_coupled_Hz.value_or(0) : 0,
                              .hum = channel != nullptr ? channel->hum : std::vector<rosin::hum_line>{},
                              .bits = plan.bits == 0 ? 32 : plan.bits};
  const auto seed = seed_for(plan.seed, "noise " + take.declared.name + " " + std::to_string(index));
  samples signal = channel != nullptr ? measured(plan, take, out.truth, channel->declared) : samples(out.truth.size(), 0.0);
  if (channel != nullptr && channel->declared.quantity == quantity::termination_force)
    for (double& f : signal) f += take.offset_N[channel->declared.name == "near" ? 0 : 1] / channel->gain;
  const auto converted = rosin::convert(signal, plan.settings.sample_rate_Hz, with, seed);
  auto& column = out.recording.channels.at(index);
  column.resize(converted.size());
  double peak = 0;
  for (std::size_t n = 0; n < column.size(); ++n) peak = std::max(peak, std::abs(column[n] = converted.share(n)));
  if (channel == nullptr) return;
  out.clipped.push_back(converted.clipped);
  out.peak_share.push_back(peak);
}

void record(const simulation_plan& plan, std::size_t i, simulated_take& out) {
  const auto last = static_cast<std::size_t>(plan.channels.back().declared.index);
  out.recording = {.file = plan.takes[i].declared.file,
                   .sample_rate_Hz = plan.settings.sample_rate_Hz,
                   .bits = plan.bits == 0 ? 32 : plan.bits,
                   .float_format = plan.bits == 0};
  out.recording.channels.resize(last + 1);
  auto next = plan.channels.begin();
  for (std::size_t index = 0; index <= last; ++index) {
    const bool named = static_cast<std::size_t>(next->declared.index) == index;
    record_channel(plan, i, index, named ? &*next : nullptr, out);
    if (named && next + 1 != plan.channels.end()) ++next;
  }
}

}  // namespace

rosin::outcome<std::vector<simulated_take>> simulate_takes(simulation_plan& plan, progress& bar) {
  std::vector<simulated_take> out;
  for (const auto& take : plan.takes) {
    auto truth = happen(plan, take);
    if (!truth) return rosin::failure{"take \"" + take.declared.name + "\": " + truth.error()};
    out.push_back({*std::move(truth), {}, {}, {}});
    bar.step();
  }
  fill_range(plan, out);
  for (std::size_t i = 0; i < out.size(); ++i) record(plan, i, out[i]);
  return out;
}

}  // namespace tool
