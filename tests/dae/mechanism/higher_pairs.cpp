// Slots, cams, racks and equations: Φ against slow twins that know positions alone; Φ_q, Φ̇, Φ̈ and
// the impulses' rates against differences of Φ in quad precision, in a plane and in space, with
// moving origins; Jacobians in every scalar; what has no derivatives is told.

#include "equations/carried.h"
#include "equations/random_tree.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/core/scalar/quad.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <numbers>

namespace momenta::dae_higher_pairs {
namespace {

using Eigen::VectorXd;

const std::string outline =
    "points = [[0.5, 0, 0], [0.3, 0.35, 0], [-0.1, 0.45, 0], [-0.45, 0.1, "
    "0], [-0.3, -0.4, 0], [0.2, -0.35, 0]]";
const std::string path = "points = [[-1, 0.2, 0], [-0.3, 0.6, 0], [0.4, 0.5, 0], [1.2, 0.9, 0]]";

bool is_equation(const std::string& loop) {
  return loop.starts_with("kind = \"equation\"");
}

/// Two arms in a row, and a third body that turns on the ground; a loop between the last two.
Scene arms(const std::string& loop, const std::string& rest = "") {
  return parse_scene(R"(
gravity = [0.3, -9.81, 0]
[[body]]
name = "a"
mass = 1
com = [0.5, 0.1, 0]
inertia = 0.1
[[body]]
name = "b"
mass = 2
com = [0.3, 0.1, 0]
inertia = 0.2
[[body]]
name = "c"
mass = 1
com = [0.1, 0, 0]
inertia = 0.1
[[joint]]
name = "A"
kind = "revolute"
child = "a"
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [0.8, 0, 0] }
[[joint]]
name = "C"
kind = "revolute"
child = "c"
origin = { parent = [0.4, -0.7, 0] }
[[marker]]
name = "P"
body = "b"
point = [0.4, 0.3, 0]
[[marker]]
name = "R"
body = "b"
point = [-0.2, 0.1, 0]
[[marker]]
name = "far-off"
body = "c"
point = [0.5, -0.2, 0]
[[loop]]
name = "K"
)" + std::string(is_equation(loop) ? "" : R"(
parent = "c"
child = "b"
origin = { parent = [0.1, 0.05, 0], child = [0.2, -0.1, 0] }
rotation = { axis = "z", angle = 0.3 }
)") + loop + "\n" + rest,
                     "arms.toml");
}

struct Case {
  std::string name, loop;
};
std::vector<Case> all_pairs() {
  const auto cam = [](const std::string& parent, const std::string& child) {
    return "kind = \"cam\"\nprofile = { parent = { " + parent + " }, child = { " + child + " } }";
  };
  const std::string circle = "kind = \"circle\", radius = 0.3";
  const std::string ellipse =
      "kind = \"ellipse\", semi_axes = [0.5, 0.3], direction = [0.6, 0.8, 0]";
  const std::string spline = "kind = \"spline\", " + outline;
  const std::string flat = "kind = \"flat\", normal = [0.28, 0.96, 0]";
  return {{"straight slot", "kind = \"slot\"\naxis = [0.8, 0.6, 0]"},
          {"round slot", "kind = \"slot\"\ncurve = \"circle\"\nradius = 0.6"},
          {"closed slot", "kind = \"slot\"\ncurve = \"spline\"\nclosed = true\n" + outline},
          {"open slot", "kind = \"slot\"\ncurve = \"spline\"\n" + path},
          {"slot seen from behind", "kind = \"slot\"\ncurve = \"spline\"\naxis = \"-z\"\n" + path},
          {"rack", "kind = \"rack\"\nradius = 0.4\noffset = 0.2\ndirection = [0.6, 0.8, 0]"},
          {"circles", cam(circle, circle)},
          {"circle on ellipse", cam(ellipse, circle)},
          {"ellipse on ellipse", cam(ellipse, ellipse)},
          {"flat on ellipse", cam(ellipse, flat)},
          {"spline on flat", cam(flat, spline)},
          {"ellipse on spline", cam(spline, ellipse)},
          {"spline on circle from behind", cam(circle, spline) + "\naxis = \"-z\""},
          {"equation of markers",
           "kind = \"equation\"\nequation = \"(P.x - 'far-off'.x)^2 + (P.y - 'far-off'.y)^2 = "
           "0.7\""},
          {"equation of coordinates",
           "kind = \"equation\"\nequation = \"sin(A.q) * B.q - exp(0.3 * C.q) + 0.2\""},
          {"equation of everything",
           "kind = \"equation\"\nequation = \"P.x * R.y + tanh(B.q) * 'far-off'.x = 0.1 * cos(A.q) "
           "+ 0.05 * P.y^2\""}};
}

