// SPDX-License-Identifier: MIT
#include "challenge_score.hpp"

#include "digits.hpp"

#include <boost/math/distributions/beta.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace tool {

namespace {

bool same_effect(const std::string& hidden, const json& said) {
  if (said.at("effect") == hidden) return true;
  const auto& others = said.at("indistinguishable_from");
  return std::find(others.begin(), others.end(), json(hidden)) != others.end() && others.size() <= 2;
}

void score_parameters(const std::string& effect, const json& truth, const json& said, rig_score& s) {
  const json& estimates = said.at("parameters");
  for (const auto& [name, value] : truth.at("parameters").items()) {
    if (value.is_string()) {
      s.has_place = true;
      const auto& where = said.at("where");
      const bool right = value == "both" ? !where.contains(name) : where.contains(name) && where.at(name) == value;
      if (!right) s.place_right = false;
      continue;
    }
    if (!estimates.contains(name)) continue;
    const json& e = estimates.at(name);
    const double x = value, found = e.at("value");
    parameter_score p{effect, name, name == "position" ? found - x : (found - x) / std::abs(x), false, e.contains("ci95")};
    if (p.has_interval) p.covered = e.at("ci95").at(0) <= x && x <= e.at("ci95").at(1);
    if (name == "position") {
      s.has_place = true;
      if (!(std::abs(p.error) <= 0.01)) s.place_right = false;
    }
    s.parameters.push_back(p);
  }
}

/// Clopper and Pearson's 95 % limits of a share.
std::string share(std::size_t right, std::size_t all) {
  if (all == 0) return "-";
  const double k = static_cast<double>(right), n = static_cast<double>(all);
  const double low = right == 0 ? 0 : boost::math::ibeta_inv(k, n - k + 1, 0.025),
               high = right == all ? 1 : boost::math::ibeta_inv(k + 1, n - k, 0.975);
  return std::to_string(right) + "/" + std::to_string(all) + " (" + in_digits(100 * low, "%.0f") + "-" +
         in_digits(100 * high, "%.0f") + " %)";
}

double median(std::vector<double> x) {
  if (x.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::nth_element(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2), x.end());
  return x[x.size() / 2];
}

std::string joined(const std::vector<std::string>& names, const char* none) {
  std::string out;
  for (const auto& n : names) out += (out.empty() ? "" : " + ") + n;
  return out.empty() ? none : out;
}

}  // namespace

rig_score score(const json& truth, const json& diagnosis) {
  rig_score s;
  s.name = truth.at("name"), s.verdict = diagnosis.at("verdict");
  for (const auto& e : truth.at("effects"))
    if (e.at("effect") != "none") s.hidden.push_back(e.at("effect"));
  const json& missing = diagnosis.at("missing");
  for (const auto& m : missing) s.named.push_back(m.at("effect"));
  std::size_t found = 0;
  for (const auto& e : truth.at("effects")) {
    const auto said = std::find_if(missing.begin(), missing.end(), [&](const json& m) { return same_effect(e.at("effect"), m); });
    if (said == missing.end()) continue;
    ++found;
    score_parameters(e.at("effect"), e, *said, s);
  }
  s.all_found = found == s.hidden.size();
  s.right = s.all_found && missing.size() == s.hidden.size() &&
            (s.hidden.empty() ? s.verdict == "no-mismatch" : s.verdict == "explained");
  const json& fit = diagnosis.at("fit");
  if (fit.at("metric") == "pluck-residual" && fit.at("after").is_number() && fit.at("noise_floor").is_number() &&
      fit.at("noise_floor") > 0)
    s.held_out_over_floor = fit.at("after").get<double>() / fit.at("noise_floor").get<double>();
  return s;
}

void add_forces(const json& errors, rig_score& s) {
  if (!errors.is_object()) return;
  for (const auto& [take, e] : errors.items())
    if (e.contains("before") && e.contains("after")) s.forces.emplace_back(e.at("before"), e.at("after"));
}

json to_json(const std::vector<rig_score>& scores) {
  json out = json::array();
  for (const auto& s : scores) {
    json parameters = json::array();
    for (const auto& p : s.parameters)
      parameters.push_back({{"effect", p.effect},
                            {"name", p.name},
                            {"error", p.error},
                            {"covered", p.has_interval ? json(p.covered) : json(nullptr)}});
    out.push_back({{"name", s.name},
                   {"hidden", s.hidden},
                   {"named", s.named},
                   {"verdict", s.verdict},
                   {"right", s.right},
                   {"place_right", s.has_place ? json(s.place_right) : json(nullptr)},
                   {"parameters", parameters},
                   {"forces", s.forces},
                   {"held_out_over_floor", s.held_out_over_floor},
                   {"seconds", s.seconds}});
  }
  return out;
}

