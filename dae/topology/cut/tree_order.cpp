#include <momenta/dae/topology/cut/cut_cost.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/tree_order.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
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

namespace {

/// The trees on the ground, numbered in the order of the scene, and which of them loops tie.
class Trees {
 public:
  explicit Trees(const Scene& scene) {
    std::unordered_map<std::string, std::vector<const JointSpec*>> children;
    for (const JointSpec& joint : scene.joints) children[joint.parent].push_back(&joint);
    for (const JointSpec& joint : scene.joints) {
      if (joint.parent != "ground") continue;
      std::vector<const JointSpec*> pending{&joint};
      while (!pending.empty()) {
        const JointSpec& next = *pending.back();
        pending.pop_back();
        of_body_[next.child] = count_;
        of_joint_[next.name] = count_;
        if (const auto found = children.find(next.child); found != children.end())
          pending.insert(pending.end(), found->second.begin(), found->second.end());
      }
      ++count_;
    }
    graph_ = TieGraph(count_);
    for (const LoopSpec& loop : scene.loops) {
      const std::vector<std::size_t> tied = of(loop);
      for (std::size_t i = 1; i < tied.size(); ++i) graph_.tie(tied[0], tied[i]);
    }
    graph_.settle();
  }

  std::size_t count() const { return count_; }
  const TieGraph& graph() const { return graph_; }

  /// The trees that a loop ties, the ground left out.
  std::vector<std::size_t> of(const LoopSpec& loop) const {
    std::vector<std::size_t> trees;
    const auto add = [&](const auto& map, const std::string& name) {
      if (const auto found = map.find(name); found != map.end()) trees.push_back(found->second);
    };
    add(of_body_, loop.parent);
    add(of_body_, loop.child);
    for (const std::string& joint : loop.joints) add(of_joint_, joint);
    return trees;
  }

 private:
  std::unordered_map<std::string, std::size_t> of_body_, of_joint_;
  TieGraph graph_;
  std::size_t count_ = 0;
};

bool driven(const Scene& scene, const std::string& loop) {
  return std::any_of(scene.drives.begin(), scene.drives.end(),
                     [&](const DriveSpec& drive) { return drive.loop == loop; });
}

enum class RootOrder { from_an_end, from_the_centre };

std::vector<std::size_t> places(const Trees& trees, RootOrder order) {
  std::vector<std::size_t> place(trees.count());
  std::vector<char> placed(trees.count(), 0);
  std::size_t next = 0;
  for (std::size_t tree = 0; tree < trees.count(); ++tree) {
    if (placed[tree]) continue;
    const TieGraph& graph = trees.graph();
    std::vector<std::size_t> all = graph.breadth_first(tree);
    if (order == RootOrder::from_an_end)
      all = graph.from_an_end(tree);
    else
      all = graph.breadth_first(
          *std::max_element(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
            return graph.ties(a).size() < graph.ties(b).size();
          }));
    for (const std::size_t one : all) {
      placed[one] = 1;
      place[one] = next++;
    }
  }
  return place;
}

}  // namespace

namespace {

/// The loops of a scene once its trees have places: in which order, and which are turned round.
struct OrderedLoops {
  std::vector<std::size_t> order;  ///< places in the scene; empty: as there
  std::vector<char> turned;
};

OrderedLoops ordered_loops(const Scene& scene, const std::vector<std::vector<std::size_t>>& tied,
                           const std::vector<char>& may_turn,
                           const std::vector<std::size_t>& place) {
  OrderedLoops loops;
  loops.turned.assign(scene.loops.size(), 0);
  std::vector<std::pair<std::size_t, std::size_t>> by_place;  // first tree's place; loop
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    std::size_t least = place.size();
    for (const std::size_t one : tied[i]) least = std::min(least, place[one]);
    by_place.emplace_back(least, i);
    // Branches of one shape go side by side if their loops are written alike.
    loops.turned[i] = may_turn[i] && place[tied[i][1]] < place[tied[i][0]];
  }
  if (std::is_sorted(by_place.begin(), by_place.end())) return loops;
  std::sort(by_place.begin(), by_place.end());
  for (const auto& [place_of, i] : by_place) loops.order.push_back(i);
  return loops;
}

Scene in_order(const Scene& scene, const std::vector<std::size_t>& place,
               const OrderedLoops& loops) {
  Scene ordered = scene;
  std::vector<const JointSpec*> roots(place.size());
  std::size_t tree = 0;
  for (const JointSpec& joint : scene.joints)
    if (joint.parent == "ground") roots[place[tree++]] = &joint;
  tree = 0;
  for (JointSpec& joint : ordered.joints)
    if (joint.parent == "ground") joint = *roots[tree++];
  for (std::size_t i = 0; i < loops.turned.size(); ++i)
    if (loops.turned[i]) ordered.loops[i] = reversed(scene.loops[i]);
  if (loops.order.empty()) return ordered;
  std::vector<LoopSpec> sorted;
  sorted.reserve(loops.order.size());
  for (const std::size_t i : loops.order) sorted.push_back(std::move(ordered.loops[i]));
  ordered.loops = std::move(sorted);
  return ordered;
}

}  // namespace

std::vector<Scene> with_roots_ordered(const Scene& scene) {
  std::vector<Scene> ordered;
  const Trees trees(scene);
  std::vector<std::vector<std::size_t>> tied;
  std::vector<char> may_turn;
  for (const LoopSpec& loop : scene.loops) {
    tied.push_back(trees.of(loop));
    may_turn.push_back(can_turn_round(loop) && tied.back().size() == 2 &&
                       !driven(scene, loop.name));
  }
  std::vector<std::size_t> as_given(trees.count()), before;
  std::iota(as_given.begin(), as_given.end(), std::size_t{0});
  for (const RootOrder order : {RootOrder::from_an_end, RootOrder::from_the_centre}) {
    const std::vector<std::size_t> place = places(trees, order);
    if (place == before) continue;
    before = place;
    const OrderedLoops loops = ordered_loops(scene, tied, may_turn, place);
    const bool turns = std::find(loops.turned.begin(), loops.turned.end(), 1) != loops.turned.end();
    if (place != as_given || turns || !loops.order.empty())
      ordered.push_back(in_order(scene, place, loops));
  }
  return ordered;
}

}  // namespace momenta
