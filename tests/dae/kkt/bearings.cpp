// Friction of bearings by the joints' own reactions: accelerations known in closed form; a slow
// twin in maximal coordinates; forms, algebras and cuts agree; energy balances; forces that are not
// unique, and friction without a value, are refused.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/planar_pins.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/mechanism/bearings.h>
#include <momenta/dae/run/run_form.h>

namespace momenta::dae_bearings {
namespace {

using namespace equations;
using Eigen::VectorXd;

BearingSpec bearing(double still, double moving, double radius, double length = 0) {
  BearingSpec b;
  b.static_friction = still;
  b.dynamic_friction = moving;
  b.transition_velocity = 0.02;
  b.radius = radius;
  b.length = length;
  return b;
}

Scene four_bar() {
  Scene scene = equations::example("four_bar");
  scene.joints[0].bearing = bearing(0.3, 0.2, 0.05);
  scene.joints[1].bearing = bearing(0.2, 0.2, 0.04);
  scene.joints[2].bearing = bearing(0.25, 0.1, 0.06);
  return scene;
}

/// A block of 2 kg on a slide, at `rate`, its centre of mass `above` the slide, pushed by 30 N
/// `high` above it.
Scene block(double slope, double rate, const BearingSpec& b, double push = 0, double above = 0,
            double high = 0) {
  Scene scene;
  scene.gravity = {0, -9.81, 0};
  BodySpec body;
  body.name = "block";
  body.mass = 2;
  body.inertia.diagonal() << 0.1, 0.1, 0.2;
  body.com = {0, above, 0};
  scene.bodies = {body};
  JointSpec joint = equations::make_joint(JointKind::prismatic, "S", "ground", "block", {0, 0, 0},
                                          Eigen::Vector3d::UnitX());
  joint.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(-slope, Eigen::Vector3d::UnitZ()));
  joint.velocity = {rate};
  joint.bearing = b;
  scene.joints = {joint};
  if (push != 0) {
    ForceSpec force;
    force.kind = "wrench";
    force.body = "block";
    force.point = {0, high, 0};
    force.force = {push, 0, 0};
    force.in_body_axes = true;
    scene.forces = {force};
  }
  return scene;
}

double acceleration_of(const Scene& scene, Algebra algebra) {
  const Mechanism mechanism(scene, {.algebra = algebra});
  return assemble(mechanism).start.udot[0];
}

std::string refusal_of(const Scene& scene) {
  return equations::thrown<SceneError>([&] {
    const Mechanism mechanism(scene);
    assemble(mechanism);
  });
}

TEST(Bearings, CoefficientHasItsSlopeItsPeakAndItsSign) {
  const BearingSpec b = bearing(0.5, 0.2, 1);
  const double vt = b.transition_velocity;
  EXPECT_NEAR(friction_coefficient(b, vt), 0.2 * std::tanh(4.0) + 0.3, 1e-15);
  EXPECT_NEAR(friction_coefficient(b, 1e3 * vt), 0.2, 1e-6);
  EXPECT_EQ(friction_coefficient(b, 0.0), 0);
  double largest = 0;
  for (int i = 1; i < 4000; ++i) {
    const double v = 0.005 * i * vt;
    EXPECT_EQ(friction_coefficient(b, -v), -friction_coefficient(b, v));
    EXPECT_GT(friction_coefficient(b, v), 0);
    largest = equations::larger(largest, friction_coefficient(b, v));
  }
  EXPECT_NEAR(largest, 0.5, 1e-3);
  // Without a peak it grows with v.
  const BearingSpec plain = bearing(0.2, 0.2, 1);
  for (int i = 1; i < 500; ++i)
    EXPECT_GE(friction_coefficient(plain, 0.01 * (i + 1) * vt),
              friction_coefficient(plain, 0.01 * i * vt));
}

TEST(Bearings, BlockOnASlopeAcceleratesByGravityLessFriction) {
  constexpr double mu = 0.3, slope = 0.6;
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial})
    for (const double rate : {2.0, -2.0}) {
      const double a = 9.81 * (std::sin(slope) - (rate > 0 ? mu : -mu) * std::cos(slope));
      EXPECT_NEAR(acceleration_of(block(slope, rate, bearing(mu, mu, 0)), algebra), a, 1e-14 * 20);
    }
  // Down the slope it stays fast, so that its way is that of a constant acceleration.
  const Mechanism mechanism(block(slope, 2, bearing(mu, mu, 0)));
  const double a = 9.81 * (std::sin(slope) - mu * std::cos(slope));
  for (const char* form : {"momentum", "acceleration", "projected", "partitioned"}) {
    const RunResult run = run_of(mechanism, form, "dop853", "", 1e-12, 1);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_NEAR(run.trajectory.rows.back()[1], 2 + a / 2, 1e-11) << form;
    EXPECT_LT(run.energy_error_max, 1e-10) << form;
  }
}

