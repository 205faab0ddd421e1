// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which quantities a fit of plucks seeks, and in which order they stand:
//
//     f0, b, 1/Q, internal loss, air loss, psi, ln gain near, ln gain far, causality and drag of the loss,     shared by all takes
//     one position for each declared position, or each take,
//     per take: instant of release, ln strength, offset near, offset far,
//     where the loss is uneven, its series; where each mode has a loss of its own, their scatter, and ln of 1/Q over what the law says,
//     where terminations are known to move, of each mode: ln of frequency, q and Z / M over what is declared.
//
#pragma once

#include <rosin/calibrate/own_losses.hpp>
#include <rosin/calibrate/pluck_options.hpp>
#include <rosin/core/outcome.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Where each parameter stands in the vectors and matrices of the fit.
class pluck_layout {
public:
  enum shared {
    fundamental,
    inharmonicity,
    inverse_quality,
    internal_loss,
    air_loss,
    convention,
    gain_near,
    gain_far,
    causality,
    loss_drag,
    first_position
  };
  enum per_take { release, strength, offset_near, offset_far, take_size };

  pluck_layout() = default;
  /// `ends`: for fits whose model has ends (scene_plucks.hpp).
  pluck_layout(const std::vector<pluck_take>& takes, const pluck_options& options,
               const std::array<modal_termination, 2>& ends = {})
      : options_{options}, ends_{ends} {
    for (const pluck_take& take : takes) {
      auto found = options.own_places ? positions_.end() : std::find(positions_.begin(), positions_.end(), take.position);
      group_.push_back(found - positions_.begin());
      if (found == positions_.end()) positions_.push_back(take.position);
      names_.push_back(take.name);
    }
  }

  [[nodiscard]] Eigen::Index size() const {
    return first_of_ends() + 3 * static_cast<Eigen::Index>(ends_[0].modes.size() + ends_[1].modes.size());
  }
  /// What follows the takes is shared by all: the loss's unevenness, and the ends.
  [[nodiscard]] Eigen::Index first_of_uneven() const { return at(group_.size(), 0); }
  [[nodiscard]] Eigen::Index loss_scatter() const {
    return first_of_uneven() + (options_.uneven_loss ? 2 * loss_unevenness::orders : 0);
  }
  /// Of the first mode, ln of its 1/Q over what the law says. There are own_losses() of them.
  [[nodiscard]] Eigen::Index first_of_own() const { return loss_scatter() + 1; }
  [[nodiscard]] int own_losses() const { return options_.own_losses; }
  [[nodiscard]] bool is_own_loss(Eigen::Index p) const { return p >= first_of_own() && p < first_of_ends(); }
  /// They are free, and known to within their scatter, where that is not zero.
  [[nodiscard]] bool has_own_losses(const Eigen::VectorXd& v) const { return own_losses() > 0 && v[loss_scatter()] > 0; }
  template <class = void>
  [[nodiscard]] rosin::own_losses own_losses_of(const Eigen::VectorXd& v, const ringing_string& string) const {
    return {string, v.segment(std::min(first_of_own(), v.size()), has_own_losses(v) ? own_losses() : 0)};
  }
  void free_own_losses(const Eigen::VectorXd& v) { own_losses_free_ = has_own_losses(v); }
  [[nodiscard]] Eigen::Index first_of_ends() const { return loss_scatter() + (own_losses() > 0 ? 1 + own_losses() : 0); }
  [[nodiscard]] bool has_ends() const { return size() > first_of_ends(); }
  [[nodiscard]] std::size_t takes() const { return group_.size(); }
  /// Declared positions, one for each that is fitted.
  [[nodiscard]] const std::vector<double>& positions() const { return positions_; }
  [[nodiscard]] double declared_position(std::size_t take) const { return positions_[static_cast<std::size_t>(group_[take])]; }
  [[nodiscard]] Eigen::Index position(std::size_t take) const { return first_position + group_[take]; }
  [[nodiscard]] Eigen::Index at(std::size_t take, int which) const {
    return first_position + static_cast<Eigen::Index>(positions_.size()) + static_cast<Eigen::Index>(take) * take_size + which;
  }

