// SPDX-License-Identifier: MIT
//
// Figs. 2 to 8 of Woodhouse, Schumacher & Garoff (2000), redone from simulated strings: plucked, calibrated, bowed, recorded with
// 16 bits and noise, reconstructed. Writes one CSV and one gnuplot script a figure into a folder (argument; ./figures), to be
// drawn there by `gnuplot *.gp`, and prints Delta of Eq. (12) where the paper gives it. docs/explain/papers_figures.md shows the
// result.
//
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <rosin/calibrate/calibration.hpp>
#include <rosin/friction/slip_loops.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/periodic_reconstruction.hpp>
#include <rosin/report/csv.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>
#include <rosin/simulate/modal_stroke.hpp>
#include <rosin/torsion/torsion_fit.hpp>

namespace {

using column = std::vector<double>;
constexpr double rate_Hz = 128e3, not_known = std::numeric_limits<double>::quiet_NaN();
constexpr rosin::band limits{20e3, 40e3};

// ---- the rig
// -------------------------------------------------------------------------------------------------------------------

rosin::modal_rig rig(double torsional_speed) {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 659.69,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = 1000}},
          .torsion = {.speed_ratio = torsional_speed, .impedance_ratio = 3.5, .quality = 15}};
}

/// Thermal friction that shows the steady-sliding curve of Smith and Woodhouse at this normal force.
rosin::thermal_plastic<double> rosin_layer(double normal_N) {
  const rosin::contact_heat_parameters<double> heat{};
  return {*rosin::design_yield_curve(rosin::two_exponential_curve<double>{}, heat.without_string(), normal_N), heat};
}

struct stroke {
  double position, speed_m_s, normal_N;
  rosin::modal_take truth;

  stroke(double torsional_speed, double beta, double speed, double normal)
      : position{beta}, speed_m_s{speed}, normal_N{normal}, truth{*rosin::simulate_stroke(
                                                                rig(torsional_speed), rosin_layer(normal),
                                                                rosin::steady_rod{.speed_m_s = speed, .normal_force_N = normal},
                                                                {.position = beta, .duration_s = 0.26}, {.oversampling = 4})} {}
};

/// What two converters of 16 bits with 0.3 mN of noise make of the forces on the ends; their gains are not known.
std::array<column, 2> recorded(const rosin::modal_take& take, std::uint64_t seed) {
  const auto channel = [&](const column& force, double gain, std::uint64_t s) {
    return rosin::convert(force, rate_Hz, {.gain = gain, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .bits = 16}, s)
        .newtons();
  };
  return {channel(take.force_near_N, 1.021, seed), channel(take.force_far_N, 0.985, seed + 1)};
}

// ---- from the recording to the bow
// -----------------------------------------------------------------------------------------------

/// Both versions and their means, NaN where unknown.
struct bow {
  column near_N, far_N, force_N, near_m_s, far_m_s, velocity_m_s;
};

template <class Physics = rosin::full_physics>
bow reconstruct(const rosin::bow_point& at, const column& near, const column& far) {
  auto m = rosin::reconstructor<double, Physics>(at, limits, rate_Hz)(near, far);
  bow b;
  for (std::size_t i = 0; i < near.size(); ++i) b.force_N.push_back(m.force_N(i)), b.velocity_m_s.push_back(m.velocity_m_s(i));
  b.near_N = std::move(m.force_near_N), b.far_N = std::move(m.force_far_N);
  b.near_m_s = std::move(m.velocity_near_m_s), b.far_m_s = std::move(m.velocity_far_m_s);
  return b;
}

/// The same low-pass as the reconstruction's.
column limited(const column& x) {
  rosin::block_convolver<double> low_pass(
      1, std::vector<rosin::fir>{rosin::shortest_fir([](double) { return 1.0; }, limits, rate_Hz, -400, 400, 1e-7)});
  column y(x.size());
  low_pass.process(std::array<std::span<const double>, 1>{x}, std::array<std::span<double>, 1>{y});
  const auto known = low_pass.valid(x.size());
  for (std::size_t i = 0; i < y.size(); ++i)
    if (i < known.begin || i >= known.end) y[i] = not_known;
  return y;
}

