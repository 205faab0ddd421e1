// SPDX-License-Identifier: MIT
#include "overlap_save_cases.hpp"

#include <rosin/adapt/fft_fftw.hpp>

namespace bench_overlap_save_fftw {

using namespace overlap_save_cases;

BENCHMARK_TEMPLATE(convolve, double, rosin::fftw_fft<std::complex<double>>)
    ->Name("overlap_save/fftw/double")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, float, rosin::fftw_fft<std::complex<float>>)
    ->Name("overlap_save/fftw/float")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, double, rosin::fftw_fft<double>)
    ->Name("overlap_save/four_bare_ffts/fftw/double")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, float, rosin::fftw_fft<float>)
    ->Name("overlap_save/four_bare_ffts/fftw/float")
    ->Unit(benchmark::kMillisecond);

}  // namespace bench_overlap_save_fftw
