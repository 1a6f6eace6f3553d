// User joints in closed loops are the built-in joints of their poses: the same numbers at one state
// by sweeps and by matrices, the same runs in every form, the same derivatives; a pin on a curve,
// whose E hangs on q, against slides that equations hold on it.

#include <gtest/gtest.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/quad_motion.h>

#include "equations/ensemble.h"
#include "equations/exact_jacobian.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"
#include "equations/user_loops.h"

namespace momenta::dae_user_joints {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr auto as_written = CutChoice::scene;

/// What a chain answers at a state off its loops, σ and λ as the forces they are.
struct Answers {
  VectorXd p, qdot, pdot, leaked, u, sigma, udot, lambda, phi, phidot, corrected, back;
  MatrixXd mass, jacobian;
  Eigen::Vector3d energies;
  std::map<std::string, Eigen::Vector3d> forces;

  Answers(ClosedChain& chain, double t, const VectorXd& q, const VectorXd& rates) {
    for (VectorXd* x : {&p, &pdot, &leaked, &u, &sigma, &udot, &lambda, &back})
      x->resize(chain.nv());
    qdot.resize(chain.nq());
    phi.resize(chain.m()), phidot.resize(chain.m());
    VectorXd s(chain.m());
    chain.momenta(t, q, rates, p);
    EXPECT_TRUE(chain.rates(t, q, p, qdot, pdot)) << chain.failure();
    EXPECT_TRUE(chain.rates(t, q, p, qdot, leaked, 1.7)) << chain.failure();
    jacobian = chain.jacobian(t, q);
    mass = chain.mass_matrix(t, q);
    EXPECT_TRUE(chain.velocities(t, q, p, u, s)) << chain.failure();
    sigma = jacobian.transpose() * s;
    EXPECT_TRUE(chain.accelerations(t, q, rates, udot, s)) << chain.failure();
    lambda = jacobian.transpose() * s;
    chain.joint_forces(t, q, rates, udot, s, back);
    chain.constraints(t, q, rates, phi, phidot);
    const Energies e = chain.energies(t, q, rates);
    energies << e.kinetic, e.potential, e.hamiltonian;
    for (const auto& r : chain.reactions(t, q, rates).joints) forces[r.name] = r.force;
    VectorXd near = q, rate = rates;
    EXPECT_TRUE(chain.correct(t, near, rate)) << chain.failure();
    corrected.resize(near.size() + rate.size());
    corrected << near, rate;
  }
};

void expect_same(const Answers& x, const Answers& y, const std::string& what) {
  constexpr double tol = 1e-11;
  const auto close = [&](const auto& a, const auto& b, const char* name) {
    EXPECT_LE(relative_error(a, b), tol) << what << ": " << name;
  };
  close(x.p, y.p, "p");
  close(x.qdot, y.qdot, "q'");
  close(x.pdot, y.pdot, "p'");
  close(x.leaked, y.leaked, "p' with a leak");
  close(x.u, y.u, "u");
  close(x.sigma, y.sigma, "sigma");
  close(x.udot, y.udot, "u'");
  close(x.lambda, y.lambda, "lambda");
  close(x.back, VectorXd::Zero(x.back.size()), "forces of the accelerations");
  close(x.phi, y.phi, "phi");
  close(x.phidot, y.phidot, "phi'");
  close(x.corrected, y.corrected, "corrected");
  close(x.mass, y.mass, "M");
  close(x.jacobian, y.jacobian, "phi_q");
  close(x.energies, y.energies, "energies");
  for (const auto& [joint, force] : x.forces) {
    const auto other = y.forces.find(joint);
    ASSERT_NE(other, y.forces.end()) << joint;
    EXPECT_LE(relative_error(force, other->second, 10.0), tol) << what << ": at " << joint;
  }
}

/// States near the start, off the loops.
template <class F>
void at_states(const Mechanism& mechanism, F&& f) {
  const Start start = assemble(mechanism).start;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const State off(mechanism.nv(), seed);
    f(0.1 * seed, VectorXd(start.q + 0.05 * off.q), VectorXd(start.u + off.u));
  }
}

