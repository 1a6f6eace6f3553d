// Studies that were killed: what is done is taken over, what comes out is what an undisturbed study
// gives, and no run of another study, scene or build gets in.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/output_of.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/dae/study/drift_study.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/stress_study.h>
#include <momenta/dae/study/work_study.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>

namespace momenta::dae_resume {
namespace {

namespace fs = std::filesystem;

using equations::text_of;

/// Everything but times, to the last bit; counters of what was timed are those of any such run.
std::string told(RunResult run) {
  run.cpu_s = run.wall_s = 0;
  run.repeats = 0;
  return record_of(run).dump();
}

class Resume : public testing::Test {
 protected:
  Resume()
      : folder_(fs::temp_directory_path() /
                ("momenta_resume_" +
                 std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "_" +
                 std::to_string(getpid()))),
        mechanism_(equations::example("four_bar")),
        start_(equations::start_of(mechanism_)) {
    fs::remove_all(folder_);
  }
  ~Resume() override { fs::remove_all(folder_); }

  fs::path file() const { return folder_ / "runs.jsonl"; }
  Journal::Study study(const std::string& digest = "one") const { return {digest, "b", "command"}; }

  DriftRequest drift() const {
    DriftRequest request;
    request.forms = {"momentum", "acceleration", "projected", "momentum-index2"};
    request.end_time = 1;
    request.samples = 20;
    return request;
  }
  /// The study up to its run number `runs`, where it is stopped.
  void stop_after(int runs, DriftRequest request) const {
    Journal journal(file(), study());
    request.journal = &journal;
    request.progress = [&](int number, int, const std::string&, double fraction) {
      return number <= runs || fraction < 0.5;
    };
    run_drift_study(mechanism_, start_, request);
  }

