// What ends a run from outside: signals, kills at any moment, a disk that is full. Samples until
// then are kept, a file under its final name is whole, and the same command gives what it would
// have given undisturbed.

#include "dae/app/program.h"

#include <momenta/dae/output/part_file.h>
#include <sys/mount.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

namespace momenta::golden::dae_stopped {
namespace {

using nlohmann::json;

std::ptrdiff_t lines_of(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

/// Without what a clock says.
json untimed(json told) {
  if (told.is_object())
    for (const char* key : {"time", "environment", "cpu_s", "wall_s", "command", "repeats", "date"})
      told.erase(key);
  if (told.is_structured())
    for (auto& member : told) member = untimed(member);
  return told;
}

class Stopped : public Program {
 protected:
  /// The shell's status of a command that gets a signal after so many seconds; of its own where it
  /// was faster. The seconds count from when the run has so many `lines` in `out`, if that is
  /// named.
  int signalled(const std::string& arguments, int number, double after, const std::string& out = "",
                int lines = 1) const {
    const std::string part = (folder_ / out / "trajectory.csv.part").string();
    const std::string wait = "for i in $(seq 3000); do [ \"$(cat '" + part +
                             "' 2>/dev/null | wc -l)\" -ge " + std::to_string(lines) +
                             " ] && break; sleep 0.01; done; ";
    const std::string command = program() + arguments + " >'" + (folder_ / "said").string() +
                                "' 2>'" + (folder_ / "err").string() + "' & pid=$!; " +
                                (out.empty() ? "" : wait) + "sleep " + std::to_string(after) +
                                "; kill -" + std::to_string(number) +
                                " $pid 2>/dev/null; wait $pid 2>/dev/null";
    return WEXITSTATUS(std::system(command.c_str()));  // NOLINT: the command is this test's own
  }
  /// The shell's status of a command that gets a signal once `file` holds something. One that was
  /// done before anybody looked is begun again.
  int signalled_at(const std::string& arguments, int number, const fs::path& file) const {
    const std::string command = program() + arguments + " >'" + (folder_ / "said").string() +
                                "' 2>'" + (folder_ / "err").string() +
                                "' & pid=$!; for i in $(seq 30000); do [ -s '" + file.string() +
                                "' ] && break; kill -0 $pid 2>/dev/null || break; sleep 0.001; "
                                "done; kill -" +
                                std::to_string(number) + " $pid 2>/dev/null; wait $pid 2>/dev/null";
    for (int more = 20;; --more) {
      const int status = WEXITSTATUS(std::system(command.c_str()));  // NOLINT: this test's own
      if (status != 0 || more == 0) return status;
      fs::remove_all(file.parent_path());
    }
  }
  std::string err() const { return text_of(folder_ / "err"); }
  std::string at(const std::string& out) const {
    return " --quiet --out '" + (folder_ / out).string() + "'";
  }
  json summary(const std::string& out) const {
    return json::parse(text_of(folder_ / out / "summary.json"));
  }
};

/// A small disk of its own; not there where there is no right to mount one.
class Disk {
 public:
  Disk(const fs::path& at, const std::string& size) : at_(at) {
    fs::create_directories(at);
    there_ = ::mount("tmpfs", at.c_str(), "tmpfs", 0, ("size=" + size).c_str()) == 0;
  }
  ~Disk() {
    if (there_) ::umount(at_.c_str());
  }
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;
  explicit operator bool() const { return there_; }

 private:
  fs::path at_;
  bool there_ = false;
};

/// A hundred samples a second of a motion of hours.
const std::string endless = " --integrator rk4 --step 1e-4 --end 1e4 --samples 1000000";

TEST_F(Stopped, BySignalsRunsKeepTheirSamples) {
  const std::string scene = "run '" + example("four_bar") + "'";
  for (const int number : {SIGINT, SIGTERM}) {
    EXPECT_EQ(signalled(scene + endless + at("out"), number, 0.2, "out", 4), 1);
    EXPECT_EQ(err().rfind("momenta: the run stopped: interrupted at t = ", 0), 0u) << err();
    const auto told = summary("out");
    EXPECT_EQ(told["status"], "failed");
    EXPECT_EQ(told["reason"].get<std::string>().rfind("interrupted at t = ", 0), 0u);
    const std::string trajectory = text_of(folder_ / "out/trajectory.csv");
    EXPECT_EQ(trajectory.back(), '\n');
    // A hundred a second of the motion, the start and the line of names.
    // Of a sample at which it stopped, but for rounding, either.
    const double samples = 100 * told["stopped_at"].get<double>();
    EXPECT_GE(lines_of(trajectory), std::floor(samples - 1e-6) + 2);
    EXPECT_LE(lines_of(trajectory), std::floor(samples + 1e-6) + 2);
    EXPECT_GT(lines_of(trajectory), 3);
  }
  // Where no sample is near, the next step is.
  EXPECT_EQ(signalled(scene + " --integrator rk4 --step 1e-4 --end 1e6 --samples 1" + at("far"),
                      SIGTERM, 0.2, "far"),
            1);
  EXPECT_GT(summary("far")["stopped_at"], 0.0);
}

TEST_F(Stopped, WhileItIsTimedARunIsDone) {
  // Some seconds of motion, then as long for each of three timed rounds.
  const std::string command = "run '" + example("four_bar") +
                              "' --integrator rk4 --step 1e-4 --end 100 --samples 10" +
                              at("timed") + " & pid=$!; while kill -0 $pid && [ \"$(cat '" +
                              (folder_ / "timed/trajectory.csv.part").string() +
                              "' 2>/dev/null | wc -l)\" -lt 12 ]; do sleep 0.01; done; "
                              "kill -TERM $pid; wait $pid";
  const int raw = std::system((program() + command).c_str());  // NOLINT: this test's own
  EXPECT_EQ(WEXITSTATUS(raw), 0);
  EXPECT_EQ(summary("timed")["status"], "done");
  EXPECT_EQ(summary("timed")["reason"], "");
  EXPECT_EQ(lines_of(text_of(folder_ / "timed/trajectory.csv")), 12);
}

TEST_F(Stopped, VerbsThatKeepNothingEndAtOnce) {
  const Outcome made = call("make closed-chain --n 20000");
  ASSERT_EQ(made.status, 0);
  const fs::path scene = write("long.toml", made.out);
  EXPECT_EQ(signalled("modes '" + scene.string() + "' --count 5", SIGTERM, 0.2), 128 + SIGTERM);
}

TEST_F(Stopped, AKilledRunLeavesItsLinesAndEarlierResults) {
  const std::string command = "run '" + example("four_bar") + "'" + endless + at("out");
  const std::string before = "run '" + example("four_bar") + "' --end 1 --samples 10" + at("out");
  ASSERT_EQ(call(before).status, 0);
  const std::string trajectory = text_of(folder_ / "out/trajectory.csv"),
                    told = text_of(folder_ / "out/summary.json");
  EXPECT_EQ(signalled_at(command, SIGKILL, folder_ / "out/checkpoint.json"), 128 + SIGKILL);
  EXPECT_EQ(text_of(folder_ / "out/trajectory.csv"), trajectory);
  EXPECT_EQ(text_of(folder_ / "out/summary.json"), told);
  const std::string part = text_of(folder_ / "out/trajectory.csv.part");
  EXPECT_GT(lines_of(part), 1);
  // Another command leaves them alone, until it is made sure that they are not wanted.
  const Outcome refused = call(before);
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(says(refused.err, "checkpoint.json belongs to an unfinished run, '"));
  EXPECT_EQ(text_of(folder_ / "out/trajectory.csv.part"), part);
  fs::remove(folder_ / "out/checkpoint.json");
  ASSERT_EQ(call(before).status, 0);
  EXPECT_EQ(text_of(folder_ / "out/trajectory.csv"), trajectory);
  for (const auto& entry : fs::directory_iterator(folder_ / "out"))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

class RunsThatGoOn : public Stopped {
 protected:
  RunsThatGoOn() {
    EXPECT_EQ(call(command_ + " --out '" + (folder_ / "whole").string() + "'").status, 0);
  }
  int killed(int number = SIGKILL) const {
    return signalled_at(command_ + out_, number, checkpoint_);
  }
  void expect_whole() const {
    EXPECT_EQ(text_of(folder_ / "out/trajectory.csv"), text_of(folder_ / "whole/trajectory.csv"));
    EXPECT_EQ(untimed(summary("out")), untimed(summary("whole")));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), {}), 3);
  }

