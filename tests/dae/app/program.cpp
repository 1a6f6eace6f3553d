// The program as its users meet it: exit status, one sentence on standard error, nothing
// half-written.

#include "dae/app/program.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <sys/resource.h>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace momenta::golden::dae_program {
namespace {

TEST_F(Program, RefusesEveryBrokenSceneAndWritesNothing) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(std::string(MOMENTA_SOURCE_DIR) +
                                                  "/tests/core/format/broken_scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++scenes;
    expect_refused(
        "run '" + entry.path().string() + "' --out '" + (folder_ / "results").string() + "'",
        entry.path().filename().string() + ":");
    EXPECT_FALSE(fs::exists(folder_ / "results")) << entry.path();
  }
  EXPECT_GE(scenes, 40);
}

TEST_F(Program, RefusesScenesThatCannotBeAssembled) {
  const std::string four_bar = text_of(example("four_bar"));
  std::string far = four_bar;
  far.replace(far.find("parent = [2.0, 0, 0] }\naxis = [0, 0, 1]\nposition = 1.74"), 22,
              "parent = [9.0, 0, 0] }");
  expect_refused("run '" + write("far.toml", far).string() + "'", "loop 'B' stays open by");
  std::string off_plane = four_bar;
  off_plane.replace(off_plane.find("child = [1.5, 0, 0] }"), 21, "child = [1.5, 0, 1] }");
  expect_refused("check '" + write("off_plane.toml", off_plane).string() + "'",
                 "apart across the plane");
}

