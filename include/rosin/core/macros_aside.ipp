// tier: freestanding
// SPDX-License-Identifier: MIT
//
// windows.h and other old headers define macros of ordinary words. A header that uses one of these words includes this file behind
// its other includes and macros_back.ipp at its end: between the two the word is a word, and outside it is what it was. (No #pragma once.)
//
#pragma push_macro("near")
#pragma push_macro("far")
#pragma push_macro("min")
#pragma push_macro("max")
#undef near
#undef far
#undef min
#undef max
