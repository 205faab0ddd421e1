// SPDX-License-Identifier: MIT
#include "take_plan.hpp"
#include "simulate_declaration.hpp"

#include <rosin/adapt/rig_toml.hpp>
#include <rosin/hardware/durable_text.hpp>

#include <locale>
#include <sstream>

namespace tool {

namespace {

namespace fs = std::filesystem;

/// Without [[take]] tables; what is indented or commented between them goes too.
std::string without_takes(const std::string& text) {
  std::istringstream lines{text};
  std::string out;
  bool in_take = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("[[take]]")) in_take = true;
    else if (line.starts_with('[')) in_take = false;
    if (!in_take) out += line + '\n';
  }
  while (out.ends_with("\n\n")) out.pop_back();
  return out;
}

/// The same whatever way the takes are written in, [[ take ]] or in line: what the lines do not tell apart is written anew.
rosin::outcome<std::string> declared_without_takes(const std::string& text, const std::string& file) {
  auto root = rosin::detail::parse_toml(text, file);
  if (!root) return rosin::failure{root.error()};
  root->erase("take");
  std::string out = without_takes(text);
  if (const auto again = rosin::detail::parse_toml(out, file); again && *again == *root) return out;
  std::ostringstream anew;
  anew.imbue(std::locale::classic());
  anew << *root << '\n';
  return std::move(anew).str();
}

std::string figure(double x) {
  std::string out = rosin::number_text(x, "%.9g");
  if (out.find_first_of(".en") == std::string::npos) out += ".0";
  return out;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f) {
      constexpr std::string_view digits = "0123456789abcdef";
      out += std::string{"\\u00"} + digits[code >> 4U] + digits[code & 15U];
    } else {
      out += (c == '"' || c == '\\' ? "\\" : "") + std::string{c};
    }
  }
  return out + '"';
}

std::string block(const take_plan& t, const std::vector<std::string>& remarks) {
  std::string out = "\n[[take]]\nname = " + quoted(t.name) + "\nkind = " + quoted(t.kind) + "\nfile = " + quoted(t.file()) + '\n';
  const auto value = [&](const char* key, const std::optional<double>& x) {
    if (x) out += std::string{key} + " = " + figure(*x) + '\n';
  };
  value("force_N", t.force_N);
  value("force_tolerance", t.force_tolerance);
  value("contact_position", t.position);
  value("speed_m_s", t.speed_m_s);
  value("normal_force_N", t.normal_force_N);
  if (t.hold_out) out += "hold_out = true\n";
  for (const auto& r : remarks) out += "# " + r + '\n';
  return out;
}

}  // namespace

void add_take_options(CLI::App& command, take_plan& given) {
  command.add_option("--take", given.name, "Name of the take; KIND-1, KIND-2, ... if left out")->type_name("NAME");
  command.add_option("--kind", given.kind, "pluck, bow or quiet")
      ->check(CLI::IsMember({"pluck", "bow", "quiet"}))
      ->capture_default_str();
  command.add_option("--wire", given.force_N, "Of a pluck: nominal breaking force of the wire")
      ->type_name("N")
      ->check(positive());
  command.add_option("--wire-tolerance", given.force_tolerance, "Its relative tolerance")->check(between(0.0, 1.0));
  command.add_option("--position", given.position, "Of bow or pluck, where it is not the rig's [contact]")
      ->check(between(0.0, 1.0));
  command.add_option("--speed", given.speed_m_s, "Of a bow: the sled's speed once it is steady")
      ->type_name("M/S")
      ->check(positive());
  command.add_option("--normal-force", given.normal_force_N, "Of a bow: force of the rod on the string")
      ->type_name("N")
      ->check(positive());
  command.add_flag("--hold-out", given.hold_out, "Never fitted, only predicted");
}

rosin::outcome<rig_file_writer> rig_file_writer::open(const std::string& folder, const std::string& like) {
  rig_file_writer out;
  out.folder_ = folder;
  std::error_code error;
  const bool there = fs::exists(out.path(), error);
  if (there && !like.empty()) return rosin::failure{out.path() + ": exists already; --like is for a new rig"};
  if (!there && like.empty())
    return rosin::failure{out.path() + ": is not there; --like names a rig file that describes string and channels"};
  const std::string from = there ? out.path() : fs::is_directory(like, error) ? like + "/rig.toml" : like;
  auto text = rosin::read_file(from);
  if (!text) return rosin::failure{text.error()};
  out.text_ = *std::move(text);
  if (!there) {
    auto declared = declaration(out.text_, from);
    if (!declared) return rosin::failure{declared.error()};
    auto string_and_channels = declared_without_takes(*declared, from);
    if (!string_and_channels) return rosin::failure{string_and_channels.error()};
    out.text_ = *std::move(string_and_channels);
    fs::create_directories(folder, error);
    if (error) return rosin::failure{folder + ": " + error.message()};
  }
  out.latest_ = out.text_;
  return out;
}

std::string rig_file_writer::free_name(const std::string& kind) const {
  for (int i = 1;; ++i) {
    const std::string name = kind + "-" + std::to_string(i);
    std::error_code ignored;
    if (latest_.find("\"" + name + "\"") == std::string::npos && !fs::exists(folder_ + "/" + name + ".wav", ignored)) return name;
  }
}

rosin::outcome<rosin::rig> rig_file_writer::with(const take_plan& take) const {
  auto rig = rosin::parse_rig(text_ + block(take, {}), path());
  const bool unfinished = take.kind == "bow"     ? !take.speed_m_s || !take.normal_force_N
                          : take.kind == "pluck" ? !take.force_N
                                                 : false;
  take_plan finished = take;
  finished.speed_m_s = finished.normal_force_N = finished.force_N = std::nullopt;
  if (take.kind == "bow") finished.speed_m_s = finished.normal_force_N = 1;
  if (take.kind == "pluck") finished.force_N = 1;
  if (!rig && unfinished && rosin::parse_rig(text_ + block(finished, {}), path()))  // nothing else is amiss
    return rosin::failure{take.kind == "bow" ? "a bowed take needs --speed and --normal-force"
                                             : "a pluck needs --wire, its nominal force"};
  return rig;
}

std::optional<rosin::failure> rig_file_writer::put(const take_plan& take, const std::vector<std::string>& remarks) {
  latest_ = text_ + block(take, remarks);
  return rosin::replace_durably(path(), latest_);
}

}  // namespace tool
