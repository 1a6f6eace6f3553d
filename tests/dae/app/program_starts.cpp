// Start values given beside a scene (--at), whatever format it has, and what a run says of its
// method.

#include "dae/app/program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace momenta::golden::dae_program_starts {
namespace {

using nlohmann::json;

std::string model(const std::string& name) {
  return "'" + (fs::path(MOMENTA_SOURCE_DIR) / "examples" / "models" / name).string() + "'";
}

class GivenStarts : public Program {
 protected:
  /// First row of the trajectory by column.
  json first_row(const std::string& arguments) {
    const fs::path out = folder_ / "out";
    fs::remove_all(out);
    const Outcome o =
        call("run " + arguments + " --end 0.01 --samples 1 --quiet --out '" + out.string() + "'");
    EXPECT_EQ(o.status, 0) << arguments << o.err;
    std::ifstream in(out / "trajectory.csv");
    std::string names, values;
    while (std::getline(in, names) && names.rfind("#", 0) == 0) continue;
    std::getline(in, values);
    json row;
    std::istringstream columns(names), numbers(values);
    for (std::string name, number;
         std::getline(columns, name, ',') && std::getline(numbers, number, ',');)
      row[name.substr(0, name.find(" ["))] = number.empty() ? json() : json(std::stod(number));
    return row;
  }
};

TEST_F(GivenStarts, AreTakenByEveryFormat) {
  const json urdf =
      first_row(model("ur5/ur5_robot.urdf") +
                R"( --at '{"q": {"elbow_joint": 0.7}, "v": {"wrist_1_joint": -0.3}}')");
  EXPECT_EQ(urdf["elbow_joint.q"], 0.7);
  EXPECT_EQ(urdf["wrist_1_joint.u"], -0.3);
  EXPECT_EQ(urdf["wrist_2_joint.q"], 0);

  const json mjcf =
      first_row(model("mujoco_small/humanoid.xml") + R"( --at '{"q": {"knee_right": -0.4}}')");
  EXPECT_NEAR(mjcf["knee_right.q"].get<double>(), -0.4, 1e-15);

  // A first guess: the loops close around what is held, the crank; of its rate, to rounding.
  const fs::path state = write("state.json", R"({"q": {"O": 1.2}, "v": {"O": 2}})");
  const json bar = first_row("'" + example("four_bar") + "' --at '" + state.string() + "'");
  EXPECT_EQ(bar["O.q"], 1.2);
  EXPECT_NEAR(bar["O.u"].get<double>(), 2, 1e-12);
  const Outcome checked = call("check '" + example("four_bar") + "' --at '" + state.string() + "'");
  EXPECT_EQ(checked.status, 0) << checked.err;
}

TEST_F(GivenStarts, WithErrorsAreRefusedByName) {
  const std::string bar = "run '" + example("four_bar") + "' --at ";
  expect_refused(bar + R"('{"q": {"P": 1}}')", "key 'q': joint 'P' is not in the scene");
  expect_refused(bar + R"('{"q": {"O": [1, 2]}}')",
                 "key 'q', joint 'O': found an array of 2, expected 1 number");
  expect_refused(bar + R"('{"t": 1}')", "key 't' is not known");
  expect_refused(bar + R"('{"q": 1}')", "expected an object of joint names");
  expect_refused(bar + "'" + (folder_ / "none.json").string() + "'", "cannot be opened");
  expect_refused("run '" + example("driven") + R"(' --at '{"q": {"O": 1}}')",
                 "the joint is driven, expected no value");
}

/// A rod on a body, at x = `along` of it, with a damper far stiffer than the motion.
std::string damped_rod(const std::string& parent, double along) {
  return R"([[body]]
name = "finger"
mass = 1.0
shape = { kind = "rod", length = 1.0, axis = "x" }
[[joint]]
name = "F"
kind = "revolute"
child = "finger"
axis = "z"
position = 0.2
damping = 3000.0
parent = ")" +
         parent + "\"\norigin = { parent = [" + std::to_string(along) + ", 0, 0] }\n";
}

/// A pendulum of two rods.
const std::string finger = R"(name = "Damped finger"
gravity = [0, -9.81, 0]
run = { end = 2.0, samples = 20 }
[[body]]
name = "a"
mass = 1.0
shape = { kind = "rod", length = 1.0, axis = "x" }
[[joint]]
name = "A"
kind = "revolute"
child = "a"
axis = "z"
position = 0.5
)" + damped_rod("a", 1);