  const std::string scene_ = "run '" + example("four_bar") + "' --timing none ";
  const std::string command_ = scene_ + "--end 10 --samples 4000 --integrator rk4 --step 1e-5";
  const std::string out_ = " --out '" + (folder_ / "out").string() + "'";
  const fs::path checkpoint_ = folder_ / "out/checkpoint.json",
                 part_ = folder_ / "out/trajectory.csv.part";
};

TEST_F(RunsThatGoOn, FromTheirCheckpointAfterKillsAndInterruptions) {
  for (const int number : {SIGKILL, SIGTERM}) {
    ASSERT_EQ(killed(number), number == SIGKILL ? 128 + SIGKILL : 1);
    ASSERT_TRUE(fs::exists(checkpoint_));
    std::ofstream(checkpoint_.string() + ".part") << "{\"study\": ";  // killed as it wrote another
    const Outcome o = call(command_ + out_);
    EXPECT_EQ(o.status, 0);
    EXPECT_EQ(o.err.rfind("momenta: the run goes on from t = ", 0), 0u) << o.err;
    EXPECT_EQ(lines_of(o.err), 1) << o.err;
    expect_whole();
  }
  // What was interrupted has its results, which any next run replaces.
  ASSERT_EQ(killed(SIGTERM), 1);
  EXPECT_EQ(call(scene_ + "--end 1" + out_).status, 0);
  EXPECT_FALSE(fs::exists(checkpoint_));
}

TEST_F(RunsThatGoOn, OrSayWhyTheyAreBegunAnew) {
  // IDA's history is not written down.
  const std::string ida = scene_ + "--end 1000 --samples 4000 --form momentum-index2" + out_;
  ASSERT_EQ(signalled_at(ida, SIGKILL, part_), 128 + SIGKILL);
  const Outcome anew = call(ida);
  EXPECT_EQ(anew.status, 0);
  EXPECT_EQ(anew.err, "momenta: " + part_.string() +
                          " of a run that was killed has no checkpoint beside it: begun anew\n");
  // Nor does a file serve that is no checkpoint, or not of these rows.
  const auto with = [&](const std::string& text) {
    EXPECT_EQ(killed(), 128 + SIGKILL);
    std::ofstream(checkpoint_, std::ios::binary) << text;
    return call(command_ + out_);
  };
  for (const char* text : {"{\"study\": ", "[]"}) {
    const Outcome o = with(text);
    EXPECT_EQ(o.status, 0);
    EXPECT_TRUE(says(o.err, ": begun anew\n"));
    expect_whole();
  }
  EXPECT_EQ(with("{}").status, 2);  // of a run without a name
  fs::remove_all(folder_ / "out");
  EXPECT_EQ(killed(), 128 + SIGKILL);
  std::ofstream(part_, std::ios::binary) << "other rows\n";
  const Outcome others = call(command_ + out_);
  EXPECT_EQ(others.status, 0);
  EXPECT_TRUE(says(others.err, "checkpoint.json is not of the trajectory beside it: begun anew"));
  expect_whole();
}

TEST_F(Stopped, AFolderThatIsRemovedMeanwhileEndsARunAndNoStudy) {
  const auto removed = [&](const std::string& arguments, const std::string& name) {
    const std::string out = (folder_ / "out").string();
    const std::string command =
        program() + arguments + at("out") + " >/dev/null 2>'" + (folder_ / "err").string() +
        "' & pid=$!; for i in $(seq 3000); do [ -s '" + out + "/" + name +
        "' ] && break; sleep 0.01; done; mv '" + out + "' '" + out + "gone'; wait $pid";
    return WEXITSTATUS(std::system(command.c_str()));  // NOLINT: this test's own
  };
  const std::string scene = " '" + example("four_bar") + "' ";
  EXPECT_EQ(removed("run" + scene + endless, "checkpoint.json"), 1);
  EXPECT_EQ(lines_of(err()), 1) << err();
  EXPECT_EQ(err().rfind("momenta: the run stopped: at t = ", 0), 0u) << err();
  EXPECT_TRUE(says(err(), "out/trajectory.csv: No such file or directory."));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_GT(lines_of(text_of(folder_ / "outgone/trajectory.csv.part")), 1);
  fs::remove_all(folder_ / "outgone");
  // A study has all it needs in memory, and makes the folder again.
  EXPECT_EQ(removed("drift" + scene + "--end 20 --samples 50 --timing none", "runs.jsonl"), 0);
  EXPECT_EQ(err(), "");
  EXPECT_TRUE(fs::exists(folder_ / "out/summary.json"));
}

TEST_F(Stopped, WhereNoFolderCanBeNothingRuns) {
  std::ofstream(folder_ / "file") << "in the way";
  const std::string out = " --out '" + (folder_ / "file").string(),
                    scene = " '" + example("four_bar") + "'";
  for (const char* verb :
       {"run", "drift", "work", "stress", "modes", "view", "evaluate", "index", "sweep"})
    for (const char* below : {"'", "/below'"}) {
      const std::string varied =
          verb == std::string("sweep") ? " --vary body.crank.mass=1:2:2" : "";
      const Outcome o = call(verb + scene + varied + out + below);
      EXPECT_EQ(o.status, 1) << verb;
      EXPECT_EQ(lines_of(o.err), 1) << o.err;
      EXPECT_TRUE(says(o.err, "/file"));
      EXPECT_TRUE(says(o.err, ": Not a directory."));
      EXPECT_EQ(text_of(folder_ / "file"), "in the way");
    }
  // Who may not write is told so; to the system's own user everything is writable.
  if (::geteuid() == 0) return;
  fs::create_directories(folder_ / "locked");
  fs::permissions(folder_ / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  for (const char* verb : {"run", "drift", "modes"}) {
    const Outcome o = call(verb + scene + at("locked"));
    EXPECT_EQ(o.status, 1) << verb;
    EXPECT_TRUE(says(o.err, ": Permission denied."));
  }
}

TEST_F(Stopped, TwoRunsAtOnceInOneDirectoryAreRefused) {
  fs::create_directories(folder_ / "out");
  const PartFile other(folder_ / "out/trajectory.csv");
  const Outcome o = call("run '" + example("four_bar") + "' --end 1" + at("out"));
  EXPECT_EQ(o.status, 1);
  EXPECT_TRUE(says(o.err, "trajectory.csv: another process is writing it."));
}

TEST_F(Stopped, WithoutRoomARunKeepsWholeLinesAndSaysSo) {
  const std::string command =
      "run '" + example("four_bar") + "' --end 20 --samples 20000 --quiet --out ";
  ASSERT_EQ(call(command + "'" + (folder_ / "whole").string() + "'").status, 0);
  const std::string whole = text_of(folder_ / "whole/trajectory.csv");
  const auto expect_part = [&](const fs::path& out, const std::string& cause) {
    const std::string part = text_of(out / "trajectory.csv");
    EXPECT_GT(lines_of(part), 100);
    EXPECT_LT(lines_of(part), lines_of(whole));
    EXPECT_TRUE(whole.starts_with(part));
    EXPECT_EQ(part.back(), '\n');
    const auto told = json::parse(text_of(out / "summary.json"));
    EXPECT_EQ(told["status"], "failed");
    EXPECT_TRUE(says(told["reason"].get<std::string>(), cause)) << told["reason"];
    for (const auto& entry : fs::directory_iterator(out))
      EXPECT_NE(entry.path().extension(), ".part") << entry.path();
  };
  // A limit of the shell on the size of files, here 1 MB.
  const Outcome o =
      call(command + "'" + (folder_ / "limited").string() + "'", "/dev/null", "ulimit -f 2000; ");
  EXPECT_EQ(o.status, 1);
  EXPECT_EQ(o.err.rfind("momenta: the run stopped: at t = ", 0), 0u) << o.err;
  expect_part(folder_ / "limited", "trajectory.csv: File too large.");

  const fs::path disk = folder_ / "disk";
  const Disk small(disk, "1m");
  if (!small) GTEST_SKIP() << "no right to mount a small disk";
  const Outcome full = call(command + "'" + (disk / "out").string() + "'");
  EXPECT_EQ(full.status, 1);
  EXPECT_TRUE(says(full.err, "No space left on device"));
  expect_part(disk / "out", "trajectory.csv: No space left on device.");
  // No page of another run stands beside them, and no room at all is told before anything runs.
  EXPECT_FALSE(fs::exists(disk / "out/index.html"));
  const Outcome none = call(command + "'" + (disk / "none").string() + "'");
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(says(none.err, "No space left on device"));
  EXPECT_FALSE(fs::exists(disk / "none"));
}

TEST_F(Stopped, FilesOfAStudyAreReplacedTogetherOrNotAtAll) {
  const fs::path out = folder_ / "out";
  const std::string study = "drift '" + example("four_bar") +
                            "' --forms momentum,acceleration --samples 10 --out '" + out.string() +
                            "' --figures svg --end ";
  ASSERT_EQ(call(study + "1").status, 0);
  const auto results = [&] {
    std::map<fs::path, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(out))
      if (entry.is_regular_file() && entry.path().filename() != "runs.jsonl")
        all[entry.path()] = text_of(entry.path());
    return all;
  };
  const auto before = results();
  ASSERT_GT(before.size(), 5u);
  // The last of them cannot be written.
  const fs::path last = (--before.end())->first;
  ASSERT_EQ(last.filename(), "summary.json");
  for (const char* name : {"index.html.part", "figures/mechanism.svg.part"}) {
    fs::create_directories(out / name);
    const Outcome o = call(study + "2");
    EXPECT_EQ(o.status, 1);
    EXPECT_TRUE(says(o.err, ": Is a directory."));
    EXPECT_EQ(results(), before);
    fs::remove(out / name);
  }
  // Its runs are kept.
  const Outcome again = call(study + "2");
  EXPECT_EQ(again.status, 0);
  EXPECT_TRUE(says(again.err, " runs taken from "));
  const auto after = results();
  EXPECT_EQ(after.size(), before.size());
  for (const auto& [file, text] : after)
    if (file.filename() != "mechanism.svg") {
      EXPECT_NE(text, before.at(file)) << file;
    }
}

TEST_F(Stopped, WithoutRoomAStudyGoesOnOnceThereIsSome) {
  const fs::path disk = folder_ / "disk";
  const Disk small(disk, "1500k");
  if (!small) GTEST_SKIP() << "no right to mount a small disk";
  const std::string study = "drift '" + example("four_bar") +
                            "' --forms momentum,acceleration --end 2 --samples 10 --out '" +
                            disk.string() + "'";
  const Outcome o = call(study);
  EXPECT_EQ(o.status, 1);
  EXPECT_TRUE(says(o.err, "No space left on device."));
  EXPECT_EQ(std::distance(fs::directory_iterator(disk), {}), 1);
  ASSERT_TRUE(fs::exists(disk / "runs.jsonl"));
  ASSERT_EQ(::mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=30m"), 0);
  const Outcome again = call(study);
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(says(again.err, " runs taken from "));
  const std::string whole = folder_ / "whole";
  ASSERT_EQ(call(study.substr(0, study.find(" --out")) + " --out '" + whole + "'").status, 0);
  EXPECT_EQ(untimed(json::parse(text_of(disk / "summary.json"))),
            untimed(json::parse(text_of(whole + "/summary.json"))));
}

TEST_F(Stopped, StandardOutputThatIsFullIsTold) {
  for (const std::string& verb :
       {std::string("make chain"), "check '" + example("four_bar") + "'",
        "run '" + example("four_bar") + "' --end 0.1", std::string("completion bash")}) {
    const std::string command =
        program() + verb + " >/dev/full 2>'" + (folder_ / "err").string() + "'";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1) << verb;  // NOLINT: this test's own
    EXPECT_TRUE(
        says(err(), "momenta: standard output cannot be written: No space left on device\n"));
  }
}

// A clock on the wall steps back and forth: it dates results, and decides nothing.
TEST(Clocks, ThatCanStepDateResultsAlone) {
  int files = 0;
  for (const char* folder : {"core", "dae"})
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(MOMENTA_SOURCE_DIR) / folder)) {
      const auto type = entry.path().extension();
      if (type != ".h" && type != ".cpp") continue;
      ++files;
      const std::string source = text_of(entry.path());
      for (const char* clock :
           {"system_clock", "high_resolution_clock", "time(nullptr)", "time(NULL)", "gettimeofday",
            "CLOCK_REALTIME", "utc_clock", "last_write_time"}) {
        if (entry.path().filename() == "environment.cpp" && clock == std::string("time(nullptr)"))
          continue;
        EXPECT_FALSE(says(source, clock)) << entry.path() << ": " << clock;
      }
    }
  EXPECT_GT(files, 300);
}

