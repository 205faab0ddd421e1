// SPDX-License-Identifier: MIT
//
// A source of rosin::compiled: calibration from plucks, a pickup or free decays, and what lies below. Whoever builds without CMake includes this file
// in one source file of a program that has ROSIN_COMPILED defined throughout.
//
#include <rosin/core/instantiate.hpp>

// What these declare by ROSIN_INSTANTIATE is defined here.
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS

#include <rosin/acquire/checks.hpp>
#include <rosin/acquire/ringing.hpp>
#include <rosin/acquire/stroke_motion.hpp>
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/damped_lines.hpp>
#include <rosin/calibrate/damped_spectrum.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/calibrate/end_search.hpp>
#include <rosin/calibrate/free_decay.hpp>
#include <rosin/calibrate/partial_choice.hpp>
#include <rosin/calibrate/partial_line.hpp>
#include <rosin/calibrate/partial_search.hpp>
#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/calibrate/pickup_glide.hpp>
#include <rosin/calibrate/pickup_loss.hpp>
#include <rosin/calibrate/pickup_pitch.hpp>
#include <rosin/calibrate/pickup_regression.hpp>
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/calibrate/stroke_calibration.hpp>
#include <rosin/calibrate/stroke_fit.hpp>
#include <rosin/friction/slip_samples.hpp>
#include <rosin/math/spectrum_line.hpp>
#include <rosin/propagate/airy_kernel.hpp>
