// SPDX-License-Identifier: MIT
#include <rosin/adapt/fft_pocketfft.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <complex>
#include <cstddef>

TEST_CASE_TEMPLATE("pocketfft's transform is the definition at any length, as Eigen's is", T, float, double) {
  static_assert(rosin::RealFft<rosin::pocketfft_fft<T>, T> && rosin::ComplexFft<rosin::pocketfft_fft<std::complex<T>>, T>);
  for (const std::size_t n : laws::fft_lengths) {
    laws::real_transform_is_exact<T, rosin::pocketfft_fft<T>>(n);
    laws::complex_transform_is_exact<T, rosin::pocketfft_fft<std::complex<T>>>(n);
    laws::two_backends_agree<T, rosin::pocketfft_fft<T>, rosin::eigen_fft<T>>(n);
  }
}
