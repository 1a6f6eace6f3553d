// What the program says of robots: stops and limits, meshes of pages and where converted scenes
// find them, controls of keys.

#include <gtest/gtest.h>

#include "dae/app/program.h"

namespace momenta::golden::dae_program_robots {
namespace {

class Robots : public Program {
 protected:
  Robots() {
    fs::create_directories(folder_ / "robot" / "meshes");
    fs::create_directories(folder_ / "there");
    write("robot/meshes/t.obj",
          "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 "
          "3 4\n");
    robot_ = write("robot/r.urdf",
                   "<robot name='r'><link name='b'/><link name='a'><inertial><mass value='1'/>"
                   "<inertia ixx='1' iyy='1' izz='1'/></inertial><visual><geometry><mesh filename="
                   "'package://robot/meshes/t.obj'/></geometry></visual></link><joint name='j' "
                   "type='prismatic'><axis xyz='0 0 1'/><parent link='b'/><child link='a'/><limit "
                   "lower='-1' upper='1'/></joint></robot>");
  }
  std::string robot() const { return "'" + robot_.string() + "'"; }
  fs::path robot_;
};

/// The meshes of a page, as its data have them.
std::string meshes_of(const std::string& page) {
  const std::size_t at = page.find("\"meshes\":");
  return at == std::string::npos ? "" : page.substr(at, page.find("\"}]", at) - at);
}

TEST_F(Robots, MeshesAreDrawnWithinTheirBytes) {
  const std::string page = call("view " + robot() + " --quiet").out;
  EXPECT_TRUE(says(meshes_of(page), "\"corners\":"));
  const Outcome none = call("view " + robot() + " --mesh-bytes 0");
  EXPECT_EQ(meshes_of(none.out), "");
  EXPECT_TRUE(says(none.err, "left out of the page: meshes (1), by --mesh-bytes 0"));
  EXPECT_TRUE(
      says(call("view " + robot() + " --mesh-bytes 20").err, "--mesh-bytes 20 does not hold"));
  expect_refused("view " + robot() + " --mesh-bytes -1", "--mesh-bytes");
  // The scene that it is converted to finds them from its own folder.
  const fs::path scene = folder_ / "there" / "s.toml";
  EXPECT_EQ(call("convert " + robot() + " '" + scene.string() + "'").status, 0);
  EXPECT_TRUE(says(text_of(scene), "file = \"../robot/meshes/t.obj\""));
  EXPECT_EQ(meshes_of(call("view '" + scene.string() + "' --quiet").out), meshes_of(page));
}

TEST_F(Robots, LimitsAreToldAndStop) {
  const std::string fall = "run " + robot() + " --end 1 --timing none --samples 1";
  const Outcome passed = call(fall);
  EXPECT_EQ(passed.status, 0) << passed.err;
  EXPECT_TRUE(says(passed.err, "joint 'j' is beyond its limits [-1, 1] m from t = 0.451"));
  EXPECT_EQ(call(fall + " --quiet").err, "");
  const Outcome stopped = call(fall + " --stops 1e4,300");
  EXPECT_TRUE(says(stopped.err, "joint 'j' is at its stops beyond [-1, 1] m from t = 0.451"));
  for (const std::string wrong : {"x", "-1", "0", "1,", "1,2,3", "1,-2", "nan"})
    expect_refused("check " + robot() + " --stops=" + wrong,
                   "--stops '" + wrong + "': expected STIFFNESS or STIFFNESS,DAMPING");
}

// A joint that is cut has no coordinate: a scene that is cut anew tells whose limits that costs.
TEST_F(Robots, LimitsOfJointsThatBecomeLoopsAreTold) {
  std::string chain = call("make closed-chain --n 60").out;
  const std::string joint = "\n[[joint]]\n";
  for (std::size_t at = 0; (at = chain.find(joint, at)) != std::string::npos;)
    chain.insert(at += joint.size(), "limits = [-9, 9]\n");
  const fs::path scene = write("chain.toml", chain), anew = folder_ / "anew.toml";
  const Outcome told = call("convert '" + scene.string() + "' '" + anew.string() + "' --recut");
  EXPECT_EQ(told.status, 0) << told.err;
  const std::string words = "left out: limits of joints that became loops: '";
  EXPECT_TRUE(says(told.err, words));
  EXPECT_TRUE(says(text_of(anew), words));
  EXPECT_EQ(call("convert '" + scene.string() + "'").err, "");
}

}  // namespace
}  // namespace momenta::golden::dae_program_robots
