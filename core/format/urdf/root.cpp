// The root of a URDF, the only link that is no joint's child, is welded to the ground, or free
// where asked for: URDF does not say which.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <map>

namespace momenta::reading {

namespace {

bool is_ground(std::string text) {
  text.erase(0, text.find_first_not_of(" \t\r\n"));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  return text == "ground";
}

/// Renames a link "ground" in attributes, and in the text of a <joint> of <gazebo>.
void rename_in(Element& element) {
  for (Attribute& a : element.attributes)
    if ((a.name == "link" || a.name == "reference" ||
         (element.name == "link" && a.name == "name")) &&
        is_ground(a.text))
      a.text = ground_link;
  if ((element.name == "parent" || element.name == "child") && is_ground(element.text))
    element.text = ground_link;
  for (Element& child : element.children) rename_in(child);
}

}  // namespace

namespace {

constexpr const char* loops_of_urdf =
    "; a loop is a <loop>, a <joint> in <gazebo>, or stands in a YAML file beside the URDF";

/// @pre every link is the child of one joint at most
void expect_no_cycle(const std::map<std::string, const JointSpec*>& inward, const Scene& scene) {
  std::map<std::string, const JointSpec*>
      seen;  // by link: the joint at which its walk inwards began
  for (const JointSpec& start : scene.joints) {
    std::string link = start.child;
    for (auto in = inward.find(link); in != inward.end(); in = inward.find(link)) {
      const auto [before, fresh] = seen.emplace(link, &start);
      if (!fresh && before->second != &start) break;
      if (!fresh) {
        std::string joints, links = on_one_line(link);
        const std::string first = link;
        do {
          const JointSpec& joint = *inward.at(link);
          joints += (joints.empty() ? "" : ", ") + in_quotes(joint.name);
          link = joint.parent;
          links += " <- " + on_one_line(link);
        } while (link != first);
        throw SceneError(scene.where(start.at) + "joints " + joints + " form a cycle, " + links +
                         ", expected a tree" + loops_of_urdf);
      }
      link = in->second->parent;
    }
  }
}

}  // namespace

bool rename_ground(Element& robot, bool free) {
  bool there = false, root = true;
  for (const Element& part : robot.children) {
    const std::string* const name = part.find("name");
    there |= part.name == "link" && name != nullptr && is_ground(*name);
    if (part.name != "joint") continue;
    for (const Element& end : part.children) {
      const std::string* const link = end.find("link");
      root &= end.name != "child" || link == nullptr || !is_ground(*link);
    }
  }
  if (!there || (root && !free)) return false;
  rename_in(robot);
  return true;
}

bool hang_root(Scene& scene, const Node& robot, const std::vector<Node>& links, bool free,
               FreeNames& edges) {
  std::map<std::string, const Node*> roots;
  for (const Node& link : links)
    if (!roots.emplace(link.text("name"), &link).second)
      link.fail("is the second of that name, expected each name once");
  for (const JointSpec& joint : scene.joints) {
    const auto known = [&](const std::string& link, const char* what) {
      if (roots.contains(link)) return;
      std::vector<std::string_view> names;
      for (const BodySpec& body : scene.bodies) names.push_back(body.name);
      throw SceneError(scene.where(joint.at) + "joint " + in_quotes(joint.name) + ": " + what +
                       " is " + in_quotes(link) + ", expected the name of a link" +
                       did_you_mean(link, names));
    };
    known(joint.parent, "parent");
    known(joint.child, "child");
  }
  std::map<std::string, const JointSpec*> inward;
  for (const JointSpec& joint : scene.joints) {
    roots.erase(joint.child);
    const auto [other, fresh] = inward.emplace(joint.child, &joint);
    if (!fresh)
      throw SceneError(scene.where(joint.at) + "link " + in_quotes(joint.child) +
                       " is the child of joints " + in_quotes(other->second->name) + " and " +
                       in_quotes(joint.name) + ", expected exactly one" + loops_of_urdf);
  }
  expect_no_cycle(inward, scene);
  if (roots.size() > 1)
    robot.fail("has two links that are no joint's child, " + in_quotes(roots.begin()->first) +
               " and " + in_quotes(std::next(roots.begin())->first) +
               ", expected one root and a tree below it");
  const std::string root = roots.begin()->first;
  if (root == "ground") {
    std::erase_if(scene.bodies, [](const BodySpec& body) { return body.name == "ground"; });
    return false;
  }
  JointSpec joint;
  joint.at = roots.begin()->second->at();
  joint.name = edges.free("root");
  joint.kind = free ? JointKind::free : JointKind::weld;
  joint.child = root;
  scene.joints.insert(scene.joints.begin(), joint);
  return !free;
}

namespace {

/// The joints form branches, one for each moving joint of the root. Two branches are tied where a
/// loop closes from one to the other, or to the root or the ground.
class Branches {
 public:
  explicit Branches(const Scene& scene) {
    for (const JointSpec& joint : scene.joints) inward_[joint.child] = &joint;
    for (const JointSpec& joint : scene.joints)
      if (const std::string branch = of(joint.child); !branch.empty())
        tied_.emplace(branch, branch);
    for (const LoopSpec& loop : scene.loops)
      if (ties_bodies(loop)) tie(of(loop.parent), of(loop.child));
  }
  /// Number of branches, tied ones counted as one, those tied to the ground not at all.
  int count() const {
    int all = 0;
    for (const auto& [branch, to] : tied_) all += branch == to && !branch.empty();
    return all;
  }

 private:
  /// The link at which a branch begins; empty for the ground, and links welded to it.
  std::string of(const std::string& link) {
    std::vector<const JointSpec*> way;  // inwards, to a link whose branch is known
    for (std::string at = link; !begin_.contains(at); at = way.back()->parent)
      way.push_back(inward_.at(at));
    for (; !way.empty(); way.pop_back()) {
      const JointSpec& joint = *way.back();
      const std::string& inner = begin_.at(joint.parent);
      const bool moves = joint.kind != JointKind::weld;
      begin_[joint.child] = inner.empty() && moves ? joint.child : inner;
    }
    return begin_.at(link);
  }
  std::string top(std::string branch) const {
    for (auto at = tied_.find(branch); at != tied_.end() && at->second != branch;
         at = tied_.find(branch))
      branch = at->second;
    return branch;
  }
  void tie(const std::string& one, const std::string& two) {
    const std::string a = top(one), b = top(two);
    if (a != b) tied_[std::max(a, b)] = std::min(a, b);  // the empty name, the ground, is least
  }

  std::map<std::string, const JointSpec*> inward_;
  std::map<std::string, std::string> begin_{{"ground", ""}};
  std::map<std::string, std::string> tied_;  ///< each branch to one it is tied to, or to itself
};

}  // namespace

void tell_of_fixed_root(const Scene& scene, Remarks& remarks) {
  const JointSpec& root = scene.joints.front();
  const auto link = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const BodySpec& body) { return body.name == root.child; });
  const int branches = Branches(scene).count();
  if (link == scene.bodies.end() || link->mass == 0 || branches < 2) return;
  remarks.say("root link " + in_quotes(link->name) +
              " is fixed to the ground, but has a mass and " + std::to_string(branches) +
              " branches that no loop ties to each other: if it floats, give --free-root");
}

}  // namespace momenta::reading
