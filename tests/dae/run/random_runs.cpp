// Any mechanism by any form and any integrator that takes it: a run that says `done` has kept its
// loops closed and its energy in balance, by the slow twin of equations/looped_motion.h; one that
// has not says why it is not done.
//
//   |Φ|, |Φ̇|   of rows in m and rad, of rates in units of the largest rate
//   balance    T + V less ∫ power, against its start, in units of the energy there is
//
// The mechanisms: planar and in space, 1 to 6 loops, some driven, some redundant, one body or all
// of them 10⁻⁹ to 10⁹ times as heavy. Ordinarily each pair of form and integrator has one small
// mechanism. A campaign: MOMENTA_RUNS=5000 in the environment, MOMENTA_RUNS_FROM=1 its first seed;
// MOMENTA_FOUND names a folder for the scenes of what fails.

#include "equations/any_text.h"
#include "equations/ensemble.h"
#include "equations/looped_motion.h"
#include "equations/random_mechanisms.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/write_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_form.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace momenta::dae_random_runs {
namespace {

using namespace equations;
using Eigen::VectorXd;

unsigned from_environment(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);  // NOLINT: tests have one thread
  return text ? static_cast<unsigned>(std::atoi(text)) : otherwise;
}

using Pair = std::pair<std::string, std::string>;  // form, integrator
std::vector<Pair> pairs() {
  std::vector<Pair> all;
  for (const std::string& form : form_names())
    for (const Integrator& method : integrators())
      if (method.takes_form(form, is_dae_form(form)) &&
          !(method.multistep && needs_one_step_method(form)))
        all.emplace_back(form, method.name);
  return all;
}

Scene any_scene(unsigned seed, bool small) {
  RandomTree random(seed);
  MechanismRecipe recipe;
  recipe.loops = 1 + random.below(small ? 2 : 6);
  recipe.bodies = 2 + recipe.loops + random.below(small ? 2 : 4);
  recipe.planar = random.chance(0.5);
  recipe.drives = random.chance(0.2);
  recipe.forces = random.chance(0.4);
  recipe.loop_drives = random.chance(0.3);
  recipe.redundant = random.chance(0.3);
  recipe.decades = random.chance(0.4) ? 9 : 0;
  Scene scene = random_mechanism(random, recipe);
  scene.run.end_time = 0.3;
  return scene;
}

/// A run of the mechanism: the algebra of space for some that a plane would do for, any gauge.
struct Asked {
  Pair pair;
  Algebra algebra = Algebra::automatic;
  RunSettings settings;
};
Asked any_run(unsigned seed, const Scene& scene, const Pair& pair, bool small) {
  RandomTree random(seed + 77777);
  Asked a{pair, random.chance(0.3) ? Algebra::spatial : Algebra::automatic,
          default_settings(scene.run, pair.first, pair.second, 1e-8)};
  RunSettings& s = a.settings;
  const Integrator& method = integrator(pair.second);
  s.samples = small ? 16 : 32;
  if (method.step == Integrator::Step::fixed) s.step = scene.run.end_time / 160;
  constexpr std::array gauges{"leak", "none", "reset"};
  const char* gauge = gauges[static_cast<std::size_t>(random.below(3))];
  if (takes_gauge(s.form) && !method.hamiltonian &&
      (method.takes == Integrator::Takes::ode || method.resets))
    s.gauge = gauge;
  if (method.projects && !is_dae_form(s.form)) s.project = random.chance(0.2);
  return a;
}

/// What the twin says of a run.
struct Kept {
  double open = 0, opening = 0, balance = 0;
  double unsure = 0;  ///< how well the twin knows the integral of the power
};
Kept kept(const Mechanism& mechanism, const RunResult& run) {
  const LoopedMotion twin(mechanism.scene(), mechanism.tree());
  const int nq = mechanism.nq(), nv = mechanism.nv();
  std::vector<double> energy, power, coarse;
  double size = 0, fastest = 1;
  Kept k;
  for (const auto& row : run.trajectory.rows) {
    const double t = row[0];
    const VectorXd q = Eigen::Map<const VectorXd>(row.data() + 1, nq),
                   u = Eigen::Map<const VectorXd>(row.data() + 1 + nq, nv);
    if (nv > 0) fastest = std::max(fastest, u.cwiseAbs().maxCoeff());
    k.open = std::max(k.open, twin.open(t, q));
    k.opening = std::max(k.opening, twin.opening(t, q, u));
    energy.push_back(twin.energy(t, q, u));
    power.push_back(twin.power(t, q, u));
    if (power.size() % 2 == 1) coarse.push_back(power.back());
    size = std::max(size, twin.kinetic_energy(t, q, u) + std::abs(energy.back() - energy.front()) +
                              1e-6 * std::abs(energy.front()));  // where nothing moves
  }
  const double every = run.trajectory.rows[1][0] - run.trajectory.rows[0][0],
               work = integral(power, every);
  k.opening /= fastest;
  k.balance = std::abs(energy.back() - energy.front() - work) / size;
  k.unsure = std::abs(integral(coarse, 2 * every) - work) / size;
  return k;
}

