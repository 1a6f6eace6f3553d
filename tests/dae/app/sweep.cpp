// Sweeps over numbers of a scene: the same cases on one thread, several threads, several processes,
// and after a kill.

#include "dae/app/program.h"

#include <gtest/gtest.h>
#include <momenta/dae/output/sweep_report.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <csignal>
#include <set>

namespace momenta::golden::dae_sweep {
namespace {

std::string four_bar() {
  return text_of(std::string(MOMENTA_SOURCE_DIR) + "/examples/four_bar/scene.toml");
}
RunSettings short_run(const RunDefaults& defaults) {
  RunSettings s;
  s.end_time = std::min(defaults.end_time, 0.5);
  s.samples = 10;
  return s;
}
SweepRequest small_sweep() {
  SweepRequest request;
  request.text = four_bar();
  request.file = "four_bar";
  request.varied = {Varied("body.crank.mass=0.5:2:4"), Varied("gravity.1=-9.81,0,3")};
  request.settings = short_run;
  return request;
}

TEST(Sweep, ValuesOfARange) {
  EXPECT_EQ(Varied("a=1:3:5").values(), (std::vector<double>{1, 1.5, 2, 2.5, 3}));
  EXPECT_EQ(Varied("a=7:9:1").values(), (std::vector<double>{7}));
  EXPECT_EQ(Varied("a=3,1,2").values(), (std::vector<double>{3, 1, 2}));
  EXPECT_EQ(Varied("body.a=b.mass=3").place, "body.a=b.mass");
  const auto log = Varied("a=1e-3:1e3:7:log").values();
  for (int i = 0; i < 7; ++i)
    EXPECT_NEAR(log[static_cast<std::size_t>(i)] / std::pow(10.0, i - 3), 1, 1e-14);
  for (const char* wrong : {"",
                            "a",
                            "=1",
                            "a=",
                            "a=1:2:0",
                            "a=1:2:2.5",
                            "a=1:2:3:lin",
                            "a=1,,2",
                            "a=nan",
                            "a=0:1:3:log",
                            "a=1:2:99999999999",
                            "a=1 ,2",
                            "a,=1",
                            ",a=1",
                            "a=normal:1",
                            "a=normal:1:0",
                            "a=normal:1:2:3",
                            "a=0:1:log",
                            "a=log",
                            "a=1:log"})
    EXPECT_THROW(Varied{wrong}, std::invalid_argument) << wrong;
}

TEST(Sweep, EveryCombinationOnceTheLastChangingFastest) {
  const SweepRequest request = small_sweep();
  ASSERT_EQ(request.cases(), 12u);
  std::set<std::vector<double>> seen;
  for (std::size_t i = 0; i < 12; ++i) seen.insert(request.values(i));
  EXPECT_EQ(seen.size(), 12u);
  EXPECT_EQ(request.values(1), (std::vector<double>{0.5, 0}));
  EXPECT_EQ(request.values(3), (std::vector<double>{1, -9.81}));
  SweepRequest endless = request;
  endless.varied.assign(8, Varied("a=1:2:100"));
  EXPECT_THROW(endless.cases(), std::invalid_argument);
}

/// A case is the run of the scene with that number written into it.
TEST(Sweep, ACaseIsTheRunOfItsScene) {
  SweepRequest request = small_sweep();
  request.watched = {"A.q", "t"};
  const SweepCase made = run_case(request, 3);
  ASSERT_EQ(made.status, "done") << made.reason;
  Scene scene = parse_scene(request.text, "four_bar", {});
  for (BodySpec& body : scene.bodies)
    if (body.name == "crank") body.mass = 1;
  scene.gravity.y() = -9.81;
  const Mechanism mechanism(scene);
  RunRequest one;
  one.settings = short_run(scene.run);
  one.keep_trajectory = true;
  const RunResult run = run_form(mechanism, assemble(mechanism).start, one);
  EXPECT_EQ(made.position_drift_max, run.position_drift_max);
  EXPECT_EQ(made.energy_error_max, run.energy_error_max);
  EXPECT_EQ(made.steps, run.counters.steps);
  ASSERT_EQ(made.watched.size(), 2u);
  const auto& columns = run.trajectory.columns;
  const auto a = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "A.q [rad]") -
                                          columns.begin());
  EXPECT_EQ(made.watched[0].last, run.trajectory.rows.back()[a]);
  double least = 1e300, greatest = -1e300;
  for (const auto& row : run.trajectory.rows) {
    least = std::min(least, row[a]);
    greatest = std::max(greatest, row[a]);
  }
  EXPECT_EQ(made.watched[0].least, least);
  EXPECT_EQ(made.watched[0].greatest, greatest);
  EXPECT_EQ(made.watched[1].last, 0.5);
}

