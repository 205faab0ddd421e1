// SPDX-License-Identifier: MIT
#include "rig_ends.hpp"

#include "digits.hpp"

#include <rosin/acquire/rig_values.hpp>
#include <rosin/acquire/signal_checks.hpp>

namespace tool {

namespace {

using form = rosin::termination::form;

constexpr double ringing_q =
    0.55;  ///< the least Q of a table's modes, and of what a diagnosis knows: it seeks poles of what rings

const std::optional<rosin::termination>& end_of(const rosin::rig& rig, std::size_t which) {
  return which == 0 ? rig.near : rig.far;
}

template <class End>
moving_end wrapped(const End& end, rosin::known_admittance admittance) {
  return {rosin::reflection_of_end<End>{end},
          [end](std::span<const double> force_N, const rosin::band& limits, double rate_Hz) {
            return rosin::motion_of_end(end, force_N, limits, rate_Hz);
          },
          std::move(admittance)};
}

/// "rig.toml: terminations.far: bridge.csv"
std::string place_of(const rosin::rig& rig, std::size_t which) {
  const auto& end = end_of(rig, which);
  return rig.file + ": terminations." + (which == 0 ? "near" : "far") + (end && end->kind == form::table ? ": " + end->file : "");
}

std::string no_impedance(const rosin::rig& rig) {
  return rig.file +
         ": terminations: length_m and tension_N (or impedance_Ns_m) are needed to set an admittance against the string's";
}

rosin::outcome<rosin::table_termination> completed(const rosin::rig& rig, const rosin::termination& t, std::size_t which,
                                                   double impedance_Ns_m, std::vector<std::string>& remarks) {
  std::vector<rosin::measured_admittance> table;
  for (const auto& p : t.admittance) table.push_back({p.frequency_Hz, {p.re_m_sN, p.im_m_sN}});
  const auto end = rosin::complete_admittance(table, impedance_Ns_m);
  const std::string name = which == 0 ? "near" : "far";
  if (!end) return rosin::failure{place_of(rig, which) + ": " + end.error()};
  const auto percent = [](double x) { return in_digits(100 * x, "%.2g") + " %"; };
  if (end->repaired > 0)
    remarks.push_back("terminations." + name + ": " + t.file + ": negative real parts (" + percent(end->repaired) +
                      " of all) were set to 0: a termination takes energy");
  if (end->mismatch > 0.1)
    remarks.push_back("terminations." + name + ": " + t.file + ": its imaginary part differs by " + percent(end->mismatch) +
                      " from what causality makes of its real part, which is used");
  return end;
}

rosin::outcome<moving_end> end_of_table(const rosin::rig& rig, const rosin::termination& t, std::size_t which,
                                        double impedance_Ns_m, std::vector<std::string>& remarks) {
  const auto end = completed(rig, t, which, impedance_Ns_m, remarks);
  if (!end) return rosin::failure{end.error()};
  return wrapped(*end, [e = *end](std::complex<double> s) { return e.at(s); });
}

rosin::modal_termination declared_modes(const rosin::termination& t, double impedance_Ns_m) {
  rosin::modal_termination out;
  for (const auto& m : t.modes) out.modes.push_back({m.frequency_Hz, m.q, impedance_Ns_m / m.mass_kg});
  return out;
}

/// A table by modes, as far as the string can feel it: from well below its pitch to where the completed table has faded. Noise in
/// a measured table is nothing that modes should follow: only where half of it cannot be had is it no admittance of modes.
rosin::outcome<rosin::modal_termination> modes_of_table(const rosin::rig& rig, const rosin::termination& t, std::size_t which,
                                                        double impedance_Ns_m, std::vector<std::string>& remarks) {
  const auto end = completed(rig, t, which, impedance_Ns_m, remarks);
  if (!end) return rosin::failure{end.error()};
  const auto like = rosin::as_modes(*end, {.from_Hz = rig.string.fundamental_Hz / 8,
                                           .to_Hz = std::min(2 * t.admittance.back().frequency_Hz, 30e3),
                                           .refuse = 0.5,
                                           .least_q = ringing_q});
  if (!like) return rosin::failure{place_of(rig, which) + ": " + like.error()};
  remarks.push_back(std::string{"terminations."} + (which == 0 ? "near" : "far") + ": " + t.file + ": by " +
                    std::to_string(like->end.modes.size()) + " modes, whose reflection differs from the table's by " +
                    in_digits(100 * like->mismatch, "%.2g") + " % of what moves");
  return like->end;
}

/// Rigid where they are to be fitted.
rosin::outcome<std::array<rosin::modal_termination, 2>> ends_as_modes(const rosin::rig& rig, double impedance_Ns_m,
                                                                      std::vector<std::string>& remarks) {
  std::array<rosin::modal_termination, 2> out;
  for (std::size_t which = 0; which < 2; ++which) {
    const auto& end = end_of(rig, which);
    if (!end || end->kind == form::rigid || end->kind == form::fit) continue;
    if (!(impedance_Ns_m > 0)) return rosin::failure{no_impedance(rig)};
    if (end->kind == form::modes) {
      out[which] = declared_modes(*end, impedance_Ns_m);
      continue;
    }
    auto modes = modes_of_table(rig, *end, which, impedance_Ns_m, remarks);
    if (!modes) return rosin::failure{modes.error()};
    out[which] = *std::move(modes);
  }
  return out;
}

}  // namespace

rosin::modal_termination fitted_ends::end(std::size_t which) const {
  rosin::modal_termination out;
  for (const auto& m : modes)
    if (m.end == which) out.modes.push_back(m.mode);
  return out;
}

std::vector<rosin::mode_of_end> fitted_ends::list() const {
  std::vector<rosin::mode_of_end> out;
  for (const auto& m : modes) out.push_back({m.end, m.mode});
  return out;
}

moving_end end_of_modes(const rosin::modal_termination& end) {
  if (end.modes.empty()) return {};
  return wrapped(end, [end](std::complex<double> s) { return end.at(s); });
}

bool to_be_fitted(const rosin::rig& rig, std::size_t which) {
  return end_of(rig, which) && end_of(rig, which)->kind == form::fit;
}

bool any_end_moves(const rosin::rig& rig) {
  return (rig.near && rig.near->kind != form::rigid) || (rig.far && rig.far->kind != form::rigid);
}

rosin::outcome<moving_end> declared_end(const rosin::rig& rig, std::size_t which, double impedance_Ns_m,
                                        std::vector<std::string>& remarks) {
  const auto& end = end_of(rig, which);
  if (!end || end->kind == form::rigid || end->kind == form::fit) return moving_end{};
  if (!(impedance_Ns_m > 0)) return rosin::failure{no_impedance(rig)};
  if (end->kind == form::table) return end_of_table(rig, *end, which, impedance_Ns_m, remarks);
  return end_of_modes(declared_modes(*end, impedance_Ns_m));
}

std::optional<rosin::failure> add_known_ends(const rosin::rig& rig, const rosin::rig_values& values, rosin::pluck_guess& guess,
                                             std::vector<std::string>& remarks) {
  auto ends = ends_as_modes(rig, values.impedance_Ns_m ? values.impedance_Ns_m->value : 0, remarks);
  if (!ends) return rosin::failure{ends.error()};
  for (auto& end : *ends)
    for (auto& m : end.modes) m.q = std::max(m.q, ringing_q);
  guess.ends = *std::move(ends);
  return std::nullopt;
}

rosin::outcome<std::array<rosin::modal_termination, 2>> simulated_ends(const rosin::rig& rig, double impedance_Ns_m,
                                                                       std::vector<std::string>& remarks) {
  for (const std::size_t which : {0U, 1U})
    if (to_be_fitted(rig, which))
      return rosin::failure{
          place_of(rig, which) +
          ": \"fit\" cannot be simulated: it asks the plucks, and there are none yet; declare \"rigid\", modes or a file"};
  return ends_as_modes(rig, impedance_Ns_m, remarks);
}

}  // namespace tool