/// The rows of the last loop at q and along q + t u + t²/2 u̇ as numbers of S.
template <class S>
struct Rows {
  explicit Rows(const Mechanism& mechanism)
      : nv(mechanism.nv()), m(mechanism.m()), e(mechanism.evaluation<S>()) {}
  int nv, m;
  std::unique_ptr<Evaluation<S>> e;

  std::vector<S> positions(double t, const std::vector<S>& q) {
    std::vector<S> phi(static_cast<std::size_t>(m));
    e->place(t, q.data());
    e->positions(phi.data());
    return phi;
  }
  std::vector<S> load(double t, const std::vector<S>& q, const std::vector<S>& sigma) {
    std::vector<S> force(static_cast<std::size_t>(nv));
    e->place(t, q.data());
    e->constraint_forces(sigma.data(), force.data());
    return force;
  }
};

std::vector<Quad> quad(const VectorXd& x) {
  std::vector<Quad> y;
  for (const double value : x) y.emplace_back(value);
  return y;
}
VectorXd doubles(const std::vector<Quad>& x) {
  VectorXd y(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) y[static_cast<Eigen::Index>(i)] = value_of(x[i]);
  return y;
}
/// q + x u
std::vector<Quad> moved(const VectorXd& q, double x, const VectorXd& u) {
  std::vector<Quad> y = quad(q);
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] += Quad(x) * Quad(u[static_cast<Eigen::Index>(i)]);
  return y;
}
VectorXd difference(const std::vector<Quad>& later, const std::vector<Quad>& sooner, double h) {
  std::vector<Quad> d = later;
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = (d[i] - sooner[i]) / Quad(2 * h);
  return doubles(d);
}

/// A state at which Φ is small, so that the curves are near to each other.
VectorXd near_contact(const Mechanism& mechanism, equations::RandomTree& random) {
  const auto e = mechanism.evaluation<double>();
  VectorXd best(mechanism.nq());
  double least = HUGE_VAL;
  for (int i = 0; i < 100; ++i) {
    VectorXd q(mechanism.nq()), phi(mechanism.m());
    for (double& x : q) x = random.uniform(-3, 3);
    e->place(0, q.data());
    e->positions(phi.data());
    if (phi.norm() < least) least = phi.norm(), best = q;
  }
  return best;
}