  fs::path folder_;
  Mechanism mechanism_;
  Start start_;
};

TEST_F(Resume, RecordsReadBackBitForBit) {
  const double huge = std::numeric_limits<double>::max(),
               tiny = std::numeric_limits<double>::denorm_min(), inf = 1 / 0.0;
  RunResult run;
  run.scene = "\"quoted\"\n ü";
  run.settings.gauge = "leak:0.1";
  run.settings.rtol = 0.1 + 0.2;
  run.settings.project = true;
  run.counters.evaluations = 1L << 62;
  run.faded_rows = {{"loop", "row", 3}};
  run.singular_crossings = {{1 / 3.0, tiny, true}};
  run.series.t = {0, -0.0, 1 / 3.0, huge, tiny, -inf, inf, not_measured};
  RunResult back;
  ASSERT_TRUE(read_record(nlohmann::json::parse(record_of(run).dump()), back));
  EXPECT_EQ(record_of(back), record_of(run));
  ASSERT_EQ(back.series.t.size(), run.series.t.size());
  for (std::size_t i = 0; i + 1 < run.series.t.size(); ++i) {
    EXPECT_EQ(back.series.t[i], run.series.t[i]);
    EXPECT_EQ(std::signbit(back.series.t[i]), std::signbit(run.series.t[i]));
  }
  EXPECT_TRUE(std::isnan(back.series.t.back()));
  EXPECT_EQ(back.settings.rtol, run.settings.rtol);
  EXPECT_EQ(back.faded_rows.at(0).evaluations, 3);
  EXPECT_FALSE(read_record(nlohmann::json::parse(R"({"scene": 3})"), back));
  EXPECT_FALSE(read_record(nlohmann::json(7), back));
}

TEST_F(Resume, DriftStudyTakesOverWhatIsDone) {
  const auto undisturbed = run_drift_study(mechanism_, start_, drift());
  ASSERT_GT(undisturbed.size(), 5u);
  for (int runs : {0, 2, 5}) {
    fs::remove(file());
    stop_after(runs, drift());
    Journal journal(file(), study());
    DriftRequest request = drift();
    request.journal = &journal;
    int made = 0;
    request.progress = [&](int, int, const std::string& label, double fraction) {
      made += fraction == 0 && label.rfind("timing", 0) != 0;  // the first sample of each run
      return true;
    };
    const auto resumed = run_drift_study(mechanism_, start_, request);
    EXPECT_EQ(journal.runs_taken(), runs);
    EXPECT_EQ(made, static_cast<int>(undisturbed.size()) - runs);
    ASSERT_EQ(resumed.size(), undisturbed.size());
    for (std::size_t i = 0; i < resumed.size(); ++i)
      EXPECT_EQ(told(resumed[i]), told(undisturbed[i])) << i;
  }
}

TEST_F(Resume, TornLineIsNotThere) {
  const auto undisturbed = run_drift_study(mechanism_, start_, drift());
  stop_after(3, drift());
  const std::string text = text_of(file());
  std::vector<std::size_t> ends;  // of lines
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') ends.push_back(i + 1);
  ASSERT_EQ(ends.size(), 4u);
  // Cut anywhere: whole lines before the cut count, and only they.
  for (std::size_t cut = 0; cut <= text.size(); cut += 1 + text.size() / 97) {
    std::ofstream(file(), std::ios::binary) << text.substr(0, cut);
    const int whole = static_cast<int>(
        std::count_if(ends.begin(), ends.end(), [&](std::size_t end) { return end <= cut; }));
    Journal journal(file(), study());
    int found = 0;
    DriftRequest request = drift();
    request.journal = &journal;
    request.progress = [](int, int, const std::string&, double) { return false; };
    run_drift_study(mechanism_, start_, request);
    found = journal.runs_taken();
    EXPECT_EQ(found, std::max(0, whole - 1)) << cut;
  }
  // And after a torn line the file goes on as if it had not been there.
  std::ofstream(file(), std::ios::binary) << text.substr(0, ends[2] + 40);
  stop_after(4, drift());
  Journal journal(file(), study());
  DriftRequest request = drift();
  request.journal = &journal;
  const auto resumed = run_drift_study(mechanism_, start_, request);
  EXPECT_EQ(journal.runs_taken(), 4);
  for (std::size_t i = 0; i < resumed.size(); ++i)
    EXPECT_EQ(told(resumed[i]), told(undisturbed[i])) << i;
}

TEST_F(Resume, RunsOfOtherStudiesStayOut) {
  stop_after(3, drift());
  const std::string mine = text_of(file());
  // Another study does not touch the file.
  EXPECT_TRUE(equations::says(
      equations::thrown<std::invalid_argument>([&] { Journal other(file(), study("two")); }),
      "unfinished study, 'command'"));
  EXPECT_EQ(text_of(file()), mine);
  // Lines of another study below one's own first line: their keys are others.
  const std::string first = mine.substr(0, mine.find('\n') + 1), others = mine.substr(first.size());
  std::string other_first = first;
  other_first.replace(other_first.find("\"one\""), 5, "\"two\"");
  std::ofstream(file(), std::ios::binary) << other_first << others;
  {
    Journal journal(file(), study("two"));
    DriftRequest request = drift();
    request.journal = &journal;
    run_drift_study(mechanism_, start_, request);
    EXPECT_EQ(journal.runs_taken(), 0);
  }
  // Other settings, other keys.
  std::ofstream(file(), std::ios::binary) << mine;
  Journal journal(file(), study());
  DriftRequest request = drift();
  request.rtol = 2e-8;
  request.journal = &journal;
  run_drift_study(mechanism_, start_, request);
  EXPECT_EQ(journal.runs_taken(), 0);
}

TEST_F(Resume, AnotherBuildBeginsAnewAndTwoAtOnceAreRefused) {
  stop_after(3, drift());
  {
    Journal same(file(), study());
    EXPECT_FALSE(same.of_another_build());
    EXPECT_THROW(Journal(file(), study()), std::invalid_argument);
  }
  {
    Journal newer(file(), {"one", "another build", "command"});
    EXPECT_TRUE(newer.of_another_build());
  }
  // Without a run it leaves nothing behind.
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_THROW(Journal("/proc/nowhere/runs.jsonl", study()), std::runtime_error);
}

TEST_F(Resume, FilesThatAreNoJournalsAreRefusedOrBegunAnew) {
  fs::create_directories(folder_);
  for (const std::string text : {"", "\n", "not json\n", "[1, 2]\n", "{}\n", "{\"study\": 3}",
                                 "{\"study\": \"one\", \"build\": \"b\"}\n{\"key\": \"\"}\n",
                                 "{\"study\": \"one\", \"build\": \"b\"}\n{\"key\": 1}\n",
                                 "{\"study\": \"one\", \"build\": \"b\"}\n\xff\xfe\n"}) {
    std::ofstream(file(), std::ios::binary) << text;
    Journal journal(file(), study());
    journal.add("k", 3);
    ASSERT_EQ(journal.trouble(), "");
  }
  Journal journal(file(), study());
  ASSERT_TRUE(journal.find("k"));
  EXPECT_EQ(*journal.find("k"), 3);
}

TEST_F(Resume, WorkStudyTakesOverRungsAndItsReference) {
  const OwnReference own = own_reference(mechanism_, start_, 0.5, 5);
  OwnReference back;
  ASSERT_TRUE(read_record(nlohmann::json::parse(record_of(own).dump()), back));
  EXPECT_EQ(back.reference.csv(), own.reference.csv());
  EXPECT_EQ(back.accuracy, own.accuracy);
  EXPECT_EQ(back.implicit, own.implicit);
  back.reference.bind(trajectory_columns(mechanism_));
  WorkRequest request;
  request.forms = {"momentum", "projected"};
  request.tolerances = {1e-4, 1e-6, 1e-8};
  request.end_time = 0.5;
  request.reference = &own.reference;
  const auto undisturbed = run_work_study(mechanism_, start_, request);
  {
    Journal journal(file(), study());
    request.journal = &journal;
    int rungs = 0;  // a first sample each
    request.progress = [&](int, int, const std::string&, double fraction) {
      rungs += fraction == 0;
      return rungs <= 4;
    };
    run_work_study(mechanism_, start_, request);
  }
  Journal journal(file(), study());
  request.journal = &journal;
  request.reference = &back.reference;
  request.progress = {};
  const auto resumed = run_work_study(mechanism_, start_, request);
  EXPECT_EQ(journal.runs_taken(), 4);
  ASSERT_EQ(resumed.size(), undisturbed.size());
  for (std::size_t i = 0; i < resumed.size(); ++i)
    EXPECT_EQ(told(resumed[i]), told(undisturbed[i])) << i;
}

TEST_F(Resume, StressStudyTakesOverRunsAndReferences) {
  Scene scene = mechanism_.scene();
  scene.run.end_time = 0.5;
  StressRequest request;
  request.ladders = {ladder_of(scene, Extreme::size, {1, 1e3, 1e6}),
                     ladder_of(scene, Extreme::mass_ratio, {1, 1e3})};
  request.contestants = {{"momentum", ""}, {"projected", ""}, {"acceleration", "rk4"}};
  request.cpu_limit = 1000;
  const auto all = [](const StressResult& result) {
    std::vector<std::string> told_of;
    for (const LadderResult& ladder : result.ladders) {
      for (const double accuracy : ladder.reference) told_of.push_back(std::to_string(accuracy));
      for (const auto& climb : ladder.runs)
        for (StressRun r : climb) {
          r.run.cpu_s = r.run.wall_s = 0;
          told_of.push_back(record_of(r).dump());
        }
    }
    return told_of;
  };
  const auto undisturbed = all(run_stress_study(request));
  ASSERT_GT(undisturbed.size(), 15u);
  for (const int threads : {1, 2}) {
    fs::remove(file());
    int lines = 0;
    {
      Journal journal(file(), study());
      request.journal = &journal;
      request.threads = threads;
      request.progress = [](int done, int, const std::string&) { return done < 10; };
      EXPECT_FALSE(run_stress_study(request).complete);
      const std::string text = text_of(file());
      lines = static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    }
    Journal journal(file(), study());
    request.journal = &journal;
    request.progress = {};
    EXPECT_EQ(all(run_stress_study(request)), undisturbed);
    EXPECT_EQ(journal.runs_taken(), lines - 1 - 5);  // without the first line and five references
    EXPECT_GT(journal.runs_taken(), 2);
  }
}

}  // namespace
}  // namespace momenta::dae_resume
