// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/passage_reconstructor.hpp>

#include <rosin/core/stage.hpp>
#include <rosin/reconstruct/passage_design.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace reconstruct_passage_reconstructor {

namespace {

constexpr double rate_Hz = 128e3;
const rosin::band limits{0.3 * rate_Hz, 0.45 * rate_Hz};
constexpr std::size_t Short = 6;

template <class T>
using stream_of = rosin::passage_reconstructor<T, 64, 320, Short>;

rosin::bow_point contact() { return rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {1000, 1e-9, 0}}, 0.3); }

rosin::passage_plan plan_for(rosin::bow_version version) {
  return rosin::plan_passages(contact(), {1.02, 0.97}, limits, rate_Hz, 1e-3, version, static_cast<int>(Short));
}

/// Two noisy forces, reproducible without a generator.
std::vector<double> forces(int seed, std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::sin(1.7 * static_cast<double>(i * i % 1013) + seed);
  return x;
}

template <class T>
std::vector<rosin::termination_frame<T>> frames(const std::vector<double>& near, const std::vector<double>& far) {
  std::vector<rosin::termination_frame<T>> out;
  for (std::size_t i = 0; i < near.size(); ++i) out.push_back({static_cast<T>(near[i]), static_cast<T>(far[i])});
  return out;
}

/// The whole-record result with the same kernels, by direct sums in double.
std::vector<double> whole(const rosin::fir& from_near, const rosin::fir& from_far, const std::vector<double>& near,
                          const std::vector<double>& far) {
  std::vector<double> out(near.size(), std::numeric_limits<double>::quiet_NaN());
  const auto n = static_cast<int>(near.size());
  for (int i = from_near.last(); i < n + from_near.first; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < from_near.taps.size(); ++j) {
      const auto at = static_cast<std::size_t>(i - from_near.first - static_cast<int>(j));
      sum += from_near.taps[j] * near[at] + from_far.taps[j] * far[at];
    }
    out[static_cast<std::size_t>(i)] = sum;
  }
  return out;
}

bool is_unknown(double x) { return std::isnan(x); }

template <class T>
bool same(const rosin::bow_frame<T>& a, const rosin::bow_frame<T>& b, T within) {
  const auto near = [&](T x, T y) { return std::abs(x - y) <= within; };
  return near(a.force_near_N, b.force_near_N) && near(a.force_far_N, b.force_far_N) &&
         near(a.velocity_near_m_s, b.velocity_near_m_s) && near(a.velocity_far_m_s, b.velocity_far_m_s);
}

}  // namespace

static_assert(rosin::Stage<stream_of<float>>);

TEST_CASE_TEMPLATE("it is the whole-record result, late by exactly the stated latency", T, float, double) {
  constexpr std::size_t n = 1500;
  const std::vector<double> near = forces(1, n), far = forces(2, n);
  for (const auto version : {rosin::bow_version::both, rosin::bow_version::near, rosin::bow_version::far}) {
    const rosin::passage_plan plan = plan_for(version);
    const auto fixed = rosin::fixed_size<T, 64, 320, Short>(plan);
    REQUIRE_MESSAGE(fixed, fixed.error());
    stream_of<T> stream{*fixed};
    const std::vector<rosin::fir> kernels = rosin::kernels_of(plan);
    const bool far_only = version == rosin::bow_version::far;
    const auto force = whole(kernels[far_only ? 2 : 0], kernels[far_only ? 3 : 1], near, far);
    const auto velocity = whole(kernels[far_only ? 6 : 4], kernels[far_only ? 7 : 5], near, far);
    const auto late = static_cast<std::size_t>(stream.latency());
    const auto in = frames<T>(near, far);
    const double tolerance = 40 * static_cast<double>(std::numeric_limits<T>::epsilon());
    std::size_t compared = 0, wrong = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto out = stream(in[i]);
      CHECK(stream.known() == !is_unknown(static_cast<double>(out.force_near_N)));
      if (!stream.known()) continue;
      const double f = static_cast<double>(far_only ? out.force_far_N : out.force_near_N);
      const double v = static_cast<double>(far_only ? out.velocity_far_m_s : out.velocity_near_m_s);
      wrong += !(std::abs(f - force[i - late]) < tolerance);
      wrong += !(std::abs(v - velocity[i - late]) < tolerance / contact().impedance_Ns_m);
      ++compared;
    }
    CHECK(wrong == 0);
    CHECK(compared > n - 330);
  }
}

