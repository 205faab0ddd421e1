// SPDX-License-Identifier: MIT
//
// rosin sweep: a plane of strokes on the string of a rig file, each simulated with travelling waves and named. Every point is
// written as soon as it is known, so that a sweep can be stopped at any time and gone on with.
//
#include "commands.hpp"
#include "progress.hpp"
#include "rig_ends.hpp"
#include "rig_input.hpp"
#include "simulate_friction.hpp"
#include "sweep_plane.hpp"

#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/math/at_once.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/wave_stroke.hpp>

#include <atomic>
#include <charconv>
#include <iostream>
#include <memory>
#include <mutex>

namespace tool {

namespace {

struct sweep_options {
  std::string rig, plane = "schelleng", position, force, acceleration, out, svg, shard = "1/1";
  std::vector<std::string> merge;
  double speed_m_s = 0, rate_Hz = 256000, periods = 100;
  int threads = 0;
  bool force_overwrite = false, json = false;
};

/// What every point has in common.
struct sweep_setup {
  rosin::modal_rig rig{};
  std::array<rosin::modal_termination, 2> ends{};
  chosen_friction friction{};
  double position = 0, force_N = 0, speed_m_s = 0, duration_s = 0;
  rosin::wave_settings settings{};
  std::size_t shard = 0, shards = 1;
};

constexpr double sample_rate_Hz = 64000, rise_s = 0.02;

rosin::outcome<friction_law> law_at(const chosen_friction& f, double normal_N) {
  if (f.model != rosin::friction_model::thermal) return f.law;
  const auto strength = rosin::design_yield_curve(f.curve, f.heat.without_string(), normal_N);
  if (!strength) return rosin::failure{strength.error()};
  return friction_law{rosin::thermal_plastic<double>{*strength, f.heat}};
}

sweep_result impossible() { return {"impossible", 0, 0, 0}; }

/// One point. `design` is kept as long as the position stays.
class stroke_maker {
public:
  explicit stroke_maker(const sweep_setup& setup) : setup_{setup} {}

  [[nodiscard]] sweep_result operator()(double position, double force_N, double acceleration_m_s2) {
    if (position != position_) {
      design_ = std::make_unique<rosin::outcome<rosin::wave_design>>(
          rosin::design_wave(setup_.rig, position, setup_.settings, setup_.ends));
      position_ = position;
    }
    const auto law = law_at(setup_.friction, force_N);
    if (!*design_ || !law) return impossible();
    const rosin::profiled_rod rod{{}, {{0, 0}, {setup_.speed_m_s / acceleration_m_s2, setup_.speed_m_s}}, {{0, force_N}}};
    const auto take = std::visit(
        [&](const auto& l) {
          return rosin::simulate_wave_stroke(**design_, setup_.rig, l, rod, setup_.duration_s, setup_.settings);
        },
        *law);
    return take ? name(*take) : impossible();
  }

private:
  [[nodiscard]] sweep_result name(const rosin::modal_take& take) const {
    std::vector<double> slip(take.size());
    for (std::size_t n = 0; n < slip.size(); ++n)
      slip[n] = take.centre_velocity_m_s[n] + take.torsion_velocity_m_s[n] - take.rod_velocity_m_s[n];
    const auto found = rosin::classify(slip, take.rod_velocity_m_s, take.sample_rate_Hz, setup_.rig.string.fundamental_Hz);
    return {std::string{name_of(found.regime)}, found.transient_periods, found.slips_per_period, take.unconverged};
  }

