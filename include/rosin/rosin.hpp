// tier: hosted
// SPDX-License-Identifier: MIT
//
// The map of the library, in the order in which a signal meets it. Adapters to third-party packages
// (<rosin/adapt/…>: files, other FFTs) are included one by one, by whoever has the package. One line a header, hence so many.
//
//   acquire ─▶ condition ─▶ calibrate ─▶ propagate / reconstruct ─▶ torsion, friction ─▶ diagnose ─▶ report
//   the rig,    delays,      plucks or    the string from its ends   what the surface     physics     tables,
//   checks of   resampling,  strokes:     to the bow: force and      does; laws of the    that was    files
//   recordings  long FIRs    gains, Q     velocity there             bow's grip           left out
//   simulate: strings in motion    hardware: where frames come from and go to, and what moves the bow
//   ──────────── core (stage, pipeline, outcome) · math (FFT, chirp-z, Levenberg-Marquardt, robust losses) ────────────
//
#pragma once

#include <rosin/version.hpp>

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/core/pipeline.hpp>
#include <rosin/core/stage.hpp>

#include <rosin/math/at_once.hpp>
#include <rosin/math/block_transform.hpp>
#include <rosin/math/chirp_z.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/math/fft_policy.hpp>
#include <rosin/math/lane_fft.hpp>
#include <rosin/math/lanes.hpp>
#include <rosin/math/levenberg_marquardt.hpp>
#include <rosin/math/median.hpp>
#include <rosin/math/plain_complex.hpp>
#include <rosin/math/reweighted_regression.hpp>
#include <rosin/math/robust_loss.hpp>
#include <rosin/math/spectrum_line.hpp>

#include <rosin/acquire/checks.hpp>
#include <rosin/acquire/effect_names.hpp>
#include <rosin/acquire/finding.hpp>
#include <rosin/acquire/hum.hpp>
#include <rosin/acquire/magnitudes.hpp>
#include <rosin/acquire/pluck_checks.hpp>
#include <rosin/acquire/recording.hpp>
#include <rosin/acquire/release.hpp>
#include <rosin/acquire/rig.hpp>
#include <rosin/acquire/rig_values.hpp>
#include <rosin/acquire/ringing.hpp>
#include <rosin/acquire/sample_runs.hpp>
#include <rosin/acquire/signal_checks.hpp>
#include <rosin/acquire/stroke_checks.hpp>
#include <rosin/acquire/stroke_motion.hpp>

#include <rosin/condition/ac_coupling.hpp>
#include <rosin/condition/fourier_resampler.hpp>
#include <rosin/condition/fourier_shift.hpp>
#include <rosin/condition/fractional_delay.hpp>
#include <rosin/condition/fractional_delay_design.hpp>
#include <rosin/condition/held_record.hpp>
#include <rosin/condition/low_pass.hpp>
#include <rosin/condition/overlap_save.hpp>
#include <rosin/condition/overlap_save_design.hpp>
#include <rosin/condition/record_at.hpp>
#include <rosin/condition/record_delay.hpp>

#include <rosin/calibrate/band_kernels.hpp>
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/damped_lines.hpp>
#include <rosin/calibrate/damped_spectrum.hpp>
#include <rosin/calibrate/end_descent.hpp>
#include <rosin/calibrate/end_fit.hpp>
#include <rosin/calibrate/end_problem.hpp>
#include <rosin/calibrate/end_search.hpp>
#include <rosin/calibrate/free_decay.hpp>
#include <rosin/calibrate/loss_scatter.hpp>
#include <rosin/calibrate/moving_string.hpp>
#include <rosin/calibrate/own_losses.hpp>
#include <rosin/calibrate/partial_baseband.hpp>
#include <rosin/calibrate/partial_choice.hpp>
#include <rosin/calibrate/partial_line.hpp>
#include <rosin/calibrate/partial_search.hpp>
#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/calibrate/pickup_glide.hpp>
#include <rosin/calibrate/pickup_loss.hpp>
#include <rosin/calibrate/pickup_pitch.hpp>
#include <rosin/calibrate/pickup_regression.hpp>
#include <rosin/calibrate/pickup_string.hpp>
#include <rosin/calibrate/plain_plucks.hpp>
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/calibrate/pluck_layout.hpp>
#include <rosin/calibrate/pluck_model.hpp>
#include <rosin/calibrate/pluck_options.hpp>
#include <rosin/calibrate/pluck_problem.hpp>
#include <rosin/calibrate/pluck_start.hpp>
#include <rosin/calibrate/stroke_calibration.hpp>
#include <rosin/calibrate/stroke_fit.hpp>
#include <rosin/calibrate/stroke_layout.hpp>
#include <rosin/calibrate/stroke_noise.hpp>
#include <rosin/calibrate/stroke_problem.hpp>
#include <rosin/calibrate/stroke_scale.hpp>
#include <rosin/calibrate/stroke_spectra.hpp>
#include <rosin/calibrate/stroke_start.hpp>
#include <rosin/calibrate/uneven_string.hpp>

