// SPDX-License-Identifier: MIT
#include "rig_input.hpp"

#include "digits.hpp"

#include <rosin/adapt/table_mat.hpp>

namespace tool {

const rosin::table_formats& table_formats() {
  static const rosin::table_formats all = [] {
    auto out = rosin::plain_table_formats();
    out.push_back({".mat", rosin::read_mat});
#ifdef ROSIN_TOOL_HDF5
    add_hdf5_tables(out);
#endif
    return out;
  }();
  return all;
}

rosin::outcome<rosin::rig_folder> open_rig(const std::string& path, provenance& from) {
  auto folder = rosin::open_rig_folder(path, table_formats());
  if (!folder) return folder;
  if (const auto why = from.add_input(folder->rig.file)) return *why;
  for (const auto* end : {&folder->rig.near, &folder->rig.far})
    if (*end && (*end)->kind == rosin::termination::form::table)
      if (const auto why = from.add_input(folder->rig.path_of((*end)->file))) return *why;
  return folder;
}

std::vector<std::string> doubts_of(const rosin::rig_folder& folder) {
  std::vector<std::string> out;
  for (const auto& f : folder.doubts) out.push_back(warning_of(folder.rig, f));
  return out;
}

rosin::outcome<checked_take> read_take(const rosin::rig& rig, const rosin::take& take, provenance& from) {
  auto signals = rosin::load_take(rig, take, table_formats());
  if (!signals) return rosin::failure{signals.error()};
  if (const auto why = from.add_input(rig.path_of(take.file))) return *why;
  auto check = rosin::check_take(rig, take, *signals);
  return checked_take{*std::move(signals), std::move(check)};
}

std::optional<checked_take> read_telling(const rosin::rig& rig, const rosin::take& take, provenance& from,
                                         std::vector<std::string>& warnings) {
  auto out = read_take(rig, take, from);
  if (!out) {
    warnings.push_back(take.name + ": left out: " + out.error());
    return std::nullopt;
  }
  for (const auto& f : out->check.findings)
    if (f.level != rosin::severity::note) warnings.push_back(warning_of(rig, f));
  return *std::move(out);
}

rosin::failure failed(const std::string& why, const std::vector<std::string>& noticed) {
  std::string text = why;
  for (const auto& line : noticed) text += "\n" + line;
  return rosin::failure{text};
}

rosin::outcome<checked_take> read_sound_take(const rosin::rig& rig, const rosin::take& take, provenance& from) {
  auto out = read_take(rig, take, from);
  if (!out || !rosin::has_error(out->check.findings)) return out;
  std::string all;
  for (const auto& finding : out->check.findings)
    if (finding.level == rosin::severity::error) all += (all.empty() ? "" : "\n") + sentence(rig, finding);
  return rosin::failure{all};
}

namespace {

/// Where it is: file, take, channel, time.
std::string place_of(const rosin::rig& rig, const rosin::finding& finding) {
  const rosin::take* take = rig.find_take(finding.take);
  if (finding.take.empty()) return rig.file + ": ";
  std::string out = take != nullptr ? take->file + ": " : std::string{};
  out += "take " + finding.take;
  if (take != nullptr) out += " (" + rig.file + ":" + std::to_string(take->line) + ")";
  if (!finding.channel.empty()) out += ", channel " + finding.channel;
  out += ", " + in_digits(finding.start_s, "%.4f");
  if (finding.end_s > finding.start_s) out += " to " + in_digits(finding.end_s, "%.4f");
  return out + " s: ";
}

}  // namespace

std::string sentence(const rosin::rig& rig, const rosin::finding& finding) {
  return place_of(rig, finding) + name_of(finding.level) + ": " + finding.what + "; " + finding.advice;
}

std::string warning_of(const rosin::rig& rig, const rosin::finding& finding) {
  return place_of(rig, finding) + (finding.level == rosin::severity::error ? "error: " : "") + finding.what + "; " +
         finding.advice;
}

json to_json(const rosin::finding& finding) {
  return {{"severity", name_of(finding.level)},
          {"kind", finding.kind},
          {"take", finding.take.empty() ? json(nullptr) : json(finding.take)},
          {"channel", finding.channel.empty() ? json(nullptr) : json(finding.channel)},
          {"time_s", {finding.start_s, finding.end_s}},
          {"what", finding.what},
          {"advice", finding.advice}};
}

rosin::outcome<rosin::string_parameters> nominal_string(const rosin::rig& rig, std::vector<std::string>& assumed) {
  const auto values = rosin::values_of(rig);
  if (!values.length_m || !values.tension_N || !values.impedance_Ns_m || !values.wave_speed_m_s)
    return rosin::failure{rig.file + ": string: length_m and tension_N are needed for a result in SI units"};
  rosin::string_parameters out;
  out.length_m = values.length_m->value;
  out.fundamental_Hz = values.fundamental_Hz.value;
  out.tension_N = values.impedance_Ns_m->value * *values.wave_speed_m_s;
  if (rig.string.impedance_Ns_m)
    assumed.push_back(rosin::detail::sentence("tension_N", out.tension_N, "from impedance, length and fundamental"));
  if (values.bending_stiffness_Nm2) out.bending_stiffness_Nm2 = values.bending_stiffness_Nm2->value;
  else assumed.push_back("bending_stiffness_Nm2 = 0, unknown");
  out.loss = {values.quality, values.loss_internal_s, values.loss_air_sqrt_Hz};
  return out;
}

}  // namespace tool
