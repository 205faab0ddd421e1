// tier: hosted
// SPDX-License-Identifier: MIT
//
// One tone in what a model leaves over, at samples that come in patches (only while it sticks, or only while it slips): its
// frequency is common to all takes, size and phase are each take's own. Scanned by least squares on the patches themselves, since
// a periodogram of patches with zeros between would show the patches. Whether it is real is asked by prediction: size and phase
// from one half of each take have to explain the other.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/tone_band.hpp>
#include <rosin/math/median.hpp>

#include <complex>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Residuals of one take at ascending samples; `carrier` is what the tone multiplies there (rod speed, friction).
struct tone_rows {
  Eigen::VectorXd residual, carrier, weight;
  std::vector<std::size_t> sample;
  double rate_Hz = 0;
};

/// residual = carrier * relative * sin(2 pi f t + phase), in each take.
struct tone_fit {
  double frequency_Hz = 0, frequency_sd_Hz = 0;
  std::vector<std::complex<double>> relative;  ///< of each take: sine part, cosine part
  double size = 0, size_sd = 0;                ///< of `relative`, over all takes
  double explained = 0;                        ///< sum of weighted squares that go
  double around = 0;                           ///< the same, median of frequencies nearby

  /// Among its neighbours: noise that is not white has a strongest frequency as well.
  [[nodiscard]] bool stands_out() const noexcept {
    constexpr double nats = 14;  // of one take alone; where several have it, chance has it less
    return explained > around * (1 + nats / static_cast<double>(std::max<std::size_t>(1, relative.size())));
  }
};

namespace detail {

struct tone_sums {
  double ss = 0, sc = 0, cc = 0, sr = 0, cr = 0;
  [[nodiscard]] std::complex<double> solve() const noexcept {
    const double det = ss * cc - sc * sc;
    if (!(det > 1e-9 * ss * cc)) return 0;
    return {(cc * sr - sc * cr) / det, (ss * cr - sc * sr) / det};
  }
};

[[nodiscard]] inline tone_sums sums_at(const tone_rows& r, double f, std::size_t from, std::size_t to) {
  tone_sums s;
  const double w = 2 * std::numbers::pi * f / r.rate_Hz;
  const std::complex<double> turn = std::polar(1.0, w);
  std::complex<double> z = 1;
  std::size_t at = 0;
  for (std::size_t i = from; i < to; ++i) {
    const std::size_t n = r.sample[i];
    if (i == from || n - at > 16) z = std::polar(1.0, w * static_cast<double>(n));
    else
      for (; at < n; ++at) z *= turn;
    at = n;
    const auto k = static_cast<Eigen::Index>(i);
    const double c = r.weight[k] * r.carrier[k], x = c * z.imag(), y = c * z.real(), v = r.weight[k] * r.residual[k];
    s.ss += x * x, s.sc += x * y, s.cc += y * y, s.sr += x * v, s.cr += y * v;
  }
  return s;
}

[[nodiscard]] inline double longest_s(const std::vector<tone_rows>& takes) {
  double length = 0;
  for (const auto& t : takes)
    if (!t.sample.empty()) length = std::max(length, static_cast<double>(t.sample.back() - t.sample.front()) / t.rate_Hz);
  return length;
}

[[nodiscard]] inline double explained_at(const std::vector<tone_rows>& takes, double f) {
  double sum = 0;
  for (const auto& t : takes) {
    const auto s = sums_at(t, f, 0, t.sample.size());
    const auto a = s.solve();
    sum += a.real() * s.sr + a.imag() * s.cr;
  }
  return sum;
}

/// explained_at(takes, f) for f = from, from + step, ...: every row turns on by an angle of its own.
class tone_scan {
public:
  template <class Real = double>
  tone_scan(const std::vector<tone_rows>& takes, double from_Hz, double step_Hz) {
    for (const auto& t : takes) {
      const auto n = static_cast<Eigen::Index>(t.sample.size());
      Eigen::ArrayX<Real> time(n);
      for (Eigen::Index i = 0; i < n; ++i)
        time[i] = 2 * std::numbers::pi * static_cast<double>(t.sample[static_cast<std::size_t>(i)]) / t.rate_Hz;
      const Eigen::ArrayX<Real> c = t.weight.array() * t.carrier.array();
      parts_.push_back({c * (from_Hz * time).sin(), c * (from_Hz * time).cos(), (step_Hz * time).sin(), (step_Hz * time).cos(),
                        t.weight.array() * t.residual.array()});
    }
  }

