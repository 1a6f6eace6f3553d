// Events: roots of numbers along runs. The search against a slow twin, bisection on a fine grid;
// times that are known; one time in every form and integrator; what is no event.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/event/crossings.h>
#include <momenta/dae/run/run_form.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "equations/examples.h"
#include "equations/parts.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

namespace momenta::dae_events {
namespace {

using equations::example;
using std::numbers::pi;
using Number = std::function<double(double)>;

std::vector<Crossing> found_in(const std::vector<double>& steps, const Number& g) {
  Crossings crossings(1e-14);
  std::vector<Crossing> found;
  for (std::size_t k = 1; k < steps.size(); ++k) {
    Crossings::Values values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = g(Crossings::point(steps[k - 1], steps[k], i));
    crossings.step(steps[k - 1], steps[k], values, g, found);
  }
  return found;
}

/// The twin: signs on a grid so fine that nothing turns back in a cell, then bisection.
std::vector<Crossing> bisected(double from, double to, const Number& g) {
  constexpr int cells = 200000;
  std::vector<Crossing> found;
  double a = from, at_a = g(a);
  for (int k = 1; k <= cells; ++k) {
    double b = from + (to - from) * k / cells;
    const double next = b, at_b = g(b);
    if ((at_a < 0) != (at_b < 0)) {
      double low = a;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + b);
        ((g(middle) < 0) == (at_a < 0) ? low : b) = middle;
      }
      found.push_back({low, at_b > 0});
    }
    a = next, at_a = at_b;
  }
  return found;
}

void expect_same(const std::vector<Crossing>& found, const std::vector<Crossing>& twin,
                 double bound) {
  ASSERT_EQ(found.size(), twin.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].t, twin[i].t, bound) << i;
    EXPECT_EQ(found[i].up, twin[i].up) << i;
  }
}

// Sums of waves with several roots a step, on steps of any lengths.
TEST(Crossings, AreThoseOfBisectionOnAFineGrid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  std::size_t roots = 0;
  for (int wave = 0; wave < 40; ++wave) {
    double a[4], f[4], s[4];
    for (int i = 0; i < 4; ++i) a[i] = any(random), f[i] = 40 * any(random), s[i] = 3 * any(random);
    const double offset = 0.3 * any(random);
    const Number g = [&](double t) {
      double sum = offset;
      for (int i = 0; i < 4; ++i) sum += a[i] * std::sin(f[i] * t + s[i]);
      return sum;
    };
    std::vector<double> steps{0};
    while (steps.back() < 3) steps.push_back(steps.back() + 0.4 * (1.01 + any(random)));
    const std::vector<Crossing> twin = bisected(0, steps.back(), g);
    roots += twin.size();
    expect_same(found_in(steps, g), twin, 1e-12);
  }
  EXPECT_GT(roots, 250U);
}

// Two roots apart by less than the points of a step are, wherever they lie in it; none where the
// minimum stays above zero by as little.
TEST(Crossings, OfPairsOfRootsInOneStep) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (const double apart : {1e-1, 1e-2, 1e-3, 1e-5})
    for (int k = 0; k < 50; ++k) {
      const double at = 0.01 + 0.98 * any(random);
      const Number g = [&](double t) {
        return (std::cos(t - at) - std::cos(0.5 * apart)) * (2 + std::sin(3 * t));
      };
      const auto found = found_in({0, 1}, g);
      const bool both = at - apart / 2 > 0 && at + apart / 2 < 1;
      if (!both) continue;
      ASSERT_EQ(found.size(), 2U) << apart << " " << at;
      EXPECT_NEAR(found[0].t, at - 0.5 * apart, 1e-11 / apart);
      EXPECT_NEAR(found[1].t, at + 0.5 * apart, 1e-11 / apart);
      EXPECT_TRUE(found[0].up && !found[1].up);
      EXPECT_TRUE(found_in({0, 1}, [&](double t) {
                    return 2 - std::cos(t - at) - std::cos(0.5 * apart);
                  }).empty());
    }
}

