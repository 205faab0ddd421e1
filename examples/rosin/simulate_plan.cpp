// SPDX-License-Identifier: MIT
#include "simulate_plan.hpp"

#include "rig_ends.hpp"
#include "rig_input.hpp"

#include <rosin/adapt/problem_log.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <numbers>
#include <set>

namespace tool {

namespace {

using rosin::quantity;
using rosin::take_kind;
using rosin::detail::sentence;

constexpr double usual_rate_Hz = 128000, usual_release_s = 0.004, most_samples = 4e6;
constexpr std::array can_simulate{"bending-stiffness", "frequency-dependent-loss", "air-loss", "torsion", "ac-coupling",
                                  "thermal-friction",  "elasto-plastic-friction"};

/// A deviation with the standard deviation given, never more than twice that.
double deviation(const simulation_plan& plan, const std::string& name, double sd) {
  rosin::gaussian_source source{seed_for(plan.seed, name)};
  return rosin::detail::slip_of_the_pen(source, sd);
}

std::string digits(double x) { return rosin::value_range::number(x); }

/// A table is simulated by modes too.
bool has_modes(const std::optional<rosin::termination>& end) {
  return end && (end->kind == rosin::termination::form::modes || end->kind == rosin::termination::form::table);
}

bool leads_out(const std::filesystem::path& file) { return file.is_absolute() || *file.lexically_normal().begin() == ".."; }

/// Whatever the modal simulation has no means for.
void refuse_unknown_physics(const rosin::rig& rig, rosin::problem_log& log) {
  for (const auto& [name, end] : {std::pair{"near", &rig.near}, std::pair{"far", &rig.far}})
    if (*end && (*end)->kind == rosin::termination::form::table && leads_out(std::filesystem::path{(*end)->file}))
      log.add(0, std::string{"terminations."} + name, (*end)->file + " leads out of the folder of the rig");
  const auto physics = rig.model ? rig.model->physics : std::vector<std::string>{};
  for (const auto& name : physics)
    if (std::find(can_simulate.begin(), can_simulate.end(), name) == can_simulate.end())
      log.add(0, "model.physics", "\"" + name + "\" cannot be simulated");
}

void refuse_channels(const rosin::rig& rig, rosin::problem_log& log) {
  for (const auto& c : rig.channels) {
    const std::string place = "channels." + c.name;
    if (c.quantity == quantity::sound) log.add(c.line, place + ".quantity", "sound cannot be simulated");
    if (c.quantity == quantity::string_displacement && (has_modes(rig.near) || has_modes(rig.far)))
      log.add(c.line, place + ".quantity", "a displacement cannot be simulated where [terminations] move");
    if (!c.position) continue;
    for (const auto& take : rig.takes)
      if (take.kind != take_kind::quiet && rig.position_of(take) != c.position)
        return log.add(c.line, place + ".position",
                       "is not the contact of take \"" + take.name + "\": the string's motion is simulated at the contact only");
  }
}

void refuse_file(const rosin::take& take, std::set<std::string>& files, rosin::problem_log& log) {
  const auto path = std::filesystem::path{take.file}.lexically_normal();
  const std::string place = "take \"" + take.name + "\".file";
  if (path.extension() != ".wav")
    log.add(take.line, place, "is " + take.file + "; simulated recordings are WAV files, the name must end in .wav");
  if (leads_out(path)) log.add(take.line, place, take.file + " leads out of the folder of the rig");
  if (!files.insert(path.string()).second) log.add(take.line, place, take.file + " is the file of another take too");
}

void refuse_takes(const rosin::rig& rig, double duration_s, rosin::problem_log& log) {
  std::set<std::string> files;
  for (const auto& take : rig.takes) {
    const auto bad = [&](const char* key, const std::string& why) {
      log.add(take.line, "take \"" + take.name + "\"." + key, why);
    };
    refuse_file(take, files, log);
    if (!rosin::table_ending(take.file).empty()) bad("file", take.file + " is a table: a simulation writes sound files, as .wav");
    if (take.kind == take_kind::quiet) continue;
    if (take.position_unknown) bad("position_unknown", "a simulation has to know where the string is touched");
    else if (!rig.position_of(take) && take.position_profile.empty())
      bad("contact_position", "is missing, and there is no [contact] position");
    if (take.kind == take_kind::pluck && !take.force_N) bad("force_N", "is missing: a simulation has to know the force");
    if (take.kind == take_kind::bow && !take.speed_m_s && take.speed_profile_m_s.empty())
      bad("speed_m_s", "is missing, and there is no profile");
    if (take.kind == take_kind::bow && !take.normal_force_N && take.normal_force_profile_N.empty())
      bad("normal_force_N", "is missing, and there is no profile");
    if (take.start_s && !take.speed_profile_m_s.empty())
      bad("start_s", "stands beside speed_profile_m_s, whose times count from the first sample");
    if (take.start_s.value_or(usual_release_s) >= duration_s) bad("start_s", "the take ends before; see [simulate] duration_s");
    if (take.kind == take_kind::pluck && take.start_s && !(*take.start_s > 0))
      bad("start_s", "the wire has to hold the string at the first sample");
  }
}

/// [simulate] with its defaults.
void set_recording(const rosin::rig& rig, simulation_plan& plan, rosin::problem_log& log) {
  const auto given = rig.simulate.value_or(rosin::simulate_section{});
  const auto pick = [&](const std::optional<double>& value, double usual, const char* key) {
    if (!value) plan.assumed.push_back(sentence(std::string{"simulate."} + key, usual, "none given"));
    return value.value_or(usual);
  };
  const double rate = pick(given.rate_Hz, usual_rate_Hz, "rate_Hz");
  plan.duration_s = pick(given.duration_s, plan.duration_s, "duration_s");
  plan.noise_N = pick(given.noise_N, plan.noise_N, "noise_N");
  if (!given.bits) plan.assumed.emplace_back("simulate.bits = 16, none given");
  plan.bits = given.bits.value_or(16);
  plan.settings.sample_rate_Hz = rate;
  plan.settings.oversampling = std::max(4, static_cast<int>(std::ceil(1.024e6 / rate)));
  plan.settings.mode_limit_Hz = std::max(250e3, rate / 2);
  if (rate != std::round(rate)) log.add(0, "simulate.rate_Hz", "must be a whole number for a WAV file, is " + digits(rate));
  if (2 * rig.string.fundamental_Hz >= rate)
    log.add(0, "simulate.rate_Hz",
            digits(rate) + " Hz cannot hold the fundamental of " + digits(rig.string.fundamental_Hz) + " Hz");
  if (!(plan.duration_s * rate >= 2 && plan.duration_s * rate <= most_samples))
    log.add(0, "simulate.duration_s",
            "a take must have 2 to " + digits(most_samples) + " samples, not " + digits(plan.duration_s * rate));
}

/// The string as it is: as declared, or within the tolerances of that.
std::optional<rosin::failure> set_string(const rosin::rig& rig, simulation_plan& plan) {
  const auto values = rosin::values_of(rig);
  const auto declared = nominal_string(rig, plan.assumed);
  if (!declared) return rosin::failure{declared.error()};
  plan.rig.string = *declared;
  if (rig.torsion) plan.rig.torsion = {rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q};
  else plan.notes.emplace_back("no [torsion]: the string does not turn");
  if (!rig.simulate || !rig.simulate->nominal_scatter) return std::nullopt;
  auto& s = plan.rig.string;
  const auto scatter = [&](double& value, const char* name, const std::optional<rosin::nominal>& from) {
    if (from && from->value > 0) value *= 1 + deviation(plan, name, from->sd / from->value);
  };
  scatter(s.length_m, "length_m", values.length_m);
  scatter(s.fundamental_Hz, "fundamental_Hz", values.fundamental_Hz);
  scatter(s.tension_N, "tension_N", rig.string.impedance_Ns_m ? values.impedance_Ns_m : values.tension_N);
  scatter(s.bending_stiffness_Nm2, "bending_stiffness_Nm2", values.bending_stiffness_Nm2);
  return std::nullopt;
}

void set_channels(const rosin::rig& rig, simulation_plan& plan) {
  const auto is_force = [](const auto& c) { return c.quantity == quantity::termination_force; };
  const auto force = std::find_if(rig.channels.begin(), rig.channels.end(), is_force);
  const double force_scale_N = force != rig.channels.end() ? force->per_full_scale.value_or(1) : 1;
  for (const auto& c : rig.channels) {  // noise is declared in newtons: other channels get the same share of full scale
    const double full = is_force(c) ? c.per_full_scale.value_or(1) : force_scale_N;
    const bool calibrated = c.per_full_scale.has_value() || c.quantity == quantity::termination_force;
    plan.channels.push_back(
        {c, calibrated ? 1 + deviation(plan, "gain " + c.name, gain_tolerance_of(c) / 2) : 1, plan.noise_N / full, {}});
  }
}

/// The place where the string is really touched: one error for each declared place.
double true_position(const rosin::rig& rig, const rosin::take& take, const simulation_plan& plan) {
  const double declared =
      take.position_profile.empty() ? rig.position_of(take).value_or(0.5) : take.position_profile.front().second;
  if (!rig.simulate || !rig.simulate->nominal_scatter) return declared;
  const double sd = rig.position_tolerance.value_or(rosin::detail::default_position_tolerance) / 2;
  return std::clamp(declared + deviation(plan, "position " + digits(declared), sd), declared / 2, (1 + declared) / 2);
}

true_take realise(const rosin::rig& rig, const rosin::take& take, simulation_plan& plan) {
  true_take out{take, take.kind == take_kind::quiet ? 0 : true_position(rig, take, plan), {}, {}, {}};
  rosin::gaussian_source start{seed_for(plan.seed, "start " + take.name)};
  const double later = start.uniform(0, std::min(2e-4, plan.duration_s / 10));
  const double begin = take.start_s.value_or(std::min(usual_release_s, plan.duration_s / 3) + later);
  if (take.kind == take_kind::pluck)
    out.pluck = {.position = out.position,
                 .force_N = *take.force_N * (1 + deviation(plan, "wire " + take.name, force_tolerance_of(take) / 2)),
                 .release_s = begin,
                 .duration_s = plan.duration_s};
  if (take.kind == take_kind::bow)
    static_cast<rosin::profiled_rod&>(out.rod) = {
        .steady = {.speed_m_s = take.speed_m_s.value_or(0), .normal_force_N = take.normal_force_N.value_or(0), .start_s = begin},
        .speed_m_s = take.speed_profile_m_s,
        .normal_force_N = take.normal_force_profile_N,
        .place = take.position_profile};
  for (auto& [t, x] : out.rod.place) x = std::clamp(x + out.position - take.position_profile.front().second, x / 2, (1 + x) / 2);
  return out;
}

}  // namespace

rosin::rod_state moving_rod::operator()(double t) const noexcept {
  const auto declared = rosin::profiled_rod::operator()(t);
  const double wave = std::sin(2 * std::numbers::pi * ripple_Hz * t);
  return {declared.velocity_m_s * (1 + speed_ripple * wave), declared.normal_force_N * (1 + force_ripple * wave)};
}

rosin::modal_rig stretched(rosin::modal_rig rig, double tension_drift) {
  rig.string.tension_N *= 1 + tension_drift;
  rig.string.fundamental_Hz *= std::sqrt(1 + tension_drift);
  return rig;
}

std::uint64_t seed_for(std::uint64_t seed, const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a, then the finaliser of splitmix64
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  std::uint64_t x = hash + (seed + 1) * 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

rosin::outcome<simulation_plan> plan_simulation(const rosin::rig& rig, std::optional<std::uint64_t> seed) {
  simulation_plan plan;
  rosin::problem_log log{rig.file};
  const bool named = rig.simulate && rig.simulate->seed;
  if (seed) plan.seed = *seed;
  else if (named) plan.seed = static_cast<std::uint64_t>(*rig.simulate->seed);
  else plan.assumed.emplace_back("simulate.seed = 1, none given");
  set_recording(rig, plan, log);
  refuse_unknown_physics(rig, log);
  refuse_channels(rig, log);
  refuse_takes(rig, plan.duration_s, log);
  if (!log.empty()) return log.to_failure();
  if (auto why = set_string(rig, plan)) return *why;
  auto ends = simulated_ends(rig, plan.rig.string.impedance_Ns_m(), plan.notes);
  if (!ends) return rosin::failure{ends.error()};
  plan.burden.string.ends = *std::move(ends);
  for (const auto& f : rosin::check_magnitudes(rig)) plan.notes.push_back(f.what + "; " + f.advice);
  auto friction = choose_friction(rig, plan.assumed, plan.notes);
  if (!friction) return rosin::failure{friction.error()};
  plan.friction = *std::move(friction);
  set_channels(rig, plan);
  for (const auto& take : rig.takes) plan.takes.push_back(realise(rig, take, plan));
  return plan;
}

}  // namespace tool
