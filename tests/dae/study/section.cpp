// Poincaré sections of motions with a further integral lie on its curves, one a start, all of one
// energy; what cannot have the energy is left out.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/output/section_report.h>
#include <momenta/dae/study/column_named.h>
#include <momenta/dae/study/section_study.h>

#include <algorithm>
#include <cmath>

#include "equations/refusal.h"

namespace momenta::dae_section {
namespace {

Scene with_event(Scene scene, const std::string& when, const std::string& direction) {
  EventSpec event;
  event.when.text = when;
  event.direction = direction;
  scene.events = {event};
  return scene;
}

SectionRequest request_of(const std::string& form, double end) {
  SectionRequest request;
  request.settings.form = form;
  request.settings.integrator = "vern9";
  request.settings.gauge = form == "momentum" ? "none" : "";
  request.settings.rtol = request.settings.atol = 1e-12;
  request.settings.end_time = end;
  return request;
}

// Two oscillators that do not see each other: ẏ² + 5 y² is kept.
TEST(Section, OfTwoOscillatorsLiesOnEllipses) {
  const Mechanism mechanism(with_event(parse_scene(R"(
[lagrangian]
coordinates = ["x", "y"]
units = ["m", "m"]
position = [0, 0.3]
velocity = [1, 0]
kinetic = "(x.dot^2 + y.dot^2)/2"
potential = "(2*x^2 + 5*y^2)/2"
)",
                                                   "oscillators.toml"),
                                       "x", "up"));
  SectionRequest request = request_of("acceleration", 60);
  request.varied = "y";
  request.values = {0, 0.1, 0.4, 2};
  request.led = "x.dot";
  const std::vector<SectionOrbit> orbits = section(mechanism, request);
  ASSERT_EQ(orbits.size(), 4U);
  for (std::size_t k = 0; k < 3; ++k) {
    const SectionOrbit& orbit = orbits[k];
    ASSERT_EQ(orbit.run.status, "done") << orbit.run.reason;
    EXPECT_NEAR(orbit.energy, 0.5 + 2.5 * 0.09, 1e-14);
    // every 2π/√2, the start left out
    EXPECT_EQ(orbit.run.events.size(), 13U);
    const auto& columns = orbit.run.trajectory.columns;
    const std::size_t x = *column_named(columns, "x"), y = *column_named(columns, "y"),
                      rate = *column_named(columns, "y.dot");
    for (std::size_t i = 0; i < orbit.run.events.size(); ++i) {
      const std::vector<double>& row = orbit.run.events[i].row;
      EXPECT_NEAR(row[x], 0, 1e-11);
      EXPECT_NEAR(row[rate] * row[rate] + 5 * row[y] * row[y], 5 * orbit.value * orbit.value, 1e-9);
      EXPECT_NEAR(orbit.run.events[i].t,
                  static_cast<double>(i + 1) * 2 * std::acos(-1) / std::sqrt(2.0), 1e-9);
    }
  }
  EXPECT_TRUE(orbits[3].left_out.starts_with("no rate there has the energy"));
  const SectionPicture picture{"two", "x", "up", "y", "y [m]", "y.dot [m/s]"};
  const std::string csv = section_csv(picture, orbits);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 3 * 13);
  const std::string svg = section_svg(picture, orbits);
  std::size_t dots = 0;
  for (std::size_t at = 0; (at = svg.find("<circle", at)) != std::string::npos; ++at) ++dots;
  EXPECT_EQ(dots, 39U);
  EXPECT_EQ(section_json(picture, orbits)["points"], 39);
  EXPECT_EQ(section_json(picture, orbits)["starts"][3]["status"], "left out");
}

// A double pendulum without gravity keeps T and its angular momentum: where the elbow is stretched
// these two give both rates, the same at every passage.
TEST(Section, OfADoublePendulumWithoutGravityIsOnePoint) {
  const Mechanism mechanism(with_event(parse_scene(R"(
[[body]]
name = "a"
mass = 1
shape = { kind = "rod", length = 1 }
[[body]]
name = "b"
mass = 0.7
shape = { kind = "rod", length = 0.8 }
[[joint]]
name = "A"
kind = "revolute"
child = "a"
velocity = 2
[[joint]]
name = "B"
kind = "revolute"
parent = "a"
child = "b"
origin.parent = [1, 0, 0]
position = 0.4
velocity = 3
)",
                                                   "double.toml"),
                                       "sin(B.q/2)", "both"));
  for (const char* form : {"momentum", "acceleration"}) {
    const std::vector<SectionOrbit> orbits = section(mechanism, request_of(form, 30));
    ASSERT_EQ(orbits.size(), 1U);
    const RunResult& run = orbits[0].run;
    ASSERT_EQ(run.status, "done") << run.reason;
    ASSERT_GE(run.events.size(), 5U) << form;
    const auto& columns = run.trajectory.columns;
    const std::size_t u = *column_named(columns, "A.u"), w = *column_named(columns, "B.u");
    for (const FoundEvent& e : run.events) {
      // the elbow passes in both ways if it swings: rates by the sign of B.u
      for (const FoundEvent& other : run.events)
        if ((e.row[w] > 0) == (other.row[w] > 0)) {
          EXPECT_NEAR(e.row[u], other.row[u], 1e-8) << form;
          EXPECT_NEAR(e.row[w], other.row[w], 1e-8) << form;
        }
    }
  }
}

TEST(Section, RefusesNamesThatAreNone) {
  const Mechanism mechanism(with_event(parse_scene(R"(
[lagrangian]
coordinates = ["x"]
units = ["m"]
kinetic = "x.dot^2/2"
)",
                                                   "free.toml"),
                                       "x - 1", "up"));
  SectionRequest request = request_of("acceleration", 1);
  request.varied = "y";
  request.values = {1};
  EXPECT_THROW(section(mechanism, request), std::invalid_argument);
  request.varied = "x";
  request.led = "x";
  EXPECT_EQ(equations::thrown<std::invalid_argument>([&] { section(mechanism, request); }),
            "'x' is no rate of the scene, expected one of: x.dot");
}

}  // namespace
}  // namespace momenta::dae_section
