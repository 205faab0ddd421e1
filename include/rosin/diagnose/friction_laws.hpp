// tier: hosted
// SPDX-License-Identifier: MIT
//
// Laws of friction set against reconstructed slips, with no simulation that runs freely: each law is driven along the
// reconstructed motion, through the same window, and asked for the force.
//
//     velocity curve   f = N mu(|v_r|)
//     thermal          f = N mu(Theta),   dTheta/dt = |f v_r| / N^p - (a + b sqrt|v_r| + c |v_r|) Theta
//
// with mu a spline of as many coefficients in either, common to all takes. The thermal contact has one temperature, cooled by
// what it conducts away (a into the string, b into a rod whose surface is renewed by sliding) and by the material that slides out
// (c); p says whether its heat capacity grows with the normal force. The whole heat memory of friction/contact_heat.hpp is tried
// besides. Heat that is gone within a few samples would be no memory but the force itself: the rates are bounded. Coefficients
// and rates are fitted by least squares with Student's t, and each take is predicted from the others.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/slip_record.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct thermal_rates {
  double conduction_1_s = 300, renewal = 0, exchange_1_m = 3000, capacity_power = 0;  ///< a, b, c, p
};

struct law_fit {
  contact_law law = contact_law::velocity_curve;
  design_fit fit{};
  stick_design design{};
  thermal_rates rates{};
  bool heat_memory = false;  ///< contact_heat.hpp instead of one temperature
  contact_heat_parameters<double> heat{};

  /// Robust rms of what is left, as a coefficient of friction.
  [[nodiscard]] double residual() const noexcept { return fit.solution.scale; }
};

namespace detail {

[[nodiscard]] inline std::vector<double> one_temperature(const slip_record& r, const std::vector<char>& slipping,
                                                         const thermal_rates& k) {
  std::vector<double> rise(r.relative_m_s.size());
  const double step = 1 / r.rate_Hz, scale = 1e3 / std::pow(r.normal_N, k.capacity_power),
               rest = std::exp(-k.conduction_1_s * step);
  double now = 0;
  const auto advance = [&](std::size_t i) {
    if (!slipping[i]) return now *= rest;
    const double v = std::abs(r.relative_m_s[i] - r.phases.level_m_s),
                 rate = k.conduction_1_s + k.renewal * std::sqrt(v) + k.exchange_1_m * v;
    const double x = rate * step, keep = std::exp(-x);
    const double force_N = std::abs(r.force_N[i]) / (r.load.empty() ? 1 : r.load[i]);  // the contact grows with its load
    return now = now * keep + scale * v * force_N * (x > 1e-9 ? (1 - keep) / rate : step);
  };
  const auto [first, last] = before_the_slips(r.phases, rise.size());
  for (std::size_t i = first; i < last; ++i) advance(i);
  for (std::size_t i = first; i < rise.size(); ++i) rise[i] = advance(i);
  return rise;
}

/// A few rows more, hardly of weight: where a take has no samples the spline goes on straight, so that it can predict another
/// take.
template <class = void>
void keep_smooth(stick_rows& rows, double weight = 0.1) {
  const Eigen::Index n = rows.target.size(), extra = rows.shared.cols() - 2;
  rows.target.conservativeResize(n + extra);
  rows.shared.conservativeResize(n + extra, Eigen::NoChange);
  for (Eigen::Index k = 0; k < extra; ++k) {
    rows.target[n + k] = 0;
    rows.shared.row(n + k).setZero();
    rows.shared(n + k, k) = rows.shared(n + k, k + 2) = weight;
    rows.shared(n + k, k + 1) = -2 * weight;
    rows.sample.push_back(rows.sample.empty() ? 100 : rows.sample.back() + 100);
  }
}

/// Strokes that may be off against the first by a constant each: a column of its own for each but the first, of which the rows
/// that keep the law smooth have nothing.
template <class Real = double>
void free_levels(stick_design& d) {
  for (std::size_t t = 1; t < d.rows.size(); ++t) {
    auto& rows = d.rows[t];
    const Eigen::Index c = rows.own.cols(), samples = rows.target.size() - (rows.shared.cols() - 2);
    rows.own.conservativeResize(rows.target.size(), c + 1);
    rows.own.col(c) << Eigen::VectorX<Real>::Ones(samples), Eigen::VectorX<Real>::Zero(rows.target.size() - samples);
  }
}

/// Rows of the spline equation for one x per sample and take; every `stride`-th slip sample.
template <class Real = double>
[[nodiscard]] stick_design law_design(const std::vector<slip_record>& records, const std::vector<Eigen::VectorXd>& x,
                                      std::size_t stride) {
  std::vector<double> all;
  for (const auto& v : x) all.insert(all.end(), v.data(), v.data() + v.size());
  const smooth_functions functions(all);
  stick_design d;
  for (std::size_t t = 0; t < records.size(); ++t) {
    const auto& s = records[t].slips;
    const auto n = (s.sample.size() + stride - 1) / stride;
    Eigen::VectorX<Real> at(static_cast<Eigen::Index>(n)), y(at.size());
    stick_rows rows;
    for (std::size_t i = 0; i < n; ++i) {
      const auto k = static_cast<Eigen::Index>(i * stride);
      at[static_cast<Eigen::Index>(i)] = x[t][k], y[static_cast<Eigen::Index>(i)] = s.friction[k];
      rows.sample.push_back(s.sample[i * stride]);
    }
    rows.target = y;
    rows.shared = functions(at);
    keep_smooth(rows);
    rows.own = Eigen::MatrixX<Real>(rows.target.size(), 0);
    d.rows.push_back(std::move(rows));
  }
  for (Eigen::Index c = 0; c < d.rows.front().shared.cols(); ++c) d.add_bound(-1e30, 1e30);
  return d;
}
ROSIN_INSTANTIATE(stick_design law_design(const std::vector<slip_record>&, const std::vector<Eigen::VectorXd>&, std::size_t))

/// What a law remembers, at the slips: the value of the sample before.
[[nodiscard]] inline Eigen::VectorXd before_slips(const slip_record& r, const std::vector<double>& memory) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(r.slips.sample.size()));
  for (Eigen::Index i = 0; i < x.size(); ++i)
    x[i] = memory[std::max<std::size_t>(1, r.slips.sample[static_cast<std::size_t>(i)]) - 1];
  return x;
}

