// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a contact of some width that was found leaves to the rest of the catalogue: one contact, which moves as both its places do on the
// average and pulls with the force of both (contact_width.hpp), up to where both can be told apart. Torsion is that of a string held at two
// places; what one contact's torsion would make of the force is set off against it, so that whoever adds that has the true surface.
//
#pragma once

#include <rosin/diagnose/contact_width.hpp>

#include <cmath>
#include <limits>

namespace rosin {

/// Takes of one contact, and the signals that they look at.
struct one_contact {
  std::vector<std::vector<double>> force_N, velocity_m_s;
  std::vector<contact_take> takes;
};

namespace detail {

/// What the sensors' noise is in a row of columns F_1, F_2, rms, through a window.
template <class Row>
[[nodiscard]] double noise_in(const Row& row, const contact_take& take, const smooth_window& window) {
  constexpr int steps = 400;
  double power = 0;
  for (int k = 0; k < steps; ++k) {
    const double f = window.edge_Hz * (k + 0.5) / steps;
    const auto columns = row(f);
    for (const std::size_t side : {0U, 1U}) power += std::pow(window(f) * take.noise_N[side], 2) * std::norm(columns[side]);
  }
  return std::sqrt(power * 2 * window.edge_Hz / (take.rate_Hz * steps));
}

}  // namespace detail

/// Nothing where no width is known or the terminations' forces are not given. Torsion: as the model has it, or none.
[[nodiscard]] inline std::optional<one_contact> as_one_contact(const std::vector<contact_take>& all, const contact_model& model) {
  constexpr torsion_values stiff{5, 1e12, 10};  // a string that does not turn
  const double half_s = model.width_s / 2;
  if (!(half_s > 0)) return std::nullopt;
  one_contact out;
  for (const contact_take& take : all) {
    if (take.near_N.size() != take.force_N.size() || take.far_N.size() != take.force_N.size()) return std::nullopt;
    const auto sticks = stick_bench::stick_takes({take});
    const stick_record record(sticks.front());
    const torsion_values torsion = model.torsion.value_or(stiff);
    const torsion_at_contact single(sticks.front(), torsion, torsion_damping::constant_q);
    wide_record wide(take, record);
    const auto row = [&](std::size_t first) {
      return [&wide, &single, half_s, torsion, first](double f) {
        const auto columns = wide.as_one(f, half_s, torsion, torsion_damping::constant_q, single);
        return std::array{columns[first], columns[first + 1]};
      };
    };
    const smooth_window window = wide_record::below_pole(record.window(), half_s);
    const auto placed = [&](const std::vector<double>& known) {
      std::vector<double> whole(take.force_N.size(), std::numeric_limits<double>::quiet_NaN());
      std::copy(known.begin(), known.end(), whole.begin() + static_cast<std::ptrdiff_t>(record.origin()));
      return whole;
    };
    out.velocity_m_s.push_back(placed(wide.signal_of(row(0), window.edge_Hz)));
    out.force_N.push_back(placed(wide.signal_of(row(2), window.edge_Hz)));
    contact_take one = take;
    one.edge_Hz = window.edge_Hz;
    one.velocity_near_m_s = one.velocity_far_m_s = one.near_N = one.far_N = {};
    one.velocity_sd_m_s = detail::noise_in(row(0), take, window) / std::sqrt(stick_bench::passed_noise);
    one.force_sd_N = detail::noise_in(row(2), take, window);
    out.takes.push_back(one);
  }
  for (std::size_t t = 0; t < out.takes.size(); ++t) out.takes[t].force_N = out.force_N[t], out.takes[t].velocity_m_s = out.velocity_m_s[t];
  return out;
}

}  // namespace rosin