// Pushed above the slide, the pads share the moment of the push: both press, the one up.
TEST(Bearings, TwoPadsCarryTheMomentAcross) {
  constexpr double mu = 0.2, apart = 0.4, push = 30, high = 0.5, above = 0.3, mass = 2;
  const BearingSpec b = bearing(mu, mu, 0, apart);
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
    // One bearing takes the weight alone.
    EXPECT_NEAR(acceleration_of(block(0, 2, bearing(mu, mu, 0), push, 0, high), algebra),
                push / mass - mu * 9.81, 1e-13);
    // No inertia above the slide: N = 2 F h/ℓ, known without the acceleration.
    ASSERT_GT(2 * push * high / apart, mass * 9.81);
    EXPECT_NEAR(acceleration_of(block(0, 2, b, push, 0, high), algebra),
                (push - mu * 2 * push * high / apart) / mass, 1e-13);
    // With the mass above it N has m a in it: m a = F − 2 μ (F h − m a e)/ℓ.
    const double k = 2 * mu / apart;
    EXPECT_NEAR(acceleration_of(block(0, 2, b, push, above, high), algebra),
                push * (1 - k * high) / (mass * (1 - k * above)), 1e-13);
    // Where the weight is more, the moment does not count.
    EXPECT_NEAR(acceleration_of(block(0, 2, b, 5, 0, 0.1), algebra), 5 / mass - mu * 9.81, 1e-13);
  }
}

TEST(Bearings, OfADrivenJointIsRefused) {
  Scene scene = block(0, 0, bearing(0.2, 0.2, 0));
  scene.drives = {equations::polynomial("S", {0, 1})};
  EXPECT_EQ(refusal_of(scene),
            "scene: joint 'S' is driven, so a spring, damper, friction, bearing, stop or torque on "
            "it has no effect; expected none");
}

TEST(Bearings, FrictionThatMayHaveNoValueIsRefused) {
  // k e = 2 μ e/ℓ is the Lipschitz constant: 0.99 of it has a value, 1.01 has none for sure.
  const auto with = [](double above) {
    return block(0, 2, bearing(0.5, 0.5, 0, 0.4), 30, above, 0.5);
  };
  EXPECT_EQ(refusal_of(with(0.99 * 0.4)), "");
  EXPECT_EQ(refusal_of(with(1.01 * 0.4)),
            "scene: the friction of the bearing of joint 'S' changes the force in it as much as it "
            "follows from it, so that it may have no value, or several; expected less friction, or "
            "a longer lever against it");
}

/// The four-bar's twin: crank, coupler, rocker; pins O, A, C, and B, which does not rub.
PlanarPins twin_of(const Scene& scene) {
  const auto pin = [&](int a, int b, double on_a, double on_b, std::size_t joint) {
    PlanarPins::Pin p{a, b, {on_a, 0}, {on_b, 0}, 0, 0, 0, 1};
    if (joint < 3) {
      const BearingSpec& of = *scene.joints[joint].bearing;
      p.radius = of.radius, p.still = of.static_friction, p.moving = of.dynamic_friction;
      p.transition = of.transition_velocity;
    }
    return p;
  };
  const auto rod = [](double mass, double length) {
    return PlanarPins::Body{mass, mass * length * length / 12};
  };
  return PlanarPins({rod(1, 0.5), rod(2, 2), rod(1.5, 1.5)},
                    {pin(-1, 0, 0, -0.25, 0), pin(0, 1, 0.25, -1, 1), pin(-1, 2, 2, -0.75, 2),
                     pin(1, 2, 1, 0.75, 9)},
                    {0, -9.81});
}

