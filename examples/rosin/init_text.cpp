// SPDX-License-Identifier: MIT
//
// The rig file that rosin init writes: what was found stands in it, what nobody can know from the recordings is a comment with its unit
// and an example, so that `rosin check` names it until it is filled in.
//
#include "init_folder.hpp"

#include "digits.hpp"

namespace tool {

namespace {

constexpr std::size_t remark_column = 48;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + '"';
}

/// One line of a comment, whatever stands in it.
std::string remark(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return "# " + text + "\n";
}

std::string number(double x) {
  std::string out = in_digits(x, "%.9g");
  if (out.find_first_of(".en") == std::string::npos) out += ".0";
  return out;
}

std::string line(const std::string& entry, const std::string& why) {
  return entry + std::string(entry.size() < remark_column ? remark_column - entry.size() : 1, ' ') + "# " + why + "\n";
}
std::string to_fill_in(const std::string& entry, const std::string& why) { return line("# " + entry, why); }

std::string string_section() {
  return "\n[string]\n" + to_fill_in("length_m = 0.70", "m, between the terminations: to be filled in") +
         to_fill_in("tension_N = 145.0", "N, at this tuning: to be filled in") +
         to_fill_in("fundamental_Hz = 98.0", "Hz, nominal tuning: to be filled in") +
         to_fill_in("bending_stiffness_Nm2 = 3.0e-4", "N m2; left out: unknown") +
         to_fill_in("fundamental_tolerance = 0.003", "relative, a limit; also of length, tension, bending_stiffness");
}

/// What a header calls a column, as far as that is plain.
std::string channel_by(std::string name) {
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const auto has = [&](std::initializer_list<const char*> parts) {
    return std::any_of(parts.begin(), parts.end(), [&](const char* part) { return name.find(part) != std::string::npos; });
  };
  if (has({"near", "bridge"})) return "near";
  if (has({"far", "nut"})) return "far";
  if (has({"speed", "velocity"})) return "bow";
  if (has({"normal", "bow_force", "bow force", "bowforce"})) return "normal";
  return {};
}

std::string extent(const column_figures& c, const std::string& unit) {
  return in_digits(c.lowest, "%.4g") + " ... " + in_digits(c.highest, "%.4g") + unit;
}

std::string table_channels(const found_take& first) {
  std::string out;
  std::vector<std::string> taken;
  for (std::size_t i = 0; i < first.columns.size(); ++i) {
    const auto& c = first.columns[i];
    const std::string what = channel_by(c.name),
                      place = c.name.empty() ? "index = " + std::to_string(i) : "column = " + quoted(c.name);
    const std::string seen = extent(c, "") + " in " + first.name;
    const bool known = !what.empty() && std::find(taken.begin(), taken.end(), what) == taken.end();
    if (!known) {
      out += to_fill_in("near = { " + place + ", gain_tolerance = 0.05 }",
                        "what is this? " + seen + ": to be filled in, or left out");
      continue;
    }
    taken.push_back(what);
    const std::string quantity = what == "normal" ? ", quantity = \"normal-force\""
                                 : what == "bow"  ? ", quantity = \"bow-speed\""
                                                  : ", gain_tolerance = 0.05";
    out += line(what + " = { " + place + quantity + " }",
                std::string{what == "bow" ? "m/s" : "N"} + ", by its header: check it; " + seen);
  }
  return out;
}

std::string channels_section(const found_take& first) {
  std::string out = "\n[channels]\n";
  if (first.machine_layout) {
    out +=
        remark(
            "The columns of the public layout. near is the bridge's end, from which contact_position counts. Scales are 1: the") +
        remark(
            "tables are in N and m/s. gain_tolerance is a limit, relative; where the sensors' calibration is known better, say "
            "so.");
    out += "normal = { index = 0, quantity = \"normal-force\" }\n";
    out += "bow = { index = 1, quantity = \"bow-speed\" }\n";
    out += "near = { index = 2, gain_tolerance = 0.05 }\n";
    return out + "far = { index = 3, gain_tolerance = 0.05 }\n";
  }
  out += remark(
      "near and far: forces on the terminations. Others: quantity = \"normal-force\", \"bow-speed\", \"string-velocity\", "
      "\"sound\".");
  if (first.is_table) return out + table_channels(first);
  for (std::size_t i = 0; i < first.columns.size(); ++i)
    out += to_fill_in(std::string{i == 0   ? "near"
                                  : i == 1 ? "far"
                                           : "other"} +
                          " = { index = " + std::to_string(i) + ", newtons_per_full_scale = 1.0 }",
                      "N at full scale: to be filled in; " + extent(first.columns[i], " of full scale") + " in " + first.name);
  return out;
}

std::string files_section(const found_take& first) {
  if (!first.is_table) return {};
  if (first.machine_layout)
    return "\n[files]\n" + line("rate_Hz = 50000", "Hz; the public set's, the files do not tell it: check it");
  for (std::size_t c = 0; c < first.columns.size(); ++c)
    if (first.rate_Hz > 0) {
      const std::string name = first.columns[c].name;
      if (name == "t" || name == "t_s" || name == "T" || name.starts_with("time") || name.starts_with("Time") ||
          name.starts_with("TIME"))
        return "\n[files]\n" + line("time_column = " + std::to_string(c),
                                    "s, by its header: " + in_digits(first.rate_Hz, "%.6g") + " samples a second");
    }
  return "\n[files]\n" + to_fill_in("rate_Hz = 50000.0", "Hz: to be filled in; or time_column = 0, the column of times in s");
}

std::string contact_section(const std::vector<found_take>& takes) {
  const bool placed =
      std::all_of(takes.begin(), takes.end(), [](const found_take& t) { return t.beta.has_value() || t.kind == "quiet"; });
  std::string out;
  if (placed) out = "\n" + remark("Each take says where its contact is; this would hold for takes that do not.");
  out += (placed ? "# [contact]\n" : "\n[contact]\n");
  out += to_fill_in("position = 0.10", std::string{"distance from the near end / length"} + (placed ? "" : ": to be filled in"));
  return out + to_fill_in("position_tolerance = 0.005", "fraction of the length; a limit");
}

std::string model_section() {
  return "\n" + remark("What bows the string. Left out: a rigid rod.") + "# [bow]\n" +
         to_fill_in("kind = \"hair\"", "or \"rod\"") + to_fill_in("width_m = 0.010", "m, along the string") + "\n" +
         remark(
             "[torsion], [terminations] and [model] are described in docs/formats/rig.md; left out: unknown, rigid, nothing.") +
         "# [torsion]\n" + to_fill_in("speed_ratio = 5.5", "torsional / transverse wave speed") +
         to_fill_in("impedance_ratio = 2.0", "torsional, referred to the surface / transverse") +
         to_fill_in("q = 30.0", "of torsional waves");
}

std::string measured(const found_take& t) {
  const auto& m = t.motion;
  if (!m.steady_speed_m_s && !m.steady_normal_force_N) return {};
  std::string out = "measured from " + in_digits(static_cast<double>(m.steady_begin) / t.rate_Hz, "%.3f") + " to " +
                    in_digits(static_cast<double>(m.steady_end) / t.rate_Hz, "%.3f") + " s:";
  if (m.steady_speed_m_s) out += " bow speed " + in_digits(*m.steady_speed_m_s, "%.4g") + " m/s,";
  if (m.steady_normal_force_N) out += " normal force " + in_digits(*m.steady_normal_force_N, "%.4g") + " N,";
  out.pop_back();
  if (m.normal_offset_N) out += " (" + in_digits(m.normal_offset_N->value, "%.3g") + " N of offset taken off)";
  return remark(out);
}

std::string take_section(const found_take& t) {
  std::string out = "\n[[take]]\nname = " + quoted(t.name) + "\n";
  out += t.kind.empty()     ? to_fill_in("kind = \"bow\"", "bow, pluck or quiet: to be filled in")
         : t.machine_layout ? "kind = \"bow\"\n"
                            : line("kind = " + quoted(t.kind), "by the file's name: check it");
  out += "file = " + quoted(t.file) + "\n";
  if (t.kind == "pluck") out += to_fill_in("force_N = 1.0", "N, nominal breaking force of the wire: to be filled in");
  if (t.kind == "bow" && !t.machine_layout)
    out += to_fill_in("speed_m_s = 0.20", "m/s, once steady: to be filled in, unless a channel measures it") +
           to_fill_in("normal_force_N = 0.30", "N, once steady: likewise");
  if (t.beta) out += "contact_position = " + number(*t.beta) + "\n";
  else if (t.machine_layout) out += to_fill_in("contact_position = 0.10", "distance from the near end / length: to be filled in");
  if (t.steady_samples)
    out += line(
        "steady_s = [" + number(t.steady_samples->first / t.rate_Hz) + ", " + number(t.steady_samples->second / t.rate_Hz) + "]",
        "said to be steady: a hint");
  out += measured(t);
  for (const auto& r : t.remarks) out += remark(r);
  return out;
}

}  // namespace

std::string rig_text(const std::vector<found_take>& takes, const init_request& given, const std::string& from) {
  const found_take& first = takes.front();
  std::string out = remark(from);
  out += remark("Lines with \"to be filled in\" hold what recordings cannot tell: take off the # and put the true value there;") +
         remark("`rosin check` names what is still missing.");
  out += "schema = 1\n";
  const std::string title = std::filesystem::path{given.folder}.lexically_normal().filename().string();
  if (!title.empty() && title != "." && title != "..") out += "title = " + quoted(title) + "\n";
  out += string_section() + channels_section(first) + files_section(first) + contact_section(takes) + model_section();
  for (const auto& t : takes) out += take_section(t);
  return out;
}

}  // namespace tool