#include <rosin/propagate/airy_kernel.hpp>
#include <rosin/propagate/band.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/propagate/complex_dispersion.hpp>
#include <rosin/propagate/dispersion.hpp>
#include <rosin/propagate/fir.hpp>
#include <rosin/propagate/string_parameters.hpp>
#include <rosin/propagate/termination.hpp>
#include <rosin/propagate/termination_modes.hpp>
#include <rosin/propagate/termination_table.hpp>
#include <rosin/propagate/transmission.hpp>

#include <rosin/reconstruct/bow_point_transfer.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/dc_level.hpp>
#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/reconstruct/end_sensitivity.hpp>
#include <rosin/reconstruct/end_weights.hpp>
#include <rosin/reconstruct/fine_tune.hpp>
#include <rosin/reconstruct/passage_design.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>
#include <rosin/reconstruct/passage_sums.hpp>
#include <rosin/reconstruct/periodic_part.hpp>
#include <rosin/reconstruct/periodic_reconstruction.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/reconstruct/sensitivity.hpp>
#include <rosin/reconstruct/streaming_design.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>
#include <rosin/reconstruct/stroke_doubts.hpp>
#include <rosin/reconstruct/uncertainty.hpp>
#include <rosin/reconstruct/whole_record.hpp>

#include <rosin/torsion/contact_signal.hpp>
#include <rosin/torsion/rod_approach.hpp>
#include <rosin/torsion/stick_data.hpp>
#include <rosin/torsion/stick_regression.hpp>
#include <rosin/torsion/torsion_fit.hpp>
#include <rosin/torsion/torsion_modes.hpp>
#include <rosin/torsion/torsion_pair.hpp>
#include <rosin/torsion/torsion_response.hpp>

#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/creep.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/enhanced_thermal.hpp>
#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/friction_law.hpp>
#include <rosin/friction/slip_loops.hpp>
#include <rosin/friction/slip_phases.hpp>
#include <rosin/friction/slip_samples.hpp>
#include <rosin/friction/slip_watch.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>

#include <rosin/simulate/burdened_sensors.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/burdened_string.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/energy_account.hpp>
#include <rosin/simulate/modal_bank.hpp>
#include <rosin/simulate/modal_contact.hpp>
#include <rosin/simulate/modal_decimator.hpp>
#include <rosin/simulate/modal_low_pass.hpp>
#include <rosin/simulate/modal_pluck.hpp>
#include <rosin/simulate/modal_string.hpp>
#include <rosin/simulate/modal_stroke.hpp>
#include <rosin/simulate/modal_take.hpp>
#include <rosin/simulate/mode_step.hpp>
#include <rosin/simulate/moving_load.hpp>
#include <rosin/simulate/moving_support.hpp>
#include <rosin/simulate/point_modes.hpp>
#include <rosin/simulate/port_bank.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/random_rig.hpp>
#include <rosin/simulate/regime.hpp>
#include <rosin/simulate/stroke_energy.hpp>
#include <rosin/simulate/travelling_design.hpp>
#include <rosin/simulate/travelling_string.hpp>
#include <rosin/simulate/wave_design.hpp>
#include <rosin/simulate/wave_echo.hpp>
#include <rosin/simulate/wave_end.hpp>
#include <rosin/simulate/wave_kernels.hpp>
#include <rosin/simulate/wave_local.hpp>
#include <rosin/simulate/wave_loop.hpp>
#include <rosin/simulate/wave_pluck.hpp>
#include <rosin/simulate/wave_settings.hpp>
#include <rosin/simulate/wave_string.hpp>
#include <rosin/simulate/wave_stroke.hpp>
#include <rosin/simulate/wave_way.hpp>

