// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: the diagnosis of strokes. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare is defined by other sources.
#include <rosin/calibrate/calibration.hpp>
#include <rosin/friction/slip_samples.hpp>
#include <rosin/propagate/airy_kernel.hpp>
#include <rosin/torsion/torsion_fit.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/diagnose/contact_as_one.hpp>
#include <rosin/diagnose/contact_bristles.hpp>
#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/diagnose/contact_ripple.hpp>
#include <rosin/diagnose/contact_slip_effects.hpp>
#include <rosin/diagnose/contact_stick_effects.hpp>
#include <rosin/diagnose/contact_take.hpp>
#include <rosin/diagnose/contact_width.hpp>
#include <rosin/diagnose/friction_laws.hpp>
#include <rosin/diagnose/law_choice.hpp>
#include <rosin/diagnose/lost_level.hpp>
#include <rosin/diagnose/rod_beside_bristles.hpp>
#include <rosin/diagnose/slip_record.hpp>
#include <rosin/diagnose/stick_design.hpp>
#include <rosin/diagnose/tone_band.hpp>
#include <rosin/diagnose/width_and_drift.hpp>
