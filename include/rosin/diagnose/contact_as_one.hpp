// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a contact of some width that was found leaves to the rest of the catalogue: one contact, which moves as both its places do
// on the average and pulls with the force of both (wide_record.hpp), up to where both can be told apart. Torsion is that of a
// string held at two places; what one contact's torsion would make of the force is set off against it, so that whoever adds that
// has the true surface.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/wide_record.hpp>

#include <cmath>
#include <limits>

namespace rosin {

/// Takes of one contact, and the signals that they look at.
struct one_contact {
  std::vector<std::vector<double>> force_N, velocity_m_s;
  std::vector<contact_take> takes;
};

/// Nothing where no width is known or the terminations' forces are not given. Torsion: as the model has it, or none.
template <class = void>
[[nodiscard]] std::optional<one_contact> as_one_contact(const std::vector<contact_take>& all, const contact_model& model) {
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
    const smooth_window window = wide_record::below_pole(record.window(), half_s);
    const wide_as_one whole = wide_record(take, record).as_one(half_s, window, torsion, torsion_damping::constant_q, single);
    const auto placed = [&](const std::vector<double>& known) {
      std::vector<double> padded(take.force_N.size(), std::numeric_limits<double>::quiet_NaN());
      std::copy(known.begin(), known.end(), padded.begin() + static_cast<std::ptrdiff_t>(record.origin()));
      return padded;
    };
    out.force_N.push_back(placed(whole.force_N)), out.velocity_m_s.push_back(placed(whole.velocity_m_s));
    contact_take one = take;
    one.edge_Hz = window.edge_Hz;
    one.force_N = out.force_N.back(), one.velocity_m_s = out.velocity_m_s.back();
    one.velocity_near_m_s = one.velocity_far_m_s = one.near_N = one.far_N = {};
    one.force_sd_N = whole.force_noise_N, one.velocity_sd_m_s = whole.velocity_noise_m_s / std::sqrt(stick_bench::passed_noise);
    out.takes.push_back(one);
  }
  return out;
}
ROSIN_INSTANTIATE(std::optional<one_contact> as_one_contact(const std::vector<contact_take>&, const contact_model&))

}  // namespace rosin