/// Places and rates of the three bodies from the joints' coordinates.
void spread(const VectorXd& q, const VectorXd& u, VectorXd& x, VectorXd& v) {
  x.setZero(9), v.setZero(9);
  const auto put = [&](int body, double angle, double rate, const Eigen::Vector2d& from,
                       const Eigen::Vector2d& speed, double length) {
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle)),
        across(-std::sin(angle), std::cos(angle));
    x.segment<3>(3 * body) << from + length / 2 * along, angle;
    v.segment<3>(3 * body) << speed + length / 2 * rate * across, rate;
  };
  put(0, q[0], u[0], {0, 0}, {0, 0}, 0.5);
  put(1, q[0] + q[1], u[0] + u[1], 2 * x.head<2>(), 2 * v.head<2>(), 2);
  put(2, q[2], u[2], {2, 0}, {0, 0}, 1.5);
}

TEST(Bearings, AccelerationsAsOfTheTwinInMaximalCoordinates) {
  const PlanarPins twin = twin_of(four_bar());
  for (const Algebra algebra : {Algebra::planar, Algebra::spatial})
    for (const KktChoice kkt : {KktChoice::automatic, KktChoice::dense, KktChoice::sparse})
      for (const double speed : {3.0, -8.0, 0.01}) {
        Scene scene = four_bar();
        scene.joints[0].velocity = {speed};
        const Mechanism mechanism(scene, {.algebra = algebra, .kkt = kkt});
        const Start start = assemble(mechanism).start;
        VectorXd x, v;
        spread(start.q, start.u, x, v);
        const VectorXd expected = twin.accelerations(x, v);
        const VectorXd& a = start.udot;
        EXPECT_NEAR(a[0], expected[2], 1e-10);
        EXPECT_NEAR(a[0] + a[1], expected[5], 1e-10);
        EXPECT_NEAR(a[2], expected[8], 1e-10);
      }
}

TEST(Bearings, MotionAsOfTheTwin) {
  Scene scene = four_bar();
  scene.joints[0].velocity = {5};
  const Mechanism mechanism(scene);
  const Start start = assemble(mechanism).start;
  VectorXd x, v;
  spread(start.q, start.u, x, v);
  twin_of(scene).integrate(x, v, 0.5, 4000);
  const RunResult run = run_of(mechanism, "momentum", "dop853", "leak", 1e-12, 0.5);
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_NEAR(run.trajectory.rows.back()[1], x[2], 1e-8);
  EXPECT_NEAR(run.trajectory.rows.back()[3], x[8], 1e-8);
}

/// Largest difference of the three joints' angles at the samples.
double apart(const RunResult& a, const RunResult& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.trajectory.rows.size(); ++i)
    for (std::size_t k = 1; k <= 3; ++k)
      worst = equations::larger(worst, std::abs(a.trajectory.rows[i][k] - b.trajectory.rows[i][k]));
  return worst;
}

struct Way {
  const char *form, *integrator, *gauge;
  double bound;
};
class BearingForms : public testing::TestWithParam<Way> {};

TEST_P(BearingForms, AgreeAndTheirEnergyBalances) {
  const Way& way = GetParam();
  const Mechanism mechanism(four_bar());
  const RunResult tight = run_of(mechanism, "momentum", "dop853", "reset", 1e-12, 1);
  ASSERT_EQ(tight.status, "done") << tight.reason;
  // Friction takes what gravity gives: without its work E is off by joules.
  EXPECT_LT(tight.energy_error_max, 1e-8);
  const RunResult run = run_of(mechanism, way.form, way.integrator, way.gauge, 1e-9, 1);
  ASSERT_EQ(run.status, "done") << run.reason;
  EXPECT_LT(apart(run, tight), way.bound);
  EXPECT_LT(run.energy_error_max, 30 * way.bound);
}
INSTANTIATE_TEST_SUITE_P(
    Bearings, BearingForms,
    testing::Values(Way{"momentum", "dop853", "leak", 1e-7}, Way{"momentum", "dp5", "none", 1e-6},
                    Way{"acceleration", "dop853", "", 1e-6}, Way{"projected", "dop853", "", 1e-7},
                    Way{"partitioned", "dop853", "", 1e-7}, Way{"baumgarte", "dop853", "", 1e-6},
                    Way{"augmented-lagrangian", "dop853", "", 1e-6},
                    Way{"augmented-lagrangian-canonical", "dop853", "leak", 1e-6},
                    Way{"acceleration-index1", "ida", "", 3e-5},
                    Way{"acceleration-index2", "ida", "", 3e-5},
                    Way{"acceleration-index2", "hem5", "", 1e-6},
                    Way{"acceleration-index3", "radau5", "", 1e-3},
                    Way{"stabilised-index2", "ida", "", 3e-5},
                    Way{"stabilised-index2", "radau5", "", 3e-5}));

