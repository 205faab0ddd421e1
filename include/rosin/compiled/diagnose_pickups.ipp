// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: the diagnosis of partials. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare is defined by other sources.
#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/math/spectrum_line.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/diagnose/pickup_effects.hpp>
#include <rosin/diagnose/pickup_glide_path.hpp>
#include <rosin/diagnose/pickup_greedy.hpp>
#include <rosin/diagnose/pickup_law_fit.hpp>
#include <rosin/diagnose/pickup_pair.hpp>
#include <rosin/diagnose/pickup_prediction.hpp>
#include <rosin/diagnose/pickup_ringing.hpp>
#include <rosin/diagnose/pickup_strays.hpp>
#include <rosin/diagnose/pickup_structure.hpp>
#include <rosin/diagnose/pickup_table.hpp>