column part(const column& x, double from_s, double to_s) {
  const auto at = [&](double t) { return x.begin() + static_cast<std::ptrdiff_t>(t * rate_Hz); };
  return {at(from_s), at(to_s)};
}

/// Delta of Eq. (12) over 0.15 s of steady motion.
double delta(const column& a, const column& b) { return rosin::consistency_delta(part(a, 0.1, 0.25), part(b, 0.1, 0.25)); }

// ---- pictures
// --------------------------------------------------------------------------------------------------------------------

struct curve {
  std::string column, style, title, x{};  // x: where it is not the panel's
};

struct panel {
  std::string title, x, x_label, y_label;
  std::vector<curve> curves;
};

constexpr const char *blue = "lc '#1b6ca8'", *orange = "lc '#d9731a' lw 1", *black = "lc '#222222' lw 1 dt 2",
                     *red = "lc '#8c1d40'";
constexpr const char *pale = "lc '#8fc1e3' lw 3", *heavy = "lc '#8c1d40' lw 5";

std::string broken_where_empty(const std::string& place) { return "valid(" + place + ") ? column(" + place + ") : NaN"; }

/// figN.csv and figN.gp in the folder. Panels are laid out in rows.
void write(const std::filesystem::path& folder, int number, const rosin::table& data, const std::vector<panel>& panels,
           int columns) {
  const std::string name = "fig" + std::to_string(number);
  std::ofstream csv(folder / (name + ".csv")), gp(folder / (name + ".gp"));
  rosin::write_csv(csv, data);
  const auto rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  gp << "set terminal svg size 940," << 60 + 220 * rows << " font 'sans-serif,12' background 'white'\nset output '" << name
     << ".svg'\n"
     << "set datafile separator ','\nset datafile commentschars '#'\nset border 3 lc '#555555'\nset tics nomirror\n"
     << "set grid lc '#e4e4e4'\nset style data lines\nset format y '%g'\nset autoscale xfix\n"
     << "set key at graph 1, graph 1.13 right horizontal samplen 1.5 font ',11' noautotitle\n"
     << "set multiplot layout " << rows << "," << columns << " margins 0.075,0.985," << 0.19 / rows << "," << 1 - 0.12 / rows
     << " spacing 0.085," << 0.32 / rows << "\n";
  const auto place = [&](const std::string& wanted) {
    for (std::size_t c = 0; c < data.columns.size(); ++c)
      if (data.columns[c].name == wanted) return std::to_string(c + 1);
    return std::string{"no_such_column"};
  };
  for (const panel& p : panels) {
    gp << "set label 1 '" << p.title << "' at graph 0, graph 1.08\nset xlabel '" << p.x_label << "' offset 0,0.4\nset ylabel '"
       << p.y_label << "' offset 1,0\nplot ";
    for (std::size_t c = 0; c < p.curves.size(); ++c)
      gp << (c > 0 ? ", " : "") << "'" << name << ".csv' every ::1 using " << place(p.curves[c].x.empty() ? p.x : p.curves[c].x)
         << ":(" << broken_where_empty(place(p.curves[c].column)) << ") " << p.curves[c].style << " title '" << p.curves[c].title
         << "'";
    gp << "\n";
  }
  gp << "unset multiplot\n";
}

/// A table with a time axis in ms, cut to a window.
struct window {
  double from_s, to_s;
  rosin::table data{};

