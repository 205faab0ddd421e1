// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Header-only or compiled once: the same headers do for both.
//
// What is only ever used in double and works on matrices is a template all the same, so that its body is compiled where it is
// used and costs its parsing elsewhere. The line ROSIN_INSTANTIATE(signature) after such a function is nothing in a header-only
// program. In a program that links rosin::compiled (which defines ROSIN_COMPILED) it is an explicit instantiation declaration
// (extern template): the body stands in the library, whose sources, rosin/compiled/*.ipp, make it the definition.
//
#pragma once

#ifdef ROSIN_COMPILED
#ifndef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS extern
#endif
#ifndef ROSIN_INSTANTIATE_EXPORT  // an attribute, where the library is a shared one that hides everything else
#define ROSIN_INSTANTIATE_EXPORT
#endif
#define ROSIN_INSTANTIATE(...) ROSIN_INSTANTIATE_AS template ROSIN_INSTANTIATE_EXPORT __VA_ARGS__;
#else
#define ROSIN_INSTANTIATE(...)
#endif
