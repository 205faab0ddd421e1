// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: simulators, reconstruction and torsion. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare is defined by other sources.
#include <rosin/calibrate/damped_lines.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/reconstruct/periodic_part.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/travelling_design.hpp>
#include <rosin/simulate/wave_design.hpp>
#include <rosin/simulate/wave_loop.hpp>
#include <rosin/torsion/rod_approach.hpp>
#include <rosin/torsion/stick_data.hpp>
#include <rosin/torsion/stick_regression.hpp>
#include <rosin/torsion/torsion_fit.hpp>
