// SPDX-License-Identifier: MIT
//
// Included first where all headers, and the tool, are compiled: what would write or read a number as the locale of the program has it
// does not compile there (core/number_text.hpp does it). printf and its like are looked for by tests/architecture/locale.cmake.
//
#pragma once

#include <cstddef>

#ifdef __GLIBCXX__
#include <bits/stringfwd.h>  // before <string>: a definition takes no attribute any more

namespace std {
// clang-format off
inline _GLIBCXX_BEGIN_NAMESPACE_CXX11
[[deprecated("asks the locale; rosin::number_text does not")]] string to_string(float);
[[deprecated("asks the locale; rosin::number_text does not")]] string to_string(double);
[[deprecated("asks the locale; rosin::number_text does not")]] string to_string(long double);
[[deprecated("asks the locale; rosin::number_from does not")]] float stof(const string&, size_t*);
[[deprecated("asks the locale; rosin::number_from does not")]] double stod(const string&, size_t*);
[[deprecated("asks the locale; rosin::number_from does not")]] long double stold(const string&, size_t*);
_GLIBCXX_END_NAMESPACE_CXX11
// clang-format on
}  // namespace std
#endif
