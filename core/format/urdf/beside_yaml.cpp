// The YAML file beside a URDF, as in example-parallel-robots:
//
//   closed_loop: [[frame, frame], ...]   loops
//   type: ['3d' | '6d', ...]             a point, or a weld
//   joint_name: [joint, ...]             joints whose type the URDF cannot say
//   joint_type: [SPHERICAL | FIXED | UJOINT_XY | ... | CARDAN, ...]
//   name_mot: [joint, ...]               joints with a motor
//
// A joint of another type keeps the origin of the URDF, and its axes are those of the origin:
// UJOINT_YZ turns about y, held by the parent, then about z, held by the child; CARDAN is
// UJOINT_XY; FIXED welds the child where it is at q = 0.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

namespace momenta::reading {
namespace {

constexpr std::array<std::string_view, 5> keys{"closed_loop", "type", "joint_name", "joint_type",
                                               "name_mot"};

Location place(const YAML::Mark& mark) {
  return mark.is_null() ? Location{} : Location{mark.line + 1, mark.column + 1};
}

/// The file, with the scene of its joints and links.
class YamlBeside {
 public:
  YamlBeside(const std::filesystem::path& file, const YAML::Node& root, const Scene& scene)
      : name_(file.string()), root_(root), scene_(scene) {}

  [[noreturn]] void fail(const YAML::Node& node, const std::string& sentence) const {
    momenta::reading::fail(name_, place(node.Mark()), sentence);
  }
  std::vector<YAML::Node> list(const char* key) const {
    const YAML::Node found = root_[key];
    if (!found)
      momenta::reading::fail(name_, {}, std::string("no key ") + key + ", expected a list");
    return items(found, std::string(key) + " is no list, expected one");
  }
  /// The pairs of two lists. Empty: the file has neither.
  std::vector<std::pair<YAML::Node, YAML::Node>> pairs(const char* key, const char* type) const {
    if (!root_[key] && !root_[type]) return {};
    const auto one = list(key), two = list(type);
    if (one.size() != two.size())
      momenta::reading::fail(name_, {},
                             std::string(key) + " has " + std::to_string(one.size()) +
                                 " entries and " + type + " " + std::to_string(two.size()) +
                                 ", expected as many");
    std::vector<std::pair<YAML::Node, YAML::Node>> both;
    for (std::size_t i = 0; i < one.size(); ++i) both.emplace_back(one[i], two[i]);
    return both;
  }
  std::vector<YAML::Node> items(const YAML::Node& node, const std::string& otherwise) const {
    if (!node.IsSequence()) fail(node, otherwise);
    std::vector<YAML::Node> all;
    for (const auto& item : node) all.push_back(item);
    return all;
  }
  std::string word(const YAML::Node& node) const {
    if (!node.IsScalar()) fail(node, "a list or a map, expected a word");
    return node.Scalar();
  }
  /// The link of a frame: the child of the joint of that name, or the link itself.
  std::string link(const YAML::Node& node) const {
    const std::string frame = word(node);
    std::vector<std::string_view> known;
    for (const JointSpec& joint : scene_.joints) {
      if (joint.name == frame) return joint.child;
      known.push_back(joint.name);
    }
    for (const BodySpec& body : scene_.bodies) {
      if (body.name == frame || (frame == "ground" && body.name == ground_link)) return body.name;
      known.push_back(body.name);
    }
    fail(node, "closed_loop has " + in_quotes(frame) + ", expected a joint or a link of " +
                   on_one_line(scene_.file) + did_you_mean(frame, known));
  }
  /// Index of a joint in the scene.
  std::size_t joint(const YAML::Node& node, const char* key) const {
    const std::string name = word(node);
    std::vector<std::string_view> known;
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) {
      if (scene_.joints[i].name == name) return i;
      known.push_back(scene_.joints[i].name);
    }
    fail(node, std::string(key) + " has " + in_quotes(name) + ", expected a joint of " +
                   on_one_line(scene_.file) + did_you_mean(name, known));
  }
  /// Refuses unknown keys, and repeated ones, of which yaml-cpp takes the first.
  void refuse_other_keys() const {
    std::set<std::string> met;
    for (const auto& entry : root_) {
      const std::string key = word(entry.first);
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        fail(entry.first, "key " + in_quotes(key) + " is not known, expected one of: " +
                              listed(keys) + did_you_mean(key, keys));
      if (!met.insert(key).second)
        fail(entry.first, "key " + in_quotes(key) + " is there twice, expected it once");
    }
  }

