#include <momenta/dae/cut/interchange.h>
#include <momenta/dae/cut/root_order.h>
#include <momenta/dae/cut/tie_graph.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace momenta {
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
    if (loops.turned[i]) ordered.loops[i] = turned_round(scene.loops[i]);
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
