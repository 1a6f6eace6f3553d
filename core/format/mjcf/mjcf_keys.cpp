#include <momenta/core/format/mjcf/mjcf_copies.h>
#include <momenta/core/format/mjcf/mjcf_keys.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <charconv>

namespace momenta::reading {
namespace {

std::string name_of(const std::vector<Node>& keys, std::size_t i) {
  return keys[i].text("name", std::to_string(i));
}

/// The key of that name, else of that number.
const Node& find(const std::vector<Node>& keys, const std::string& chosen, const MjcfModel& model) {
  for (const Node& key : keys)
    if (key.text("name", "") == chosen) return key;
  std::size_t number = 0;
  const char* const end = chosen.data() + chosen.size();
  const auto [stop, error] = std::from_chars(chosen.data(), end, number);
  if (stop == end && error == std::errc() && number < keys.size()) return keys[number];
  std::vector<std::string> names;
  for (std::size_t i = 0; i < keys.size(); ++i) names.push_back(name_of(keys, i));
  const std::vector<std::string_view> views(names.begin(), names.end());
  fail(model.scene.file, {},
       "has no key " + in_quotes(chosen) +
           (keys.empty() ? ", expected a <keyframe> with keys where one is asked for"
                         : ", expected one of " + all_in_quotes(names, 20) +
                               " or a number from 0 to " + std::to_string(keys.size() - 1)) +
           did_you_mean(chosen, views));
}

/// Deals the numbers of `attribute` out to `joints`, those of the model: `size(joint)` to each. A
/// key of an attached model is for its joints alone.
template <class Size, class Give>
void deal(const Node& key, const char* attribute, const MjcfModel& model,
          std::vector<JointSpec>& joints, const Size& size, const Give& give) {
  if (!key.has(attribute)) return;
  const std::vector<double> numbers = key.numbers(attribute);
  const std::string* const attached = key.element().find(of_model);
  const auto meant = [&](const JointSpec& joint) {
    if (attached == nullptr) return model.refs.contains(joint.name);
    const auto of = model.joint_of_attached.find(joint.name);
    return of != model.joint_of_attached.end() && of->second == *attached;
  };
  std::size_t all = 0;
  for (const JointSpec& joint : joints)
    if (meant(joint)) all += size(joint);
  if (numbers.size() != all)
    key.fail(attribute, "has " + std::to_string(numbers.size()) + " numbers, expected " +
                            std::to_string(all) + " for the joints of the model");
  auto from = numbers.begin();
  for (JointSpec& joint : joints)
    if (meant(joint)) {
      const auto count = static_cast<std::ptrdiff_t>(size(joint));
      give(joint, std::vector<double>(from, from + count));
      from += count;
    }
}

/// Normalises the quaternion that begins at `at`.
void normalise(const Node& key, const JointSpec& joint, std::vector<double>& q, std::size_t at) {
  Eigen::Map<Eigen::Vector4d> quaternion(q.data() + at);
  if (!(quaternion.norm() > 0))
    key.fail("qpos",
             "has a zero quaternion for joint " + in_quotes(joint.name) + ", expected w x y z");
  quaternion /= quaternion.norm();
}

/// Gives `joints`, those of the model, the state of a key.
void start_at(const Node& key, const MjcfModel& model, std::vector<JointSpec>& joints) {
  deal(
      key, "qpos", model, joints,
      [](const JointSpec& joint) { return static_cast<std::size_t>(coordinates_of(joint)); },
      [&](JointSpec& joint, std::vector<double> q) {
        if (joint.kind == JointKind::spherical) normalise(key, joint, q, 0);
        if (joint.kind == JointKind::free) normalise(key, joint, q, 3);
        if (q.size() == 1) q[0] -= model.refs.at(joint.name);
        joint.position = std::move(q);
      });
  deal(
      key, "qvel", model, joints,
      [](const JointSpec& joint) { return static_cast<std::size_t>(rates_of(joint)); },
      [](JointSpec& joint, std::vector<double> u) {
        if (joint.kind == JointKind::free) {
          const std::vector<double>& q = joint.position;
          const Eigen::Quaterniond turn(q[3], q[4], q[5], q[6]);
          Eigen::Map<Eigen::Vector3d> along(u.data());
          along = turn.conjugate() * Eigen::Vector3d(along);
        }
        joint.velocity = std::move(u);
      });
}

}  // namespace

namespace {

std::vector<Node> keys_in(const std::vector<Node>& keyframes) {
  std::vector<Node> keys;
  for (const Node& keyframe : keyframes)
    for (const Node& key : keyframe.children("key"))
      keys.push_back(key.of(key.has("name") ? "key " + in_quotes(key.text("name", "")) : "key"));
  return keys;
}

}  // namespace

void expect_keys_fit(const std::vector<Node>& keyframes, std::size_t actuators,
                     const MjcfModel& model) {
  for (const Node& key : keys_in(keyframes)) {
    std::vector<JointSpec> joints = model.scene.joints;
    start_at(key, model, joints);
    key.number("time", 0);
    if (!key.has("ctrl") || key.element().find(of_model) != nullptr) continue;
    if (const std::size_t count = key.numbers("ctrl").size(); count != actuators)
      key.fail("ctrl", "has " + std::to_string(count) + " numbers, expected " +
                           std::to_string(actuators) + " for the actuators of the model");
  }
}

std::vector<double> controls_of_key(const std::vector<Node>& keyframes, const std::string& chosen,
                                    const MjcfModel& model) {
  if (chosen.empty()) return {};
  const std::vector<Node> keys = keys_in(keyframes);
  const Node& key = find(keys, chosen, model);
  const bool whole = key.element().find(of_model) == nullptr;  // else for actuators of one part
  return key.has("ctrl") && whole ? key.numbers("ctrl") : std::vector<double>{};
}

void read_keys(const std::vector<Node>& keyframes, const std::string& chosen, bool acts,
               MjcfModel& model) {
  const std::vector<Node> keys = keys_in(keyframes);
  if (!chosen.empty()) {
    const Node& key = find(keys, chosen, model);
    start_at(key, model, model.scene.joints);
    if (key.number("time", 0) != 0)
      model.remarks.left_out("time of the key: runs begin at 0, and nothing depends on time");
    if (key.has("ctrl") && key.element().find(of_model) != nullptr)
      model.remarks.left_out("ctrl of the key of an attached model");
    else if (key.has("ctrl") && !acts)
      model.remarks.left_out("ctrl of the key, which --control lets act");
    for (const char* other : {"act", "mpos", "mquat"})
      if (key.has(other)) model.remarks.left_out(std::string(other) + " of the key");
  } else if (!keys.empty()) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < keys.size(); ++i) names.push_back(name_of(keys, i));
    for (std::size_t i = 0; i < keys.size(); ++i)
      model.remarks.count("not taken as start, as --key would: " + all_in_quotes(names, 20));
  }
}

}  // namespace momenta::reading
