// SPDX-License-Identifier: MIT
#include "reconstruct_take.hpp"
#include "digits.hpp"
#include "reconstruct_channels.hpp"

namespace tool {

namespace {

/// Loss is compensated, which multiplies what the fit takes for loss: a fit that went astray must not drown the result.
void limit_loss(rosin::calibration& c, const rosin::band& limits, std::vector<std::string>& warnings) {
  const double f = limits.stop_Hz, longest = std::max(c.at.delay_s[0], c.at.delay_s[1]);
  const double gain = std::exp(std::numbers::pi * f * longest * c.at.loss.inverse_q(f));
  if (gain > 0.5 && gain < 5) return;
  warnings.push_back("the fitted loss would change the band's end by a factor of " + in_digits(gain, "%.2g") +
                     " on its way: no string does that; taken as Q = 1000");
  c.at.loss = {rosin::detail::default_quality, 0, 0};
  for (const Eigen::Index p : {3, 4}) {
    c.covariance.row(p).setZero();
    c.covariance.col(p).setZero();
  }
}

/// The calibration for this contact, moved from the nearest pluck where none was at the same place.
rosin::calibration calibration_at(const calibration_set& set, double declared, double position_sd,
                                  std::vector<std::string>& warnings) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < set.at.size(); ++i)
    if (std::abs(set.declared[i] - declared) < std::abs(set.declared[nearest] - declared)) nearest = i;
  rosin::calibration c = set.at[nearest];
  if (c.at.stiffness_s2 < 0) {  // an ideal string, but for the fit's error; or no string at all
    if (c.at.stiffness_s2 * c.at.stiffness_s2 > 9 * c.covariance(2, 2))
      warnings.emplace_back("the fitted bending stiffness is negative beyond its error: taken as 0");
    c.at.stiffness_s2 = 0;
  }
  const double shift = declared - set.declared[nearest];
  if (std::abs(shift) < 1e-9) return c;
  const double one_way = c.at.delay_s[0] + c.at.delay_s[1], doubt = position_sd * std::sqrt(2.0) * one_way;
  c.position += shift;
  c.at.delay_s[0] += shift * one_way;
  c.at.delay_s[1] -= shift * one_way;
  c.covariance(0, 0) += doubt * doubt;
  c.covariance(1, 1) += doubt * doubt;
  c.covariance(0, 1) -= doubt * doubt;
  c.covariance(1, 0) -= doubt * doubt;
  warnings.push_back("no pluck was made at the contact's position " + in_digits(declared, "%.6g") +
                     ": the delays are those of the plucks at " + in_digits(set.declared[nearest], "%.6g") +
                     ", moved by the declared distance");
  return c;
}

/// Filters are as long as the band's edge is narrow: one narrower than the fundamental would outlast the string's periods.
rosin::outcome<rosin::band> band_of(const take_options& how, double rate_Hz, double fundamental_Hz) {
  rosin::band limits{0.30 * rate_Hz, 0.45 * rate_Hz};
  if (how.pass_Hz > 0) limits = {how.pass_Hz, how.stop_Hz > 0 ? how.stop_Hz : std::min(1.5 * how.pass_Hz, 0.5 * rate_Hz)};
  else if (how.stop_Hz > 0) limits = {how.stop_Hz / 1.5, how.stop_Hz};
  const std::string given = "--pass " + in_digits(limits.pass_Hz, "%.0f") + " --stop " + in_digits(limits.stop_Hz, "%.0f") + ": ";
  if (!(limits.pass_Hz < limits.stop_Hz && limits.stop_Hz <= 0.5 * rate_Hz))
    return rosin::failure{given + "pass has to be below stop, and stop not above half the sampling rate of " +
                          in_digits(rate_Hz, "%.0f") + " Hz"};
  if (limits.pass_Hz < fundamental_Hz || limits.stop_Hz - limits.pass_Hz < fundamental_Hz)
    return rosin::failure{given + "pass, and the distance from pass to stop, have to be at least the fundamental, " +
                          in_digits(fundamental_Hz, "%.0f") + " Hz"};
  return limits;
}