/// What a design leaves, quickly, for a search: the inverse of the geometric mean of Student's densities, a few passes of
/// reweighting. (Ordinary least squares would follow the few samples at which a slip was cut too late.)
template <class Real = double>
[[nodiscard]] double quick_residual(const stick_design& d, double floor = 1e-6) {
  const stacked s = stack(d.rows);
  const Eigen::Index n = std::max<Eigen::Index>(1, s.y.size());
  Eigen::VectorX<Real> weight = Eigen::VectorX<Real>::Ones(s.y.size()), r = s.y;
  double scale = 0, density = 0;
  for (int pass = 0; pass < 6; ++pass) {
    const Eigen::MatrixX<Real> weighted = weight.asDiagonal() * s.x;
    Eigen::MatrixX<Real> h = s.x.transpose() * weighted;
    h.diagonal().array() += 1e-9 * h.diagonal().maxCoeff();
    r = s.y - s.x * h.ldlt().solve(weighted.transpose() * s.y);
    for (int inner = 0; inner < 3; ++inner) {
      scale = std::max(floor, std::sqrt(weight.dot(r.cwiseAbs2()) / static_cast<double>(n)));
      weight = student_weights(r, scale);
    }
  }
  for (const double x : r) density += student_log_density(x, scale);
  return std::exp(-density / static_cast<double>(n));
}
ROSIN_INSTANTIATE(double quick_residual(const stick_design&, double))

[[nodiscard]] inline std::vector<double> heat_along(const slip_record& r, const contact_heat_parameters<double>& heat) {
  return temperature_along(r.force_N, r.relative_m_s, r.phases, r.normal_N, r.rate_Hz, heat, r.load);
}

[[nodiscard]] inline std::vector<std::vector<char>> slipping_in(const std::vector<slip_record>& records) {
  std::vector<std::vector<char>> out;
  for (const auto& r : records) out.push_back(interior(r.phases.slips, r.relative_m_s.size(), 0));
  return out;
}

template <class Memory>
[[nodiscard]] stick_design memory_design(const std::vector<slip_record>& records, const Memory& memory, std::size_t stride) {
  std::vector<Eigen::VectorXd> x;
  for (std::size_t t = 0; t < records.size(); ++t) x.push_back(before_slips(records[t], memory(t)));
  return law_design(records, x, stride);
}
[[nodiscard]] inline stick_design rates_design(const std::vector<slip_record>& records,
                                               const std::vector<std::vector<char>>& slipping, const thermal_rates& rates,
                                               std::size_t stride) {
  return memory_design(
      records, [&](std::size_t t) { return one_temperature(records[t], slipping[t], rates); }, stride);
}

}  // namespace detail

/// Precondition of all fits: 200 slip samples in all.
template <class Real = double>
[[nodiscard]] law_fit fit_velocity_curve(const std::vector<slip_record>& records, double floor) {
  std::vector<Eigen::VectorX<Real>> x;
  for (const auto& r : records) x.push_back(r.slips.speed_m_s);
  law_fit out;
  out.design = detail::law_design(records, x, 2);
  out.fit = fit_design(out.design, floor);
  return out;
}
ROSIN_INSTANTIATE(law_fit fit_velocity_curve(const std::vector<slip_record>&, double))

