// <keyframe>: a key's state as the start.

#include "equations/model_folder.h"
#include "equations/refusal.h"

namespace momenta::core_mjcf_keys {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

class MjcfKeys : public equations::ModelFolder {
 protected:
  static constexpr const char* bodies =
      "<worldbody><body name='f'><freejoint name='free'/><geom size='1'/><frame pos='0 0 1'><body "
      "name='h'><joint name='hinge' ref='90'/><joint name='ball' type='ball'/><geom "
      "size='1'/><body "
      "name='w'><geom size='1'/></body></body></frame></body><body name='s'><joint name='slide' "
      "type='slide' ref='.5'/><geom size='1'/></body></worldbody>";
  Scene at(const std::string& key) const {
    ReadOptions options;
    options.key = key;
    return mjcf(
        std::string(bodies) +
            "<keyframe>\n<key name='up' qpos='1 2 3 0 0 3 4 2 .1 .2 .2 .4 7' qvel='1 2 3 4 5 "
            "6 7 8 9 10 11' time='2'/></keyframe><keyframe><key qpos='0 0 0 1 0 0 0 0 1 0 0 "
            "0 0'/><key name='0' qvel='0 0 0 0 0 0 .5 0 0 0 0'/></keyframe>",
        options);
  }
};

const JointSpec& joint(const Scene& scene, const std::string& name) {
  for (const JointSpec& j : scene.joints)
    if (j.name == name) return j;
  throw std::out_of_range(name);
}

// q over the joints in the order of the file, hinges and slides without `ref`; the velocity of a
// free body in its own axes.
TEST_F(MjcfKeys, StateOfAKeyIsTheStart) {
  const Scene scene = at("up");
  const Quaterniond turn(0, 0, 0.6, 0.8);
  EXPECT_EQ(joint(scene, "free").position, (std::vector<double>{1, 2, 3, 0, 0, 0.6, 0.8}));
  const std::vector<double>& u = joint(scene, "free").velocity;
  ASSERT_EQ(u.size(), 6U);
  EXPECT_LE((turn * Vector3d(u[0], u[1], u[2]) - Vector3d(1, 2, 3)).norm(), 1e-15);
  EXPECT_EQ(std::vector<double>(u.begin() + 3, u.end()), (std::vector<double>{4, 5, 6}));
  EXPECT_NEAR(joint(scene, "hinge").position.at(0), 2 - std::acos(0), 1e-15);
  EXPECT_EQ(joint(scene, "hinge").velocity, std::vector<double>{7});
  const std::vector<double>& q = joint(scene, "ball").position;
  ASSERT_EQ(q.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(q[i], (std::array{.2, .4, .4, .8}[i]), 1e-15);
  EXPECT_EQ(joint(scene, "ball").velocity, (std::vector<double>{8, 9, 10}));
  EXPECT_EQ(joint(scene, "slide").position, std::vector<double>{6.5});
  EXPECT_EQ(joint(scene, "slide").velocity, std::vector<double>{11});
}

// By number, but a name goes first; what a key does not give is as the model stands.
TEST_F(MjcfKeys, KeysByNumber) {
  EXPECT_EQ(joint(at("1"), "slide").position, std::vector<double>{-0.5});
  EXPECT_TRUE(joint(at("1"), "slide").velocity.empty());
  EXPECT_EQ(joint(at("0"), "hinge").velocity, std::vector<double>{0.5});
  EXPECT_TRUE(joint(at("0"), "hinge").position.empty());
  EXPECT_EQ(joint(at("2"), "hinge").velocity, std::vector<double>{0.5});
}

TEST_F(MjcfKeys, KeysAreToldWhereNoneIsChosen) {
  const auto told = [](const Scene& scene) {
    for (const std::string& remark : scene.remarks)
      if (remark.find("--key") != std::string::npos) return remark;
    return std::string();
  };
  EXPECT_EQ(told(at("")), "not taken as start, as --key would: 'up', '1', '0' (3)");
  EXPECT_EQ(told(at("up")), "");
}

TEST_F(MjcfKeys, WrongKeys) {
  const auto refused = [&](const std::string& key, const std::string& keys,
                           const std::string& expected) {
    ReadOptions options;
    options.key = key;
    expect_refused(bodies + keys, "m.xml", expected, options);
  };
  const std::string two = "<keyframe><key name='home'/><key/></keyframe>";
  refused("hone", two,
          ": has no key 'hone', expected one of 'home', '1' or a number from 0 to 1; did you mean "
          "'home'?");
  refused("2", two, "has no key '2', expected one of");
  refused("-1", two, "has no key '-1'");
  refused("home", "", "has no key 'home', expected a <keyframe> with keys");
  refused("1", "<keyframe><key/>\n<key qpos='1 2'/></keyframe>",
          ":2: key: <key> qpos has 2 numbers, expected 13 for the joints of the model");
  refused("a", "<keyframe>\n<key name='a' qvel='1 2'/></keyframe>",
          ":2: key 'a': <key> qvel has 2 numbers, expected 11 for the joints of the model");
  refused("0", "<keyframe><key qpos='1 2 3 0 0 3 4 2 0 0 0 0 7'/></keyframe>",
          "qpos has a zero quaternion for joint 'ball', expected w x y z");
  refused("0", "<keyframe><key qpos='1 2 3 0 0 3 4 2 0 0 0 x 7'/></keyframe>",
          "qpos has 'x', expected finite numbers");
  // Those that are not chosen are no less wrong.
  refused("", "<keyframe><key/>\n<key name='a' qpos='1 2'/></keyframe>",
          ":2: key 'a': <key> qpos has 2 numbers, expected 13 for the joints of the model");
  refused("0", "<keyframe><key/>\n<key qvel='1'/></keyframe>",
          ":2: key: <key> qvel has 1 numbers, expected 11");
  refused("", "<keyframe><key time='soon'/></keyframe>", "time has 'soon'");
  refused("", "<keyframe>\n<key ctrl='1 2'/></keyframe><actuator><motor joint='hinge'/></actuator>",
          ":2: key: <key> ctrl has 2 numbers, expected 1 for the actuators of the model");
  ReadOptions options;
  options.key = "home";
  for (const char* other : {"r.urdf", "s.toml"})
    EXPECT_TRUE(equations::says(
        equations::thrown<SceneError>(
            [&] { read_scene(write(other, "<robot name='r'><link name='a'/></robot>"), options); }),
        "no MJCF, expected one where a key is given"));
}

}  // namespace
}  // namespace momenta::core_mjcf_keys
