// URDF, MJCF and YAML that are wrong: one sentence with file and line, what was found, what was
// expected; and damaged bytes, which end in a scene or in such a sentence.

#include "equations/any_text.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace momenta::core_robots_broken {
namespace {

namespace fs = std::filesystem;

struct Case {
  const char* name;
  const char* text;
  const char* expected;  ///< ":LINE: SENTENCE", as far as it matters
};

/// A folder of its own for files of one test.
class Files : public testing::Test {
 protected:
  Files() {
    folder_ = fs::temp_directory_path() /
              ("momenta_robots_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
               std::to_string(static_cast<long>(std::random_device{}())));
    fs::create_directories(folder_);
  }
  ~Files() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    const fs::path file = folder_ / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  static std::string sentence_of(const fs::path& file, const ReadOptions& options = {}) {
    try {
      read_scene(file, options);
    } catch (const SceneError& error) {
      return error.what();
    }
    ADD_FAILURE() << "nothing was refused";
    return "";
  }
  void expect_refused(const std::string& ending, const Case& c) const {
    SCOPED_TRACE(c.name);
    const fs::path file = write(std::string(c.name) + ending, c.text);
    const std::string sentence = sentence_of(file);
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    ASSERT_TRUE(sentence.starts_with(file.string())) << sentence;
    EXPECT_NE(sentence.find(c.expected), std::string::npos) << sentence;
  }

