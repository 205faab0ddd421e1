// tier: hosted
// SPDX-License-Identifier: MIT
//
// The least-squares problem behind the fit of plucks: residual, gradient and normal matrix. Each take is two stretches, before
// the release and after it, each a sum of damped lines; a guard of half a filter's length around the release is left out.
// Poles and residues are differentiated numerically (they cost nothing); the sums over samples are done by damped_lines.hpp.
// What rings is the model's affair: `plain_plucks` is the string between pinned ends, and whatever else comes down to damped
// lines (diagnosis) is fitted by the same code.
//
#pragma once

#include <rosin/calibrate/band_kernels.hpp>
#include <rosin/calibrate/plain_plucks.hpp>
#include <rosin/calibrate/pluck_start.hpp>
#include <rosin/math/levenberg_marquardt.hpp>

#include <concepts>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Model of a set of plucks: which parameters there are, and the lines that a take consists of from `begin_s` on, before its
/// release (part 0) or after it (part 1), seen through a band.
template <class M>
concept LineModel = requires(const M& m, const Eigen::VectorXd& v, Eigen::Index p, std::size_t take, const band& limits) {
  { m.size() } -> std::convertible_to<Eigen::Index>;
  { m.is_free(p) } -> std::same_as<bool>;
  { m.concerns(p, take) } -> std::same_as<bool>;
  { m.step(p, v) } -> std::same_as<double>;
  { m.release_s(v, take) } -> std::same_as<double>;
  { m.string(v) } -> std::same_as<ringing_string>;
  { m.lines(v, take, std::size_t{}, 0.0, limits, 1) } -> std::same_as<std::vector<damped_line>>;
};

/// `prior` is the part of the Hessian that does not come from data.
struct pluck_equations : normal_equations<> {
  Eigen::MatrixXd prior;
};

/// What the residual says of the model.
struct assessment {
  std::array<double, 2> noise{};
  std::array<double, 2> power{}, samples{};  ///< of the residual, channel by channel; of white noise it would be noise^2 samples
  double misfit = 1, dimensions = 1;
  std::vector<double> residual_ratio;
  /// Variance is inflated by lack of fit only where noise does not explain it.
  [[nodiscard]] double inflation() const { return misfit > 1 + 4 * std::sqrt(2 / dimensions) ? misfit : 1.0; }
};

template <LineModel Model>
class line_problem {
public:
  line_problem(const std::vector<pluck_take>& takes, const Model& model, const pluck_options& options, const pluck_guess& guess,
               const Eigen::VectorXd& value, int partials, double periods, bool filtered, std::array<double, 2> noise,
               const band_kernels& kernels = {})
      : model_{model}, noise_{noise}, partials_{std::min(partials, options.most_partials)} {
    model_.free_own_losses(value);
    for (Eigen::Index p = 0; p < model.size(); ++p) prior_.push_back(model.prior(p, takes, guess));
    for (std::size_t i = 0; i < takes.size(); ++i) {
      const double rate = takes[i].rate_Hz;
      limits_ = options.limits_for(rate, model.string(value));
      fir kernel{0, {1.0}};
      if (filtered) kernel = kernels.of(limits_, rate);
      else limits_ = {0.5 * rate, 0.5 * rate};
      const int reach = std::max(kernel.last(), -kernel.first);
      const int guard = std::max(reach, static_cast<int>(2.5 / (options.stop_fraction - options.pass_fraction)));
      const double release = model.release_s(value, i) * rate;
      const auto length = static_cast<int>(takes[i].force_N[0].size());
      const double last = release + periods * rate / model.string(value).fundamental_Hz;
      const int end = static_cast<int>(std::min<double>(length - reach, last));
      const int before = static_cast<int>(std::floor(release)) - guard, after = static_cast<int>(std::ceil(release)) + guard;
      takes_.push_back({rate, {cut(takes[i], kernel, reach, before), cut(takes[i], kernel, std::max(after, reach), end)}});
    }
  }

