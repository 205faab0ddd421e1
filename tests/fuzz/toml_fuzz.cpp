// SPDX-License-Identifier: MIT
//
// Any bytes as a rig file: either a rig whose derived values are finite, or a failure that names the file in every line.
//
#include <rosin/acquire/rig_values.hpp>
#include <rosin/adapt/rig_toml.hpp>

#include <cstdlib>

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_failure(const std::string& message) {
  require(!message.empty());
  std::istringstream lines{message};
  for (std::string line; std::getline(lines, line);) require(line.starts_with("rig.toml:"));
}

void check_rig(const rosin::rig& r) {
  require(r.string.fundamental_Hz > 0 && !r.channels.empty() && !r.takes.empty());
  for (const auto& c : r.channels) require(c.index >= 0);
  const auto values = rosin::values_of(r);
  if (values.impedance_Ns_m) require(std::isfinite(values.impedance_Ns_m->value) && values.impedance_Ns_m->value > 0);
  if (r.has_both_forces()) require(values.length_m && values.tension_N && values.impedance_Ns_m);
  for (const auto& t : r.takes)
    if (const auto position = r.position_of(t)) require(*position > 0 && *position < 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const auto r = rosin::parse_rig({reinterpret_cast<const char*>(data), size}, "rig.toml");
  if (r) check_rig(*r);
  else check_failure(r.error());
  return 0;
}
