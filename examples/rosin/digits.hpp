// SPDX-License-Identifier: MIT
//
// Numbers as the tool says them.
//
#pragma once

#include <rosin/core/number_text.hpp>

#include <limits>
#include <string>

namespace tool {

/// A number that is not known.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// A number as printf's form says it.
inline std::string in_digits(double x, const char* form = "%.3g") { return rosin::number_text(x, form); }

}  // namespace tool