  const sweep_setup& setup_;
  double position_ = -1;
  std::unique_ptr<rosin::outcome<rosin::wave_design>> design_;
};

rosin::outcome<sweep_plane> plan_axes(const sweep_options& given) {
  const bool guettler = given.plane == "guettler";
  const auto x = guettler ? parse_axis("acceleration_m_s2", given.acceleration.empty() ? "0.2:20:16" : given.acceleration)
                          : parse_axis("position", given.position.empty() ? "0.03:0.2:16" : given.position);
  const auto y = parse_axis("force_N", given.force.empty() ? "0.02:2:16" : given.force);
  if (!x || !y) return rosin::failure{x ? y.error() : x.error()};
  if (!guettler && !given.acceleration.empty()) return rosin::failure{"--acceleration: belongs to --plane guettler"};
  if (!guettler && std::max(x->first, x->last) >= 1) return rosin::failure{"--position: must lie below 1"};
  return sweep_plane{*x, *y, {}, {}};
}

std::optional<rosin::failure> read_shard(const std::string& text, sweep_setup& setup) {
  const auto whole = [](std::string_view digits) {
    std::size_t out = 0;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), out);
    return end.ec == std::errc{} && end.ptr == digits.data() + digits.size() ? out : 0;
  };
  const auto slash = std::min(text.find('/'), text.size() - 1);
  const std::size_t k = whole(std::string_view{text}.substr(0, slash)), n = whole(std::string_view{text}.substr(slash + 1));
  if (k < 1 || n < 1 || k > n) return rosin::failure{"--shard: " + text + " is not K/N with 1 <= K <= N"};
  setup.shard = k - 1, setup.shards = n;
  return std::nullopt;
}

/// The string and its bow from the rig file; `--` options win over the first bowed take.
std::optional<rosin::failure> read_setup(const rosin::rig& rig, const sweep_options& given, sweep_setup& setup,
                                         std::vector<std::string>& notes) {
  const auto string = nominal_string(rig, notes);
  if (!string) return rosin::failure{string.error()};
  setup.rig.string = *string;
  auto ends = simulated_ends(rig, string->impedance_Ns_m(), notes);
  if (!ends) return rosin::failure{ends.error()};
  setup.ends = *std::move(ends);
  if (rig.torsion) setup.rig.torsion = {rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q};
  auto friction = choose_friction(rig, notes, notes);
  if (!friction) return rosin::failure{friction.error()};
  setup.friction = *std::move(friction);
  setup.position = 0.12, setup.speed_m_s = given.speed_m_s;
  for (const auto& take : rig.takes)
    if (take.kind == rosin::take_kind::bow) {
      setup.position = rig.position_of(take).value_or(setup.position);
      if (!(setup.speed_m_s > 0)) setup.speed_m_s = take.speed_m_s.value_or(0);
      break;
    }
  if (!(setup.speed_m_s > 0)) setup.speed_m_s = 0.2;
  if (given.plane == "guettler" && !given.position.empty()) {
    const auto one = parse_axis("position", given.position + ":" + given.position + ":1");
    if (!one || !(one->first < 1)) return rosin::failure{"--position: one number between 0 and 1 in a plane after Guettler"};
    setup.position = one->first;
  }
  const double steps = given.rate_Hz / sample_rate_Hz;
  if (!(steps >= 1 && steps <= 64 && steps == std::floor(steps))) return rosin::failure{"--rate: must be 64000 Hz times 1 to 64"};
  if (!(given.periods >= 20 && given.periods <= 1e5)) return rosin::failure{"--periods: 20 to 100000"};
  setup.settings = {.sample_rate_Hz = sample_rate_Hz, .oversampling = static_cast<int>(steps)};
  setup.duration_s = given.periods / setup.rig.string.fundamental_Hz;
  return read_shard(given.shard, setup);
}

std::string conditions(const sweep_options& given, const sweep_setup& setup) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  const auto& s = setup.rig.string;
  out << "plane " << given.plane << ", position " << (given.plane == "guettler" ? rosin::number_text(setup.position, "%f") : "x")
      << ", speed " << setup.speed_m_s << " m/s, " << given.periods << " periods at " << given.rate_Hz << " Hz, string "
      << s.fundamental_Hz << " Hz " << s.length_m << " m " << s.tension_N << " N " << s.bending_stiffness_Nm2 << " N m2, loss "
      << s.loss.quality << " " << s.loss.air_sqrt_Hz << " " << s.loss.internal_s << ", torsion " << setup.rig.torsion.speed_ratio
      << " " << setup.rig.torsion.impedance_ratio << " " << setup.rig.torsion.quality << ", friction "
      << setup.friction.to_json().dump();
  for (const auto& end : setup.ends) {
    out << ", end";
    for (const auto& m : end.modes) out << " " << m.frequency_Hz << " Hz " << m.q << " " << m.per_mass_per_s << " per s";
  }
  return out.str();
}

