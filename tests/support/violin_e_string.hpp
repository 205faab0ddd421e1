// SPDX-License-Identifier: MIT
//
// The string of Woodhouse, Schumacher & Garoff (2000), with the torsion of their simulation.
//
#pragma once

#include <rosin/simulate/modal_string.hpp>

namespace test {

inline const rosin::modal_rig violin_e_string{.string = {.length_m = 0.314,
                                                         .tension_N = 72.5,
                                                         .fundamental_Hz = 660,
                                                         .bending_stiffness_Nm2 = 4.7e-5,
                                                         .loss = {.quality = 1000}},
                                              .torsion = {7, 3.5, 15}};

}  // namespace test
