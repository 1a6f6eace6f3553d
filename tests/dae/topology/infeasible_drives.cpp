// Drives that ask for what loops cannot follow: every form and every integrator says the same time,
// that of the dead point, and no run is done with open loops.
//
// The slow twin is geometry. A crank a turned by φ(t) about O carries a coupler b, pinned to a
// rocker c about C at a distance g from O: the loop closes where
//
//   |b − c| ≤ d(φ) ≤ b + c,   d² = g² + a² − 2 g a cos φ,
//
// and the drive can go on until φ(t) first leaves these angles.

#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/parts.h"
#include "equations/runs.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>

namespace momenta::dae_infeasible_drives {
namespace {

using namespace equations;
using Eigen::Vector3d;

struct FourBar {
  double a = 1, b = 1.2, c = 0.6, g = 2;
  double from = 0.5;      ///< φ(0) [rad]
  DriveSpec law = {};     ///< φ(t)
  bool folded = false;    ///< which of the two assemblies
  bool as_loop = false;   ///< cut at the driven joint
  bool pendulum = false;  ///< hangs from the coupler: a freedom the drive does not have
  bool tail = false;      ///< three rods from the coupler to the ground: another loop, with one
};

double law_at(const DriveSpec& d, double t) {
  if (d.kind == "harmonic") return d.offset + d.amplitude * std::sin(d.frequency * t + d.phase);
  double value = 0;
  for (std::size_t i = d.coefficients.size(); i-- > 0;) value = value * t + d.coefficients[i];
  return value;
}

/// How far the loop is from its limits, in length: positive where it closes with room.
double room(const FourBar& x, double phi) {
  const double d = std::sqrt(x.g * x.g + x.a * x.a - 2 * x.g * x.a * std::cos(phi));
  return std::min(x.b + x.c - d, d - std::abs(x.b - x.c));
}

/// The first time in (0, end) at which a loop opens, of its room over time; end where it does not.
/// `closest`: least room met before, or the most by which it is missed until it closes again.
double dead_point(const std::function<double(double)>& room_at, double end, double& closest) {
  constexpr int parts = 4000;
  closest = room_at(0);
  for (int i = 1; i <= parts; ++i) {
    double low = end * (i - 1) / parts, high = end * i / parts;
    const double here = room_at(high);
    if (here > 0) {
      closest = std::min(closest, here);
      continue;
    }
    for (int k = 0; k < 60; ++k)
      (room_at(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
    closest = 0;
    for (int k = i; k <= parts && room_at(end * k / parts) <= 0; ++k)
      closest = std::min(closest, room_at(end * k / parts));
    return low;
  }
  return end;
}

BodySpec rod_of(const std::string& name, double length) {
  BodySpec body = rod(name);
  body.com *= length;
  body.inertia *= length * length;
  return body;
}

Scene scene_of(const FourBar& x) {
  Scene s;
  s.name = "driven four-bar";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod_of("a", x.a), rod_of("b", x.b), rod_of("c", x.c)};
  // Angles of coupler and rocker from the triangle A, B, C.
  const Eigen::Vector2d A(x.a * std::cos(x.from), x.a * std::sin(x.from)), C(x.g, 0);
  const Eigen::Vector2d way = C - A;
  const double d = way.norm(), along = std::atan2(way.y(), way.x());
  const double at_a = std::acos((d * d + x.b * x.b - x.c * x.c) / (2 * d * x.b));
  const double coupler = along + (x.folded ? -at_a : at_a);
  const Eigen::Vector2d B = A + x.b * Eigen::Vector2d(std::cos(coupler), std::sin(coupler));
  const double rocker = std::atan2(B.y() - C.y(), B.x() - C.x());
  LoopSpec loop;
  loop.kind = LoopKind::revolute;
  DriveSpec drive = x.law;
  if (x.as_loop) {  // the tree: ground, rocker, coupler, crank
    s.joints = {hinge("C", "ground", "c", {x.g, 0, 0}, rocker),
                hinge("B", "c", "b", {x.c, 0, 0}, coupler - rocker)};
    s.joints.back().origin_child = {x.b, 0, 0};
    s.joints.push_back(hinge("A", "b", "a", {0, 0, 0}, x.from - coupler));
    s.joints.back().origin_child = {x.a, 0, 0};
    loop.name = drive.loop = "O";
    loop.parent = "ground";
    loop.child = "a";
  } else {
    s.joints = {hinge("O", "ground", "a", {0, 0, 0}, x.from),
                hinge("A", "a", "b", {x.a, 0, 0}, coupler - x.from),
                hinge("C", "ground", "c", {x.g, 0, 0}, rocker)};
    loop.name = "B";
    loop.parent = "b";
    loop.child = "c";
    loop.origin_parent = {x.b, 0, 0};
    loop.origin_child = {x.c, 0, 0};
    drive.joint = "O";
  }
  s.loops = {loop};
  s.drives = {drive};
  if (x.pendulum) {
    s.bodies.push_back(rod("bob"));
    s.joints.push_back(hinge("M", "b", "bob", {0.5 * x.b, 0, 0}, 0.3));
  }
  if (x.tail) {
    const char* before = "b";
    for (const char* name : {"d", "e", "f"}) {
      s.bodies.push_back(rod(name));
      const bool first = before[0] == 'b';
      s.joints.push_back(hinge(std::string("joint of ") + name, before, name,
                               {first ? 0.5 * x.b : 1, 0, 0}, first ? 1 : -1));
      before = name;
    }
    loop.name = "tail";
    loop.parent = "ground";
    loop.child = "f";
    loop.origin_parent = {2, 1, 0};
    loop.origin_child = {1, 0, 0};
    s.loops.push_back(loop);
  }
  return s;
}

DriveSpec steady(double from, double rate) {
  DriveSpec d;
  d.kind = "polynomial";
  d.coefficients = {from, rate};
  return d;
}

RunResult run(const Mechanism& mechanism, const std::string& form, double end,
              const std::string& integrator = "", bool project = false) {
  RunRequest request =
      equations::stepped(form, integrator.empty() ? default_integrator(form, 1e-8) : integrator,
                         "leak:3", 1e-3, end, 50);
  request.settings.project = project;
  request.max_cpu_seconds = 200;
  return run_form(mechanism, start_of(mechanism), request);
}

TEST(InfeasibleDrives, EveryFormSaysTheSameTime) {
  FourBar x;
  x.law = steady(0.5, 1);
  const double exact = std::acos((5 - 1.8 * 1.8) / 4) - 0.5;
  for (const bool as_loop : {false, true})
    for (const int with : {0, 1, 2}) {
      x.as_loop = as_loop;
      x.pendulum = with == 1;
      x.tail = with == 2;
      const Mechanism mechanism(scene_of(x));
      const auto expect = [&](const RunResult& r, const std::string& what) {
        EXPECT_EQ(r.status, "failed") << what;
        EXPECT_NEAR(r.stopped_at, exact, 1e-8) << what;
        EXPECT_EQ(r.reason.rfind("drive of 'O' cannot go on at t = 0.615198 s: loop '", 0), 0U)
            << what << ": " << r.reason;
        EXPECT_GT(r.series.t.size(), 20U) << what;
        EXPECT_LT(r.position_drift_max, 1e-4) << what;
      };
      for (const std::string& form : form_names()) expect(run(mechanism, form, 1), form);
      for (const char* integrator : {"rk4", "dp5", "vern9", "gauss4"})
        expect(run(mechanism, "momentum", 1, integrator), integrator);
      expect(run(mechanism, "momentum", 1, "dop853", true), "momentum, projected");
      expect(run(mechanism, "acceleration", 1, "rk4", true), "acceleration, projected");
      expect(run(mechanism, "momentum-index2", 1, "radau5"), "radau5");
    }
  const Mechanism mechanism(scene_of({.law = steady(0.5, 1)}));
  EXPECT_NE(run(mechanism, "projected", 1).reason.find("(dead point of 'b' and 'c')"),
            std::string::npos);
}

/// A dead point is approached with rates that go to infinity, a change point is passed.
TEST(InfeasibleDrives, ChangePointsArePassed) {
  FourBar parallelogram{1, 2, 1, 2, 0.3, steady(0.3, 2), true};
  const Mechanism mechanism(scene_of(parallelogram));
  const auto start = start_of(mechanism);
  const DriveReach reach = drive_reach(mechanism, start.t, start.q, 10);
  EXPECT_EQ(reach.obstacle, "");
  EXPECT_EQ(reach.until, 10);
  EXPECT_TRUE(reach.determined);
}

/// A drive that comes to rest where rocker and coupler are stretched goes on, and they through the
/// line; to turn round there is another motion, which takes an impulse.
TEST(InfeasibleDrives, NoRunTurnsRoundWhereADriveTouchesADeadPoint) {
  FourBar x;
  const double widest = 1.2;
  x.from = 0.4;
  x.law.kind = "harmonic";
  x.law.offset = x.from;
  x.law.frequency = 2;
  const double d = std::sqrt(5 - 4 * std::cos(widest));
  x.c = d - x.b;
  for (const double part : {1.0, 0.9}) {
    x.law.amplitude = part * (widest - x.from);
    const Mechanism mechanism(scene_of(x));
    for (const char* form : {"partitioned", "projected", "momentum"}) {
      const RunResult r = run(mechanism, form, 1.5);
      EXPECT_TRUE(part == 1 || r.status == "done") << form << r.reason;
      if (r.status == "done") {
        EXPECT_LT(r.energy_error_max, 1e-3) << form << part;
      }
    }
  }
}

/// Three rods of 1 m between the ground and a slider that leaves at 1 m/s: stretched at t = 2 s,
/// with a freedom that forces move until then.
TEST(InfeasibleDrives, LoopsWithAFreedomLeftAreStretched) {
  Scene s;
  s.name = "three rods pulled";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod("a"), rod("b"), rod("c"), rod("slider")};
  s.joints = {hinge("A", "ground", "a", {0, 0, 0}, 0.9), hinge("B", "a", "b", {1, 0, 0}, -1.2),
              hinge("C", "b", "c", {1, 0, 0}, -0.6)};
  JointSpec slide = hinge("S", "ground", "slider", {1, 0, 0}, 0);
  slide.kind = JointKind::prismatic;
  slide.axis = {1, 0, 0};
  s.joints.push_back(slide);
  s.loops = {equations::make_loop(LoopKind::revolute, "D", "c", "slider", {1, 0, 0})};
  DriveSpec drive = steady(0, 1);
  drive.joint = "S";
  s.drives = {drive};
  const Mechanism mechanism(s);
  EXPECT_FALSE(drive_reach(mechanism, 0, start_of(mechanism).q, 3).determined);
  for (const std::string& form : form_names()) {
    const RunResult r = run(mechanism, form, 3);
    EXPECT_NE(r.status, "done") << form;
    EXPECT_EQ(r.reason.rfind("drive of 'S' cannot go on at t = ", 0), 0U) << form << r.reason;
    EXPECT_NEAR(r.stopped_at, 2, 2e-3) << form;
  }
}

using Uniform = std::function<double(double, double)>;

DriveSpec random_law(const Uniform& uniform, double from) {
  if (uniform(0, 1) < 0.5) return steady(from, uniform(-3, 3));
  DriveSpec d;
  d.kind = "harmonic";
  d.amplitude = uniform(0.1, 2);
  d.frequency = uniform(0.5, 4);
  d.offset = from;
  return d;
}

/// A scene and what geometry says of it: how far it is from where its loops open, in length.
struct Linkage {
  Scene scene;
  std::function<double(double)> room_at;  ///< of time
};

Linkage random_four_bar(const Uniform& uniform) {
  FourBar x{uniform(0.2, 2), uniform(0.2, 2), uniform(0.2, 2), uniform(0.5, 2), uniform(0, 6.28)};
  x.folded = uniform(0, 1) < 0.5;
  x.as_loop = uniform(0, 1) < 0.3;
  x.pendulum = uniform(0, 1) < 0.3;
  x.law = random_law(uniform, x.from);
  const auto room_at = [x](double t) { return room(x, law_at(x.law, t)); };
  return {room_at(0) > 0 ? scene_of(x) : Scene{}, room_at};
}

/// A crank a, a rod b, a slide along x at height e: closed where |a sin φ − e| ≤ b.
Linkage random_slider_crank(const Uniform& uniform) {
  const double a = uniform(0.2, 2), b = uniform(0.2, 2), e = uniform(-0.5, 0.5),
               from = uniform(0, 6.28), side = uniform(0, 1) < 0.5 ? 1 : -1;
  const DriveSpec law = random_law(uniform, from);
  const auto room_at = [=](double t) { return b - std::abs(a * std::sin(law_at(law, t)) - e); };
  if (!(room_at(0) > 0)) return {{}, room_at};
  Scene s;
  s.name = "slider-crank";
  s.gravity = {0, -9.81, 0};
  s.bodies = {rod_of("a", a), rod_of("b", b), rod("slider")};
  const double rise = std::asin((e - a * std::sin(from)) / b);
  const double coupler = side > 0 ? rise : std::numbers::pi - rise;
  s.joints = {
      hinge("O", "ground", "a", {0, 0, 0}, from), hinge("A", "a", "b", {a, 0, 0}, coupler - from),
      hinge("S", "ground", "slider", {0, e, 0}, a * std::cos(from) + b * std::cos(coupler))};
  s.joints.back().kind = JointKind::prismatic;
  s.joints.back().axis = {1, 0, 0};
  s.loops = {equations::make_loop(LoopKind::revolute, "B", "b", "slider", {b, 0, 0})};
  s.drives = {law};
  s.drives.back().joint = "O";
  return {s, room_at};
}

/// The tip B of a four-bar's rocker carries on with two rods more, d and f, to a hinge at G.
Linkage random_six_bar(const Uniform& uniform) {
  FourBar x{uniform(0.2, 2), uniform(0.2, 2), uniform(0.2, 2), uniform(0.5, 2), uniform(0, 6.28)};
  x.folded = uniform(0, 1) < 0.5;
  x.law = random_law(uniform, x.from);
  const double d = uniform(0.3, 2), f = uniform(0.3, 2);
  const Eigen::Vector2d G(uniform(1, 4), uniform(-1, 1));
  const double up = uniform(0, 1) < 0.5 ? 1 : -1;
  const auto tip = [x](double phi) {
    const Eigen::Vector2d A(x.a * std::cos(phi), x.a * std::sin(phi)), C(x.g, 0), way = C - A;
    const double r = way.norm(), cosine = (r * r + x.b * x.b - x.c * x.c) / (2 * r * x.b);
    const double at_a = std::acos(std::clamp(cosine, -1.0, 1.0));
    const double coupler = std::atan2(way.y(), way.x()) + (x.folded ? -at_a : at_a);
    return Eigen::Vector2d(A + x.b * Eigen::Vector2d(std::cos(coupler), std::sin(coupler)));
  };
  const auto room_at = [=](double t) {
    const double phi = law_at(x.law, t), first = room(x, phi), r = (tip(phi) - G).norm();
    return first > 0 ? std::min({first, d + f - r, r - std::abs(d - f)}) : first;
  };
  if (!(room_at(0) > 0)) return {{}, room_at};
  Scene s = scene_of(x);
  s.name = "six-bar";
  s.bodies.push_back(rod_of("d", d));
  s.bodies.push_back(rod_of("f", f));
  const Eigen::Vector2d B = tip(x.from), way = G - B;
  const double r = way.norm(), along = std::atan2(way.y(), way.x());
  const double second = along + up * std::acos((r * r + d * d - f * f) / (2 * r * d));
  const Eigen::Vector2d H = B + d * Eigen::Vector2d(std::cos(second), std::sin(second));
  const double rocker = s.joints[2].position[0];
  s.joints.push_back(hinge("E", "c", "d", {x.c, 0, 0}, second - rocker));
  s.joints.push_back(
      hinge("G", "ground", "f", {G.x(), G.y(), 0}, std::atan2(H.y() - G.y(), H.x() - G.x())));
  LoopSpec loop = s.loops[0];
  loop.name = "H";
  loop.parent = "d";
  loop.child = "f";
  loop.origin_parent = {d, 0, 0};
  loop.origin_child = {f, 0, 0};
  s.loops.push_back(loop);
  return {s, room_at};
}

/// In space: a crank a about z, a rocker c about x at (g, 0, h), their tips b apart. The rocker's
/// circle is at distances from the crank's tip of
///   √(Δx² + (ρ − c)²) … √(Δx² + (ρ + c)²),  ρ its distance from the rocker's axis.
Linkage random_spatial(const Uniform& uniform) {
  const double a = uniform(0.2, 2), b = uniform(0.5, 2.5), c = uniform(0.2, 2), g = uniform(0.3, 2),
               h = uniform(-1, 1), from = uniform(0, 6.28), side = uniform(0, 1) < 0.5 ? 1 : -1;
  const DriveSpec law = random_law(uniform, from);
  const auto room_at = [=](double t) {
    const double phi = law_at(law, t), dx = a * std::cos(phi) - g,
                 rho = std::hypot(a * std::sin(phi), h);
    return std::min(std::hypot(dx, rho + c) - b, b - std::hypot(dx, rho - c));
  };
  if (!(room_at(0) > 0)) return {{}, room_at};
  Scene s;
  s.name = "spatial four-bar";
  s.gravity = {0, 0, -9.81};
  s.bodies = {rod_of("a", a), rod_of("c", c)};
  const double y = a * std::sin(from), dx = a * std::cos(from) - g, rho = std::hypot(y, h);
  // |A − B|² = Δx² + ρ² + c² − 2 ρ c cos(ψ − angle of A about the rocker's axis)
  const double cosine = (dx * dx + rho * rho + c * c - b * b) / (2 * rho * c);
  const double psi = std::atan2(-h, y) + side * std::acos(std::clamp(cosine, -1.0, 1.0));
  s.joints = {hinge("O", "ground", "a", {0, 0, 0}, from),
              hinge("C", "ground", "c", {g, 0, h}, psi)};
  // The rocker's rod, along its x, turns about the joint's x from the joint's y.
  s.joints.back().axis = {1, 0, 0};
  s.bodies.back().com = Eigen::Vector3d(0, s.bodies.back().com.x(), 0);
  LoopSpec loop = equations::make_loop(LoopKind::distance, "B", "a", "c", {a, 0, 0}, {0, c, 0});
  loop.length = b;
  s.loops = {loop};
  s.drives = {law};
  s.drives.back().joint = "O";
  return {s, room_at};
}

/// Random linkages, random laws, a form each in turn: done exactly where the geometry says so, and
/// else stopped at its time. MOMENTA_CASES: how many.
void expect_verdicts_of(const std::function<Linkage(const Uniform&)>& make, unsigned seed,
                        int cases_in_suite) {
  const char* asked = std::getenv("MOMENTA_CASES");
  const int cases = asked ? std::atoi(asked) : cases_in_suite;
  std::mt19937 random(seed);
  const Uniform uniform = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  constexpr double end = 3;
  int feasible = 0, infeasible = 0, close = 0;
  for (int i = 0; i < cases; ++i) {
    const Linkage x = make(uniform);
    if (!(x.room_at(0) > 0.02)) {  // open, or next to a dead point, at the start
      --i;
      continue;
    }
    double closest = 0;
    const double exact = dead_point(x.room_at, end, closest);
    const auto& forms = form_names();
    const std::string form = forms[static_cast<std::size_t>(i) % forms.size()];
    const Mechanism mechanism(x.scene);
    const RunResult r = run(mechanism, form, end);
    const std::string what = x.scene.name + ", case " + std::to_string(i) + ", " + form + ": " +
                             r.status + ", " + r.reason + ", dead point at " +
                             std::to_string(exact) + ", room " + std::to_string(closest);
    // Touching a limit, or a motion between two limits too close to tell, is either.
    if (std::abs(closest) < 1e-6) {
      ++close;
      continue;
    }
    if (exact < end) {
      ++infeasible;
      EXPECT_EQ(r.status, "failed") << what;
      if (form == "partitioned" && asked && r.reason.find("dense output") != std::string::npos)
        continue;
      EXPECT_NEAR(r.stopped_at, exact, 1e-6) << what;
      EXPECT_NE(r.reason.find("cannot go on"), std::string::npos) << what;
    } else {
      ++feasible;
      // Close to a dead point forms may give up; none may be done with open loops. Where drives
      // move all there is, `partitioned` has no unknowns and no error to choose steps by: it takes
      // those its Newton method can follow, and gives up where the stages of a dense output can't
      // (two of 1250).
      if (closest > 0.01 && (form != "partitioned" || !asked)) {
        EXPECT_EQ(r.status, "done") << what;
      }
      if (r.status == "done") {
        EXPECT_LT(r.position_drift_max, 0.01) << what;
      }
      EXPECT_EQ(r.reason.find("cannot go on"), std::string::npos) << what;
    }
  }
  EXPECT_GT(feasible, cases / 8);
  EXPECT_GT(infeasible, cases / 8);
  std::printf("%d feasible, %d infeasible, %d at a limit\n", feasible, infeasible, close);
}

TEST(InfeasibleDrives, RandomFourBars) {
  expect_verdicts_of(random_four_bar, 2026, 250);
}

TEST(InfeasibleDrives, RandomSliderCranks) {
  expect_verdicts_of(random_slider_crank, 2027, 150);
}

TEST(InfeasibleDrives, RandomSixBars) {
  expect_verdicts_of(random_six_bar, 2028, 150);
}

TEST(InfeasibleDrives, RandomSpatialLoops) {
  expect_verdicts_of(random_spatial, 2029, 150);
}

}  // namespace
}  // namespace momenta::dae_infeasible_drives
