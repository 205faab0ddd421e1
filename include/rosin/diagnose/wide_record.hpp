// tier: hosted
// SPDX-License-Identifier: MIT
//
// A contact of some width w holds the string at two places, not at one. With a width assumed the
// two places follow exactly from the two ends' forces, F_1 and F_2, by what waves do between them:
//
//     v_a = F_1 sinh(g a) / Z_w,   v_b = F_2 sinh(g b) / Z_w,   (f_a +- f_b) / G = F_1 cosh(g a) +- F_2 cosh(g b) + Z_w (v_a +- v_b) tanh(g d)^(+-1)
//
// with a = tau_1 - d, b = tau_2 - d, d = w / (2 c), and torsion between them (torsion_pair.hpp). Where a side carries loads or
// ends on what moves, what stands for its sinh and cosh is in string_side.hpp.
//
#pragma once

#include <rosin/diagnose/contact_stick.hpp>
#include <rosin/propagate/transmission.hpp>
#include <rosin/torsion/torsion_pair.hpp>

#include <type_traits>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Both places of a wide contact, smoothed.
struct wide_motion {
  std::vector<double> near_m_s, far_m_s;          ///< surface velocities less the rod's
  std::array<std::vector<double>, 2> compliance;  ///< columns as in stick_record
};

/// Both places of a wide contact as one.
struct wide_as_one {
  std::vector<double> velocity_m_s, force_N;
  double velocity_noise_m_s, force_noise_N;  ///< rms
};

/// A take's terminations, transformed once.
class wide_record {
  using complex = std::complex<double>;

public:
  template <class = void>
  wide_record(const contact_take& take, const stick_record& record)
      : take_{take}, rod_m_s_{record.rod_m_s()}, edge_Hz_{record.window().edge_Hz},
        near_{record.known(take.near_N), take.rate_Hz}, far_{record.known(take.far_N), take.rate_Hz} {}

  /// `columns` of compliance; those that are not asked for are empty.
  [[nodiscard]] wide_motion at(double half_delay_s, const smooth_window& window, const torsion_values& values,
                               torsion_damping damping = torsion_damping::constant_q, std::size_t columns = 2) {
    const torsion_pair torsion = rolling(half_delay_s, values, damping);
    const auto table = by_bins(window.edge_Hz, [&](double f) { return passage(f, half_delay_s, torsion); });
    wide_motion m{row_of(table, 0, window), row_of(table, 1, window), {}};
    for (std::size_t i = 0; i < columns; ++i) m.compliance[i] = row_of(table, 2 + i, window);
    for (auto* v : {&m.near_m_s, &m.far_m_s}) detail::add_to(*v, rod_m_s_, -1);
    return m;
  }

  /// What the sensors' noise makes either place seem to move by, rms of both.
  [[nodiscard]] double noise_m_s(double half_delay_s, const smooth_window& window, const torsion_values& values,
                                 torsion_damping damping) const {
    const torsion_pair torsion = rolling(half_delay_s, values, damping);
    const auto place = [&](std::size_t first) {
      return [&, first](double f) { return columns(passage(f, half_delay_s, torsion), first); };
    };
    const auto noise = [&](std::size_t first) {
      return detail::noise_of_ends(place(first), take_.noise_N, take_.rate_Hz, window);
    };
    return std::hypot(noise(0), noise(1)) / std::numbers::sqrt2;
  }

  /// Both places as one contact, below `edge_Hz` and unsmoothed: the centre's mean velocity as it would be if one contact's
  /// torsion turned it under the force of both, and that force; and what the sensors' noise is in them through a window that ends
  /// there.
  [[nodiscard]] wide_as_one as_one(double half_delay_s, const smooth_window& window, const torsion_values& values,
                                   torsion_damping damping, const torsion_at_contact& single) {
    constexpr smooth_window flat{1e15};
    const torsion_pair torsion = rolling(half_delay_s, values, damping);
    const auto rows = [&](double f) { return passage_as_one(f, half_delay_s, torsion, single); };
    const auto noise = [&](std::size_t row) {
      return detail::noise_of_ends([&](double f) { return columns(rows(f), row); }, take_.noise_N, take_.rate_Hz, window);
    };
    const auto table = by_bins(window.edge_Hz, rows);
    return {row_of(table, 0, flat), row_of(table, 1, flat), noise(0), noise(1)};
  }

  /// Up to where both places can be told apart: their sum has its first pole at 1 / (4 d).
  [[nodiscard]] static smooth_window below_pole(const smooth_window& window, double half_delay_s) noexcept {
    return {half_delay_s > 0 ? std::min(window.edge_Hz, 0.22 / half_delay_s) : window.edge_Hz};
  }