/// Terminations as declared, or as the plucks say.
std::optional<rosin::failure> set_ends(const rosin::rig& rig, take_reconstruction& r, process_input& in) {
  const fitted_ends& fitted = r.calibration.ends;
  for (std::size_t e = 0; e < 2; ++e) {
    const std::string name = e == 0 ? "near" : "far";
    auto end = declared_end(rig, e, r.before.at.impedance_Ns_m, r.warnings);
    if (!end) return rosin::failure{end.error()};
    in.ends[e] = *std::move(end);
    if (!to_be_fitted(rig, e)) continue;
    in.ends[e] = end_of_modes(fitted.end(e));
    if (!fitted.fitted[e])
      r.warnings.push_back("terminations." + name +
                           " = \"fit\": the calibration says nothing of it: taken as rigid; fit the plucks again");
    else if (!in.ends[e]) r.assumed.push_back("terminations." + name + " = \"fit\": the plucks show no motion of it: rigid");
  }
  if (fitted.modes.empty() || !(in.ends[0] || in.ends[1])) return std::nullopt;
  in.uncertain_modes = fitted.list();
  const Eigen::Index waveform = rosin::waveform_parameters, modes = fitted.covariance.rows();
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < r.calibration.declared.size(); ++i)
    if (std::abs(r.calibration.at[i].position - r.before.position) <
        std::abs(r.calibration.at[nearest].position - r.before.position))
      nearest = i;
  in.joint_covariance = Eigen::MatrixXd::Zero(waveform + modes, waveform + modes);
  in.joint_covariance.topLeftCorner(waveform, waveform) = r.before.covariance;
  in.joint_covariance.bottomRightCorner(modes, modes) = fitted.covariance;
  in.joint_covariance.topRightCorner(waveform, modes) = fitted.with_waveform[nearest];
  in.joint_covariance.bottomLeftCorner(modes, waveform) = fitted.with_waveform[nearest].transpose();
  return std::nullopt;
}

rosin::outcome<process_input> input_of(const rosin::rig& rig, const checked_take& read, take_reconstruction& r) {
  process_input in{r.before, read.signals.near_N(), read.signals.far_N(), r.limits, r.rate_Hz, r.how.fine_tune, {}, {}, {}};
  for (double& noise : in.calibration.noise_N) noise *= std::sqrt(r.rate_Hz / r.calibration.rate_Hz);
  if (const auto why = set_ends(rig, r, in)) return *why;
  for (std::size_t c = 0; c < 2; ++c) {
    std::vector<double>& x = c == 0 ? in.near_N : in.far_N;
    const std::string name = c == 0 ? "near" : "far";
    const double corner = rig.channel(name)->ac_coupled_Hz.value_or(0);
    const doubtful& offset = r.calibration.offset_N[c];
    if (corner > 0) {
      r.ac_coupled = true;
      rosin::restore_ac_coupled(std::span(x), corner, r.rate_Hz);
    } else if (std::abs(offset.value) > 5 * offset.sd && std::abs(offset.value) > 1e-4) {
      for (double& v : x) v -= offset.value;
      r.assumed.push_back("offset of channel " + name + " = " + in_digits(1e3 * offset.value) +
                          " mN, that of the plucks: taken out");
    }
  }
  return in;
}

/// With the corrected model of a diagnosis, or as the rig file declares it.
std::optional<rosin::failure> process(const rosin::rig& rig, const rosin::take& take, const checked_take& read,
                                      take_reconstruction& r) {
  if (r.how.model) {
    auto made = process_with_model(*r.how.model, rig, take.name, r.limits, r.warnings);
    if (!made) return rosin::failure{made.error()};
    r.result = *std::move(made);
    return std::nullopt;
  }
  const auto in = input_of(rig, read, r);
  if (!in) return rosin::failure{in.error()};
  const bool moving = in->ends[0] || in->ends[1];
  if (r.how.paper && moving) r.warnings.emplace_back("--paper: terminations are taken as rigid");
  r.result = r.how.paper ? process_as_paper(*in) : moving ? process_moving_ends(*in) : process_full(*in);
  return std::nullopt;
}

/// One period, at the samples of the stretch that it was fitted to.
std::vector<double> unrolled(const std::vector<double>& one_period, const rosin::periodic_part& part, std::size_t samples) {
  const auto N = one_period.size();
  std::vector<std::complex<double>> bins(N / 2);
  for (std::size_t k = 0; k < bins.size(); ++k)
    for (std::size_t n = 0; n < N; ++n)
      bins[k] += one_period[n] * std::polar((k == 0 ? 1.0 : 2.0) / static_cast<double>(N),
                                            -2 * std::numbers::pi * static_cast<double>(k * n % N) / static_cast<double>(N));
  std::vector<double> out(samples, nan);
  for (std::size_t i = part.begin; i < std::min(part.end, samples); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i - part.begin) / part.period;
    double sum = 0;
    for (std::size_t k = 0; k < bins.size(); ++k) sum += (bins[k] * std::polar(1.0, turn * static_cast<double>(k))).real();
    out[i] = sum;
  }
  return out;
}