  /// At the frequency it stands at; then goes on to the next.
  template <class = void>
  [[nodiscard]] double next() {
    double sum = 0;
    for (auto& p : parts_) {
      tone_sums s;
      for (Eigen::Index i = 0; i < p.sine.size(); ++i) {
        const double x = p.sine[i], y = p.cosine[i], v = p.value[i];
        s.ss += x * x, s.sc += x * y, s.cc += y * y, s.sr += x * v, s.cr += y * v;
        p.sine[i] = x * p.turn_cosine[i] + y * p.turn_sine[i];
        p.cosine[i] = y * p.turn_cosine[i] - x * p.turn_sine[i];
      }
      const auto a = s.solve();
      sum += a.real() * s.sr + a.imag() * s.cr;
    }
    return sum;
  }

private:
  struct part {
    Eigen::ArrayXd sine, cosine, turn_sine, turn_cosine, value;
  };
  std::vector<part> parts_;
};

/// Neighbours put together, as far apart as a tone hardly moves on between them: the same sums from fewer rows.
template <class Real = double>
[[nodiscard]] tone_rows gathered(const tone_rows& r, double within_s) {
  tone_rows out;
  out.rate_Hz = r.rate_Hz;
  const auto reach = static_cast<std::size_t>(within_s * r.rate_Hz);
  std::vector<double> residual, carrier;
  for (std::size_t i = 0; i < r.sample.size();) {
    const std::size_t first = r.sample[i];
    double power = 0, product = 0;
    std::size_t last = first;
    for (; i < r.sample.size() && r.sample[i] - first <= reach; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      const double c = r.weight[k] * r.carrier[k];
      last = r.sample[i], power += c * c, product += c * r.weight[k] * r.residual[k];
    }
    carrier.push_back(std::sqrt(power)), residual.push_back(power > 0 ? product / carrier.back() : 0);
    out.sample.push_back((first + last) / 2);
  }
  const auto n = static_cast<Eigen::Index>(residual.size());
  out.residual = Eigen::Map<const Eigen::VectorX<Real>>(residual.data(), n);
  out.carrier = Eigen::Map<const Eigen::VectorX<Real>>(carrier.data(), n);
  out.weight = Eigen::VectorX<Real>::Ones(n);
  return out;
}
ROSIN_INSTANTIATE(tone_rows gathered(const tone_rows&, double))

}  // namespace detail

/// The tone that explains most, of those that fit twice into the record; of frequency 0 where none is looked for, or explains
/// anything.
template <class = void>
[[nodiscard]] tone_fit find_tone(const std::vector<tone_rows>& takes, const tone_band& band = {}) {
  const double length = detail::longest_s(takes);
  std::vector<tone_rows> coarse;
  for (const auto& t : takes) coarse.push_back(detail::gathered(t, 0.1 / band.highest_Hz));
  tone_fit best;
  if (!(length > 0)) return best;
  const double step = 0.25 / length, lowest_Hz = 2 / length;
  const auto allowed = [&](double f) { return f >= lowest_Hz && f < band.highest_Hz && !band.is_its_own(f, 3 / length); };
  const auto attempt = [&](double f, double explained) {
    if (allowed(f) && explained > best.explained) best.explained = explained, best.frequency_Hz = f;
  };
  detail::tone_scan scan(coarse, lowest_Hz, step);
  for (double f = lowest_Hz; f < band.highest_Hz; f += step) attempt(f, scan.next());
  if (!(best.explained > 0)) return best;
  best.explained = detail::explained_at(takes, best.frequency_Hz);
  for (double width = step / 2; width > step / 500; width /= 2)
    for (const double f : {best.frequency_Hz - width, best.frequency_Hz + width}) attempt(f, detail::explained_at(takes, f));
  double weights = 0, sum = 0;
  for (const auto& t : takes) {
    const auto s = detail::sums_at(t, best.frequency_Hz, 0, t.sample.size());
    best.relative.push_back(s.solve());
    const double w = s.ss + s.cc;
    weights += w, sum += w * std::abs(best.relative.back());
  }
  best.size = weights > 0 ? sum / weights : 0;
  std::vector<double> nearby;
  for (double aside = 2 / length; aside < 8 / length; aside += 2 * step)
    for (const double f : {best.frequency_Hz - aside, best.frequency_Hz + aside})
      if (allowed(f)) nearby.push_back(detail::explained_at(coarse, f));
  best.around = median_of(nearby);
  return best;
}
ROSIN_INSTANTIATE(tone_fit find_tone(const std::vector<tone_rows>&, const tone_band&))