TEST_F(Program, WritesPagesAndFigures) {
  const fs::path run = folder_ / "run", drift = folder_ / "drift", view = folder_ / "view";
  const std::string scene = "'" + example("bricard") + "' --quiet --figures svg --end 1 --out '";
  EXPECT_EQ(call("run " + scene + run.string() + "'").status, 0);
  EXPECT_EQ(call("drift " + scene + drift.string() + "' --forms momentum,acceleration").status, 0);
  EXPECT_EQ(call("view '" + example("bricard") + "' --quiet --out '" + view.string() + "'").status,
            0);
  for (const fs::path& folder : {run, drift, view}) {
    const std::string page = text_of(folder / "index.html");
    EXPECT_GT(page.size(), 100'000u);
    EXPECT_LT(page.size(), 3'000'000u);
    const auto from = page.find("id=\"study\">") + 11;
    const auto data = nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
    EXPECT_EQ(data["picture"]["bodies"].size(), 5u);
    EXPECT_EQ(data["motions"].size(), folder == drift ? data["runs"].size() : 1u);
    EXPECT_EQ(data["motions"][0]["count"] == 1, folder == view);
  }
  for (const char* figure : {"mechanism", "position_drift", "angles", "energy_error"})
    EXPECT_TRUE(fs::exists(run / "figures" / (std::string(figure) + ".svg"))) << figure;
  EXPECT_TRUE(fs::exists(drift / "figures" / "error_cost.svg"));
  const Outcome printed = call("view '" + example("four_bar") + "'");
  EXPECT_EQ(printed.status, 0);
  EXPECT_EQ(printed.out.rfind("<!doctype html>", 0), 0u);
  expect_refused("run '" + example("four_bar") + "' --figures svg", "expected --out DIR");
  expect_refused("run '" + example("four_bar") + "' --figures png --out x", "png");
  expect_refused("view '" + example("four_bar") + "' --out '" + run.string() + "'",
                 "trajectory.csv");
}

TEST_F(Program, ShowsNoMechanismThatAPageCannotHold) {
  const Outcome text = call("make chain --n 2001");
  const std::string scene = write("long.toml", text.out).string();
  expect_refused("view '" + scene + "'", "expected at most 2000");
  const fs::path out = folder_ / "results";
  EXPECT_EQ(call("run '" + scene + "' --quiet --end 1e-3 --samples 2 --out '" + out.string() + "'")
                .status,
            0);
  EXPECT_LT(text_of(out / "index.html").size(), 3'000'000u);
}

TEST_F(Program, RefusesFilesThatAreNoScenes) {
  expect_refused("check '" + write("empty.toml", "").string() + "'", "empty.toml");
  expect_refused("check '" +
                     write("binary.toml", std::string("\x7f"
                                                      "ELF\0\1\2",
                                                      7))
                         .string() +
                     "'",
                 "binary.toml");
  expect_refused("check '" + folder_.string() + "'", folder_.filename().string());
  expect_refused("check '" + (folder_ / "missing.toml").string() + "'", "missing.toml");
}

// A scene cut anew is a scene again: the joint that was cut is a loop, and nothing more is to gain.
TEST_F(Program, ConvertCutsAnewWhereThatIsLessWork) {
  const fs::path chain = write("chain.toml", call("make closed-chain --n 60").out),
                 anew = folder_ / "anew.toml";
  EXPECT_TRUE(says(call("check '" + chain.string() + "'").out, "--recut"));
  const Outcome told = call("convert '" + chain.string() + "' '" + anew.string() + "' --recut");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_TRUE(says(told.err, "tree 30 deep, now 60"));
  const Outcome checked = call("check '" + anew.string() + "' --json");
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_TRUE(says(checked.out, "\"depth\": 30"));
  EXPECT_FALSE(says(checked.out, "\"better\""));
  const Outcome kept = call("convert '" + chain.string() + "' --recut --keep end --quiet");
  EXPECT_EQ(kept.out, call("convert '" + chain.string() + "'").out);
  expect_refused("convert '" + chain.string() + "' --keep end", "--recut");
  expect_refused("convert '" + chain.string() + "' --recut --keep nobody", "'nobody'");
}

/// Three four-bars in a row, written as one chain of rods with the feet of three uprights as loops.
std::string row_as_one_chain() {
  std::string text = "name = \"row\"\ngravity = [0, -9.81, 0]\n", parent = "ground";
  for (int i = 0; i < 7; ++i) {
    const bool upright = i % 2 == 0;
    const std::string rod = (upright ? "v" : "h") + std::to_string(i / 2);
    text += "[[body]]\nname = \"" + rod +
            "\"\nmass = 1\nshape = { kind = \"rod\", length = 1 }\n"
            "[[joint]]\nname = \"" +
            rod + " pin\"\nkind = \"revolute\"\nparent = \"" + parent + "\"\nchild = \"" + rod +
            "\"\norigin = { parent = [" + (i == 0 ? "0" : "1") + ", 0, 0], child = [" +
            (upright && i > 0 ? "1" : "0") + ", 0, 0] }\nposition = " + (upright ? "1.1" : "-1.1") +
            "\n";
    if (upright && i > 0)
      text += "[[loop]]\nname = \"foot " + std::to_string(i / 2) +
              "\"\nkind = \"point\"\nchild = \"" + rod + "\"\norigin = { parent = [" +
              std::to_string(i / 2) + ", 0, 0] }\n";
    parent = rod;
  }
  return text;
}

// What runs integrate in place of the scene is told, but not among the numbers of --json.
TEST_F(Program, TellsWhatIsIntegrated) {
  const fs::path chain = write("chain.toml", row_as_one_chain());
  const std::string scene = " '" + chain.string() + "' ", told = "cut at 'h0 pin', 'h1 pin'",
                    few = "--end 0.01 --timing none";
  EXPECT_TRUE(says(call("check" + scene).out, "runs integrate    " + told));
  const std::string forms = "--forms momentum,projected ";
  for (const std::string& asked : {"run" + scene + few, "drift" + scene + forms + few}) {
    EXPECT_TRUE(says(call(asked).out, told)) << asked;
    EXPECT_FALSE(says(call(asked + " --cut scene").out, "as written")) << asked;
    EXPECT_EQ(call(asked + " --quiet").out, "") << asked;
    auto json = nlohmann::json::parse(call(asked + " --json").out);
    if (json.is_array()) json = json.at(0);
    EXPECT_EQ(json.at("integrated").get<std::string>().find(told), 0u) << asked;
    json = nlohmann::json::parse(call(asked + " --json --cut scene").out);
    if (json.is_array()) json = json.at(0);
    EXPECT_EQ(json.at("integrated"), "") << asked;
  }
}

// A robot moves as the scene it is converted to; what is left out is told unless --quiet is given.
TEST_F(Program, ReadsAndConvertsRobots) {
  const std::string models = std::string(MOMENTA_SOURCE_DIR) + "/examples/models/";
  const std::string gripper = models + "robotiq_2f85_v4/2f85.xml";
  const std::string written = (folder_ / "gripper.toml").string();
  const Outcome told = call("convert " + gripper + " '" + written + "'");
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_TRUE(says(told.err, "2f85.xml: left out: actuators, which --control lets act (1)\n"));
  EXPECT_EQ(call("convert " + gripper + " --quiet").err, "");
  EXPECT_EQ(call("convert " + gripper).out, text_of(written));
  for (const std::string verb : {"check ", "assemble "}) {
    const Outcome robot = call(verb + gripper), scene = call(verb + "'" + written + "'");
    EXPECT_EQ(robot.status, 0) << robot.err;
    EXPECT_EQ(robot.out, scene.out);
  }
  EXPECT_EQ(call("check " + models + "epr_robot_delta/robot.urdf").status, 0);
  EXPECT_EQ(call("check " + models + "ur5/ur5_robot.urdf --free-root --quiet").status, 0);
  expect_refused("check " + models + "ur5/ur5_robot.urdf --loops none.yaml", "no such file");
  expect_refused("check " + gripper + " --free-root", "no URDF");
  expect_refused("convert " + example("four_bar") + " --loops x.yaml", "no URDF");
}

TEST_F(Program, RefusesWrongUsage) {
  const std::string scene = "'" + example("four_bar") + "'";
  expect_refused("run " + scene + " --form nonsense", "form 'nonsense' is not known");
  expect_refused("run " + scene + " --gauge nonsense", "gauge 'nonsense'");
  expect_refused("run " + scene + " --rtol -1", "rtol");
  expect_refused("run " + scene + " --form momentum-index2 --integrator rk4",
                 "expected integrator ida");
  expect_refused("run " + scene + " --integrator bdf --gauge reset", "multistep");
  expect_refused("drift " + scene + " --forms momentum,nonsense", "nonsense");
  expect_refused("run " + scene + " --reference missing.csv", "missing.csv");
  expect_refused("sing " + scene, "verb 'sing' is not known");
}

TEST_F(Program, RunWritesTrajectoryAndSummaryAndKeepsThemAfterAFailure) {
  const fs::path results = folder_ / "results";
  const std::string scene = "'" + example("four_bar") + "'",
                    out = " --out '" + results.string() + "'";
  ASSERT_EQ(call("run " + scene + " --end 1 --samples 10 --integrator dop853" + out).status, 0);
  const std::string trajectory = text_of(results / "trajectory.csv");
  EXPECT_EQ(trajectory.rfind("t [s],O.q [rad],A.q [rad],C.q [rad],O.u [rad/s]", 0), 0u)
      << trajectory.substr(0, 80);
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 12);
  const auto summary = nlohmann::json::parse(text_of(results / "summary.json"));
  EXPECT_EQ(summary.at("status"), "done");
  EXPECT_EQ(summary.at("form"), "momentum");
  expect_refused("run " + scene + " --form nonsense" + out, "nonsense");
  EXPECT_EQ(text_of(results / "trajectory.csv"), trajectory);
}