TEST(Crossings, AreNoneAtTheStartAtPolesAndWhereZeroIsTouched) {
  EXPECT_TRUE(found_in({0, 0.7, 2}, [](double t) { return t; }).empty());
  EXPECT_TRUE(found_in({0, 0.7, 2}, [](double t) { return 1e-17 - t * t; }).empty());
  EXPECT_TRUE(found_in({0, 0.7, 2}, [](double t) { return 1 / (t - 1.1); }).empty());
  EXPECT_TRUE(found_in({0, 1, 2}, [](double t) { return (t - 1) * (t - 1); }).empty());
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(found_in({0, 1, 3}, [&](double t) { return t < 2 ? none : t - 1.5; }).empty());
  // a jump, a root at a step's end, zero for a while
  expect_same(found_in({0, 1, 2}, [](double t) { return t < 1.3 ? -1 : 2; }), {{1.3, true}}, 1e-12);
  expect_same(found_in({0, 1, 2}, [](double t) { return 1 - t; }), {{1, false}}, 0);
}

// Roots right behind the edge of where a number has a value, whatever the steps.
TEST(Crossings, BesideTheEdgeOfValues) {
  for (const double step : {0.05, 0.3, 1.0}) {
    std::vector<double> times{0};
    while (times.back() < 1) times.push_back(times.back() + step);
    expect_same(found_in(times, [](double t) { return std::sqrt(t - 0.5) - 0.1; }), {{0.51, true}},
                1e-12);
    expect_same(found_in(times, [](double t) { return std::sqrt(0.5 - t) - 0.1; }), {{0.49, false}},
                1e-12);
  }
}

// A number that stays zero for some steps crosses where it leaves zero, in the step in which that
// is told: of steps before it no dense output is left.
TEST(Crossings, OfANumberThatStaysZeroAreWhereItLeavesIt) {
  for (const double end : {2.0, 2.3, 2.99}) {
    const Number g = [&](double t) { return t < 1 ? t - 1 : t <= end ? 0 : t - end; };
    expect_same(found_in({0, 1, 2, 3}, g), {{end, true}}, 1e-12);
    expect_same(found_in({0, 0.7, 3}, g), {{end, true}}, 1e-12);
    expect_same(found_in({0, 1, 2, 3}, [&](double t) { return -g(t); }), {{end, false}}, 1e-12);
    EXPECT_TRUE(found_in({0, 1, 2, 3}, [&](double t) { return std::abs(g(t)); }).empty());
  }
  for (const double left : {0.1, 1.2, 2.7}) {
    Crossings behind(1e-14);
    behind.restart_below_zero(0);
    for (int k = 0; k < 3; ++k) {
      const Number g = [&](double t) { return t <= left ? 0 : t - left; };
      Crossings::Values values;
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = g(Crossings::point(k, k + 1, i));
      std::vector<Crossing> found;
      behind.step(k, k + 1, values, g, found);
      ASSERT_EQ(found.size(), left > k && left < k + 1 ? 1U : 0U) << left << " " << k;
      for (const Crossing& c : found) EXPECT_NEAR(c.t, left, 1e-12);
    }
  }
}

// A correction after a step that moves g through zero: the crossing is there; one that moves it
// back after a crossing is none.
TEST(Crossings, ThatACorrectionMakesAreToldOnce) {
  for (const double moved : {-1e-3, 1e-3}) {
    Crossings crossings(1e-14);
    std::vector<Crossing> found;
    const auto step = [&](double t0, double t1, const Number& g) {
      Crossings::Values values;
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = g(Crossings::point(t0, t1, i));
      crossings.step(t0, t1, values, g, found);
    };
    const double end = 1 - 0.5 * moved;  // g there is −moved/2: not yet, or beyond
    step(0, end, [](double t) { return t - 1; });
    step(end, 2, [&](double t) { return t - 1 + moved; });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].t, moved > 0 ? end : 1, 1e-12);
    EXPECT_TRUE(found[0].up);
  }
}

/// A slide in free fall, thrown up: q = 3 t − 5 t².
Scene thrown(const std::string& events) {
  return parse_scene(R"(
gravity = [0, 0, -10]
[[body]]
name = "a"
mass = 2
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "A"
kind = "prismatic"
child = "a"
velocity = 3
[[marker]]
name = "P"
body = "a"
point = [0, 0, 1]
)" + events,
                     "thrown.toml");
}

