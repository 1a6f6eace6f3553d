// Forces as results of runs: the power of what is prescribed is what T + V gains, efforts of drives
// are the residuals of (1a) in the coordinates they prescribe, energies balance with drives in
// every form, λ converges, and what is not unique is left out.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/random_tree.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/measure/drive_power.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/state_values.h>
#include <momenta/dae/study/own_reference.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta::dae_forces_of_runs {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

VectorXd any(RandomTree& random, int size, double reach) {
  VectorXd x(size);
  for (int i = 0; i < size; ++i) x[i] = random.uniform(-reach, reach);
  return x;
}

/// A tree with drives of joints, a loop with drives of its own, and a coupler of driven and free
/// joints; in a plane or in space.
Scene driven_scene(RandomTree& random, unsigned seed, bool flat, const TreeRecipe& recipe) {
  Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
  if (flat || seed % 4 == 0) return scene;
  if (const auto coupler = random_coupler(random, scene); coupler && seed % 2 == 0) {
    scene.loops.push_back(*coupler);
    if (seed % 3 == 0) drive_loop(random, scene, *coupler, 1, 0);
  }
  scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
  drive_loop(random, scene, scene.loops.back(), random.below(8), random.below(8));
  return scene;
}

/// The power of drives and of forces without potential against the rate of T + V along the motion,
/// by a difference of fourth order.
TEST(ForcesOfRuns, PowerOfDrivesIsWhatEnergyGains) {
  int tried = 0, flat_ones = 0, trees = 0;
  double largest = 0;
  for (unsigned seed = 0; seed < 90; ++seed) {
    RandomTree random(seed);
    const bool flat = seed % 5 == 0;
    const Scene scene = driven_scene(random, seed, flat, {.bodies = 5});
    const Mechanism mechanism(scene, {.algebra = flat ? Algebra::automatic : Algebra::spatial});
    const int nv = mechanism.nv(), m = mechanism.m();
    if (m > nv || nv == 0 || !mechanism.plan().drives) continue;
    const auto e = mechanism.evaluation<double>();
    const auto solver = m > 0 ? make_loop_solver(mechanism, *e) : nullptr;
    const TreeState s = random.state(mechanism.tree());
    VectorXd u = s.u, sigma(m), udot(nv), lambda(m), qdot(mechanism.nq());
    if (m > 0) {
      ASSERT_TRUE(solver->momentum(s.t, s.q.data(), s.u.data(), nullptr, 1e-13, 0, u.data(),
                                   sigma.data(), nullptr));
      ASSERT_TRUE(solver->acceleration(s.t, s.q.data(), u.data(), nullptr, 0, 0, udot.data(),
                                       lambda.data()));
    } else {
      ASSERT_TRUE(e->open_accelerations(s.t, s.q.data(), u.data(), udot.data()));
    }
    if (!(lambda.norm() < 300) || !(udot.norm() < 300)) continue;
    ++tried;
    flat_ones += mechanism.plan().planar;
    trees += m == 0;
    e->place(s.t, s.q.data());
    e->move(u.data());
    e->coordinate_rates(s.q.data(), u.data(), qdot.data());
    const double lost = e->dissipated_power(s.q.data(), u.data());
    DrivePower drives(mechanism, *e, solver.get());
    ASSERT_TRUE(drives.any());
    const double power = drives.at(s.t, s.q.data(), u.data());
    const auto energy = [&](double h) {
      const VectorXd q = s.q + h * qdot, v = u + h * udot;
      e->place(s.t + h, q.data());
      e->move(v.data());
      return e->kinetic() + e->potential(q.data());
    };
    const double h = 2e-4;
    const double rate =
        (8 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) / (12 * h);
    EXPECT_NEAR(rate, power + lost, 1e-6 * (1 + std::abs(power) + std::abs(lost) + udot.norm()))
        << seed;
    largest = equations::larger(largest, std::abs(power));
  }
  EXPECT_GT(tried, 30);
  EXPECT_GT(flat_ones, 5);
  EXPECT_GT(trees, 10);
  EXPECT_GT(largest, 10);
}

