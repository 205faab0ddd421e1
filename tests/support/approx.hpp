// SPDX-License-Identifier: MIT
#pragma once

#include <doctest/doctest.h>

namespace test {

/// Within a relative epsilon() of a value. (doctest's own allows epsilon (1 + |value|), which nothing small can miss.) Of zero:
/// say scale(), too.
inline doctest::Approx approx(double value) { return doctest::Approx(value).scale(0); }

}  // namespace test
