// SPDX-License-Identifier: MIT
#include "live_chain.hpp"

#include "digits.hpp"
#include "recorder.hpp"
#include "rig_leftovers.hpp"

#include <rosin/hardware/csv_sink.hpp>
#include <rosin/hardware/take_file.hpp>
#include <rosin/reconstruct/passage_design.hpp>

#include <unistd.h>

namespace tool {

namespace {

const std::vector<std::string> columns{"force_N",           "velocity_m_s",     "force_near_N", "force_far_N",
                                       "velocity_near_m_s", "velocity_far_m_s", "slips"};

template <rosin::FrameSink Sink>
frame_output output_of(Sink sink) {
  auto held = std::make_shared<Sink>(std::move(sink));
  return {[held](std::span<const double> frames) { return held->write(frames); }, [held] { return held->finish(); }};
}

rosin::outcome<rosin::band> band_of(const live_options& how, double rate_Hz) {
  const rosin::band limits{how.pass_Hz > 0 ? how.pass_Hz : 0.30 * rate_Hz, how.stop_Hz > 0 ? how.stop_Hz
                                                                           : how.pass_Hz > 0
                                                                               ? std::min(1.5 * how.pass_Hz, 0.5 * rate_Hz)
                                                                               : 0.45 * rate_Hz};
  if (limits.pass_Hz < limits.stop_Hz && limits.stop_Hz <= 0.5 * rate_Hz) return limits;
  return rosin::failure{"--pass " + in_digits(limits.pass_Hz, "%.4g") + " --stop " + in_digits(limits.stop_Hz, "%.4g") +
                        ": pass has to be below stop, and stop not above half the sampling rate"};
}

}  // namespace

rosin::outcome<frame_output> open_output(const std::string& path, bool force, double rate_Hz,
                                         const std::vector<std::string>& names) {
  if (path == "-")
    return output_of(rosin::csv_sink{rosin::byte_link{::dup(STDOUT_FILENO), "standard output"}, rate_Hz, names, stop_flag()});
  const std::string place = rosin::detail::followed(path).string();  // a link stays
  std::error_code ignored;
  if (std::filesystem::is_regular_file(place, ignored)) {
    if (!force) return rosin::failure{path + ": exists already; --force overwrites it"};
    if (const auto why = being_written(place)) return *why;
    std::filesystem::remove(place, ignored);
  }
  if (path.ends_with(".wav")) {
    auto file = rosin::take_file<>::create(place, {rate_Hz, static_cast<int>(names.size()), 32, true});
    if (!file) return rosin::failure{file.error()};
    return output_of(*std::move(file));
  }
  auto file = rosin::csv_sink::create(place, rate_Hz, names);
  if (!file) return rosin::failure{file.error()};
  return output_of(*std::move(file));
}

double live_chain::end::operator()(double sample) noexcept {
  const double y = sample * newtons;
  if (half_step > 0) {  // the amplifier's droop undone, see ac_coupling.hpp; after a gap it begins anew
    if (!std::isfinite(y)) {
      integral = last = 0;
      return y;
    }
    integral += half_step * (y + last);
    last = y;
  }
  return y + integral - offset_N;
}

void live_chain::place(const rosin::rig& rig, const calibration_set& set, rosin::calibration& at, double declared) {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < set.at.size(); ++i)
    if (std::abs(set.declared[i] - declared) < std::abs(set.declared[nearest] - declared)) nearest = i;
  at = set.at[nearest];
  at.at.stiffness_s2 = std::max(0.0, at.at.stiffness_s2);
  const double shift = declared - set.declared[nearest], one_way = at.at.delay_s[0] + at.at.delay_s[1];
  at.at.delay_s[0] += shift * one_way;
  at.at.delay_s[1] -= shift * one_way;
  if (std::abs(shift) > 1e-9)
    remarks_.push_back(rig.file + ": no pluck was made at the contact's position " + in_digits(declared, "%.4g") +
                       ": the delays are those of " + in_digits(set.declared[nearest], "%.4g") +
                       ", moved by the declared distance");
}

void live_chain::set_ends(const rosin::rig& rig, const calibration_set& set, double rate_Hz) {
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& sensor = *rig.channel(c == 0 ? "near" : "far");
    const double corner = sensor.ac_coupled_Hz.value_or(0);
    ends_[c] = {
        static_cast<std::size_t>(sensor.index), sensor.per_full_scale.value_or(1), 0, std::numbers::pi * corner / rate_Hz, 0, 0};
    if (corner > 0) {
      remarks_.push_back("channel " + sensor.name + " is AC coupled: the mean of the force is not known");
    } else if (std::abs(set.offset_N[c].value) > 5 * set.offset_N[c].sd && std::abs(set.offset_N[c].value) > 1e-4) {
      ends_[c].offset_N = set.offset_N[c].value;
      remarks_.push_back("offset of channel " + sensor.name + " = " + in_digits(1e3 * set.offset_N[c].value, "%.4g") +
                         " mN, that of the plucks: taken out");
    }
  }
}

