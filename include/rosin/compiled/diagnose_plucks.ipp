// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: the search for effects in plucks. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare is defined by other sources.
#include <rosin/diagnose/clock_drift_effect.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_candidates.hpp>
#include <rosin/diagnose/sympathetic_effect.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/diagnose/loosened_plucks.hpp>
#include <rosin/diagnose/odd_pluck.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/diagnose/pluck_exchange.hpp>
#include <rosin/diagnose/pluck_judgement.hpp>
#include <rosin/diagnose/pluck_prediction.hpp>
#include <rosin/diagnose/pluck_search.hpp>
#include <rosin/diagnose/rattle_effect.hpp>
#include <rosin/diagnose/rattling_string.hpp>
#include <rosin/diagnose/slow_noise.hpp>
