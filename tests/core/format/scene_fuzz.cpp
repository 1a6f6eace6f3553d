// Damaged text: whatever arrives, the reader returns a scene or throws SceneError with one line.

#include "equations/any_text.h"
#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <random>
#include <string>

namespace momenta::core_scene_fuzz {
namespace {

const std::string valid = R"(# ü
name = "all keys"
gravity = [0.0, -9.81, 0]
[[body]]
name = "a"
mass = 1e0
shape = { kind = "rod", length = 0.5, axis = "-x" }
[[body]]
name = 'b'
mass = 2
com = [1, 0, 0]
inertia = [1, 2, 2.5, 0.1, 0.2, 0.3]
[[joint]]
name = "O"
kind = "revolute"
child = "a"
origin = { parent = [1, 2, 3], child = [4, 5, 6] }
rotation = { rpy = [0, 0, 1] }
position = 1.5
stiffness = 3.5
[[joint]]
name = "A"
kind = "spherical"
parent = "a"
child = "b"
position = [1, 0, 0, 0]
[[body]]
name = "c"
mass = 0
[[joint]]
name = "D"
kind = "planar"
parent = "b"
child = "c"
axis = "y"
direction = [1, 0, 1]
position = [0.1, 0.2, 0.3]
[[body]]
name = "d"
mass = 0
[[joint]]
name = "E"
kind = "universal"
parent = "c"
child = "d"
axis2 = "-x"
[[body]]
name = "e"
mass = 1
shape = { kind = "sphere", radius = 0.1 }
[[joint]]
name = "F"
kind = "helical"
parent = "d"
child = "e"
pitch = 0.01
[[drive]]
joint = "D"
coordinate = 2
kind = "step"
to = 1
duration = 2
[[loop]]
name = "C"
kind = "distance"
child = "b"
length = 2
[[drive]]
joint = "O"
kind = "table"
times = [0, 1, 3]
values = [0, 1, 0.5]
[[force]]
kind = "wrench"
body = "b"
force = [4, 5, 6]
axes = "body"
[[marker]]
name = """tip"""
body = "a"
[assembly]
hold = ["O"]
[run]
end = 5
samples = 200
)";

/// @return whether the text is a scene
bool survives(const std::string& text) {
  bool is_scene = false;
  EXPECT_EQ(equations::wrong_in_reading(text, &is_scene), "") << text;
  return is_scene;
}

TEST(DamagedScene, TruncatedAtEveryByte) {
  ASSERT_TRUE(survives(valid));
  for (std::size_t size = 0; size < valid.size(); ++size) survives(valid.substr(0, size));
}

TEST(DamagedScene, EveryByteLeftOut) {
  for (std::size_t i = 0; i < valid.size(); ++i) survives(valid.substr(0, i) + valid.substr(i + 1));
}

TEST(DamagedScene, BytesFlippedAtRandom) {
  std::mt19937 random(20'000);
  int scenes = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = valid;
    const std::size_t flips = 1 + random() % 3;
    for (std::size_t k = 0; k < flips; ++k) {
      char& byte = text[random() % text.size()];
      byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random() % 8));
    }
    scenes += survives(text);
  }
  EXPECT_GT(scenes, 0);  // some flips change a digit only
}

// toml++ reads a number on over a quote, and asks of what follows whether it is white.
TEST(DamagedScene, QuotesWithinWordsBeforeCharactersOutsideAscii) {
  for (const char* text :
       {"a = 1.B\"\xef\xbb\xbd = [run]", "a = 1.B\"\xef\xbb\xbd\" = 1", "a = x'\xef\xbb\xbd' # ü",
        "a = \"\xef\xbb\xbd\nb = 1", "\nr= 1x0=\"\xef\xba\xbf\"\n00", "a = 1x[\"\xef\xba\xbf\"]",
        "a = 1x.\"\xef\xba\xbf\"", "a = [1, 1x=\"\xef\xba\xbf\"]", "a = {b = 1x{\"\xef\xba\xbf\"}",
        "a = 1x==\"\xef\xba\xbf\""}) {
    EXPECT_TRUE(equations::says(equations::thrown<SceneError>([&] { parse_scene(text); }),
                                "a character outside ASCII"))
        << text;
  }
}

// Valid TOML has its letters wherever a string may begin.
TEST(DamagedScene, StringsOutsideAsciiAreKeysAndValues) {
  for (const char* text : {"\"ü\" = 1", "a.\"ü\".b = 1", "a . 'ü' = 1", "a=\"ü\"", "a=['ü',\"ü\"]",
                           "a={\"ü\"='ü',b.\"ü\"=1}", "[\"ü\"]", "[[a.\"ü\"]]",
                           "a=[{b='ü'},{c=\"ü\"}]", "a=[\n'ü'\n]", "a=[['ü']]", "a={b={c='ü'}}"}) {
    try {
      parse_scene(text);
      ADD_FAILURE() << text;  // text, but no scene
    } catch (const SceneError& e) {
      EXPECT_EQ(std::string(e.what()).find("ASCII"), std::string::npos) << text << "\n" << e.what();
      EXPECT_EQ(std::string(e.what()).find("not valid TOML"), std::string::npos) << e.what();
    }
  }
}

TEST(DamagedScene, PiecesShuffled) {
  const std::string pieces[] = {
      "[",    "]",    "{",  "}",  "=",          ".",   ",",  "\"", "'", "\n",      "\\",  "#",
      "name", "body", "1",  "-",  "inf",        "nan", "0x", "1e", "_", "\"\"\"",  "'''", "[[",
      "]]",   " ",    "\r", "\t", "1979-05-27", "T",   ":",  "+",  "u", "\xc3\xbc"};
  std::mt19937 random(7);
  for (int round = 0; round < 20'000; ++round) {
    std::string text;
    const std::size_t count = 1 + random() % 12;
    for (std::size_t k = 0; k < count; ++k) text += pieces[random() % std::size(pieces)];
    survives(text);
  }
}

}  // namespace
}  // namespace momenta::core_scene_fuzz