void compare_with_differences(const Mechanism& mechanism, double t, equations::RandomTree& random) {
  constexpr double h = 1e-9;
  const int nv = mechanism.nv(), m = mechanism.m();
  const VectorXd q = near_contact(mechanism, random);
  VectorXd u(nv), udot(nv), sigma(m);
  for (VectorXd* x : {&u, &udot, &sigma})
    for (double& value : *x) value = random.uniform(-1, 1);
  Rows<Quad> twin(mechanism);
  const auto e = mechanism.evaluation<double>();

  // Φ and Φ_qᵀσ
  VectorXd phi(m), force(nv), later(nv), sooner(nv);
  e->place(t, q.data());
  ASSERT_EQ(e->lost_loop(), "");
  e->positions(phi.data());
  EXPECT_LE((phi - doubles(twin.positions(t, quad(q)))).norm(), 1e-13);
  e->constraint_forces(sigma.data(), force.data());
  for (int k = 0; k < nv; ++k) {
    const VectorXd unit = VectorXd::Unit(nv, k);
    const VectorXd column =
        difference(twin.positions(t, moved(q, h, unit)), twin.positions(t, moved(q, -h, unit)), h);
    EXPECT_NEAR(force[k], column.dot(sigma), 1e-12) << k;
  }
  std::vector<double> entries(mechanism.constraint_pattern().size());
  e->constraint_entries(entries.data());
  VectorXd by_entries = VectorXd::Zero(nv);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& at = mechanism.constraint_pattern()[i];
    by_entries[at.column] += entries[i] * sigma[at.row];
  }
  EXPECT_LE((by_entries - force).norm(), 1e-13);

  // Φ̇ by t and along u; Φ̈ as the derivative of Φ̇ along (u, u̇)
  const auto rate_at = [&](double x) {  // at time t + x
    std::vector<Quad> rate(static_cast<std::size_t>(m));
    std::vector<Quad> at = moved(q, x, u), rates = moved(u, x, udot);
    for (std::size_t i = 0; i < at.size(); ++i)
      at[i] += Quad(0.5 * x * x) * Quad(udot[static_cast<Eigen::Index>(i)]);
    twin.e->place(t + x, at.data());
    twin.e->move(rates.data());
    twin.e->velocities(rate.data());
    return rate;
  };
  VectorXd rate(m), second(m), unused(nv), with(nv), without(nv);
  // the clock of quad evaluations is a double: steps that it holds exactly
  constexpr double tick = 0x1p-17;
  e->place(t, q.data());
  e->move(u.data());
  e->velocities(rate.data());
  EXPECT_LE((rate - doubles(rate_at(0))).norm(), 1e-12);
  const VectorXd by_clock = difference(twin.positions(t + tick, moved(q, tick, u)),
                                       twin.positions(t - tick, moved(q, -tick, u)), tick);
  EXPECT_LE((rate - by_clock).norm(), 1e-7);
  e->joint_forces(q.data(), u.data(), udot.data(), nullptr, unused.data());
  e->accelerations(second.data());
  EXPECT_LE((second - difference(rate_at(tick), rate_at(-tick), tick)).norm(), 1e-6);
  if (!mechanism.plan().drives) {
    EXPECT_LE((rate -
               difference(twin.positions(t, moved(q, h, u)), twin.positions(t, moved(q, -h, u)), h))
                  .norm(),
              1e-12);
    EXPECT_LE((second - difference(rate_at(h), rate_at(-h), h)).norm(), 1e-11);
  }

  // (Φ_qᵀσ)˙
  e->momenta(sigma.data(), with.data());
  e->momentum_rates(q.data(), u.data(), sigma.data(), 0, with.data());
  e->momenta(nullptr, without.data());
  e->momentum_rates(q.data(), u.data(), nullptr, 0, without.data());
  const VectorXd impulse = difference(twin.load(t + tick, moved(q, tick, u), quad(sigma)),
                                      twin.load(t - tick, moved(q, -tick, u), quad(sigma)), tick);
  EXPECT_LE((with - without - impulse).norm(), 1e-6);
  if (!mechanism.plan().drives) {
    EXPECT_LE((with - without -
               difference(twin.load(t, moved(q, h, u), quad(sigma)),
                          twin.load(t, moved(q, -h, u), quad(sigma)), h))
                  .norm(),
              1e-11);
  }
}

TEST(HigherPairs, RowsAgainstDifferences) {
  for (const Case& c : all_pairs())
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      SCOPED_TRACE(c.name + (algebra == Algebra::planar ? " in a plane" : " in space"));
      const Mechanism mechanism(arms(c.loop), {.algebra = algebra});
      equations::RandomTree random(7);
      for (int i = 0; i < 5; ++i) {
        compare_with_differences(mechanism, 0, random);
        if (HasFatalFailure()) return;
      }
    }
}

TEST(HigherPairs, OriginsMoveOnDrives) {
  const std::string drive = R"(
[[drive]]
loop = "K"
origin = "x"
kind = "harmonic"
amplitude = 0.2
frequency = 3
[[drive]]
joint = "C"
kind = "polynomial"
coefficients = [0.1, 0.5]
)";
  for (const Case& c : all_pairs())
    for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
      SCOPED_TRACE(c.name + (algebra == Algebra::planar ? " in a plane" : " in space"));
      if (is_equation(c.loop)) continue;
      const Mechanism mechanism(arms(c.loop, drive), {.algebra = algebra});
      equations::RandomTree random(8);
      compare_with_differences(mechanism, 0.25, random);
      if (HasFatalFailure()) return;
    }
}

/// With the time in them, and with a coordinate that a drive prescribes.
TEST(HigherPairs, EquationsInTime) {
  const std::string drive = R"(
[[drive]]
joint = "C"
kind = "harmonic"
amplitude = 0.7
frequency = 2
)";
  for (const char* equation :
       {"P.x * R.y + B.q^2 = 0.3 * sin(3 * t)", "(P.x - 'far-off'.x)^2 + P.y * C.q = 0.7 + t^2"})
    for (const std::string& driven : {std::string(), drive})
      for (const Algebra algebra : {Algebra::planar, Algebra::spatial}) {
        SCOPED_TRACE(equation + driven);
        const Mechanism mechanism(
            arms(std::string("kind = \"equation\"\nequation = \"") + equation + "\"", driven),
            {.algebra = algebra});
        EXPECT_TRUE(mechanism.plan().drives);
        equations::RandomTree random(12);
        compare_with_differences(mechanism, 0.25, random);
        if (HasFatalFailure()) return;
      }
}