/// A contact whose heat memory is known.
template <class = void>
[[nodiscard]] law_fit fit_memory(const std::vector<slip_record>& records, double floor,
                                 const contact_heat_parameters<double>& heat) {
  law_fit out;
  out.law = contact_law::thermal, out.heat_memory = true, out.heat = heat;
  out.design = detail::memory_design(
      records, [&](std::size_t t) { return detail::heat_along(records[t], heat); }, 2);
  out.fit = fit_design(out.design, floor);
  return out;
}

/// A contact of one temperature whose rates are known.
template <class = void>
[[nodiscard]] law_fit fit_rates(const std::vector<slip_record>& records, double floor, const thermal_rates& rates) {
  law_fit out;
  out.law = contact_law::thermal, out.rates = rates;
  out.design = detail::rates_design(records, detail::slipping_in(records), rates, 2);
  out.fit = fit_design(out.design, floor);
  return out;
}

/// A law that was found, on other forces along the same motion: its memory is kept.
template <class = void>
[[nodiscard]] law_fit fit_again(const std::vector<slip_record>& records, double floor, const law_fit& found) {
  if (found.law != contact_law::thermal) return fit_velocity_curve(records, floor);
  return found.heat_memory ? fit_memory(records, floor, found.heat) : fit_rates(records, floor, found.rates);
}

template <class = void>
[[nodiscard]] law_fit fit_thermal(const std::vector<slip_record>& records, double floor) {
  const auto slipping = detail::slipping_in(records);
  std::size_t samples = 0;
  for (const auto& r : records) samples += r.slips.sample.size();
  const std::size_t stride = std::max<std::size_t>(2, samples / 6000);
  law_fit out;
  double best = 1e300;
  const auto attempt = [&](thermal_rates k) {
    if (!(k.conduction_1_s + k.renewal + k.exchange_1_m > 0) || k.conduction_1_s > 5e3 || k.renewal > 1e4 ||
        k.exchange_1_m > 1.2e4)
      return 1e300;
    const double r = detail::quick_residual(detail::rates_design(records, slipping, k, stride));
    if (r < best) best = r, out.rates = k;
    return r;
  };
  const auto scaled = [](double rate, double by) {
    return rate > 0 ? (rate * by < 2 ? 0.0 : rate * by) : by > 1 ? 20 * by : 0.0;
  };
  const auto descend = [&](double smallest) {
    for (double factor = 2.5; factor > smallest; factor = std::sqrt(factor))
      for (int round = 0; round < 8; ++round) {  // the valley runs across a and c: their directions together, then b's
        const double before = best;
        const thermal_rates from = out.rates;
        for (const auto& [i, j, k] : {std::array{1, 0, 0},
                                      {-1, 0, 0},
                                      {0, 0, 1},
                                      {0, 0, -1},
                                      {1, 0, 1},
                                      {-1, 0, -1},
                                      {1, 0, -1},
                                      {-1, 0, 1},
                                      {0, 1, 0},
                                      {0, -1, 0}})
          attempt({scaled(from.conduction_1_s, std::pow(factor, i)), scaled(from.renewal, j == 0 ? 1.0 : std::pow(factor, j)),
                   scaled(from.exchange_1_m, std::pow(factor, k)), from.capacity_power});
        if (!(best < 0.999 * before)) break;
      }
  };
  // Coarsely with either capacity, the better one to the end.
  std::array<std::pair<double, thermal_rates>, 2> with_capacity;
  for (const double p : {0.0, 1.0}) {
    best = 1e300;
    for (const double a : {100.0, 1000.0})
      for (const double c : {0.0, 3000.0}) attempt({a, c > 0 ? 0.0 : 1000.0, c, p});
    descend(1.2);
    with_capacity[p > 0] = {best, out.rates};
  }
  best = 1e300;
  attempt(with_capacity[with_capacity[1].first < with_capacity[0].first].second);
  descend(1.005);
  double best_memory = 1e300;
  contact_heat_parameters<double> found;
  const auto remember = [&](double layer, double area) {
    const contact_heat_parameters<double> heat{.layer_m = layer, .area_per_newton_m2 = area};
    const double r = detail::quick_residual(detail::memory_design(
        records, [&](std::size_t t) { return detail::heat_along(records[t], heat); }, stride));
    if (r < best_memory) best_memory = r, found = heat;
  };
  for (const double layer : {1e-6, 3.5e-6})
    for (const double area : {0.6e-7, 1.5e-7}) remember(layer, area);
  if (best_memory < 2 * best)
    for (double factor = 1.6; factor > 1.01; factor = std::sqrt(factor))
      for (int round = 0; round < 4; ++round) {
        const double before = best_memory;
        const auto from = found;
        for (const auto& [i, j] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          remember(from.layer_m * std::pow(factor, i), from.area_per_newton_m2 * std::pow(factor, j));
        if (!(best_memory < 0.999 * before)) break;
      }
  if (best_memory < best) return fit_memory(records, floor, found);
  return fit_rates(records, floor, out.rates);
}
ROSIN_INSTANTIATE(law_fit fit_thermal(const std::vector<slip_record>&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
