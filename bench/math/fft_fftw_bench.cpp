// SPDX-License-Identifier: MIT
#include "fft_cases.hpp"

#include <rosin/adapt/fft_fftw.hpp>

namespace bench_fft_fftw {

using fft_cases::there_and_back;

BENCHMARK_TEMPLATE(there_and_back, double, rosin::fftw_fft<double>)->Name("fft/fftw/double")->Apply(fft_cases::lengths);
BENCHMARK_TEMPLATE(there_and_back, float, rosin::fftw_fft<float>)->Name("fft/fftw/float")->Apply(fft_cases::lengths);

}  // namespace bench_fft_fftw