// Killed at any moment, again and again, then left to end.

struct Verb {
  const char *name, *arguments;
  std::vector<const char*> tables;  ///< results without times, to the last bit
  std::vector<const char*> told;    ///< results with times
};
const Verb verbs[] = {
    {"run",
     "run FOUR_BAR --integrator rk4 --step 1e-5 --end 10 --timing once",
     {"trajectory.csv"},
     {"summary.json"}},
    {"drift", "drift FOUR_BAR --end 2 --samples 50 --timing once", {}, {"summary.json"}},
    {"work",
     "work FOUR_BAR --forms momentum,projected,momentum-index2 --from 1e-4 --to 1e-8 --end 1 "
     "--timing once",
     {"reference.csv"},
     {"summary.json"}},
    {"stress",
     "stress FOUR_BAR --forms momentum,projected,baumgarte --along size --end 0.3 --threads 2",
     {},
     {"stress.json"}},
    {"sweep",
     "sweep FOUR_BAR --vary body.crank.mass=0.5:2:20 --end 5 --threads 2",
     {"sweep.csv"},
     {}},
    {"modes", "modes FOUR_BAR", {"modes.csv"}, {}}};

class Killed : public Stopped, public testing::WithParamInterface<Verb> {
 protected:
  static double size_of(const fs::path& folder) {
    double bytes = 0;
    std::error_code gone;  // files come and go meanwhile
    for (const auto& entry : fs::directory_iterator(folder, gone)) {
      const auto size = entry.file_size(gone);
      if (!gone) bytes += static_cast<double>(size);
    }
    return bytes;
  }
  /// Whole lines of a trajectory that was not finished.
  static std::string rows_of(const fs::path& folder) {
    const std::string text = text_of(folder / "trajectory.csv.part");
    return text.substr(0, text.rfind('\n') + 1);
  }
  /// The shell's status of a command killed as soon as its folder has so many bytes.
  int killed_after_writing(const std::string& arguments, const fs::path& out, double bytes) const {
    const std::string command = "exec " + program() + arguments + " >'" +
                                (folder_ / "said").string() + "' 2>'" + (folder_ / "err").string() +
                                "'";
    const pid_t pid = ::fork();
    if (pid == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
      ::_exit(127);
    }
    int raw = 0;
    while (::waitpid(pid, &raw, WNOHANG) == 0) {
      if (size_of(out) >= bytes) ::kill(pid, SIGKILL);
      ::usleep(500);
    }
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  }
};