TEST_F(GivenStarts, ARunSaysWhenItsMethodChanged) {
  const std::string run = "run '" + write("finger.toml", finger).string() + "'";
  const Outcome plain = call(run);
  EXPECT_EQ(plain.status, 0) << plain.err;
  EXPECT_NE(plain.out.find("bdf went on from t = "), std::string::npos) << plain.out;
  EXPECT_NE(plain.out.find("--integrator dop853: no change"), std::string::npos) << plain.out;
  const json summary = json::parse(call(run + " --json").out);
  EXPECT_EQ(summary["changed_to"], "bdf");
  EXPECT_GE(summary["changed_at"].get<double>(), summary["stiff_from"].get<double>());

  const Outcome named = call(run + " --integrator dop853");
  EXPECT_NE(named.out.find("implicit methods take fewer: --integrator bdf"), std::string::npos)
      << named.out;
  EXPECT_TRUE(json::parse(call(run + " --integrator dop853 --json").out)["changed_to"].is_null());
}

/// Where no method with memory can take over.
TEST_F(GivenStarts, ARunHeldByStabilitySaysWhatToChoose) {
  const std::string bar = text_of(fs::path(MOMENTA_SOURCE_DIR) / "examples/four_bar/scene.toml") +
                          damped_rod("crank", 0.2);
  const std::string run = "run '" + write("bar.toml", bar).string() + "' --end 1 --samples 10 ";
  const std::string held =
      "s: steps of dop853 are as long as its stability allows, shorter than "
      "its tolerance asks for; implicit methods take fewer: ";
  for (const auto& [options, choice] :
       {std::pair{"--gauge reset", "--integrator bdf --gauge leak, or a form by ida"},
        std::pair{"--gauge flip", "--integrator bdf --gauge leak, or a form by ida"},
        std::pair{"--form projected", "--form momentum --integrator bdf, or a form by ida"}}) {
    const Outcome o = call(run + options + " --timing none");
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_NE(o.out.find(held + choice), std::string::npos) << options << o.out;
    const json summary = json::parse(call(run + options + " --timing none --json").out);
    EXPECT_NE(summary["stiffness"].get<std::string>().find(held + choice), std::string::npos);
    EXPECT_LT(summary["stiff_from"].get<double>(), 0.5) << options;
    EXPECT_TRUE(summary["changed_to"].is_null()) << options;
  }
  // What it names is taken.
  for (const char* options : {"--integrator bdf --gauge leak", "--form momentum --integrator bdf"})
    EXPECT_EQ(call(run + options + " --timing none --quiet").status, 0) << options;
  EXPECT_EQ(json::parse(call("run '" + example("four_bar") + "' --end 1 --timing none --json").out)
                .at("stiffness"),
            "");
}

TEST_F(GivenStarts, WorkPutsAMethodForStiffProblemsBesideAnExplicitOne) {
  const fs::path out = folder_ / "work", exact = folder_ / "exact";
  const std::string scene = "'" + write("finger.toml", finger).string() + "'";
  ASSERT_EQ(call("run " + scene + " --rtol 1e-11 --integrator dop853 --quiet --out '" +
                 exact.string() + "'")
                .status,
            0);
  const Outcome o = call("work " + scene + " --forms momentum --to 1e-6 --timing none --quiet" +
                         " --reference '" + (exact / "trajectory.csv").string() + "' --out '" +
                         out.string() + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  const std::string csv = text_of(out / "study.csv");
  const Outcome told = call("work " + scene + " --forms momentum --to 1e-4 --timing none" +
                            " --reference '" + (exact / "trajectory.csv").string() + "'");
  EXPECT_NE(told.out.find("Runs were not timed"), std::string::npos) << told.out;
  EXPECT_NE(csv.find(",dop853,"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",bdf,"), std::string::npos) << csv;
}

}  // namespace

}  // namespace momenta::golden::dae_program_starts
