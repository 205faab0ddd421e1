// SPDX-License-Identifier: MIT
#include "fft_cases.hpp"

#include <rosin/adapt/fft_pocketfft.hpp>

namespace bench_fft_pocketfft {

using fft_cases::there_and_back;

BENCHMARK_TEMPLATE(there_and_back, double, rosin::pocketfft_fft<double>)->Name("fft/pocketfft/double")->Apply(fft_cases::lengths);
BENCHMARK_TEMPLATE(there_and_back, float, rosin::pocketfft_fft<float>)->Name("fft/pocketfft/float")->Apply(fft_cases::lengths);

}  // namespace bench_fft_pocketfft
