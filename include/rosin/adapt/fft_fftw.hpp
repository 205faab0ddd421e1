// tier: hosted
// SPDX-License-Identifier: MIT
//
// The Fourier transform of FFTW 3 (GPL: a program that links it is under the GPL as a whole). Needs -lfftw3, and -lfftw3f
// where float is used. FFTW's planner serves one thread at a time and is slow, its plans serve any number: they are made
// under a lock and kept until the program ends. Plans are estimated by default; Effort = FFTW_MEASURE times them first.
//
#pragma once

#include <rosin/math/fft_policy.hpp>

#include <fftw3.h>

#include <complex>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <type_traits>

namespace rosin {

/// FFTW's two libraries under one name.
template <class T>
struct fftw_library;

template <>
struct fftw_library<double> {
  using complex_type = fftw_complex;
  using plan = std::remove_pointer_t<fftw_plan>;
  static constexpr auto allocate = &fftw_alloc_complex;
  static constexpr auto release = &fftw_free;
  static constexpr auto alignment = &fftw_alignment_of;
  static constexpr auto plan_complex = &fftw_plan_dft_1d;
  static constexpr auto plan_forward = &fftw_plan_dft_r2c_1d;
  static constexpr auto plan_inverse = &fftw_plan_dft_c2r_1d;
  static constexpr auto run_complex = &fftw_execute_dft;
  static constexpr auto run_forward = &fftw_execute_dft_r2c;
  static constexpr auto run_inverse = &fftw_execute_dft_c2r;
  static constexpr auto destroy = &fftw_destroy_plan;
};

template <>
struct fftw_library<float> {
  using complex_type = fftwf_complex;
  using plan = std::remove_pointer_t<fftwf_plan>;
  static constexpr auto allocate = &fftwf_alloc_complex;
  static constexpr auto release = &fftwf_free;
  static constexpr auto alignment = &fftwf_alignment_of;
  static constexpr auto plan_complex = &fftwf_plan_dft_1d;
  static constexpr auto plan_forward = &fftwf_plan_dft_r2c_1d;
  static constexpr auto plan_inverse = &fftwf_plan_dft_c2r_1d;
  static constexpr auto run_complex = &fftwf_execute_dft;
  static constexpr auto run_forward = &fftwf_execute_dft_r2c;
  static constexpr auto run_inverse = &fftwf_execute_dft_c2r;
  static constexpr auto destroy = &fftwf_destroy_plan;
};

/// One transform, planned twice: for arrays aligned as FFTW's vector code wants them, and for arrays that lie anywhere.
template <class T>
class fftw_transform {
public:
  using library = fftw_library<T>;
  using raw_type = typename library::complex_type;
  enum class kind { complex_forward, complex_inverse, real_forward, real_inverse };

  /// The transform of this length, kind and effort: made at the first call, shared from then on, by all threads.
  [[nodiscard]] static fftw_transform get(std::size_t n, kind what, unsigned effort) {
    static std::mutex busy;
    static std::map<std::tuple<std::size_t, kind, unsigned>, fftw_transform> known;
    const std::lock_guard lock{busy};
    fftw_transform& found = known[{n, what, effort}];
    if (!found.anywhere_) found = fftw_transform{static_cast<int>(n), what, effort | FFTW_PRESERVE_INPUT};
    return found;
  }

  fftw_transform() = default;

  /// The plan that these two arrays may be given to.
  [[nodiscard]] typename library::plan* plan(const void* in, const void* out) const noexcept {
    return offset(in) == 0 && offset(out) == 0 ? aligned_.get() : anywhere_.get();
  }

  [[nodiscard]] static raw_type* raw(const std::complex<T>* x) noexcept {
    return reinterpret_cast<raw_type*>(const_cast<std::complex<T>*>(x));
  }

private:
  using handle = std::shared_ptr<typename library::plan>;
  using buffer = std::unique_ptr<raw_type, decltype(library::release)>;

  fftw_transform(int n, kind what, unsigned flags)
      : aligned_{make(n, what, flags), library::destroy}, anywhere_{make(n, what, flags | FFTW_UNALIGNED), library::destroy} {}

  static int offset(const void* array) noexcept { return library::alignment(static_cast<T*>(const_cast<void*>(array))); }

  static typename library::plan* make(int n, kind what, unsigned flags) {
    const std::size_t room = static_cast<std::size_t>(n) + 1;  // a measured plan writes to its arrays
    const buffer in{library::allocate(room), library::release}, out{library::allocate(room), library::release};
    switch (what) {
      case kind::complex_forward:
        return library::plan_complex(n, in.get(), out.get(), FFTW_FORWARD, flags);
      case kind::complex_inverse:
        return library::plan_complex(n, in.get(), out.get(), FFTW_BACKWARD, flags);
      case kind::real_forward:
        return library::plan_forward(n, reinterpret_cast<T*>(in.get()), out.get(), flags);
      default:
        return library::plan_inverse(n, in.get(), reinterpret_cast<T*>(out.get()), flags);
    }
  }

  handle aligned_, anywhere_;
};

/// FFTW's transform of one length: real over float and double, complex over std::complex of these.
template <class T, unsigned Effort = FFTW_ESTIMATE>
class fftw_fft {
public:
  using complex_type = std::complex<T>;

  explicit fftw_fft(std::size_t n)
      : size_{n}, forward_{transform::get(n, transform::kind::real_forward, Effort)}, inverse_{transform::get(
                                                                                          n, transform::kind::real_inverse,
                                                                                          Effort)} {}
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  void forward(const T* in, complex_type* out) noexcept {
    transform::library::run_forward(forward_.plan(in, out), const_cast<T*>(in), transform::raw(out));
  }
  void inverse(const complex_type* in, T* out) noexcept {
    transform::library::run_inverse(inverse_.plan(in, out), transform::raw(in), out);
    const T scale = static_cast<T>(1.0 / static_cast<double>(size_));
    for (std::size_t j = 0; j < size_; ++j) out[j] *= scale;
  }

private:
  using transform = fftw_transform<T>;
  std::size_t size_;
  transform forward_, inverse_;
};

template <class T, unsigned Effort>
class fftw_fft<std::complex<T>, Effort> {
public:
  using complex_type = std::complex<T>;

  explicit fftw_fft(std::size_t n)
      : size_{n}, forward_{transform::get(n, transform::kind::complex_forward, Effort)}, inverse_{transform::get(
                                                                                             n, transform::kind::complex_inverse,
                                                                                             Effort)} {}
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  void forward(const complex_type* in, complex_type* out) noexcept {
    transform::library::run_complex(forward_.plan(in, out), transform::raw(in), transform::raw(out));
  }
  void inverse(const complex_type* in, complex_type* out) noexcept {
    transform::library::run_complex(inverse_.plan(in, out), transform::raw(in), transform::raw(out));
    const T scale = static_cast<T>(1.0 / static_cast<double>(size_));
    for (std::size_t j = 0; j < size_; ++j) out[j] *= scale;
  }

private:
  using transform = fftw_transform<T>;
  std::size_t size_;
  transform forward_, inverse_;
};

}  // namespace rosin