  window(double from, double to, const char* what) : from_s{from}, to_s{to} {
    data.comments.emplace_back(what);
    column ms;
    for (std::size_t i = 0; i < part_size(); ++i) ms.push_back(1e3 * static_cast<double>(i) / rate_Hz);
    data.add("time_ms", ms, 7);
  }
  [[nodiscard]] std::size_t part_size() const {
    return static_cast<std::size_t>(to_s * rate_Hz) - static_cast<std::size_t>(from_s * rate_Hz);
  }
  void add(const char* name, const column& x) { data.add(name, part(x, from_s, to_s), 5); }
};

/// `level` where the string slips.
column while_slipping(const column& relative, double speed, double level) {
  column out(relative.size(), not_known);
  for (const auto& s : rosin::find_phases(relative, speed, {.least = 1.2, .most = 1.2}).slips)
    for (std::size_t i = s.begin; i < s.end; ++i) out[i] = level;
  return out;
}

column less(column x, double level) {
  for (double& v : x) v -= level;
  return x;
}

// ---- the figures
// -----------------------------------------------------------------------------------------------------------------

/// Fig. 2: a pluck and the string that fits it. Returns the calibration.
rosin::calibration pluck(const std::filesystem::path& folder, double position) {
  const auto true_rig = rig(7);
  const rosin::modal_pluck wire{.position = position, .force_N = 1.012, .release_s = 0.00413};
  const auto force = recorded(*rosin::simulate_pluck(true_rig, wire), 1);
  const auto fit = rosin::fit_plucks({{"pluck", rate_Hz, force, 1.0, 0.03, position + 0.002}}, {.fundamental_Hz = 660.3});
  const auto& v = fit->value;
  using layout = rosin::pluck_layout;
  auto found = true_rig;
  found.string.fundamental_Hz = v[layout::fundamental], found.string.loss = fit->string().loss;
  found.string.bending_stiffness_Nm2 =
      v[layout::inharmonicity] * found.string.tension_N * std::pow(found.string.length_m / std::numbers::pi, 2);
  const auto c = rosin::calibration_from(*fit, position, true_rig.string.impedance_Ns_m(), 0.01);
  const auto theory = *rosin::simulate_pluck(found, {.position = c.position,
                                                     .force_N = std::exp(v[fit->layout.at(0, layout::strength)]),
                                                     .release_s = fit->layout.release_s(v, 0)});
  std::printf("Fig. 2: B = %.4g N m^2 (true 4.7e-05, paper 4.7e-5), contact at %.5f, residual %.2g %% of the signal\n",
              found.string.bending_stiffness_Nm2, c.position, 100 * fit->residual_ratio[0]);
  window w(0.0037, 0.0080, "Fig. 2: forces on the ends after a pluck, recorded and fitted");
  const auto scaled = [](column x, double gain) {
    for (double& f : x) f *= gain;
    return x;
  };
  w.add("near_N", force[0]), w.add("near_fitted_N", scaled(theory.force_near_N, c.gain[0]));
  w.add("far_N", force[1]), w.add("far_fitted_N", scaled(theory.force_far_N, c.gain[1]));
  write(folder, 2, w.data,
        {{"(a) end nearer to the pluck",
          "time_ms",
          "time (ms)",
          "force (N)",
          {{"near_N", pale, "recorded"}, {"near_fitted_N", black, "fitted"}}},
         {"(b) the other end",
          "time_ms",
          "time (ms)",
          "force (N)",
          {{"far_N", pale, "recorded"}, {"far_fitted_N", black, "fitted"}}}},
        1);
  return c;
}

std::vector<panel> four_panels(const std::string& second) {
  return {{"(a) forces on the ends",
           "time_ms",
           "time (ms)",
           "force (N)",
           {{"end_near_N", blue, "near"}, {"end_far_N", orange, "far"}}},
          {"(b) velocity, Eqs. (1)",
           "time_ms",
           "time (ms)",
           "velocity (m/s)",
           {{"near_m_s", pale, "near"}, {"far_m_s", orange, "far"}, {"true_m_s", black, second}}},
          {"(c) friction, Eqs. (3)",
           "time_ms",
           "time (ms)",
           "force (N)",
           {{"near_N", pale, "near"}, {"far_N", orange, "far"}, {"true_N", black, second}, {"slips_N", heavy, ""}}},
          {"(d) force against velocity", "velocity_m_s", "velocity (m/s)", "force (N)", {{"force_N", blue, "reconstructed"}}}};
}

