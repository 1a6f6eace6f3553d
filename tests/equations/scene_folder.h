#pragma once
// Scenes from texts of files, in a folder of their own that a test leaves behind it empty.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <string>

namespace momenta::equations {

class SceneFolder : public testing::Test {
 protected:
  SceneFolder()
      : folder_(std::filesystem::temp_directory_path() /
                ("momenta_scenes_" + std::to_string(static_cast<long>(std::random_device{}())))) {
    std::filesystem::create_directories(folder_);
  }
  ~SceneFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  Scene read(const std::string& name, const std::string& text, const ReadOptions& o = {}) const {
    return read_scene(write(name, text), o);
  }
  /// The sentence by which a text is refused; empty, and a failure, where it is not.
  std::string refused(const std::string& name, const std::string& text,
                      const ReadOptions& o = {}) const {
    try {
      read(name, text, o);
    } catch (const SceneError& error) {
      const std::string sentence = error.what();
      EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
      EXPECT_TRUE(sentence.starts_with(folder_.string())) << sentence;
      return sentence;
    }
    ADD_FAILURE() << "nothing was refused: " << text;
    return "";
  }

 private:
  std::filesystem::path folder_;
};

inline const JointSpec& joint_of(const Scene& scene, const std::string& name) {
  for (const JointSpec& joint : scene.joints)
    if (joint.name == name) return joint;
  throw std::out_of_range(name);
}

}  // namespace momenta::equations
