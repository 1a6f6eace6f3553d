// Files that the program reads: kept as they are, plain, in the scene's folder, in UTF-8; and the
// words of a command line that is wrong.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "dae/app/program.h"

namespace momenta::golden::dae_program_inputs {
namespace {

const char* const one_link =
    "<robot name='r'><link name='b'/><link name='a'><inertial><mass value='1'/><inertia ixx='1' "
    "iyy='1' izz='1'/></inertial></link><joint name='j' type='continuous'><parent link='b'/><child "
    "link='a'/></joint></robot>";
const char* const one_body =
    "[[body]]\nname = 'a'\nmass = 1\nshape = { kind = 'rod', length = 1 }\n[[joint]]\nname = 'A'\n"
    "kind = 'revolute'\nchild = 'a'\n";

class Inputs : public Program {
 protected:
  std::string in(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
  /// Refused in one sentence, and in time.
  void expect_no_wait(const std::string& arguments, const std::string& mentions) const {
    const Outcome o = call(arguments, "/dev/null", "timeout 30 ");
    EXPECT_EQ(o.status, 2) << arguments << "\n" << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    EXPECT_NE(o.err.find(mentions), std::string::npos) << o.err;
  }
};

TEST_F(Inputs, AreNotWrittenOver) {
  write("r.urdf", one_link);
  fs::create_directories(folder_ / "sub");
  fs::create_symlink(folder_ / "r.urdf", folder_ / "link.toml");
  fs::create_hard_link(folder_ / "r.urdf", folder_ / "hard.toml");
  for (const std::string out : {"r.urdf", "sub/../r.urdf", "link.toml", "hard.toml"}) {
    expect_refused("convert " + in("r.urdf") + " " + in(out),
                   " is a file that the scene is read from, expected another");
    EXPECT_EQ(text_of(folder_ / "r.urdf"), one_link) << out;
  }
  write("s.toml", one_body);
  expect_refused("convert " + in("s.toml") + " " + in("s.toml"), "is a file that the scene is");
  EXPECT_EQ(text_of(folder_ / "s.toml"), one_body);
  // Nor what a model includes.
  write("part.xml", "<mujoco><body name='a'><joint/><geom size='1'/></body></mujoco>");
  write("m.xml", "<mujoco><worldbody><include file='part.xml'/></worldbody></mujoco>");
  expect_refused("convert " + in("m.xml") + " --quiet " + in("part.xml"),
                 "is a file that the scene is");
  // Nor by the results of other verbs.
  const std::string table = "t [s],A.q [rad],A.u [rad/s]\n0,0,0\n1,0,0\n";
  write("sub/trajectory.csv", table);
  expect_refused(
      "run " + in("s.toml") + " --reference " + in("sub/trajectory.csv") + " --out " + in("sub"),
      "its trajectory.csv is a file that this command reads");
  EXPECT_EQ(text_of(folder_ / "sub/trajectory.csv"), table);
  EXPECT_EQ(call("convert " + in("r.urdf") + " " + in("new.toml") + " --quiet").status, 0);
}

TEST_F(Inputs, PipesAndDevicesAreRefused) {
  for (const char* name : {"pipe.toml", "pipe.urdf", "pipe.csv", "pipe.json"})
    ASSERT_EQ(mkfifo((folder_ / name).c_str(), 0600), 0);
  write("s.toml", one_body);
  write("f.toml", std::string(one_body) + "[[function]]\nname = 'f'\nfile = 'pipe.csv'\nx = 'x'\n" +
                      "y = 'y'\n");
  for (const std::string verb : {"check ", "run ", "convert ", "evaluate "}) {
    expect_no_wait(verb + in("pipe.toml"), "a pipe or a device, expected a scene in a plain file");
    expect_no_wait(verb + in("pipe.urdf"), "a pipe or a device, expected a scene in a plain file");
    expect_no_wait(verb + in("f.toml"), "file is 'pipe.csv', which is no plain file, expected one");
  }
  expect_no_wait("check /dev/zero", "a pipe or a device");
  const std::string run = "run " + in("s.toml");
  expect_no_wait(run + " --at " + in("pipe.json"), "found a pipe or a device");
  expect_no_wait(run + " --reference " + in("pipe.csv"), "a pipe or a device");
  expect_no_wait("effort " + in("s.toml") + " --motion " + in("pipe.csv"), "pipe.csv");
}

TEST_F(Inputs, FilesOfFunctionsStayInTheFolder) {
  fs::create_directories(folder_ / "inner");
  write("secret.csv", "root,b\n0,1\n1,2\n");
  fs::create_symlink(folder_ / "secret.csv", folder_ / "inner/link.csv");
  for (const std::string& name :
       {std::string("../secret.csv"), std::string("link.csv"), (folder_ / "secret.csv").string()}) {
    write("inner/s.toml", std::string(one_body) + "[[function]]\nname = 'f'\nfile = '" + name +
                              "'\nx = 'root'\ny = 'c'\n");
    const Outcome o = call("check " + in("inner/s.toml"));
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_NE(o.err.find("which is not in the folder"), std::string::npos) << o.err;
    EXPECT_EQ(o.err.find("root"), std::string::npos) << o.err;
  }
}

// Names and paths that are not UTF-8 end in a sentence or in results, never in a crash.
TEST_F(Inputs, WhatIsNoUtf8) {
  const std::string name = "lev\xe9";
  write("m.xml", "<mujoco><worldbody><body name='" + name +
                     "'><joint/><geom size='1'/></body></worldbody></mujoco>");
  write("r.urdf", "<robot name='r'><link name='" + name + "'/></robot>");
  write("s.sdf", "<sdf version='1.9'><model name='" + name + "'><link name='a'/></model></sdf>");
  for (const std::string verb : {"run ", "evaluate ", "drift ", "check ", "convert "})
    for (const std::string file : {"m.xml", "r.urdf", "s.sdf"})
      expect_refused(verb + in(file), "is not in UTF-8, expected UTF-8");
  fs::create_directories(folder_ / name);
  write(name + "/s.toml", one_body);
  const std::string scene = in(name + "/s.toml"), out = " --out " + in(name + "/out");
  for (const std::string verb :
       {"check --json ", "evaluate ", "assemble --json ", "run --end 0.1 --timing none --json ",
        "drift --end 0.1 --timing none --forms momentum --json ", "index --json "})
    EXPECT_EQ(call(verb + scene).status, 0) << verb;
  const Outcome kept = call("run --end 0.1 --timing none " + scene + out);
  EXPECT_EQ(kept.status, 0) << kept.err;
  EXPECT_NE(text_of(folder_ / name / "out/summary.json").find("momenta"), std::string::npos);
}

TEST_F(Inputs, CommandLinesThatAreWrong) {
  const std::string run = "run '" + example("pendulum") + "' ";
  expect_refused("rnu", "verb 'rnu' is not known; expected check, ");
  expect_refused("rnu", "; did you mean 'run'?");
  expect_refused(run + "--ennd 1",
                 "run: option '--ennd' is not known, expected one of momenta run "
                 "--help; did you mean '--end'?");
  expect_refused(run + "again", "run: 'again' is one word too many, expected run SCENE [OPTIONS]");
  expect_refused("run", "run: SCENE is missing, expected run SCENE [OPTIONS]");
  expect_refused("fit '" + example("pendulum") + "'", "fit: --vary is missing, expected fit SCENE");
  expect_refused("make chain --n 1e7", "--n is '1e7', expected a whole number");
  expect_refused(run + "--end", "--end has no value, expected a number");
  expect_refused(run + "--samples 0", "--samples: found '0', expected a whole number from 1 to ");
  expect_refused(run + "--samples 1e3", "--samples: found '1e3', expected a whole number from 1");
  expect_refused(run + "--algebra planer",
                 "--algebra: found 'planer', expected one of: auto, planar or spatial; did you "
                 "mean 'planar'?");
  expect_refused(run + "--form momentm", "; did you mean 'momentum'?");
  expect_refused(run + "--integrator dop835", "; did you mean 'dop853'?");
  expect_refused(run + "--spectral-radius 2", "found '2', expected a number from 0 to 1");
  expect_refused(run + "--project --no-project", "expected one of them");
  expect_refused("move '" + example("pendulum") + "' --sweep O --to inf",
                 "--to is inf, expected a finite coordinate");
}

}  // namespace
}  // namespace momenta::golden::dae_program_inputs
