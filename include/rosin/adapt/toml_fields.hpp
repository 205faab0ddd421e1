// tier: hosted
// SPDX-License-Identifier: MIT
//
// A table of a TOML file read key by key. Each call says what the key must hold; what is missing, of another type or out
// of its range goes to the log with its line, and unknown() at the end reports every key that nobody asked for.
// Needs toml++ 3.
//
#pragma once

#include <rosin/adapt/problem_log.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/number_text.hpp>

#include <toml++/toml.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace rosin {

/// From low to high; the ends themselves are out where open.
struct value_range {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;

  [[nodiscard]] constexpr bool holds(double x) const noexcept {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
  [[nodiscard]] std::string text() const {
    if (low == -std::numeric_limits<double>::infinity()) return "must be a finite number";
    return std::string{"must be "} + (low_open ? "larger than " : "at least ") + number(low) +
           (high < std::numeric_limits<double>::infinity() ? (high_open ? " and less than " : " and at most ") + number(high)
                                                           : std::string{});
  }
  [[nodiscard]] static std::string number(double x) { return number_text(x, "%.9g"); }
};

/// Larger than zero and at most this.
[[nodiscard]] constexpr value_range up_to(double high) noexcept { return {0, high, true, false}; }
/// Zero or larger, and at most this.
[[nodiscard]] constexpr value_range zero_to(double high) noexcept { return {0, high, false, false}; }
/// Between 0 and 1, both excluded: a place on the string.
inline constexpr value_range inside_unit{0, 1, true, true};

class toml_fields {
public:
  toml_fields(const toml::table& table, std::string where, problem_log& log)
      : table_{&table}, where_{std::move(where)}, log_{&log} {}

  [[nodiscard]] int line() const noexcept { return line_of(*table_); }
  [[nodiscard]] const std::string& where() const noexcept { return where_; }
  [[nodiscard]] problem_log& log() const noexcept { return *log_; }
  [[nodiscard]] std::string path(std::string_view key) const {
    return where_.empty() ? std::string{key} : where_ + "." + std::string{key};
  }

  /// The node under the key, which counts as known from now on; null if there is none.
  const toml::node* find(std::string_view key) {
    known_.emplace_back(key);
    return table_->get(key);
  }
  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }

  std::optional<double> number(std::string_view key, const value_range& range) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    return number_in(*node, path(key), range);
  }
  double required_number(std::string_view key, const value_range& range) {
    if (!has(key)) missing(key);
    return number(key, range).value_or(range.holds(1) ? 1 : 0.5);
  }
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t low, std::int64_t high) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto* value = node->as_integer();
    if (value == nullptr) return wrong_type(*node, path(key), "a whole number"), std::nullopt;
    if (value->get() >= low && value->get() <= high) return value->get();
    problem(*node, path(key),
            "must be " + std::to_string(low) + " ... " + std::to_string(high) + ", is " + std::to_string(value->get()));
    return std::nullopt;
  }
  std::optional<std::string> text(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    const auto* value = node->as_string();
    if (value == nullptr) return wrong_type(*node, path(key), "a text in quotes"), std::nullopt;
    if (value->get().empty()) return problem(*node, path(key), "must not be empty"), std::nullopt;
    return value->get();
  }
  std::optional<std::string> required_text(std::string_view key) {
    if (!has(key)) missing(key);
    return text(key);
  }
  bool flag(std::string_view key) {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const auto* value = node->as_boolean();
    if (value == nullptr) return wrong_type(*node, path(key), "true or false"), false;
    return value->get();
  }
  /// One of some names, as its place in the list.
  template <class Names>
  std::optional<std::size_t> choice(std::string_view key, const Names& names) {
    const auto chosen = text(key);
    if (!chosen) return std::nullopt;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (*chosen == names[i]) return i;
    problem(*table_->get(key), path(key), "unknown name \"" + *chosen + "\"" + suggestion(*chosen, names));
    return std::nullopt;
  }
  /// A number at any place (an element of an array, say), checked and reported like a key's.
  std::optional<double> number_in(const toml::node& node, const std::string& place, const value_range& range) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value) return wrong_type(node, place, "a number"), std::nullopt;
    if (std::isfinite(*value) && range.holds(*value)) return value;
    problem(node, place, range.text() + ", is " + value_range::number(*value));
    return std::nullopt;
  }

  void missing(std::string_view key) { log_->add(line(), path(key), "is missing"); }
  void problem(const toml::node& node, const std::string& place, const std::string& reason) {
    log_->add(line_of(node), place, reason);
  }
  void wrong_type(const toml::node& node, const std::string& place, const std::string& wanted) {
    problem(node, place, "must be " + wanted);
  }
  /// The table under a key; null (and reported) where something else stands there.
  const toml::table* table(std::string_view key) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) wrong_type(*node, path(key), "a table");
    return node != nullptr ? node->as_table() : nullptr;
  }
  /// The array under a key; null (and reported, with an example) where something else stands there.
  const toml::array* list(std::string_view key, const std::string& wanted) {
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_array()) wrong_type(*node, path(key), wanted);
    return node != nullptr ? node->as_array() : nullptr;
  }
  /// Calls read(fields) for each table of a list of tables.
  template <class Read>
  void each_table(std::string_view key, const std::string& wanted, Read read) {
    const toml::array* tables = list(key, wanted);
    for (std::size_t i = 0; tables != nullptr && i < tables->size(); ++i) {
      const std::string place = path(key) + "[" + std::to_string(i) + "]";
      if (const auto* one = tables->get(i)->as_table()) read(toml_fields{*one, place, *log_});
      else wrong_type(*tables->get(i), place, "a table");
    }
  }

  /// A key that is known but has no meaning where it stands.
  void refuse(std::string_view key, const std::string& reason) {
    if (const toml::node* node = find(key)) problem(*node, path(key), reason);
  }
  /// To be called last: reports every key that no call has named.
  void unknown() {
    for (const auto& [key, node] : *table_)
      if (std::find(known_.begin(), known_.end(), key.str()) == known_.end())
        problem(node, path(key.str()), "unknown key" + suggestion(key.str(), known_));
  }

  [[nodiscard]] static int line_of(const toml::node& node) noexcept { return static_cast<int>(node.source().begin.line); }

private:
  const toml::table* table_;
  std::string where_;
  problem_log* log_;
  std::vector<std::string> known_;
};

}  // namespace rosin
