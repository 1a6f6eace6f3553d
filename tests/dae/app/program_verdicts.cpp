// What the program says of runs whose loops do not stay closed, and of what it is asked wrongly.

#include "dae/app/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace momenta::golden::dae_program_verdicts {
namespace {

using nlohmann::json;

/// The four-bar of the examples, its crank driven; links of other lengths.
std::string dead_point(const std::string& drive) {
  return R"(name = "Four-bar driven past its reach"
gravity = [0, -9.81, 0]
run = { end = 1.0, step = 0.001, samples = 200 }
[[body]]
name = "a"
mass = 1.0
shape = { kind = "rod", length = 1.0, axis = "x" }
[[body]]
name = "b"
mass = 1.2
shape = { kind = "rod", length = 1.2, axis = "x" }
[[body]]
name = "c"
mass = 0.6
shape = { kind = "rod", length = 0.6, axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
parent = "ground"
child = "a"
axis = "z"
position = 1.0
[[joint]]
name = "A"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
axis = "z"
position = -1.2
[[joint]]
name = "C"
kind = "revolute"
parent = "ground"
child = "c"
origin = { parent = [2, 0, 0] }
axis = "z"
position = 2.2
[[loop]]
name = "B"
kind = "revolute"
parent = "b"
child = "c"
origin = { parent = [1.2, 0, 0], child = [0.6, 0, 0] }
axis = "z"
[[drive]]
joint = "O"
)" + drive;
}
const char* const sentence =
    "drive of 'O' cannot go on at t = 0.115198 s: loop 'B' does not close behind it (dead point of "
    "'b' and 'c')";
const double exact = std::acos(0.44) - 1;  // (1 + 4 − 4 cos φ)^½ = 1.2 + 0.6

TEST_F(Program, SaysWhereADriveCannotGoOn) {
  const std::string scene =
      "'" +
      write("dead.toml", dead_point("kind = \"polynomial\"\ncoefficients = [1, 1]\n")).string() +
      "'";
  for (const char* how : {"", " --form projected", " --form acceleration", " --project",
                          " --form momentum-index2", " --integrator rk4"}) {
    const fs::path out = folder_ / "run";
    const Outcome o = call("run " + scene + how + " --quiet --out '" + out.string() + "'");
    EXPECT_EQ(o.status, 1) << how;
    EXPECT_EQ(o.err.rfind(std::string("momenta: the run stopped: ") + sentence, 0), 0U) << o.err;
    const json summary = json::parse(text_of(out / "summary.json"));
    EXPECT_EQ(summary.at("status"), "failed");
    EXPECT_EQ(summary.at("reason"), sentence);
    EXPECT_NEAR(summary.at("stopped_at").get<double>(), exact, 1e-8);
    EXPECT_LT(summary.at("drift").at("position_max").get<double>(), 1e-4);
  }
  const Outcome study =
      call("drift " + scene + " --out '" + (folder_ / "drift").string() + "' --timing none");
  EXPECT_EQ(study.status, 1);
  EXPECT_TRUE(says(study.out, "all 21 runs stopped at 0.1152 s: "));
  EXPECT_FALSE(says(study.out, "recommend"));
  const Outcome check = call("check " + scene);
  EXPECT_EQ(check.status, 0);
  EXPECT_TRUE(says(check.out, std::string("Drives\n  ") + sentence));
  const json drives = json::parse(call("check " + scene + " --json").out).at("drives");
  EXPECT_EQ(drives.at("obstacle"), sentence);
  EXPECT_NEAR(drives.at("until_s").get<double>(), exact, 1e-8);
  expect_refused("evaluate " + scene + R"( --at '{"t": 0.5}')", sentence);
}

TEST_F(Program, FollowsDrivesWithinTheirReach) {
  const std::string scene =
      "'" +
      write("within.toml", dead_point("kind = \"harmonic\"\noffset = 1\namplitude = 0.1\n"
                                      "frequency = 20.0\n"))
          .string() +
      "'";
  EXPECT_TRUE(says(call("check " + scene).out, "loops close along the drives up to t = 1 s"));
  EXPECT_EQ(call("run " + scene + " --quiet").status, 0);
  const json at = json::parse(call("evaluate " + scene + R"( --at '{"t": 0.7}')").out);
  const json& loop = at.at("loops").at("B");
  for (const double phi : loop.at("phi")) EXPECT_LT(std::abs(phi), 1e-12);
  for (const double rate : loop.at("phidot")) EXPECT_LT(std::abs(rate), 1e-11);
}

TEST_F(Program, SaysWhenLoopsComeApart) {
  const fs::path out = folder_ / "run";
  const Outcome o = call("run '" + example("four_bar") +
                         "' --form acceleration --integrator rk4 --step 0.05 --end 300 --quiet "
                         "--timing none --out '" +
                         out.string() + "'");
  EXPECT_EQ(o.status, 1);
  EXPECT_TRUE(says(o.err, "s the loops came apart: loop 'B' is open by "));
  const json summary = json::parse(text_of(out / "summary.json"));
  EXPECT_EQ(summary.at("status"), "came apart");
  const double at = summary.at("stopped_at");
  EXPECT_GT(at, 1);
  EXPECT_LT(at, 300);
  // Samples up to there: t every 0.15 s.
  const std::string rows = text_of(out / "trajectory.csv");
  EXPECT_GT(std::count(rows.begin(), rows.end(), '\n'), 10);
}

TEST_F(Program, SaysWhenTooManyLoopsAreOpenForAReference) {
  const fs::path grid = write("grid.toml", call("make grid --n 5").out);
  const Outcome o =
      call("work '" + grid.string() +
           "' --forms momentum --integrators dop853 --from 1e-6 --to 1e-6 --end 0.01");
  EXPECT_EQ(o.status, 1);
  EXPECT_TRUE(says(o.err,
                   "a reference in quadruple precision takes at most 16 loop equations open at "
                   "once, found 20"));
}

TEST_F(Program, TellsHowForceIsPassedToAnOutput) {
  const std::string move =
      "move '" + example("four_bar") + "' --sweep O --by 0.5 --output C --out '";
  const Outcome o = call(move + (folder_ / "m").string() + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(says(o.out, "The transmission angle of C.q is least, 48."));
  const auto told = json::parse(text_of(folder_ / "m" / "move.json"));
  EXPECT_EQ(told.at("output").at("coordinate"), "C.q [rad]");
  const double least = told.at("output").at("transmission_angle").at("least");
  EXPECT_GT(least, 0.84);
  EXPECT_LT(least, 0.86);  // 0.841 between these poses
  const std::string csv = text_of(folder_ / "m" / "move.csv");
  EXPECT_TRUE(says(csv, ",transmission_angle [rad],joint_force [1/m],C.q.advantage [rad/rad],"));
  EXPECT_TRUE(says(text_of(folder_ / "m" / "index.html"), "transmission angle of C.q"));
  expect_refused("move '" + example("four_bar") + "' --sweep O --output O", "is swept or held");
  const Outcome dead = call("move '" + example("four_bar") + "' --sweep C --by 0.5");
  EXPECT_TRUE(says(dead.out, "Dead points: O.q = 3.9827, A.q = -3.1416, C.q = 2.3005; O.q = "));
}

TEST_F(Program, TellsAllAssemblies) {
  const std::string all = "assemble '" + example("four_bar") + "' --all ";
  const Outcome o = call(all + "--hold O --starts 50");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(says(o.out, "2 assemblies with O held, from 50 starts"));
  EXPECT_TRUE(says(o.out, "A search proves no completeness"));
  const auto told = json::parse(call(all + "--hold O --starts 50 --json").out);
  ASSERT_EQ(told.at("assemblies").size(), 2u);
  EXPECT_EQ(told.at("assemblies").at(0).at("own"), true);
  EXPECT_EQ(told.at("assemblies").at(1).at("own"), false);
  const double other = told.at("assemblies").at(1).at("q").at("C.q [rad]");
  EXPECT_NEAR(other, 4.05128, 1e-4);
  expect_refused(all, "leaves 1 degree of freedom");
  const Outcome every =
      call(all + "--hold O --by homotopy --out '" + (folder_ / "all").string() + "'");
  EXPECT_EQ(every.status, 0) << every.err;
  EXPECT_TRUE(says(every.out,
                   "2 assemblies with O held, of 2 solutions over the complex numbers; 2 "
                   "paths: 2 to these, 0 to infinity"));
  const auto written = json::parse(text_of(folder_ / "all" / "assemblies.json"));
  EXPECT_EQ(written.at("paths").at("complete"), true);
  EXPECT_NEAR(written.at("assemblies").at(1).at("q").at("C.q [rad]").get<double>(), other, 1e-9);
  EXPECT_TRUE(says(text_of(folder_ / "all" / "assemblies.csv"), "assembly,met,apart,"));
  const std::string page = text_of(folder_ / "all" / "index.html");
  EXPECT_TRUE(says(page, "<figcaption>own</figcaption>"));
  EXPECT_TRUE(says(page, "<figcaption>1</figcaption>"));
  EXPECT_NE(call("assemble '" + example("four_bar") + "' --starts 5").status, 0);
}

TEST_F(Program, PrintsItsHelpWhereNothingIsAsked) {
  const Outcome o = call("");
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.out, "");
  EXPECT_EQ(o.err, call("--help").out);
}

TEST_F(Program, NamesNumbersThatAreNotPositive) {
  const std::string run = "run '" + example("four_bar") + "' ";
  expect_refused(run + "--rtol -1", "momenta: --rtol: found -1, expected a positive number\n");
  expect_refused(run + "--step nan", "momenta: --step: found nan, expected a positive number\n");
  expect_refused(run + "--end abc", "momenta: --end: found 'abc', expected a positive number\n");
}

}  // namespace

}  // namespace momenta::golden::dae_program_verdicts
