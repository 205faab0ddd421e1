// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/reconstructor.hpp>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include "support/moving_end_rig.hpp"
#include "support/through_band.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace reconstruct_reconstructor {

namespace {

const rosin::string_parameters string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 659.69, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
constexpr double position = 0.3;
const rosin::band limits{20e3, 40e3};

/// 60 ms of a bowed string, made by modes: another method than the one that is inverted.
const rosin::modal_take& bowed() {
  static const rosin::modal_take take = *rosin::simulate_stroke(
      {.string = string, .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}},
      rosin::velocity_curve{rosin::two_exponential_curve<>{}}, rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
      {.position = position, .duration_s = 0.06}, {.oversampling = 4});
  return take;
}

/// The truth through the band of the reconstruction.
std::vector<double> through_band(const std::vector<double>& x) { return test::through_band(x, limits, bowed().sample_rate_Hz); }

template <class Motion>
std::vector<double> mean_force(const Motion& m) {
  std::vector<double> f;
  for (std::size_t i = 0; i < m.force_near_N.size(); ++i) f.push_back(static_cast<double>(m.force_N(i)));
  return f;
}

}  // namespace

TEST_CASE("force and velocity under the bow, transient included, to a few parts in ten thousand") {
  rosin::reconstructor<double> reconstruct(rosin::contact_at(string, position), limits, bowed().sample_rate_Hz);
  const rosin::bow_motion<double> m = reconstruct(bowed().force_near_N, bowed().force_far_N);
  CHECK(rosin::consistency_delta(m.force_near_N, m.force_far_N) < 0.002);
  CHECK(rosin::consistency_delta(mean_force(m), through_band(bowed().contact_force_N)) < 0.002);
  CHECK(rosin::consistency_delta(m.velocity_near_m_s, through_band(bowed().centre_velocity_m_s)) < 0.002);
}

TEST_CASE("the paper's processing is one of the choices, and does what the paper says") {
  rosin::reconstructor<double, rosin::paper_physics> reconstruct(rosin::contact_at(string, position), limits,
                                                                 bowed().sample_rate_Hz);
  const rosin::bow_motion<double> m = reconstruct(bowed().force_near_N, bowed().force_far_N);
  const double versions = rosin::consistency_delta(m.force_near_N, m.force_far_N);
  CHECK(versions > 0.01);
  CHECK(versions < 0.07);
}

TEST_CASE("what would need samples from beyond the record is not made up, and lengths are kept") {
  rosin::reconstructor<double> reconstruct(rosin::contact_at(string, position), limits, bowed().sample_rate_Hz);
  const rosin::bow_motion<double> m = reconstruct(bowed().force_near_N, bowed().force_far_N);
  CHECK(m.force_near_N.size() == bowed().size());
  const double passage = 0.7 * 0.5 / string.fundamental_Hz * bowed().sample_rate_Hz;
  CHECK(static_cast<double>(m.known.begin) >= passage);
  for (std::size_t i = 0; i < bowed().size(); ++i) {
    const bool inside = i >= m.known.begin && i < m.known.end;
    CHECK(std::isfinite(m.force_far_N[i]) == inside);
    CHECK(std::isfinite(m.velocity_near_m_s[i]) == inside);
  }
  const std::vector<double> brief(30, 0.1);
  const rosin::bow_motion<double> none = reconstruct(brief, brief);
  CHECK(none.known.begin == none.known.end);
  CHECK(std::isnan(none.force_near_N[15]));
}

TEST_CASE("float is float-precise") {
  rosin::reconstructor<double> in_double(rosin::contact_at(string, position), limits, bowed().sample_rate_Hz);
  rosin::reconstructor<float> in_float(rosin::contact_at(string, position), limits, bowed().sample_rate_Hz);
  const std::vector<float> near(bowed().force_near_N.begin(), bowed().force_near_N.end()),
      far(bowed().force_far_N.begin(), bowed().force_far_N.end());
  CHECK(rosin::consistency_delta(mean_force(in_float(near, far)),
                                 mean_force(in_double(bowed().force_near_N, bowed().force_far_N))) < 1e-5);
}

TEST_CASE("ends that move as declared cost nothing; taken for rigid they do") {
  const double fs = bowed().sample_rate_Hz, Z = string.impedance_Ns_m();
  const test::moving_end_rig rig{
      string, {std::vector<test::end_mode>{{900, 40, 2e-3}, {3000, 15, 8e-3}}, std::vector<test::end_mode>{{2000, 20, 5e-3}}}};
  const auto take =
      test::bow_moving_ends(rig, position, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                            {.speed_m_s = 0.2, .normal_force_N = 0.3}, 0.06, {.mode_limit_Hz = 60e3, .oversampling = 2});
  std::array<rosin::modal_termination, 2> ends;
  for (std::size_t e = 0; e < 2; ++e)
    for (const test::end_mode& m : rig.ends[e]) ends[e].modes.push_back({m.frequency_Hz, m.q, Z / m.mass_kg});
  const auto near = rosin::motion_of_end(ends[0], take.near_N, limits, fs),
             far = rosin::motion_of_end(ends[1], take.far_N, limits, fs);
  rosin::reconstructor<double> rigid(rosin::contact_at(string, position), limits, fs);
  rosin::reconstructor<double, rosin::with_moving_ends<rosin::full_physics>> moving(rosin::contact_at(string, position), limits,
                                                                                    fs);
  const auto as_rigid = rigid(take.near_N, take.far_N);
  const auto as_declared = moving({take.near_N, take.far_N, near.times_impedance_N, far.times_impedance_N});
  CHECK(rosin::consistency_delta(mean_force(as_declared), through_band(take.force_N)) < 0.001);
  CHECK(rosin::consistency_delta(as_declared.velocity_far_m_s, through_band(take.velocity_m_s)) < 0.003);
  CHECK(rosin::consistency_delta(as_declared.force_near_N, as_declared.force_far_N) < 0.001);
  CHECK(rosin::consistency_delta(mean_force(as_rigid), through_band(take.force_N)) > 0.005);
  CHECK(rosin::consistency_delta(as_rigid.force_near_N, as_rigid.force_far_N) > 0.01);
}

}  // namespace reconstruct_reconstructor