/// The slow twin of efforts: the mechanism with the driven coordinates set free, and the residual
/// of (1a) in them, at any accelerations and any multipliers.
TEST(ForcesOfRuns, EffortsAreResidualsOfTheMechanismSetFree) {
  int tried = 0, coupled = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    RandomTree random(seed);
    const bool flat = seed % 5 == 0;
    const TreeRecipe recipe{.bodies = 5, .kinds = canonical_kinds, .rotors = false};
    const Scene scene = driven_scene(random, seed, flat, recipe);
    Scene set_free = scene;
    std::erase_if(set_free.drives, [](const DriveSpec& d) { return !d.joint.empty(); });
    const MechanismOptions options{.algebra = flat ? Algebra::automatic : Algebra::spatial};
    const Mechanism mechanism(scene, options), twin(set_free, options);
    const std::size_t drives = mechanism.tree().drives.size();
    if (drives == 0) continue;
    ASSERT_EQ(twin.m(), mechanism.m());
    ++tried;
    for (const LoopSpec& loop : scene.loops)
      for (const std::string& joint : loop.joints)
        coupled += std::any_of(scene.drives.begin(), scene.drives.end(),
                               [&](const DriveSpec& d) { return d.joint == joint; });
    const double t = 0.3;
    const VectorXd q = any(random, mechanism.nq(), 1), u = any(random, mechanism.nv(), 1),
                   udot = any(random, mechanism.nv(), 3), lambda = any(random, mechanism.m(), 5);
    // Body by body: the trees are the same but for what is prescribed.
    ASSERT_EQ(twin.tree().bodies.size(), mechanism.tree().bodies.size());
    VectorXd q2(twin.nq()), u2(twin.nv()), udot2(twin.nv()), tau(twin.nv());
    std::vector<int> place(drives);
    for (std::size_t k = 0; k < twin.tree().bodies.size(); ++k) {
      const Tree::Body &b = mechanism.tree().bodies[k], &c = twin.tree().bodies[k];
      ASSERT_EQ(b.joint, c.joint);
      if (b.drive >= 0) {
        const auto drive = static_cast<std::size_t>(b.drive);
        ASSERT_EQ(c.nv, 1);
        mechanism.tree().drives[drive].evaluate(t, q2[c.q], u2[c.u], udot2[c.u]);
        place[drive] = c.u;
        continue;
      }
      for (int i = 0; i < b.nv; ++i) {
        q2[c.q + i] = q[b.q + i];
        u2[c.u + i] = u[b.u + i];
        udot2[c.u + i] = udot[b.u + i];
      }
    }
    const auto e = twin.evaluation<double>();
    e->place(t, q2.data());
    e->move(u2.data());
    e->joint_forces(q2.data(), u2.data(), udot2.data(), lambda.data(), tau.data());
    const auto sweep = make_wrench_sweep(mechanism);
    std::vector<double> efforts(drives);
    sweep->move(t, q.data(), u.data(), udot.data(), lambda.data());
    sweep->efforts(efforts.data());
    for (std::size_t i = 0; i < drives; ++i)
      EXPECT_NEAR(efforts[i], tau[place[i]], 1e-10 * (1 + tau.norm())) << seed << " drive " << i;
  }
  EXPECT_GT(tried, 30);
  EXPECT_GT(coupled, 3);
}

struct Method {
  std::string form, integrator, gauge;
  double tolerance, bound;  ///< of the energy error, relative
  double step = 0;          ///< of methods with steps of one length [s]
};

RunResult run_by(const Mechanism& mechanism, const Method& how, double end) {
  RunRequest request =
      equations::adaptive(how.form, how.integrator, how.gauge, how.tolerance, end, 50);
  request.settings.step = how.step;
  request.multipliers = true;
  return run_form(mechanism, start_of(mechanism), request);
}