/// In space with bodies that tilt: slots alone, whose points need no common plane.
TEST(HigherPairs, SlotsInSpaceOnBodiesThatTilt) {
  for (const char* slot : {"kind = \"slot\"\ncurve = \"circle\"\nradius = 0.6",
                           "kind = \"slot\"\naxis = [0.8, 0.6, 0]"}) {
    Scene scene = arms(slot);
    scene.joints[1].rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.6, 0, 0.8));
    scene.joints[2].axis = Eigen::Vector3d(0, 0.6, 0.8);
    for (BodySpec& body : scene.bodies) body.inertia.diagonal() = Eigen::Vector3d(0.2, 0.2, 0.3);
    const Mechanism mechanism(scene);
    EXPECT_FALSE(mechanism.plan().planar);
    EXPECT_EQ(mechanism.m(), 2);
    equations::RandomTree random(9);
    compare_with_differences(mechanism, 0, random);
  }
}

/// All of them where their plane goes with a body in space: on three slides and three hinges.
TEST(HigherPairs, PlanesThatMoveInSpace) {
  for (const Case& c : all_pairs()) {
    SCOPED_TRACE(c.name);
    std::vector<BodySpec> bodies;
    std::vector<JointSpec> joints;
    std::string parent = "ground";
    for (int i = 0; i < 6; ++i) {
      const std::string child = i == 5 ? "base" : "base" + std::to_string(i);
      bodies.push_back(equations::massless(child));
      joints.push_back(equations::base_joint("J" + std::to_string(i),
                                             i < 3 ? JointKind::prismatic : JointKind::revolute,
                                             parent, child, Eigen::Vector3d::Unit(i % 3)));
      parent = child;
    }
    bodies.back().mass = 3;
    bodies.back().com = {0.1, 0.3, -0.2};
    bodies.back().inertia.diagonal() = Eigen::Vector3d(0.2, 0.3, 0.4);
    const Mechanism mechanism(equations::on_base(arms(c.loop), bodies, joints));
    ASSERT_FALSE(mechanism.plan().planar);
    equations::RandomTree random(17);
    for (int i = 0; i < 3; ++i) {
      compare_with_differences(mechanism, 0, random);
      if (HasFatalFailure()) return;
    }
  }
}

/// The gap of two convex outlines is the largest distance by which a line keeps them apart,
/// max over n of min n·(points of A) − max n·(points of B), found by looking everywhere.
double gap_by_separation(const HigherPair& pair, const std::array<double, 4>& y) {
  constexpr int many = 4000;
  const auto sampled = [&](const PlaneCurve& curve, int k) {
    return curve.at(curve.period() * k / many).p;
  };
  std::vector<std::array<double, 2>> of_a, of_b;
  for (int k = 0; k < many; ++k) {
    const auto a = sampled(pair.of_a, k);
    of_a.push_back({y[0] + y[2] * a[0] - y[3] * a[1], y[1] + y[3] * a[0] + y[2] * a[1]});
    of_b.push_back(sampled(pair.of_b, k));
  }
  double best = -HUGE_VAL;
  for (int k = 0; k < 720; ++k) {
    const double w = k * std::numbers::pi / 360, nx = std::cos(w), ny = std::sin(w);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const auto& p : of_a) low = std::min(low, nx * p[0] + ny * p[1]);
    for (const auto& p : of_b) high = std::max(high, nx * p[0] + ny * p[1]);
    best = std::max(best, low - high);
  }
  return best;
}

TEST(HigherPairs, GapsAgainstSeparation) {
  equations::RandomTree random(3);
  for (const Case& c : all_pairs()) {
    const Scene scene = arms(c.loop);
    const LoopSpec& loop = scene.loops[0];
    if (loop.kind != LoopKind::cam || loop.curve.kind == "flat" || loop.child_curve.kind == "flat")
      continue;
    SCOPED_TRACE(c.name);
    const HigherPair pair = pair_of(loop);
    for (int i = 0; i < 8; ++i) {
      const double angle = random.uniform(-3, 3), way = random.uniform(-3, 3);
      const double far = random.uniform(0.75, 1.3);
      const std::array<double, 4> y{far * std::cos(way), far * std::sin(way), std::cos(angle),
                                    std::sin(angle)};
      PairPlace place;
      PairTerms<double> terms;
      pair.evaluate(y, place, terms);
      ASSERT_EQ(place.lost, PairPlace::Lost::no);
      EXPECT_NEAR(terms.value, gap_by_separation(pair, y), 1e-4);
    }
  }
}