/// What a run promises that says `done`: of adaptive steps by the tolerance, with room for what
/// grows on the way, and for Φ̇ and λ of index 3, which come an order late; of steps of length h by
/// the second order that the least of the methods has.
struct Promise {
  double open, opening, balance;
};
Promise promise(const RunSettings& s) {
  if (integrator(s.integrator).step == Integrator::Step::fixed) {
    const double bound = 1e3 * s.step * s.step;
    return {bound, bound, bound};
  }
  return {1e3 * s.rtol, 1e4 * s.rtol, 1e4 * s.rtol};
}

struct Outcome {
  std::string status;  ///< of the run; "refused": it or its start was
  std::string reason;  ///< where it is not done
  std::string wrong;   ///< empty: the law holds
  Kept kept;
  bool judged = false;
};
Outcome outcome(const Scene& scene, const Asked& asked) {
  Outcome o;
  const auto refused = [&](const std::string& why) {
    o.status = "refused";
    o.reason = why;
    o.wrong = wrong_as_a_sentence(why, o.status);
    return o;
  };
  try {
    validate(scene);
    const Mechanism mechanism(scene, {.algebra = asked.algebra});
    const Start start = equations::start_of(mechanism);
    RunRequest request;
    request.settings = asked.settings;
    request.keep_trajectory = true;
    request.max_cpu_seconds = 2;
    const RunResult run = run_form(mechanism, start, request);
    o.status = run.status;
    if (run.status != "done") {
      o.reason = run.reason;
      o.wrong = wrong_as_a_sentence(run.reason, run.status);
      return o;
    }
    const auto& rows = run.trajectory.rows;
    if (rows.size() != static_cast<std::size_t>(run.settings.samples) + 1 ||
        std::abs(rows.back()[0] - scene.run.end_time) > 1e-12) {
      o.wrong = "done, but not at the end";
      return o;
    }
    for (const auto& row : rows)
      for (int i = 0; i <= mechanism.nq() + mechanism.nv(); ++i)
        if (!std::isfinite(row[static_cast<std::size_t>(i)])) {
          o.wrong = "done with a state that is no number";
          return o;
        }
    if (!reliable(run)) {  // and told
      o.status = "done, and departed";
      o.reason = run.departure;
      return o;
    }
    o.kept = kept(mechanism, run);
    o.judged = true;
    const Promise p = promise(run.settings);
    if (!(o.kept.open <= p.open)) o.wrong += "open by " + std::to_string(o.kept.open) + "; ";
    if (!(o.kept.opening <= p.opening))
      o.wrong += "opening at " + std::to_string(o.kept.opening) + "; ";
    if (!(o.kept.balance <= p.balance + 10 * o.kept.unsure))
      o.wrong += "energy off by " + std::to_string(o.kept.balance) + "; ";
  } catch (const SceneError& error) {
    return refused(error.what());
  } catch (const std::invalid_argument& error) {
    return refused(error.what());
  }
  return o;
}

TEST(RandomRuns, DoneMeansClosedAndInBalance) {
  const auto all = pairs();
  const unsigned asked = from_environment("MOMENTA_RUNS", 0),
                 first = from_environment("MOMENTA_RUNS_FROM", 1);
  const unsigned count = asked > 0 ? asked : static_cast<unsigned>(all.size());
  const char* folder = std::getenv("MOMENTA_FOUND");  // NOLINT: tests have one thread
  std::map<std::string, int> by_status;
  int judged = 0;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned seed = first + i;
    const Pair& pair = all[(seed * 37) % all.size()];
    const Scene scene = any_scene(seed, asked == 0);
    const Asked run = any_run(seed, scene, pair, asked == 0);
    const Outcome o = outcome(scene, run);
    ++by_status[o.status];
    judged += o.judged && o.kept.unsure < 1e-3;
    if (asked > 0)
      std::printf("RUN %u %s %s %s %d%s %s %.2e %.2e %.2e %.2e %s\n", seed, pair.first.c_str(),
                  pair.second.c_str(), run.settings.gauge.c_str(), run.settings.project,
                  run.algebra == Algebra::spatial ? "s" : "", o.status.c_str(), o.kept.open,
                  o.kept.opening, o.kept.balance, o.kept.unsure, o.reason.c_str());
    EXPECT_EQ(o.wrong, "") << "seed " << seed << ", " << pair.first << ", " << pair.second;
    if (!o.wrong.empty() && folder)
      std::ofstream(std::string(folder) + "/" + std::to_string(seed) + ".toml")
          << "# " << pair.first << ", " << pair.second << ": " << o.wrong << '\n'
          << scene_text(scene);
  }
  for (const auto& [status, runs] : by_status) RecordProperty(status, runs);
  EXPECT_GT(judged, static_cast<int>(count) / 2);
}

}  // namespace
}  // namespace momenta::dae_random_runs