/// With the work of drives counted, energies of driven mechanisms balance as those of others do: a
/// driven crank, a rope of prescribed length, a driven tree.
TEST(ForcesOfRuns, EnergyBalancesWithDrivesInEveryForm) {
  Scene tree = example("driven/scene.toml");
  tree.loops.clear();
  std::erase_if(tree.joints, [](const JointSpec& j) { return j.name == "C"; });
  std::erase_if(tree.bodies, [](const BodySpec& b) { return b.name == "rocker"; });
  for (const Scene& scene : {example("driven/scene.toml"), example("driven/swing.toml"), tree}) {
    const Mechanism mechanism(scene);
    for (const Method& how : {Method{"momentum", "vern9", "reset", 1e-13, 1e-12},
                              Method{"momentum", "dop853", "leak:3", 1e-12, 1e-10},
                              Method{"acceleration", "vern9", "", 1e-13, 1e-12},
                              Method{"projected", "vern9", "", 1e-13, 1e-12},
                              Method{"baumgarte", "dop853", "", 1e-12, 1e-10},
                              Method{"partitioned", "dop853", "", 1e-12, 1e-10},
                              Method{"momentum-index2", "ida", "leak:3", 1e-9, 1e-6},
                              Method{"stabilised-index2", "ida", "", 1e-9, 1e-6},
                              Method{"acceleration-index1", "ida", "", 1e-9, 1e-6},
                              Method{"momentum-index1", "ida", "leak:3", 1e-9, 1e-6}}) {
      if (mechanism.m() == 0 && how.form != "momentum" && how.form != "acceleration") continue;
      Method method = how;
      if (mechanism.m() == 0) method.gauge = "";
      const RunResult run = run_by(mechanism, method, 3);
      ASSERT_EQ(run.status, "done") << scene.name << " " << how.form << ": " << run.reason;
      EXPECT_LE(run.energy_error_max, how.bound * run.energy_scale)
          << scene.name << " " << how.form << " " << how.integrator;
      // The drive has done work, or there was nothing to balance.
      EXPECT_GT(run.energy_scale, 1);
    }
  }
}

/// To 1e-12 of the energies where the method is that good: implicit Runge-Kutta methods for ODEs
/// and DAEs, and feedback and penalties, which leave the loops open by the tolerance. Others as far
/// as their steps and error tests go. Balances of radau5 are three times its errors of velocities,
/// whatever the tolerance: they are of the motion, not of the quadrature of the power. At 1e-14
/// what is left on accelerations no longer goes with it.
TEST(ForcesOfRuns, EnergyBalancesWithDrivesByImplicitMethods) {
  for (const std::string name : {"driven/scene.toml", "driven/swing.toml"}) {
    const Mechanism mechanism(example(name));
    for (const Method& how :
         {Method{"momentum", "gauss6", "reset", 0, 1e-13, 0.002},
          Method{"momentum", "gauss4", "flip", 0, 1e-11, 0.001},
          Method{"momentum", "rattle", "reset", 0, 1e-4, 0.001},
          Method{"momentum-index1", "radau5", "leak:3", 1e-14, 5e-12},
          Method{"momentum-index2", "radau5", "reset", 1e-14, 1e-12},
          Method{"momentum-stabilised", "radau5", "leak:3", 1e-14, 1e-12},
          Method{"acceleration-index2", "radau5", "", 1e-14, 3e-12},
          Method{"stabilised-index2", "radau5", "", 1e-14, 3e-12},
          Method{"momentum-index2", "hem5", "reset", 1e-12, 1e-9},
          Method{"acceleration-index2", "hem5", "", 1e-12, 1e-9},
          Method{"momentum-index2", "bdf5", "reset", 1e-11, 1e-9},
          Method{"momentum", "bdf", "leak:3", 1e-10, 3e-8},
          Method{"maximal-coordinates", "dop853", "", 1e-13, 3e-12},
          Method{"augmented-lagrangian", "dop853", "", 1e-13, 3e-12},
          Method{"augmented-lagrangian-canonical", "dop853", "leak:3", 1e-13, 3e-12}}) {
      const RunResult run = run_by(mechanism, how, 1);
      ASSERT_EQ(run.status, "done") << name << " " << how.form << ": " << run.reason;
      EXPECT_LE(run.energy_error_max, how.bound * run.energy_scale)
          << name << " " << how.form << " " << how.integrator << " of " << run.energy_scale;
      EXPECT_GT(run.energy_scale, 0.1);
    }
  }
}

