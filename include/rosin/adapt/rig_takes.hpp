// tier: hosted
// SPDX-License-Identifier: MIT
//
// The [[take]] tables of a rig file. A key belongs to one kind of take; with two force transducers the forces, speeds and
// positions are required, without them everything is compared in relative terms and they may be left out. What a channel measures
// need not be declared.
//
#pragma once

#include <rosin/acquire/recording.hpp>
#include <rosin/adapt/toml_fields.hpp>

namespace rosin::detail {

/// [[time in s, value], ...], times ascending.
inline profile read_profile(toml_fields& fields, std::string_view key, const value_range& values) {
  profile out;
  const auto* list = fields.list(key, "a list of pairs, as [[0, 0], [0.05, 0.2]]");
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const std::string place = fields.path(key) + "[" + std::to_string(i) + "]";
    const auto* pair = list->get(i)->as_array();
    if (pair == nullptr || pair->size() != 2) {
      fields.wrong_type(*list->get(i), place, "a pair [time in s, value]");
      continue;
    }
    const auto time = fields.number_in(*pair->get(0), place + "[0]", zero_to(1e6));
    const auto value = fields.number_in(*pair->get(1), place + "[1]", values);
    if (!time || !value) continue;
    if (!out.empty() && *time <= out.back().first) fields.problem(*pair, place, "is not later than the point before it");
    out.emplace_back(*time, *value);
  }
  if (list != nullptr && list->empty()) fields.refuse(key, "is empty");
  return out;
}

inline void read_pluck(toml_fields& fields, take& t, bool forces) {
  if (forces && !fields.has("force_N")) fields.missing("force_N");
  t.force_N = fields.number("force_N", up_to(1e4));
  t.force_tolerance = fields.number("force_tolerance", {0, 1, false, true});
  for (const char* key :
       {"speed_m_s", "normal_force_N", "speed_profile_m_s", "normal_force_profile_N", "position_profile", "steady_s"})
    fields.refuse(key, "does not belong to a take of kind pluck");
}

/// [a, b], two times within the take.
inline std::optional<std::pair<double, double>> read_span(toml_fields& fields, std::string_view key) {
  const auto* pair = fields.list(key, "a pair of times, as [1.5, 1.9]");
  if (pair == nullptr) return std::nullopt;
  if (pair->size() != 2) return fields.refuse(key, "must be a pair of times, as [1.5, 1.9]"), std::nullopt;
  const auto begin = fields.number_in(*pair->get(0), fields.path(key) + "[0]", zero_to(1e6)),
             end = fields.number_in(*pair->get(1), fields.path(key) + "[1]", zero_to(1e6));
  if (begin && end && *end <= *begin) fields.refuse(key, "ends before it begins");
  return begin && end ? std::optional{std::pair{*begin, *end}} : std::nullopt;
}

inline void read_bow(toml_fields& fields, take& t, const rig& r) {
  const bool forces = r.has_both_forces();
  for (const auto& [key, measured] : {std::pair{"speed_m_s", quantity::bow_speed}, {"normal_force_N", quantity::normal_force}})
    if (forces && !fields.has(key) && r.channel_of(measured) == nullptr) fields.missing(key);
  t.steady_s = read_span(fields, "steady_s");
  t.speed_m_s = fields.number("speed_m_s", up_to(100));
  t.normal_force_N = fields.number("normal_force_N", up_to(1e4));
  t.speed_profile_m_s = read_profile(fields, "speed_profile_m_s", {-100, 100});
  t.normal_force_profile_N = read_profile(fields, "normal_force_profile_N", zero_to(1e4));
  t.position_profile = read_profile(fields, "position_profile", inside_unit);
  for (const char* key : {"contact_position", "position_unknown"})
    if (!t.position_profile.empty() && fields.has(key))
      fields.refuse(key, "contradicts position_profile, which stands beside it");
  for (const char* key : {"force_N", "force_tolerance"}) fields.refuse(key, "does not belong to a take of kind bow");
}

