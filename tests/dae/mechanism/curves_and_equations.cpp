// Mechanisms with slots, cams, racks and equations move as the mechanisms that they stand for: by
// other joints and loops, in every form, or by formulas of the textbooks.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <numbers>

namespace momenta::dae_curves_and_equations {
namespace {

using Eigen::VectorXd;

Scene scene_of(const std::string& text) {
  return parse_scene("gravity = [0, -9.81, 0]\n" + text, "scene.toml");
}
std::string body(const std::string& name, double mass, const std::string& com = "[0, 0, 0]") {
  const std::string m = std::to_string(mass);
  return "[[body]]\nname = \"" + name + "\"\nmass = " + m + "\ncom = " + com +
         (mass > 0 ? "\ninertia = [0.1, 0.2, 0.3]\n" : "\n");
}
std::string joint(const std::string& name, const std::string& kind, const std::string& child,
                  const std::string& rest = "") {
  return "[[joint]]\nname = \"" + name + "\"\nkind = \"" + kind + "\"\nchild = \"" + child +
         "\"\n" + rest + "\n";
}
std::string loop(const std::string& name, const std::string& rest) {
  return "[[loop]]\nname = \"" + name + "\"\n" + rest + "\n";
}
std::string marker(const std::string& name, const std::string& of, const std::string& at) {
  return "[[marker]]\nname = \"" + name + "\"\nbody = \"" + of + "\"\npoint = " + at + "\n";
}

RunResult run_of(const Mechanism& mechanism, const std::string& form, double end) {
  RunRequest request;
  request.settings.form = form;
  if (is_dae_form(form)) request.settings.integrator = "ida";
  request.settings.rtol = request.settings.atol = is_dae_form(form) ? 1e-9 : 1e-11;
  if (form == "momentum") request.settings.gauge = "reset";
  request.settings.end_time = end;
  request.settings.samples = 20;
  request.keep_trajectory = true;
  return run_form(mechanism, assemble(mechanism).start, request);
}
double number(const RunResult& run, std::size_t row, const Mechanism& mechanism,
              const std::string& column) {
  std::vector<Column> all = mechanism.coordinate_columns();
  for (const auto& more : {mechanism.rate_columns(), mechanism.marker_columns()})
    all.insert(all.end(), more.begin(), more.end());
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].name == column) return run.trajectory.rows[row][1 + i];
  ADD_FAILURE() << "no column " << column;
  return 0;
}

bool has_massless(const Scene& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(),
                     [](const BodySpec& b) { return b.mass == 0; });
}

/// Every form that keeps to its velocities or positions moves both alike, and so closely keeps the
/// energy.
void expect_same_motion(const Scene& one, const Scene& other,
                        const std::vector<std::string>& columns, double end) {
  const Mechanism a(one), b(other);
  for (const std::string& form : form_names()) {
    if (form == "momentum-index3" || form == "acceleration-index3" || form == "momentum-index1" ||
        form == "acceleration-index1")
      continue;  // integrated to lower accuracy
    SCOPED_TRACE(form);
    const RunResult first = run_of(a, form, end), second = run_of(b, form, end);
    ASSERT_EQ(first.status, "done") << first.reason;
    if (form == "maximal-coordinates" && has_massless(other)) continue;  // no place for them
    ASSERT_EQ(second.status, "done") << second.reason;
    const double tolerance = is_dae_form(form) || form.starts_with("augmented") ? 2e-5 : 2e-7;
    for (const std::string& column : columns)
      for (std::size_t row : {std::size_t{7}, std::size_t{20}})
        EXPECT_NEAR(number(first, row, a, column), number(second, row, b, column), tolerance)
            << column;
    EXPECT_LT(first.energy_error_max, form == "baumgarte" ? 1e-4 : tolerance * 10);
  }
}

/// Starts are the same where assembly leaves the coordinate that the others follow.
std::string held(const std::string& name) {
  return "[assembly]\nhold = [\"" + name + "\"]\n";
}