/// The distance of a point from a curve, by looking everywhere; its sign that of the left side.
TEST(HigherPairs, SlotsAgainstNearestPoints) {
  equations::RandomTree random(4);
  for (const Case& c : all_pairs()) {
    const Scene scene = arms(c.loop);
    if (scene.loops[0].kind != LoopKind::slot || scene.loops[0].curve.kind != "spline") continue;
    SCOPED_TRACE(c.name);
    const HigherPair pair = pair_of(scene.loops[0]);
    const double first = pair.of_b.period() > 0 ? 0 : pair.of_b.samples().front() - 3;
    const double last =
        pair.of_b.period() > 0 ? pair.of_b.period() : pair.of_b.samples().back() + 3;
    for (int i = 0; i < 20; ++i) {
      const std::array<double, 4> y{random.uniform(-1.5, 1.5), random.uniform(-1, 1.5), 1, 0};
      constexpr int many = 20000;
      double least = HUGE_VAL;
      for (int k = 0; k <= many; ++k) {
        const auto p = pair.of_b.at(first + (last - first) * k / many).p;
        least = std::min(least, std::hypot(y[0] - p[0], y[1] - p[1]));
      }
      PairPlace place;
      PairTerms<double> terms;
      pair.evaluate(y, place, terms);
      ASSERT_EQ(place.lost, PairPlace::Lost::no);
      EXPECT_NEAR(std::abs(terms.value), least, 1e-5);
      EXPECT_NEAR(std::hypot(terms.slope[0], terms.slope[1]), 1, 1e-14);
    }
  }
}

/// The pinion's angle is what rolling makes it, turn after turn.
TEST(HigherPairs, RacksRollThroughManyTurns) {
  const HigherPair pair = pair_of(arms("kind = \"rack\"\nradius = 0.4\noffset = 0.2").loops[0]);
  for (double way = -20; way < 20; way += 0.7) {
    const double angle = 0.2 - way / 0.4;
    PairPlace place;
    PairTerms<double> terms;
    pair.evaluate({way, 0.4, std::cos(angle), std::sin(angle)}, place, terms);
    EXPECT_NEAR(terms.value, 0, 1e-13);
    EXPECT_NEAR(terms.slope[0], 1, 1e-13);  // metres of rolling
    pair.evaluate({way + 0.01, 0.4, std::cos(angle), std::sin(angle)}, place, terms);
    EXPECT_NEAR(terms.value, 0.01, 1e-5);
  }
}

/// α and β are functions of y, whatever the last place was.
TEST(HigherPairs, PlacesDoNotRememberTheWay) {
  for (const Case& c : all_pairs()) {
    const Scene scene = arms(c.loop);
    if (!has_curves(scene.loops[0])) continue;
    SCOPED_TRACE(c.name);
    const HigherPair pair = pair_of(scene.loops[0]);
    const auto at = [](double w) {
      return std::array<double, 4>{0.6 * std::cos(w), 0.6 * std::sin(w), std::cos(2 * w),
                                   std::sin(2 * w)};
    };
    PairPlace far, near, fresh;
    PairTerms<double> one, two, three;
    pair.evaluate(at(0.9), far, one);
    pair.evaluate(at(1), far, one);
    for (int k = 0; k <= 100; ++k) pair.evaluate(at(1.2 - 0.002 * k), near, two);
    pair.evaluate(at(1), near, two);
    pair.evaluate(at(1), fresh, three);
    EXPECT_EQ(one.value, two.value);
    EXPECT_EQ(one.value, three.value);
    EXPECT_EQ(one.bend, two.bend);
  }
}

