// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: plucked strings with effects of the catalogue. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare is defined by other sources.
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/calibrate/partial_search.hpp>
#include <rosin/math/spectrum_line.hpp>
#include <rosin/propagate/airy_kernel.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/diagnose/clock_drift_effect.hpp>
#include <rosin/diagnose/corrected_take.hpp>
#include <rosin/diagnose/hum_effect.hpp>
#include <rosin/diagnose/isolability.hpp>
#include <rosin/diagnose/loaded_motion.hpp>
#include <rosin/diagnose/mismatch_class.hpp>
#include <rosin/diagnose/mismatch_map.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_candidates.hpp>
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/pluck_order.hpp>
#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/diagnose/string_poles.hpp>
#include <rosin/diagnose/string_response.hpp>
#include <rosin/diagnose/strong_starts.hpp>
#include <rosin/diagnose/sympathetic_effect.hpp>
#include <rosin/diagnose/wire_effects.hpp>