RunRequest request_of(const std::string& form, const std::string& integrator, double end,
                      double tolerance = 1e-10) {
  RunRequest request = equations::kept(
      equations::adaptive(form, integrator, takes_gauge(form) ? "none" : "", tolerance, end, 3));
  request.events = true;
  return request;
}

RunResult run(const Scene& scene, const RunRequest& request) {
  const Mechanism mechanism(scene);
  return run_form(mechanism, assemble(mechanism).start, request);
}

TEST(Events, OfAThrownSlideAreThoseOfItsParabola) {
  const Scene scene = thrown(R"(
[[event]]
name = "height"
when = "A.q - 0.4"
[[event]]
name = "top"
when = "P.vz"
direction = "down"
[[event]]
name = "never"
when = "P.z - 1.46"
[[event]]
name = "falls"
when = "P.z - 1 + 0.2*t"
direction = "down"
)");
  const RunResult result = run(scene, request_of("momentum", "dop853", 1));
  ASSERT_EQ(result.status, "done");
  std::vector<std::pair<std::string, double>> told;
  for (const FoundEvent& e : result.events) told.emplace_back(e.name, e.t);
  // 3 t − 5 t² = 0.4 at 0.2 and 0.4; ż = 0 at 0.3; 3 t − 5 t² = −0.2 t at 0.64
  const std::vector<std::pair<std::string, double>> known{
      {"height", 0.2}, {"top", 0.3}, {"height", 0.4}, {"falls", 0.64}};
  ASSERT_EQ(told.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_EQ(told[i].first, known[i].first);
    EXPECT_NEAR(told[i].second, known[i].second, 1e-12) << i;
  }
  EXPECT_TRUE(result.events[0].up);
  EXPECT_FALSE(result.events[2].up);
  const FoundEvent& first = result.events[0];
  ASSERT_EQ(first.row.size(), result.trajectory.columns.size());
  EXPECT_EQ(first.row[0], first.t);
  EXPECT_NEAR(first.row[1], 0.4, 1e-12);  // A.q
  EXPECT_NEAR(first.row[2], 1, 1e-12);    // A.u
}

// Each integrator with a form it takes, to its order and tolerance. The parabola is exact in all.
TEST(Events, OfAThrownSlideInEveryIntegrator) {
  const Scene scene = thrown("[[event]]\nwhen = \"A.q - 0.4\"\n");
  for (const Integrator& integrator : integrators()) {
    const std::string form = !integrator.forms.empty()                    ? integrator.forms[0]
                             : integrator.takes == Integrator::Takes::ode ? "momentum"
                                                                          : "momentum-index2";
    RunRequest request = request_of(form, integrator.name, 1);
    if (integrator.step == Integrator::Step::fixed) request.settings.step = 0.01;
    const RunResult result = run(scene, request);
    ASSERT_EQ(result.status, "done") << integrator.name << result.reason;
    ASSERT_EQ(result.events.size(), 2U) << integrator.name;
    const double bound = integrator.step == Integrator::Step::fixed ? 1e-5
                         : integrator.multistep                     ? 1e-7
                                                                    : 1e-9;
    EXPECT_NEAR(result.events[0].t, 0.2, bound) << integrator.name;
    EXPECT_NEAR(result.events[1].t, 0.4, bound) << integrator.name;
  }
}

// A four-bar: the crank passes an angle in every form, at the time of the most accurate run but for
// what the form's own motion is off: |Δt| ≤ |Δq|/|q̇|.
TEST(Events, OfAFourBarAreAtOneTimeInEveryForm) {
  Scene scene = example("four_bar");
  EventSpec event;
  event.when.text = "O.q - " + std::to_string(scene.joints[0].position[0] + 0.4);
  scene.events = {event};
  const auto crank = [&](const std::string& form, const std::string& integrator, double tolerance) {
    RunRequest request = request_of(form, integrator, 4, tolerance);
    request.settings.samples = 400;
    return run(scene, request);
  };
  const RunResult exact = crank("momentum", "vern9", 1e-13);
  ASSERT_GE(exact.events.size(), 2U);
  for (const std::string& form : form_names()) {
    const RunResult result = crank(form, "", 1e-9);
    ASSERT_EQ(result.status, "done") << form << result.reason;
    ASSERT_EQ(result.events.size(), exact.events.size()) << form;
    double off = 0;  // of O.q, column 1
    for (std::size_t i = 0; i < exact.trajectory.rows.size(); ++i)
      off = equations::larger(off,
                              std::abs(result.trajectory.rows[i][1] - exact.trajectory.rows[i][1]));
    EXPECT_LT(off, 0.05) << form;
    for (std::size_t i = 0; i < exact.events.size(); ++i) {
      const double rate = std::abs(exact.events[i].row[4]);  // O.u, behind O.q, A.q, C.q
      EXPECT_NEAR(result.events[i].t, exact.events[i].t, 1e-9 + 1.5 * off / rate) << form;
    }
  }
}