 private:
  fs::path folder_;
};

const Case wrong_urdf[] = {
    {"empty", "", "not valid XML: empty document"},
    {"open_tag", "<robot>\n<link name='a'>\n</robot>", ":2: not valid XML: mismatched element"},
    {"two_values", "<robot>\n<link name='a' name/></robot>", "not valid XML"},
    {"other_root", "\n<svg version='1.7'/>",
     ":2: the root element is <svg>, expected <robot> (URDF), <mujoco> (MJCF) or <sdf> (SDF)"},
    {"no_link", "<robot name='r'/>", ":1: <robot> has no <link>, expected at least one"},
    {"nameless", "<robot>\n<link/></robot>", ":2: link 'without a name': <link> has no name"},
    {"joint_type",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='revolut'><parent link='a'/>"
     "<child link='b'/></joint></robot>",
     ":2: joint 'j': <joint> type is 'revolut', expected one of: revolute, continuous, prismatic, "
     "fixed, floating, planar, spherical; did you mean 'revolute'?"},
    {"no_type",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j'><parent link='a'/><child link='b'/>"
     "</joint></robot>",
     ":2: joint 'j': <joint> has no type"},
    {"no_child",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='fixed'><parent "
     "link='a'/></joint></robot>",
     ":2: joint 'j': <joint> has no <child>, expected one"},
    {"unknown_parent",
     "<robot><link name='base'/><link name='b'/>\n<joint name='j' type='fixed'><parent "
     "link='bas'/><child link='b'/></joint></robot>",
     ":2: joint 'j': parent is 'bas', expected the name of a link; did you mean 'base'?"},
    {"two_parents",
     "<robot><link name='a'/><link name='b'/><link name='c'/>\n<joint name='j' type='fixed'>"
     "<parent link='a'/><child link='c'/></joint>\n<joint name='k' type='fixed'><parent link='a'/>"
     "<child link='b'/></joint>\n<joint name='l' type='fixed'><parent link='b'/><child "
     "link='c'/></joint></robot>",
     ":4: link 'c' is the child of joints 'j' and 'l', expected exactly one; a loop is a <loop>"},
    {"two_roots", "<robot>\n<link name='a'/><link name='b'/></robot>",
     ":1: <robot> has two links that are no joint's child, 'a' and 'b', expected one root"},
    {"cycle",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='fixed'><parent link='a'/>"
     "<child link='b'/></joint>\n<joint name='k' type='fixed'><parent link='b'/><child "
     "link='a'/></joint></robot>",
     "joints 'j', 'k' form a cycle, b <- a <- b, expected a tree"},
    {"link_twice", "<robot><link name='a'/>\n<link name='a'/></robot>",
     ":2: link 'a': <link> is the second of that name, expected each name once"},
    {"mass",
     "<robot><link name='a'><inertial>\n<mass value='1 kg'/><inertia ixx='1' iyy='1' "
     "izz='1'/></inertial></link></robot>",
     ":2: link 'a': <mass> value has 'kg', expected finite numbers"},
    {"mass_nan",
     "<robot><link name='a'><inertial>\n<mass value='nan'/><inertia ixx='1' iyy='1' "
     "izz='1'/></inertial></link></robot>",
     ":2: link 'a': <mass> value has 'nan', expected finite numbers"},
    {"mass_negative",
     "<robot><link name='a'><inertial>\n<mass value='-1'/><inertia ixx='1' iyy='1' "
     "izz='1'/></inertial></link></robot>",
     ":2: link 'a': <mass> gives the mass -1, expected a number >= 0 [kg]"},
    {"no_inertia", "<robot><link name='a'>\n<inertial><mass value='1'/></inertial></link></robot>",
     ":2: link 'a': <inertial> has a mass and no <inertia>, expected both"},
    {"no_izz",
     "<robot><link name='a'><inertial><mass value='1'/>\n<inertia ixx='1' iyy='1'/></inertial>"
     "</link></robot>",
     ":2: link 'a': <inertia> has no izz"},
    {"axis",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='revolute'><parent link='a'/>"
     "<child link='b'/>\n<axis xyz='0 0 0'/></joint></robot>",
     ":3: joint 'j': <axis> xyz is the zero vector, expected a direction"},
    {"two_numbers",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='fixed'><parent link='a'/>"
     "<child link='b'/>\n<origin xyz='0 1e999'/></joint></robot>",
     ":3: joint 'j': <origin> xyz has '1e999', expected finite numbers"},
    {"mimic",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='revolute'><parent link='a'/>"
     "<child link='b'/>\n<mimic joint='k'/></joint></robot>",
     ":3: joint 'j': <mimic> joint is 'k', expected the name of a joint"},
    {"loop_link",
     "<robot><link name='a'/>\n<loop name='l' type='revolute'><predecessor link='a'/>\n<successor "
     "link='b'/></loop></robot>",
     ":3: loop 'l': <successor> link is 'b', expected the name of a link"},
    {"loop_type",
     "<robot><link name='a'/>\n<loop name='l' type='screw'><predecessor link='a'/><successor "
     "link='a'/></loop></robot>",
     ":2: loop 'l': <loop> type is 'screw', expected one of: revolute"},
    {"coupling",
     "<robot><link name='a'/>\n<coupling name='c'><predecessor link='a'/><successor link='a'/>"
     "<ratio value='2'/></coupling></robot>",
     ":2: coupling 'c': <coupling> couples no joint"},
    {"misspelt",
     "<robot><link name='a'/><link name='b'/>\n<jiont name='j' type='fixed'><parent link='a'/>"
     "<child link='b'/></jiont></robot>",
     ":2: <jiont> is not known in <robot>, expected an element of the format; did you mean "
     "'joint'?"},
    {"misspelt_limit",
     "<robot><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent link='a'/>"
     "<child link='b'/>\n<limits lower='-1' upper='1'/></joint></robot>",
     ":2: <limits> is not known in <joint>, expected an element of the format; did you mean "
     "'limit'?"},
    {"not_utf8",
     "<?xml version='1.0' encoding='ISO-8859-1'?>\n<robot>\n<link name='lev\xe9'/></robot>",
     ":3: 'lev\\xe9' is not in UTF-8 (the file declares ISO-8859-1), expected UTF-8"},
    {"mimic_itself",
     "<robot><link name='a'/><link name='b'/>\n<joint name='j' type='revolute'><parent link='a'/>"
     "<child link='b'/>\n<mimic joint='j'/></joint></robot>",
     ":3: joint 'j': <mimic> joint is the joint itself, expected another one"},
    {"macro", "<robot><link name='a'/>\n<xacro:include filename='x'/></robot>",
     ":2: <xacro:include> is for xacro, expected a URDF: expand the file by"},
};

const Case wrong_mjcf[] = {
    {"no_body", "<mujoco><worldbody/></mujoco>", ":1: <mujoco> has no <body>"},
    {"joint_type",
     "<mujoco><worldbody><body name='b'>\n<joint name='j' "
     "type='hing'/></body></worldbody></mujoco>",
     ":2: body 'b': <joint> type is 'hing', expected one of: hinge, slide, ball, free; did you "
     "mean 'hinge'?"},
    {"class",
     "<mujoco><default><default class='big'/></default><worldbody><body name='b'>\n<joint "
     "class='bog'/></body></worldbody></mujoco>",
     ":2: body 'b': <joint> class is 'bog', expected a class of <default>; did you mean 'big'?"},
    {"class_twice",
     "<mujoco><default><default class='a'/>\n<default class='a'/></default></mujoco>",
     ":2: <default> class is 'a' once more, expected each class once"},
    {"free_inside",
     "<mujoco><worldbody><body name='a'><body name='b'>\n<joint name='j' "
     "type='free'/></body></body></worldbody></mujoco>",
     ":2: joint 'j': <joint> is free, expected such a joint alone, on a body of the world"},
    {"orientation",
     "<mujoco><worldbody>\n<body name='b' quat='1 0 0 0' euler='0 0 0'/></worldbody></mujoco>",
     ":2: body 'b': <body> has quat and euler, expected one orientation"},
    {"quaternion", "<mujoco><worldbody>\n<body name='b' quat='0 0 0 0'/></worldbody></mujoco>",
     ":2: body 'b': <body> quat is zero"},
    {"body_twice", "<mujoco><worldbody><body name='b'/>\n<body name='b'/></worldbody></mujoco>",
     ":2: body 'b': <body> has a name that is taken"},
    {"tendon_range",
     "<mujoco><worldbody><body name='b'><joint name='j'/><geom "
     "size='1'/></body></worldbody><tendon>"
     "\n<fixed name='t' range='2 1'><joint joint='j' coef='1'/></fixed></tendon></mujoco>",
     ":2: tendon 't': <fixed> range has its first number not below its second"},
    {"tendon_lengths",
     "<mujoco><worldbody><body name='b'><joint name='j'/><geom "
     "size='1'/></body></worldbody><tendon>"
     "\n<fixed name='t' stiffness='1' springlength='2 1'><joint joint='j' coef='1'/></fixed>"
     "</tendon></mujoco>",
     ":2: tendon 't': <fixed> springlength is no length and no two, expected one, or the least and "
     "the largest without force"},
    {"size",
     "<mujoco><worldbody><body name='b'><joint/>\n<geom type='box' size='1 "
     "1'/></body></worldbody></mujoco>",
     ":2: body 'b': <geom> size has 2 numbers, expected 3 for a box"},
    {"no_size", "<mujoco><worldbody><body name='b'><joint/>\n<geom/></body></worldbody></mujoco>",
     ":2: body 'b': <geom> has no size"},
    {"inertial",
     "<mujoco><worldbody><body name='b'>\n<inertial pos='0 0 0' "
     "mass='1'/></body></worldbody></mujoco>",
     ":2: body 'b': <inertial> has no diaginertia"},
    {"tendon_equality",
     "<mujoco><worldbody><body name='b'/></worldbody><equality>\n<tendon "
     "tendon1='t'/></equality></mujoco>",
     ":2: equality: <tendon> tendon1 is 't', expected the name of a tendon"},
    {"site",
     "<mujoco><worldbody><body name='b'/></worldbody><equality>\n<connect site1='s' "
     "site2='t'/></equality></mujoco>",
     ":2: equality: <connect> site1 is 's', expected the name of a <site>"},
    {"equality_body",
     "<mujoco><worldbody><body name='bar'/></worldbody><equality>\n<connect body1='baz' anchor='0 "
     "0 0'/></equality></mujoco>",
     ":2: equality: <connect> body1 is 'baz', expected the name of a <body>; did you mean 'bar'?"},
    {"polynomial",
     "<mujoco><worldbody><body name='b'><joint name='j'/><joint name='k'/></body></worldbody>"
     "<equality>\n<joint joint1='j' joint2='k' polycoef='0 1 2 0 0 1'/></equality></mujoco>",
     ":2: equality: <joint> polycoef has 6 numbers, expected 5"},
    {"flag", "<mujoco><option>\n<flag equality='disabled'/></option></mujoco>",
     ":2: <flag> equality is 'disabled', expected one of: enable, disable; did you mean "
     "'disable'?"},
    {"misspelt_section", "<mujoco><worldbody/>\n<equalitty/></mujoco>",
     ":2: <equalitty> is not known in <mujoco>, expected an element of the format; did you mean "
     "'equality'?"},
    {"misspelt_joint",
     "<mujoco><worldbody><body name='a'><joint/><geom size='1'/><body name='b'>\n<jiont/><geom "
     "size='1'/></body></body></worldbody></mujoco>",
     ":2: <jiont> is not known in <body>, expected an element of the format; did you mean "
     "'joint'?"},
    {"misspelt_in_frame",
     "<mujoco><worldbody><frame>\n<boddy name='a'/></frame></worldbody></mujoco>",
     ":2: <boddy> is not known in <frame>"},
    {"not_utf8", "<mujoco><worldbody>\n<body name='lev\xe9'/></worldbody></mujoco>",
     ":2: 'lev\\xe9' is not in UTF-8, expected UTF-8"},
    {"surrogate", "<mujoco><worldbody>\n<body name='&#xd800;'/></worldbody></mujoco>",
     ":2: '\\xed\\xa0\\x80' is not in UTF-8"},
    {"utf16", "\xff\xfe<mujoco/>", ":1: holds NUL or the mark of UTF-16, expected text in UTF-8"},
};

TEST_F(Files, WrongUrdf) {
  for (const Case& c : wrong_urdf) expect_refused(".urdf", c);
}

TEST_F(Files, WrongMjcf) {
  for (const Case& c : wrong_mjcf) expect_refused(".xml", c);
}

TEST_F(Files, WrongYaml) {
  const fs::path urdf =
      write("r.urdf",
            "<robot><link name='a'/><link name='b'/><joint name='j' type='fixed'><parent link='a'/>"
            "<child link='b'/></joint></robot>");
  const Case wrong[] = {
      {"list", "- 1\n", "no map of keys, expected closed_loop and type"},
      {"no_type", "closed_loop: [[a, b]]\n", "no key type, expected a list"},
      {"count", "closed_loop: [[a, b]]\ntype: []\n", "closed_loop has 1 entries and type 0"},
      {"pair", "closed_loop:\n  - [a]\ntype: ['3d']\n", ":2:5: closed_loop holds no pair"},
      {"frame", "closed_loop: [[a, c]]\ntype: ['3d']\n",
       ":1:19: closed_loop has 'c', expected a joint or a link of"},
      {"type", "closed_loop: [[a, b]]\ntype: ['4d']\n",
       ":2:8: type has '4d', expected '3d' or '6d'"},
      {"itself", "closed_loop: [[b, j]]\ntype: ['3d']\n", "ties link 'b' to itself"},
      {"syntax", "closed_loop: [[a, b]\n", "not valid YAML: "},
  };
  for (const Case& c : wrong) {
    SCOPED_TRACE(c.name);
    ReadOptions options;
    options.loops = write(std::string(c.name) + ".yaml", c.text);
    const std::string sentence = sentence_of(urdf, options);
    EXPECT_TRUE(sentence.starts_with(options.loops.string())) << sentence;
    EXPECT_NE(sentence.find(c.expected), std::string::npos) << sentence;
  }
  ReadOptions none;
  none.loops = urdf.string() + ".none";
  EXPECT_NE(sentence_of(urdf, none).find("no such file"), std::string::npos);
}

TEST_F(Files, OptionsOfUrdfElsewhere) {
  ReadOptions options;
  options.free_root = true;
  EXPECT_NE(sentence_of(write("a.xml", "<mujoco/>"), options).find("no URDF, expected one"),
            std::string::npos);
  EXPECT_NE(sentence_of(write("a.toml", "name = 'x'"), options).find("no URDF, expected one"),
            std::string::npos);
}

// Bytes of real models, changed, cut, doubled.
TEST_F(Files, DamagedModels) {
  const fs::path models = fs::path(MOMENTA_SOURCE_DIR) / "examples/models";
  std::mt19937 random(11);
  int scenes = 0, refused = 0;
  for (const char* name :
       {"urdfplus/four_bar.urdf", "panda_urdf/panda.urdf", "robotiq_2f85_v4/2f85.xml",
        "mujoco_small/weld.xml", "epr_robot_delta/robot.yaml"}) {
    std::ifstream in(models / name, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    ASSERT_FALSE(whole.empty()) << name;
    const bool yaml = std::string(name).ends_with(".yaml");
    for (int i = 0; i < 150; ++i) {
      std::string text = whole;
      const auto at = [&] { return random() % text.size(); };
      for (unsigned n = 1 + random() % 4; n > 0; --n) switch (random() % 4) {
          case 0:
            text[at()] = static_cast<char>(random());
            break;
          case 1:
            text.erase(at(), random() % 40);
            break;
          case 2:
            text.insert(at(), text.substr(at(), random() % 60));
            break;
          default:
            text[at()] = "<>\"'/= 0-.e[]"[random() % 13];
        }
      if (text.empty()) continue;
      ReadOptions options;
      fs::path file = write(std::string("damaged") + fs::path(name).extension().string(), text);
      if (yaml) {
        options.loops = file;
        file = models / "epr_robot_delta/robot.urdf";
      }
      try {
        read_scene(file, options);
        ++scenes;
      } catch (const SceneError& error) {
        ++refused;
        EXPECT_EQ(equations::wrong_as_a_sentence(error.what(), name), "");
      }
    }
  }
  EXPECT_GT(scenes, 20);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace momenta::core_robots_broken