const std::string yoke = body("crank", 1, "[0.1, 0, 0]") + body("yoke", 2) +
                         joint("O", "revolute", "crank", "position = 0.4\nvelocity = 5") +
                         joint("S", "prismatic", "yoke", "axis = \"x\"\nposition = 0.27");

TEST(Slots, AreBlocksOnSlides) {
  const Scene slot = scene_of(yoke + loop("pin", R"(
kind = "slot"
parent = "yoke"
child = "crank"
origin = { child = [0.3, 0, 0] }
axis = "y")") + held("O"));
  const Scene block =
      scene_of(yoke + body("block", 0) +
               joint("B", "prismatic", "block", "parent = \"yoke\"\naxis = \"y\"\nposition = 0.1") +
               loop("pin", R"(
kind = "revolute"
parent = "block"
child = "crank"
origin = { child = [0.3, 0, 0] })") +
               held("O"));
  expect_same_motion(slot, block, {"O.q", "S.q", "O.u"}, 1);
}

/// In a plane the rows are the same numbers.
TEST(Slots, OnCirclesAreDistances) {
  const std::string arms =
      body("a", 1, "[0.3, 0, 0]") + body("b", 2, "[0.1, 0.2, 0]") +
      joint("A", "revolute", "a", "position = 0.3\nvelocity = 1") +
      joint("B", "revolute", "b", "origin = { parent = [1.1, 0.2, 0] }\nposition = 2");
  const std::string ends =
      "parent = \"a\"\nchild = \"b\"\norigin = { parent = [0.5, 0.1, 0], "
      "child = [0.3, 0, 0] }\n";
  const Scene slot =
      scene_of(arms + loop("L", ends + "kind = \"slot\"\ncurve = \"circle\"\nradius = 0.45"));
  const Scene distance = scene_of(arms + loop("L", ends + "kind = \"distance\"\nlength = 0.45"));
  const Mechanism one(slot), other(distance);
  EXPECT_EQ(one.solver().kkt(), KktChoice::sweeps);
  const RunResult first = run_of(one, "momentum", 1), second = run_of(other, "momentum", 1);
  EXPECT_EQ(first.trajectory.rows, second.trajectory.rows);
}

/// In space: a light link about the axis of the circle, with a ball at its end.
TEST(Slots, OnCirclesAreLinksInSpace) {
  const std::string free =
      body("b", 2, "[0.1, 0.2, 0.1]") +
      joint("B", "free", "b",
            "position = [0.6, 0.1, -0.2, 1, 0, 0, 0]\nvelocity = [0, 0, 0, 0.3, 1, -0.4]");
  const std::string turn = "rotation = { axis = [1, 2, 3], angle = 0.8 }\n";
  const Scene slot = scene_of(free + loop("L", turn + R"(
kind = "slot"
curve = "circle"
radius = 0.7
child = "b"
origin = { child = [0.2, 0, 0] })"));
  const Scene link =
      scene_of(free + body("link", 0) + joint("R", "revolute", "link", turn + "position = 0.2") +
               loop("L", R"(
kind = "spherical"
parent = "link"
child = "b"
origin = { parent = [0.7, 0, 0], child = [0.2, 0, 0] })"));
  const Mechanism one(slot), other(link);
  EXPECT_EQ(one.m(), 2);
  // starts differ: both from the pose that the link leads to
  const RunResult led = run_of(other, "projected", 0.01);
  ASSERT_EQ(led.status, "done") << led.reason;
  Scene from = slot;
  Scene with = link;
  for (Scene* s : {&from, &with}) {
    for (int i = 0; i < 7; ++i)
      s->joints[0].position[static_cast<std::size_t>(i)] =
          led.trajectory.rows[0][1 + static_cast<std::size_t>(i)];
    for (int i = 0; i < 6; ++i)
      s->joints[0].velocity[static_cast<std::size_t>(i)] =
          number(led, 0, other, other.rate_columns()[static_cast<std::size_t>(i)].name);
  }
  with.joints[1].position = {number(led, 0, other, "R.q")};
  with.joints[1].velocity = {number(led, 0, other, "R.u")};
  std::vector<std::string> columns;
  for (int i = 0; i < 7; ++i)
    columns.push_back(Mechanism(from).coordinate_columns()[static_cast<std::size_t>(i)].name);
  expect_same_motion(from, with, columns, 0.5);
}

TEST(Cams, OfCirclesAreDistances) {
  const std::string arms =
      body("a", 1, "[0.3, 0, 0]") + body("b", 2, "[0.1, 0.2, 0]") +
      joint("A", "revolute", "a", "position = 0.3\nvelocity = 1") +
      joint("B", "revolute", "b", "origin = { parent = [1.1, 0.2, 0] }\nposition = 2");
  const std::string ends =
      "parent = \"a\"\nchild = \"b\"\norigin = { parent = [0.5, 0.1, 0], "
      "child = [0.3, 0, 0] }\n";
  const Scene cam = scene_of(arms + loop("L", ends + R"(kind = "cam"
profile = { parent = { kind = "circle", radius = 0.25 }, child = { kind = "circle", radius = 0.2 } })") +
                             held("A"));
  const Scene distance =
      scene_of(arms + loop("L", ends + "kind = \"distance\"\nlength = 0.45") + held("A"));
  expect_same_motion(cam, distance, {"A.q", "B.q", "B.u"}, 1);
}

const std::string slide_and_turn =
    body("b", 1, "[0.1, 0, 0]") +
    joint("P", "planar", "b", "position = [0.6, -0.8, 0.3]\nvelocity = [0.8, 0.6, 2]");

TEST(Equations, OfCirclesAreDistances) {
  const Scene equation =
      scene_of(slide_and_turn + marker("A", "b", "[0, 0, 0]") +
               loop("E", "kind = \"equation\"\nequation = \"A.x^2 + A.y^2 = 1\""));
  const Scene distance =
      scene_of(slide_and_turn + loop("E", "kind = \"distance\"\nchild = \"b\"\nlength = 1"));
  const std::vector<Column> all = Mechanism(distance).coordinate_columns();
  expect_same_motion(equation, distance, {all[0].name, all[1].name, all[2].name}, 1);
}

TEST(Equations, OfCoordinatesAreCouplers) {
  const std::string arms =
      body("a", 1, "[0.3, 0, 0]") + body("b", 2, "[0.1, 0.2, 0]") +
      joint("A", "revolute", "a", "position = 0.3\nvelocity = 1") +
      joint("B", "revolute", "b", "parent = \"a\"\norigin = { parent = [1, 0, 0] }");
  const Scene equation =
      scene_of(arms + loop("E", "kind = \"equation\"\nequation = \"A.q - 2 * B.q = 0.2\""));
  const Scene coupler = scene_of(
      arms +
      loop("E", "kind = \"coupler\"\njoints = [\"A\", \"B\"]\nratios = [1, -2]\noffset = 0.2"));
  expect_same_motion(equation, coupler, {"A.q", "B.q", "B.u"}, 1);
}

/// Φ_t: the time in an equation, and the same motion by a drive.
TEST(Equations, InTimeAreDrives) {
  const std::string arms =
      body("a", 1, "[0.3, 0, 0]") + body("b", 2, "[0.1, 0.2, 0]") + joint("A", "revolute", "a") +
      joint("B", "revolute", "b", "parent = \"a\"\norigin = { parent = [1, 0, 0] }");
  const Scene equation =
      scene_of(arms + loop("E", "kind = \"equation\"\nequation = \"A.q = 0.5 * sin(3 * t)\""));
  const Scene driven = scene_of(arms + R"(
[[drive]]
joint = "A"
kind = "harmonic"
amplitude = 0.5
frequency = 3
)");
  const Mechanism a(equation), b(driven);
  const RunResult truth = run_of(b, "acceleration", 1);
  ASSERT_EQ(truth.status, "done") << truth.reason;
  for (const char* form :
       {"momentum", "acceleration", "projected", "baumgarte", "stabilised-index2",
        "momentum-index2", "augmented-lagrangian", "maximal-coordinates"}) {
    SCOPED_TRACE(form);
    const RunResult run = run_of(a, form, 1);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_NEAR(number(run, 20, a, "B.q"), number(truth, 20, b, "B.q"), 2e-5);
    EXPECT_NEAR(number(run, 20, a, "A.q"), 0.5 * std::sin(3.0), 2e-5);
  }
}

/// Scotch yoke: the slide is r cos of the crank.
TEST(Textbook, ScotchYoke) {
  const Mechanism mechanism(scene_of(yoke + loop("pin", R"(
kind = "slot"
parent = "yoke"
child = "crank"
origin = { child = [0.3, 0, 0] }
axis = "y")")));
  const RunResult run = run_of(mechanism, "momentum", 1);
  ASSERT_EQ(run.status, "done") << run.reason;
  for (std::size_t row = 0; row <= 20; ++row)
    EXPECT_NEAR(number(run, row, mechanism, "S.q"),
                0.3 * std::cos(number(run, row, mechanism, "O.q")), 1e-8);
}

/// Elliptic trammel: both ends of a bar in slots at right angles; its points draw ellipses.
TEST(Textbook, EllipticTrammel) {
  const Mechanism mechanism(scene_of(
      body("bar", 1, "[0.5, 0, 0]") +
      joint("P", "planar", "bar", "position = [0.8, 0, 2.4]\nvelocity = [0.1, 0, 1]") +
      loop("along x", "kind = \"slot\"\nchild = \"bar\"\naxis = \"x\"") +
      loop("along y",
           "kind = \"slot\"\nchild = \"bar\"\naxis = \"y\"\norigin = { child = [1, 0, 0] }") +
      marker("M", "bar", "[0.3, 0, 0]")));
  const RunResult run = run_of(mechanism, "momentum", 2);
  ASSERT_EQ(run.status, "done") << run.reason;
  for (std::size_t row = 0; row <= 20; ++row) {
    const double x = number(run, row, mechanism, "M.x"), y = number(run, row, mechanism, "M.y");
    EXPECT_NEAR(x * x / 0.49 + y * y / 0.09, 1, 1e-7);
  }
}

/// Whitworth's quick return: a pin at r from its shaft in the slot of an arm whose shaft is at d
/// below; the arm's angle is atan2(d + r sin θ, r cos θ), and the arm is slow for 2 π − 2 acos(r/d)
/// of the crank's turn … here d > r.
TEST(Textbook, WhitworthQuickReturn) {
  const Mechanism mechanism(
      scene_of(body("crank", 1) + body("arm", 1, "[0.3, 0, 0]") +
               joint("O", "revolute", "crank", "origin = { parent = [0, 0.4, 0] }") +
               joint("Q", "revolute", "arm", "position = 1.1") + R"(
[[drive]]
joint = "O"
kind = "polynomial"
coefficients = [0, 6.283185307179586]
)" + loop("pin", R"(
kind = "slot"
parent = "arm"
child = "crank"
origin = { child = [0.2, 0, 0] }
axis = "x")")));
  const RunResult run = run_of(mechanism, "projected", 1);
  ASSERT_EQ(run.status, "done") << run.reason;
  for (std::size_t row = 0; row <= 20; ++row) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(row) / 20;
    EXPECT_NEAR(number(run, row, mechanism, "Q.q"),
                std::atan2(0.4 + 0.2 * std::sin(turn), 0.2 * std::cos(turn)), 1e-8);
  }
}

/// Disc cam with a flat follower: an ellipse with half axes a, b about its centre lifts the face by
/// its support function √(a² sin² θ + b² cos² θ); an eccentric circle by R + e sin θ.
TEST(Textbook, DiscCamWithFlatFollower) {
  const auto cam = [](const std::string& profile, const std::string& at) {
    return scene_of(body("cam", 2) + body("follower", 0.5) +
                    joint("O", "revolute", "cam", "position = 0.3\nvelocity = 6") +
                    joint("S", "prismatic", "follower", "axis = \"y\"\nposition = 0.1") +
                    loop("contact", "kind = \"cam\"\nparent = \"cam\"\nchild = \"follower\"\n" +
                                        at + "profile = { parent = { " + profile +
                                        " }, child = { kind = \"flat\", normal = \"-y\" } }"));
  };
  const Mechanism ellipse(cam("kind = \"ellipse\", semi_axes = [0.1, 0.06]", ""));
  const Mechanism circle(
      cam("kind = \"circle\", radius = 0.08", "origin = { parent = [0.03, 0, 0] }\n"));
  for (const char* form : {"momentum", "projected", "stabilised-index2", "maximal-coordinates"}) {
    SCOPED_TRACE(form);
    const RunResult one = run_of(ellipse, form, 1), other = run_of(circle, form, 1);
    ASSERT_EQ(one.status, "done") << one.reason;
    ASSERT_EQ(other.status, "done") << other.reason;
    EXPECT_LT(one.energy_error_max, 1e-5);
    for (std::size_t row = 0; row <= 20; ++row) {
      double turn = number(one, row, ellipse, "O.q");
      EXPECT_NEAR(number(one, row, ellipse, "S.q"),
                  std::hypot(0.1 * std::sin(turn), 0.06 * std::cos(turn)), 1e-7);
      turn = number(other, row, circle, "O.q");
      EXPECT_NEAR(number(other, row, circle, "S.q"), 0.08 + 0.03 * std::sin(turn), 1e-7);
    }
  }
}

/// A wheel on a line, held at its distance by a slot: it rolls down as a body with the inertia of
/// both motions, x = g sin(slope) t² / (2 (1 + I / (m r²))).
TEST(Textbook, WheelRollsDown) {
  const double slope = 0.4, r = 0.25;
  const Mechanism mechanism(
      scene_of(body("wheel", 2) + joint("P", "planar", "wheel", "position = [0.0974, 0.2303, 0]") +
               loop("height",
                    "kind = \"slot\"\nchild = \"wheel\"\naxis = \"x\"\nrotation = { axis = \"z\", "
                    "angle = -0.4 }\n"
                    "origin = { parent = [0.09735458557716263, 0.23026524850072128, 0] }") +
               loop("rolling",
                    "kind = \"rack\"\nchild = \"wheel\"\nradius = 0.25\nrotation = { axis = \"z\", "
                    "angle = -0.4 }\noffset = 0.4")));
  const RunResult run = run_of(mechanism, "momentum", 2);
  ASSERT_EQ(run.status, "done") << run.reason;
  const auto columns = mechanism.coordinate_columns();
  const double start = number(run, 0, mechanism, columns[2].name);
  const double way = 9.81 * std::sin(slope) * 4 / 2 / (1 + 0.3 / (2 * r * r));
  EXPECT_NEAR(number(run, 20, mechanism, columns[2].name) - start, -way / r, 1e-6);
}

/// Forms that hold Φ̈ = 0 alone drift with t², those on momenta with t at most; splines too, whose
/// third derivatives jump.
TEST(Slots, OnSplinesDriftAsLoopsDo) {
  const Mechanism mechanism(
      scene_of(body("b", 1, "[0.1, 0, 0]") +
               joint("P", "planar", "b", "position = [0.4, 0.1, 0]\nvelocity = [0, 1, 3]") +
               loop("groove", R"(
kind = "slot"
curve = "spline"
closed = true
points = [[0.5, 0, 0], [0.3, 0.35, 0], [-0.1, 0.45, 0], [-0.45, 0.1, 0], [-0.3, -0.4, 0], [0.2, -0.35, 0]]
child = "b")")));
  for (const char* form : {"momentum", "projected", "acceleration", "stabilised-index2",
                           "momentum-index2", "baumgarte", "maximal-coordinates"}) {
    SCOPED_TRACE(form);
    const RunResult run = run_of(mechanism, form, 3);
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_LT(run.position_drift_max, 1e-6);
    EXPECT_LT(run.energy_error_max, 2e-5);
  }
}

}  // namespace
}  // namespace momenta::dae_curves_and_equations
