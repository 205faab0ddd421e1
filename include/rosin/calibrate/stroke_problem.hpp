// tier: hosted
// SPDX-License-Identifier: MIT
//
// The least-squares problem of a fit of strokes. Whatever the friction does, and at every instant, both ends tell of one force:
//
//     e = F_near sinh(g_1) - F_far sinh(g_2) = 0,    g_j = x_j gamma(w)
//
// (two versions of the force, Eqs. (3) and (9) of Woodhouse, Schumacher & Garoff (2000), and G beside them, differ by 2 G e). So
// travel times, stiffness, loss, ratio of the gains and skew follow from e alone. Noise is in both forces: with true forces of
// any kind the likelihood is greatest where
//
//     sum over bins  |e|^2 / S,    S = s_1^2 |sinh(g_1)|^2 + s_2^2 |sinh(g_2)|^2 + d^2 (|F_near sinh(g_1)|^2 + |F_far sinh(g_2)|^2)
//
// is least (total least squares, a bin at a time). S depends on the parameters like e does: a fit with fixed weights would make the
// sinh of quiet bins small. d is what calibration, converters and model leave undone, relative to the signal.
//
#pragma once

#include <rosin/calibrate/stroke_noise.hpp>
#include <rosin/calibrate/stroke_spectra.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/levenberg_marquardt.hpp>

#include <Eigen/Dense>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Mean and standard deviation of each parameter before the fit.
struct stroke_prior {
  Eigen::VectorXd mean, sd;
};

/// One bin of one take.
struct stroke_bin {
  std::complex<double> rate;  ///< gamma c
  std::array<std::complex<double>, 2> g, s, c;
  double w = 0, slow = 1, inverse_q = 0;
  uneven_string::place place;
};

class stroke_problem {
public:
  using complex = std::complex<double>;

  stroke_problem(const stroke_layout& layout, const std::vector<stroke_spectra>& takes, stroke_prior prior, stroke_noise noise)
      : layout_{layout}, takes_{takes}, prior_{std::move(prior)}, noise_{noise} {}

  void set_noise(const stroke_noise& noise) noexcept { noise_ = noise; }
  [[nodiscard]] const stroke_noise& noise() const noexcept { return noise_; }
  void set_prior(stroke_prior prior) { prior_ = std::move(prior); }
  [[nodiscard]] const stroke_prior& prior() const noexcept { return prior_; }

  [[nodiscard]] bool plausible(const Eigen::VectorXd& v) const {
    bool ok = v.allFinite() && std::abs(v[stroke_layout::fundamental] / prior_.mean[stroke_layout::fundamental] - 1) < 0.2 &&
              v[stroke_layout::inharmonicity] > -1e-5 && v[stroke_layout::inharmonicity] < 0.01;
    const uneven_string string = layout_.string(v);
    ok = ok && string.loss.inverse_q(0) > 1e-7 && string.loss.inverse_q(highest_Hz()) > 1e-7 && string.loss.inverse_q(0) < 0.2;
    for (std::size_t t = 0; t < takes_.size(); ++t)
      ok = ok && v[layout_.position(t)] > 0.002 && v[layout_.position(t)] < 0.998 && std::abs(v[layout_.drift(t)]) < 0.05;
    return ok;
  }

  template <class = void>
  [[nodiscard]] normal_equations<> linearise(const Eigen::VectorXd& v) const {
    auto out = normal_equations<>::zero(layout_.size());
    for (std::size_t t = 0; t < takes_.size(); ++t) add_take(v, t, out);
    out.mirror();
    for (Eigen::Index p = 0; p < layout_.size(); ++p) {
      const double weight = 1 / (prior_.sd[p] * prior_.sd[p]), off = prior_.mean[p] - v[p];
      out.hessian(p, p) += weight, out.gradient[p] += weight * off, out.cost += weight * off * off;
    }
    return out;
  }