std::string left_out_to_markdown(const std::vector<rig_score>& scores, const std::string& how) {
  std::map<std::string, std::vector<const rig_score*>> by;
  std::size_t owned_up = 0, misled = 0;
  for (const auto& s : scores) {
    by[joined(s.hidden, "nothing")].push_back(&s);
    owned_up += s.verdict == "unexplained", misled += s.verdict == "explained";
  }
  std::string out =
      how + "\n\nCalled unexplained: " + share(owned_up, scores.size()) +
      ". Explained by something else: " + share(misled, scores.size()) +
      ".\n\n| hidden and not in the catalogue | unexplained | seen as no mismatch | explained instead by |\n|---|---|---|---|\n";
  for (const auto& [hidden, rigs] : by) {
    std::size_t unexplained = 0, unseen = 0;
    std::map<std::string, int> instead;
    for (const auto* s : rigs) {
      unexplained += s->verdict == "unexplained", unseen += s->verdict == "no-mismatch";
      if (s->verdict == "explained") ++instead[joined(s->named, "nothing")];
    }
    std::string wrong;
    for (const auto& [name, count] : instead)
      wrong += (wrong.empty() ? "" : ", ") + (count > 1 ? std::to_string(count) + " x " : std::string{}) + name;
    out += "| " + hidden + " | " + share(unexplained, rigs.size()) + " | " + std::to_string(unseen) + " | " + wrong + " |\n";
  }
  return out;
}

std::string forces_to_markdown(const std::vector<rig_score>& scores) {
  std::map<std::string, std::vector<std::pair<double, double>>> by;
  for (const auto& s : scores)
    if (!s.forces.empty())
      by[joined(s.hidden, "nothing")].insert(by[joined(s.hidden, "nothing")].end(), s.forces.begin(), s.forces.end());
  if (by.empty()) return {};
  std::string out =
      "\nError of the reconstructed force against the true one (Delta of Eq. (12) up to 20 kHz, after one common scale):\n\n"
      "| hidden | strokes | as declared, median | as diagnosed, median | worst | larger than as declared by a tenth "
      "|\n|---|---|---|---|---|---|\n";
  for (const auto& [hidden, strokes] : by) {
    std::vector<double> before, after;
    std::size_t worse = 0;
    for (const auto& [b, a] : strokes) before.push_back(b), after.push_back(a), worse += a > 1.1 * b;
    out += "| " + hidden + " | " + std::to_string(strokes.size()) + " | " + in_digits(median(before), "%.2g") + " | " +
           in_digits(median(after), "%.2g") + " | " + in_digits(*std::max_element(after.begin(), after.end()), "%.2g") + " | " +
           std::to_string(worse) + " |\n";
  }
  return out;
}

std::string to_markdown(const std::vector<rig_score>& scores, const std::string& how) {
  std::map<std::string, std::vector<const rig_score*>> by;
  std::size_t right = 0, placed = 0, with_place = 0, covered = 0, intervals = 0;
  std::vector<double> seconds, floors;
  for (const auto& s : scores) {
    by[joined(s.hidden, "nothing")].push_back(&s);
    right += s.right, with_place += s.has_place, placed += s.has_place && s.place_right;
    for (const auto& p : s.parameters) intervals += p.has_interval, covered += p.covered;
    if (s.seconds > 0) seconds.push_back(s.seconds);
    if (s.held_out_over_floor > 0 && s.verdict == "explained") floors.push_back(s.held_out_over_floor);
  }
  std::string out = how + "\n\nNamed right: " + share(right, scores.size()) +
                    ". End, channel and position right where the effect was named: " + share(placed, with_place) +
                    ". 95 % intervals that cover: " + share(covered, intervals) +
                    ". Held-out residual over the noise floor, median: " + (floors.empty() ? "-" : in_digits(median(floors))) +
                    ". Seconds a rig, median: " + in_digits(median(seconds)) +
                    ".\n\n| hidden | named right | placed right | errors, median | intervals that cover | said instead "
                    "|\n|---|---|---|---|---|---|\n";
  for (const auto& [hidden, rigs] : by) {
    std::size_t ok = 0, place_ok = 0, places = 0, in = 0, of = 0;
    std::map<std::string, std::vector<double>> errors;
    std::map<std::string, int> instead;
    for (const auto* s : rigs) {
      ok += s->right, places += s->has_place, place_ok += s->has_place && s->place_right;
      for (const auto& p : s->parameters) errors[p.name].push_back(std::abs(p.error)), of += p.has_interval, in += p.covered;
      if (!s->right) ++instead[joined(s->named, "nothing") + (s->verdict == "unexplained" ? " (unexplained)" : "")];
    }
    std::string wrong, off;
    for (const auto& [name, count] : instead)
      wrong += (wrong.empty() ? "" : ", ") + (count > 1 ? std::to_string(count) + " x " : std::string{}) + name;
    for (const auto& [name, e] : errors)
      off += (off.empty() ? "" : ", ") + name + " " +
             (name == "position" ? in_digits(median(e), "%.1e") : in_digits(100 * median(e), "%.2g") + " %");
    out += "| " + hidden + " | " + share(ok, rigs.size()) + " | " + share(place_ok, places) + " | " + off + " | " +
           share(in, of) + " | " + wrong + " |\n";
  }
  return out;
}

}  // namespace tool