/// The points of this shard that are not known yet, those of one position together.
std::vector<std::size_t> pending(const sweep_plane& plane, const sweep_setup& setup) {
  std::vector<std::size_t> out;
  for (std::size_t ix = 0; ix < plane.x.count; ++ix)
    for (std::size_t iy = 0; iy < plane.y.count; ++iy) {
      const auto index = iy * plane.x.count + ix;
      if (index % setup.shards == setup.shard && plane.points.count(index) == 0) out.push_back(index);
    }
  return out;
}

/// All pending points on all cores; each goes to the file at once.
void fill(sweep_plane& plane, const sweep_setup& setup, const sweep_options& given, std::ostream& file) {
  const auto todo = pending(plane, setup);
  progress bar{"sweeping", todo.size()};
  std::atomic<std::size_t> next{0};
  std::mutex one_at_a_time;
  const std::size_t threads = rosin::threads_for(given.threads);
  rosin::at_once(threads, given.threads, [&](std::size_t) {
    stroke_maker make{setup};
    for (std::size_t n = next++; n < todo.size(); n = next++) {
      const double x = plane.x.at(todo[n] % plane.x.count), force_N = plane.y.at(todo[n] / plane.x.count);
      const bool guettler = given.plane == "guettler";
      const auto point = make(guettler ? setup.position : x, force_N, guettler ? x : setup.speed_m_s / rise_s);
      const std::lock_guard lock{one_at_a_time};
      plane.points[todo[n]] = point;
      file << plane.line(todo[n], point) << std::flush;
      bar.step();
    }
  });
}

void print_summary(const sweep_options& given, const sweep_plane& plane, const std::vector<std::string>& notes) {
  std::map<std::string, std::size_t> counts;
  std::size_t unconverged = 0;
  for (const auto& [index, point] : plane.points) ++counts[point.regime], unconverged += point.unconverged;
  if (given.json)
    return print({{"schema", 1},
                  {"out", given.out},
                  {"points", plane.points.size()},
                  {"of", plane.size()},
                  {"regimes", counts},
                  {"unconverged", unconverged},
                  {"notes", notes}});
  std::cout << given.out << ": " << plane.points.size() << " of " << plane.size() << " points\n";
  for (const auto& [regime, count] : counts) std::cout << "  " << regime << ": " << count << '\n';
  if (unconverged > 0)
    std::cout << "warning: the contact's equation was not solved to tolerance in " << unconverged << " steps\n";
  for (const auto& line : notes) std::cout << "note: " << line << '\n';
}

std::optional<rosin::failure> write_text(const std::string& path, const std::string& text) {
  return rosin::write_file(path, rosin::overwrite::allow, [&](std::ostream& out) { out << text; });
}

exit_code finish(const sweep_options& given, const sweep_plane& plane, const std::vector<std::string>& notes) {
  if (!given.svg.empty())
    if (const auto why = write_text(given.svg, plane_svg(plane))) return fail(why->message, given.json);
  print_summary(given, plane, notes);
  return exit_code::ok;
}

exit_code run_merge(const sweep_options& given) {
  std::error_code ignored;
  if (std::filesystem::exists(given.out, ignored) && !given.force_overwrite)
    return fail(given.out + ": exists already; --force overwrites it", given.json);
  const auto plane = merge_planes(given.merge);
  if (!plane) return fail(plane.error(), given.json);
  if (const auto why = write_text(given.out, plane_text(*plane))) return fail(why->message, given.json);
  return finish(given, *plane, {});
}