TEST(Sweep, WhatIsWrongWithACaseIsInTheCase) {
  SweepRequest request = small_sweep();
  request.varied = {Varied("body.crank.mass=1,-1"), Varied("loop.B.origin.child.0=1.5,15")};
  const auto made = [&](std::size_t i) { return run_case(request, i); };
  EXPECT_EQ(made(0).status, "done");
  EXPECT_EQ(made(1).status, "refused");
  EXPECT_NE(made(1).reason.find("stays open"), std::string::npos) << made(1).reason;
  EXPECT_EQ(made(2).status, "refused");
  EXPECT_NE(made(2).reason.find("mass"), std::string::npos) << made(2).reason;
  // What is wrong with all of them ends the study.
  for (const char* place :
       {"body.crnk.mass=1", "gravity.3=1", "body.crank=1", "name=1", "body.crank.mass.x=1"}) {
    request.varied = {Varied(place)};
    EXPECT_THROW(made(0), std::invalid_argument) << place;
  }
  request.varied = {Varied("gravity.0=0")};
  request.watched = {"nothing"};
  EXPECT_THROW(made(0), std::invalid_argument);
}

TEST(Sweep, TablesHaveAHeadingForEachColumn) {
  SweepRequest request = small_sweep();
  request.watched = {"A.q", "energy"};
  std::vector<SweepCase> cases;
  const auto expect_columns = [&](std::size_t columns) {
    std::istringstream table(sweep_table(request, cases));
    for (std::size_t i = 0; i <= cases.size(); ++i) {
      std::string line, cell;
      std::getline(table, line);
      std::size_t cells = 0;  // two blanks and more between them
      for (std::size_t at = 0; at != std::string::npos; ++cells) {
        at = line.find("  ", at);
        at = line.find_first_not_of(' ', at);
      }
      EXPECT_EQ(cells, columns) << line;
    }
  };
  cases.assign(1, run_case(request, 0));
  const std::size_t varied = request.varied.size();
  expect_columns(varied + 1 + 3 + 1 + 2);  // status, two drifts and the energy, steps
  cases.back().angle_drift_max = cases.back().angle_rate_drift_max = 1e-3;
  cases.push_back(run_case(request, 1));
  expect_columns(varied + 1 + 5 + 1 + 2);
  for (SweepCase& c : cases) {
    const std::vector<double> values = c.values;
    c = SweepCase();
    c.values = values;
    c.status = "refused";
    c.watched.resize(2);
  }
  expect_columns(varied + 1 + 0 + 1 + 2);
}

class SweepProgram : public Program {
 protected:
  std::string sweep(const std::string& out) const {
    return "sweep '" + example("four_bar") +
           "' --vary body.crank.mass=0.5:2:8 --vary body.rocker.mass=-1,1,2 --end 600 --watch "
           "A.q,energy --out '" +
           (folder_ / out).string() + "'";
  }
  std::string csv(const std::string& out) const { return text_of(folder_ / out / "sweep.csv"); }
};

