#include <momenta/dae/cut/interchange.h>
#include <momenta/dae/cut/root_order.h>

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
    ties_.resize(count_);
    for (const LoopSpec& loop : scene.loops) {
      const std::vector<std::size_t> tied = of(loop);
      for (std::size_t i = 1; i < tied.size(); ++i)
        if (tied[i] != tied[0]) {
          ties_[tied[0]].push_back(tied[i]);
          ties_[tied[i]].push_back(tied[0]);
        }
    }
    for (auto& list : ties_) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }
  }

  std::size_t count() const { return count_; }
  const std::vector<std::size_t>& ties(std::size_t tree) const { return ties_[tree]; }

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

  /// All that is tied to `first`, breadth first, of few ties first.
  std::vector<std::size_t> breadth_first(std::size_t first) const {
    std::vector<char> seen(count_, 0);
    std::vector<std::size_t> reached{first};
    seen[first] = 1;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      std::vector<std::size_t> next;
      for (const std::size_t tree : ties(reached[i]))
        if (!seen[tree]) next.push_back(tree);
      std::stable_sort(next.begin(), next.end(), [&](std::size_t a, std::size_t b) {
        return ties(a).size() < ties(b).size();
      });
      for (const std::size_t tree : next) seen[tree] = 1;
      reached.insert(reached.end(), next.begin(), next.end());
    }
    return reached;
  }

 private:
  std::unordered_map<std::string, std::size_t> of_body_, of_joint_;
  std::vector<std::vector<std::size_t>> ties_;
  std::size_t count_ = 0;
};

bool driven(const Scene& scene, const std::string& loop) {
  return std::any_of(scene.drives.begin(), scene.drives.end(),
                     [&](const DriveSpec& drive) { return drive.loop == loop; });
}

/// The place of each tree.
std::vector<std::size_t> places(const Trees& trees, RootOrder order) {
  std::vector<std::size_t> place(trees.count());
  std::vector<char> placed(trees.count(), 0);
  std::size_t next = 0;
  for (std::size_t tree = 0; tree < trees.count(); ++tree) {
    if (placed[tree]) continue;
    std::vector<std::size_t> all = trees.breadth_first(tree);
    if (order == RootOrder::from_an_end)
      all = trees.breadth_first(trees.breadth_first(all.back()).back());
    else
      all = trees.breadth_first(
          *std::max_element(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
            return trees.ties(a).size() < trees.ties(b).size();
          }));
    for (const std::size_t one : all) {
      placed[one] = 1;
      place[one] = next++;
    }
  }
  return place;
}

}  // namespace

Scene with_roots_ordered(const Scene& scene, RootOrder order) {
  const Trees trees(scene);
  const std::vector<std::size_t> place = places(trees, order);
  Scene ordered = scene;
  std::vector<const JointSpec*> roots(trees.count());
  std::size_t tree = 0;
  for (const JointSpec& joint : scene.joints)
    if (joint.parent == "ground") roots[place[tree++]] = &joint;
  tree = 0;
  for (JointSpec& joint : ordered.joints)
    if (joint.parent == "ground") joint = *roots[tree++];
  const auto first = [&](const LoopSpec& loop) {
    std::size_t least = trees.count();
    for (const std::size_t one : trees.of(loop)) least = std::min(least, place[one]);
    return least;
  };
  // Branches of one shape go side by side if their loops are written alike.
  for (LoopSpec& loop : ordered.loops) {
    const std::vector<std::size_t> tied = trees.of(loop);
    if (can_turn_round(loop) && tied.size() == 2 && place[tied[1]] < place[tied[0]] &&
        !driven(scene, loop.name))
      loop = turned_round(loop);
  }
  std::vector<std::pair<std::size_t, std::size_t>> by_place;  // and place in the scene
  for (const LoopSpec& loop : ordered.loops) by_place.emplace_back(first(loop), by_place.size());
  if (std::is_sorted(by_place.begin(), by_place.end())) return ordered;
  std::sort(by_place.begin(), by_place.end());
  std::vector<LoopSpec> loops;
  loops.reserve(by_place.size());
  for (const auto& [place_of, i] : by_place) loops.push_back(std::move(ordered.loops[i]));
  ordered.loops = std::move(loops);
  return ordered;
}

}  // namespace momenta