TEST(UserJointsInLoops, AnswerAsBuiltInJointsDo) {
  for (const Pair& pair : pairs()) {
    ClosedChain reference(pair.built_in, {.algebra = Algebra::spatial});
    ASSERT_EQ(reference.mechanism().solver().kkt(), KktChoice::sweeps);
    for (const KktChoice kkt : {KktChoice::sweeps, KktChoice::sparse, KktChoice::dense}) {
      ClosedChain chain(pair.user, {.kkt = kkt});
      ASSERT_EQ(chain.nv(), reference.nv());
      ASSERT_EQ(chain.mechanism().solver().kkt(), kkt);
      at_states(reference.mechanism(), [&](double t, const VectorXd& q, const VectorXd& u) {
        const Answers x(chain, t, q, u), y(reference, t, q, u);
        expect_same(x, y, pair.name + " by " + name_of(kkt));
      });
    }
  }
}

TEST(UserJointsInLoops, StatesSideBySideAreThoseOneByOne) {
  for (const Pair& pair : pairs()) {
    ClosedChain chain(pair.user);
    const int count = 11, n = chain.nv();
    StateMatrix q(n, count), p(n, count), u(n, count), qdot(n, count), pdot(n, count),
        udot(n, count), lambda(chain.m(), count);
    const Start start = chain.assemble().start;
    VectorXd one(n), two(n), multipliers(chain.m());
    for (int i = 0; i < count; ++i) {
      const State off(n, 50 + static_cast<unsigned>(i));
      q.col(i) = start.q + 0.05 * off.q;
      u.col(i) = start.u + off.u;
      chain.momenta(0.3, q.col(i), u.col(i), one);
      p.col(i) = one;
    }
    ASSERT_TRUE(chain.rates_of_states(0.3, q, p, qdot, pdot)) << chain.failure();
    ASSERT_TRUE(chain.accelerations_of_states(0.3, q, u, udot, lambda)) << chain.failure();
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(chain.rates(0.3, q.col(i), p.col(i), one, two));
      EXPECT_LE(relative_error(qdot.col(i), one), 1e-12) << pair.name;
      EXPECT_LE(relative_error(pdot.col(i), two), 1e-12) << pair.name;
      ASSERT_TRUE(chain.accelerations(0.3, q.col(i), u.col(i), one, multipliers));
      EXPECT_LE(relative_error(udot.col(i), one), 1e-12) << pair.name;
      EXPECT_LE(relative_error(lambda.col(i), multipliers), 1e-12) << pair.name;
    }
  }
}

/// All sixteen but the one that takes user joints of one coordinate alone.
std::vector<std::string> forms_of(const Scene& scene) {
  std::vector<std::string> forms;
  for (const std::string& form : form_names()) {
    const bool one = std::all_of(scene.joints.begin(), scene.joints.end(), [](const JointSpec& j) {
      return j.kind != JointKind::user || j.law->coordinates() == 1;
    });
    if (one || form != "maximal-coordinates") forms.push_back(form);
  }
  return forms;
}
std::vector<std::string> integrators_of(const std::string& form) {
  if (is_dae_form(form)) return {"ida", "radau5"};
  return {"dop853"};
}

TEST(UserJointsInLoops, RunsAreThoseOfBuiltInJoints) {
  for (const Pair& pair : pairs()) {
    if (pair.name == "prismatic") continue;  // "all" has it
    const Mechanism mine(pair.user, {.cut = as_written}),
        theirs(pair.built_in, {.algebra = Algebra::spatial, .cut = as_written});
    for (const std::string& form : forms_of(pair.user))
      for (const std::string& integrator : integrators_of(form)) {
        const std::string what = pair.name + " " + form + " " + integrator;
        const RunResult x = run_of(mine, form, integrator, "", 1e-9, 0.4),
                        y = run_of(theirs, form, integrator, "", 1e-9, 0.4);
        ASSERT_EQ(x.status, "done") << what << ": " << x.reason;
        ASSERT_EQ(y.status, "done") << what << ": " << y.reason;
        ASSERT_EQ(x.trajectory.rows.size(), y.trajectory.rows.size());
        // Steps are chosen by numbers that differ by rounding: solutions differ by a part of
        // their error.
        for (std::size_t i = 0; i < x.trajectory.rows.size(); ++i)
          for (std::size_t k = 1; k <= static_cast<std::size_t>(mine.nq()); ++k)
            EXPECT_NEAR(x.trajectory.rows[i][k], y.trajectory.rows[i][k],
                        form.find("index3") == std::string::npos ? 1e-7 : 1e-5)
                << what;
        // So drifts and energies are of one order of magnitude, above the tolerance.
        const auto level = [&](double a, double b) {
          const double share = form.find("index3") == std::string::npos ? 10 : 100;
          EXPECT_LE(a, share * b + 1e-9) << what;
          EXPECT_LE(b, share * a + 1e-9) << what;
        };
        level(x.position_drift_max, y.position_drift_max);
        level(x.velocity_drift_max, y.velocity_drift_max);
        level(x.energy_error_max, y.energy_error_max);
      }
  }
}