TEST_F(SweepProgram, ThreadsProcessesAndKillsChangeNothing) {
  ASSERT_EQ(call(sweep("one") + " --threads 1").status, 0) << text_of(folder_ / "stderr");
  const std::string expected = csv("one");
  EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 25);
  EXPECT_NE(expected.find("refused"), std::string::npos);
  ASSERT_EQ(call(sweep("four") + " --threads 4").status, 0);
  EXPECT_EQ(csv("four"), expected);

  const fs::path journal = folder_ / "killed" / "runs.jsonl";
  ASSERT_EQ(status_when_killed(sweep("killed") + " --threads 2", journal, 6), 128 + SIGKILL);
  ASSERT_FALSE(fs::exists(folder_ / "killed" / "sweep.csv"));
  const Outcome resumed = call(sweep("killed"));
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_NE(resumed.err.find("of 24 runs taken from"), std::string::npos) << resumed.err;
  EXPECT_EQ(csv("killed"), expected);
  EXPECT_FALSE(fs::exists(journal));
  const auto json = nlohmann::json::parse(text_of(folder_ / "killed" / "sweep.json"));
  EXPECT_EQ(json.at("cases"), 24);
  EXPECT_EQ(json.at("status").at("refused"), 8);
  EXPECT_EQ(json.at("status").at("done"), 16);

  if (!MOMENTA_WITH_MPI || std::system("command -v mpirun >/dev/null") != 0) return;
  // Under sanitizers: Open MPI leaves what it allocated to the system.
  const std::string quiet = "ASAN_OPTIONS=detect_leaks=0 ";
  const std::string three = " mpirun --allow-run-as-root --oversubscribe -n 3 ";
  const Outcome ranks = call(sweep("ranks"), "/dev/null", quiet + "timeout 600" + three);
  EXPECT_EQ(ranks.status, 0) << ranks.err;
  EXPECT_EQ(csv("ranks"), expected);
  const auto shared = nlohmann::json::parse(text_of(folder_ / "ranks" / "sweep.json"));
  EXPECT_EQ(shared.at("processes"), 3);
  // What rank 0 alone can tell is told, and nobody waits for it.
  fs::create_directories(folder_ / "foreign");
  std::ofstream(folder_ / "foreign" / "study.csv") << "another verb's";
  const Outcome refused = call(sweep("foreign"), "/dev/null", quiet + "timeout 60" + three);
  EXPECT_EQ(refused.status, 2) << refused.err;
  EXPECT_NE(refused.err.find("study.csv of another verb"), std::string::npos) << refused.err;
}