std::vector<double> mean_of(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = 0.5 * (a[i] + b[i]);
  return out;
}

void take_time_domain(take_reconstruction& r) {
  const auto& m = r.result.motion;
  r.force_near_N = m.force_near_N, r.force_far_N = m.force_far_N;
  r.velocity_near_m_s = m.velocity_near_m_s, r.velocity_far_m_s = m.velocity_far_m_s;
  r.known = m.known;
}

void take_frequency_domain(take_reconstruction& r) {
  const auto& p = *r.result.periodic;
  const std::size_t n = r.result.motion.force_near_N.size();
  r.force_near_N = unrolled(p.force_near_N, p.source, n), r.force_far_N = unrolled(p.force_far_N, p.source, n);
  r.velocity_near_m_s = unrolled(p.velocity_near_m_s, p.source, n),
  r.velocity_far_m_s = unrolled(p.velocity_far_m_s, p.source, n);
  r.known = {p.source.begin, std::min(p.source.end, n)};
  for (const auto& b : p.regularised)
    r.warnings.push_back("a termination all but follows the string from " + in_digits(b.pass_Hz, "%.0f") + " to " +
                         in_digits(b.stop_Hz, "%.0f") + " Hz: the division was regularised there");
}

void compare_domains(take_reconstruction& r) {
  if (!r.result.periodic) return;
  const auto& p = *r.result.periodic;
  const auto& m = r.result.motion;
  const auto periodic = mean_of(unrolled(p.force_near_N, p.source, m.force_near_N.size()),
                                unrolled(p.force_far_N, p.source, m.force_near_N.size()));
  r.domains_differ = rosin::consistency_delta(mean_of(m.force_near_N, m.force_far_N), periodic);
  r.period_s = p.source.period / r.rate_Hz;
  r.steady_begin = p.source.begin, r.steady_end = p.source.end;
}

void finish_columns(take_reconstruction& r) {
  r.force_N = mean_of(r.force_near_N, r.force_far_N);
  r.velocity_m_s = mean_of(r.velocity_near_m_s, r.velocity_far_m_s);
  r.force_sd_N = r.result.sd.force_sd_N;
  r.velocity_sd_m_s = r.result.sd.velocity_sd_m_s;
  for (std::size_t i = 0; i < r.force_N.size(); ++i)
    if (!std::isfinite(r.force_N[i])) r.force_sd_N[i] = r.velocity_sd_m_s[i] = nan;
  r.delta_force = rosin::consistency_delta(r.force_near_N, r.force_far_N);
  r.delta_velocity = rosin::consistency_delta(r.velocity_near_m_s, r.velocity_far_m_s);
}

/// Rolling under the force; empty as long as what was before the known samples still rings.
void add_torsion(const rosin::rig& rig, take_reconstruction& r) {
  if (!rig.torsion) return;
  const auto& c = r.result.used.at;
  const auto waveguide =
      rosin::torsion_of(c.delay_s, c.impedance_Ns_m, rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q);
  const auto& m = r.result.motion;
  const auto begin = static_cast<std::ptrdiff_t>(m.known.begin), end = static_cast<std::ptrdiff_t>(m.known.end);
  const auto force = mean_of(m.force_near_N, m.force_far_N), velocity = mean_of(m.velocity_near_m_s, m.velocity_far_m_s);
  const std::vector<double> rolled =
      rosin::torsion_velocity(waveguide, std::vector<double>(force.begin() + begin, force.begin() + end), r.rate_Hz);
  const auto memory = static_cast<std::size_t>(waveguide.memory_s() * r.rate_Hz);
  double early = 0, all = 0;
  const std::size_t first = std::min<std::size_t>(m.known.begin + memory, m.known.end);
  for (std::size_t i = m.known.begin; i < m.known.end; ++i) {
    all += velocity[i] * velocity[i] / static_cast<double>(m.known.end - m.known.begin);
    if (i < first) early += velocity[i] * velocity[i] / static_cast<double>(first - m.known.begin);
  }
  const bool at_rest = early < 0.05 * 0.05 * all;
  r.torsion_m_s.assign(force.size(), nan);
  for (std::size_t i = at_rest ? m.known.begin : first; i < m.known.end; ++i)
    if (i >= r.known.begin && i < r.known.end) r.torsion_m_s[i] = rolled[i - m.known.begin];
}