  /// where the piece between both places is half a wave long, their sum is all noise
  static constexpr double pole_width = 0.1;

private:
  [[nodiscard]] torsion_pair rolling(double half_delay_s, const torsion_values& v, torsion_damping damping) const {
    const auto delay_s = take_.rest_delay_s();
    return {{(delay_s[0] - half_delay_s) / v.speed_ratio, 2 * half_delay_s / v.speed_ratio,
             (delay_s[1] - half_delay_s) / v.speed_ratio},
            take_.rest_impedance_Ns_m() * v.impedance_ratio,
            v.q,
            damping,
            torsion_modes::seen_below(edge_Hz_, (delay_s[0] + delay_s[1]) / v.speed_ratio)};
  }

  /// Row r of a table: columns F_1, F_2 in 2 r, 2 r + 1.
  template <std::size_t Size>
  [[nodiscard]] static std::array<complex, 2> columns(const std::array<complex, Size>& table, std::size_t row) noexcept {
    return {table[2 * row], table[2 * row + 1]};
  }
  /// A table's values at both signals' bins below the edge.
  template <class Passage>
  [[nodiscard]] std::vector<std::invoke_result_t<Passage, double>> by_bins(double edge_Hz, const Passage& at) const {
    std::vector<std::invoke_result_t<Passage, double>> out;
    out.reserve(static_cast<std::size_t>(edge_Hz / near_.bin_Hz()) + 1);
    for (std::size_t k = 0; static_cast<double>(k) * near_.bin_Hz() < edge_Hz; ++k)
      out.push_back(at(static_cast<double>(k) * near_.bin_Hz()));
    return out;
  }
  /// A row of a table as a signal, through a window.
  template <class Table>
  [[nodiscard]] std::vector<double> row_of(const Table& table, std::size_t row, const smooth_window& window) {
    const auto column = [&](std::size_t side) { return [&, side](std::size_t k) { return table[k][2 * row + side]; }; };
    return near_.through_with(far_, window, table.size(), column(0), column(1));
  }

  /// Rows: the centre's mean velocity less one contact's torsion, the force of both places.
  [[nodiscard]] std::array<complex, 4> passage_as_one(double f, double d, const torsion_pair& torsion,
                                                      const torsion_at_contact& single) const {
    if (f == 0) return {0, 0, 1, 1};
    const auto row = passage(f, d, torsion);
    std::array<complex, 4> out;
    for (const std::size_t side : {0U, 1U}) {
      out[2 + side] = row[4 + side] / complex(0, 2 * std::numbers::pi * f * stick_record::compliance_unit);
      out[side] = 0.5 * (row[side] + row[2 + side]) - single(f) * out[2 + side];
    }
    return out;
  }

  /// Rows: surface at a, surface at b, two columns of compliance; columns: F_1, F_2.
  [[nodiscard]] std::array<complex, 8> passage(double f, double d, const torsion_pair& torsion) const {
    if (f == 0) return {};
    const double w = 2 * std::numbers::pi * f, eps = take_.stiffness_s2, Z = take_.impedance_Ns_m * wave_impedance_ratio(w, eps);
    const complex g = propagation_rate(f, eps, take_.loss);
    const complex near_field(0, -near_field_ratio(w, eps) / (2 * Z * force_factor(w, eps)));
    const double a = take_.delay_s[0] - d, b = take_.delay_s[1] - d;
    const plain::hyperbolic half(g * d);
    const complex cosh_d = half.cosh, sinh_d = half.sinh,
                  tanh_d = sinh_d * std::conj(cosh_d) / (std::norm(cosh_d) + pole_width * pole_width);
    const auto rolls = torsion(f);
    std::array<complex, 8> out;
    for (const std::size_t side : {0U, 1U}) {
      const double own = side == 0 ? a : b, sign = side == 0 ? 1 : -1;
      const auto waves = detail::waves_at(f, eps, g, take_.sides[side].clamping);
      const auto here = take_.sides[side].at(own, waves);
      const complex v = here.velocity / Z, c = here.force, sum = waves.force_factor * (c + tanh_d * Z * v);
      const complex difference =
          d > 0 ? waves.force_factor * sign * (c + Z * v * cosh_d * std::conj(sinh_d) / (std::norm(sinh_d) + 1e-12)) : complex(0);
      const complex fa = 0.5 * (sum + difference), fb = 0.5 * (sum - difference);
      out[side] = (side == 0 ? v : complex(0)) + (rolls.aa + near_field) * fa + rolls.across * fb;
      out[2 + side] = (side == 1 ? v : complex(0)) + (rolls.bb + near_field) * fb + rolls.across * fa;
      out[4 + side] = sum * complex(0, w * stick_record::compliance_unit);
      out[6 + side] = out[4 + side] * std::pow(f / stick_record::compliance_corner_Hz, 2);
    }
    return out;
  }

  contact_take take_;
  std::vector<double> rod_m_s_;
  double edge_Hz_;
  contact_signal<> near_, far_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