// T = 4 √(l/g) K(sin(q₀/2)), and no sample has a part in it.
TEST(Events, OfAPendulumAreItsPeriodApartWhateverTheSamples) {
  Scene scene = example("pendulum");
  scene.joints[0].position = {-0.5 * pi + 2};
  EventSpec event;
  event.when.text = "O.q + pi/2";
  event.direction = "up";
  scene.events = {event};
  RunRequest request = request_of("momentum", "vern9", 12, 1e-13);
  const RunResult few = run(scene, request);
  request.settings.samples = 997;
  const RunResult many = run(scene, request);
  const double period = 4 * std::sqrt(1 / 9.81) * std::comp_ellint_1(std::sin(1.0));
  ASSERT_GE(few.events.size(), 4U);
  ASSERT_EQ(few.events.size(), many.events.size());
  for (std::size_t i = 0; i < few.events.size(); ++i) {
    EXPECT_NEAR(few.events[i].t, (0.75 + static_cast<double>(i)) * period, 1e-10);
    EXPECT_EQ(few.events[i].t, many.events[i].t);
    EXPECT_TRUE(few.events[i].up);
  }
}

// Samples up to it and one there; what is measured beyond it is left out.
TEST(Events, EndARun) {
  const Scene scene = thrown(
      "[[event]]\nname = \"down again\"\nwhen = \"A.q - 0.4\"\ndirection = \"down\"\nstop = true\n"
      "[[event]]\nname = \"later\"\nwhen = \"A.q - 0.399999\"\n");
  for (const char* integrator : {"dop853", "rk4"}) {
    RunRequest request = request_of("momentum", integrator, 1);
    request.settings.step = 0.05;
    request.settings.samples = 10;
    request.film_intervals = 20;
    const RunResult result = run(scene, request);
    EXPECT_EQ(result.status, "event");
    EXPECT_EQ(result.reason, "event 'down again' (down) ended the run at t = 0.4 s");
    EXPECT_TRUE(finished(result));
    EXPECT_NEAR(result.stopped_at, 0.4, 1e-11);
    ASSERT_EQ(result.series.t.size(), 5U);  // 0, 0.1 … 0.3, 0.4
    EXPECT_NEAR(result.series.t.back(), result.stopped_at, 1e-11);
    EXPECT_EQ(result.trajectory.rows.back()[0], result.series.t.back());
    EXPECT_NEAR(result.trajectory.rows.back()[1], 0.4, 1e-12);
    EXPECT_EQ(result.events.size(), 2U);  // "later" on the way up, and this one
    EXPECT_LE(result.film.frames.size(), 9U);
  }
  RunRequest without = request_of("momentum", "dop853", 1);
  without.events = false;
  const RunResult whole = run(scene, without);
  EXPECT_EQ(whole.status, "done");
  EXPECT_TRUE(whole.events.empty());
}

