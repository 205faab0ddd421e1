// SPDX-License-Identifier: MIT
//
// Everything rosin claims about its accuracy, measured: prints the tables of docs/verification.md. The strings are those of the
// modal simulator, which shares no method with what is tested here.
//
#include "../tests/proof/chain.hpp"
#include "../tests/proof/pluck_statistics.hpp"

#include <algorithm>
#include <cstdio>

namespace {

using rosin::airy_form, rosin::airy_passage, rosin::exact_passage, rosin::physics;

void row(const char* processing, const proof::verdict& v) {
  std::printf("| %-44s | %.4f | %.4f | %.4f | %.4f | %.4f |\n", processing, v.whole.versions, v.whole.force, v.whole.velocity,
              v.transient.force, v.periodic.force);
}

void exact_parameters(bool thermal) {
  const rosin::modal_take take = proof::paper_take(thermal);
  std::printf("\n## Exact parameters, no noise: %s\n\n", thermal ? "thermal friction" : "friction as a function of velocity");
  std::printf(
      "| processing | two versions | force | velocity | force, first 60 ms | force, last 200 ms |\n|---|---|---|---|---|---|\n");
  row("the paper's, Eq. (6) as printed",
      proof::with_exact_parameters<physics<false, false, false, airy_passage<airy_form::printed>>>(take));
  row("the paper's, Airy kernel as an all-pass", proof::with_exact_parameters<rosin::paper_physics>(take));
  row("the paper's, exact phase", proof::with_exact_parameters<physics<false, false, false, exact_passage>>(take));
  row("with force factor and near field", proof::with_exact_parameters<physics<true, true, false, exact_passage>>(take));
  row("rosin: with loss as well", proof::with_exact_parameters<rosin::full_physics>(take));
}

void plucks(const char* heading, rosin::damping_convention damping, int rigs) {
  const proof::pluck_errors e = proof::judge_plucks(1, rigs, 5, damping, 0.14, true);
  std::printf("\n## %zu noisy plucks, %s (fits that failed: %d)\n\n", e.error.size(), heading, e.failed);
  std::printf("| | rms error / stated sd | rms error / Cramer-Rao bound | within 1.96 sd |\n|---|---|---|---|\n");
  for (std::size_t i = 0; i < proof::judged_names.size(); ++i)
    std::printf("| %s | %.2f | %.2f | %.1f %% |\n", proof::judged_names[i], proof::rms_ratio(e.error, e.sd, i),
                proof::rms_ratio(e.error, e.bound, i), 100 * proof::coverage(e, i));
}

void chain_row(const std::string& name, const proof::chain_row& r) {
  std::printf("| %s | %.3f | %.4f | %.4f | %.4f | %+.2f %% | %.2f %% | %.1f %% | %.2f | %.1f %% | %.2f |\n", name.c_str(),
              r.position, r.made.whole.versions, r.made.whole.force, r.made.whole.velocity, 100 * r.scale_error, 100 * r.scale_sd,
              100 * r.force_inside, r.force_width, 100 * r.velocity_inside, r.velocity_width);
}

void chain_heading(const char* title) {
  std::printf("\n## %s\n\n", title);
  std::printf(
      "| take | beta | two versions | force | velocity | scale off by | stated | force within 1.96 sd | sd / error | "
      "velocity within | sd / error |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void whole_chain() {
  chain_heading("The whole chain on the paper's string: 16 bits, 0.3 mN of noise");
  for (const bool thermal : {true, false})
    for (const proof::chain_row& r : proof::run_chain(proof::paper_laboratory(thermal)).rows)
      chain_row(std::string(thermal ? "thermal, " : "curve, ") + r.take, r);
}

void random_rigs() {
  const proof::chain_result all = proof::run_random_rigs(1, 24);
  chain_heading("The whole chain on 24 random rigs: 16 bits, 0.3 to 0.5 mN of noise");
  for (const proof::chain_row& r : all.rows)
    chain_row("rig " + std::to_string(r.seed) + (r.thermal ? " t, " : " c, ") + r.take, r);
  const auto worst = std::max_element(all.rows.begin(), all.rows.end(),
                                      [](const auto& a, const auto& b) { return a.made.whole.force < b.made.whole.force; });
  std::printf(
      "\n%zu takes; %d without stick-slip motion left out; %zu failures. Worst against the truth: %.4f (rig %llu, %s: force of "
      "%.3f N rms).\n",
      all.rows.size(), all.without_slip, all.failures.size(), worst->made.whole.force,
      static_cast<unsigned long long>(worst->seed), worst->take.c_str(), worst->force_rms_N);
  for (const std::string& failure : all.failures) std::printf("failed: %s\n", failure.c_str());
}

}  // namespace

int main() {
  exact_parameters(true);
  exact_parameters(false);
  plucks("viscous damping as in the model", rosin::damping_convention::viscous, 40);
  plucks("damping in the elastic stress", rosin::damping_convention::kelvin_voigt, 20);
  whole_chain();
  random_rigs();
}
