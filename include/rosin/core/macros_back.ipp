// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What macros_aside.ipp put aside is back.
//
#pragma pop_macro("max")
#pragma pop_macro("min")
#pragma pop_macro("far")
#pragma pop_macro("near")