TEST_CASE_TEMPLATE("a block of any length gives what frame by frame gives, to rounding", T, float, double) {
  const auto in = frames<T>(forces(3, 2000), forces(4, 2000));
  const auto fixed = rosin::fixed_size<T, 64, 320, Short>(plan_for(rosin::bow_version::both));
  REQUIRE(fixed);
  std::vector<rosin::bow_frame<T>> one_by_one;
  stream_of<T> single{*fixed};
  for (const auto& frame : in) one_by_one.push_back(single(frame));
  for (const std::size_t block : {1UL, 7UL, 16UL, 64UL, 333UL, 2000UL}) {
    stream_of<T> stream{*fixed};
    std::vector<rosin::bow_frame<T>> out(in.size());
    for (std::size_t i = 0; i < in.size(); i += block) {
      const std::size_t count = std::min(block, in.size() - i);
      stream.process({in.data() + i, count}, {out.data() + i, count});
    }
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < in.size(); ++i) {
      const bool unknown = is_unknown(static_cast<double>(one_by_one[i].force_near_N));
      wrong += unknown ? !is_unknown(static_cast<double>(out[i].force_near_N))
                       : !same(out[i], one_by_one[i], 200 * std::numeric_limits<T>::epsilon());
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a NaN or an infinity is flagged for as long as it is in reach, and leaves no trace") {
  auto in = frames<float>(forces(5, 1600), forces(6, 1600));
  const auto fixed = rosin::fixed_size<float, 64, 320, Short>(plan_for(rosin::bow_version::both));
  REQUIRE(fixed);
  stream_of<float> clean{*fixed}, hurt{*fixed};
  std::vector<rosin::bow_frame<float>> expected(in.size()), out(in.size());
  clean.process(in, expected);
  in[700].near_N = std::numeric_limits<float>::quiet_NaN();
  in[701].far_N = -std::numeric_limits<float>::infinity();
  hurt.process(in, out);
  std::size_t unknown = 0, wrong = 0;
  for (std::size_t i = 400; i < in.size(); ++i) {
    if (is_unknown(static_cast<double>(out[i].force_near_N))) {
      ++unknown;
      wrong += i < 700 || i >= 701 + fixed->reach;
    } else wrong += !same(out[i], expected[i], 1e-4F);
  }
  CHECK(unknown == fixed->reach + 1);  // frame 700 and those that see frame 701
  CHECK(wrong == 0);
}

TEST_CASE("reset brings back the beginning") {
  const auto in = frames<float>(forces(7, 700), forces(8, 700));
  const auto fixed = rosin::fixed_size<float, 64, 320, Short>(plan_for(rosin::bow_version::near));
  REQUIRE(fixed);
  stream_of<float> used{*fixed}, fresh{*fixed};
  std::vector<rosin::bow_frame<float>> a(in.size()), b(in.size());
  used.process(in, a);
  used.reset();
  CHECK_FALSE(used.known());
  used.process(in, a);
  fresh.process(in, b);
  std::size_t different = 0;
  for (std::size_t i = fixed->reach; i < in.size(); ++i)
    different += a[i].force_near_N != b[i].force_near_N || a[i].velocity_far_m_s != b[i].velocity_far_m_s;
  CHECK(different == 0);
  CHECK(a.back().force_near_N == a.back().force_far_N);  // one version alone: both fields hold it
}

}  // namespace reconstruct_passage_reconstructor
