// expect: Feeds
// SPDX-License-Identifier: MIT
// A float stage cannot feed a double stage, wherever in the chain.
#include <rosin/core/pipeline.hpp>

template <class T>
struct gain {
  using input_type = T;
  using output_type = T;
  T operator()(const T& x) noexcept { return x; }
  void reset() noexcept {}
  T latency() const noexcept { return T(0); }
};

#ifdef ROSIN_MUST_FAIL
using last = gain<double>;
#else
using last = gain<float>;
#endif
auto chain = rosin::pipeline(gain<float>{}, gain<float>{}, last{});