/// Slower than half the rod, until it is up to three quarters of it again; from when the rod first caught the string. What
/// sticks is the surface: where its rolling is modelled it counts.
void find_slips(take_reconstruction& r) {
  if (r.rod_m_s.empty()) return;
  bool caught = false, slipping = false;
  for (std::size_t i = r.bowed().begin; i < r.bowed().end; ++i) {
    const double rolling = !r.torsion_m_s.empty() && std::isfinite(r.torsion_m_s[i]) ? r.torsion_m_s[i] : 0;
    const double ratio = r.rod_m_s[i] > 0 ? (r.velocity_m_s[i] + rolling) / r.rod_m_s[i] : 0;
    caught = caught || ratio > 0.75;
    if (!caught) continue;
    const bool before = std::exchange(slipping, slipping ? ratio < 0.75 : ratio < 0.5);
    if (slipping && !before) r.slips.emplace_back(i, i + 1);
    if (slipping) r.slips.back().second = i + 1;
  }
}

/// Where the rod moves and the bow is on: what cannot be so.
void doubt(const rosin::take& take, take_reconstruction& r) {
  std::size_t begin = r.bowed().begin;
  const std::size_t end = r.bowed().end;
  if (r.rod_m_s.empty()) return;
  while (begin < end && !(std::abs(r.rod_m_s[begin]) > 0)) ++begin;
  std::vector<double> surface(r.velocity_m_s.begin() + static_cast<std::ptrdiff_t>(begin),
                              r.velocity_m_s.begin() + static_cast<std::ptrdiff_t>(end));
  for (std::size_t i = begin; i < end && !r.torsion_m_s.empty(); ++i)
    if (std::isfinite(r.torsion_m_s[i])) surface[i - begin] += r.torsion_m_s[i];
  const double period_s = r.period_s > 0 ? r.period_s : 1 / r.calibration.fundamental_Hz;
  const auto of = [&](const std::vector<double>& x) { return std::span(x).subspan(begin, end - begin); };
  const auto [slowest, fastest] = std::minmax_element(r.rod_m_s.begin() + static_cast<std::ptrdiff_t>(begin),
                                                      r.rod_m_s.begin() + static_cast<std::ptrdiff_t>(end));
  const bool steady = begin < end && take.normal_force_profile_N.empty() && !r.normal_from.starts_with("channel") &&
                      *fastest - *slowest < 0.1 * std::abs(*fastest);
  const rosin::stroke_view view{of(r.force_N),        surface,        of(r.rod_m_s), r.normal_force_N,
                                period_s * r.rate_Hz, r.slips.size(), !r.ac_coupled, steady};
  for (const auto& d : rosin::doubts_of_stroke(view)) r.warnings.push_back(d.what), r.contradicts_itself = true;
}

void judge(const rosin::rig& rig, take_reconstruction& r) {
  const double one_way = r.before.at.delay_s[0] + r.before.at.delay_s[1];
  if (const auto& t = r.result.tuning; t && t->sigmas > 5) {
    const double stretch = (t->shift[0] + t->shift[1]) / one_way, length = rig.string.length_m.value_or(0);
    const double moved = (t->shift[0] - r.before.position * (t->shift[0] + t->shift[1])) / one_way;
    r.warnings.push_back(
        "the search had to move delays and gain ratio by " + in_digits(t->sigmas, "%.1f") + " standard deviations (tension " +
        in_digits(-200 * stretch, "%+.3f") + " %, contact " +
        (length > 0 ? in_digits(1e3 * length * moved, "%+.3f") + " mm" : in_digits(moved, "%+.5f") + " of the length") +
        ", gain ratio " + in_digits(100 * t->shift[5], "%+.3f") +
        " %): tension or contact moved since the plucks, or the string does more than the model");
  }
  if (r.delta_force > 0.03)
    r.warnings.push_back("the two versions of the force differ by Delta = " + in_digits(r.delta_force, "%.3f") +
                         ": string or sensors do what the model does not hold; the standard deviations count that in");
  if (r.period_s > 0 && std::abs(r.period_s * r.calibration.fundamental_Hz - 1) > 0.06)
    r.warnings.push_back("the take repeats at " + in_digits(1 / r.period_s, "%.2f") + " Hz, the plucks at " +
                         in_digits(r.calibration.fundamental_Hz, "%.2f") +
                         " Hz: check the sample rate in the file's header, or it is no motion of one slip a period");
  if (!r.result.periodic) r.warnings.push_back("no periodic stretch: " + r.result.why_not_periodic);
  if (r.rod_m_s.empty()) r.warnings.push_back("speed_m_s of the take is not given: slips cannot be told from sticking");
}

