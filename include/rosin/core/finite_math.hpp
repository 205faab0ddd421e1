// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What handles values that are no numbers (a gap of a table, a sample that cannot be known, bad data that is to be refused) needs a
// compiler that knows of them: with -ffinite-math-only, which is part of -ffast-math and -Ofast, std::isfinite is always true and bad
// data would pass in silence. Headers that use such values include this one and do not compile then; all others work with any flags.
//
#pragma once

#if (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0) || defined(_M_FP_FAST)
#error "rosin: NaN has to be told from numbers here, which -ffast-math (or /fp:fast) forbids: add -fno-finite-math-only"
#endif
