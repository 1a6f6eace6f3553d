// Scenes that are wrong: one line, where, what was found, what was expected. Each file of
// broken_scenes/ opens with "# expect: " lines, the parts its sentence must contain.

#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace momenta::core_scene_broken {
namespace {

namespace fs = std::filesystem;

using equations::sentence_of;

void expect_contains(const std::string& sentence, const std::string& part) {
  EXPECT_NE(sentence.find(part), std::string::npos)
      << "sentence: " << sentence << "\nmissing:  " << part;
}

std::vector<fs::path> broken_scenes() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(MOMENTA_SOURCE_DIR) / "tests/core/format/broken_scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class BrokenScene : public testing::TestWithParam<fs::path> {};

TEST_P(BrokenScene, IsRefusedWithTheExpectedSentence) {
  const std::string sentence = sentence_of([&] { read_scene(GetParam()); });

  // file:line: first, and the rest as the file asks
  const std::string name = GetParam().string();
  ASSERT_TRUE(sentence.starts_with(name)) << sentence;
  int line = 0, column = 0;
  EXPECT_EQ(std::sscanf(sentence.c_str() + name.size(), ":%d:%d: ", &line, &column), 2) << sentence;
  EXPECT_GE(line, 1);
  EXPECT_GE(column, 1);
  std::ifstream stream(GetParam());
  const std::string mark = "# expect: ";
  int expected = 0;
  for (std::string head; std::getline(stream, head) && head.starts_with(mark); ++expected)
    expect_contains(sentence, head.substr(mark.size()));
  EXPECT_GT(expected, 0) << "the file opens with no '# expect: '";
}

INSTANTIATE_TEST_SUITE_P(Core, BrokenScene, testing::ValuesIn(broken_scenes()),
                         [](const auto& scene) { return scene.param.stem().string(); });

TEST(BrokenScenes, ThereAreManyOfThem) {
  EXPECT_GE(broken_scenes().size(), 50U);
}

/// A directory for generated files, removed at the end.
class BrokenFile : public testing::Test {
 protected:
  void SetUp() override {
    directory_ =
        fs::temp_directory_path() /
        ("momenta_broken_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
         testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  fs::path file(const std::string& content) const {
    const fs::path path = directory_ / "scene.toml";
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }

  fs::path directory_;
};

TEST_F(BrokenFile, Missing) {
  expect_contains(sentence_of([&] { read_scene(directory_ / "none.toml"); }),
                  "none.toml: no such file");
}

TEST_F(BrokenFile, Directory) {
  expect_contains(sentence_of([&] { read_scene(directory_); }),
                  "a directory, expected a scene file");
}

TEST_F(BrokenFile, BelowAFile) {
  expect_contains(sentence_of([&] { read_scene(file("x = 1") / "below"); }), "no such file");
}

TEST_F(BrokenFile, NameTooLong) {
  expect_contains(sentence_of([&] { read_scene(std::string(10000, 'a')); }), "expected a scene");
}

TEST_F(BrokenFile, NameOnTwoLines) {
  expect_contains(sentence_of([&] { read_scene("a\nb.toml"); }), "a\\x0ab.toml: no such file");
}

TEST_F(BrokenFile, Empty) {
  expect_contains(sentence_of([&] { read_scene(file("")); }), "scene.toml: the file is empty");
}

TEST_F(BrokenFile, Nul) {
  expect_contains(sentence_of([&] { read_scene(file(std::string("name = \"a\"\nx\0", 13))); }),
                  "scene.toml:2:2: a NUL byte");
}

TEST_F(BrokenFile, NotUtf8) {
  const char* sequences[] = {
      "\xff",         "\x80",         "\xc0\x80",         "\xc3",
      "\xe0\x80\x80", "\xed\xa0\x80", "\xf0\x80\x80\x80", "\xf4\x90\x80\x80"};
  for (const char* bytes : sequences)
    expect_contains(sentence_of([&] { read_scene(file(std::string("# ü ") + bytes)); }),
                    "scene.toml:1:5: a byte that is not UTF-8");
}

TEST_F(BrokenFile, WhatIsTooLargeIsNotReadToItsEnd) {
  // A terabyte of holes, which no memory has room for.
  const fs::path path = file("nonsense");
  fs::resize_file(path, 1'000'000'000'000);
  expect_contains(sentence_of([&] { read_scene(path); }), "over 64 MiB");
  expect_contains(sentence_of([&] { parse_scene(std::string(100'000'000, '[')); }), "over 64 MiB");
}

TEST_F(BrokenFile, DepthIsBounded) {
  const auto repeated = [](const std::string& part, int n) {
    std::string text;
    for (int i = 0; i < n; ++i) text += part;
    return text;
  };
  const int n = 1'000'000;
  expect_contains(sentence_of([&] { parse_scene("a = " + repeated("[", n)); }),
                  "nested more than 16 deep");
  expect_contains(sentence_of([&] { parse_scene("a = " + repeated("{b=", n)); }),
                  "nested more than 16 deep");
  expect_contains(sentence_of([&] { parse_scene(repeated("a.", n) + "b = 1"); }),
                  "more than 16 parts");
  expect_contains(sentence_of([&] { parse_scene("[" + repeated("a . ", n) + "b]"); }),
                  "more than 16 parts");
  expect_contains(sentence_of([&] { parse_scene(repeated("'a'.", n) + "b = 1"); }),
                  "more than 16 parts");
  expect_contains(sentence_of([&] { parse_scene("a = [" + repeated("1,", 4 * n) + "]"); }),
                  "more than 4 million");
  // brackets and dots inside strings and comments are text
  const std::string text = repeated("[.", 20);
  expect_contains(sentence_of([&] {
                    parse_scene("# " + text + "\nname = \"\\\"" + text + "\" # " + text +
                                "\nx = '" + text + "'\ny = \"\"\"\n" + text +
                                "\"\"\"\"\"\nz = '''\n''" + text + "'''\n");
                  }),
                  "unknown key 'x'");
}

TEST_F(BrokenFile, OutsideAsciiOnlyInStringsAndComments) {
  for (const char* character : {"\u00fc", "\u00a0", "\u2003", "\u2028", "\ufeff", "\U0001f600"}) {
    const std::string c = character, what = "a character outside ASCII";
    expect_contains(sentence_of([&] { parse_scene(c); }), c == "\ufeff" ? "no body" : what);
    expect_contains(sentence_of([&] { parse_scene("a = 1" + c); }),
                    "scene:1:6: not valid TOML: " + what);
    expect_contains(sentence_of([&] { parse_scene(c + c + " = 1"); }), what);
    expect_contains(sentence_of([&] { parse_scene("[" + c + "]"); }), "not valid TOML");
    expect_contains(sentence_of([&] { parse_scene("a = [" + c + "]"); }), what);
    expect_contains(sentence_of([&] { parse_scene("a = \"\\" + c + "\""); }), what);
    expect_contains(sentence_of([&] { parse_scene("a = \"\"\"\\" + c + "\"\"\""); }), what);
    expect_contains(sentence_of([&] { parse_scene("a = \"\"\"\\ \n\n " + c + "\"\"\""); }),
                    "scene:3:2: ");
    const std::string text = c + "x\\n" + c;
    expect_contains(sentence_of([&] {
                      parse_scene("# " + c + "\n'" + c + "' = \"" + text + "\" #" + c +
                                  "\nb = \"\"\"\n" + text + " \\\n   x" + c + "\"\"\"\nc = '''" +
                                  c + "\\" + c + "'''");
                    }),
                    "unknown key");
  }
}

TEST_F(BrokenFile, WhatFailsAssertionsOfTheParser) {
  for (const char* text :
       {"[&", "[[[1]]]", "[[=", "a = [1, }", "a = [}", "a = { b = [1, } }", "a = 1979-05-27 0]"})
    expect_contains(sentence_of([&] { parse_scene(text); }), "not valid TOML");
}

TEST(BrokenHandmade, ScenesBuiltByHandAreChecked) {
  const auto good = [] {
    Scene scene;
    scene.bodies.resize(2);
    scene.bodies[0].name = "a";
    scene.bodies[1].name = "b";
    scene.joints.resize(2);
    scene.joints[0].name = "j";
    scene.joints[0].child = "a";
    scene.joints[1].name = "k";
    scene.joints[1].parent = "a";
    scene.joints[1].child = "b";
    scene.loops.resize(1);
    scene.loops[0].name = "c";
    scene.loops[0].child = "b";
    scene.drives.resize(1);
    scene.drives[0].joint = "j";
    scene.drives[0].kind = "step";
    scene.drives[0].duration = 1;
    scene.forces.resize(1);
    scene.forces[0].kind = "wrench";
    scene.forces[0].body = "a";
    scene.markers.resize(1);
    scene.markers[0].name = "m";
    scene.markers[0].body = "ground";
    return scene;
  };
  EXPECT_NO_THROW(validate(good()));

  const double nan = std::nan("");
  const std::pair<const char*, std::function<void(Scene&)>> mistakes[] = {
      {"mass must be", [&](Scene& s) { s.bodies[0].mass = nan; }},
      {"mass must be", [&](Scene& s) { s.bodies[0].mass = -1; }},
      {"com must be", [&](Scene& s) { s.bodies[0].com.x() = nan; }},
      {"inertia is not finite", [&](Scene& s) { s.bodies[0].inertia(1, 2) = nan; }},
      {"inertia is not symmetric",
       [&](Scene& s) { s.bodies[0].inertia << 1, 0.1, 0, 0, 1, 0, 0, 0, 1; }},
      {"shape.kind", [&](Scene& s) { s.bodies[0].shape.kind = "cone"; }},
      {"shape must", [&](Scene& s) { s.bodies[0].shape.size.x() = -1; }},
      {"the name is taken", [&](Scene& s) { s.bodies[1].name = "a"; }},
      {"rotation must", [&](Scene& s) { s.joints[0].rotation.w() = 2; }},
      {"axis must", [&](Scene& s) { s.joints[0].axis.setZero(); }},
      {"origin must", [&](Scene& s) { s.joints[0].origin_child.x() = nan; }},
      {"position must be empty",
       [&](Scene& s) {
         s.joints[0].position = {1, 2};
       }},
      {"velocity must be empty",
       [&](Scene& s) {
         s.joints[0].velocity = {1, 2};
       }},
      {"must be finite", [&](Scene& s) { s.joints[0].velocity = {nan}; }},
      {"stiffness, rest and damping must be finite", [&](Scene& s) { s.joints[0].rest = nan; }},
      {"rotor_inertia must be empty, of one number for each coordinate",
       [&](Scene& s) {
         s.joints[0].rotor_inertia = {1, 2};
       }},
      {"rotor_inertia must be empty, of one number for each coordinate",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::spherical;
         s.joints[1].rotor_inertia = {1, 2, 3};
       }},
      {"rotor_inertia must be finite and >= 0",
       [&](Scene& s) { s.joints[0].rotor_inertia = {-1}; }},
      {"rotor_inertia must be finite and >= 0",
       [&](Scene& s) { s.joints[0].rotor_inertia = {nan}; }},
      {"pitch is for helical joints only", [&](Scene& s) { s.joints[0].pitch = 1; }},
      {"pitch must be finite",
       [&](Scene& s) {
         s.joints[0].kind = JointKind::helical;
         s.joints[0].pitch = nan;
       }},
      {"axis2 is for universal joints only",
       [&](Scene& s) { s.joints[0].axis2 = Eigen::Vector3d::UnitX(); }},
      {"axis2 is no direction, expected a unit vector",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::universal;
         s.joints[1].axis2 = {2, 0, 0};
       }},
      {"axis2 is parallel to axis",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::universal;
         s.joints[1].axis2 = -s.joints[1].axis;
       }},
      {"direction is for planar joints only",
       [&](Scene& s) { s.joints[0].direction = Eigen::Vector3d::UnitX(); }},
      {"direction is no direction, expected a unit vector",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::planar;
         s.joints[1].direction = {nan, 0, 0};
       }},
      {"direction is parallel to axis",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::planar;
         s.joints[1].direction = s.joints[1].axis;
       }},
      {"coordinate is 1, expected 0", [&](Scene& s) { s.drives[0].coordinate = 1; }},
      {"coordinate is -1, expected 0", [&](Scene& s) { s.drives[0].coordinate = -1; }},
      {"for revolute, prismatic and helical joints only",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::weld;
         s.joints[1].damping = 1;
       }},
      {"a unit quaternion",
       [&](Scene& s) {
         s.joints[1].kind = JointKind::spherical;
         s.joints[1].position = {0, 0, 0, 0};
       }},
      {"length must", [&](Scene& s) { s.loops[0].kind = LoopKind::distance; }},
      {"the name is taken", [&](Scene& s) { s.loops[0].name = "j"; }},
      {"duration must", [&](Scene& s) { s.drives[0].duration = 0; }},
      {"kind must be", [&](Scene& s) { s.drives[0].kind = "jump"; }},
      {"kind must be", [&](Scene& s) { s.forces[0].kind = "push"; }},
      {"must be finite", [&](Scene& s) { s.forces[0].force.x() = nan; }},
      {"point must", [&](Scene& s) { s.markers[0].point.x() = nan; }},
      {"is a loop", [&](Scene& s) { s.held = {"c"}; }},
      {"gravity: must be finite", [&](Scene& s) { s.gravity.x() = nan; }},
      {"end must", [&](Scene& s) { s.run.end_time = 0; }},
      {"step must", [&](Scene& s) { s.run.step = -1; }},
      {"leak must", [&](Scene& s) { s.run.leak = nan; }},
      {"samples must", [&](Scene& s) { s.run.samples = 0; }},
      {"the child of no joint", [&](Scene& s) { s.joints.pop_back(); }},
      {"form a cycle", [&](Scene& s) { s.joints[0].parent = "b"; }},
  };
  for (const auto& [part, make] : mistakes) {
    Scene scene = good();
    make(scene);
    const std::string sentence = sentence_of([&] { validate(scene); });
    expect_contains(sentence, part);
    EXPECT_TRUE(sentence.starts_with("scene: ")) << sentence;
  }
}

TEST(Words, NamesInQuotesSayHowManyMoreThereAre) {
  const std::vector<std::string> names{"a", "b\n", "c"};
  EXPECT_EQ(reading::all_in_quotes({}), "");
  EXPECT_EQ(reading::all_in_quotes(names), "'a', 'b\\x0a', 'c'");
  EXPECT_EQ(reading::all_in_quotes(names, 3), "'a', 'b\\x0a', 'c'");
  EXPECT_EQ(reading::all_in_quotes(names, 2), "'a', 'b\\x0a' and 1 more");
  EXPECT_EQ(reading::all_in_quotes(names, 1), "'a' and 2 more");
}

}  // namespace
}  // namespace momenta::core_scene_broken
