// The program as its users meet it: exit status, one sentence on standard error, nothing
// half-written.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

struct Outcome {
  int status = -1;
  std::string out, err;
};

class Program : public testing::Test {
 protected:
  Program() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              ("momenta_program_" + std::string(test->name()) + "_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Program() override { fs::remove_all(folder_); }

  Outcome call(const std::string& arguments) const {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const std::string command = std::string(MOMENTA_BINARY_DIR) + "/dae/momenta " + arguments +
                                " >'" + out.string() + "' 2>'" + err.string() + "' </dev/null";
    const int raw = std::system(command.c_str());  // NOLINT: the command is this test's own
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw), text_of(out), text_of(err)};
  }
  static std::string example(const std::string& name) {
    return std::string(MOMENTA_SOURCE_DIR) + "/examples/" + name + "/scene.toml";
  }
  fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  void expect_refused(const std::string& arguments, const std::string& mentions) const {
    const Outcome o = call(arguments);
    EXPECT_EQ(o.status, 2) << arguments << "\n" << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    EXPECT_EQ(o.err.rfind("momenta: ", 0), 0u) << o.err;
    EXPECT_NE(o.err.find(mentions), std::string::npos)
        << "expected '" << mentions << "' in: " << o.err;
    EXPECT_TRUE(o.out.empty()) << o.out;
  }

  fs::path folder_;
};

TEST_F(Program, RefusesEveryBrokenSceneAndWritesNothing) {
  int scenes = 0;
  for (const auto& entry :
       fs::directory_iterator(std::string(MOMENTA_SOURCE_DIR) + "/tests/unit/broken_scenes")) {
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
           "' --integrator rk4 --step 1e-6 --end 100 --samples 100000 --cpu-limit 0.2 --out '" +
           results.string() + "'");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.err.rfind("momenta: the run stopped: ", 0), 0u) << o.err;
  const auto summary = nlohmann::json::parse(text_of(results / "summary.json"));
  EXPECT_EQ(summary.at("status"), "time limit");
  const std::string trajectory = text_of(results / "trajectory.csv");
  EXPECT_GT(std::count(trajectory.begin(), trajectory.end(), '\n'), 2);
}

TEST_F(Program, DriftWritesPageTableAndJson) {
  const fs::path results = folder_ / "results";
  const Outcome o =
      call("drift '" + example("four_bar") +
           "' --integrator dop853 --end 0.5 --samples 50 --json --out '" + results.string() + "'");
  ASSERT_EQ(o.status, 0) << o.err;
  const auto runs = nlohmann::json::parse(o.out);
  ASSERT_TRUE(runs.is_array());
  EXPECT_EQ(runs.size(), 14u);
  for (const auto& run : runs) EXPECT_EQ(run.at("status"), "done") << run.at("form");
  EXPECT_EQ(nlohmann::json::parse(text_of(results / "summary.json")), runs);
  EXPECT_NE(text_of(results / "index.html").find("<!doctype html>"), std::string::npos);
  const std::string csv = text_of(results / "study.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 15);
}

TEST_F(Program, FamiliesItMakesAreScenesItReads) {
  for (const std::string family : {"chain --n 5", "n-four-bar --n 3"}) {
    const Outcome made = call("make " + family);
    ASSERT_EQ(made.status, 0) << made.err;
    const Outcome checked = call("check --json '" + write("made.toml", made.out).string() + "'");
    ASSERT_EQ(checked.status, 0) << checked.err;
    const auto check = nlohmann::json::parse(checked.out);
    EXPECT_EQ(check.at("mobility"), family[0] == 'c' ? 5 : 1);
  }
}

}  // namespace
