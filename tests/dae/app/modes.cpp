// momenta modes as its users call it: text, files, sentences.

#include "dae/app/program.h"

#include <nlohmann/json.hpp>
#include <sstream>

namespace momenta::golden::dae_modes {
namespace {

using ModesOfTheProgram = Program;

TEST_F(ModesOfTheProgram, AreToldInATableAndInFiles) {
  const Outcome o = call("modes '" + example("four_bar") + "' --out '" + folder_.string() + "/m'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("The equilibrium is stable; joints are up to 2.87 rad or m away"),
            std::string::npos)
      << o.out;
  EXPECT_NE(o.out.find("1     oscillation  0.94215  5.9197"), std::string::npos) << o.out;

  std::istringstream csv(text_of(folder_ / "m" / "modes.csv"));
  std::string head, line;
  std::getline(csv, head);
  EXPECT_EQ(head,
            "mode,kind,s_re [1/s],s_im [rad/s],frequency [Hz],damping_ratio,O.q [rad],A.q "
            "[rad],C.q [rad]");
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("1,oscillation,0,5.91969", 0), 0u) << line;

  const auto json = nlohmann::json::parse(text_of(folder_ / "m" / "modes.json"));
  EXPECT_EQ(json["nature"], "stable");
  EXPECT_EQ(json["degrees_of_freedom"], 1);
  EXPECT_EQ(json["complete"], true);
  EXPECT_NEAR(json["modes"][0]["frequency"].get<double>(), 0.94214845, 1e-8);
  EXPECT_NEAR(json["modes"][0]["shape"]["O.q [rad]"].get<double>(), 1.76821593, 1e-8);
  EXPECT_LT(json["equilibrium"]["left"].get<double>(), 1e-12);
  EXPECT_EQ(json["equilibrium"]["lambda"].size(), 2u);
  const std::string page = text_of(folder_ / "m" / "index.html");
  EXPECT_NE(page.find("Small motions"), std::string::npos);
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org"));

  const Outcome json_alone = call("modes '" + example("four_bar") + "' --json");
  EXPECT_EQ(nlohmann::json::parse(json_alone.out)["modes"], json["modes"]);
}

TEST_F(ModesOfTheProgram, KeepToDirectoriesOfTheirOwn) {
  const fs::path out = folder_ / "m";
  ASSERT_EQ(call("modes '" + example("four_bar") + "' --quiet --out '" + out.string() + "'").status,
            0);
  expect_refused("run '" + example("four_bar") + "' --end 0.1 --out '" + out.string() + "'",
                 "holds the modes.csv of another verb");
}

TEST_F(ModesOfTheProgram, OfRobotsAndWhatFalls) {
  const std::string models = std::string(MOMENTA_SOURCE_DIR) + "/examples/models/";
  const Outcome o = call("modes '" + models + "ur5/ur5_robot.urdf' --quiet --json");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto json = nlohmann::json::parse(o.out);
  EXPECT_EQ(json["degrees_of_freedom"], 6);
  EXPECT_GE(json["rigid"].get<int>(), 1);  // the shoulder turns about the vertical
  expect_refused(
      "modes --quiet '" + models + "agility_cassie/cassie.xml'",
      "no equilibrium was found from this pose: joint 'cassie-pelvis free' is left with");
}

TEST_F(ModesOfTheProgram, RefuseWhatTheyCannotDoInOneSentence) {
  expect_refused("modes '" + example("four_bar") + "' --equilibrium start",
                 "the assembled pose is no equilibrium: joint '");
  expect_refused("modes '" + example("driven") + "' --drives running",
                 "the drives move loop 'B': no pose is at rest while they run");
  expect_refused("modes '" + example("four_bar") + "' --equilibrium up", "--equilibrium");
  expect_refused("modes '" + example("four_bar") + "' --count 0", "--count");
}

TEST_F(ModesOfTheProgram, OfDrivesHeldAndManyJoints) {
  EXPECT_NE(call("modes '" + example("driven") + "'").out.find("4.2888"), std::string::npos);
  // Rods from level: 3 modes of all, by Lanczos' method; the lowest near Bernoulli's rope. On the
  // way they fold, and steps stall by rounding at poses from which they can still fall.
  for (const int rods : {302, 310, 315}) {
    SCOPED_TRACE(rods);
    const fs::path scene = write("chain.toml", call("make chain --n " + std::to_string(rods)).out);
    const Outcome o = call("modes '" + scene.string() + "' --json --count 3 --kkt sparse");
    ASSERT_EQ(o.status, 0) << o.err;
    const auto json = nlohmann::json::parse(o.out);
    EXPECT_EQ(json["complete"], false);
    EXPECT_EQ(json["route"], "sparse");
    const double hanging = -0.5 * 9.81 * rods * rods;  // V [J]
    EXPECT_NEAR(json["equilibrium"]["potential"].get<double>(), hanging, -1e-9 * hanging);
    ASSERT_EQ(json["modes"].size(), 3u);
    const double rope = 0.5 * 2.404825557695773 * std::sqrt(9.81 / rods);
    EXPECT_NEAR(json["modes"][0]["angular_frequency"].get<double>(), rope, 1e-4 * rope);
  }
}

}  // namespace
}  // namespace momenta::golden::dae_modes
