// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_effects.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

TEST_CASE("contact effects: a contact as declared is called so") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 91),
             b = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 93);
  const auto found = rosin::contact_hypotheses({a.take(), b.take()}, contact_rigs::declared());
  CHECK(found.as_declared);
  CHECK(rosin::beyond_doubt(found).empty());
  CHECK(found.stick_fluctuation < 0.01);
  CHECK(found.friction_residual < 0.02);
  CHECK(found.independent > 200);
}

TEST_CASE("contact effects: torsion that nobody declared comes first, and is all there was") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 95);
  const auto found = rosin::contact_hypotheses({a.take()}, {});
  REQUIRE_FALSE(found.hypotheses.empty());
  const auto& best = found.hypotheses.front();
  CHECK_FALSE(found.as_declared);
  CHECK(best.effect == "torsion");
  CHECK(best.gain > 10 * found.hypotheses[1].gain);
  CHECK(best.parameters[0].value == test::approx(7).epsilon(0.005));
  const auto then = rosin::contact_hypotheses({a.take()}, rosin::include({}, best));
  CHECK(then.as_declared);
  for (const auto& h : then.hypotheses) CHECK(h.effect != "torsion");
}

TEST_CASE("contact effects: torsion that the catalogue does not know shows all the same") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 95);
  rosin::contact_model ignorant;
  ignorant.included = {"torsion",      "rod-resonance",        "elasto-plastic-friction", "creep",
                       "speed-ripple", "finite-contact-width", "normal-force-ripple",     "thermal-friction"};
  const auto found = rosin::contact_hypotheses({a.take()}, ignorant);
  CHECK(found.hypotheses.empty());
  CHECK(found.as_declared);
  CHECK(rosin::beyond_doubt(found) == "stick-fluctuation");
  CHECK(rosin::beyond_doubt(found, 1e3).empty());
}

TEST_CASE("contact effects: a contact of bristles is not asked for heat, as it has a law already") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 91);
  const auto asked = [&](const rosin::contact_model& model) {
    const auto found = rosin::contact_hypotheses({a.take()}, model).hypotheses;
    return std::any_of(found.begin(), found.end(), [](const auto& h) { return h.effect == "thermal-friction"; });
  };
  CHECK(asked(contact_rigs::declared()));
  const rosin::contact_hypothesis bristles{.effect = "elasto-plastic-friction",
                                           .parameters = {{"bristle_stiffness_N_m", 3e4, 3e2}}};
  CHECK_FALSE(asked(rosin::include(contact_rigs::declared(), bristles)));
}

TEST_CASE("contact effects: what no imperfect model looks like needs no more in a longer record") {
  rosin::contact_findings found;
  found.threshold = 200;
  rosin::contact_hypothesis rod{.effect = "rod-resonance"};
  rod.gain = rod.held_out_gain = 110;
  CHECK_FALSE(found.stands(rod));
  rod.peculiar = true;
  CHECK(found.stands(rod));
  rod.gain = rod.held_out_gain = 35;
  CHECK_FALSE(found.stands(rod));
}

TEST_CASE("contact effects: torsion is as declared where the string sticks as well as the reconstruction lets it") {
  rosin::contact_findings found;
  found.threshold = 100, found.stick_floor = 0.01;
  rosin::contact_hypothesis torsion{.effect = "torsion"}, rod{.effect = "rod-resonance"};
  torsion.gain = torsion.held_out_gain = rod.gain = rod.held_out_gain = 200;
  found.stick_fluctuation = 0.0065;
  CHECK(found.stands(torsion));
  found.stick_fluctuation = 0.006;
  CHECK_FALSE(found.stands(torsion));
  CHECK(found.stands(rod));
}

