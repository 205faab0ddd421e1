// SPDX-License-Identifier: MIT
//
// A take that ends with the bow lifted: pitch and loss of the string from its free decay, beside those of the plucks.
//
#include "digits.hpp"
#include "reconstruct_take.hpp"

#include <numbers>

namespace tool {

namespace {

struct pitch_difference {
  double cents = 0, sd = 0;
};

double fundamental_of(const rosin::calibration& c) { return 0.5 / (c.at.delay_s[0] + c.at.delay_s[1]); }

pitch_difference against_plucks(const take_reconstruction& r) {
  const auto& c = r.before.covariance;
  const double plucked = fundamental_of(r.before),
               relative = 2 * plucked * std::sqrt(std::max(0.0, c(0, 0) + 2 * c(0, 1) + c(1, 1)));
  const double per_cent = 1200 / std::numbers::ln2;
  return {1200 * std::log2(r.decay->fundamental_Hz / plucked),
          per_cent * std::hypot(relative, r.decay->fundamental_sd / plucked)};
}

/// Numbers of partials at which Q is told: the first, and the last of the octaves above.
std::vector<int> told(const rosin::free_decay& d) {
  std::vector<int> out;
  for (int n = 1; n <= std::max(d.partials[0].back().number, d.partials[1].back().number); n *= 2) out.push_back(n);
  return out;
}

}  // namespace

void find_free_decay(take_reconstruction& r) {
  const double f0 = fundamental_of(r.before);
  if (!(r.known.end > r.known.begin)) return;
  const auto known = std::span<const double>(r.force_N).subspan(r.known.begin, r.known.end - r.known.begin);
  if (const auto end = rosin::contact_ends(known, r.rate_Hz, f0, !r.ac_coupled)) r.lifted = r.known.begin + *end;
  if (!r.lifted) return;
  if (r.steady_end > *r.lifted) {  // nothing repeats as well as a string left alone, but that is no bowing
    r.steady_begin = r.steady_end = 0, r.period_s = 0;
    r.domains_differ.reset();
    r.warnings.emplace_back("the motion repeats best after the bow is off: no steady part of the bowing is named");
  }
  const rosin::free_decay_options expected{.inharmonicity = r.before.at.stiffness_s2 * std::pow(2 * std::numbers::pi * f0, 2),
                                           .highest_Hz = r.limits.pass_Hz};
  const auto& f = r.result.force_N;
  auto decay = rosin::fit_free_decay({f[0], f[1]}, r.rate_Hz, f0, r.time_s(*r.lifted), expected);
  if (!decay) return;
  r.decay = *std::move(decay);
  const auto [cents, sd] = against_plucks(r);
  if (std::abs(cents) > std::max(5 * sd, 0.5))
    r.warnings.push_back("the free decay at the end is " + in_digits(cents, "%+.2f") +
                         " cent from the plucks: the tension changed by " +
                         in_digits(100 * (std::exp2(cents / 600) - 1), "%+.3f") + " % in between");
}

std::string decay_text(const take_reconstruction& r) {
  std::string out = "the bow is off from " + in_digits(r.time_s(*r.lifted), "%.4f") + " s on";
  if (!r.decay) return out + "; too short, or too faint, for pitch and loss";
  const auto [cents, sd] = against_plucks(r);
  out += ": " + in_digits(r.decay->fundamental_Hz, "%.4f") + " +- " + in_digits(r.decay->fundamental_sd, "%.1g") + " Hz, " +
         in_digits(cents, "%+.3f") + " +- " + in_digits(sd, "%.1g") + " cent against the plucks; Q";
  for (const int n : told(*r.decay)) {
    const double f = r.decay->frequency_Hz(n), q = r.decay->quality(n);
    out += (n > 1 ? ", " : " ") + in_digits(q, "%.0f") + " +- " + in_digits(q * q * r.decay->loss.inverse_q_sd(f), "%.1g") +
           " (plucks " + in_digits(1 / r.before.at.loss.inverse_q(f), "%.0f") + ") at " + in_digits(1e-3 * f, "%.2f") + " kHz";
  }
  return out;
}

json decay_json(const take_reconstruction& r) {
  if (!r.lifted) return nullptr;
  json out{{"begin_s", r.time_s(*r.lifted)}};
  if (!r.decay) return out;
  const auto& d = *r.decay;
  const auto [cents, sd] = against_plucks(r);
  out.update({{"fitted_s", {d.begin_s, d.end_s}},
              {"fundamental_Hz", d.fundamental_Hz},
              {"fundamental_sd_Hz", d.fundamental_sd},
              {"inharmonicity", d.inharmonicity},
              {"inharmonicity_sd", d.inharmonicity_sd},
              {"cents_from_plucks", cents},
              {"cents_sd", sd}});
  out["loss"] = json::array();
  for (const int n : told(d)) {
    const double f = d.frequency_Hz(n);
    out["loss"].push_back({{"frequency_Hz", f},
                           {"inverse_q", d.loss.law.inverse_q(f)},
                           {"inverse_q_sd", d.loss.inverse_q_sd(f)},
                           {"inverse_q_of_plucks", r.before.at.loss.inverse_q(f)}});
  }
  return out;
}

}  // namespace tool