std::optional<rosin::failure> cannot_start(const rosin::take& take, const checked_take& read, const take_reconstruction& r) {
  if (!std::isfinite(r.before.at.impedance_Ns_m))
    return rosin::failure{
        take.name +
        ": length_m and tension_N (or impedance_Ns_m) are needed: without the wave impedance there is no velocity in m/s"};
  const double needed = 4 * (r.before.at.delay_s[0] + r.before.at.delay_s[1]);
  if (r.sampled_s > needed) return std::nullopt;
  return rosin::failure{read.signals.file + ": take " + take.name + ": " + in_digits(1e3 * r.sampled_s) +
                        " ms are too short: nothing is known within a transit time of either end"};
}

}  // namespace

double take_reconstruction::slips_per_period() const {
  if (period_s <= 0) return 0;
  double count = 0;
  for (const auto& [begin, end] : slips) count += begin >= steady_begin && begin < steady_end ? 1 : 0;
  return count * period_s * rate_Hz / static_cast<double>(steady_end - steady_begin);
}

rosin::outcome<take_reconstruction> reconstruct_take(const rosin::rig& rig, const rosin::take& take, const checked_take& read,
                                                     const calibration_set& calibration, const take_options& how) {
  take_reconstruction r;
  r.rig = rig.file, r.take = take.name, r.title = rig.title.value_or(rig.file);
  r.rate_Hz = read.signals.sample_rate_Hz, r.how = how, r.calibration = calibration;
  r.sampled_s = static_cast<double>(read.signals.frames()) / r.rate_Hz;
  const auto limits = band_of(how, r.rate_Hz, rig.string.fundamental_Hz);
  if (!limits) return rosin::failure{limits.error()};
  r.limits = *limits;
  const auto position = rig.position_of(take);
  if (!position)
    return rosin::failure{rig.file + ":" + std::to_string(take.line) + ": take \"" + take.name + "\": " +
                          (take.position_profile.empty()
                               ? "the position of the contact is unknown"
                               : "the bow travels along the string; the force is reconstructed at one place only")};
  r.before = calibration_at(calibration, *position,
                            rig.position_tolerance.value_or(rosin::detail::default_position_tolerance) / 2, r.warnings);
  if (const auto why = cannot_start(take, read, r)) return *why;
  limit_loss(r.before, r.limits, r.warnings);
  if (calibration.rate_Hz != r.rate_Hz)
    r.warnings.push_back("recorded at " + in_digits(r.rate_Hz, "%.0f") + " Hz, the plucks at " +
                         in_digits(calibration.rate_Hz, "%.0f") + " Hz");
  if (const auto why = process(rig, take, read, r)) return *why;
  if (r.result.ends_settle)
    r.assumed.emplace_back("the take begins in motion: nothing is given until the terminations have forgotten what was before");
  const auto& m = r.result.motion;
  if (m.known.end <= m.known.begin)
    return rosin::failure{read.signals.file + ": take " + take.name + ": " + std::to_string(read.signals.frames()) +
                          " samples are too few: the kernels reach beyond them everywhere"};
  if (how.frequency_domain && !r.result.periodic)
    return rosin::failure{take.name + ": --frequency-domain: " + r.result.why_not_periodic};
  if (how.frequency_domain) take_frequency_domain(r);
  else take_time_domain(r);
  compare_domains(r);
  finish_columns(r);
  add_torsion(rig, r);
  find_free_decay(r);
  add_rod_and_normal_force(rig, take, read, r);
  find_slips(r);
  add_comparisons(rig, take, read, r);
  estimate_level(rig, r);
  judge(rig, r);
  doubt(take, r);
  return r;
}

}  // namespace tool