exit_code run(const sweep_options& given) {
  if (!given.svg.empty())
    if (const auto why = may_write_file(given.svg, true)) return fail(why->message, given.json);
  if (!given.merge.empty()) return run_merge(given);
  if (given.rig.empty()) return fail("rosin sweep: RIG is missing", given.json);
  const auto rig = rosin::load_rig(given.rig, rosin::take_files::to_be_made);
  if (!rig) return fail(rig.error(), given.json);
  sweep_setup setup;
  std::vector<std::string> notes;
  auto plane = plan_axes(given);
  if (!plane) return fail(plane.error(), given.json);
  if (const auto why = read_setup(*rig, given, setup, notes)) return fail(why->message, given.json);
  plane->conditions = conditions(given, setup);
  std::error_code ignored;
  const bool there = std::filesystem::exists(given.out, ignored);
  if (given.out == "-" || (there && !std::filesystem::is_regular_file(given.out, ignored)))
    return fail(given.out + ": is no file; a sweep is gone on with from its file", given.json);
  if (const auto why = rosin::cannot_write(given.out, rosin::overwrite::allow)) return fail(why->message, given.json);
  if (there && !given.force_overwrite) {
    const auto before = read_plane(given.out);
    if (!before) return fail(before.error() + "; --force overwrites it", given.json);
    if (before->header() != plane->header()) return fail(given.out + ": holds another plane; --force overwrites it", given.json);
    plane->points = before->points;
  }
  if (const auto why = write_text(given.out, plane_text(*plane))) return fail(why->message, given.json);
  {
    errno = 0;
    std::ofstream file{given.out, std::ios::binary | std::ios::app};
    fill(*plane, setup, given, file);
    if (!file) return fail(given.out + ": cannot be written" + rosin::detail::system_reason(), given.json);
  }
  if (const auto why = write_text(given.out, plane_text(*plane))) return fail(why->message, given.json);  // now in order
  return finish(given, *plane, notes);
}

}  // namespace

void add_sweep(CLI::App& app, exit_code& result) {
  auto given = std::make_shared<sweep_options>();
  CLI::App* command = app.add_subcommand("sweep", "Bow the string of a rig at every point of a plane, and name what it does");
  command->add_option("RIG", given->rig, "Rig file, or the folder that holds it; recordings are not needed");
  command->add_option("--plane", given->plane, "schelleng (force against position) or guettler (force against acceleration)")
      ->check(CLI::IsMember({"schelleng", "guettler"}))
      ->capture_default_str();
  command->add_option("--position", given->position,
                      "FIRST:LAST:COUNT, in steps of one ratio; one number in a plane after Guettler");
  command->add_option("--force-range", given->force, "Normal force in N, FIRST:LAST:COUNT");
  command->add_option("--acceleration", given->acceleration, "In m/s2, FIRST:LAST:COUNT");
  command->add_option("--speed", given->speed_m_s, "Final speed of the rod in m/s; else that of the first bowed take")
      ->check(positive());
  command->add_option("--periods", given->periods, "Length of each stroke in periods of the string")->capture_default_str();
  command->add_option("--rate", given->rate_Hz, "Steps of the contact per second")->capture_default_str();
  command->add_option("--threads", given->threads, "0: all cores")
      ->check(between(0, 1024, "INT").description(""))
      ->capture_default_str();
  command->add_option("--shard", given->shard, "K/N: only every N-th point, from the K-th on")->capture_default_str();
  command->add_option("--merge", given->merge, "Files of one plane to be joined into --out; nothing is simulated")
      ->type_name("FILE");
  command->add_option("--out", given->out, "CSV file, gone on with if it is there")->required()->type_name("FILE");
  command->add_option("--svg", given->svg, "Draw the plane")->type_name("FILE");
  add_force_option(*command, given->force_overwrite);
  add_json_option(*command, given->json);
  command->callback([given, &result] { result = run(*given); });
}

}  // namespace tool
