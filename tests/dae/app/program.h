#pragma once
// The program called as its users call it, from a folder that is gone after the test.

#include "equations/output_of.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace momenta::golden {

namespace fs = std::filesystem;

using equations::says, equations::text_of;

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

  static std::string program() { return "'" MOMENTA_BINARY_DIR "/dae/momenta' "; }

  /// `launcher`: what stands before the program on the command line.
  Outcome call(const std::string& arguments, const fs::path& input = "/dev/null",
               const std::string& launcher = "") const {
    const fs::path out = folder_ / "stdout", err = folder_ / "stderr";
    const std::string command = launcher + program() + arguments + " >'" + out.string() + "' 2>'" +
                                err.string() + "' <'" + input.string() + "'";
    const int raw = std::system(command.c_str());  // NOLINT: the command is this test's own
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -WTERMSIG(raw), text_of(out), text_of(err)};
  }
  /// The shell's status of a study killed as soon as its journal has so many lines. A study that
  /// was done before anybody looked is begun again.
  static int status_when_killed(const std::string& arguments, const fs::path& journal, int lines) {
    const std::string command = program() + arguments +
                                " >/dev/null 2>&1 & pid=$!; for i in $(seq 3000); do "
                                "[ \"$(cat '" +
                                journal.string() + "' 2>/dev/null | wc -l)\" -ge " +
                                std::to_string(lines) +
                                " ] && break; sleep 0.01; done; "
                                "kill -9 $pid; wait $pid 2>/dev/null";
    for (int more = 10;; --more) {
      const int status = WEXITSTATUS(std::system(command.c_str()));  // NOLINT: this test's own
      if (status != 0 || more == 0) return status;
      fs::remove_all(journal.parent_path());
    }
  }
  static std::string example(const std::string& name) {
    return (std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / "scene.toml").string();
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
    EXPECT_TRUE(says(o.err, mentions)) << "expected '" << mentions << "' in: ";
    EXPECT_TRUE(o.out.empty()) << o.out;
  }

  fs::path folder_;
};

}  // namespace momenta::golden
