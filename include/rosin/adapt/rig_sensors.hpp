// tier: hosted
// SPDX-License-Identifier: MIT
//
// [channels] and [terminations] of a rig file: what is screwed to the two ends of the string, and what else listens.
//
#pragma once

#include <rosin/acquire/rig.hpp>
#include <rosin/adapt/toml_fields.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

/// The key that calibrates a channel, in the unit of its quantity; empty for those that have none.
inline std::string_view scale_key(quantity what) noexcept {
  switch (what) {
    case quantity::termination_force:
    case quantity::normal_force:
      return "newtons_per_full_scale";
    case quantity::string_velocity:
    case quantity::bow_speed:
      return "metres_per_second_per_full_scale";
    case quantity::string_displacement:
      return "metres_per_full_scale";
    case quantity::sound:
      return "pascals_per_full_scale";
    case quantity::unused:
      break;
  }
  return {};
}

/// near and far measure the force on a termination, and nothing else does.
inline quantity read_quantity(toml_fields& fields, const std::string& name) {
  const bool termination = name == "near" || name == "far";
  if (!termination && !fields.has("quantity")) fields.missing("quantity");
  const auto chosen = fields.choice("quantity", quantity_names);
  const auto what = chosen ? static_cast<quantity>(*chosen) : termination ? quantity::termination_force : quantity::unused;
  if (chosen && termination != (what == quantity::termination_force))
    fields.refuse("quantity", "the channels near and far, and only they, measure termination-force");
  return what;
}

/// The one scale that belongs to the quantity; any other is refused by name. Tables are in SI units where none is given.
inline void read_scale(toml_fields& fields, sensor_channel& c, bool tables) {
  const std::string_view own = scale_key(c.quantity);
  if (c.quantity == quantity::termination_force && !tables && !fields.has(own)) fields.missing(own);
  for (const std::string_view key :
       {"newtons_per_full_scale", "metres_per_second_per_full_scale", "metres_per_full_scale", "pascals_per_full_scale"}) {
    if (key == own) c.per_full_scale = fields.number(key, up_to(1e9));
    else if (fields.has(key)) fields.refuse(key, "is no scale of the quantity " + name_of(c.quantity));
  }
  const bool measures_bow = c.quantity == quantity::normal_force || c.quantity == quantity::bow_speed;
  c.scale_assumed = tables && !fields.has(own) && (measures_bow || c.quantity == quantity::termination_force);
  if (c.scale_assumed) c.per_full_scale = 1;
}

/// By its place among the columns, or by its name in a table (`variable` in a file of variables).
inline void read_column(toml_fields& fields, sensor_channel& c) {
  c.index = static_cast<int>(fields.integer("index", 0, 1023).value_or(-1));
  std::string_view told = fields.has("index") ? "index" : "";
  for (const char* key : {"column", "variable"}) {
    const auto name = fields.text(key);
    if (!fields.has(key)) continue;
    if (!told.empty()) fields.refuse(key, "contradicts " + std::string{told} + ", which stands beside it");
    else c.column = name.value_or("");
    told = key;
  }
  if (told.empty()) fields.missing("index");
}

inline sensor_channel read_channel(const std::string& name, toml_fields fields, bool tables) {
  sensor_channel c;
  c.name = name;
  c.line = fields.line();
  read_column(fields, c);
  c.quantity = read_quantity(fields, name);
  read_scale(fields, c, tables);
  c.gain_tolerance = fields.number("gain_tolerance", {0, 1, false, true});
  c.ac_coupled_Hz = fields.number("ac_coupled_Hz", up_to(1e4));
  if (c.quantity == quantity::string_velocity || c.quantity == quantity::string_displacement)
    c.position = fields.number("position", inside_unit);
  else fields.refuse("position", "only a channel that measures the string's motion has a position");
  fields.unknown();
  return c;
}

/// `tables`: the takes are tables of numbers.
inline std::vector<sensor_channel> read_channels(toml_fields fields, const toml::table& table, bool tables) {
  std::vector<sensor_channel> out;
  for (const auto& [key, node] : table) {
    const std::string name{key.str()};
    if (const auto* one = node.as_table()) out.push_back(read_channel(name, {*one, fields.path(name), fields.log()}, tables));
    else fields.wrong_type(node, fields.path(name), "a table, as { index = 0, ... }");
  }
  if (table.empty()) fields.log().add(fields.line(), fields.where(), "names no channel");
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.index < b.index; });
  for (std::size_t i = 1; i < out.size(); ++i)
    if (out[i].index >= 0 && out[i].index == out[i - 1].index)
      fields.log().add(std::max(out[i].line, out[i - 1].line), fields.path(out[i].name) + ".index",
                       "is " + std::to_string(out[i].index) + ", as that of " + out[i - 1].name);
  return out;
}

inline std::vector<termination_mode> read_modes(toml_fields fields) {
  std::vector<termination_mode> out;
  if (!fields.has("modes")) fields.missing("modes");
  fields.each_table("modes", "a list, as [ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ]", [&](toml_fields mode) {
    out.push_back({mode.required_number("frequency_Hz", up_to(1e6)), mode.required_number("q", {0.5, 1e6}),
                   mode.required_number("mass_kg", up_to(1e4))});
    mode.unknown();
  });
  const toml::node* node = fields.find("modes");
  if (node != nullptr && node->is_array() && node->as_array()->empty()) fields.refuse("modes", "is empty");
  fields.unknown();
  return out;
}

/// "rigid", "fit", { modes = [...] }, or the name of a file.
inline std::optional<termination> read_termination(toml_fields& fields, std::string_view end) {
  const toml::node* node = fields.find(end);
  if (node == nullptr) return std::nullopt;
  termination out;
  if (const auto* table = node->as_table()) {
    out.kind = termination::form::modes;
    out.modes = read_modes({*table, fields.path(end), fields.log()});
  } else if (const auto text = fields.text(end)) {
    if (*text == "fit") out.kind = termination::form::fit;
    else if (*text != "rigid") {
      out.kind = termination::form::table;
      out.file = *text;
    }
  }
  return out;
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