TEST(Bearings, SpaceAndPlaneAndCutsAgree) {
  Scene scene = four_bar();
  const RunResult plain = run_of(Mechanism(scene), "momentum", "dop853", "reset", 1e-11, 1);
  const RunResult spatial = run_of(Mechanism(scene, {.algebra = Algebra::spatial}), "momentum",
                                   "dop853", "reset", 1e-11, 1);
  ASSERT_EQ(spatial.status, "done") << spatial.reason;
  EXPECT_LT(apart(plain, spatial), 1e-8);
  const RunResult as_written =
      run_of(Mechanism(scene, {.cut = CutChoice::scene}), "momentum", "dop853", "reset", 1e-11, 1);
  EXPECT_LT(apart(plain, as_written), 1e-8);
}

TEST(Bearings, LongRowByLocalMatrices) {
  Scene scene = row_of_four_bars(15, 1.5, -1);
  for (JointSpec& joint : scene.joints) joint.bearing = bearing(0.2, 0.2, 0.02);
  const Mechanism mechanism(scene);
  const RunResult tight = run_of(mechanism, "acceleration", "dop853", "", 1e-11, 0.1);
  ASSERT_EQ(tight.status, "done") << tight.reason;
  const RunResult index2 = run_of(mechanism, "stabilised-index2", "ida", "", 1e-8, 0.1);
  ASSERT_EQ(index2.status, "done") << index2.reason;
  for (std::size_t k = 1; k <= static_cast<std::size_t>(mechanism.nq()); ++k)
    EXPECT_NEAR(index2.trajectory.rows.back()[k], tight.trajectory.rows.back()[k], 1e-4);
}

// A bar on three cranks of one length: how they share its weight nobody knows.
TEST(Bearings, ForcesThatAreNotUniqueAreRefusedByName) {
  std::string text =
      "gravity = [0, -9.81, 0]\n[[body]]\nname = \"bar\"\nmass = 3\ncom = [1, 0, "
      "0]\ninertia = 1\n";
  for (const char* name : {"a", "b", "c"})
    text += std::string("[[body]]\nname = \"") + name + "\"\nmass = 1\ninertia = 0.1\n";
  const std::string rubs = "bearing = { dynamic = 0.2, radius = 0.05 }\n";
  text += "[[joint]]\nname = \"A\"\nkind = \"revolute\"\nchild = \"a\"\nposition = 0.6\n" + rubs;
  text +=
      "[[joint]]\nname = \"P\"\nkind = \"revolute\"\nparent = \"a\"\nchild = \"bar\"\norigin = "
      "{ parent = [1, 0, 0] }\nposition = -0.6\n";
  int place = 1;
  for (const std::string name : {"b", "c"}) {
    const std::string x = std::to_string(place++);
    text += "[[joint]]\nname = \"" + std::string(name == "b" ? "B" : "C") +
            "\"\nkind = \"revolute\"\nchild = \"" + name +
            "\"\nposition = 0.6\norigin = { parent = [" + x + ", 0, 0] }\n[[loop]]\nname = \"L" +
            name + "\"\nkind = \"point\"\nparent = \"bar\"\nchild = \"" + name +
            "\"\norigin = { parent = [" + x + ", 0, 0], child = [1, 0, 0] }\n";
  }
  EXPECT_EQ(refusal_of(parse_scene(text, "cranks.toml")),
            "cranks.toml: joint 'A' has a bearing, and the force in it is not unique, as loop "
            "equations depend on each other: expected loops that tie less (momenta check names "
            "them), or no bearing");
}

// What the pins of a planar four-bar carry across their axes nobody knows either; of an open chain
// it is known.
TEST(Bearings, MomentsOfAClosedPlanarChainAreNotUnique) {
  Scene scene = four_bar();
  scene.joints[1].bearing->length = 0.1;
  EXPECT_NE(refusal_of(scene).find("joint 'A' has a bearing, and the force in it is not unique"),
            std::string::npos)
      << refusal_of(scene);
  scene.loops.clear();
  EXPECT_EQ(refusal_of(scene), "");
  const Mechanism open(scene);
  EXPECT_FALSE(open.plan().planar);
  EXPECT_EQ(open.plan().planar_reason, "the bearing of joint 'A' carries moments out of the plane");
}

