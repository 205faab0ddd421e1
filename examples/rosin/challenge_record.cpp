// SPDX-License-Identifier: MIT
//
// The takes of a challenge, played and written: three plucks, two strokes, and a rig file that owns up to nothing.
//
#include "challenge_rig.hpp"
#include "digits.hpp"
#include "rig_leftovers.hpp"

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/report/csv.hpp>
#include <rosin/simulate/modal_decimator.hpp>

namespace tool {

namespace {

namespace fs = std::filesystem;

constexpr int oversampling = 16;

/// Speed and normal force, each with its ripple, from some steps before the take's first sample on.
struct unsteady_rod {
  rosin::steady_rod steady;
  double ripple_Hz = 0, speed = 0, force = 0, lead_s = 0;
  rosin::rod_state operator()(double t) const noexcept {
    const auto s = steady(t - lead_s);
    const double wave = std::sin(2 * 3.14159265358979323846 * ripple_Hz * (t - lead_s));
    return {s.velocity_m_s * (1 + speed * wave), s.normal_force_N * (1 + force * wave)};
  }
};

struct played {
  std::string name;
  std::array<std::vector<double>, 2> force_N;                     ///< as the converters get them
  std::vector<double> contact_force_N{}, contact_velocity_m_s{};  ///< of a stroke, through the same low-pass
};

class player {
public:
  explicit player(const challenge_rig& rig)
      : rig_{rig}, decimate_{settings_.low_pass(), step_, oversampling}, lead_s_{static_cast<double>(decimate_.reach()) * step_} {
  }

  [[nodiscard]] played pluck(std::size_t i) const {
    const auto& base = rig_.base.plucks[i];
    const rosin::burdened_pluck wire{base.position, base.force_N, base.release_s + lead_s_, rig_.release_duration_s,
                                     rig_.pluck_width_m};
    const double lasts_s = 0.14 + 2 * lead_s_;
    if (rig_.detuning == 0)
      return finish(named(i), rosin::step_pluck(rig_.base.rig, rig_.burden, wire, lasts_s, limit_Hz, step_));
    auto across = rig_.base.rig;
    across.string.fundamental_Hz *= 1 + rig_.detuning;
    across.string.tension_N *= std::pow(1 + rig_.detuning, 2);  // the same string with other supports: only its pitch differs
    auto one = wire, other = wire;
    one.force_N *= std::cos(rig_.pluck_angle_rad), other.force_N *= std::sin(rig_.pluck_angle_rad);
    auto planes = rosin::step_planes(rig_.base.rig, one, across, other, rig_.burden, lasts_s, limit_Hz, step_);
    mix(planes[0], planes[1]);
    return finish(named(i), std::move(planes[0]));
  }

