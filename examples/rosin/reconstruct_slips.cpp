// SPDX-License-Identifier: MIT
#include "reconstruct_slips.hpp"

#include "digits.hpp"

namespace tool {

namespace {

const char* name_of(rosin::loop_sense sense) {
  return sense == rosin::loop_sense::none ? "none" : sense == rosin::loop_sense::clockwise ? "clockwise" : "counter-clockwise";
}

std::string body(const take_reconstruction& r) { return r.torsion_m_s.empty() ? "the string's centre" : "the string's surface"; }

/// From when the rod first caught the string.
std::vector<double> relative_of(const take_reconstruction& r) {
  std::vector<double> out(r.velocity_m_s.size(), nan);
  bool caught = false;
  for (std::size_t i = r.known.begin; i < r.known.end; ++i) {
    const double surface = r.velocity_m_s[i] + (r.torsion_m_s.empty() ? 0.0 : r.torsion_m_s[i]);
    caught = caught || (std::abs(r.rod_m_s[i]) > 0 && surface / r.rod_m_s[i] > 0.75);
    if (caught) out[i] = surface - r.rod_m_s[i];
  }
  return out;
}

/// The middle one of all slips that decide.
double median(const take_slips& s, double (*of)(const rosin::slip_loop&)) {
  std::vector<double> values;
  double fastest = 0;
  for (const auto& l : s.loops) fastest = std::max(fastest, l.fastest_m_s);
  for (const auto& l : s.loops)
    if (l.fastest_m_s >= 0.3 * fastest) values.push_back(of(l));
  if (values.empty()) return nan;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::string direction(const take_slips& s) {
  const auto& v = s.verdict;
  const std::string split = in_digits(1e3 * v.split_N, "%+.2f") + " +- " + in_digits(1e3 * v.sd_N, "%.2f") +
                            " mN while it gathers speed against while it loses it, of a range of " +
                            in_digits(1e3 * v.range_N, "%.0f") + " mN (" + std::to_string(v.loops) +
                            " slips, the fastest quarter of their speeds)";
  if (v.sense == rosin::loop_sense::none) return "no sense: force " + split;
  return std::string{name_of(v.sense)} + " (velocity to the right, force upwards): force " + split;
}

/// Pieces of a curve, apart from one another.
struct pieces {
  curve drawn;
  void add(double x, double y) { drawn.x.push_back(x), drawn.y.push_back(y); }
  void lift() { add(nan, nan); }
};

panel loops_panel(const take_slips& s, const take_reconstruction& r, std::size_t begin, std::size_t end) {
  pieces there{{"gathers speed", {}, {}, colour::far, 1.3, 1}}, back{{"loses speed", {}, {}, colour::near, 1.3, 1}};
  for (const auto& l : s.loops) {
    if (l.at.begin < begin || l.at.end > end) continue;
    bool turned = false;
    for (std::size_t i = l.at.begin; i < l.at.end; ++i) {
      (turned ? back : there).add(s.relative_m_s[i], r.force_N[i]);
      if (!turned && std::abs(s.relative_m_s[i]) >= std::abs(l.fastest_m_s))
        turned = true, back.add(s.relative_m_s[i], r.force_N[i]);
    }
    there.lift(), back.lift();
  }
  return {"loops of the slips",
          "velocity of " + body(r) + " against the rod / (m/s)",
          r.ac_coupled ? "force, mean unknown / N" : "force / N",
          {there.drawn, back.drawn},
          {},
          {},
          {},
          400};
}

panel track_panel(const take_slips& s, const take_reconstruction& r, std::size_t begin, std::size_t end) {
  curve place{"", {}, {}, colour::model, 1.3, 1};
  panel p{"(a) place of the contact on the rod", "time / ms", "place / mm", {}, {}, {}, {}, 280};
  for (std::size_t i = begin; i < end; ++i) place.x.push_back(1e3 * r.time_s(i)), place.y.push_back(1e3 * s.place_m[i]);
  for (const auto& l : s.loops)
    if (l.at.begin < end && l.at.end > begin)
      p.heavy.emplace_back(1e3 * std::max(l.begin_s, r.time_s(begin)), 1e3 * std::min(l.end_s, r.time_s(end)));
  p.curves.push_back(place);
  p.x_range = std::pair{1e3 * r.time_s(begin), 1e3 * r.time_s(end)};
  return p;
}

panel scars_panel(const take_slips& s, std::size_t begin, std::size_t end) {
  pieces scars{{"", {}, {}, colour::slip, 2.2, 1}};
  for (const auto& l : s.loops) {
    if (l.at.begin < begin || l.at.end > end) continue;
    for (const auto& [x, y] : {std::pair{l.from_m, 0.0}, {l.from_m, l.stuck_s}, {nan, nan}}) scars.add(1e3 * x, 1e3 * y);
  }
  return {"(b) where it stuck", "place on the rod / mm", "for how long / ms", {scars.drawn}, {}, {}, {}, 220};
}

}  // namespace

take_slips slips_of(const take_reconstruction& r) {
  take_slips s;
  if (r.rod_m_s.empty()) return s;
  s.relative_m_s = relative_of(r);
  s.place_m = rosin::track_along(s.relative_m_s, r.rate_Hz);
  const double rod = r.rod_m_s[(r.known.begin + r.known.end) / 2];
  // the centre swings by rolling on the rod while the surface sticks, by up to the rod's speed
  s.phases =
      rosin::find_phases(s.relative_m_s, rod, r.torsion_m_s.empty() ? rosin::phase_options{1.2, 1.2, 4} : rosin::phase_options{});
  s.loops = rosin::slip_loops(r.force_N, s.relative_m_s, s.phases, rod, r.rate_Hz);
  s.verdict = rosin::judge_loops(s.loops, 5 / r.limits.stop_Hz);
  return s;
}

rosin::table table_of(const take_slips& s, const take_reconstruction& r, const provenance& from) {
  rosin::table t;
  t.comments = from.comment_lines();
  t.comments.push_back("slips of take " + r.take + " of rig " + r.title + ": " + body(r) +
                       " against the rod; rod: " + r.rod_from);
  t.comments.emplace_back(
      "loop_area_W: N m/s, > 0 counter-clockwise with the velocity to the right and the force upwards, both counted the way the "
      "rod moves; fast_area_W: "
      "beyond three quarters of the slip's speed; split_N: that divided by its width, force while it gathers speed less while it "
      "loses it");
  t.comments.push_back("loops: " + direction(s));
  if (r.ac_coupled)
    t.comments.emplace_back("AC coupled sensors: force and work lack the unknown mean of the force; areas and split do not");
  const auto column = [&](const char* name, double (*of)(const rosin::slip_loop&), int digits) {
    std::vector<double> values;
    for (const auto& l : s.loops) values.push_back(of(l));
    t.add(name, std::move(values), digits);
  };
  using loop = const rosin::slip_loop&;
  column(
      "begin_s", [](loop l) { return l.begin_s; }, 12);
  column(
      "end_s", [](loop l) { return l.end_s; }, 12);
  column(
      "duration_s", [](loop l) { return l.duration_s(); }, 6);
  column(
      "distance_m", [](loop l) { return l.distance_m(); }, 6);
  column(
      "fastest_m_s", [](loop l) { return l.fastest_m_s; }, 6);
  column(
      "onset_force_N", [](loop l) { return l.onset_N; }, 6);
  column(
      "recapture_force_N", [](loop l) { return l.recapture_N; }, 6);
  column(
      "force_range_N", [](loop l) { return l.range_N; }, 6);
  column(
      "loop_area_W", [](loop l) { return l.area_W; }, 6);
  column(
      "fast_area_W", [](loop l) { return l.fast_area_W; }, 6);
  column(
      "split_N", [](loop l) { return l.split_N(); }, 6);
  column(
      "dissipated_J", [](loop l) { return l.dissipated_J; }, 6);
  column(
      "from_m", [](loop l) { return l.from_m; }, 9);
  column(
      "to_m", [](loop l) { return l.to_m; }, 9);
  column(
      "stuck_before_s", [](loop l) { return l.stuck_s; }, 6);
  column(
      "crept_before_m", [](loop l) { return l.crept_m; }, 6);
  return t;
}

json to_json(const take_slips& s) {
  if (s.loops.empty()) return nullptr;
  const auto& v = s.verdict;
  return {{"slips", s.loops.size()},
          {"counted", v.loops},
          {"sense", name_of(v.sense)},
          {"split_N", v.split_N},
          {"split_sd_N", number_or_null(v.sd_N)},
          {"force_range_N", v.range_N},
          {"median_area_W", median(s, [](const rosin::slip_loop& l) { return l.area_W; })},
          {"median_distance_m", median(s, [](const rosin::slip_loop& l) { return l.distance_m(); })},
          {"median_dissipated_J", median(s, [](const rosin::slip_loop& l) { return l.dissipated_J; })}};
}

std::vector<std::pair<std::string, std::string>> facts_of(const take_slips& s, const take_reconstruction& r) {
  if (s.loops.empty()) return {};
  const double distance = median(s, [](const rosin::slip_loop&l) { return l.distance_m(); }),
               work = median(s, [](const rosin::slip_loop&l) { return l.dissipated_J; });
  const double area = median(s, [](const rosin::slip_loop&l) { return l.area_W; }),
               onset = median(s, [](const rosin::slip_loop&l) { return l.onset_N; });
  const double recapture = median(s, [](const rosin::slip_loop&l) { return l.recapture_N; }),
               fastest = median(s, [](const rosin::slip_loop&l) { return l.fastest_m_s; });
  std::string middle = in_digits(1e6 * distance) + " um along the rod, up to " + in_digits(fastest) + " m/s, force " +
                       in_digits(onset) + " N at its onset and " + in_digits(recapture) + " N at its end, loop of " +
                       in_digits(area, "%+.3g") + " N m/s, " + in_digits(1e6 * work) + " uJ";
  if (r.ac_coupled) middle += " (forces and work without the unknown mean)";
  return {{"loops of force against velocity", direction(s)}, {"middle one of the slips (" + body(r) + ")", middle}};
}

std::vector<figure> figures_of(const take_slips& s, const take_reconstruction& r, std::size_t begin, std::size_t end) {
  begin = std::max(begin, r.known.begin), end = std::min(end, r.known.end);
  if (s.loops.empty() || begin + 2 > end) return {};
  figure loops{"Each slip of that stretch by itself. Loops: " + direction(s) + ".", {loops_panel(s, r, begin, end)}, 680};
  figure track{"The track along the rod, from the velocity of " + body(r) +
                   " against it: (a) steep where it slips (heavy lines above), level where it sticks; (b) the scars: "
                   "places at which it stuck before it slipped, and for how long.",
               {track_panel(s, r, begin, end), scars_panel(s, begin, end)},
               920};
  return {loops, track};
}

}  // namespace tool
