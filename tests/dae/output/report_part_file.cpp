// FILE.part: replaced after a kill, its process's own, and whole lines where there is no more room.
#include <gtest/gtest.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/output/trajectory_file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace momenta::dae_report_part_file {
namespace {

namespace fs = std::filesystem;

class Part : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "momenta-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override { fs::remove_all(directory_); }
  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(directory_), {}); }

  fs::path directory_;
};

/// Files may grow no further than this while it lives.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    rlimit limit = old_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, before_);
  }

 private:
  rlimit old_{};
  void (*before_)(int);
};

TEST_F(Part, OfAKilledProcessIsReplaced) {
  const fs::path file = directory_ / "x.csv";
  std::ofstream(file) << "old";
  std::ofstream(directory_ / "x.csv.part") << "half of something longer";
  {
    PartFile part(file);
    ASSERT_EQ(part.problem(), "");
    EXPECT_TRUE(part.append("ne") && part.append("w"));
    EXPECT_EQ(content(file), "old");
    EXPECT_TRUE(part.put_in_place());
  }
  EXPECT_EQ(content(file), "new");
  EXPECT_EQ(entries(), 1);
}

TEST_F(Part, KeepsItsBeginningWhereItStandsThere) {
  const fs::path file = directory_ / "x.csv", stands = directory_ / "x.csv.part";
  const std::string before(200000, 'b');  // more than is read at once
  std::ofstream(stands) << before << "what was not reported";
  {
    PartFile part(file, before);
    EXPECT_EQ(part.size(), before.size());
    EXPECT_EQ(content(stands), before);
  }
  // Not put in place it is left: there is work in it.
  EXPECT_EQ(content(stands), before);
  for (const std::string& other : {before.substr(1), before + "c", std::string(200000, 'c')}) {
    {
      PartFile part(file, other);
      EXPECT_EQ(content(stands), other);
      EXPECT_TRUE(part.append("more"));
      EXPECT_EQ(content(stands), other + "more");
    }
    EXPECT_EQ(fs::exists(stands), other.size() < before.size());
    std::ofstream(stands) << before;
  }
}

TEST_F(Part, DevicesAndPipesAreWrittenToAndLinksFollowed) {
  for (const char* device : {"/dev/null", "/dev/full"}) {
    if (!fs::is_character_file(device)) GTEST_SKIP() << "no " << device;
    PartFile part(device);
    EXPECT_EQ(part.append("text") && part.put_in_place(), device == std::string("/dev/null"));
    EXPECT_EQ(part.problem(), device == std::string("/dev/null")
                                  ? ""
                                  : "Cannot write /dev/full: No space left on device.");
    EXPECT_TRUE(fs::is_character_file(device));
    EXPECT_FALSE(fs::exists(device + std::string(".part")));
  }
  const fs::path file = directory_ / "file", link = directory_ / "link";
  std::ofstream(file) << "old";
  fs::create_symlink(file, link);
  {
    PartFile part(link);
    EXPECT_TRUE(part.append("new") && part.put_in_place()) << part.problem();
  }
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(file), "new");
  EXPECT_EQ(entries(), 2);
}

TEST_F(Part, RemovedUnderneathIsTold) {
  const fs::path folder = directory_ / "out";
  PartFile part(folder / "x.csv");
  EXPECT_TRUE(part.append("text"));
  fs::remove_all(folder);
  EXPECT_FALSE(part.append("more"));
  EXPECT_FALSE(part.put_in_place());
  EXPECT_EQ(part.problem(),
            "Cannot write " + (folder / "x.csv").string() + ": No such file or directory.");
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(Part, NotPutInPlaceLeavesNothingNorADirectory) {
  const fs::path file = directory_ / "made" / "x.csv";
  {
    PartFile part(file);
    EXPECT_TRUE(part.append("text"));
    EXPECT_TRUE(fs::exists(directory_ / "made" / "x.csv.part"));
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(Part, IsItsProcessesOwnUntilThatEnds) {
  const fs::path file = directory_ / "x.csv";
  int ready[2], go[2];
  ASSERT_EQ(pipe(ready), 0);
  ASSERT_EQ(pipe(go), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  char byte = 0;
  if (child == 0) {  // writes half of it, and waits to be killed
    PartFile part(file);
    part.append("half");
    if (write(ready[1], "r", 1) != 1) _exit(1);
    while (read(go[0], &byte, 1) != 1) {
    }
    _exit(0);
  }
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  {
    PartFile part(file);
    EXPECT_EQ(part.problem(), "Cannot write " + file.string() + ": another process is writing it.");
    EXPECT_FALSE(part.append("mine"));
    EXPECT_FALSE(part.put_in_place());
  }
  EXPECT_EQ(content(directory_ / "x.csv.part"), "half");
  kill(child, SIGKILL);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  PartFile part(file);
  EXPECT_EQ(part.problem(), "");
  EXPECT_TRUE(part.append("mine") && part.put_in_place());
  EXPECT_EQ(content(file), "mine");
  for (const int end : {ready[0], ready[1], go[0], go[1]}) close(end);
}

TEST_F(Part, HasTheRoomItReserved) {
  const fs::path file = directory_ / "summary.json";
  PartFile part(file);
  EXPECT_TRUE(part.reserve(1 << 16));
  EXPECT_EQ(fs::file_size(directory_ / "summary.json.part"), 1u << 16);
  EXPECT_TRUE(part.append("short") && part.put_in_place());
  EXPECT_EQ(content(file), "short");
  PartFile large(directory_ / "large");
  const SizeLimit limit(1000);
  EXPECT_FALSE(large.reserve(1 << 16));
  EXPECT_NE(large.problem().find("large: File too large."), std::string::npos) << large.problem();
}

TEST_F(Part, TrajectoriesEndWithAWholeLineWhereverTheRoomEnds) {
  const std::vector<double> row{0.1, 1.0 / 3, -2e-300};
  const std::string head = "t [s],a [m],b [m]\n", line = "0.1,0.3333333333333333,-2e-300\n";
  for (const std::size_t room :
       {std::size_t{17}, head.size(), head.size() + 1, head.size() + line.size() - 1,
        head.size() + line.size(), head.size() + line.size() + 1, std::size_t{70'000}}) {
    const fs::path file = directory_ / "trajectory.csv";
    auto trajectory = [&] {
      const SizeLimit limit(room);
      auto made = csv_trajectory(file, {"t [s]", "a [m]", "b [m]"});
      for (int i = 0; i < 5000 && made->write(row); ++i) {
      }
      EXPECT_FALSE(made->flush());
      return made;
    }();
    EXPECT_EQ(trajectory->problem(), "Cannot write " + file.string() + ": File too large.");
    EXPECT_FALSE(trajectory->write(row));
    EXPECT_TRUE(trajectory->finish(""));
    const std::string text = content(file);
    const std::size_t lines = room < head.size() ? 0 : (room - head.size()) / line.size();
    std::string expected = room < head.size() ? "" : head;
    for (std::size_t i = 0; i < lines; ++i) expected += line;
    EXPECT_EQ(text, expected) << room;
    EXPECT_EQ(entries(), 1);
  }
}

}  // namespace
}  // namespace momenta::dae_report_part_file
