// tier: hosted
// SPDX-License-Identifier: MIT
//
// Poles against a recording: the string's lines (gliding, where it glides) with amplitude and phase of each line free, by least
// squares on the samples themselves. Nothing else is free, so what is left over judges frequencies and decays alone. Position and
// strength of the pluck, the place and the response of the sensor are all in the amplitudes: they are nuisances here.
//
//     x(t) = sum_n Re{ A_n exp(s_n t + 2 pi i f_n relative path_n(t)) }
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_glide_path.hpp>

#include <complex>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One free line: the partial whose glide it shares (0: steady), and its pole.
struct predicted_line {
  int number = 0;
  std::complex<double> pole;
};

/// The stretch of a recording that is to be accounted for.
struct judged_stretch {
  std::vector<double> x;
  double rate_Hz = 0, start_s = 0;
};

[[nodiscard]] inline double rms_level(std::span<const double> x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return x.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(x.size()));
}

[[nodiscard]] inline judged_stretch stretch_of(const pickup_signal& s, double start_s, double stop_s) {
  const auto from = std::min(static_cast<std::size_t>(start_s * s.rate_Hz), s.values.size());
  const auto to = std::clamp(static_cast<std::size_t>(stop_s * s.rate_Hz), from, s.values.size());
  judged_stretch out{{s.values.begin() + static_cast<std::ptrdiff_t>(from), s.values.begin() + static_cast<std::ptrdiff_t>(to)},
                     s.rate_Hz,
                     start_s};
  double mean = 0;
  for (const double v : out.x) mean += v / static_cast<double>(out.x.size());
  for (double& v : out.x) v -= mean;
  return out;
}

/// A single recording in two: from the attack to the middle of what is audible (four seconds at most), and from there on.
[[nodiscard]] inline std::pair<pickup_signal, pickup_signal> halves_of(const pickup_signal& s, double nominal_Hz) {
  const auto block = std::max<std::size_t>(1, static_cast<std::size_t>(0.05 * s.rate_Hz));
  const double begin = detail::sound_begins_s(s.values, s.rate_Hz) + 0.05 + 2 / std::min(64.0, 0.45 * nominal_Hz);
  std::vector<double> level;
  for (std::size_t j = 0; j + block <= s.values.size(); j += block)
    level.push_back(rms_level(std::span<const double>{s.values}.subspan(j, block)));
  std::vector<double> sorted = level;
  std::sort(sorted.begin(), sorted.end());
  std::size_t last = level.size();
  while (last > 1 && level[last - 1] < std::sqrt(3.0) * sorted[sorted.size() / 10]) --last;
  const double end = std::min(static_cast<double>(last * block) / s.rate_Hz, begin + 4),
               whole = static_cast<double>(s.values.size()) / s.rate_Hz;
  const double middle = 0.5 * (begin + (end > begin + 0.6 ? end : std::min(whole, begin + 4)));
  std::pair<pickup_signal, pickup_signal> out{s, s};
  out.first.to_s = middle, out.second.from_s = middle;
  out.second.to_s = std::min(whole, 2 * middle - begin);
  return out;
}

namespace detail {

/// A path on a coarse grid, straight in between.
class coarse_path {
public:
  coarse_path(const glide_shape& shape, int number, double rate_Hz, std::size_t count) {
    for (std::size_t j = 0; j <= count / every + 1; ++j)
      at_.push_back(shape.path_s(number, static_cast<double>(j * every) / rate_Hz));
  }
  [[nodiscard]] double operator[](std::size_t j) const {
    const double share = static_cast<double>(j % every) / every;
    return (1 - share) * at_[j / every] + share * at_[j / every + 1];
  }

private:
  static constexpr std::size_t every = 32;
  std::vector<double> at_;
};

class line_columns {
public:
  line_columns(const std::vector<predicted_line>& lines, const glide_found* glide, double rate_Hz, std::size_t count)
      : lines_{lines}, rate_Hz_{rate_Hz} {
    if (glide == nullptr || !(glide->relative > 0)) return;
    relative_ = glide->relative;
    for (const auto& l : lines) paths_.emplace_back(glide->shape, l.number, rate_Hz, count);
  }
  /// Rows from..from + block of the design matrix: re, -im of each line.
  template <class = void>
  void fill(std::size_t from, std::size_t block, Eigen::MatrixXd& out) const {
    out.resize(static_cast<Eigen::Index>(block), static_cast<Eigen::Index>(2 * lines_.size()));
    for (std::size_t k = 0; k < lines_.size(); ++k) {
      const auto s = lines_[k].pole;
      const bool glides = !paths_.empty() && lines_[k].number > 0;
      const auto step = std::exp(s / rate_Hz_);
      auto z = std::exp(s * (static_cast<double>(from) / rate_Hz_));
      for (std::size_t j = 0; j < block; ++j, z *= step) {
        const auto v = glides ? z * std::polar(1.0, s.imag() * relative_ * paths_[k][from + j]) : z;
        out(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(2 * k)) = v.real();
        out(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(2 * k + 1)) = -v.imag();
      }
    }
  }

private:
  const std::vector<predicted_line>& lines_;
  double rate_Hz_, relative_ = 0;
  std::vector<coarse_path> paths_;
};

/// Of the lower half of X^T X and of X^T x; lines that are alike share what there is.
template <class Real = double>
Eigen::VectorXd amplitudes_by(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right) {
  const Eigen::VectorX<Real> size = gram.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixX<Real> scaled =
      size.asDiagonal() * Eigen::MatrixX<Real>(gram.template selfadjointView<Eigen::Lower>()) * size.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  return size.cwiseProduct(scaled.ldlt().solve(size.cwiseProduct(right)));
}

}  // namespace detail