TEST(HigherPairs, WithoutDerivativesIsTold) {
  HigherPair pair = pair_of(
      arms("kind = \"cam\"\nprofile = { parent = { kind = \"ellipse\", semi_axes = [0.5, 0.3] }, "
           "child = { kind = \"circle\", radius = 0.3 } }")
          .loops[0]);
  pair.kind = HigherPair::Kind::curve;  // a point, and its distance from the ellipse
  PairPlace place;
  PairTerms<double> terms;
  const double centre = 0.5 - 0.3 * 0.3 / 0.5;  // of curvature, at the end of the long axis
  pair.evaluate({centre, 0, 1, 0}, place, terms);
  EXPECT_EQ(place.lost, PairPlace::Lost::curvature);
  EXPECT_TRUE(std::isfinite(terms.value));
  EXPECT_FALSE(std::isfinite(terms.bend[1][1]));
  pair.evaluate({centre + 0.01, 0, 1, 0}, place, terms);
  EXPECT_EQ(place.lost, PairPlace::Lost::no);
  pair.evaluate({std::nan(""), 0, 1, 0}, place, terms);
  EXPECT_EQ(place.lost, PairPlace::Lost::no_normal);
  EXPECT_FALSE(std::isfinite(terms.value));
}

/// Newton matrices by dual numbers, and the local ones by sparse duals, against differences of the
/// residual.
TEST(HigherPairs, JacobiansOfForms) {
  for (const Case& c : all_pairs()) {
    SCOPED_TRACE(c.name);
    const Mechanism mechanism(arms(c.loop));
    equations::RandomTree random(11);
    const VectorXd q = near_contact(mechanism, random);
    Start start;
    start.q = q;
    start.u = VectorXd::Constant(3, 0.3);
    start.udot = VectorXd::Zero(3);
    start.lambda = VectorXd::Constant(mechanism.m(), 0.5);
    for (const char* name : {"stabilised-index2", "momentum-index2", "acceleration-index1"}) {
      SCOPED_TRACE(name);
      const auto form = make_form(name, mechanism, {}, start);
      auto& dae = dynamic_cast<DaeForm&>(*form);
      const auto n = static_cast<std::size_t>(dae.size());
      std::vector<double> y = dae.initial(start), ydot(n), values(n * n);
      for (double& x : ydot) x = random.uniform(-1, 1);
      constexpr double slope = 3, h = 1e-6;
      ASSERT_TRUE(dae.pattern().column_start.empty());  // dense
      ASSERT_TRUE(dae.jacobian(0, y.data(), ydot.data(), slope, values.data()));
      for (std::size_t j = 0; j < n; ++j) {
        std::vector<double> later(n), sooner(n);
        for (const double sign : {1.0, -1.0}) {
          std::vector<double> at = y, rates = ydot;
          at[j] += sign * h;
          rates[j] += sign * h * slope;
          dae.residual(0, at.data(), rates.data(), sign > 0 ? later.data() : sooner.data());
        }
        for (std::size_t i = 0; i < n; ++i)
          EXPECT_NEAR(values[j * n + i], (later[i] - sooner[i]) / (2 * h), 2e-7) << i << " " << j;
      }
      auto& local = dae.local_jacobian();
      ASSERT_TRUE(local.evaluate(0, y.data(), ydot.data(), slope));
      const int version = local.version();
      // other values, the same pattern
      for (double& x : y) x += random.uniform(-0.05, 0.05);
      ASSERT_TRUE(local.evaluate(0, y.data(), ydot.data(), slope));
      EXPECT_EQ(local.version(), version);
    }
  }
}

// The sine of a rack's angle is zero half a turn off as well.
TEST(HigherPairs, RacksThatCloseHalfATurnOffAreLedBack) {
  for (const double offset : {0.0, 0.7})
    for (const double way : {0.0, 0.05})
      for (const double guess : {-2.9, -2.0, -1.0, 0.4, 1.0, 2.0, 3.0, 4.0, 5.5}) {
        Scene scene = parse_scene(R"(
[[body]]
name = "slide"
mass = 1
shape = { kind = "point" }
[[body]]
name = "gear"
mass = 2
com = [0.05, 0, 0]
inertia = 0.03
[[joint]]
name = "P"
kind = "prismatic"
axis = "x"
child = "slide"
[[joint]]
name = "G"
kind = "revolute"
parent = "slide"
child = "gear"
[[loop]]
name = "teeth"
kind = "rack"
child = "gear"
radius = 0.1
direction = "x"
origin = { parent = [0, -0.1, 0] }
[assembly]
hold = ["P"]
)",
                                  "rack.toml");
        scene.joints[0].position = {way};
        scene.joints[1].position = {guess};
        scene.loops[0].offset = offset;
        const Mechanism mechanism(scene);
        const VectorXd q = assemble(mechanism).start.q;
        EXPECT_NEAR(std::remainder(q[1] - offset + way / 0.1, 2 * std::numbers::pi), 0, 1e-10)
            << offset << " " << way << " " << guess;
      }
}

}  // namespace
}  // namespace momenta::dae_higher_pairs