rosin::outcome<live_chain> live_chain::design(const rosin::rig& rig, const take_plan& take, const calibration_set& set,
                                              const rosin::frame_format& format, const live_options& how) {
  if (!rig.has_both_forces())
    return rosin::failure{rig.file + ": channels near and far (forces on both terminations) are needed"};
  const auto declared = take.position ? take.position : rig.contact_position;
  if (!declared) return rosin::failure{rig.file + ": where the bow is has to be known: [contact] position, or --position"};
  const auto limits = band_of(how, format.sample_rate_Hz);
  if (!limits) return rosin::failure{limits.error()};
  live_chain out;
  if (any_end_moves(rig))
    out.remarks_.push_back(rig.file + ": terminations: live, both ends are taken for rigid; rosin reconstruct knows better");
  rosin::calibration at;
  out.place(rig, set, at, *declared);
  if (!std::isfinite(at.at.impedance_Ns_m))
    return rosin::failure{set.from + ": the impedance is not known, so there is no velocity"};
  out.set_ends(rig, set, format.sample_rate_Hz);
  const auto plan = rosin::plan_passages(at.at, at.gain, *limits, format.sample_rate_Hz, how.error, rosin::bow_version::both, 8);
  const auto coefficients = rosin::fixed_size<double, 2048, 8192, 8>(plan);
  if (!coefficients) return rosin::failure{coefficients.error() + ": a larger --error or a wider band makes it shorter"};
  out.run_ = std::make_unique<reconstructor>(*coefficients);
  out.latency_ = out.skip_ = coefficients->latency;
  if (const auto bad = out.open(take, format, how)) return *bad;
  return out;
}

std::optional<rosin::failure> live_chain::open(const take_plan& take, const rosin::frame_format& format,
                                               const live_options& how) {
  width_ = static_cast<std::size_t>(format.channels);
  rate_Hz_ = format.sample_rate_Hz;
  speed_m_s_ = take.speed_m_s.value_or(0);
  watch_ = std::make_unique<rosin::slip_watch<double>>(speed_m_s_);
  for (const auto& path : how.out) {
    auto one = open_output(path, how.force, rate_Hz_, columns);
    if (!one) return rosin::failure{one.error()};
    outputs_.push_back(*std::move(one));
  }
  return std::nullopt;
}

std::optional<rosin::failure> live_chain::push(std::span<const double> interleaved) {
  const std::size_t count = interleaved.size() / width_;
  in_.resize(count);
  result_.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    in_[i] = {ends_[0](interleaved[i * width_ + ends_[0].index]), ends_[1](interleaved[i * width_ + ends_[1].index])};
  run_->process(in_, result_);
  return give(count);
}

std::optional<rosin::failure> live_chain::give(std::size_t count) {
  rows_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const auto& r = result_[i];
    const auto state = (*watch_)(r.velocity_m_s());
    if (std::isfinite(r.force_N())) {
      latest_ = r;
      ++known_;
      sum_N_ += r.force_N();
      largest_N_ = std::max(largest_N_, std::abs(r.force_N()));
    }
    if (skip_ > 0) {  // these belong to frames before the first
      --skip_;
      continue;
    }
    const double slips = state == rosin::contact_state::unknown ? nan : state == rosin::contact_state::slipping ? 1 : 0;
    rows_.insert(rows_.end(),
                 {r.force_N(), r.velocity_m_s(), r.force_near_N, r.force_far_N, r.velocity_near_m_s, r.velocity_far_m_s, slips});
  }
  std::optional<rosin::failure> broken;
  std::erase_if(outputs_, [&](frame_output& out) {
    auto bad = out.write(rows_);
    if (bad) broken = bad;
    return bad.has_value();
  });
  return broken;
}

std::optional<rosin::failure> live_chain::finish() {
  rows_.assign((latency_ - skip_) * columns.size(), nan);
  for (auto& out : outputs_) {
    if (auto bad = out.write(rows_)) return bad;
    if (auto bad = out.finish()) return bad;
  }
  return std::nullopt;
}

std::string live_chain::shows() const {
  const auto state = watch_->state();
  const char* word = state == rosin::contact_state::slipping   ? "slips "
                     : state == rosin::contact_state::sticking ? "sticks"
                                                               : "      ";
  return "F " + in_digits(latest_.force_N(), "%+.3f") + " N  v " + in_digits(latest_.velocity_m_s(), "%+.3f") + " m/s  " + word +
         " " + std::to_string(watch_->slips());
}

json live_chain::to_json() const {
  const auto n = static_cast<double>(std::max<std::uint64_t>(1, known_));
  return {{"latency_frames", latency_},
          {"latency_s", static_cast<double>(latency_) / rate_Hz_},
          {"known_frames", known_},
          {"mean_force_N", sum_N_ / n},
          {"largest_force_N", largest_N_},
          {"slips", speed_m_s_ > 0 ? json(watch_->slips()) : json(nullptr)},
          {"remarks", remarks_}};
}

std::string live_chain::summary() const {
  return "late by " + std::to_string(latency_) + " frames (" + in_digits(1e3 * static_cast<double>(latency_) / rate_Hz_, "%.2f") +
         " ms), " + std::to_string(known_) + " frames known, largest force " + in_digits(largest_N_, "%.4g") + " N" +
         (speed_m_s_ > 0 ? ", " + std::to_string(watch_->slips()) + " slips" : "");
}

void add_live_options(CLI::App& command, live_options& given) {
  command.add_option("--pass", given.pass_Hz, "End of the pass band; 0.30 of the sampling rate if not given")
      ->type_name("HZ")
      ->check(positive());
  command.add_option("--stop", given.stop_Hz, "Nothing is left from here on; 0.45 of the sampling rate")
      ->type_name("HZ")
      ->check(positive());
  command.add_option("--error", given.error, "Of the filters, relative; a larger one makes the result come earlier")
      ->check(between(1e-6, 0.1))
      ->capture_default_str();
  command
      .add_option("--out", given.out,
                  "Where the result goes: FILE.wav (floating point, N and m/s), FILE.csv, or - for lines on standard output; may "
                  "be repeated")
      ->type_name("FILE");
  add_force_option(command, given.force);
}

}  // namespace tool
