// SPDX-License-Identifier: MIT
#include "overlap_save_cases.hpp"

#include <rosin/adapt/fft_pocketfft.hpp>

namespace bench_overlap_save_pocketfft {

using namespace overlap_save_cases;

BENCHMARK_TEMPLATE(convolve, double, rosin::pocketfft_fft<std::complex<double>>)
    ->Name("overlap_save/pocketfft/double")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, float, rosin::pocketfft_fft<std::complex<float>>)
    ->Name("overlap_save/pocketfft/float")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, double, rosin::pocketfft_fft<double>)
    ->Name("overlap_save/four_bare_ffts/pocketfft/double")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, float, rosin::pocketfft_fft<float>)
    ->Name("overlap_save/four_bare_ffts/pocketfft/float")
    ->Unit(benchmark::kMillisecond);

}  // namespace bench_overlap_save_pocketfft
