// expect: ComplexFft
// SPDX-License-Identifier: MIT
// A block transform wants an FFT of complex records or of lanes.
#include <rosin/math/block_transform.hpp>

struct identity {
  explicit identity(std::size_t n) : n_{n} {}
  std::size_t size() const noexcept { return n_; }
  void forward(const std::complex<double>*, std::complex<double>*) noexcept {}
#ifndef ROSIN_MUST_FAIL
  void inverse(const std::complex<double>*, std::complex<double>*) noexcept {}
#endif
private:
  std::size_t n_;
};

rosin::block_transform<double, identity>* transform = nullptr;