  [[nodiscard]] played stroke(std::size_t i) const {
    const unsteady_rod motion{rig_.base.strokes[i], rig_.ripple_Hz, rig_.speed_ripple, rig_.force_ripple, lead_s_};
    const auto run = [&](const auto& law) {
      return rosin::step_stroke(rig_.bowed, rig_.burden, law, motion, rig_.rod, rig_.base.position, rig_.contact_width_m,
                                rig_.base.stroke_s + 2 * lead_s_, limit_Hz, step_, 0, rig_.contact_places);
    };
    auto steps = rig_.bristles_N_m > 0 ? run(bristles(i))
                 : rig_.creeps         ? run(rosin::creep{rig_.base.steady_friction, *rig_.creeps})
                                       : std::visit(run, rig_.base.law);
    if (rig_.detuning != 0) mix(steps, {});
    auto force = decimate_.lines(steps.force_N), velocity = decimate_.points(steps.centre_m_s),
         rate = decimate_.slopes(steps.force_N);
    for (std::size_t n = 0; n < velocity.size(); ++n) velocity[n] += steps.centre_left_out_m_N * rate[n];
    auto out = finish("bow-" + std::to_string(i + 1), std::move(steps));
    out.contact_force_N = std::move(force), out.contact_velocity_m_s = std::move(velocity);
    return out;
  }

private:
  [[nodiscard]] static std::string named(std::size_t i) { return "pluck-" + std::to_string(i + 1); }
  [[nodiscard]] rosin::elasto_plastic<rosin::two_exponential_curve<double>> bristles(std::size_t i) const {
    const double normal = rig_.base.strokes[i].normal_force_N, stiffness = rig_.bristles_N_m;
    return rosin::elasto_plastic<rosin::two_exponential_curve<double>>{rig_.base.steady_friction,
                                                                       {.stiffness_1_m = stiffness / normal,
                                                                        .damping_Ns_m = 0.02 * std::sqrt(stiffness * 1e-4),
                                                                        .kinetic = rig_.base.steady_friction.c}};
  }
  void mix(rosin::burdened_steps& along, const rosin::burdened_steps& across) const {
    for (std::size_t e = 0; e < 2; ++e)
      for (std::size_t n = 0; n < along.end_N[e].size(); ++n)
        along.end_N[e][n] = std::cos(rig_.sensor_angle_rad) * along.end_N[e][n] +
                            (across.end_N[e].empty() ? 0 : std::sin(rig_.sensor_angle_rad) * across.end_N[e][n]);
  }
  [[nodiscard]] played finish(std::string name, rosin::burdened_steps steps) const {
    rosin::disturb(steps.end_N, rig_.faults, step_, lead_s_);
    return {std::move(name), {decimate_.points(steps.end_N[0]), decimate_.points(steps.end_N[1])}};
  }