window stretch(double from, double to, const char* what, const column& near, const column& far, const bow& b, double speed) {
  window w(from, to, what);
  w.add("end_near_N", near), w.add("end_far_N", far);
  w.add("near_m_s", b.near_m_s), w.add("far_m_s", b.far_m_s), w.add("velocity_m_s", b.velocity_m_s);
  w.add("near_N", b.near_N), w.add("far_N", b.far_N), w.add("force_N", b.force_N);
  w.add("slips_N", while_slipping(less(b.velocity_m_s, speed), speed, 0.36));
  return w;
}

/// One period at the samples of the take.
column unrolled(const column& one, const rosin::periodic_part& source, std::size_t samples) {
  column out(samples, not_known);
  const auto N = static_cast<double>(one.size());
  for (std::size_t i = source.begin; i < std::min(samples, source.end); ++i) {
    double sum = 0;
    for (std::size_t n = 0; n < one.size(); ++n) {  // Dirichlet's kernel: a trigonometric polynomial through the samples
      const double u = std::numbers::pi * (static_cast<double>(i - source.begin) / source.period - static_cast<double>(n) / N);
      const double s = std::sin(u);
      sum += one[n] * (std::abs(s) < 1e-12 ? 1.0 : std::sin(N * u) / N / (one.size() % 2 == 0 ? std::tan(u) : s));
    }
    out[i] = sum;
  }
  return out;
}

/// Figs. 3 to 5: recorded, calibrated by the pluck, tuned.
void laboratory(const std::filesystem::path& folder, const stroke& s, const rosin::calibration& plucked) {
  auto force = recorded(s.truth, 3);
  const auto c = rosin::fine_tune(plucked, part(force[0], 0.1, 0.18), part(force[1], 0.1, 0.18), limits, rate_Hz).tuned;
  for (std::size_t e = 0; e < 2; ++e)
    for (double& f : force[e]) f /= c.gain[e];
  const bow b = reconstruct(c.at, force[0], force[1]), paper = reconstruct<rosin::paper_physics>(c.at, force[0], force[1]);
  std::printf("Fig. 3: two versions of the force: Delta %.4f, with the paper's filters %.4f (paper 0.20)\n",
              delta(b.near_N, b.far_N), delta(paper.near_N, paper.far_N));
  auto panels = four_panels("");
  panels[1].curves.pop_back(), panels[2].curves.erase(panels[2].curves.begin() + 2);
  write(folder, 3, stretch(0.2005, 0.2047, "Fig. 3: recorded", force[0], force[1], b, s.speed_m_s).data, panels, 2);
  panels[1].title = "(a) velocity at the bow", panels[2].title = "(b) friction force";
  write(folder, 4, stretch(0.010, 0.021, "Fig. 4: the transient", force[0], force[1], b, s.speed_m_s).data,
        {panels[1], panels[2]}, 1);

  const auto p = *rosin::reconstruct_periodic(c.at, force[0], force[1], limits, rate_Hz);
  const std::size_t n = force[0].size();
  const column near = unrolled(p.force_near_N, p.source, n), far = unrolled(p.force_far_N, p.source, n),
               near_v = unrolled(p.velocity_near_m_s, p.source, n);
  std::printf("Fig. 5: two versions in the frequency domain: Delta %.4f (paper 0.29); against the time domain %.4f\n", p.delta,
              rosin::consistency_delta(near, b.near_N));
  const double from = static_cast<double>(p.source.begin + 20) / rate_Hz;
  window w(from, from + 0.0031, "Fig. 5: time and frequency domain");
  w.add("near_m_s", b.near_m_s), w.add("near_by_frequency_m_s", near_v), w.add("near_N", b.near_N),
      w.add("near_by_frequency_N", near), w.add("far_by_frequency_N", far);
  write(folder, 5, w.data,
        {{"(a) velocity",
          "time_ms",
          "time (ms)",
          "velocity (m/s)",
          {{"near_m_s", pale, "time domain"}, {"near_by_frequency_m_s", black, "frequency domain"}}},
         {"(b) force",
          "time_ms",
          "time (ms)",
          "force (N)",
          {{"near_N", pale, "time domain"}, {"near_by_frequency_N", black, "frequency domain"}}}},
        1);
}