  /// What is left of a take.
  template <class = void>
  [[nodiscard]] stroke_leftover left(const Eigen::VectorXd& v, std::size_t take) const {
    const stroke_spectra& x = takes_[take];
    const uneven_string string = layout_.string(v, take);
    const auto e = mismatch(v, take, string);
    const double ratio = std::exp(v[stroke_layout::ln_gain_ratio]);
    stroke_leftover out;
    for (std::size_t k = x.first(); k <= x.last(); ++k) {
      const stroke_bin b = bin(string, v[layout_.position(take)], static_cast<double>(k) * x.bin_Hz());
      const double one = std::norm(b.s[0]) / ratio, two = std::norm(b.s[1]) * ratio;
      out.power.push_back(std::norm(e[k])), out.independence = x.independence();
      out.near.push_back(one * x.noise_power()), out.far.push_back(two * x.noise_power());
      out.signal.push_back(std::norm(x.windowed(0)[k]) * one + std::norm(x.windowed(1)[k]) * two);
    }
    return out;
  }

private:
  [[nodiscard]] double highest_Hz() const { return static_cast<double>(takes_[0].last()) * takes_[0].bin_Hz(); }

  [[nodiscard]] static stroke_bin bin(const uneven_string& string, double position, double f) {
    stroke_bin b;
    b.w = 2 * std::numbers::pi * f;
    b.slow = slowness_ratio(b.w, string.stiffness_s2);
    b.inverse_q = string.inverse_q(f);
    const double q = phase_rate(b.w, string.stiffness_s2), one_way = 0.5 / string.fundamental_Hz;
    b.rate = {b.w * b.inverse_q / 2 * b.slow, q};
    b.place = string.place_of(q);
    const std::array<double, 2> delay{position * one_way, (1 - position) * one_way};
    for (std::size_t j = 0; j < 2; ++j) {
      b.g[j] = delay[j] * b.rate;
      const complex up = std::exp(b.g[j]), down = 1.0 / up;
      b.s[j] = 0.5 * (up - down), b.c[j] = 0.5 * (up + down);
    }
    return b;
  }

  /// Factors of the recorded spectra: half the ratio of the gains each, the skew on the far one.
  [[nodiscard]] static std::array<complex, 2> factors(const Eigen::VectorXd& v, double w) {
    const double half = std::exp(v[stroke_layout::ln_gain_ratio] / 2);
    return {1 / half, std::polar(half, w * v[stroke_layout::skew])};
  }

  [[nodiscard]] std::vector<complex> mismatch(const Eigen::VectorXd& v, std::size_t take, const uneven_string& string) const {
    const stroke_spectra& x = takes_[take];
    std::vector<complex> e(x.bins());
    for (std::size_t k = 1; k < e.size(); ++k) {
      const stroke_bin b = bin(string, v[layout_.position(take)], static_cast<double>(k) * x.bin_Hz());
      const auto factor = factors(v, b.w);
      e[k] = x.force(0)[k] * factor[0] * b.s[0] - x.force(1)[k] * factor[1] * b.s[1];
    }
    return x.within(e);
  }

  /// Derivatives of the rate by what the string has.
  struct rate_slopes {
    complex by_epsilon;
    double by_inverse_q;
  };
  [[nodiscard]] static rate_slopes slopes(const stroke_bin& b, double epsilon) {
    const double q = b.rate.imag(), K = epsilon * q * q, stiffer = 1 + 2 * K;
    return {{b.rate.real() * (0.5 / (1 + K) - 2 / stiffer) * q * q / stiffer, -q * q * q / (2 * stiffer)}, b.w * b.slow / 2};
  }

  static constexpr std::size_t active = 10;
  using indices = std::array<Eigen::Index, active>;