TEST(UserJointsInLoops, OneStepOfFixedSizeIsTheSameToRounding) {
  for (const Pair& pair : pairs()) {
    const Mechanism mine(pair.user, {.cut = as_written}),
        theirs(pair.built_in, {.algebra = Algebra::spatial, .cut = as_written});
    for (const std::string& form : forms_of(pair.user)) {
      if (is_dae_form(form)) continue;
      RunRequest request = equations::kept(equations::stepped(form, "rk4", "none", 0.005, 0.4, 8));
      const RunResult x = run_form(mine, assemble(mine).start, request),
                      y = run_form(theirs, assemble(theirs).start, request);
      ASSERT_EQ(x.status, "done") << x.reason;
      for (std::size_t i = 0; i < x.trajectory.rows.size(); ++i)
        for (std::size_t k = 1; k <= static_cast<std::size_t>(mine.nq()); ++k)
          EXPECT_NEAR(x.trajectory.rows[i][k], y.trajectory.rows[i][k], 1e-10)
              << pair.name << " " << form;
    }
  }
}

TEST(UserJointsInLoops, PinOnACurve) {
  const Mechanism mine(slider_on_user_curve(), {.cut = as_written}),
      theirs(slider_on_curve(), {.cut = as_written});
  ASSERT_EQ(mine.solver().kkt(), KktChoice::sweeps);
  ASSERT_EQ(mine.m(), 3);
  ASSERT_EQ(theirs.m(), 6);
  // The marker's column, which both have.
  const auto column = [](const Mechanism& m) {
    const auto all = trajectory_columns(m);
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), "B.x [m]") - all.begin());
  };
  const std::size_t at = column(mine), there = column(theirs);
  const RunResult reference = run_of(theirs, "momentum", "dop853", "leak", 1e-12, 0.6);
  ASSERT_EQ(reference.status, "done") << reference.reason;
  for (const std::string& form : form_names())
    for (const std::string& integrator : integrators_of(form)) {
      const RunResult run = run_of(mine, form, integrator, "", 1e-9, 0.6);
      const std::string what = form + " " + integrator;
      ASSERT_EQ(run.status, "done") << what << ": " << run.reason;
      for (std::size_t i = 0; i < run.trajectory.rows.size(); ++i)
        for (std::size_t k = 0; k < 6; ++k)
          EXPECT_NEAR(run.trajectory.rows[i][at + k], reference.trajectory.rows[i][there + k],
                      form.find("index3") == std::string::npos ? 2e-6 : 2e-3)
              << what;
      EXPECT_LT(run.position_drift_max, 1e-6) << what;
      EXPECT_LT(run.energy_error_max, 1e-4) << what;
    }
}

TEST(UserJointsInLoops, NewtonMatricesAreExact) {
  std::vector<Scene> scenes{slider_on_user_curve()};
  for (const Pair& pair : pairs()) scenes.push_back(pair.user);
  for (const Scene& scene : scenes) {
    const Mechanism mechanism(scene);
    const Start start = assemble(mechanism).start;
    for (const std::string& form : form_names()) {
      if (!is_dae_form(form)) continue;
      const auto made = make_form(form, mechanism, {}, start);
      auto& dae = dynamic_cast<DaeForm&>(*made);
      std::vector<double> y(static_cast<std::size_t>(dae.size())), ydot(y.size());
      ASSERT_TRUE(dae.start(start.t, y.data(), ydot.data()));
      expect_exact_jacobian(dae, 0.2, y, ydot, form);
    }
  }
}