/// A slide on a table carries the weight: x = v t − μ g t²/2. Beside a hinge about the normal too;
/// with all loads in the plane the scene stays there.
TEST(Bearings, OfSlidesCarryLoadsAcrossThePlane) {
  const auto table = [](const std::string& second, const std::string& more) {
    return parse_scene(
        "gravity = [0, 0, -9.81]\n[[body]]\nname = \"a\"\nmass = 1\ninertia = [0.1, 0.1, "
        "0.1]\n[[body]]\nname = \"b\"\nmass = 2\ninertia = [0.1, 0.1, 0.1]\n[[joint]]\nname = "
        "\"A\"\nkind = \"prismatic\"\naxis = \"x\"\nchild = \"a\"\nvelocity = 3\nbearing = { "
        "dynamic = 0.2 }\n[[joint]]\nname = \"B\"\nparent = \"a\"\nchild = \"b\"\n" +
        second + more);
  };
  for (const std::string second :
       {"kind = \"prismatic\"\naxis = \"y\"\n", "kind = \"revolute\"\naxis = \"z\"\n"}) {
    const Mechanism mechanism(table(second, ""));
    EXPECT_EQ(mechanism.plan().planar_reason,
              "the bearing of joint 'A' carries loads out of the plane");
    const RunResult run =
        run_form(mechanism, equations::start_of(mechanism),
                 equations::kept(equations::adaptive("momentum", "", "", 1e-9, 1, 2)));
    EXPECT_EQ(run.status, "done") << run.reason;
    EXPECT_NEAR(run.trajectory.rows.back()[1], 3 - 0.1 * 9.81, 1e-6) << second;
    Scene flat = table(second, "");
    flat.gravity = {0, -9.81, 0};
    EXPECT_TRUE(Mechanism(flat).plan().planar);
    const auto beside = [&](const std::string& force) {
      Scene s = table(second, "[[force]]\n" + force);
      s.gravity.setZero();
      return Mechanism(s).plan().planar;
    };
    EXPECT_TRUE(beside("kind = \"wrench\"\nbody = \"b\"\nforce = [1, 2, 0]\n"));
    EXPECT_FALSE(beside("kind = \"wrench\"\nbody = \"b\"\nforce = [1, 2, 0.1]\n"));
    EXPECT_TRUE(beside("kind = \"wrench\"\nbody = \"b\"\nforce = [1, 2, 0]\naxes = \"body\"\n"));
    EXPECT_TRUE(beside("kind = \"spring-damper\"\nchild = \"b\"\nstiffness = 3\n"));
    EXPECT_FALSE(
        beside("kind = \"spring-damper\"\nchild = \"b\"\nstiffness = 3\norigin = { "
               "parent = [0, 0, 1] }\n"));
    EXPECT_TRUE(beside("kind = \"potential\"\nV = \"A.q^2\"\n"));
    EXPECT_FALSE(
        beside("kind = \"potential\"\nV = \"P.z\"\n[[marker]]\nname = \"P\"\nbody = "
               "\"b\"\n"));
  }
}

TEST(Bearings, FormsWithoutAccelerationsRefuse) {
  const Mechanism mechanism(four_bar());
  for (const char* form : {"momentum-index1", "momentum-index2", "momentum-stabilised",
                           "momentum-index3", "maximal-coordinates"}) {
    const std::string reason =
        equations::thrown<std::invalid_argument>([&] { run_of(mechanism, form, "", "", 1e-8, 1); });
    EXPECT_NE(reason.find("joint 'O' has a bearing, whose friction takes accelerations"),
              std::string::npos)
        << form << ": " << reason;
  }
}

TEST(Bearings, IntegratorsOfHamiltoniansRefuse) {
  const Mechanism mechanism(four_bar());
  const Start start = assemble(mechanism).start;
  for (const std::string integrator : {"rattle", "energy-momentum"}) {
    RunRequest request;
    request.settings.integrator = integrator;
    request.settings.step = 1e-3;
    const std::string reason =
        equations::thrown<std::invalid_argument>([&] { run_form(mechanism, start, request); });
    EXPECT_EQ(reason,
              "joint 'O' has a bearing, whose friction takes accelerations and forces of loops, "
              "and '" +
                  integrator + "' finds none: expected another integrator");
  }
}

}  // namespace
}  // namespace momenta::dae_bearings