#include <rosin/diagnose/bristle_yield.hpp>
#include <rosin/diagnose/clock_drift_effect.hpp>
#include <rosin/diagnose/contact_as_one.hpp>
#include <rosin/diagnose/contact_bristles.hpp>
#include <rosin/diagnose/contact_cycle.hpp>
#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/diagnose/contact_ripple.hpp>
#include <rosin/diagnose/contact_slip_effects.hpp>
#include <rosin/diagnose/contact_stick.hpp>
#include <rosin/diagnose/contact_stick_effects.hpp>
#include <rosin/diagnose/contact_take.hpp>
#include <rosin/diagnose/contact_width.hpp>
#include <rosin/diagnose/corrected_take.hpp>
#include <rosin/diagnose/even_tension.hpp>
#include <rosin/diagnose/friction_laws.hpp>
#include <rosin/diagnose/hum_effect.hpp>
#include <rosin/diagnose/isolability.hpp>
#include <rosin/diagnose/law_choice.hpp>
#include <rosin/diagnose/loaded_motion.hpp>
#include <rosin/diagnose/loosened_plucks.hpp>
#include <rosin/diagnose/lost_level.hpp>
#include <rosin/diagnose/mismatch_class.hpp>
#include <rosin/diagnose/mismatch_map.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/odd_pluck.hpp>
#include <rosin/diagnose/pickup_diagnosis.hpp>
#include <rosin/diagnose/pickup_effects.hpp>
#include <rosin/diagnose/pickup_findings.hpp>
#include <rosin/diagnose/pickup_glide_path.hpp>
#include <rosin/diagnose/pickup_greedy.hpp>
#include <rosin/diagnose/pickup_law_fit.hpp>
#include <rosin/diagnose/pickup_pair.hpp>
#include <rosin/diagnose/pickup_poles.hpp>
#include <rosin/diagnose/pickup_prediction.hpp>
#include <rosin/diagnose/pickup_ringing.hpp>
#include <rosin/diagnose/pickup_strays.hpp>
#include <rosin/diagnose/pickup_structure.hpp>
#include <rosin/diagnose/pickup_table.hpp>
#include <rosin/diagnose/pluck_candidates.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/diagnose/pluck_effect.hpp>
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/pluck_exchange.hpp>
#include <rosin/diagnose/pluck_judgement.hpp>
#include <rosin/diagnose/pluck_order.hpp>
#include <rosin/diagnose/pluck_prediction.hpp>
#include <rosin/diagnose/pluck_scene.hpp>
#include <rosin/diagnose/pluck_score.hpp>
#include <rosin/diagnose/pluck_search.hpp>
#include <rosin/diagnose/rattle_effect.hpp>
#include <rosin/diagnose/rattling_string.hpp>
#include <rosin/diagnose/rod_beside_bristles.hpp>
#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/diagnose/scene_lines.hpp>
#include <rosin/diagnose/scene_plucks.hpp>
#include <rosin/diagnose/sensor_chain.hpp>
#include <rosin/diagnose/slip_bench.hpp>
#include <rosin/diagnose/slip_record.hpp>
#include <rosin/diagnose/slow_noise.hpp>
#include <rosin/diagnose/stick_columns.hpp>
#include <rosin/diagnose/stick_design.hpp>
#include <rosin/diagnose/stretching_pluck.hpp>
#include <rosin/diagnose/string_poles.hpp>
#include <rosin/diagnose/string_response.hpp>
#include <rosin/diagnose/string_side.hpp>
#include <rosin/diagnose/stroke_place.hpp>
#include <rosin/diagnose/strong_starts.hpp>
#include <rosin/diagnose/sympathetic_effect.hpp>
#include <rosin/diagnose/tension_drift.hpp>
#include <rosin/diagnose/tone_band.hpp>
#include <rosin/diagnose/wide_record.hpp>
#include <rosin/diagnose/width_and_drift.hpp>
#include <rosin/diagnose/wire_effects.hpp>

#include <rosin/hardware/capture.hpp>
#include <rosin/hardware/cobs.hpp>
#include <rosin/hardware/crc32.hpp>
#include <rosin/hardware/deadline.hpp>
#include <rosin/hardware/frame_packet.hpp>
#include <rosin/hardware/frame_ring.hpp>
#include <rosin/hardware/frames.hpp>
#include <rosin/hardware/grbl_lines.hpp>
#include <rosin/hardware/grbl_protocol.hpp>
#include <rosin/hardware/grbl_simulator.hpp>
#include <rosin/hardware/level_meter.hpp>
#include <rosin/hardware/level_trigger.hpp>
#include <rosin/hardware/line_witness.hpp>
#include <rosin/hardware/paced_source.hpp>
#include <rosin/hardware/packet_decoder.hpp>
#include <rosin/hardware/wav_header.hpp>

#if __has_include(<termios.h>)  // POSIX: descriptors and serial lines
#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/csv_sink.hpp>
#include <rosin/hardware/durable_text.hpp>
#include <rosin/hardware/file_lock.hpp>
#include <rosin/hardware/grbl_stage.hpp>
#include <rosin/hardware/pseudo_terminal.hpp>
#include <rosin/hardware/serial_source.hpp>
#include <rosin/hardware/take_file.hpp>
#endif

#include <rosin/report/csv.hpp>
#include <rosin/report/input_file.hpp>
#include <rosin/report/npy.hpp>
#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>