/// Fig. 6: parameters known, no noise, against the truth.
void simulation(const std::filesystem::path& folder, const stroke& s) {
  const auto& t = s.truth;
  const auto at = rosin::contact_at(rig(7).string, s.position);
  using printed = rosin::physics<false, false, false, rosin::airy_passage<rosin::airy_form::printed>>;
  const column force = limited(t.contact_force_N), velocity = limited(t.centre_velocity_m_s);
  const bow b = reconstruct(at, t.force_near_N, t.force_far_N), paper = reconstruct<printed>(at, t.force_near_N, t.force_far_N);
  std::printf("Fig. 6: two versions of the force: Delta %.4f, with Eq. (6) as printed %.4f (paper 0.07)\n",
              delta(b.near_N, b.far_N), delta(paper.near_N, paper.far_N));
  std::printf("        their mean against the truth: Delta %.4f, with Eq. (6) as printed %.4f (paper 0.042)\n",
              delta(b.force_N, force), delta(paper.force_N, force));
  window w = stretch(0.2005, 0.2047, "Fig. 6: simulated, parameters known; printed: Eq. (6) as it stands", t.force_near_N,
                     t.force_far_N, b, s.speed_m_s);
  w.add("true_m_s", velocity), w.add("true_N", force);
  auto panels = four_panels("truth");
  panels[3].curves = {{"force_N", pale, "reconstructed"}, {"true_N", black, "truth", "true_m_s"}};
  write(folder, 6, w.data, panels, 2);
}

/// Fig. 8(b): the track along the rod, from the centre's velocity as in the paper and from the surface's.
void track(const std::filesystem::path& folder, const column& force, const column& centre, const column& surface, double speed) {
  const auto phases = rosin::find_phases(surface, speed);
  const auto loops = rosin::slip_loops(force, surface, phases, speed, rate_Hz, 0.25);
  double far = 0, slips = 0;
  for (const auto& l : loops)
    if (l.begin_s > 0.1) far += l.distance_m(), ++slips;
  const double cycles = (0.25 - 0.1) * 659.69;
  const auto verdict = rosin::judge_loops(loops, 5 / limits.stop_Hz);
  std::printf("Fig. 8: %.2f slips a cycle, %.0f um each in the mean; loops %s\n", slips / cycles, 1e6 * far / slips,
              verdict.sense == rosin::loop_sense::counter_clockwise ? "counter-clockwise" : "without that sense");
  const auto mm = [](column x) {
    const double first = x[25600];
    for (double& v : x) v = 1e3 * (v - first);
    return x;
  };
  window w(0.200, 0.2061, "Fig. 8(b): distance along the rod");
  w.add("centre_mm", mm(rosin::track_along(centre, rate_Hz))), w.add("surface_mm", mm(rosin::track_along(surface, rate_Hz)));
  column slipping(surface.size(), not_known);
  for (const auto& l : loops)
    std::fill(slipping.begin() + static_cast<std::ptrdiff_t>(l.at.begin),
              slipping.begin() + static_cast<std::ptrdiff_t>(l.at.end), 0.0);
  w.add("slips_mm", slipping);
  column um = rosin::track_along(centre, rate_Hz);
  const column rolled_out = rosin::track_along(surface, rate_Hz);
  for (std::size_t i = 0; i < um.size(); ++i) um[i] = 1e6 * (um[i] - rolled_out[i]);
  w.add("rolling_um", um);
  write(folder, 8, w.data,
        {{"(b) distance along the rod",
          "time_ms",
          "time (ms)",
          "distance (mm)",
          {{"centre_mm", blue, "centre"}, {"surface_mm", black, "surface"}, {"slips_mm", heavy, "slips"}}},
         {"what rolling moves the centre by", "time_ms", "time (ms)", "distance (um)", {{"rolling_um", red, ""}}}},
        1);
}