/// Every form and kind of method writes efforts and reactions, and they are those of (3) at the
/// row's own coordinates and rates.
TEST(ForcesOfRuns, EveryFormWritesTheForcesOfItsStates) {
  const Mechanism mechanism(example("driven/scene.toml"));
  std::vector<std::pair<std::string, std::string>> ways{
      {"momentum", "rattle"},
      {"momentum", "gauss4"},
      {"momentum-index2", "radau5"},
      {"momentum-index2", "hem5"},
      {"acceleration-index3", "generalised-alpha"},
      {"acceleration-index3", "bayo-ledesma"}};
  for (const std::string& form : form_names())
    ways.emplace_back(form, default_integrator(form, 1e-8));
  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  for (const auto& [form, integrator] : ways) {
    RunRequest request;
    request.settings.form = form;
    request.settings.integrator = integrator;
    request.settings.gauge = takes_gauge(form) ? "reset" : "";
    if (takes_gauge(form) && integrator == "ida") request.settings.gauge = "leak:3";
    request.settings.step = 0.005;
    request.settings.end_time = 0.2;
    request.settings.samples = 3;
    request.keep_trajectory = request.reactions = true;
    const RunResult run = run_form(mechanism, start_of(mechanism), request);
    ASSERT_EQ(run.status, "done") << form << " " << integrator << ": " << run.reason;
    const auto& columns = run.trajectory.columns;
    ASSERT_EQ(columns, trajectory_columns(mechanism, true));
    const auto effort = static_cast<std::size_t>(
        std::find(columns.begin(), columns.end(), "O.effort [N m]") - columns.begin());
    ASSERT_EQ(run.trajectory.rows.size(), 4u);
    for (const auto& row : run.trajectory.rows) {
      VectorXd udot(mechanism.nv()), lambda(mechanism.m());
      const VectorXd q = Eigen::Map<const VectorXd>(row.data() + 1, mechanism.nq()),
                     u = Eigen::Map<const VectorXd>(row.data() + 1 + mechanism.nq(),
                                                    mechanism.nv());
      ASSERT_TRUE(solver->acceleration(row[0], q.data(), u.data(), nullptr, 0, 0, udot.data(),
                                       lambda.data()));
      const Reactions all = reactions(mechanism, row[0], q, u, udot, lambda);
      std::size_t at = effort + 1;
      for (const Transmitted& r : all.joints) {
        for (const double x :
             {r.force.x(), r.force.y(), r.force.z(), r.torque.x(), r.torque.y(), r.torque.z()})
          EXPECT_NEAR(row[at++], x, 1e-9 * (1 + std::abs(x))) << form << " " << r.name;
        // In the plane the drive of O is the moment of its reaction about its axis.
        if (r.name == "O") {
          EXPECT_NEAR(row[effort], r.torque.z(), 1e-9) << form;
          EXPECT_GT(std::abs(row[effort]), 1e-3) << form;
        }
      }
      EXPECT_EQ(at, row.size());
    }
  }
  // Where there are no results a sentence says so.
  RunRequest request = equations::stepped("momentum", "energy-momentum", "none", 0.005, 0.1);
  EXPECT_TRUE(equations::says(equations::thrown<std::invalid_argument>(
                                  [&] { run_form(mechanism, start_of(mechanism), request); }),
                              "no prescribed motion"));
}

/// The balance has the order of the method: with steps half as long its error falls by 2⁴ or more.
TEST(ForcesOfRuns, TheBalanceOfDrivesHasTheOrderOfTheMethod) {
  const Mechanism mechanism(example("driven/scene.toml"));
  const auto error = [&](double step) {
    const RunResult run = run_form(mechanism, start_of(mechanism),
                                   equations::stepped("momentum", "gauss4", "reset", step, 2, 20));
    EXPECT_EQ(run.status, "done") << run.reason;
    return run.energy_error_max;
  };
  const double coarse = error(0.02), fine = error(0.01);
  EXPECT_GT(coarse / fine, 11) << coarse << " " << fine;
  EXPECT_LT(coarse / fine, 40) << coarse << " " << fine;
}