  [[nodiscard]] bool is_free(Eigen::Index p) const {
    return (p != inharmonicity || options_.stiffness) && (p != internal_loss || options_.internal_loss || options_.causality) &&
           (p != air_loss || options_.air_loss) && (p != convention || options_.convention) &&
           (p != causality || options_.causality) && (p != loss_drag || options_.causality || options_.air_loss) &&
           (p < loss_scatter() || p >= first_of_ends() || (own_losses_free_ && p != loss_scatter()));
  }
  /// Gains and strengths: only their products show.
  [[nodiscard]] bool is_scale(Eigen::Index p) const {
    return p == gain_near || p == gain_far || (p >= at(0, 0) && p < first_of_uneven() && (p - at(0, 0)) % take_size == strength);
  }

  [[nodiscard]] std::string name(Eigen::Index p) const {
    static constexpr std::array names{"fundamental_Hz", "inharmonicity", "inverse_quality", "loss_internal_s", "loss_air_sqrt_Hz",
                                      "convention",     "ln_gain_near",  "ln_gain_far",     "loss_causality",  "loss_drag_Hz"};
    static constexpr std::array mine{"release_s", "ln_strength", "offset_near_N", "offset_far_N"};
    if (p < first_position) return names[static_cast<std::size_t>(p)];
    if (p < at(0, 0)) return positions_.size() == 1 ? "position" : "position " + std::to_string(p - first_position + 1);
    if (p >= first_of_ends()) return name_of_end(static_cast<std::size_t>(p - first_of_ends()));
    if (p >= first_of_own()) return "ln_loss of mode " + std::to_string(p - loss_scatter());
    if (p == loss_scatter()) return "loss_scatter";
    if (p >= first_of_uneven()) return name_of_uneven(static_cast<int>(p - first_of_uneven()));
    const auto i = static_cast<std::size_t>(p - at(0, 0));
    return std::string(mine[i % take_size]) + " of " + names_[i / take_size];
  }

  /// Whether this take depends on this parameter.
  [[nodiscard]] bool concerns(Eigen::Index p, std::size_t take) const {
    return p < at(0, 0) || p >= first_of_uneven() || (p >= at(take, 0) && p < at(take + 1, 0));
  }
  [[nodiscard]] double release_s(const Eigen::VectorXd& v, std::size_t take) const { return v[at(take, release)]; }

  /// Gain of a channel, recorded / true.
  [[nodiscard]] static double gain(const Eigen::VectorXd& v, std::size_t channel) {
    return std::exp(v[gain_near + static_cast<int>(channel)]);
  }

  /// What is slow in a channel from `begin_s` on: its offset, the held string before the release (`held`: recorded newtons), and
  /// what a high-pass makes of both, H(s) = s / (s + w_c): the offset dies away, the step of the release leaves -held exp(-w_c
  /// t).
  template <class = void>
  [[nodiscard]] damped_line slow_line(const Eigen::VectorXd& v, std::size_t take, std::size_t part, double begin_s,
                                      std::size_t channel, double corner_Hz, double held) const {
    const double corner = 2 * std::numbers::pi * corner_Hz, offset = v[at(take, offset_near + static_cast<int>(channel))];
    damped_line slow{-corner, {}};
    slow.residue[channel] = offset * std::exp(-corner * begin_s);
    if (corner == 0 && part == 0) slow.residue[channel] += held;
    if (corner > 0 && part == 1) slow.residue[channel] -= held * std::exp(-corner * (begin_s - release_s(v, take)));
    return slow;
  }

  [[nodiscard]] ringing_string string(const Eigen::VectorXd& v) const {
    loss_law loss{1 / v[inverse_quality], v[internal_loss], v[air_loss], v[causality], v[loss_drag], v[fundamental]};
    if (options_.uneven_loss)
      for (std::size_t i = 0; i < loss_unevenness::orders; ++i) {
        const Eigen::Index p = first_of_uneven() + 2 * static_cast<Eigen::Index>(i);
        loss.uneven.cosine[i] = v[p], loss.uneven.sine[i] = v[p + 1];
      }
    return {v[fundamental], v[inharmonicity], loss, v[convention]};
  }