/// Squares that the tone explains in each half of each take with size and phase from the other, less what it spoils.
[[nodiscard]] inline double tone_prediction(const std::vector<tone_rows>& takes, double f) {
  double sum = 0;
  for (const auto& t : takes)
    for (const bool second : {false, true}) {
      const std::size_t half = t.sample.size() / 2, n = t.sample.size();
      const auto here = detail::sums_at(t, f, second ? half : 0, second ? n : half),
                 there = detail::sums_at(t, f, second ? 0 : half, second ? half : n);
      const auto a = there.solve();
      sum += 2 * (a.real() * here.sr + a.imag() * here.cr) -
             (a.real() * a.real() * here.ss + 2 * a.real() * a.imag() * here.sc + a.imag() * a.imag() * here.cc);
    }
  return sum;
}

namespace detail {

/// Weighted squares of the residuals, and how many there are.
struct tone_power {
  double rows = 0, power = 0;

  template <class = void>
  explicit tone_power(const std::vector<tone_rows>& takes) {
    for (const auto& t : takes) {
      rows += static_cast<double>(t.sample.size());
      power += t.weight.cwiseProduct(t.residual).squaredNorm();
    }
  }
  [[nodiscard]] double without(double explained, double scale) const {
    return std::max(power - explained, rows * scale * scale * 1e-6);
  }
};

/// Gains of a Student likelihood from weighted squares: what a tone takes from the residual's power, at the final weights.
template <class = void>
void finish_tone(const std::vector<tone_rows>& takes, double scale, double share, tone_fit& tone, contact_hypothesis& h) {
  const tone_power all(takes);
  const double rows = all.rows, length = longest_s(takes), left = all.without(tone.explained, scale),
               predicted = all.without(tone_prediction(takes, tone.frequency_Hz), scale);
  h.gain = 0.5 * share * rows * std::log(all.power / left);
  h.held_out_gain = 0.5 * share * rows * std::log(all.power / predicted);
  const double noise = std::sqrt(left / std::max(1.0, rows)), effective = std::max(1.0, share * rows);
  double carrier = 0;
  for (const auto& t : takes) carrier += t.weight.cwiseProduct(t.carrier).squaredNorm();
  carrier = std::sqrt(carrier / std::max(1.0, rows));
  tone.size_sd = std::sqrt(2 / effective) * noise / std::max(1e-12, carrier);
  tone.frequency_sd_Hz =
      std::sqrt(6 / effective) * noise / (std::numbers::pi * std::max(1e-9, length) * std::max(1e-12, tone.size * carrier));
  h.parameters = {{"frequency_Hz", tone.frequency_Hz, tone.frequency_sd_Hz},
                  {"relative", tone.size, std::hypot(tone.size_sd, contact_faults::ripple * tone.size)}};
  h.free_parameters = 1 + 2 * static_cast<int>(takes.size());
  h.decided = tone.size > 4 * tone.size_sd && tone.stands_out();
}
ROSIN_INSTANTIATE(void finish_tone(const std::vector<tone_rows>&, double, double, tone_fit&, contact_hypothesis&))

}  // namespace detail

/// The rod's speed is not steady: a tone in the surface's velocity while it sticks, whatever the force. It sticks for most of a
/// period, so that tones above the pitch show as well.
template <class Real = double>
[[nodiscard]] contact_hypothesis speed_ripple_hypothesis(stick_bench& bench) {
  constexpr double highest_ripple_Hz = 1500;
  contact_hypothesis h{.effect = "speed-ripple"};
  h.statistic = "stick-fluctuation";
  const auto& s = bench.fit().solution;
  std::vector<tone_rows> takes;
  for (std::size_t t = 0; t < bench.declared().rows.size(); ++t) {
    const auto& rows = bench.declared().rows[t];
    const double speed = bench.records()[t].take().rod_speed_m_s;
    takes.push_back({s.residual[t], Eigen::VectorX<Real>::Constant(rows.target.size(), speed),
                     detail::student_row_factors(s.residual[t], s.scale), rows.sample, bench.records()[t].take().rate_Hz});
  }
  auto tone = find_tone(takes, {highest_ripple_Hz, pitches_of(bench)});
  if (!(tone.frequency_Hz > 0)) return detail::nothing(bench, h);
  stick_design d = bench.declared();
  bench.add_rod_tone(d, tone.frequency_Hz);
  const auto fit = fit_design(d, bench.floor_m_s());
  detail::finish_tone(takes, s.scale, fit.share, tone, h);
  const double predicted = h.held_out_gain;
  h.gain = bench.gains(fit)[0];
  h.held_out_gain = std::min(predicted, bench.gains(fit)[1]);
  h.share = fit.share, h.density = h.gain / fit.share, h.held_out_density = h.held_out_gain / fit.share;
  double size = 0;
  for (const auto& own : fit.solution.own)
    size += std::hypot(own[own.size() - 2], own[own.size() - 1]) / static_cast<double>(takes.size());
  h.parameters[1].value = size;
  h.fluctuation = fit.solution.scale / bench.speed_m_s();
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis speed_ripple_hypothesis(stick_bench&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