TEST_P(Killed, AtAnyMomentItGivesWhatItGivesUndisturbed) {
  const Verb& verb = GetParam();
  std::string arguments = verb.arguments;
  arguments.replace(arguments.find("FOUR_BAR"), 8, "'" + example("four_bar") + "'");
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(call(arguments + at("whole")).status, 0) << text_of(folder_ / "stderr");
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const fs::path whole = folder_ / "whole", out = folder_ / "killed";
  const auto expect_whole = [&](bool all) {
    for (const char* name : verb.tables)
      if (all || fs::exists(out / name)) {
        EXPECT_EQ(text_of(out / name), text_of(whole / name)) << name;
      }
    for (const char* name : verb.told)
      if (all || fs::exists(out / name)) {
        EXPECT_EQ(untimed(json::parse(text_of(out / name))),
                  untimed(json::parse(text_of(whole / name))))
            << name;
      }
    if (fs::exists(out / "index.html")) {
      EXPECT_TRUE(text_of(out / "index.html").ends_with("</html>\n"));
    }
  };
  // Kept by then: whole lines of the journal; of a run, the rows and the time it goes on from.
  const auto lines_kept = [&] {
    const std::string text = text_of(out / "runs.jsonl");
    return text.substr(0, text.rfind('\n') + 1);
  };
  const auto time_kept = [&] {
    const json kept = json::parse(text_of(out / "checkpoint.json"), nullptr, false);
    return kept.is_object() ? kept["run"]["t"].get<double>() : 0.0;
  };
  std::random_device random;
  const char* asked = std::getenv("MOMENTA_KILLS");  // NOLINT: tests have one thread
  const int kills = asked ? std::atoi(asked) : 4;
  int killed = 0, tries = 0, went_on = 0;
  double longest = seconds;
  while (killed < kills && tries < 50 * kills) {
    const std::string lines = lines_kept();
    const double time = time_kept();
    const double share = std::uniform_real_distribution<double>(0, 1)(random);
    SCOPED_TRACE("try " + std::to_string(++tries) + ", " + std::to_string(share));
    // By a clock, or once something more is on the disk.
    const int status = tries % 2 == 1
                           ? signalled(arguments + at("killed"), SIGKILL, share * longest)
                           : killed_after_writing(arguments + at("killed"), out,
                                                  size_of(out) + 0.3 * size_of(whole) * share);
    EXPECT_TRUE(status == 128 + SIGKILL || status == 0) << status << err();
    // Done before the kill: it is quicker than when it was timed.
    if (status == 0 && tries % 2 == 1) longest = std::max(0.6 * longest, 0.02 * seconds);
    killed += status != 0;
    expect_whole(status == 0);
    if (status == 0) {
      fs::remove_all(out);
      continue;
    }
    if ((!lines.empty() && !fs::exists(out / "runs.jsonl")) ||
        (time > 0 && !fs::exists(out / "checkpoint.json"))) {
      expect_whole(true);  // all results were there already
    } else {
      EXPECT_TRUE(lines_kept().starts_with(lines));
      EXPECT_GE(time_kept(), time);
    }
    EXPECT_TRUE(text_of(whole / "trajectory.csv").starts_with(rows_of(out)));
    went_on += time > 0 || lines.size() > 1;
  }
  EXPECT_EQ(killed, kills) << tries << " tries";
  RecordProperty("kills", killed);
  RecordProperty("went_on", went_on);
  if (asked) std::printf("%s: %d kills, of them %d after it went on\n", verb.name, killed, went_on);
  EXPECT_EQ(call(arguments + at("killed")).status, 0) << text_of(folder_ / "stderr");
  expect_whole(true);
  for (const auto& entry : fs::directory_iterator(out)) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    EXPECT_NE(entry.path().extension(), ".jsonl") << entry.path();
    EXPECT_NE(entry.path().filename(), "checkpoint.json");
  }
}
INSTANTIATE_TEST_SUITE_P(Verbs, Killed, testing::ValuesIn(verbs),
                         [](const auto& verb) { return std::string(verb.param.name); });

}  // namespace
}  // namespace momenta::golden::dae_stopped
