// tier: hosted
// SPDX-License-Identifier: MIT
//
// Pieces of work that do not depend on one another, on several threads. Each is known by its number and keeps what it makes to
// itself, so that nothing depends on how many threads there are but the time.
//
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// How many threads are meant: so many, or for 0 as many as there are cores.
[[nodiscard]] inline std::size_t threads_for(int asked) noexcept {
  return asked > 0 ? static_cast<std::size_t>(asked) : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

/// work(0), ..., work(count - 1), each once, in any order, on this thread and up to threads_for(threads) - 1 others, as many as can be had.
/// Returns when all are done; what the lowest number that threw has thrown is thrown then.
template <class Work>
void at_once(std::size_t count, int threads, const Work& work) {
  std::vector<std::exception_ptr> thrown(count);
  std::atomic<std::size_t> next{0};
  const auto take_part = [&]() noexcept {
    for (std::size_t i = next++; i < count; i = next++) try {
        work(i);
      } catch (...) {
        thrown[i] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (std::size_t i = 1; i < std::min(count, threads_for(threads)); ++i) others.emplace_back(take_part);
    } catch (const std::system_error&) {  // there are no more to be had: these will do
    }
    take_part();
  }
  for (const auto& what : thrown)
    if (what) std::rethrow_exception(what);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