  /// The recording in one stretch, filtered, and from when on.
  struct stretch {
    double begin_s = 0;
    std::array<Eigen::VectorXd, 2> data;
    [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(data[0].size()); }
  };
  /// The residual, J^T r per line, its power and the recording's.
  struct projection {
    Eigen::MatrixXd residual;                   // count x 2
    std::array<Eigen::MatrixXd, 2> onto_lines;  // N x 4: Re z, Im z, t Re z, t Im z
    std::array<double, 2> power{}, signal{};
  };

  [[nodiscard]] const band& limits() const { return limits_; }
  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] int partials() const { return partials_; }
  [[nodiscard]] std::array<double, 2> noise() const { return noise_; }
  [[nodiscard]] std::size_t takes() const { return takes_.size(); }
  [[nodiscard]] double rate_Hz(std::size_t take) const { return takes_[take].rate_Hz; }
  [[nodiscard]] const stretch& part(std::size_t take, std::size_t part) const { return takes_[take].part[part]; }
  [[nodiscard]] std::vector<damped_line> lines(const Eigen::VectorXd& v, std::size_t take, std::size_t part) const {
    return model_.lines(v, take, part, takes_[take].part[part].begin_s, limits_, partials_);
  }
  [[nodiscard]] projection project(const stretch& s, double rate_Hz, const std::vector<damped_line>& lines) const;
  [[nodiscard]] std::array<Eigen::MatrixXd, 2> sensitivities(const Eigen::VectorXd& v, std::size_t take, std::size_t part,
                                                             const std::vector<damped_line>& at) const;
  void set_noise(std::array<double, 2> noise) { noise_ = noise; }

  [[nodiscard]] pluck_equations linearise(const Eigen::VectorXd& value) const;
  /// Covariance of the gradient's data part for white noise of the assumed size: less than the Hessian where the band falls off.
  [[nodiscard]] Eigen::MatrixXd scatter(const Eigen::VectorXd& value) const;
  [[nodiscard]] assessment assess(const Eigen::VectorXd& value) const;

private:
  /// visit(take, stretch, lines, their Gram matrix, sensitivities), before and after each release.
  template <class Visit>
  void each_stretch(const Eigen::VectorXd& v, Visit&& visit) const;

  struct prepared {
    double rate_Hz;
    std::array<stretch, 2> part;  // before and after the release
  };

  static stretch cut(const pluck_take& take, const fir& kernel, int begin, int end) {
    stretch s{begin / take.rate_Hz, {}};
    const Eigen::VectorXd taps =
        Eigen::VectorXd::Map(kernel.taps.data(), static_cast<Eigen::Index>(kernel.taps.size())).reverse();
    for (std::size_t c = 0; c < 2; ++c) {
      s.data[c].resize(std::max(0, end - begin));
      for (int i = begin; i < end; ++i)
        s.data[c][i - begin] = taps.dot(Eigen::VectorXd::Map(take.force_N[c].data() + (i - kernel.last()), taps.size()));
    }
    return s;
  }

  Model model_;
  std::vector<pluck_layout::knowledge> prior_;
  std::array<double, 2> noise_;
  int partials_;
  band limits_{0, 0};
  std::vector<prepared> takes_;
};

template <LineModel Model>
typename line_problem<Model>::projection line_problem<Model>::project(const stretch& s, double rate_Hz,
                                                                      const std::vector<damped_line>& lines) const {
  const line_runner run(lines, 1 / rate_Hz);
  projection out{-run.sum(lines, s.count()), {}, {}, {}};
  for (std::size_t c = 0; c < 2; ++c) {
    auto left = out.residual.col(static_cast<Eigen::Index>(c));
    left += s.data[c];
    out.power[c] = left.squaredNorm(), out.signal[c] = s.data[c].squaredNorm();
  }
  const std::vector<Eigen::MatrixXd> onto = run.products(out.residual);
  out.onto_lines = {onto[0], onto[1]};
  return out;
}

