// SPDX-License-Identifier: MIT
#include <rosin/calibrate/damped_lines.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>

namespace {

using complex = std::complex<double>;
constexpr double step_s = 1 / 128e3;

/// Damped, barely damped, lossless, and a constant.
const std::vector<rosin::damped_line> lines{{{-30, 4000}, {complex(1, 0), complex(0.5, -0.2)}},
                                            {{-1e-6, 150000}, {complex(0, 1), complex(1, 1)}},
                                            {{0, 25000}, {complex(0.1, 0), complex(-1, 0)}},
                                            {{0, 0}, {complex(2, 0), complex(0, 0)}}};

}  // namespace

TEST_CASE("sums of powers by doubling are the sums term by term, for any count") {
  for (const complex p : {complex(-30, 4000), complex(-1e-9, 0), complex(0, 0), complex(0, 3e5), complex(-2000, 1e5)})
    for (const std::size_t count : {0U, 1U, 2U, 7U, 1000U, 4097U}) {
      std::array<complex, 3> direct{};
      for (std::size_t k = 0; k < count; ++k) {
        const double t = static_cast<double>(k) * step_s;
        const complex z = std::exp(p * t);
        direct[0] += z, direct[1] += t * z, direct[2] += t * t * z;
      }
      const auto sums = rosin::power_sums(p, step_s, count);
      for (std::size_t a = 0; a < 3; ++a)
        CHECK(std::abs(sums[a] - direct[a]) <=
              1e-11 * (static_cast<double>(count) * std::pow(static_cast<double>(count) * step_s, a) + 1e-30));
    }
}

TEST_CASE("sums of powers in closed form and by doubling are the same where one takes over from the other") {
  constexpr std::size_t count = 200000;
  for (const complex p :
       {complex(-3, 0), complex(-9, 3), complex(-11, 5), complex(-2, 40), complex(-30, 4000), complex(-900, 350e3)}) {
    const auto sums = rosin::power_sums(p, step_s, count),
               doubled = rosin::detail::doubled_sums(std::exp(p * step_s), step_s, count);
    for (std::size_t a = 0; a < 3; ++a) CHECK(std::abs(sums[a] - doubled[a]) <= 2e-10 * std::abs(doubled[a]));
  }
}

TEST_CASE("the Gram matrix is what summing the functions gives") {
  constexpr std::size_t count = 700;
  const Eigen::MatrixXd gram = rosin::line_gram(lines, step_s, count);
  Eigen::MatrixXd functions(count, 16);
  for (Eigen::Index k = 0; k < Eigen::Index{count}; ++k)
    for (Eigen::Index n = 0; n < 4; ++n) {
      const double t = static_cast<double>(k) * step_s;
      const complex z = std::exp(lines[static_cast<std::size_t>(n)].pole * t);
      functions.row(k).segment<4>(4 * n) << z.real(), z.imag(), t * z.real(), t * z.imag();
    }
  const Eigen::MatrixXd direct = functions.transpose() * functions;
  for (Eigen::Index i = 0; i < 16; ++i)
    for (Eigen::Index j = 0; j < 16; ++j)
      CHECK(std::abs(gram(i, j) - direct(i, j)) <= 1e-10 * std::sqrt(direct(i, i) * direct(j, j)) + 1e-14);
}

TEST_CASE("sums and products of lines are what one adds up sample by sample, over several blocks and chunks") {
  for (const std::size_t count : std::vector<std::size_t>{1, 255, 256, 1000, 20011}) {
    const rosin::line_runner run(lines, step_s);
    const Eigen::MatrixXd sum = run.sum(lines, count);
    REQUIRE(sum.rows() == static_cast<Eigen::Index>(count));
    Eigen::MatrixXd signals(sum.rows(), 2), direct = Eigen::MatrixXd::Zero(sum.rows(), 2);
    std::array<Eigen::MatrixXd, 2> onto{Eigen::MatrixXd::Zero(4, 4), Eigen::MatrixXd::Zero(4, 4)};
    for (Eigen::Index k = 0; k < signals.rows(); ++k) {
      const double t = static_cast<double>(k) * step_s;
      signals.row(k) << std::sin(0.37 * static_cast<double>(k)), std::cos(0.011 * static_cast<double>(k));
      for (std::size_t n = 0; n < lines.size(); ++n) {
        const complex z = std::exp(lines[n].pole * t);
        for (std::size_t c = 0; c < 2; ++c) {
          const auto col = static_cast<Eigen::Index>(c);
          direct(k, col) += (lines[n].residue[c] * z).real();
          onto[c].row(static_cast<Eigen::Index>(n)) +=
              signals(k, col) * Eigen::RowVector4d(z.real(), z.imag(), t * z.real(), t * z.imag());
        }
      }
    }
    CHECK((sum - direct).cwiseAbs().maxCoeff() < 1e-10 * (1 + direct.cwiseAbs().maxCoeff()));
    const auto products = run.products(signals);
    for (std::size_t c = 0; c < 2; ++c)
      CHECK((products[c] - onto[c]).cwiseAbs().maxCoeff() < 1e-10 * (1 + onto[c].cwiseAbs().maxCoeff()));
  }
}
