// Errors of what a run says of forces: p without its gauge, impulses of loops, efforts, reactions
// and work, against references of quadruple precision and against slow twins.

#include "equations/decompositions.h"
#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/kkt_blocks.h"
#include "equations/random_tree.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/run/reference_errors.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/own_reference.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta::dae_errors_of_forces {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using equations::example;

OwnReference reference_of(const Mechanism& mechanism, double end, int count) {
  return own_reference(mechanism, assemble(mechanism).start, end, count, {}, true);
}

/// The values of a column over the reference's times.
std::vector<double> column(const Reference& reference, const std::string& name) {
  const auto& all = reference.columns();
  const auto at = std::find(all.begin(), all.end(), name);
  EXPECT_NE(at, all.end()) << name;
  std::vector<double> values;
  if (at == all.end()) return values;
  for (const auto& row : reference.values())
    values.push_back(row[static_cast<std::size_t>(at - all.begin())]);
  return values;
}

/// ∫ up to each third sample of equal intervals h, by Simpson's rule.
double simpson(const std::vector<double>& values, double h) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < values.size(); i += 2)
    sum += h / 3 * (values[i] + 4 * values[i + 1] + values[i + 2]);
  return sum;
}

RunResult run_by(const Mechanism& mechanism, const Reference& reference, const std::string& form,
                 const std::string& integrator, const std::string& gauge, double tolerance,
                 double end) {
  RunRequest request = equations::adaptive(form, integrator, gauge, tolerance, end, 4);
  request.reference = &reference;
  const RunResult run = run_form(mechanism, assemble(mechanism).start, request);
  EXPECT_EQ(run.status, "done") << form << " " << integrator << ": " << run.reason;
  return run;
}

const std::vector<std::string> closed{
    "four_bar/scene.toml", "andrews/scene.toml", "spatial_slider_crank/scene.toml",
    "bricard/scene.toml",  "driven/scene.toml",  "driven/swing.toml"};

/// The error of p is the part of M u − p_ref that moves, by dense matrices and a pseudo-inverse;
/// any Φ_qᵀc in the reference leaves it as it is, and what moves does not.
TEST(ErrorsOfForces, TheErrorOfMomentaHasNoGauge) {
  RandomTree random(7);
  for (const std::string& name : closed) {
    const Mechanism mechanism(example(name));
    const Start start = assemble(mechanism).start;
    const auto e = mechanism.evaluation<double>();
    const auto solver = make_loop_solver(mechanism, *e);
    const int n = mechanism.nv();
    VectorXd p(n), d(n), c(mechanism.m());
    e->place(start.t, start.q.data());
    e->move(start.u.data());
    e->momenta(nullptr, p.data());
    const KktBlocks kkt(mechanism, *e);
    for (int i = 0; i < n; ++i) d[i] = random.uniform(-1, 1);
    for (int i = 0; i < mechanism.m(); ++i) c[i] = random.uniform(-9, 9);
    const MatrixXd inverse = kkt.M.inverse();
    const MatrixXd D = kkt.J * inverse * kkt.J.transpose();
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> of_D;
    of_D.setThreshold(1e-9);
    of_D.compute(D);
    const VectorXd pushed = kkt.J * inverse * d, idle = of_D.solve(pushed),
                   moved = d - kkt.J.transpose() * idle;
    MomentumError error(mechanism, *e, solver.get());
    const auto of = [&](const VectorXd& reference) {
      return error.at(start.t, start.q.data(), start.u.data(), reference.data());
    };
    const auto expected = [&](const VectorXd& reference) {
      return (moved.array().abs() / (1 + reference.array().abs())).maxCoeff();
    };
    const VectorXd plain = p - d, shifted = plain + kkt.J.transpose() * c;
    EXPECT_NEAR(of(plain), expected(plain), 1e-9) << name;
    EXPECT_NEAR(of(shifted), expected(shifted), 1e-9) << name;
    EXPECT_LT(of(p + kkt.J.transpose() * c), 1e-9) << name;  // the gauge alone
    EXPECT_GT(of(plain), 1e-3) << name;
  }
}

