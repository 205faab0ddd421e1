// SPDX-License-Identifier: MIT
// All headers behind windows.h, with its macros as they come (near, far, ...). Adapters of packages and POSIX are not asked of Windows.
#include <windows.h>

#include <rosin/rosin.hpp>

int main() {
  const rosin::string_parameters string{.length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660};
  rosin::reconstructor<double> reconstruct(rosin::contact_at(string, 0.3), rosin::band{20e3, 40e3}, 128e3);
  return reconstruct(std::vector<double>(4000), std::vector<double>(4000)).force_near_N.empty() ? 1 : 0;
}