  template <class = void>
  void add_take(const Eigen::VectorXd& v, std::size_t take, normal_equations<>& to) const {
    using L = stroke_layout;
    const stroke_spectra& x = takes_[take];
    const uneven_string string = layout_.string(v, take);
    const double f0 = v[L::fundamental], position = v[layout_.position(take)], one_way = 0.5 / string.fundamental_Hz;
    const double epsilon = string.stiffness_s2, drifted = std::exp(-4 * v[layout_.drift(take)]);
    const double per_b = drifted / std::pow(2 * std::numbers::pi * f0, 2);
    const std::array<double, 2> delay{position * one_way, (1 - position) * one_way};
    const double ratio = std::exp(v[L::ln_gain_ratio]), d2 = noise_.model * noise_.model;
    const std::array<double, 2> noise{x.noise_power() * noise_.sensor_N[0] * noise_.sensor_N[0] / ratio,
                                      x.noise_power() * noise_.sensor_N[1] * noise_.sensor_N[1] * ratio};
    const auto e = mismatch(v, take, string);
    for (std::size_t k = x.first(); k <= x.last(); ++k) {
      const stroke_bin b = bin(string, position, static_cast<double>(k) * x.bin_Hz());
      const auto factor = factors(v, b.w);
      const std::array<complex, 2> F{x.windowed(0)[k] * factor[0], x.windowed(1)[k] * factor[1]};
      const complex one = F[0] * b.s[0], two = F[1] * b.s[1];
      const std::array<double, 2> S{noise[0] * std::norm(b.s[0]), noise[1] * std::norm(b.s[1])};
      const double sum = S[0] + S[1] + d2 * (std::norm(one) + std::norm(two));
      const double scale = std::sqrt(2 * x.independence() / sum);
      const auto slope = slopes(b, epsilon);
      indices at;
      std::array<complex, active> row;
      std::size_t n = 0;
      const auto add = [&](Eigen::Index p, complex by_g1, complex by_g2, complex de, double ds) {
        de += F[0] * b.c[0] * by_g1 - F[1] * b.c[1] * by_g2;
        ds += 2 * noise[0] * (std::conj(b.s[0]) * b.c[0] * by_g1).real() +
              2 * noise[1] * (std::conj(b.s[1]) * b.c[1] * by_g2).real();
        at[n] = p, row[n++] = -scale * (de - 0.5 * ds / sum * e[k]);
      };
      const auto add_rate = [&](Eigen::Index p, complex by) { add(p, delay[0] * by, delay[1] * by, 0, 0); };
      const complex by_epsilon = slope.by_epsilon;
      const double lost = slope.by_inverse_q * b.inverse_q, law = string.loss.inverse_q(b.w / (2 * std::numbers::pi));
      const double own = b.inverse_q / law;
      add_rate(L::fundamental, (-b.rate - 2 * epsilon * by_epsilon) / f0);
      add_rate(L::inharmonicity, per_b * by_epsilon);
      add_rate(L::ln_inverse_quality, slope.by_inverse_q * own / string.loss.quality);
      add_rate(L::internal_loss, slope.by_inverse_q * own * b.w / (2 * std::numbers::pi));
      add(L::ln_gain_ratio, 0, 0, -0.5 * (one + two), S[1] - S[0]);
      add(L::skew, 0, 0, complex(0, -b.w) * two, 0);
      add(layout_.position(take), b.rate * one_way, -b.rate * one_way, 0, 0);
      add_rate(layout_.drift(take), -b.rate - 4 * epsilon * by_epsilon);
      add_rate(layout_.own_q(b.place.mode), -lost * (1 - b.place.share));
      if (layout_.modes() > 1) add_rate(layout_.own_q(b.place.mode + 1), -lost * b.place.share);
      const complex r = scale * e[k];
      for (std::size_t i = 0; i < n; ++i) {
        to.gradient[at[i]] += row[i].real() * r.real() + row[i].imag() * r.imag();
        for (std::size_t j = 0; j <= i; ++j)  // the indices ascend
          to.hessian(at[i], at[j]) += row[i].real() * row[j].real() + row[i].imag() * row[j].imag();
      }
      to.cost += std::norm(r);
    }
  }

  stroke_layout layout_;
  const std::vector<stroke_spectra>& takes_;
  stroke_prior prior_;
  stroke_noise noise_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