/// A reference's impulses are the integrals of its λ, and its work that of its efforts: here
/// by Simpson's rule over its own samples. Its reactions at the start are those of the start.
TEST(ErrorsOfForces, ReferencesAgreeWithSumsOfTheirOwnColumns) {
  for (const std::string name : {"four_bar/scene.toml", "driven/scene.toml"}) {
    const Mechanism mechanism(example(name));
    const Start start = assemble(mechanism).start;
    constexpr int count = 200;
    const double end = 0.5, h = end / count;
    const OwnReference own = reference_of(mechanism, end, count);
    const auto impulses = impulse_columns(mechanism), lambdas = mechanism.multiplier_columns();
    for (std::size_t i = 0; i < impulses.size(); ++i)
      EXPECT_NEAR(column(own.reference, impulses[i].label()).back(),
                  simpson(column(own.reference, lambdas[i].label()), h), 1e-7)
          << name << " " << impulses[i].label();
    const VectorXd lambda = start.lambda;
    for (const Transmitted& r :
         reactions(mechanism, 0, start.q, start.u, start.udot, lambda).joints)
      EXPECT_NEAR(column(own.reference, r.name + ".force_x [N]").front(), r.force.x(),
                  1e-10 * (1 + r.force.norm()))
          << name << " " << r.name;
    if (name[0] != 'd') continue;
    // The drive of O turns the crank by π/2 + 2.5 sin 2t.
    std::vector<double> power = column(own.reference, "O.effort [N m]");
    for (std::size_t i = 0; i < power.size(); ++i)
      power[i] *= 5 * std::cos(2 * h * static_cast<double>(i));
    const double work = column(own.reference, "work [J]").back();
    EXPECT_NEAR(work, simpson(power, h), 1e-6);
    EXPECT_GT(std::abs(work), 1);
  }
}

/// In every form and gauge all of it converges to the reference.
TEST(ErrorsOfForces, ConvergeInEveryFormAndGauge) {
  struct Way {
    std::string form, integrator, gauge;
    double loose, tight, bound;
  };
  const std::vector<Way> ways{{"momentum", "dop853", "none", 1e-5, 1e-11, 1e-8},
                              {"momentum", "dop853", "reset", 1e-5, 1e-11, 1e-8},
                              {"momentum", "vern9", "flip", 1e-5, 1e-11, 1e-8},
                              {"momentum", "dop853", "leak:3", 1e-5, 1e-11, 1e-8},
                              {"projected", "dop853", "", 1e-5, 1e-11, 1e-8},
                              {"baumgarte", "dop853", "", 1e-5, 1e-11, 1e-8},
                              {"momentum-index2", "ida", "leak:3", 1e-4, 1e-9, 1e-4},
                              {"momentum-index2", "radau5", "reset", 1e-4, 1e-9, 1e-4},
                              {"acceleration-index2", "ida", "", 1e-4, 1e-9, 1e-4},
                              {"stabilised-index2", "ida", "", 1e-4, 1e-9, 1e-4}};
  for (const std::string name :
       {"four_bar/scene.toml", "spatial_slider_crank/scene.toml", "driven/scene.toml"}) {
    const Mechanism mechanism(example(name));
    const double end = 0.4;
    const OwnReference own = reference_of(mechanism, end, 4);
    const bool driven = name[0] == 'd';
    for (const Way& way : ways) {
      const RunResult loose = run_by(mechanism, own.reference, way.form, way.integrator, way.gauge,
                                     way.loose, end),
                      tight = run_by(mechanism, own.reference, way.form, way.integrator, way.gauge,
                                     way.tight, end);
      const std::map<std::string, double RunResult::*> errors{
          {"p", &RunResult::momentum_error_max},
          {"impulse", &RunResult::impulse_error_max},
          {"reaction", &RunResult::reaction_error_max},
          {"effort", &RunResult::effort_error_max},
          {"work", &RunResult::work_error_max}};
      for (const auto& [what, error] : errors) {
        const std::string where = name + " " + way.form + " " + way.gauge + ": " + what;
        if (!driven && (what == "effort" || what == "work")) {
          EXPECT_TRUE(std::isnan(tight.*error)) << where;
          continue;
        }
        EXPECT_LT(tight.*error, way.bound) << where;
        EXPECT_LT(tight.*error, 0.1 * (loose.*error)) << where;
        EXPECT_GT(loose.*error, 1e-13) << where;
      }
      // By joint: the largest of them is the error of reactions, and all are unique.
      double largest = 0;
      for (const auto& joint : tight.reaction_errors) {
        largest = equations::larger(largest, joint.error_max);
        EXPECT_EQ(joint.not_unique, 0) << joint.joint;
      }
      EXPECT_EQ(largest, tight.reaction_error_max) << name << " " << way.form;
    }
  }
}