/// d model / d parameter in the basis of damped_lines.hpp, per channel: P x 4N. Central differences of poles and residues.
template <LineModel Model>
std::array<Eigen::MatrixXd, 2> line_problem<Model>::sensitivities(const Eigen::VectorXd& v, std::size_t take, std::size_t part,
                                                                  const std::vector<damped_line>& at) const {
  const auto N = static_cast<Eigen::Index>(at.size());
  std::array<Eigen::MatrixXd, 2> out{Eigen::MatrixXd::Zero(model_.size(), 4 * N), Eigen::MatrixXd::Zero(model_.size(), 4 * N)};
  for (Eigen::Index p = 0; p < model_.size(); ++p) {
    if (!model_.is_free(p) || !model_.concerns(p, take) || model_.is_own_loss(p)) continue;
    const double h = model_.step(p, v);
    Eigen::VectorXd up = v, down = v;
    up[p] += h, down[p] -= h;
    std::vector<damped_line> above = lines(up, take, part), below = lines(down, take, part);
    // With a partial at the very edge of the band (weight 0) there is one line more or less on one side.
    const double width = above.size() == below.size() ? 2 * h : h;
    if (above.size() != at.size()) above = at;
    if (below.size() != at.size()) below = at;
    for (Eigen::Index n = 0; n < N; ++n)
      for (std::size_t c = 0; c < 2; ++c) {
        const auto i = static_cast<std::size_t>(n);
        const std::complex<double> change = (above[i].residue[c] - below[i].residue[c]) / width;
        const std::complex<double> drift = at[i].residue[c] * (above[i].pole - below[i].pole) / width;
        out[c].block<1, 4>(p, 4 * n) << change.real(), -change.imag(), drift.real(), -drift.imag();
      }
  }
  if (part == 0 || !model_.has_own_losses(v) || !model_.is_free(model_.first_of_own())) return out;
  const auto own = model_.own_losses_at(v, take, limits_, partials_);
  const double age_s = takes_[take].part[part].begin_s - model_.release_s(v, take);
  for (Eigen::Index n = 0; n < N; ++n) {
    const damped_line& line = at[static_cast<std::size_t>(n)];
    const auto slope = own.slope_of(line, age_s, limits_);
    if (slope.mode == 0) continue;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::complex<double> change = line.residue[c] * slope.ln_residue, drift = line.residue[c] * slope.pole;
      out[c].block<1, 4>(model_.first_of_own() + slope.mode - 1, 4 * n) << change.real(), -change.imag(), drift.real(),
          -drift.imag();
    }
  }
  return out;
}

template <LineModel Model>
template <class Visit>
void line_problem<Model>::each_stretch(const Eigen::VectorXd& v, Visit&& visit) const {
  for (std::size_t t = 0; t < takes_.size(); ++t)
    for (std::size_t part = 0; part < 2; ++part)
      if (takes_[t].part[part].count() > 0) {
        const std::vector<damped_line> now = lines(v, t, part);
        visit(t, takes_[t].part[part], now, line_gram(now, 1 / takes_[t].rate_Hz, takes_[t].part[part].count()),
              sensitivities(v, t, part, now));
      }
}

template <LineModel Model>
pluck_equations line_problem<Model>::linearise(const Eigen::VectorXd& v) const {
  const Eigen::Index P = model_.size();
  pluck_equations eq{normal_equations<>::zero(P), Eigen::MatrixXd::Zero(P, P)};
  each_stretch(v, [&](std::size_t t, const stretch& s, const auto& now, const Eigen::MatrixXd& gram, const auto& all) {
    std::vector<Eigen::Index> rows;  // of parameters that this take tells of; the others' are zero
    for (Eigen::Index p = 0; p < P; ++p)
      if (model_.is_free(p) && model_.concerns(p, t)) rows.push_back(p);
    const projection p = project(s, takes_[t].rate_Hz, now);
    for (std::size_t c = 0; c < 2; ++c) {
      const double sure = 1 / (noise_[c] * noise_[c]);
      const Eigen::MatrixXd to = all[c](rows, Eigen::seqN(0, all[c].cols())), of_gram = to * gram,
                            flat = p.onto_lines[c].transpose();
      eq.cost += sure * p.power[c];
      eq.gradient(rows) += sure * (to * Eigen::Map<const Eigen::VectorXd>(flat.data(), flat.size()));
      eq.hessian(rows, rows) += sure * (of_gram * to.transpose());
    }
  });
  for (Eigen::Index p = 0; p < P; ++p) {
    auto [known, sd] = prior_[static_cast<std::size_t>(p)];
    if (model_.is_own_loss(p)) sd = v[model_.loss_scatter()];
    if (!model_.is_free(p)) eq.hessian(p, p) = 1;
    if (sd <= 0 || !model_.is_free(p)) continue;
    eq.prior(p, p) = 1 / (sd * sd);
    eq.gradient[p] += (known - v[p]) / (sd * sd);
    eq.cost += (known - v[p]) * (known - v[p]) / (sd * sd);
  }
  eq.hessian += eq.prior;
  return eq;
}

