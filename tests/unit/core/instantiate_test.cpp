// SPDX-License-Identifier: MIT
#include <rosin/core/instantiate.hpp>

#include <doctest/doctest.h>

namespace core_instantiate {

template <class Real = double>
int half(int x) {
  return x / 2;
}
ROSIN_INSTANTIATE(int half(int))

// A definition as the library's sources have it, since nothing else holds this function.
#ifdef ROSIN_COMPILED
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS
ROSIN_INSTANTIATE(int half(int))
#undef ROSIN_INSTANTIATE_AS
#define ROSIN_INSTANTIATE_AS extern
#endif

TEST_CASE("a function that is declared to be compiled once is called like any other") { CHECK(half(8) == 4); }

}  // namespace core_instantiate