  static constexpr double step_ = 1.0 / 128000 / oversampling, limit_Hz = 250e3;
  const challenge_rig& rig_;
  rosin::modal_settings settings_{};
  rosin::modal_decimator decimate_;
  double lead_s_;
};

rosin::table motion_of(const played& take, const std::string& rig) {
  rosin::table out{{"truth of take " + take.name + ", " + rig}, {}};
  std::vector<double> time_s(take.contact_force_N.size());
  for (std::size_t n = 0; n < time_s.size(); ++n) time_s[n] = static_cast<double>(n) / 128000;
  out.add("time_s", std::move(time_s)), out.add("force_N", take.contact_force_N),
      out.add("velocity_m_s", take.contact_velocity_m_s);
  return out;
}

std::string rig_text(const challenge_rig& r, const std::array<double, 2>& full_scale_N) {
  const auto& d = r.base.declared;
  std::string out = "schema = 1\ntitle = \"" + r.name + "\"\n\n[string]\nlength_m = " + in_digits(d.string.length_m, "%.5f") +
                    "\ntension_N = " + in_digits(d.string.tension_N, "%.2f") +
                    "\nfundamental_Hz = " + in_digits(d.string.fundamental_Hz, "%.2f") + "\n";
  if (r.declares_stiffness) out += "bending_stiffness_Nm2 = " + in_digits(d.string.bending_stiffness_Nm2, "%.3e") + "\n";
  out += "\n[channels]\nnear = { index = 0, newtons_per_full_scale = " + in_digits(full_scale_N[0], "%.6f") +
         ", gain_tolerance = 0.05 }\nfar = { index = 1, newtons_per_full_scale = " + in_digits(full_scale_N[1], "%.6f") +
         ", gain_tolerance = 0.05 }\n\n[contact]\nposition = " + in_digits(d.position, "%.4f") + "\n";
  if (r.declares_torsion)
    out += "\n[torsion]\nspeed_ratio = " + in_digits(d.torsion.speed_ratio, "%.3f") +
           "\nimpedance_ratio = " + in_digits(d.torsion.impedance_ratio, "%.3f") +
           "\nq = " + in_digits(d.torsion.quality, "%.1f") + "\n";
  out += std::string{"\n[model]\nphysics = ["} + (r.declares_stiffness ? "\"bending-stiffness\"" : "") +
         (r.declares_stiffness && r.declares_torsion ? ", " : "") + (r.declares_torsion ? "\"torsion\"" : "") +
         "]\nfriction = \"velocity-curve\"\n";
  for (std::size_t i = 0; i < r.base.plucks.size(); ++i) {
    const std::string name = "pluck-" + std::to_string(i + 1);
    out += "\n[[take]]\nname = \"" + name + "\"\nkind = \"pluck\"\nfile = \"" + name +
           ".wav\"\nforce_N = " + in_digits(d.pluck_N[i], "%.3f") + "\nforce_tolerance = 0.03\n";
  }
  for (std::size_t i = 0; i < r.base.strokes.size(); ++i) {
    const std::string name = "bow-" + std::to_string(i + 1);
    out += "\n[[take]]\nname = \"" + name + "\"\nkind = \"bow\"\nfile = \"" + name +
           ".wav\"\nspeed_m_s = " + in_digits(r.base.strokes[i].speed_m_s, "%.5f") +
           "\nnormal_force_N = " + in_digits(r.base.strokes[i].normal_force_N, "%.5f") + "\n";
  }
  return out;
}

}  // namespace

std::filesystem::path true_forces(const fs::path& truth, const std::string& rig, const std::string& take) {
  return truth / (rig + "." + take + ".csv");
}

std::optional<rosin::failure> write_challenge(const challenge_rig& rig, const fs::path& folder, bool force,
                                              const fs::path& truth) {
  const player play{rig};
  std::vector<played> takes;
  for (std::size_t i = 0; i < rig.base.plucks.size(); ++i) takes.push_back(play.pluck(i));
  for (std::size_t i = 0; i < rig.base.strokes.size(); ++i) takes.push_back(play.stroke(i));
  std::array<double, 2> full_scale{};
  for (std::size_t c = 0; c < 2; ++c) {
    for (const auto& take : takes)
      for (const double f : take.force_N[c]) full_scale[c] = std::max(full_scale[c], std::abs(rig.converters[c].gain * f));
    full_scale[c] /= rig.base.peak_share;
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return rosin::failure{folder.string() + ": cannot be made: " + error.message()};
  const auto lock = lock_folder(folder.string());
  if (!lock) return rosin::failure{lock.error()};
  if (auto why = recording_in(folder.string())) return why;
  const auto existing = force ? rosin::overwrite::allow : rosin::overwrite::refuse;
  std::uint64_t seed = rig.base.seed * 1000;
  for (const auto& take : takes) {
    rosin::recording out{.file = take.name, .sample_rate_Hz = 128000, .bits = rig.base.bits};
    for (std::size_t c = 0; c < 2; ++c) {
      auto with = rig.converters[c];
      with.newtons_per_full_scale = full_scale[c], with.bits = rig.base.bits;
      const auto codes = rosin::convert(take.force_N[c], 128000, with, seed++);
      auto& column = out.channels.emplace_back(codes.size());
      for (std::size_t n = 0; n < column.size(); ++n) column[n] = codes.share(n);
    }
    if (const auto& [pluck, first, count] = rig.lost; count > 0 && take.name == "pluck-" + std::to_string(pluck + 1))
      for (auto& column : out.channels)
        column.erase(column.begin() + static_cast<std::ptrdiff_t>(first),
                     column.begin() + static_cast<std::ptrdiff_t>(first + count));
    if (auto why = rosin::write_audio((folder / (take.name + ".wav")).string(), out, existing)) return why;
    if (truth.empty() || take.contact_force_N.empty()) continue;
    const auto true_motion = motion_of(take, rig.name);
    if (auto why = rosin::save_csv(true_forces(truth, rig.name, take.name).string(), true_motion, existing)) return why;
  }
  const auto text = rig_text(rig, full_scale);
  return rosin::write_file((folder / "rig.toml").string(), existing, [&](std::ostream& o) { o << text; });
}

}  // namespace tool
