#pragma once
// A folder with the files of one test's models.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace momenta::equations {

class ModelFolder : public testing::Test {
 protected:
  ModelFolder()
      : folder(std::filesystem::canonical(std::filesystem::temp_directory_path()) /
               ("momenta_models_" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(folder);
  }
  ~ModelFolder() override { std::filesystem::remove_all(folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  /// A <mujoco> of this text in the file m.xml.
  Scene mjcf(const std::string& inside, const ReadOptions& options = {}) const {
    return read_scene(write("m.xml", "<mujoco>" + inside + "</mujoco>"), options);
  }
  /// Expects that m.xml is refused by one sentence that begins with a place in `file` and holds
  /// `expected`.
  void expect_refused(const std::string& inside, const std::string& file,
                      const std::string& expected, const ReadOptions& options = {}) const {
    SCOPED_TRACE(expected);
    try {
      mjcf(inside, options);
      ADD_FAILURE() << "nothing was refused";
    } catch (const SceneError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_TRUE(sentence.starts_with((folder / file).string() + ":")) << sentence;
      EXPECT_NE(sentence.find(expected), std::string::npos) << sentence;
    }
  }

  const std::filesystem::path folder;
};

}  // namespace momenta::equations
