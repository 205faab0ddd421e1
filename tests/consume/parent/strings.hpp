// SPDX-License-Identifier: MIT
#pragma once

#include <rosin/propagate/band.hpp>

namespace strings {
double middle_of(const rosin::band& limits);
}
