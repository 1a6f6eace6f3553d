#include <momenta/dae/cut/child_order.h>
#include <momenta/dae/cut/tie_graph.h>

#include <algorithm>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace momenta {
namespace {

/// The tree of a scene by numbers, 0 the ground, with the loops that go on from a body to its
/// parent, and those that close at a body.
class OpenLoops {
 public:
  explicit OpenLoops(const Scene& scene) {
    number_["ground"] = 0;
    for (const BodySpec& body : scene.bodies) number_.emplace(body.name, number_.size());
    parent_.resize(number_.size());
    depth_.resize(number_.size());
    joints_.resize(number_.size());
    leaving_.resize(number_.size());
    for (std::size_t i = 0; i < scene.joints.size(); ++i) {
      const JointSpec& joint = scene.joints[i];
      const std::size_t child = number(joint.child);
      number_of_joint_[joint.name] = child;
      children_.push_back(child);
      parent_[child] = number(joint.parent);
      joints_[parent_[child]].push_back(i);
    }
    std::vector<std::size_t> reached{0};
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const std::size_t joint : joints_[reached[i]]) {
        depth_[children_[joint]] = depth_[reached[i]] + 1;
        reached.push_back(children_[joint]);
      }
    for (std::size_t i = 0; i < scene.loops.size(); ++i) climb(i, ends(scene.loops[i]));
  }

  std::size_t bodies() const { return parent_.size(); }
  /// Joints below a body, by their place in the scene, and the child of each.
  const std::vector<std::size_t>& joints(std::size_t body) const { return joints_[body]; }
  std::size_t child(std::size_t joint) const { return children_[joint]; }
  const std::vector<std::size_t>& leaving(std::size_t body) const { return leaving_[body]; }
  std::size_t closes_at(std::size_t loop) const { return closes_at_[loop]; }

 private:
  std::size_t number(const std::string& body) const { return number_.at(body); }
  std::set<std::size_t> ends(const LoopSpec& loop) const {
    std::set<std::size_t> all;
    for (const std::string& body : {loop.parent, loop.child})
      if (const auto found = number_.find(body); found != number_.end()) all.insert(found->second);
    for (const std::string& joint : loop.joints)
      if (const auto found = number_of_joint_.find(joint); found != number_of_joint_.end())
        all.insert(found->second);
    return all;
  }
  void climb(std::size_t loop, std::set<std::size_t> at) {
    while (at.size() > 1) {
      const std::size_t deepest =
          *std::max_element(at.begin(), at.end(),
                            [&](std::size_t a, std::size_t b) { return depth_[a] < depth_[b]; });
      leaving_[deepest].push_back(loop);
      at.erase(deepest);
      at.insert(parent_[deepest]);
    }
    closes_at_.push_back(at.empty() ? 0 : *at.begin());
  }

  std::unordered_map<std::string, std::size_t> number_, number_of_joint_;
  std::vector<std::size_t> parent_, depth_, children_, closes_at_;
  std::vector<std::vector<std::size_t>> joints_, leaving_;
};

/// The joints below `body` in their new order.
std::vector<std::size_t> ordered(const OpenLoops& loops, std::size_t body) {
  const std::vector<std::size_t>& joints = loops.joints(body);
  TieGraph graph(joints.size());
  std::unordered_map<std::size_t, std::size_t> first_of, left;  // per loop: first child, those left
  const auto leaving = [&](std::size_t i) -> auto& {
    return loops.leaving(loops.child(joints[i]));
  };
  for (std::size_t i = 0; i < joints.size(); ++i)
    for (const std::size_t loop : leaving(i)) {
      graph.tie(first_of.emplace(loop, i).first->second, i);
      ++left[loop];
    }
  graph.settle();
  struct Group {
    std::vector<std::size_t> members;
    long freed = 0;
  };
  std::vector<Group> groups;
  std::vector<char> placed(joints.size(), 0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (placed[i]) continue;
    Group group{graph.ties(i).empty() ? std::vector{i} : graph.from_an_end(i)};
    std::set<std::size_t> open;
    std::size_t most = 0;
    for (std::size_t j = group.members.size(); j-- > 0;) {
      const std::size_t one = group.members[j];
      placed[one] = 1;
      open.insert(leaving(one).begin(), leaving(one).end());
      most = std::max(most, open.size());
      for (const std::size_t loop : leaving(one))
        if (--left[loop] == 0 && loops.closes_at(loop) == body) open.erase(loop);
    }
    group.freed = static_cast<long>(most - open.size());
    groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const Group& a, const Group& b) { return a.freed < b.freed; });
  std::vector<std::size_t> order;
  for (const Group& group : groups)
    for (const std::size_t i : group.members) order.push_back(joints[i]);
  return order;
}

}  // namespace

std::optional<Scene> with_children_ordered(const Scene& scene) {
  if (scene.loops.empty()) return std::nullopt;
  const OpenLoops loops(scene);
  std::optional<Scene> anew;
  for (std::size_t body = 1; body < loops.bodies(); ++body) {
    const std::vector<std::size_t>& joints = loops.joints(body);
    if (joints.size() < 2) continue;
    const std::vector<std::size_t> order = ordered(loops, body);
    if (order == joints) continue;
    if (!anew) anew = scene;
    for (std::size_t i = 0; i < joints.size(); ++i)
      anew->joints[joints[i]] = scene.joints[order[i]];
  }
  return anew;
}

}  // namespace momenta