  /// The terminations: what is declared, and how far it is off.
  [[nodiscard]] std::array<modal_termination, 2> ends(const Eigen::VectorXd& v) const {
    auto out = ends_;
    Eigen::Index p = first_of_ends();
    for (modal_termination& end : out)
      for (admittance_mode& m : end.modes) {
        m.frequency_Hz *= std::exp(v[p]), m.q *= std::exp(v[p + 1]), m.per_mass_per_s *= std::exp(v[p + 2]);
        p += 3;
      }
    return out;
  }

  /// Steps for numerical derivatives of poles and residues: small against what each parameter can be known to.
  [[nodiscard]] double step(Eigen::Index p, const Eigen::VectorXd& v) const {
    static constexpr std::array common{0.0, 1e-9, 1e-8, 1e-12, 1e-6, 1e-4, 1e-6, 1e-6, 1e-5, 1e-5};
    static constexpr std::array mine{1e-9, 1e-6, 1e-6, 1e-6};
    if (p == fundamental) return 1e-7 * v[p];
    if (p < first_position) return common[static_cast<std::size_t>(p)];
    if (p >= first_of_uneven()) return 1e-5;
    return p < at(0, 0) ? 1e-7 : mine[static_cast<std::size_t>(p - at(0, 0)) % take_size];
  }

  /// What is known of a parameter beforehand: value and standard deviation; sd 0: nothing.
  struct knowledge {
    double value, sd;
  };
  [[nodiscard]] knowledge prior(Eigen::Index p, const std::vector<pluck_take>& takes, const pluck_guess& guess) const {
    if (p == gain_near || p == gain_far) return {0, guess.gain_tolerance[static_cast<std::size_t>(p - gain_near)] / 2};
    if (p == convention) return {0, 1.5};   // conventions lie between -1 and 1
    if (p == causality) return {0.5, 0.5};  // between 0 and 1
    // a tenth of the loss at the first partial and at the thirtieth: no law is exact
    if (p == loss_drag) return {0, 0.1 * guess.fundamental_Hz / guess.quality};
    if (p == internal_loss && !options_.internal_loss) return {0, 0.1 / (guess.quality * 30 * guess.fundamental_Hz)};
    if (p == inharmonicity && options_.stiffness && guess.inharmonicity > 0)
      return {guess.inharmonicity, 0.3 * guess.inharmonicity};  // for what does not tell it yet: short looks, few partials
    if (p >= first_of_ends()) return {0, end_doubt[static_cast<std::size_t>(p - first_of_ends()) % 3] / 2};
    if (p >= loss_scatter()) return {0, 0};  // own losses: by their scatter
    if (p >= first_of_uneven()) return {0, uneven_doubt / 5};
    if (p < at(0, 0) || !is_scale(p)) return {0, 0};
    const pluck_take& take = takes[static_cast<std::size_t>(p - at(0, 0)) / take_size];
    return {std::log(take.strength_N), take.strength_tolerance / 2};
  }

  /// Starting point: pitch, releases and positions as given; nominal values for the rest.
  template <class Real = double>
  [[nodiscard]] Eigen::VectorXd initial(const std::vector<pluck_take>& takes, const pluck_guess& guess, double fundamental_Hz,
                                        const std::vector<double>& release_s, const std::vector<double>& position_of) const {
    Eigen::VectorX<Real> v = Eigen::VectorX<Real>::Zero(size());
    v[fundamental] = fundamental_Hz;
    v[inharmonicity] = options_.stiffness ? guess.inharmonicity : 0.0;
    v[inverse_quality] = 1 / guess.quality;
    v[convention] = options_.convention ? 0.0 : -1.0;
    for (std::size_t t = 0; t < takes.size(); ++t) {
      v[position(t)] = position_of[t];
      v[at(t, release)] = release_s[t];
      v[at(t, strength)] = std::log(takes[t].strength_N);
    }
    return v;
  }