TEST_CASE("contact effects: of two ripples of one frequency the one is meant that takes more of what its statistic had") {
  const auto findings = [](double speed_leaves, double force_leaves, double force_Hz) {
    rosin::contact_findings f;
    f.tone_threshold = 30, f.stick_fluctuation = 0.012, f.friction_residual = 0.046;
    rosin::contact_hypothesis speed{.effect = "speed-ripple"}, force{.effect = "normal-force-ripple"};
    speed.gain = speed.held_out_gain = 900, speed.fluctuation = speed_leaves, speed.parameters = {{"frequency_Hz", 169.56, 0.04}};
    force.gain = force.held_out_gain = 500, force.fluctuation = force_leaves,
    force.parameters = {{"frequency_Hz", force_Hz, 0.05}};
    f.hypotheses = {speed, force};
    rosin::detail::keep_one_ripple(f);
    return std::pair{f.stands(f.hypotheses[0]), f.stands(f.hypotheses[1])};
  };
  CHECK(findings(0.0109, 0.0165, 169.6) == std::pair{false, true});
  CHECK(findings(0.004, 0.04, 169.6) == std::pair{true, false});
  CHECK(findings(0.0109, 0.0165, 172) == std::pair{true, true});  // each has its own
}

TEST_CASE("contact effects: a rod that leaves the string now and then is no contact as declared") {
  const auto findings = [](double leaves_for_s) {
    auto rod = contact_rigs::fast();
    rod.leaves_every_s = 0.02, rod.leaves_for_s = leaves_for_s;
    const auto a = contact_rigs::play(contact_rigs::curve(), rod, contact_rigs::rolls, 97);
    return rosin::contact_hypotheses({a.take()}, contact_rigs::declared());
  };
  const auto touches = findings(0), leaves = findings(1e-3);
  CHECK(rosin::beyond_doubt(touches).empty());
  CHECK(touches.warnings.empty());
  CHECK(leaves.as_declared);  // there is no name for it
  CHECK(rosin::beyond_doubt(leaves) == "friction-residual");
  REQUIRE(leaves.warnings.size() == 1);
  CHECK(leaves.warnings[0].find("bow: ") == 0);
}

TEST_CASE("contact effects: friction that is gone where the law has none either is no touch that is lost") {
  rosin::stick_rows rows;
  rows.target = Eigen::VectorXd::Constant(103, 0.4);
  rows.shared = Eigen::MatrixXd::Zero(103, 5);  // the last three rows keep the law smooth
  rows.target.segment(10, 20).setConstant(0.02), rows.target.tail(3).setZero();
  Eigen::VectorXd left = Eigen::VectorXd::Zero(103);
  CHECK(rosin::detail::loses_touch(rows, left).share == 0);
  left.segment(10, 10).setConstant(-0.3), left.tail(3).setConstant(-1);
  CHECK(rosin::detail::loses_touch(rows, left).share == test::approx(0.1));
  CHECK(rosin::detail::loses_touch(rows, left).left == test::approx(0.3 * std::sqrt(0.1)));
}

TEST_CASE("contact effects: what was found has to take half of what moved while it stuck, or leave a fifth of all at first") {
  const auto stuck = [](double fluctuation, double floor) {
    rosin::contact_findings f;
    f.stick_fluctuation = fluctuation, f.stick_floor = floor;
    return f;
  };
  const auto all = stuck(0.1, 0.01);
  CHECK(rosin::accounts_for_sticking(all, all, stuck(0.04, 0.01)));
  CHECK_FALSE(rosin::accounts_for_sticking(all, all, stuck(0.06, 0.01)));
  CHECK(rosin::accounts_for_sticking(all, all, stuck(0.06, 0.05)));  // no more than is uncertain
  // Versions that part by a width leave all uncertain. Six places that slide in part, and a ripple:
  const auto as_one = stuck(0.2, 0.333), wide = stuck(0.039, 0.005);
  CHECK(rosin::accounts_for_sticking(as_one, wide, stuck(0.0257, 0.005)));
  // A drift of the tension that nobody knows of, taken for a width and bristles:
  CHECK_FALSE(rosin::accounts_for_sticking(stuck(0.117, 0.195), stuck(0.0916, 0.0013), stuck(0.0517, 0.0014)));
}

TEST_CASE("contact effects: takes that tell nothing are left out, with a reason") {
  const std::vector<double> few(50, 0.1);
  rosin::contact_take take;
  take.name = "bow-9", take.force_N = few, take.velocity_m_s = few;
  const auto found = rosin::contact_hypotheses({take}, {});
  CHECK(found.hypotheses.empty());
  CHECK(found.as_declared);
  CHECK(rosin::beyond_doubt(found).empty());
  REQUIRE(found.warnings.size() == 1);
  CHECK(found.warnings[0].find("bow-9") == 0);
}
