// expect: ReflectionFunction
// SPDX-License-Identifier: MIT
// A reflection function depends on frequency, even where it is constant.
#include <rosin/reconstruct/periodic_reconstruction.hpp>

auto motion(const rosin::bow_point& at, std::span<const double> near_N, std::span<const double> far_N) {
#ifdef ROSIN_MUST_FAIL
  return rosin::reconstruct_periodic<rosin::full_physics>(at, near_N, far_N, rosin::band{20e3, 30e3}, 128e3, -0.98);
#else
  return rosin::reconstruct_periodic<rosin::full_physics>(at, near_N, far_N, rosin::band{20e3, 30e3}, 128e3,
                                                          [](double) { return -0.98; });
#endif
}
