// A result file is whole or not there.
#include <gtest/gtest.h>
#include <momenta/dae/output/part_file.h>

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace momenta::dae_report_atomic_write {
namespace {

namespace fs = std::filesystem;

class AtomicWrite : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "momenta-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override {
    fs::permissions(directory_, fs::perms::owner_all);
    fs::remove_all(directory_);
  }

  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(directory_), {}); }

  fs::path directory_;
};

TEST_F(AtomicWrite, MakesDirectoriesAndReplacesWhatStoodThere) {
  const fs::path path = directory_ / "a" / "b" / "summary.json";
  EXPECT_EQ(atomic_write(path, "first"), std::nullopt);
  EXPECT_EQ(content(path), "first");
  const std::string bytes("se\0cond\n", 8);
  EXPECT_EQ(atomic_write(path, bytes), std::nullopt);
  EXPECT_EQ(content(path), bytes);
  EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), {}), 1);
}

TEST_F(AtomicWrite, LeavesNothingWhenTheTargetIsADirectory) {
  const fs::path path = directory_ / "taken";
  fs::create_directories(path / "inside");
  const auto failure = atomic_write(path, "text");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("Cannot write " + path.string() + ": "), std::string::npos) << *failure;
  EXPECT_TRUE(fs::is_directory(path / "inside"));
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicWrite, NamesTheDirectoryItCannotMake) {
  ASSERT_EQ(atomic_write(directory_ / "file", "text"), std::nullopt);
  const auto failure = atomic_write(directory_ / "file" / "below" / "x.csv", "text");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find((directory_ / "file").string()), std::string::npos) << *failure;
  EXPECT_NE(failure->find("Not a directory"), std::string::npos) << *failure;
  EXPECT_EQ(content(directory_ / "file"), "text");
}

TEST_F(AtomicWrite, LeavesTheOldFileInADirectoryClosedToWriting) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const fs::path path = directory_ / "x.csv";
  ASSERT_EQ(atomic_write(path, "old"), std::nullopt);
  fs::permissions(directory_, fs::perms::owner_read | fs::perms::owner_exec);
  const auto failure = atomic_write(path, "new");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("Permission denied"), std::string::npos) << *failure;
  EXPECT_EQ(content(path), "old");
}

TEST_F(AtomicWrite, FailsOnANameThatIsTooLong) {
  const auto failure = atomic_write(directory_ / std::string(300, 'n'), "text");
  ASSERT_TRUE(failure);
  EXPECT_NE(failure->find("File name too long"), std::string::npos) << *failure;
  EXPECT_EQ(entries(), 0);
}

}  // namespace
}  // namespace momenta::dae_report_atomic_write
