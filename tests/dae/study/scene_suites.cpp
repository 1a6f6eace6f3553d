// Suites of mechanisms: errors are what their definitions say; the reference of the row of
// four-bars is the motion of one rod of the same period; errors fall with tolerances; what is amiss
// in a suite is told in a sentence.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/output/submission.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/scene_suite.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "equations/refusal.h"
#include "equations/scene_folder.h"

namespace momenta::dae_scene_suites {
namespace {

using equations::sentence_of;
using Kind = BenchmarkError::Kind;

std::filesystem::path example(const std::string& file) {
  return std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / file;
}

TEST(BenchmarkErrors, AreWhatTheirDefinitionsSay) {
  // |y − r| / max(|r|, s): 0.1/2, 0.1/0.5, 0.3/4. Root of the mean of squares.
  BenchmarkError threshold(Kind::threshold, 0.5);
  threshold.add(2.1, 2);
  threshold.add(0.1, 0);
  threshold.add(-4.3, -4);
  EXPECT_NEAR(threshold.value(), std::sqrt((0.05 * 0.05 + 0.2 * 0.2 + 0.075 * 0.075) / 3), 1e-15);
  BenchmarkError mixed(Kind::mixed, 0.5);
  mixed.add(2.1, 2);
  mixed.add(0.1, 0);
  mixed.add(-4.3, -4);
  EXPECT_NEAR(mixed.value(), 0.1, 1e-15);
}

TEST(BenchmarkErrors, NothingIsNoErrorAndNotANumberStays) {
  for (const Kind kind : {Kind::threshold, Kind::mixed}) {
    BenchmarkError error(kind, 1e-3);
    EXPECT_TRUE(std::isnan(error.value()));
    error.add(1, 1);
    EXPECT_EQ(error.value(), 0);
    error.add(std::numeric_limits<double>::quiet_NaN(), 1);
    error.add(1, 1);
    EXPECT_TRUE(std::isnan(error.value()));
  }
}

RunResult run_of(const std::vector<double>& times, const std::vector<double>& x) {
  RunResult run;
  run.trajectory.columns = {"t [s]", "y [m]", "x [m]"};
  for (std::size_t i = 0; i < times.size(); ++i) run.trajectory.rows.push_back({times[i], 7, x[i]});
  return run;
}

TEST(BenchmarkErrors, OfRunsAreThoseOfTheirColumnsAfterTheStart) {
  const Reference reference("here", {"x [m]"}, {0, 1, 2}, {{5}, {1}, {3}});
  const BenchmarkError mixed(Kind::mixed, 1);
  // The start, 4 off, is given: only what was integrated counts.
  EXPECT_NEAR(error_of(run_of({0, 1, 2}, {9, 1, 3.4}), reference, {"x [m]"}, mixed), 0.1, 1e-15);
  RunResult failed = run_of({0, 1, 2}, {5, 1, 3});
  failed.status = "failed";
  EXPECT_TRUE(std::isnan(error_of(failed, reference, {"x [m]"}, mixed)));
  EXPECT_NE(sentence_of([&] {
              (void)error_of(run_of({0, 1, 2.5}, {5, 1, 3}), reference, {"x [m]"}, mixed);
            }).find("found t = 2 s, expected 2.5 s"),
            std::string::npos);
  EXPECT_NE(sentence_of([&] {
              (void)error_of(run_of({0, 1}, {5, 1}), reference, {"x [m]"}, mixed);
            }).find("found 3 times, expected the 2 of the run"),
            std::string::npos);
}

// The parallelogram motion of N four-bars obeys φ'' = λ sin φ, λ = 3(3N + 1)/(2(4N + 1)) g/L: that
// of a compound pendulum with m g c / (I + m c²) = λ. Its motion in quadruple precision is a twin
// of the closed formula behind the reference.
TEST(SceneSuites, TheRowOfFourBarsSwingsAsOneRodOfItsPeriod) {
  const Reference closed(example("suites/iftomm/n_four_bar.csv"));
  ASSERT_EQ(closed.columns().front(), "B0.x [m]");
  const Mechanism rod(parse_scene(R"(
gravity = [0, -9.81, 0]
[parameters]
N = 40
c = 0.5
[[body]]
name = "rod"
mass = 1
com = ["c", 0, 0]
inertia = "c*2*(4*N + 1)/(3*(3*N + 1)) - c^2"
[[joint]]
name = "O"
kind = "revolute"
child = "rod"
axis = "z"
position = "pi/2"
velocity = -1
)"));
  const int count = 60;  // of the 400 outputs, to 3 s
  const OwnReference own = own_reference(rod, assemble(rod).start, 0.05 * count, count);
  ASSERT_EQ(own.reference.columns().front(), "O.q [rad]");
  for (int i = 0; i <= count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double angle = own.reference.values()[k][0], rate = own.reference.values()[k][1];
    const std::vector<double>& b0 = closed.values()[k];
    EXPECT_NEAR(closed.times()[k], own.reference.times()[k], 1e-14);
    EXPECT_NEAR(b0[0], std::cos(angle), 1e-13);
    EXPECT_NEAR(b0[1], std::sin(angle), 1e-13);
    EXPECT_NEAR(b0[2], -rate * std::sin(angle), 1e-12);
    EXPECT_NEAR(b0[3], rate * std::cos(angle), 1e-12);
  }
}

TEST(SceneSuites, ErrorsFallWithTolerancesWithinWhatSourcesAllow) {
  SceneSuite suite = read_scene_suite(example("suites/iftomm/suite.toml"));
  ASSERT_EQ(suite.problems.size(), 6u);
  suite.problems.resize(3);
  for (SceneProblem& problem : suite.problems) {
    problem.forms = {"momentum", "projected"};
    problem.tolerances = {1e-5, 1e-9};
  }
  SceneSuiteRequest request;
  request.timing = Timing::none;
  const SceneSuiteResult result = run_suite(suite, request);
  ASSERT_EQ(result.problems.size(), 3u);
  EXPECT_TRUE(result.complete);
  for (const SceneProblemResult& p : result.problems) {
    SCOPED_TRACE(p.name);
    EXPECT_EQ(p.why, "");
    EXPECT_EQ(p.error, Kind::threshold);
    EXPECT_EQ(p.threshold, 1e-3);
    ASSERT_EQ(p.runs.size(), 4u);
    for (const std::size_t form : {0u, 2u}) {
      EXPECT_LT(p.errors[form + 1], 0.02 * p.errors[form]);
      EXPECT_LT(p.errors[form + 1], 1e-3);
    }
    for (const double allowed : p.allowed) EXPECT_LT(cheapest_within(p, allowed), p.runs.size());
    EXPECT_EQ(cheapest_within(p, 1e-30), p.errors.size());
    for (const RunResult& run : p.runs) EXPECT_TRUE(run.trajectory.rows.empty());
  }
}

TEST(SceneSuites, TheCheapestRunIsThatOfFewestEvaluations) {
  SceneProblemResult problem;
  problem.errors = {1e-2, 1e-5, std::numeric_limits<double>::quiet_NaN(), 1e-4};
  for (const long evaluations : {10, 300, 5, 200}) {
    RunResult run;
    run.counters.evaluations = evaluations;
    problem.runs.push_back(run);
  }
  EXPECT_EQ(cheapest_within(problem, 1e-1), 0u);
  EXPECT_EQ(cheapest_within(problem, 1e-3), 3u);
  EXPECT_EQ(cheapest_within(problem, 1e-5), 1u);
  EXPECT_EQ(cheapest_within(problem, 1e-6), 4u);
}

// What is sent in is of the run that is named in the table, and its command makes that run again.
TEST(SceneSuites, SubmissionsAreOfTheCheapestRunsWithinWhatSourcesAllow) {
  SceneSuiteResult suite;
  SceneProblemResult& p = suite.problems.emplace_back();
  p.name = "A03: Andrews' squeezer";
  p.scene = "some/andrews.toml";
  p.set = {{"joint.O.position", -0.0620}};
  p.end = 0.05;
  p.samples = 100;
  p.error = BenchmarkError::Kind::threshold;
  p.threshold = 1e-3;
  p.allowed = {1e-1, 1e-3, 1e-9};
  p.reference = "andrews.csv";
  for (const double error : {2e-2, 3e-4}) {
    RunResult& run = p.runs.emplace_back();
    p.errors.push_back(error);
    run.settings = default_settings({}, "momentum", "dop853", error > 1e-3 ? 1e-4 : 1e-7);
    run.settings.gauge = "reset";
    run.settings.project = true;
    run.counters.evaluations = error > 1e-3 ? 1000 : 3000;
  }
  p.runs[1].cpu_s = 2.5e-3;
  Environment here;
  here.cpu = "a processor";
  const auto files = submissions(suite, here);
  ASSERT_EQ(files.size(), 2u) << "no run meets 1e-9";
  EXPECT_EQ(files[0].first, "submission-1-a03-andrews-squeezer-0.1.txt");
  EXPECT_EQ(files[1].first, "submission-1-a03-andrews-squeezer-0.001.txt");
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != text.npos;
  };
  EXPECT_TRUE(has(files[0].second, "\nAccuracy: 0.02 (mean error with threshold 0.001)"));
  EXPECT_TRUE(has(files[0].second, "\nCPU time: not taken\n"));
  EXPECT_TRUE(has(files[1].second, "\nCPU time: 0.0025 s\n")) << files[1].second;
  EXPECT_TRUE(has(files[1].second, "a processor, one core"));
  EXPECT_TRUE(has(files[1].second,
                  "momenta run some/andrews.toml --set joint.O.position=-0.062 --form momentum "
                  "--integrator dop853 --rtol 1e-7 --atol 1e-7 --end 0.05 --samples 100 --gauge "
                  "reset --project --out solution\n"))
      << files[1].second;
}

TEST(SceneSuites, MakeReferencesThatTheyHaveNot) {
  SceneSuite suite = read_scene_suite(example("suites/iftomm/suite.toml"));
  suite.problems = {suite.problems[0]};
  SceneProblem& problem = suite.problems[0];
  problem.reference.clear();
  problem.columns.clear();
  problem.end = 1;
  problem.samples = 10;
  problem.forms = {"momentum"};
  problem.tolerances = {1e-10};
  SceneSuiteRequest request;
  request.timing = Timing::none;
  const SceneSuiteResult result = run_suite(suite, request);
  ASSERT_EQ(result.problems[0].errors.size(), 1u) << result.problems[0].why;
  EXPECT_LT(result.problems[0].errors[0], 1e-7);
  EXPECT_EQ(result.problems[0].reference.find("quadruple precision"), 0u);
  // Multipliers are not judged where nobody asks for them.
  EXPECT_EQ(result.problems[0].columns,
            (std::vector<std::string>{"X.q [m]", "Y.q [m]", "X.u [m/s]", "Y.u [m/s]"}));
}

TEST(SceneSuites, TellInARowWhatCannotBeRun) {
  SceneSuite suite = read_scene_suite(example("suites/iftomm/suite.toml"));
  suite.problems = {suite.problems[0], suite.problems[0]};
  for (SceneProblem& problem : suite.problems) {
    problem.forms = {"momentum"};
    problem.tolerances = {1e-4};
  }
  suite.problems[0].columns = {"Q.x [m]"};
  SceneSuiteRequest request;
  request.timing = Timing::none;
  const SceneSuiteResult result = run_suite(suite, request);
  EXPECT_NE(result.problems[0].why.find("column 'Q.x [m]' is judged, expected one of the "
                                        "reference's, for instance 'P.x [m]'"),
            std::string::npos)
      << result.problems[0].why;
  EXPECT_TRUE(result.problems[0].runs.empty());
  EXPECT_EQ(result.problems[1].runs.size(), 1u);
  // Interrupted: what follows is not begun.
  request.progress = [](int, int, const std::string&) { return false; };
  EXPECT_FALSE(run_suite(suite, request).complete);
}

class SceneSuiteFiles : public equations::SceneFolder {};

TEST_F(SceneSuiteFiles, AreRefusedInASentence) {
  write("a.toml", "[[body]]\nname = \"b\"\nmass = 1\n");
  write("a.csv", "t [s],x [m]\n0,0\n1,0\n");
  const std::string first = "[[problem]]\nscene = \"a.toml\"\n";
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"[[problem]]\nscene = \"none.toml\"\n", "'none.toml', expected a scene in TOML"},
           {first + "reference = \"none.csv\"\n", "expected a reference solution in CSV"},
           {first + "file = \"a.toml\"\n", "'file' is of suites of equations, expected 'scene'"},
           {first + "forms = [\"momentun\"]\n", "has 'momentun': "},
           {first + "integrators = [\"rk5\"]\n", "has 'rk5': "},
           {first + "integrators = [\"rk4\"]\n", "it has fixed steps"},
           {first + "tolerances = [2]\n", "has 2, expected numbers between 0 and 1"},
           {first + "error = \"large\"\n", "'large', expected \"mixed\" or \"threshold\""},
           {first + "threshold = 1\n", "'threshold' belongs to error = \"threshold\""},
           {first + "reference = \"a.csv\"\nend = 2\n", "'end' stands beside a reference"},
           {first + "reference = \"a.csv\"\nsamples = 2\n", "'samples' stands beside a reference"},
           {first + "samples = 100000000\n", "expected at most 10000000"},
           {first + "set = 1\n", "expected a table"},
           {first + "set = { \"gravity.1\" = \"a\" }\n", "set 'gravity.1' is a string"},
           {first + "tolerance = [1e-4]\n", "unknown key 'tolerance'"},
           {first + "allowed = [3]\n", "has 3, expected numbers between 0 and 1"}}) {
    const std::filesystem::path file = write("suite.toml", text);
    EXPECT_TRUE(has_scenes(file)) << text;
    const std::string sentence = sentence_of([&] { (void)read_scene_suite(file); });
    EXPECT_NE(sentence.find(expected), std::string::npos) << text << sentence;
    EXPECT_EQ(sentence.find(file.string() + ":"), 0u) << sentence;
  }
  EXPECT_FALSE(has_scenes(write("suite.toml", "[[problem]]\nfile = \"a.toml\"\n")));
  EXPECT_FALSE(has_scenes(write("suite.toml", "").replace_filename("none.toml")));
  EXPECT_FALSE(has_scenes(write("suite.toml", "[[problem]\n")));
  // Times of references are at equal intervals from 0.
  SceneSuite suite = read_scene_suite(example("suites/iftomm/suite.toml"));
  suite.problems.resize(1);
  for (const char* times : {"0,0\n1,0\n3,0\n", "1,0\n2,0\n", "0,0\n"}) {
    suite.problems[0].reference =
        write("times.csv", std::string("t [s],P.x [m]\n") + times).string();
    suite.problems[0].columns.clear();
    const std::string why = run_suite(suite, {}).problems[0].why;
    EXPECT_NE(why.find("expected times from 0 at equal intervals"), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace momenta::dae_scene_suites