/// A force that takes the time has the digits of a double's time, and steps look for no more: as
/// many as of the same force without it.
TEST(ForcesOfRuns, OfTheTimeAskAReferenceForNoMoreThanTheTimeHas) {
  const auto steps = [](const std::string& law) {
    const Mechanism mechanism(
        parse_scene("gravity = [0, -9.81, 0]\n[[body]]\nname = \"p\"\nmass = 1\n"
                    "shape = { kind = \"rod\", length = 1 }\n[[joint]]\nname = \"J\"\n"
                    "kind = \"revolute\"\nchild = \"p\"\nposition = 0.3\n[[force]]\n"
                    "kind = \"torque\"\njoint = \"J\"\nlaw = \"" +
                    law + "\"\n"));
    long count = 0;
    const OwnReference own =
        own_reference(mechanism, assemble(mechanism).start, 0.5, 2, [&](double) {
          ++count;
          return true;
        });
    EXPECT_LT(own.accuracy, 1e-11) << law;
    return count;
  };
  EXPECT_LE(steps("0.8*t"), steps("0.8*q"));
}

/// λ of the reference in quadruple precision against λ of (3) in doubles at the same state, and
/// against the λ of a run.
TEST(ForcesOfRuns, MultipliersConvergeToThoseOfQuadruplePrecision) {
  for (const std::string name :
       {"andrews/scene.toml", "four_bar/scene.toml", "spatial_slider_crank/scene.toml"}) {
    const Mechanism mechanism(example(name));
    const Start start = assemble(mechanism).start;
    const double end = name[0] == 'a' ? 0.004 : 0.2;
    const OwnReference own = own_reference(mechanism, start, end, 2);
    const auto first = static_cast<std::size_t>(mechanism.nq() + mechanism.nv());
    ASSERT_TRUE(own.reference.has_forces());
    double size = 0;
    for (int i = 0; i < mechanism.m(); ++i) size = std::max(size, std::abs(start.lambda[i]));
    for (int i = 0; i < mechanism.m(); ++i)
      EXPECT_NEAR(own.reference.values()[0][first + static_cast<std::size_t>(i)], start.lambda[i],
                  1e-10 * (1 + size))
          << name << " " << i;
    const auto errors = [&](const std::string& form, const std::string& gauge, double tolerance) {
      RunRequest request = equations::adaptive(form, "dop853", gauge, tolerance, end, 2);
      request.reference = &own.reference;
      const RunResult run = run_form(mechanism, start, request);
      EXPECT_EQ(run.status, "done") << name << form << run.reason;
      return run;
    };
    for (const auto& [form, gauge] : std::map<std::string, std::string>{
             {"momentum", "reset"}, {"projected", ""}, {"baumgarte", ""}}) {
      const RunResult loose = errors(form, gauge, 1e-5), tight = errors(form, gauge, 1e-11);
      EXPECT_LT(tight.force_error_max, 1e-7) << name << " " << form;
      EXPECT_LT(tight.force_error_max, 1e-2 * loose.force_error_max) << name << " " << form;
      EXPECT_LT(tight.multiplier_error_max, 1e-2) << name << " " << form;
    }
  }
}

/// λ = σ̇ + κσ of the states alone: it is the λ of (3) but for the method's error, with every gauge,
/// and its noise grows as the inverse of the step.
TEST(ForcesOfRuns, MultipliersOfImpulsesAreThoseOfTheSolution) {
  const Mechanism mechanism(example("four_bar/scene.toml"), {.cut = CutChoice::scene});
  for (const char* gauge : {"none", "reset", "flip", "leak:3"}) {
    const auto difference = [&](double step) {
      RunRequest request = equations::stepped("momentum", "gauss6", gauge, step, 2, 37);
      request.multipliers = true;
      const RunResult run = run_form(mechanism, start_of(mechanism), request);
      EXPECT_EQ(run.status, "done") << run.reason;
      EXPECT_EQ(run.series.multiplier_difference.size(), run.series.t.size());
      EXPECT_TRUE(std::isnan(run.series.multiplier_difference[0]));  // no step has been taken
      EXPECT_FALSE(std::isnan(run.series.multiplier_difference[1]));
      return run.multiplier_difference_max;
    };
    const double coarse = difference(0.02), fine = difference(0.01);
    EXPECT_LT(coarse, 0.1) << gauge;
    EXPECT_GT(coarse / fine, 4) << gauge << " " << coarse << " " << fine;
    EXPECT_GT(difference(1e-5), 1e-13 / 1e-5 * 1e-3) << gauge;  // noise, ε over the step
  }
}