/// Where loops leave reactions open no column of the reference has them, and a run tells of each
/// such joint, by its name, at how many times; p has an error there as elsewhere.
TEST(ErrorsOfForces, JointsWhoseReactionsAreOpenAreTold) {
  for (const std::string name : {"bricard/scene.toml", "extremes/three_cranks.toml"}) {
    const Mechanism mechanism(example(name));
    const OwnReference own = reference_of(mechanism, 0.2, 4);
    for (const std::string& c : own.reference.columns()) {
      EXPECT_EQ(c.find(".force_"), std::string::npos) << c;
      EXPECT_EQ(c.find(".impulse"), std::string::npos) << c;
    }
    const RunResult run =
        run_by(mechanism, own.reference, "momentum", "dop853", "reset", 1e-9, 0.2);
    EXPECT_LT(run.momentum_error_max, 1e-6) << name;
    EXPECT_TRUE(std::isnan(run.reaction_error_max)) << name;
    EXPECT_TRUE(std::isnan(run.impulse_error_max)) << name;
    EXPECT_EQ(run.reaction_errors.size(), joint_places(mechanism).size()) << name;
    for (const auto& joint : run.reaction_errors) {
      EXPECT_TRUE(std::isnan(joint.error_max)) << name << " " << joint.joint;
      EXPECT_EQ(joint.not_unique, 5) << name << " " << joint.joint;
    }
  }
}

/// Columns that the reference alone has do not get into the trajectory.
TEST(ErrorsOfForces, TheTrajectoryKeepsItsColumns) {
  const Mechanism mechanism(example("driven/scene.toml"));
  const OwnReference own = reference_of(mechanism, 0.2, 2);
  RunRequest request =
      equations::kept(equations::adaptive("momentum", "dop853", "reset", 1e-8, 0.2, 2));
  const RunResult without = run_form(mechanism, assemble(mechanism).start, request);
  request.reference = &own.reference;
  const RunResult with = run_form(mechanism, assemble(mechanism).start, request);
  EXPECT_EQ(with.trajectory.columns, trajectory_columns(mechanism));
  EXPECT_EQ(with.trajectory.rows, without.trajectory.rows);
  EXPECT_FALSE(std::isnan(with.reaction_error_max));
}

/// A run that goes on from a checkpoint has the errors of one that was not put down.
TEST(ErrorsOfForces, GoOnFromACheckpoint) {
  const Mechanism mechanism(example("four_bar/scene.toml"));
  const OwnReference own = reference_of(mechanism, 0.4, 8);
  for (const char* gauge : {"none", "reset", "leak:3"}) {
    RunRequest request = equations::adaptive("momentum", "dop853", gauge, 1e-6, 0.4, 8);
    request.reference = &own.reference;
    std::vector<Checkpoint> kept;
    request.between_steps = [&](const std::function<Checkpoint()>& make) {
      kept.push_back(make());
    };
    const RunResult whole = run_form(mechanism, assemble(mechanism).start, request);
    ASSERT_GE(kept.size(), 3u);
    request.between_steps = {};
    request.from = &kept[kept.size() / 2];
    const RunResult rest = run_form(mechanism, assemble(mechanism).start, request);
    EXPECT_GT(whole.impulse_error_max, 0) << gauge;
    EXPECT_NEAR(rest.impulse_error_max, whole.impulse_error_max, 1e-14) << gauge;
    EXPECT_EQ(rest.momentum_error_max, whole.momentum_error_max) << gauge;
    ASSERT_EQ(rest.reaction_errors.size(), whole.reaction_errors.size());
    for (std::size_t i = 0; i < rest.reaction_errors.size(); ++i)
      EXPECT_EQ(rest.reaction_errors[i].error_max, whole.reaction_errors[i].error_max) << gauge;
  }
}

}  // namespace
}  // namespace momenta::dae_errors_of_forces
