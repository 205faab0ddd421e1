// SPDX-License-Identifier: MIT
#include "overlap_save_cases.hpp"

#include <rosin/math/fft.hpp>

namespace bench_overlap_save {

using namespace overlap_save_cases;

BENCHMARK_TEMPLATE(direct_sum, double)->Name("overlap_save/direct_sum/double")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct_sum, float)->Name("overlap_save/direct_sum/float")->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, double, rosin::lane_fft<double>)
    ->Name("overlap_save/lanes/double")
    ->Arg(0)
    ->Arg(512)
    ->Arg(2048)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, float, rosin::lane_fft<float>)
    ->Name("overlap_save/lanes/float")
    ->Arg(0)
    ->Arg(512)
    ->Arg(2048)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, double, rosin::eigen_fft<std::complex<double>>)
    ->Name("overlap_save/eigen/double")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(convolve, float, rosin::eigen_fft<std::complex<float>>)
    ->Name("overlap_save/eigen/float")
    ->Arg(0)
    ->Arg(8192)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, double, rosin::eigen_fft<double>)
    ->Name("overlap_save/four_bare_ffts/eigen/double")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(four_bare_ffts, float, rosin::eigen_fft<float>)
    ->Name("overlap_save/four_bare_ffts/eigen/float")
    ->Unit(benchmark::kMillisecond);

}  // namespace bench_overlap_save