/// Cases in parts, as the tasks of an array of jobs make them, are the cases in one.
TEST_F(SweepProgram, TasksMakeTheSameSample) {
  const auto sample = [&](const std::string& out) {
    return "sweep '" + example("four_bar") +
           "' --vary body.crank.mass=normal:1:0.1 --vary "
           "body.rocker.mass,body.coupler.mass=1:2 --sample latin --points 4 --indices --seed 3 "
           "--end 0.5 --samples 10 --watch A.q --out '" +
           (folder_ / out).string() + "'";
  };
  ASSERT_EQ(call(sample("one") + " --threads 1").status, 0) << text_of(folder_ / "stderr");
  for (const char* task : {"1/3", "2/3", "3/3"}) {
    const Outcome made = call(sample("parts") + " --task " + task);
    EXPECT_EQ(made.status, 0) << made.err;
    EXPECT_NE(made.err.find(std::string("task ") + task), std::string::npos) << made.err;
    EXPECT_FALSE(fs::exists(folder_ / "parts" / "sweep.csv"));
  }
  // Two cases of the last task are missing: they are made.
  const fs::path third = folder_ / "parts" / "task-3-of-3.jsonl";
  std::vector<std::string> lines;
  std::istringstream in(text_of(third));
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 6u);  // of 16 cases numbers 2, 5, 8, 11, 14
  std::string fewer;
  for (std::size_t i = 0; i < 4; ++i) fewer += lines[i] + "\n";
  std::ofstream(third, std::ios::binary) << fewer;
  const Outcome joined = call(sample("parts") + " --threads 2");
  EXPECT_EQ(joined.status, 0) << joined.err;
  EXPECT_NE(joined.err.find("14 of 16 runs taken from 3 tasks"), std::string::npos) << joined.err;
  for (const char* file : {"sweep.csv", "statistics.csv", "curves.csv"}) {
    EXPECT_EQ(text_of(folder_ / "parts" / file), text_of(folder_ / "one" / file)) << file;
    EXPECT_GT(text_of(folder_ / "one" / file).size(), 200u) << file;
  }
  for (const auto& entry : fs::directory_iterator(folder_ / "parts"))
    EXPECT_FALSE(entry.path().extension() == ".jsonl") << entry.path();
  const auto json = nlohmann::json::parse(text_of(folder_ / "parts" / "sweep.json"));
  EXPECT_EQ(json.at("sampling").at("kind"), "latin");
  EXPECT_EQ(json.at("varied").at(0).at("distribution"), "normal");
  EXPECT_EQ(json.at("statistics").at("A.q last").at("count"), 8);
  EXPECT_EQ(json.at("statistics").at("A.q last").at("index_rows"), 4);
  EXPECT_TRUE(json.at("statistics")
                  .at("A.q last")
                  .at("indices")
                  .at("body.rocker.mass,body.coupler.mass")
                  .at("total")
                  .is_number());
  EXPECT_EQ(json.at("along_time").at("A.q").at("q95").size(), 11u);
  const std::string page = text_of(folder_ / "parts" / "index.html");
  EXPECT_NE(page.find("Parts of the variance"), std::string::npos);
  EXPECT_NE(page.find("A.q [rad] along time"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST_F(SweepProgram, PartsOfAnotherBuildAreNotJoined) {
  const std::string scene = "sweep '" + example("four_bar") + "' --vary body.crank.mass=1,2 ",
                    out = "--end 0.1 --out '" + (folder_ / "parts").string() + "'";
  ASSERT_EQ(call(scene + out + " --task 1/2").status, 0);
  const fs::path part = folder_ / "parts" / "task-1-of-2.jsonl";
  std::string text = text_of(part);
  const auto at = text.find("\"build\":\"");
  ASSERT_NE(at, std::string::npos);
  text.replace(at + 9, 4, "none");
  std::ofstream(part, std::ios::binary) << text;
  expect_refused(scene + out, "was made by another build or on another processor");
  EXPECT_EQ(text_of(part), text);
  expect_refused(scene + "--task 1/2", "expected --out DIR");
  for (const char* wrong : {"0/2", "3/2", "1", "1/2/3", "a/b", "1/0"})
    expect_refused(scene + out + " --task " + wrong, "expected I/N");
}

TEST_F(SweepProgram, RefusesWhatItCannotSample) {
  const std::string scene = "sweep '" + example("four_bar") + "' ";
  expect_refused(scene + "--vary body.crank.mass=1:2", "expected --sample random, latin or sobol");
  expect_refused(scene + "--vary body.crank.mass=normal:1:0 --sample sobol", "above zero");
  expect_refused(scene + "--vary body.crank.mass=1,2 --points 3", "without a sample");
  expect_refused(scene + "--vary body.crank.mass=1,2 --indices", "without a sample");
  expect_refused(scene + "--vary body.crank.mass=1:2 --sample halton", "halton");
  expect_refused(scene + "--vary gravity.1,gravity.1=1:2 --sample sobol", "varied twice");
  expect_refused(scene + "--vary gravity.1=1:2 --sample sobol --points 5000000 --indices",
                 "expected 1 to");
}

TEST_F(SweepProgram, RefusesWhatItCannotVary) {
  const std::string scene = "sweep '" + example("four_bar") + "' ";
  expect_refused(scene + "--vary body.crank.mass=1:2:3:4", "PLACE=FROM:TO:COUNT");
  expect_refused(scene + "--vary body.crnk.mass=1:2:3", "no body of that name");
  expect_refused(scene + "--vary body.crank.mass=1:2:3 --watch speed", "no such column");
  expect_refused("sweep nowhere.toml --vary a=1", "nowhere.toml");
}

}  // namespace

}  // namespace momenta::golden::dae_sweep
