// Loops beside a URDF, as the files of example-parallel-robots have them:
//
//   closed_loop: [[frame, frame], ...]
//   type: ['3d' | '6d', ...]

#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/near_name.h>
#include <momenta/core/scene/urdf/urdf.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

namespace momenta::reading {
namespace {

Location place(const YAML::Mark& mark) {
  return mark.is_null() ? Location{} : Location{mark.line + 1, mark.column + 1};
}

/// A file of loops with the scene whose frames it names.
class LoopsFile {
 public:
  LoopsFile(const std::filesystem::path& file, const Scene& scene)
      : name_(file.string()), scene_(scene) {}

  std::vector<YAML::Node> list(const YAML::Node& root, const char* key) const {
    const YAML::Node found = root[key];
    if (!found) fail(name_, {}, std::string("no key ") + key + ", expected a list");
    return items(found, std::string(key) + " is no list, expected one");
  }
  std::vector<YAML::Node> items(const YAML::Node& node, const std::string& otherwise) const {
    if (!node.IsSequence()) fail(name_, place(node.Mark()), otherwise);
    std::vector<YAML::Node> all;
    for (const auto& item : node) all.push_back(item);
    return all;
  }
  std::string word(const YAML::Node& node) const {
    if (!node.IsScalar()) fail(name_, place(node.Mark()), "a list or a map, expected a word");
    return node.Scalar();
  }
  /// The link whose frame it is: the child of the joint of that name, or the link.
  std::string link(const YAML::Node& node) const {
    const std::string frame = word(node);
    std::vector<std::string_view> known;
    for (const JointSpec& joint : scene_.joints) {
      if (joint.name == frame) return joint.child;
      known.push_back(joint.name);
    }
    for (const BodySpec& body : scene_.bodies) {
      if (body.name == frame) return frame;
      known.push_back(body.name);
    }
    fail(name_, place(node.Mark()),
         "closed_loop has " + in_quotes(frame) + ", expected a joint or a link of " +
             on_one_line(scene_.file) + did_you_mean(frame, known));
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  const Scene& scene_;
};

/// `asked`: by the user, so that a file without loops is a mistake.
void read_loops(const std::filesystem::path& path, bool asked, Scene& scene, FreeNames& edges,
                Remarks& remarks) try {
  const LoopsFile file(path, scene);
  const YAML::Node root = YAML::Load(text_of(path));
  if (!asked && (!root.IsMap() || !root["closed_loop"]))
    return remarks.left_out("the YAML file beside it, which has no closed_loop");
  if (!root.IsMap()) fail(file.name(), {}, "no map of keys, expected closed_loop and type");
  const auto pairs = file.list(root, "closed_loop"), types = file.list(root, "type");
  if (pairs.size() != types.size())
    fail(file.name(), {},
         "closed_loop has " + std::to_string(pairs.size()) + " entries and type " +
             std::to_string(types.size()) + ", expected as many");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string expected = "closed_loop holds no pair, expected two frames";
    const auto ends = file.items(pairs[i], expected);
    if (ends.size() != 2) fail(file.name(), place(pairs[i].Mark()), expected);
    LoopSpec loop;
    loop.parent = file.link(ends[0]);
    loop.child = file.link(ends[1]);
    const std::string type = file.word(types[i]);
    if (type != "3d" && type != "6d" && type != "3D" && type != "6D")
      fail(file.name(), place(types[i].Mark()),
           "type has " + in_quotes(type) + ", expected '3d' or '6d'");
    loop.kind = type[0] == '3' ? LoopKind::point : LoopKind::weld;
    if (loop.parent == loop.child)
      fail(file.name(), place(pairs[i].Mark()),
           "closed_loop ties link " + in_quotes(loop.parent) + " to itself, expected two links");
    loop.name = edges.free("loop " + std::to_string(i + 1));
    scene.loops.push_back(loop);
  }
  for (const auto& entry : root) {
    const std::string key = file.word(entry.first);
    if (key != "closed_loop" && key != "type") remarks.left_out("key " + key + " beside the loops");
  }
} catch (const YAML::Exception& error) {
  fail(path.string(), place(error.mark), "not valid YAML: " + on_one_line(error.msg));
}

}  // namespace

void read_loops_beside(const std::string& urdf, const ReadOptions& options, Scene& scene,
                       FreeNames& edges, Remarks& remarks) {
  if (!options.loops.empty()) return read_loops(options.loops, true, scene, edges, remarks);
  for (const char* ending : {".yaml", ".yml"}) {
    const std::filesystem::path beside = std::filesystem::path(urdf).replace_extension(ending);
    std::error_code error;
    if (std::filesystem::is_regular_file(beside, error))
      return read_loops(beside, false, scene, edges, remarks);
  }
}

}  // namespace momenta::reading