 private:
  std::string name_;
  YAML::Node root_;
  const Scene& scene_;
};

/// Gives a joint of a URDF its type in the YAML file.
void retype(JointSpec& joint, const std::string& type, const YamlBeside& file, const YAML::Node& at,
            Remarks& remarks) {
  const auto axis_of = [&](char letter) -> int {
    return letter >= 'X' && letter <= 'Z' ? letter - 'X' : -1;
  };
  JointKind kind = JointKind::spherical;
  Eigen::Vector3d first = Eigen::Vector3d::UnitZ(), second = Eigen::Vector3d::Zero();
  const std::string pair = type == "CARDAN"                                         ? "XY"
                           : type.size() == 9 && type.compare(0, 7, "UJOINT_") == 0 ? type.substr(7)
                                                                                    : "";
  if (!pair.empty() && axis_of(pair[0]) >= 0 && axis_of(pair[1]) >= 0 && pair[0] != pair[1]) {
    kind = JointKind::universal;
    first = Eigen::Vector3d::Unit(axis_of(pair[0]));
    second = Eigen::Vector3d::Unit(axis_of(pair[1]));
  } else if (type == "FIXED") {
    kind = JointKind::weld;
  } else if (type != "SPHERICAL") {
    file.fail(at, "joint_type has " + in_quotes(type) +
                      ", expected SPHERICAL, FIXED, CARDAN, or UJOINT_ with two of X Y Z");
  }
  if (joint.kind == JointKind::weld && kind != JointKind::weld)
    file.fail(at, "joint_type " + type + " is for joint " + in_quotes(joint.name) +
                      ", which the URDF fixes, expected a joint that moves");
  joint.kind = kind;
  joint.axis = first;
  joint.axis2 = second;
  if (joint.damping != 0) remarks.left_out("dampers of joints of several degrees of freedom");
  joint.damping = 0;
}

void read_joint_types(const YamlBeside& file, Scene& scene, Remarks& remarks) {
  std::set<std::size_t> done;
  for (const auto& [name, type] : file.pairs("joint_name", "joint_type")) {
    const std::size_t joint = file.joint(name, "joint_name");
    if (!done.insert(joint).second)
      file.fail(name, "joint_name has " + in_quotes(scene.joints[joint].name) +
                          " twice, expected it once");
    retype(scene.joints[joint], file.word(type), file, type, remarks);
  }
}

void read_loops(const YamlBeside& file, Scene& scene, FreeNames& edges) {
  int number = 0;
  for (const auto& [pair, kind] : file.pairs("closed_loop", "type")) {
    const std::string expected = "closed_loop holds no pair, expected two frames";
    const auto ends = file.items(pair, expected);
    if (ends.size() != 2) file.fail(pair, expected);
    LoopSpec loop;
    loop.parent = file.link(ends[0]);
    loop.child = file.link(ends[1]);
    const std::string type = file.word(kind);
    if (type != "3d" && type != "6d" && type != "3D" && type != "6D")
      file.fail(kind, "type has " + in_quotes(type) + ", expected '3d' or '6d'");
    loop.kind = type[0] == '3' ? LoopKind::point : LoopKind::weld;
    if (loop.parent == loop.child)
      file.fail(pair, "closed_loop ties link " + in_quotes(loop.parent) +
                          " to itself, expected two links");
    loop.name = edges.free("loop " + std::to_string(++number));
    scene.loops.push_back(loop);
  }
}

/// `asked`: the user named the file, so that one without loops is a mistake.
void read_yaml(const std::filesystem::path& path, bool asked, Scene& scene, FreeNames& edges,
               Remarks& remarks) try {
  const YAML::Node root = YAML::Load(text_of(path));
  const auto has = [&](std::string_view key) {
    return root.IsMap() && root[std::string(key)].IsDefined();
  };
  // A file for another purpose has none of these keys; one with a misspelt key would give another
  // mechanism.
  if (!asked && std::none_of(keys.begin(), keys.end(), has))
    return remarks.left_out("the YAML file beside it, which has no closed_loop");
  if (!root.IsMap()) fail(path.string(), {}, "no map of keys, expected closed_loop and type");
  const YamlBeside file(path, root, scene);
  if (asked && !has("joint_name")) static_cast<void>(file.list("closed_loop"));
  file.refuse_other_keys();
  read_joint_types(file, scene, remarks);
  read_loops(file, scene, edges);
  if (!has("name_mot")) return;
  for (const YAML::Node& motor : file.list("name_mot")) {
    static_cast<void>(file.joint(motor, "name_mot"));
    remarks.left_out("motors of name_mot, which drive nothing here");
  }
} catch (const YAML::Exception& error) {
  fail(path.string(), place(error.mark),
       "not valid YAML: " + on_one_line(error.msg) + ", expected lists closed_loop and type");
}

}  // namespace

void read_beside(const std::string& urdf, const ReadOptions& options, Scene& scene,
                 FreeNames& edges, Remarks& remarks) {
  if (!options.loops.empty()) return read_yaml(options.loops, true, scene, edges, remarks);
  for (const char* ending : {".yaml", ".yml"}) {
    const std::filesystem::path beside = std::filesystem::path(urdf).replace_extension(ending);
    std::error_code error;
    if (std::filesystem::is_regular_file(beside, error))
      return read_yaml(beside, false, scene, edges, remarks);
  }
}

}  // namespace momenta::reading