// Lengths of springs, their rates, sums, driven coordinates, against markers and laws.
TEST(Events, OfLengthsSumsAndDrivenCoordinates) {
  const Scene scene = thrown(R"(
[[body]]
name = "b"
mass = 1
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "B"
kind = "prismatic"
child = "b"
axis = "x"
[[drive]]
joint = "B"
kind = "polynomial"
coefficients = [0, 2]
[[force]]
name = "S"
kind = "spring-damper"
parent = "b"
child = "a"
[[force]]
name = "C"
kind = "coordinate-spring"
joints = ["A", "B"]
ratios = [2, 1]
[[marker]]
name = "Q"
body = "b"
[[event]]
name = "length"
when = "S.length - 0.5"
[[event]]
name = "length by markers"
when = "(Q.x - P.x)^2 + (Q.z - P.z + 1)^2 - 0.25"
[[event]]
name = "rate"
when = "S.rate - 2.1"
[[event]]
name = "rate by markers"
when = "(Q.x*Q.vx + (P.z - 1)*P.vz)/hypot(Q.x, P.z - 1) - 2.1"
[[event]]
name = "sum"
when = "C.l - 0.5"
[[event]]
name = "sum by joints"
when = "2*A.q + B.q - 0.5"
[[event]]
name = "sum's rate"
when = "C.rate - B.u - 1"
[[event]]
name = "driven"
when = "B.q - 0.7"
)");
  const RunResult result = run(scene, request_of("momentum", "vern9", 1, 1e-13));
  ASSERT_EQ(result.status, "done") << result.reason;
  const auto times = [&](const std::string& name) {
    std::vector<double> all;
    for (const FoundEvent& e : result.events)
      if (e.name == name) all.push_back(e.t);
    EXPECT_FALSE(all.empty()) << name;
    return all;
  };
  const auto same = [&](const std::string& a, const std::string& b) {
    const auto x = times(a), y = times(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], 1e-12);
  };
  same("length", "length by markers");
  same("rate", "rate by markers");
  same("sum", "sum by joints");
  EXPECT_NEAR(times("sum's rate")[0], 0.25, 1e-12);  // 2 (3 − 10 t) = 1
  EXPECT_NEAR(times("driven")[0], 0.35, 1e-12);
}

// Of formulas: x" = −x from x = 1, ẋ = 0, whatever names there are for it.
TEST(Events, OfALagrangian) {
  const Scene scene = parse_scene(R"(
[parameters]
half = 0.5
[lagrangian]
coordinates = ["x"]
units = ["m"]
position = [1]
kinetic = "x.dot^2/2"
potential = "x^2/2"
[[event]]
name = "half"
when = "x - half"
[[event]]
name = "turns"
when = "cos(0*t)*x.dot"
)",
                                  "oscillator.toml");
  const RunResult result = run(scene, request_of("acceleration", "vern9", 4, 1e-13));
  ASSERT_EQ(result.status, "done") << result.reason;
  ASSERT_EQ(result.events.size(), 2U);
  EXPECT_NEAR(result.events[0].t, pi / 3, 1e-11);
  EXPECT_NEAR(result.events[1].t, pi, 1e-11);
  EXPECT_EQ(result.events[1].name, "turns");
}

// Where a formula has no value no event is, and it is told once.
TEST(Events, WithoutValuesAreTold) {
  const RunResult result = run(thrown("[[event]]\nname = \"root\"\nwhen = \"sqrt(A.q + 1) - 5\"\n"),
                               request_of("momentum", "dop853", 1));
  EXPECT_EQ(result.status, "done");
  EXPECT_TRUE(result.events.empty());
  ASSERT_EQ(result.event_remarks.size(), 1U);
  EXPECT_EQ(result.event_remarks[0].substr(0, 52),
            "event 'root': 'sqrt(A.q + 1) - 5' has no value at t ");
  Scene wrong = thrown("");
  EventSpec event;
  event.when.text = "A.v";
  wrong.events = {event};
  EXPECT_THROW(run(wrong, request_of("momentum", "dop853", 1)), std::exception);
  wrong.events[0].when.text = "A.u";
  wrong.events[0].direction = "sideways";
  EXPECT_THROW(run(wrong, request_of("momentum", "dop853", 1)), SceneError);
}

// Everything is driven: nothing is integrated, and events are found all the same.
TEST(Events, WhereNothingIsIntegrated) {
  Scene scene = thrown("[[event]]\nwhen = \"A.q - 0.3\"\n");
  scene.drives = {equations::polynomial("A", {0, 0, 1})};
  const RunResult result = run(scene, request_of("momentum", "dop853", 1));
  EXPECT_EQ(result.status, "done");
  ASSERT_EQ(result.events.size(), 1U);
  EXPECT_NEAR(result.events[0].t, std::sqrt(0.3), 1e-12);
}

}  // namespace
}  // namespace momenta::dae_events