/// Fig. 7: a quarter of the string, torsion eight times as fast, found again from the reconstructed force.
void torsion(const std::filesystem::path& folder, const stroke& s) {
  const auto at = rosin::contact_at(rig(8).string, s.position);
  auto force = recorded(s.truth, 5);
  for (double& f : force[0]) f /= 1.021;
  for (double& f : force[1]) f /= 0.985;
  const bow b = reconstruct(at, force[0], force[1]), paper = reconstruct<rosin::paper_physics>(at, force[0], force[1]);
  std::printf("Fig. 7: two versions of the force: Delta %.4f, with the paper's filters %.4f (paper 0.36)\n",
              delta(b.near_N, b.far_N), delta(paper.near_N, paper.far_N));
  const column f = part(b.force_N, 0.1, 0.2), v = part(b.velocity_m_s, 0.1, 0.2);
  const auto fit = rosin::fit_torsion({{f, v, rate_Hz, s.speed_m_s, at.delay_s, at.impedance_Ns_m, 1e-3, limits.stop_Hz, 0.02}});
  if (!fit) return;
  const auto& found = fit->value;
  std::printf("        torsion found: speed %.3f +- %.3f (true 8, paper near 8), impedance %.2f (3.5), Q %.1f (15)\n",
              found.speed_ratio, fit->sd.speed_ratio, found.impedance_ratio, found.q);
  const auto guide = rosin::torsion_of(at.delay_s, at.impedance_Ns_m, found.speed_ratio, found.impedance_ratio, found.q);
  const column rolled = rosin::torsion_velocity(guide, part(b.force_N, 0.01, 0.25), rate_Hz);
  column surface(b.force_N.size(), not_known), rolling = surface, centre = surface;
  for (std::size_t i = 0, n = static_cast<std::size_t>(0.01 * rate_Hz); i < rolled.size(); ++i, ++n)
    rolling[n] = rolled[i], centre[n] = b.velocity_m_s[n] - s.speed_m_s, surface[n] = centre[n] + rolled[i];
  window w(0.200, 0.2061, "Fig. 7: velocity of the string's centre, and of its surface by rotation");
  w.add("centre_m_s", b.velocity_m_s), w.add("rolling_m_s", rolling), w.add("surface_m_s", less(surface, -s.speed_m_s));
  write(folder, 7, w.data,
        {{"velocity at the bow",
          "time_ms",
          "time (ms)",
          "velocity (m/s)",
          {{"centre_m_s", blue, "string (centre)"}, {"rolling_m_s", red, "surface by rotation"}}},
         {"their sum: the surface, which sticks to the rod",
          "time_ms",
          "time (ms)",
          "velocity (m/s)",
          {{"surface_m_s", blue, ""}}}},
        1);
  track(folder, b.force_N, centre, surface, s.speed_m_s);
}

}  // namespace

int main(int count, char** arguments) {
  const std::filesystem::path folder = count > 1 ? arguments[1] : "figures";
  std::filesystem::create_directories(folder);
  const auto calibration = pluck(folder, 0.3);
  const stroke paper(7, 0.3, 0.2, 0.3);
  laboratory(folder, paper, calibration);
  simulation(folder, paper);
  torsion(folder, stroke(8, 0.25, 0.35, 0.8));
}
