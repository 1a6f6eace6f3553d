// Couplers with powers of a coordinate: Φ against its polynomial, Φ_q, Φ̇, Φ̈ and the impulses'
// rates against differences along the motion, in a plane and in space; forms agree; limits.

#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

namespace momenta::dae_powers {
namespace {

using Eigen::VectorXd;

Scene coupled() {
  return parse_scene(R"(
gravity = [0, -9.81, 0]
[[body]]
name = "a"
mass = 1
com = [0.5, 0, 0]
inertia = 0.1
[[body]]
name = "b"
mass = 2
com = [0.3, 0.1, 0]
inertia = 0.2
[[body]]
name = "c"
mass = 1
inertia = 0.1
[[joint]]
name = "A"
kind = "revolute"
child = "a"
position = 0.2
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
[[joint]]
name = "C"
kind = "prismatic"
child = "c"
axis = "y"
[[loop]]
name = "K"
kind = "coupler"
joints = ["B", "C", "A"]
ratios = [1, -0.5, -1.2]
powers = [0.7, -0.4, 0.3]
offset = 0.1
)",
                     "coupled.toml");
}

double polynomial(const VectorXd& q) {
  const double a = q[0];
  return q[1] - 0.5 * q[2] - 1.2 * a + 0.7 * a * a - 0.4 * a * a * a + 0.3 * a * a * a * a - 0.1;
}

TEST(Powers, RowsAgainstTheirPolynomial) {
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    const Mechanism mechanism(coupled(), {.algebra = algebra});
    EXPECT_NE(mechanism.solver().kkt(), KktChoice::sweeps);
    const auto e = mechanism.evaluation<double>();
    equations::RandomTree random(1);
    constexpr double h = 1e-5;
    for (int i = 0; i < 20; ++i) {
      VectorXd q(3), u(3), udot(3);
      for (VectorXd* x : {&q, &u, &udot})
        for (double& value : *x) value = random.uniform(-1, 1);
      const double sigma = random.uniform(-2, 2);
      const auto phi_at = [&](double t) { return polynomial(q + t * u + 0.5 * t * t * udot); };
      double phi, rate, second;
      VectorXd with(3), without(3), unused(3), force(3), later(3), sooner(3);
      e->place(0, q.data());
      e->positions(&phi);
      EXPECT_NEAR(phi, polynomial(q), 1e-14);
      e->constraint_forces(&sigma, force.data());
      for (int k = 0; k < 3; ++k) {
        VectorXd step = VectorXd::Zero(3);
        step[k] = h;
        EXPECT_NEAR(force[k] / sigma, (polynomial(q + step) - polynomial(q - step)) / (2 * h),
                    1e-8);
      }
      e->move(u.data());
      e->velocities(&rate);
      EXPECT_NEAR(rate, (phi_at(h) - phi_at(-h)) / (2 * h), 1e-8);
      e->momenta(&sigma, with.data());
      e->momentum_rates(q.data(), u.data(), &sigma, 0, with.data());
      e->momenta(nullptr, without.data());
      e->momentum_rates(q.data(), u.data(), nullptr, 0, without.data());
      e->joint_forces(q.data(), u.data(), udot.data(), nullptr, unused.data());
      e->accelerations(&second);
      const double wide = 1e-3;
      EXPECT_NEAR(second, (phi_at(wide) - 2 * phi_at(0) + phi_at(-wide)) / (wide * wide), 1e-4);
      e->place(0, VectorXd(q + h * u).data());
      e->constraint_forces(&sigma, later.data());
      e->place(0, VectorXd(q - h * u).data());
      e->constraint_forces(&sigma, sooner.data());
      EXPECT_LE((with - without - (later - sooner) / (2 * h)).norm(), 1e-8);
    }
  }
}

TEST(Powers, FormsAgree) {
  const Mechanism mechanism(coupled());
  const Start start = assemble(mechanism).start;
  VectorXd first;
  for (const char* form : {"momentum", "acceleration", "projected", "stabilised-index2",
                           "momentum-index2", "augmented-lagrangian"}) {
    SCOPED_TRACE(form);
    RunRequest request;
    request.settings.form = form;
    if (std::string(form).ends_with("index2")) request.settings.integrator = "ida";
    request.settings.rtol = 1e-10;
    request.settings.end_time = 1;
    request.settings.samples = 10;
    request.keep_trajectory = true;
    const RunResult run = run_form(mechanism, start, request);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_LT(run.energy_error_max, 1e-5);
    const VectorXd q = Eigen::Map<const VectorXd>(run.trajectory.rows.back().data() + 1, 3);
    EXPECT_NEAR(polynomial(q), 0, 1e-6);
    if (first.size() == 0) first = q;
    EXPECT_LE((q - first).norm(), 1e-5);
  }
}

/// Bushings, coordinate springs and friction in closed loops: energies with what dampers take.
TEST(Powers, ForcesOfAllKindsBalance) {
  Scene scene = coupled();
  scene.joints[1].friction = 0.5;
  ForceSpec bushing;
  bushing.kind = "bushing";
  bushing.child = "b";
  bushing.stiffness = 3;
  bushing.damping = 0.4;
  bushing.rotational_damping = 0.2;
  ForceSpec spring;
  spring.kind = "coordinate-spring";
  spring.joints = {"A", "C"};
  spring.ratios = {1, -2};
  spring.stiffness = 5;
  spring.damping = 0.3;
  scene.forces = {bushing, spring};
  for (const bool powers : {true, false}) {
    if (!powers) scene.loops[0].powers.clear();  // carried by the sweeps
    VectorXd first;
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      const Mechanism mechanism(scene, {.algebra = algebra});
      EXPECT_EQ(mechanism.solver().kkt() == KktChoice::sweeps, !powers);
      const Start start = assemble(mechanism).start;
      for (const char* form : {"momentum", "projected", "stabilised-index2", "momentum-index2"}) {
        SCOPED_TRACE(form);
        RunRequest request;
        request.settings.form = form;
        if (std::string(form).ends_with("index2")) request.settings.integrator = "ida";
        request.settings.rtol = 1e-10;
        request.settings.end_time = 1;
        request.settings.samples = 10;
        request.keep_trajectory = true;
        const RunResult run = run_form(mechanism, start, request);
        ASSERT_EQ(run.status, "done") << run.reason;
        EXPECT_LT(run.energy_error_max, 1e-5);
        const VectorXd q = Eigen::Map<const VectorXd>(run.trajectory.rows.back().data() + 1, 3);
        if (first.size() == 0) first = q;
        EXPECT_LE((q - first).norm(), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace momenta::dae_powers
