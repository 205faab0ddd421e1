// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a fit of strokes is given, which quantities it seeks, and in which order they stand:
//
//     f0, b = pi^2 B / (T L^2), ln 1/Q, internal loss, ln (gain near / gain far), skew        shared by all takes
//     position of the contact                                                                of each take
//     drift: ln of f0 in this take over that of all                                          of each take
//     u_n: ln of Q over its law                                                              of each mode in the band
//
// All of them have priors: nominal values with their tolerances, and for drift and u_n a spread that the data choose
// (stroke_fit.hpp).
//
#pragma once

#include <rosin/calibrate/uneven_string.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace rosin {

/// One recorded stroke: forces on the terminations in nominal newtons.
struct stroke_take {
  std::string name{};
  double rate_Hz = 0;
  std::array<std::vector<double>, 2> force_N{};  ///< near, far; equally long
  double position = 0.1;                         ///< declared, from the near end
};

/// What is known beforehand. Tolerances are limits: two standard deviations.
struct stroke_guess {
  double fundamental_Hz = 0;
  double fundamental_tolerance = 0.01;  ///< relative
  double inharmonicity = 0;             ///< 0: unknown
  double inharmonicity_tolerance = 0.3;
  double quality = 1000;
  std::array<double, 2> gain_tolerance{0.05, 0.05};
  double position_tolerance = 0.005;
};

struct stroke_options {
  double edge_Hz = 8000;      ///< the records are used up to here
  double skew_sd_s = 2e-6;    ///< 0: the channels are known to be of one time
  double most_drift = 3e-3;   ///< standard deviation of the drift of pitch from take to take, at most
  double least_drift = 1e-8;  ///< and at least
  double most_scatter = 0.5;  ///< the same of u_n
  double least_scatter = 1e-3;
  bool one_by_one = true;  ///< where the takes contradict each other, each is left out once
};

/// Where each parameter stands in the vectors and matrices of the fit.
class stroke_layout {
public:
  enum shared { fundamental, inharmonicity, ln_inverse_quality, internal_loss, ln_gain_ratio, skew, first_position };

  stroke_layout() = default;
  stroke_layout(std::size_t takes, std::size_t modes) : takes_{takes}, modes_{modes} {}

  [[nodiscard]] Eigen::Index size() const noexcept { return own_q(modes_); }
  [[nodiscard]] std::size_t takes() const noexcept { return takes_; }
  [[nodiscard]] std::size_t modes() const noexcept { return modes_; }
  [[nodiscard]] Eigen::Index position(std::size_t take) const noexcept {
    return first_position + static_cast<Eigen::Index>(take);
  }
  [[nodiscard]] Eigen::Index drift(std::size_t take) const noexcept { return position(takes_ + take); }
  [[nodiscard]] Eigen::Index own_q(std::size_t mode) const noexcept { return drift(takes_ + mode); }

  [[nodiscard]] std::string name(Eigen::Index p) const {
    static constexpr std::array names{"fundamental_Hz",  "inharmonicity", "ln_inverse_quality",
                                      "loss_internal_s", "ln_gain_ratio", "skew_s"};
    if (p < first_position) return names[static_cast<std::size_t>(p)];
    if (p < drift(0)) return "position of take " + std::to_string(p - first_position + 1);
    if (p < own_q(0)) return "drift of take " + std::to_string(p - drift(0) + 1);
    return "ln_q of mode " + std::to_string(p - own_q(0) + 1);
  }

  /// The string in a take. Tension drifts, not mass, stiffness or length: epsilon goes as f0^-4 then.
  [[nodiscard]] uneven_string string(const Eigen::VectorXd& v, std::size_t take) const {
    uneven_string s = string(v);
    s.fundamental_Hz *= std::exp(v[drift(take)]);
    s.stiffness_s2 *= std::exp(-4 * v[drift(take)]);
    return s;
  }
  /// The same of all takes.
  [[nodiscard]] uneven_string string(const Eigen::VectorXd& v) const {
    const double w0 = 2 * std::numbers::pi * v[fundamental];
    uneven_string s{v[fundamental], v[inharmonicity] / (w0 * w0), {}, {}};
    s.loss.quality = std::exp(-v[ln_inverse_quality]), s.loss.internal_s = v[internal_loss];
    s.ln_own_q.assign(v.data() + own_q(0), v.data() + size());
    return s;
  }

private:
  std::size_t takes_ = 0, modes_ = 0;
};

}  // namespace rosin