/// Of loops all of whose forces are open nothing is compared: no error, not none.
TEST(ForcesOfRuns, WhatIsNotUniqueHasNoError) {
  const Mechanism mechanism(example("bricard/scene.toml"));
  const Start start = start_of(mechanism);
  std::vector<std::string> columns{"P1.q [rad]"};
  for (const Column& c : mechanism.multiplier_columns()) columns.push_back(c.label());
  const std::vector<double> zeros(columns.size());
  Reference reference("zeros", columns, {0, 0.1}, {zeros, zeros});
  reference.bind(trajectory_columns(mechanism));
  RunRequest request = equations::adaptive("momentum", "dop853", "reset", 1e-8, 0.1, 1);
  request.reference = &reference;
  const RunResult run = run_form(mechanism, start, request);
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_FALSE(std::isnan(run.position_error_max));
  EXPECT_TRUE(std::isnan(run.force_error_max)) << run.force_error_max;
  EXPECT_TRUE(std::isnan(run.multiplier_difference_max)) << run.multiplier_difference_max;
}

/// Columns of efforts and reactions are those of one state; what is not unique is left out.
TEST(ForcesOfRuns, ColumnsAreTheForcesOfTheState) {
  for (const std::string name :
       {"driven/scene.toml", "spatial_slider_crank/scene.toml", "extremes/three_cranks.toml"}) {
    const Mechanism mechanism(example(name));
    RunRequest request =
        equations::kept(equations::adaptive("momentum", "dop853", "leak:3", 1e-8, 0.4, 3));
    request.reactions = true;
    const RunResult run = run_form(mechanism, start_of(mechanism), request);
    ASSERT_EQ(run.status, "done") << run.reason;
    const auto& columns = run.trajectory.columns;
    ASSERT_EQ(columns, trajectory_columns(mechanism, true));
    const auto at = [&](const std::string& column) {
      const auto found = std::find(columns.begin(), columns.end(), column);
      EXPECT_NE(found, columns.end()) << column;
      return static_cast<std::size_t>(found - columns.begin());
    };
    int left_out = 0, given_ones = 0;
    for (const auto& row : run.trajectory.rows) {
      ASSERT_EQ(row.size(), columns.size());
      GivenState given;
      given.t = row[0];
      given.q.resize(mechanism.nq());
      given.v.resize(mechanism.nv());
      std::copy_n(row.begin() + 1, mechanism.nq(), given.q.begin());
      std::copy_n(row.begin() + 1 + mechanism.nq(), mechanism.nv(), given.v.begin());
      given.p = given.tau = VectorXd::Zero(mechanism.nv());
      const StateValues state = evaluate_state(mechanism, given);
      for (const Transmitted& r : state.reactions.joints)
        for (int i = 0; i < 6; ++i) {
          const char* parts[] = {".force_x [N]",    ".force_y [N]",    ".force_z [N]",
                                 ".torque_x [N m]", ".torque_y [N m]", ".torque_z [N m]"};
          const double expected = i < 3 ? r.force[i] : r.torque[i - 3],
                       found = row[at(r.name + parts[i])];
          EXPECT_EQ(std::isnan(found), !r.unique) << name << " " << r.name;
          left_out += std::isnan(found);
          given_ones += !std::isnan(found);
          if (r.unique) {
            EXPECT_NEAR(found, expected, 1e-8 * (1 + r.force.norm() + r.torque.norm()))
                << name << " " << r.name << parts[i];
          }
        }
      if (name[0] == 'd') {
        // The planar drive of O: the moment of its reaction about its axis.
        EXPECT_NEAR(row[at("O.effort [N m]")], row[at("O.torque_z [N m]")], 1e-9);
      }
    }
    EXPECT_EQ(given_ones > 0, name[0] != 'e') << name;  // in three cranks every joint shares
    EXPECT_EQ(left_out > 0, name[0] == 'e') << name;
  }
}

}  // namespace
}  // namespace momenta::dae_forces_of_runs