namespace detail {

inline constexpr std::size_t line_block = 512;

/// Amplitudes of the columns at the beginning of the stretch.
template <class Real = double>
Eigen::VectorXd fit_columns(const judged_stretch& s, const line_columns& columns, Eigen::Index n) {
  Eigen::MatrixX<Real> gram = Eigen::MatrixX<Real>::Zero(n, n), part;
  Eigen::VectorX<Real> right = Eigen::VectorX<Real>::Zero(n);
  for (std::size_t from = 0; from < s.x.size(); from += line_block) {
    const std::size_t size = std::min(line_block, s.x.size() - from);
    columns.fill(from, size, part);
    gram.template selfadjointView<Eigen::Lower>().rankUpdate(part.transpose());
    right += part.transpose() * Eigen::Map<const Eigen::VectorX<Real>>(s.x.data() + from, static_cast<Eigen::Index>(size));
  }
  return amplitudes_by(gram, right);
}

}  // namespace detail

/// What these lines leave of it.
template <class Real = double>
[[nodiscard]] std::vector<double> left_by_lines(const judged_stretch& s, const std::vector<predicted_line>& lines,
                                                const glide_found* glide = nullptr) {
  const detail::line_columns columns(lines, glide, s.rate_Hz, s.x.size());
  const Eigen::VectorX<Real> amplitude = detail::fit_columns(s, columns, static_cast<Eigen::Index>(2 * lines.size()));
  std::vector<double> left = s.x;
  Eigen::MatrixX<Real> part;
  for (std::size_t from = 0; from < left.size(); from += detail::line_block) {
    const std::size_t size = std::min(detail::line_block, left.size() - from);
    columns.fill(from, size, part);
    Eigen::Map<Eigen::VectorX<Real>>(left.data() + from, static_cast<Eigen::Index>(size)) -= part * amplitude;
  }
  return left;
}
ROSIN_INSTANTIATE(std::vector<double> left_by_lines(const judged_stretch&, const std::vector<predicted_line>&,
                                                    const glide_found*))

/// Takes lines that last from the whole recording, as large as they are in a stretch of it beside lines that are not taken out.
template <class Real = double>
void take_out_lines(pickup_signal& s, const judged_stretch& stretch, const std::vector<predicted_line>& lines,
                    std::vector<predicted_line> beside, const glide_found* glide = nullptr) {
  const auto first = static_cast<Eigen::Index>(2 * beside.size());
  beside.insert(beside.end(), lines.begin(), lines.end());
  const detail::line_columns columns(beside, glide, stretch.rate_Hz, stretch.x.size());
  const Eigen::VectorX<Real> amplitude = detail::fit_columns(stretch, columns, static_cast<Eigen::Index>(2 * beside.size()));
  const double begin = std::floor(stretch.start_s * s.rate_Hz);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto at = first + static_cast<Eigen::Index>(2 * k);
    const std::complex<double> a{amplitude[at], amplitude[at + 1]};
    for (std::size_t j = 0; j < s.values.size(); ++j)
      s.values[j] -= (a * std::exp(lines[k].pole * ((static_cast<double>(j) - begin) / s.rate_Hz))).real();
  }
}

/// The recording's own noise: the quietest of its pieces of 50 ms, of what lines that were fitted to itself leave. Noise that
/// comes and goes, and whatever else those lines lack, does not count as noise.
[[nodiscard]] inline double quietest_piece(std::span<const double> left, double rate_Hz) {
  const auto block = std::max<std::size_t>(256, static_cast<std::size_t>(0.05 * rate_Hz));
  double least = rms_level(left);
  for (std::size_t j = 0; j + block <= left.size(); j += block) least = std::min(least, rms_level(left.subspan(j, block)));
  return least;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