TEST(UserJointsInLoops, SmallMotionsAndSeries) {
  for (const Pair& pair : pairs()) {
    const Mechanism mine(pair.user), theirs(pair.built_in, {.algebra = Algebra::spatial});
    const int n = mine.nv();
    const MatrixXd X = MatrixXd::Identity(n, n);
    at_states(theirs, [&](double t, const VectorXd& q, const VectorXd& u) {
      const State more(n + mine.m(), 7);
      const VectorXd udot = more.u.head(n), lambda = more.q.head(mine.m());
      const StateLinearisation x = linearise_state(mine, t, q, u, udot, lambda, X),
                               y = linearise_state(theirs, t, q, u, udot, lambda, X);
      EXPECT_LE(relative_error(x.M, y.M), 1e-12) << pair.name;
      EXPECT_LE(relative_error(x.C, y.C), 1e-12) << pair.name;
      EXPECT_LE(relative_error(x.K, y.K), 1e-12) << pair.name;
      EXPECT_LE(relative_error(x.loops, y.loops), 1e-12) << pair.name;
      EXPECT_LE(relative_error(x.second_by_rates, y.second_by_rates), 1e-12) << pair.name;
      EXPECT_LE(relative_error(x.second_by_poses, y.second_by_poses), 1e-12) << pair.name;

      // Along a curve through the state, with two directions from it.
      const auto a = mine.evaluation<Jet>(), b = theirs.evaluation<Jet>();
      const auto size = static_cast<std::size_t>(n);
      std::vector<Jet> place(size), rates(size), forces(size), other(size),
          rows(static_cast<std::size_t>(mine.m())), other_rows(rows.size());
      for (std::size_t i = 0; i < size; ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        for (std::size_t c = 0; c < jet_order + 1; ++c) {
          place[i].a.c[c] = c == 0 ? q[k] : std::sin(1.0 + 3.1 * static_cast<double>(c + i));
          rates[i].a.c[c] = c == 0 ? u[k] : std::cos(2.0 + 1.7 * static_cast<double>(c + 2 * i));
          place[i].b[0].c[c] = std::sin(static_cast<double>(2 * c + i));
          rates[i].b[1].c[c] = std::cos(static_cast<double>(c + 3 * i));
        }
      }
      const auto take = [&](EquationRows<Jet>& e, std::vector<Jet>& tau, std::vector<Jet>& phi) {
        e.place(t, place.data());
        e.move(rates.data());
        e.joint_forces(place.data(), rates.data(), nullptr, nullptr, tau.data());
        e.accelerations(phi.data());
        std::vector<Jet> p(size), pdot(size), back(size);
        e.momenta(nullptr, p.data());
        e.momentum_rates(place.data(), rates.data(), nullptr, 0, pdot.data());
        e.joint_rates(place.data(), rates.data(), back.data());
        for (std::size_t i = 0; i < size; ++i) tau[i] += 3.0 * p[i] + 2.0 * pdot[i] + back[i];
      };
      take(*a, forces, rows);
      take(*b, other, other_rows);
      const auto compare = [&](const Jet& one, const Jet& two) {
        for (std::size_t c = 0; c < jet_order + 1; ++c) {
          const double size_of = 1e-11 * (100 + std::abs(two.a.c[c]));
          EXPECT_NEAR(one.a.c[c], two.a.c[c], size_of) << pair.name << " " << c;
          for (std::size_t d = 0; d < 2; ++d)
            EXPECT_NEAR(one.b[d].c[c], two.b[d].c[c], 1e-11 * (1000 + std::abs(two.b[d].c[c])))
                << pair.name << " " << c;
        }
      };
      for (std::size_t i = 0; i < size; ++i) compare(forces[i], other[i]);
      for (std::size_t i = 0; i < rows.size(); ++i) compare(rows[i], other_rows[i]);
    });
  }
}

TEST(UserJointsInLoops, Units) {
  const Mechanism mine(pairs()[4].user), theirs(pairs()[4].built_in, {.algebra = Algebra::spatial});
  const auto same = [](const std::vector<Column>& a, const std::vector<Column>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].label(), b[i].label());
  };
  same(mine.coordinate_columns(), theirs.coordinate_columns());
  same(mine.rate_columns(), theirs.rate_columns());
}

TEST(UserJointsInLoops, WhatIsRefused) {
  const Mechanism two(pairs()[1].user);
  EXPECT_EQ(
      equations::thrown([&] { make_form("maximal-coordinates", two, {}, assemble(two).start); }),
      "maximal coordinates take user joints of one coordinate, but joint 'U' has 2; expected "
      "another form");
  EXPECT_EQ(
      equations::thrown([&] { make_quad_motion(two); }),
      "joint 'U' is a user joint, whose formula has no values in quadruple precision; expected "
      "a reference from a file");
}

}  // namespace
}  // namespace momenta::dae_user_joints
