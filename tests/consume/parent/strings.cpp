// SPDX-License-Identifier: MIT
#include "strings.hpp"

#include <rosin/propagate/airy_kernel.hpp>

double strings::middle_of(const rosin::band& limits) { return limits((limits.pass_Hz + limits.stop_Hz) / 2); }