  /// Whether a string could be like this, and near enough to where the fit began.
  [[nodiscard]] bool plausible(const Eigen::VectorXd& v, const Eigen::VectorXd& start, double highest_Hz) const {
    bool ok = v.allFinite() && std::abs(v[fundamental] / start[fundamental] - 1) < 0.08 && v[inverse_quality] > 1e-7 &&
              v[inverse_quality] < 0.2 && v[inharmonicity] > -1e-5 && v[inharmonicity] < 0.01 && std::abs(v[convention]) < 300 &&
              std::abs(v[causality]) < 10;
    for (const double f : {v[fundamental], 30 * v[fundamental], highest_Hz}) ok = ok && string(v).loss.inverse_q(f) > 0;
    for (std::size_t t = 0; t < group_.size(); ++t)
      ok = ok && v[position(t)] > 0.002 && v[position(t)] < 0.998 && std::abs(v[position(t)] - start[position(t)]) < 0.06 &&
           std::abs(v[at(t, release)] - start[at(t, release)]) * start[fundamental] < 0.1;
    for (Eigen::Index p = first_of_uneven(); p < loss_scatter(); ++p) ok = ok && std::abs(v[p]) < 2 * uneven_doubt;
    for (Eigen::Index p = loss_scatter(); p < first_of_ends(); ++p) ok = ok && std::abs(v[p]) < most_own_loss;
    return ok && ends_within_doubt(v, 2);
  }
  [[nodiscard]] bool ends_within_doubt(const Eigen::VectorXd& v, double times = 1) const {
    for (Eigen::Index p = first_of_ends(); p < size(); ++p)
      if (!(std::abs(v[p]) <= times * end_doubt[static_cast<std::size_t>(p - first_of_ends()) % 3])) return false;
    for (const modal_termination& end : ends(v))
      for (const admittance_mode& m : end.modes)
        if (!(m.q > 0.5)) return false;  // it would not ring
    return true;
  }

  /// how well a declared mode is known: frequency, q, mass, relative limits; twice that is another mode
  static constexpr std::array end_doubt{0.01, 0.2, 0.1};
  /// how far a loss may be from what its law says, a fifth of it a usual term of its series; twice that is another law
  static constexpr double uneven_doubt = 0.05;
  static constexpr double most_own_loss = 2;

private:
  [[nodiscard]] static std::string name_of_uneven(int i) {
    return std::string(i % 2 == 0 ? "loss_cosine_" : "loss_sine_") + std::to_string(i / 2 + 1);
  }
  [[nodiscard]] std::string name_of_end(std::size_t i) const {
    static constexpr std::array of_mode{"ln_frequency", "ln_q", "ln_per_mass"};
    const std::size_t mode = i / 3, near = ends_[0].modes.size();
    return std::string(of_mode[i % 3]) + " of " + (mode < near ? "near" : "far") + " end's mode " +
           std::to_string(mode < near ? mode + 1 : mode - near + 1);
  }

  pluck_options options_{};
  std::vector<double> positions_;
  std::vector<Eigen::Index> group_;
  std::vector<std::string> names_;
  std::array<modal_termination, 2> ends_{};
  bool own_losses_free_ = false;
};

/// Inverse over the free parameters; rows and columns of the fixed ones are zero.
template <class Layout>
[[nodiscard]] Eigen::MatrixXd invert_free(const Layout& layout, const Eigen::MatrixXd& hessian) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index p = 0; p < layout.size(); ++p)
    if (layout.is_free(p)) free.push_back(p);
  const Eigen::VectorXd scale = hessian.diagonal()(free).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * hessian(free, free) * scale.asDiagonal();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(hessian.rows(), hessian.cols());
  inverse(free, free) =
      scale.asDiagonal() * Eigen::MatrixXd(scaled.completeOrthogonalDecomposition().pseudoInverse()) * scale.asDiagonal();
  return inverse;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
