// SPDX-License-Identifier: MIT
#include <rosin/propagate/bow_point.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>
#include <rosin/reconstruct/passage_sums.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>

// Instantiated, not run: the symbols it leaves undefined are the test.
extern "C" void rosin_bow_block(const rosin::streaming_coefficients<float, 128>* coefficients, const float* near_N,
                                const float* far_N, float* force_N, int count) noexcept {
  rosin::streaming_reconstructor<float, 128, 512> stream{*coefficients};
  for (int n = 0; n < count; ++n) force_N[n] = stream({near_N[n], far_N[n]}).force_N();
}

extern "C" bool rosin_bow_passages(const rosin::passage_coefficients<float, 64, 7>* coefficients,
                                   const rosin::termination_frame<float>* in, rosin::bow_frame<float>* out,
                                   std::size_t count) noexcept {
  rosin::passage_reconstructor<float, 64, 256, 7> stream{*coefficients};
  stream.process({in, count}, {out, count});
  out[0] = stream(in[0]);
  const bool known = stream.known();
  stream.reset();
  return known;
}

extern "C" bool rosin_bow_passages_in_double(const rosin::passage_coefficients<double, 64, 7>* coefficients,
                                             const rosin::termination_frame<double>* in, rosin::bow_frame<double>* out,
                                             std::size_t count) noexcept {
  rosin::passage_reconstructor<double, 64, 256, 7> stream{*coefficients};
  stream.process({in, count}, {out, count});
  out[0] = stream(in[0]);
  return stream.known();
}