template <LineModel Model>
Eigen::MatrixXd line_problem<Model>::scatter(const Eigen::VectorXd& v) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(model_.size(), model_.size());
  each_stretch(v, [&](std::size_t, const stretch&, const auto& now, const Eigen::MatrixXd& gram, const auto& to) {
    Eigen::VectorXd weight(to[0].cols());
    for (std::size_t n = 0; n < now.size(); ++n)
      weight.segment<4>(4 * static_cast<Eigen::Index>(n)).setConstant(limits_(now[n].pole.imag() / (2 * std::numbers::pi)));
    for (std::size_t c = 0; c < 2; ++c) {
      const Eigen::MatrixXd filtered = to[c] * weight.asDiagonal();
      sum += filtered * gram * filtered.transpose() / (noise_[c] * noise_[c]);
    }
  });
  return sum;
}

template <LineModel Model>
assessment line_problem<Model>::assess(const Eigen::VectorXd& v) const {
  double mean_square = 0;  // of W over the band to half the sampling rate
  for (int i = 0; i < 1000; ++i) mean_square += std::pow(limits_(takes_.front().rate_Hz * (i + 0.5) / 2000), 2) / 1000;
  assessment out;
  double at_lines = 0, expected = 0, dimensions = 0;
  std::array<double, 2>&power = out.power, &samples = out.samples;
  std::array<double, 2> captured{}, used{};
  for (std::size_t t = 0; t < takes_.size(); ++t) {
    double residual = 0, signal = 0;
    for (std::size_t part = 0; part < 2; ++part) {
      const stretch& s = takes_[t].part[part];
      std::vector<damped_line> now = lines(v, t, part);
      const projection p = project(s, takes_[t].rate_Hz, now);
      now.resize(now.size() - 2);
      const auto N = static_cast<Eigen::Index>(now.size());
      const Eigen::LDLT<Eigen::MatrixXd> gram(line_gram(now, 1 / takes_[t].rate_Hz, s.count()));
      for (std::size_t c = 0; c < 2; ++c) {
        residual += p.power[c], signal += p.signal[c];
        power[c] += p.power[c];
        samples[c] += static_cast<double>(s.count()) * mean_square;
        if (N == 0) continue;
        const Eigen::MatrixXd flat = p.onto_lines[c].topRows(N).transpose();
        const Eigen::Map<const Eigen::VectorXd> b(flat.data(), flat.size());
        captured[c] += b.dot(gram.solve(b));
        for (const damped_line& line : now) used[c] += 4 * std::pow(limits_(line.pole.imag() / (2 * std::numbers::pi)), 2);
        dimensions += 4 * static_cast<double>(N);
      }
    }
    out.residual_ratio.push_back(std::sqrt(residual / signal));
  }
  for (std::size_t c = 0; c < 2; ++c) {
    const double variance = std::max(1e-300, (power[c] - captured[c]) / std::max(1.0, samples[c] - used[c]));
    out.noise[c] = std::sqrt(variance);
    at_lines += captured[c] / variance, expected += used[c];
  }
  out.dimensions = std::max(1.0, dimensions);
  out.misfit = expected > 0 ? at_lines / expected : 1;
  return out;
}

using pluck_problem = line_problem<plain_plucks>;

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