inline void read_quiet(toml_fields& fields) {
  for (const char* key :
       {"force_N", "force_tolerance", "speed_m_s", "normal_force_N", "speed_profile_m_s", "normal_force_profile_N",
        "position_profile", "contact_position", "position_unknown", "strength", "start_s", "steady_s"})
    fields.refuse(key, "does not belong to a take of kind quiet");
}

/// Where the string is touched: of the take, of [contact], or declared unknown.
inline void read_place(toml_fields& fields, take& t, bool needed) {
  t.contact_position = fields.number("contact_position", inside_unit);
  t.position_unknown = fields.flag("position_unknown");
  t.strength = fields.number("strength", up_to(1e9));
  t.start_s = fields.number("start_s", zero_to(3600));
  if (t.position_unknown && t.contact_position)
    fields.refuse("position_unknown", "contradicts contact_position, which stands beside it");
  if (needed && !t.position_unknown && !fields.has("contact_position") && !fields.has("position_profile"))
    fields.log().add(fields.line(), fields.path("contact_position"), "is missing, and there is no [contact] position");
}

/// A table has to be told its rate, unless it has a column of times; a sound file tells its own.
inline void read_rate(toml_fields& fields, take& t, const files_section& files) {
  t.rate_Hz = fields.number("rate_Hz", {1, 1e9});
  if (t.file.empty()) return;
  const bool table = !table_ending(t.file).empty();
  if (!table) fields.refuse("rate_Hz", "belongs to a table of numbers: this file tells its own rate");
  if (table && !fields.has("rate_Hz") && !files.rate_Hz && !files.time_column)
    fields.log().add(fields.line(), fields.path("rate_Hz"),
                     "is missing, and there is neither [files] rate_Hz nor [files] time_column: a table does not tell its rate");
}

/// What the rig says of its channels, its [contact] and its [files] is read before.
inline take read_take(toml_fields fields, const rig& r) {
  const bool forces = r.has_both_forces(), placed = r.contact_position.has_value();
  take t;
  t.line = fields.line();
  t.name = fields.required_text("name").value_or("");
  t.file = fields.required_text("file").value_or("");
  read_rate(fields, t, r.files);
  t.hold_out = fields.flag("hold_out");
  if (!fields.has("kind")) fields.missing("kind");
  const auto kind = fields.choice("kind", take_kind_names);
  t.kind = kind ? static_cast<take_kind>(*kind) : take_kind::quiet;
  if (t.kind != take_kind::quiet) read_place(fields, t, forces && !placed);
  if (t.kind == take_kind::pluck) read_pluck(fields, t, forces);
  if (t.kind == take_kind::bow) read_bow(fields, t, r);
  if (kind && t.kind == take_kind::quiet) read_quiet(fields);
  if (kind) fields.unknown();  // without a kind, nobody can say which keys belong
  if (t.name.find_first_of("/\\") != std::string::npos) fields.refuse("name", "must not hold / or \\");
  if (std::any_of(t.name.begin(), t.name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
    fields.refuse("name", "must be one line, without control characters");
  if (t.file.starts_with('/')) fields.refuse("file", "must be a path relative to the folder of the rig file");
  return t;
}

/// Whether the takes are tables of numbers, all of them.
inline bool are_tables(const toml::table& root) {
  const auto* takes = root.get_as<toml::array>("take");
  const auto is_table = [](const toml::node& node) {
    const auto* take = node.as_table();
    const auto file = take != nullptr ? (*take)["file"].value<std::string>() : std::nullopt;
    return file && !table_ending(*file).empty();
  };
  return takes != nullptr && !takes->empty() && std::all_of(takes->begin(), takes->end(), is_table);
}

inline std::vector<take> read_takes(toml_fields& root, const rig& r) {
  std::vector<take> out;
  if (!root.has("take")) root.missing("take");
  root.each_table("take", "a list of tables, each headed [[take]]", [&](toml_fields fields) {
    take one = read_take(fields, r);
    for (const take& other : out)
      if (!one.name.empty() && one.name == other.name)
        fields.refuse("name", "\"" + one.name + "\" is the name of an earlier take, line " + std::to_string(other.line));
    out.push_back(std::move(one));
  });
  return out;
}

}  // namespace rosin::detail