TEST_F(Program, StoppedRunSaysWhyAndKeepsItsSamples) {
  const fs::path results = folder_ / "results";
  const Outcome o =
      call("run '" + example("four_bar") +
           "' --integrator rk4 --step 1e-6 --end 100 --samples 100000 --cpu-limit 2 --out '" +
           results.string() + "'");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.err.rfind("momenta: the run stopped: ", 0), 0u) << o.err;
  const auto summary = nlohmann::json::parse(text_of(results / "summary.json"));
  EXPECT_EQ(summary.at("status"), "time limit");
  const std::string trajectory = text_of(results / "trajectory.csv");
  EXPECT_GT(std::count(trajectory.begin(), trajectory.end(), '\n'), 2);
}

// What comes before the run counts, and a step of seconds is cut short.
TEST_F(Program, CpuLimitHoldsWithinLongSteps) {
  const fs::path star = folder_ / "star.toml";
  const Outcome made = call("make star --n 2000");
  ASSERT_EQ(made.status, 0) << made.err;
  std::ofstream(star) << made.out;
  const auto used = [] {
    rusage all{};
    getrusage(RUSAGE_CHILDREN, &all);
    return static_cast<double>(all.ru_utime.tv_sec + all.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(all.ru_utime.tv_usec + all.ru_stime.tv_usec);
  };
  const double limit = 1, before = used();
  const Outcome o = call("run '" + star.string() +
                         "' --form stabilised-index2 --timing none --samples 2 --cpu-limit 1");
  EXPECT_EQ(o.status, 1) << o.out << o.err;
  EXPECT_LT(used() - before, limit + 1.5);  // a second for the step, and what prints the results
}

TEST_F(Program, RunNamesRowsThatFade) {
  const auto faded = [&](const std::string& scene, const std::string& options) {
    const Outcome o = call("run '" + scene + "' " + options + " --timing none --json");
    EXPECT_EQ(o.status, 0) << o.err;
    return nlohmann::json::parse(o.out).at("faded_rows");
  };
  EXPECT_TRUE(faded(example("four_bar"), "--end 1").empty());
  // Six poses in ten seconds at which the slider loses a direction.
  const auto rows = faded(example("slider_crank"), "--integrator rk4 --step 1e-4");
  ASSERT_FALSE(rows.empty());
  EXPECT_EQ(rows[0].at("loop"), "B");
  EXPECT_GT(rows[0].at("evaluations"), 4);
  EXPECT_LT(rows[0].at("evaluations"), 4000);
}

TEST_F(Program, DriftWritesPageTableAndJson) {
  const fs::path results = folder_ / "results";
  const Outcome o =
      call("drift '" + example("four_bar") +
           "' --integrator dop853 --end 0.5 --samples 50 --json --out '" + results.string() + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto runs = nlohmann::json::parse(o.out);
  ASSERT_TRUE(runs.is_array());
  EXPECT_EQ(runs.size(), 19u);
  for (const auto& run : runs) EXPECT_EQ(run.at("status"), "done") << run.at("form");
  EXPECT_EQ(nlohmann::json::parse(text_of(results / "summary.json")), runs);
  EXPECT_TRUE(says(text_of(results / "index.html"), "<!doctype html>"));
  const std::string csv = text_of(results / "study.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 20);
}

TEST_F(Program, WorkMakesItsOwnReferenceAndAdvises) {
  const fs::path results = folder_ / "results";
  const std::string command = "work '" + example("four_bar") +
                              "' --forms momentum,acceleration --from 1e-5 --to 1e-9 "
                              "--per-decade 0.5 --end 0.5";
  const Outcome o = call(command + " --json --out '" + results.string() + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto runs = nlohmann::json::parse(o.out);
  ASSERT_EQ(runs.size(), 6u);
  for (const auto& run : runs) {
    EXPECT_EQ(run.at("status"), "done") << run.at("reason");
    EXPECT_LT(run.at("error").at("position_max").get<double>(), 100 * run.at("rtol").get<double>());
  }
  const std::string page = text_of(results / "index.html");
  EXPECT_TRUE(says(page, "quadruple precision"));
  EXPECT_TRUE(says(page, "For an error of"));
  const Outcome said = call(command);
  EXPECT_TRUE(says(said.out, "For an error of 1e-6 take"));
  expect_refused("work '" + example("four_bar") + "' --from 1e-9 --to 1e-5",
                 "expected the loosest tolerance first");
  expect_refused("work '" + example("four_bar") + "' --forms acceleraton", "acceleraton");
}

TEST_F(Program, KilledStudyResumesAndStudiesDoNotMix) {
  const std::string study = "drift '" + example("four_bar") +
                            "' --end 40 --samples 50 --timing once --forms "
                            "momentum,acceleration,momentum-index2,stabilised-index2";
  const fs::path whole = folder_ / "whole", killed = folder_ / "killed",
                 journal = killed / "runs.jsonl";
  ASSERT_EQ(call(study + " --out '" + whole.string() + "'").status, 0);
  ASSERT_EQ(status_when_killed(study + " --out '" + killed.string() + "'", journal, 4),
            128 + SIGKILL);
  ASSERT_FALSE(fs::exists(killed / "summary.json"));
  const std::string before = text_of(journal);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  ASSERT_GE(lines, 4);

  // Neither another scene nor other settings nor another verb takes the place.
  const std::string there = " --out '" + killed.string() + "'";
  expect_refused("drift '" + example("slider_crank") + "' --end 40" + there, "unfinished study");
  expect_refused(study + " --rtol 1e-7" + there, "unfinished study, 'momenta drift");
  expect_refused("work '" + example("four_bar") + "' --end 40" + there, "unfinished study");
  EXPECT_EQ(text_of(journal), before);

  const Outcome o = call(study + there);
  EXPECT_EQ(o.status, 0) << o.err;
  const auto all = nlohmann::json::parse(text_of(whole / "summary.json")).size();
  EXPECT_TRUE(says(o.err, "momenta: " + std::to_string(lines - 1) + " of " + std::to_string(all) +
                              " runs taken from "));
  EXPECT_FALSE(fs::exists(journal));
  const auto untimed = [](const fs::path& folder) {
    auto runs = nlohmann::json::parse(text_of(folder / "summary.json"));
    for (auto& run : runs) {
      run.erase("time");
      run["environment"].erase("date");
    }
    return runs;
  };
  EXPECT_EQ(untimed(killed), untimed(whole));
  // Finished results are another verb's neighbours no more than unfinished ones.
  expect_refused("run '" + example("four_bar") + "' --end 1" + there, "study.csv of another verb");
  expect_refused("stress '" + example("four_bar") + "'" + there, "study.csv of another verb");
}

TEST_F(Program, IndexAgreesWithCheckAndIsWritten) {
  const fs::path results = folder_ / "results";
  const std::string scene = "'" + example("four_bar") + "'";
  const Outcome o = call("index " + scene + " --json --out '" + results.string() + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto j = nlohmann::json::parse(o.out);
  EXPECT_EQ(nlohmann::json::parse(text_of(results / "index.json")), j);
  const Outcome checked = call("check " + scene), table = call("index " + scene);
  EXPECT_GE(j.at("forms").size(), 10u);
  for (const auto& f : j.at("forms")) {
    const std::string form = f.at("form");
    const std::string line = "\n  " + form + " ";
    const auto at = checked.out.find(line);
    ASSERT_NE(at, std::string::npos) << form << " is missing in check";
    const std::string said = checked.out.substr(at, checked.out.find('\n', at + 1) - at);
    if (f.at("kind") == "ODE")
      EXPECT_TRUE(says(said, "ODE"));
    else
      EXPECT_TRUE(says(said, "index " + f.at("index").dump()));
    EXPECT_TRUE(says(table.out, "\n" + form + ": q, ")) << form;
  }
  EXPECT_EQ(call("index " + scene + " --quiet").out, "");
}

TEST_F(Program, IndexAtAStateAsksForAConsistentOne) {
  const std::string scene = "'" + example("slider_crank") + "'";
  expect_refused("index " + scene + R"( --at '{"q": {"O": 1}}')", "loop 'B' is open by");
  expect_refused("index " + scene + R"( --at '{"v": {"O": 1}}')", "loop 'B' opens at a rate of");
  expect_refused("index " + scene + " --forms momentum,nonsense", "form 'nonsense' is not known");
  const Outcome made = call("make n-four-bar --n 150");
  expect_refused("index '" + write("large.toml", made.out).string() + "'", "expected at most 450");
  // The crossing: one of two loop equations says nothing new there.
  const Outcome o = call(
      "index " + scene +
      R"( --at '{"q": {"O": 1.5707963267948966, "A": -3.141592653589793, "S": 0}, "p": {}}' --json)");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto j = nlohmann::json::parse(o.out);
  EXPECT_EQ(j.at("loops").at("rank"), 1);
  for (const auto& f : j.at("forms")) {
    if (f.at("form") != "momentum-index2") continue;
    EXPECT_NE(f.at("index"), 2);
  }
}

TEST_F(Program, EvaluateGivesThePendulumByHand) {
  // A point mass of 1 kg at 1 m, θ from the x axis, gravity along −y; τ = 0.5 N m.
  const double angle = 0.4, rate = 1.7, g = 9.81;
  const std::string scene = "'" + example("pendulum") + "'";
  const Outcome o = call("evaluate " + scene +
                         R"( --at '{"q": {"O": 0.4}, "v": {"O": [1.7]}, "tau": {"O": 0.5}}')");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto j = nlohmann::json::parse(o.out);
  const auto of = [&](const char* key) { return j.at(key).at("O").at(0).get<double>(); };
  const double push = -g * std::cos(angle) + 0.5;
  EXPECT_EQ(j.at("given"), "v");
  EXPECT_EQ(of("q"), angle);
  EXPECT_EQ(of("v"), rate);
  EXPECT_NEAR(of("p"), rate, 1e-15);
  EXPECT_EQ(of("qdot"), rate);
  EXPECT_NEAR(of("pdot"), push, 1e-14);
  EXPECT_NEAR(of("bias"), -push, 1e-14);
  EXPECT_NEAR(j.at("acceleration").at("free").at("O").at(0).get<double>(), push, 1e-14);
  EXPECT_FALSE(j.at("acceleration").contains("constrained"));
  EXPECT_FALSE(j.contains("loops"));
  EXPECT_EQ(j.at("dofs"), nlohmann::json({"O"}));
  EXPECT_NEAR(j.at("M").at(0).at(0).get<double>(), 1, 1e-15);
  const double kinetic = 0.5 * rate * rate, potential = g * std::sin(angle);
  EXPECT_NEAR(j.at("energy").at("T").get<double>(), kinetic, 1e-14);
  EXPECT_NEAR(j.at("energy").at("V").get<double>(), potential, 1e-14);
  EXPECT_NEAR(j.at("energy").at("H").get<double>(), kinetic + potential, 1e-14);
  const auto expect_vector = [](const nlohmann::json& found, double x, double y, double z) {
    const double expected[] = {x, y, z};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(found.at(i).get<double>(), expected[i], 1e-13) << found;
  };
  const double c = std::cos(angle), s = std::sin(angle);
  const auto& all = j.at("centroidal");
  expect_vector(all.at("centre_of_mass"), c, s, 0);
  expect_vector(all.at("linear_momentum"), -rate * s, rate * c, 0);
  expect_vector(all.at("angular_momentum"), 0, 0, rate);
  // The hinge carries m a − m g, and the moment that τ puts on the bob.
  const auto& hinge = j.at("reactions").at("O");
  expect_vector(hinge.at("force"), -rate * rate * c - push * s, -rate * rate * s + push * c + g, 0);
  expect_vector(hinge.at("torque"), 0, 0, 0.5);
  expect_vector(hinge.at("at"), 0, 0, 0);
  expect_vector(j.at("markers").at("P").at("position"), c, s, 0);
  expect_vector(j.at("markers").at("P").at("velocity"), -rate * s, rate * c, 0);

  // The same from its momentum, from a file and from standard input.
  const fs::path state = write("state.json", R"({"q": {"O": 0.4}, "p": {"O": 1.7}})");
  const Outcome file = call("evaluate " + scene + " --at '" + state.string() + "'");
  const Outcome piped = call("evaluate " + scene + " --at -", state);
  ASSERT_EQ(file.status, 0) << file.err;
  EXPECT_EQ(file.out, piped.out);
  const auto back = nlohmann::json::parse(file.out);
  EXPECT_EQ(back.at("given"), "p");
  EXPECT_NEAR(back.at("v").at("O").at(0).get<double>(), rate, 1e-15);
}

TEST_F(Program, EvaluateOfLoopsSolvesSevenForGivenMomenta) {
  const std::string scene = "'" + example("four_bar") + "'";
  const auto at = [&](const std::string& state) {
    const Outcome o = call("evaluate " + scene + " --at '" + state + "'");
    EXPECT_EQ(o.status, 0) << o.err;
    return nlohmann::json::parse(o.out);
  };
  const auto start = at("{}");
  const auto& loop = start.at("loops").at("B");
  EXPECT_EQ(loop.at("lambda").size(), 2u);
  for (double sigma : loop.at("sigma")) EXPECT_EQ(sigma, 0);
  for (double phi : loop.at("phi")) EXPECT_LT(std::abs(phi), 1e-14);
  EXPECT_EQ(start.at("rank"), 2);
  EXPECT_EQ(start.at("mobility"), 1);
  EXPECT_EQ(start.at("singular_values").size(), 2u);

  const auto moving = at(R"({"t": 1, "p": {"O": 1, "A": 0, "C": 0}, "tau": {"O": 3}})");
  EXPECT_EQ(moving.at("t"), 1);
  for (double rate : moving.at("loops").at("B").at("phidot")) EXPECT_LT(std::abs(rate), 1e-14);
  EXPECT_GT(std::abs(moving.at("loops").at("B").at("sigma").at(0).get<double>()), 1e-3);
  // Back by v: the same motion, another gauge.
  const auto again = at(R"({"v": )" + moving.at("v").dump() + R"(, "tau": {"O": [3]}})");
  for (const char* joint : {"O", "A", "C"})
    EXPECT_NEAR(again.at("acceleration").at("constrained").at(joint).at(0).get<double>(),
                moving.at("acceleration").at("constrained").at(joint).at(0).get<double>(), 1e-11);
  const double kinetic = again.at("energy").at("T").get<double>();
  EXPECT_NEAR(kinetic, moving.at("energy").at("T").get<double>(), 1e-14);
  EXPECT_NEAR(moving.at("energy").at("H").get<double>(),
              kinetic + moving.at("energy").at("V").get<double>(), 1e-13);
}

TEST_F(Program, EvaluateWritesWholeFilesAndLeavesOutWhatIsLarge) {
  const Outcome made = call("make n-four-bar --n 80");
  const std::string large = write("large.toml", made.out).string();
  const Outcome o = call("evaluate '" + large + "' --out '" + (folder_ / "results").string() + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(o.out.empty());
  const auto j = nlohmann::json::parse(text_of(folder_ / "results" / "evaluate.json"));
  EXPECT_FALSE(j.contains("M"));
  EXPECT_FALSE(j.contains("rank"));
  EXPECT_TRUE(says(j.at("left_out").get<std::string>(), "300"));
  EXPECT_EQ(j.at("loops").size(), 80u);
}

TEST_F(Program, EvaluateRefusesBadStates) {
  const std::string four_bar =
      "evaluate '" + example("four_bar") + "' --out '" + (folder_ / "results").string() + "' --at ";
  const std::pair<const char*, const char*> states[] = {
      {R"('{"q": {"B1": 1}}')", "joint 'B1' is not in the scene"},
      {R"('{"tau": {"crank": 1}}')", "key 'tau': joint 'crank' is not in the scene"},
      {R"('{"q": {"O": [1, 2]}}')", "joint 'O': found an array of 2, expected 1 number"},
      {R"('{"v": {"O": []}}')", "joint 'O': found an array of 0, expected 1 number"},
      {R"('{"v": {"O": "1"}}')", "joint 'O': found the string '1', expected 1 number"},
      {R"('{"v": {"O": [null]}}')", "joint 'O': found null, expected 1 number"},
      {R"('{"v": {}, "p": {}}')", "found both 'v' and 'p'"},
      {R"('{"vel": {}}')", "key 'vel' is not known"},
      {R"('{"taus": {}}')", "did you mean 'tau'?"},
      {R"('{"t": "now"}')", "key 't': found the string 'now', expected a time [s]"},
      {R"('{"t": 1e999}')", "too large"},
      {R"('{"t": NaN}')", "--at:1:7: the text is not JSON"},
      {R"('{"q": [1, 2, 3]}')", "key 'q': found an array of 3, expected an object"},
      {R"('{"q": {"O": 1, "O": 2}}')", "key 'O' stands twice"},
      {R"('{"q": {"O": [[[[1]]]]}}')", "nested deeper"},
      {"'{'", "not JSON"},
      {"''", "--at: found nothing"},
      {"-", "standard input:1:1: the text is not JSON"},
      {"missing.json", "missing.json: the file cannot be opened"},
      {"/", "found a directory"},
  };
  for (const auto& [state, mentions] : states) expect_refused(four_bar + state, mentions);
  const fs::path list = write("list.json", "[1, 2]");
  expect_refused(four_bar + "'" + list.string() + "'", "list.json: found an array of 2, expected");
  const fs::path broken = write("broken.json", "{\n  \"q\": {\n    \"O\": }\n}\n");
  expect_refused(four_bar + "'" + broken.string() + "'", "broken.json:3:10: the text is not JSON");
  expect_refused(
      "evaluate '" + example("free_body") + R"(' --at '{"q": {"S": [0, 0, 0, 1, 1, 0, 0]}}')",
      "norm");
  EXPECT_FALSE(fs::exists(folder_ / "results"));
}

TEST_F(Program, FamiliesItMakesAreScenesItReadsAndRuns) {
  const std::pair<const char*, int> mobilities[] = {
      {"chain --n 5", 5},
      {"chain --n 1", 1},
      {"random-chain --n 1", 1},
      {"random-chain --n 30", 30},
      {"rope --n 1", 1},
      {"rope --n 20", 20},
      {"spherical-chain --n 1", 3},
      {"tree --n 1", 1},
      {"spherical-chain --n 5", 15},
      {"tree --n 40", 40},
      {"star --n 1", 12},
      {"star --n 5", 36},
      {"humanoid", 36},
      {"rope", 10},
      {"n-four-bar --n 1", 1},
      {"n-four-bar --n 3", 1},
      {"n-four-bar --n 3 --turned", 1},
      {"chain --n 4 --turned", 4},
      {"scissor-ladder --n 2", 2},
      {"scissor-ladder --n 5 --turned", 2},
      {"closed-chain --n 3", 1},
      {"closed-chain --n 9 --turned", 7},
      {"grid --n 1", 1},
      {"grid --n 3 --turned", 3},
      {"jansen-legs --n 1", 1},
      {"jansen-legs --n 3 --turned", 1},
      {"stewart --n 3", 6},
      {"stewart", 6},
      {"humanoid --n 30", 36},
  };
  for (const auto& [family, mobility] : mobilities) {
    SCOPED_TRACE(family);
    const Outcome made = call(std::string("make ") + family);
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_EQ(call(std::string("make ") + family).out, made.out);
    const std::string scene = "'" + write("made.toml", made.out).string() + "'";
    const Outcome checked = call("check --json " + scene);
    ASSERT_EQ(checked.status, 0) << checked.err;
    EXPECT_EQ(nlohmann::json::parse(checked.out).at("mobility"), mobility);
    const Outcome ran = call("run --json " + scene + " --integrator dop853 --end 1");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_LT(nlohmann::json::parse(ran.out).at("energy").at("error_max").get<double>(), 1e-3);
  }
}

TEST_F(Program, FamiliesAreWhatTheirNamesSay) {
  const auto start = [&](const std::string& family) {
    const std::string scene = write("made.toml", call("make " + family).out).string();
    return nlohmann::json::parse(call("evaluate '" + scene + "'").out);
  };
  const auto rope = start("rope --n 50");
  EXPECT_NEAR(rope.at("centroidal").at("mass").get<double>(), 0.5, 1e-14);
  EXPECT_GT(rope.at("markers").at("end").at("position").at(0).get<double>(), 4.9);
  const auto person = start("humanoid");
  EXPECT_NEAR(person.at("centroidal").at("mass").get<double>(), 75, 1e-12);
  EXPECT_EQ(person.at("dofs").size(), 36u);
  const double crown = person.at("markers").at("crown").at("position").at(2).get<double>();
  const double sole = person.at("markers").at("left_sole").at("position").at(2).get<double>();
  EXPECT_NEAR(crown - sole, 1.75, 0.06);  // knees bent
  // Jansen's legs walk: for a good third of a turn the foot goes level.
  const auto walker = start("jansen-legs --n 24");
  std::vector<double> heights;
  for (int leg = 1; leg <= 24; ++leg)
    heights.push_back(
        walker.at("markers").at("foot" + std::to_string(leg)).at("position").at(1).get<double>());
  const double lowest = *std::min_element(heights.begin(), heights.end());
  EXPECT_GE(std::count_if(heights.begin(), heights.end(),
                          [&](double height) { return height < lowest + 0.01; }),
            9);
}

TEST_F(Program, LoopsOfFamiliesCloseAsTheyArePrinted) {
  for (const char* family : {"n-four-bar", "scissor-ladder", "closed-chain", "grid", "jansen-legs",
                             "jansen-legs --n 7 --turned", "grid --turned", "stewart --n 9"}) {
    SCOPED_TRACE(family);
    const std::string scene = write("made.toml", call(std::string("make ") + family).out).string();
    const momenta::Mechanism mechanism(momenta::read_scene(scene));
    EXPECT_LT(momenta::assemble(mechanism).moved, 1e-12);
  }
}

TEST_F(Program, LargeFamiliesAreWrittenQuicklyAndImpossibleOnesRefused) {
  const Outcome tree = call("make tree --n 100000");
  ASSERT_EQ(tree.status, 0);
  EXPECT_TRUE(says(tree.out, "\"branch100000\""));
  expect_refused("make robe", "family 'robe' is not known; expected chain, random-chain, rope");
  expect_refused("make rope --n 0", "found --n 0, expected 1 to 100000");
  expect_refused("make star --n 100000", "expected 1 to 20000");
  expect_refused("make humanoid --n 12", "expected 30, its number of hinges");
  expect_refused("make rope --turned", "found --turned, which is for planar mechanisms alone");
}

TEST_F(Program, StressTellsWhoSurvives) {
  const fs::path results = folder_ / "results";
  const Outcome o = call("stress '" + example("four_bar") +
                         "' --end 1 --along 'duration,mass ratio' --forms momentum,projected "
                         "--reference-limit 0 --cpu-limit 2 --out '" +
                         results.string() + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(says(o.out, "Ladders of all"));
  const auto json = nlohmann::json::parse(text_of(results / "stress.json"));
  EXPECT_EQ(json["ladders"].size(), 3u);
  EXPECT_EQ(json["contestants"].size(), 2u);
  EXPECT_EQ(json["contestants"][0]["form"], "momentum");
  EXPECT_GT(json["contestants"][0]["survived"].get<int>(), 3);
  EXPECT_TRUE(json["complete"].get<bool>());
  const std::string csv = text_of(results / "stress.csv");
  std::size_t runs = 0;
  for (const auto& ladder : json["ladders"]) runs += ladder["runs"].size();
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), runs + 1);
  EXPECT_TRUE(says(text_of(results / "index.html"), "survived most"));
}

TEST_F(Program, StressRefusesWhatItDoesNotKnow) {
  expect_refused("stress --along nonsense", "nonsense");
  expect_refused("stress '" + example("four_bar") + "' --along nonsense", "nonsense");
  expect_refused("stress '" + example("four_bar") + "' --along stiffness", "no spring");
  expect_refused("stress '" + example("four_bar") + "' --forms nonsense", "nonsense");
  expect_refused("stress '" + example("four_bar") + "' --integrators nonsense", "nonsense");
  expect_refused("stress nowhere.toml", "nowhere.toml");
}

TEST_F(Program, CheckNamesWhatIsRedundantAndWhatIsSingular) {
  const Outcome three =
      call("check '" + std::string(MOMENTA_SOURCE_DIR) + "/examples/extremes/three_cranks.toml'");
  EXPECT_EQ(three.status, 0);
  EXPECT_TRUE(says(three.out, "redundant: loop 'C' row"));
  EXPECT_TRUE(says(three.out, "follows from loop 'B'"));
  const Outcome hinges = call("check '" + example("four_bar") + "' --algebra spatial");
  EXPECT_TRUE(says(hinges.out, "a point loop in place of 'B' ties as much"));
  const Outcome json = call("check '" + example("bricard") + "' --json");
  EXPECT_EQ(nlohmann::json::parse(json.out)["loops"]["dependencies"].size(), 1u);
}

}  // namespace

}  // namespace momenta::golden::dae_program
