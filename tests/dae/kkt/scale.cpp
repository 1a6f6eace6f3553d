// What a mechanism of twenty thousand bodies must do: assemble, with the right rank, and solve (7)
// to rounding; and what it holds in memory doubles when its bodies do.

#include "equations/ensemble.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <momenta/core/expression/functions_quad.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <cmath>

#include <memory>

namespace momenta::dae_scale {
namespace {

using namespace equations;
using Eigen::VectorXd;

struct Large {
  const char* name;
  Scene (*make)(int bodies);
  int mobility(int bodies) const { return name == std::string("arch") ? bodies - 2 : 1; }
};
const Large all[] = {
    {"row", [](int bodies) { return row_of_four_bars(bodies / 2, 1.1, 1); }},
    {"ladder", [](int bodies) { return crossed_bars(bodies / 2); }},
    {"arch", [](int bodies) { return arch(bodies); }},
};

class Scale : public testing::TestWithParam<Large> {};

TEST_P(Scale, TwentyThousandBodiesAssembleAndMove) {
  const Mechanism mechanism(GetParam().make(20000));
  const Assembly a = assemble(mechanism);
  EXPECT_EQ(a.rank, mechanism.m());
  // A ladder held at one pin turns and opens: one more.
  const int more = GetParam().name == std::string("ladder") ? 1 : 0;
  EXPECT_EQ(a.mobility,
            GetParam().mobility(static_cast<int>(mechanism.tree().bodies.size())) + more);
  EXPECT_LT(a.moved, 1e-6);

  const auto e = mechanism.evaluation<double>();
  const auto solver = make_loop_solver(mechanism, *e);
  const VectorXd& q = a.start.q;
  VectorXd p(mechanism.nv()), u(mechanism.nv()), back(mechanism.nv()), pdot(mechanism.nv()),
      sigma(mechanism.m()), rate(mechanism.m());
  // What starts at rest is pushed, as its loops do not allow.
  VectorXd wanted = a.start.u;
  if (wanted.isZero(0))
    for (Eigen::Index i = 0; i < wanted.size(); ++i) wanted[i] = std::sin(static_cast<double>(i));
  e->place(0, q.data());
  e->move(wanted.data());
  e->momenta(nullptr, p.data());
  const double size = p.cwiseAbs().maxCoeff();
  ASSERT_TRUE(solver->momentum(0, q.data(), p.data(), nullptr, fade_evaluation, 0, u.data(),
                               sigma.data(), pdot.data()));
  EXPECT_TRUE(pdot.allFinite());
  e->place(0, q.data());
  e->move(u.data());
  e->momenta(sigma.data(), back.data());
  EXPECT_LT((back - p).cwiseAbs().maxCoeff(), 1e-9 * size);
  e->velocities(rate.data());
  EXPECT_LT(rate.cwiseAbs().maxCoeff(), 1e-9 * (1 + u.cwiseAbs().maxCoeff()));
}

std::size_t held() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST_P(Scale, MemoryGrowsLikeTheBodies) {
  const auto bytes = [&](int bodies) {
    const std::size_t before = held();
    const auto mechanism = std::make_unique<Mechanism>(GetParam().make(bodies));
    const auto e = mechanism->evaluation<double>();
    const auto solver = make_loop_solver(*mechanism, *e);
    assemble(*mechanism);  // patterns are kept
    return static_cast<double>(held()) - static_cast<double>(before);
  };
  const double one = bytes(4000), two = bytes(8000);
  if (!(one > 0)) GTEST_SKIP() << "another heap";
  EXPECT_LT(two, 2.2 * one);
  EXPECT_LT(two, 20e3 * 8000);
}

/// Kilometres from the ground Φ is right to the rounding of its own loop, four bars of 2 m: not to
/// that of the places, which is a hundred times as much.
TEST(FarLoops, AreRightToTheirOwnRounding) {
  for (const bool planar : {true, false}) {
    Scene scene = crossed_bars(1500);
    if (!planar) {
      // One joint about another axis makes the scene spatial.
      scene.bodies.push_back(rod("aside", 0.1));
      scene.joints.push_back(hinge("aside", "ground", "aside", {0, 0, 0}, 0.3));
      scene.joints.back().axis = {1, 0, 0};
    }
    const Mechanism mechanism(scene);
    ASSERT_EQ(mechanism.plan().planar, planar);
    const auto e = mechanism.evaluation<double>();
    const auto true_e = mechanism.evaluation<Quad>();
    VectorXd q = mechanism.tree().q0, phi(mechanism.m());
    // Another pose, nearly closed, with digits of all sizes in it.
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += 1e-7 * std::sin(static_cast<double>(i));
    std::vector<Quad> true_q(q.begin(), q.end()), true_phi(static_cast<std::size_t>(phi.size()));
    e->place(0, q.data());
    e->positions(phi.data());
    true_e->place(0, true_q.data());
    true_e->positions(true_phi.data());
    double worst = 0, apart = 0;
    for (Eigen::Index i = 0; i < phi.size(); ++i) {
      const double exact = value_of(true_phi[static_cast<std::size_t>(i)]);
      worst = equations::larger(worst, std::abs(phi[i] - exact));
      apart = equations::larger(apart, std::abs(exact));
    }
    EXPECT_LT(worst, 2 * algebra_tol(4)) << (planar ? "plane" : "space");
    EXPECT_GT(apart, 1e-8);
  }
}

/// IDA's first steps on a ladder of four thousand bars. Φ is rounded like its loops, not like the
/// ladder: with what rounding leaves of places 3 km away, answered by impulses, no correction of p
/// at the tip is below the tolerance, however short the step.
TEST(LongLadder, ImplicitFormsStart) {
  const Mechanism mechanism(crossed_bars(2000));
  const Start start = equations::start_of(mechanism);
  for (const char* name : {"momentum-index2", "acceleration-index2", "stabilised-index2"}) {
    FormOptions options;
    if (takes_gauge(name)) options.gauge = {Gauge::Kind::leak, 1.7};
    const auto form = make_form(name, mechanism, options, start);
    IntegrationOptions tolerance;
    tolerance.rtol = tolerance.atol = 1e-8;
    const auto run = integrate_ida(*form->dae(), start.t, {1e-3}, tolerance, {});
    EXPECT_TRUE(run.done) << name << ": " << run.reason;
    EXPECT_LT(run.counters.steps, 100) << name;
    EXPECT_LT(run.counters.rejected, 5) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Families, Scale, testing::ValuesIn(all),
                         [](const auto& family) { return std::string(family.param.name); });

}  // namespace
}  // namespace momenta::dae_scale
