#include <momenta/core/text/quoting.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/topology/cut/cycles.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/recut.h>
#include <momenta/dae/topology/cut/tree_order.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

namespace momenta {
namespace {

constexpr std::int64_t most_effort = 20'000'000;
constexpr int long_cycles = 30;  ///< joints on a cycle of another tree than given, in the mean

/// The graph of a scene: its joints, then its loops that tie two bodies.
class SceneGraph {
 public:
  SceneGraph(const Mechanism& mechanism, const RecutRestrictions& said)
      : scene_(mechanism.scene()), planar_(mechanism.plan().planar) {
    vertex_["ground"] = 0;
    for (const BodySpec& body : scene_.bodies)
      vertex_.emplace(body.name, static_cast<int>(vertex_.size()));
    for (const JointSpec& joint : scene_.joints) {
      CutEdge& e = add(joint.parent, joint.child, true);
      const auto loop = as_loop(joint.kind, planar_);
      e.rows = rows_of(joint.kind, planar_);
      e.fixed = !loop || said.of_coordinates.contains(joint.name) || said.kept.contains(joint.name);
    }
    for (const LoopSpec& loop : scene_.loops) {
      loop_at_.push_back(-1);
      if (!ties_bodies(loop) || loop.parent == loop.child) continue;
      loop_at_.back() = static_cast<int>(edges.size());
      CutEdge& e = add(loop.parent, loop.child, false);
      const auto joint = as_joint(loop.kind, planar_);
      e.rows = joint                                     ? rows_of(*joint, planar_)
               : loop.kind == LoopKind::rolling          ? 3
               : loop.kind == LoopKind::slot && !planar_ ? 2
                                                         : 1;
      e.fixed = !joint || said.driven_loops.contains(loop.name) || said.kept.contains(loop.name);
    }
  }
  int vertices() const { return static_cast<int>(vertex_.size()); }
  int vertex(const std::string& body) const { return vertex_.at(body); }
  /// Edge of a loop of the scene; −1: it ties no two bodies.
  int loop(std::size_t i) const { return loop_at_[i]; }

  std::vector<CutEdge> edges;

 private:
  CutEdge& add(const std::string& a, const std::string& b, bool in_tree) {
    edges.push_back({vertex_.at(a), vertex_.at(b), 0, in_tree, false});
    return edges.back();
  }
  const Scene& scene_;
  bool planar_;
  std::unordered_map<std::string, int> vertex_;
  std::vector<int> loop_at_;
};

constexpr int none = -1, no_way = -2;

/// Sets `result` to the scene with the tree of `edges`. Returns `none`, or the edge of a loop that
/// is no joint as its bodies stand, or `no_way` where a joint cannot be turned round.
int rebuild(const Mechanism& mechanism, const Start& start, const SceneGraph& graph,
            const std::vector<CutEdge>& edges, const RecutRestrictions& said,
            const BodyMotions& bodies, Recut& result) {
  const Scene& given = mechanism.scene();
  const double length = length_of(given);
  Scene& scene = result.scene;
  const std::vector<JointSpec> joints = joints_at(mechanism, start);
  std::vector<JointSpec> new_joints;  // from loops, each in the place of a cut joint
  std::vector<LoopSpec> new_loops;
  for (std::size_t i = 0; i < given.loops.size(); ++i)
    if (graph.loop(i) >= 0 && edges[static_cast<std::size_t>(graph.loop(i))].in_tree) {
      const auto joint = joint_of(given.loops[i], mechanism, bodies, length);
      if (!joint) return graph.loop(i);
      new_joints.push_back(*joint);
      result.joined.push_back(joint->name);
    }
  scene.joints.clear();
  std::size_t taken = 0;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (edges[i].in_tree) {
      scene.joints.push_back(joints[i]);
      continue;
    }
    new_loops.push_back(loop_of(joints[i]));
    result.cut.push_back(joints[i].name);
    scene.joints.push_back(new_joints[taken++]);
  }
  taken = 0;
  for (std::size_t i = 0; i < given.loops.size(); ++i)
    if (graph.loop(i) >= 0 && edges[static_cast<std::size_t>(graph.loop(i))].in_tree)
      scene.loops[i] = new_loops[taken++];

  // joints point away from the ground
  std::vector<std::vector<std::size_t>> beside(static_cast<std::size_t>(graph.vertices()));
  const auto vertex = [&](const std::string& body) {
    return static_cast<std::size_t>(graph.vertex(body));
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    beside[vertex(scene.joints[i].parent)].push_back(i);
    beside[vertex(scene.joints[i].child)].push_back(i);
  }
  std::vector<std::size_t> reached{0};
  std::vector<char> seen(beside.size());
  seen[0] = 1;
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::size_t k : beside[reached[i]]) {
      JointSpec& joint = scene.joints[k];
      const bool away = vertex(joint.parent) == reached[i];
      const std::size_t next = vertex(away ? joint.child : joint.parent);
      if (seen[next]) continue;
      seen[next] = 1;
      reached.push_back(next);
      if (!away && !turn_round(joint, scene, said, bodies)) return no_way;
    }
  scene.remarks.push_back("cut anew: loops in place of joints " +
                          reading::all_in_quotes(result.cut) + ", joints in place of loops " +
                          reading::all_in_quotes(result.joined));
  return none;
}

/// Takes the best of the scenes that enter, each with its trees on the ground in three orders, and
/// with children in two.
class Contest {
 public:
  /// `edges`: the tree of the given scene.
  Contest(const Mechanism& given, const std::vector<CutEdge>& edges, Recut& best)
      : given_(given),
        swept_(given.solver().kkt() == KktChoice::sweeps),
        best_(best),
        best_edges_(edges) {}

  /// Enters a scene; returns whether the sweeps carry its loops. `edges`: its tree, which enters
  /// once.
  bool enter(Recut found, const std::vector<CutEdge>& edges) {
    const int before = changes_;
    const bool swept = enter_in_every_order(std::move(found));
    if (changes_ != before) best_edges_ = edges;
    entered_.push_back({edges, swept});
    return swept;
  }
  /// Number of times that the best changed.
  int changes() const { return changes_; }
  /// Whether the sweeps carry the loops of a tree that has entered.
  std::optional<bool> entered(const std::vector<CutEdge>& edges) const {
    const auto found = std::find_if(entered_.begin(), entered_.end(),
                                    [&](const Entered& e) { return e.edges == edges; });
    return found == entered_.end() ? std::nullopt : std::optional(found->swept);
  }
  /// Tree of the best scene.
  const std::vector<CutEdge>& edges() const { return best_edges_; }

 private:
  /// Enters orders of least cost first: those after one that is swept are no better.
  bool enter_in_every_order(Recut found) {
    struct Entry {
      Scene scene;
      bool reordered, children_reordered;
      CutCost cost;
    };
    std::vector<Entry> entries;
    // In a plane loops close in the bodies' own fronts: no order of children has fewer lanes there.
    std::optional<Scene> arranged;
    if (!given_.plan().planar) arranged = with_children_ordered(found.scene);
    const bool children = arranged.has_value();
    std::vector<Scene> others = with_roots_ordered(children ? *arranged : found.scene);
    if (found.gains()) entries.push_back({std::move(found.scene), false, false, {}});
    if (children) entries.push_back({std::move(*arranged), false, true, {}});
    for (Scene& other : others) entries.push_back({std::move(other), true, children, {}});
    for (Entry& entry : entries) entry.cost = swept_cost(entry.scene, given_.plan());
    const auto rank = [](const Entry& entry) {
      return std::pair(entry.cost.open > LoopPlan::most_slots, entry.cost.sweeps);
    };
    std::stable_sort(entries.begin(), entries.end(),
                     [&](const Entry& x, const Entry& y) { return rank(x) < rank(y); });
    bool now_swept = !found.gains() && swept_;  // the given scene
    found.scene = {};
    for (Entry& entry : entries) {
      // most entries are no better, as their cost alone tells
      bool swept =
          swept_ && entry.cost.open <= LoopPlan::most_slots && !better(entry.cost, best_.after);
      if (!swept) {
        Recut one = found;
        one.scene = std::move(entry.scene);
        one.reordered = entry.reordered;
        one.children_reordered = entry.children_reordered;
        swept = enter_one(std::move(one), entry.cost);
      }
      now_swept |= swept;
      if (swept) break;
    }
    return now_swept;
  }
  bool enter_one(Recut found, const CutCost& cost) {
    found.mechanism =
        std::make_shared<const Mechanism>(found.scene, MechanismOptions{given_.options().algebra});
    const bool now_swept = found.mechanism->solver().kkt() == KktChoice::sweeps;
    found.after = now_swept ? cost : cut_cost(*found.mechanism);
    if ((now_swept && !swept_) || (now_swept == swept_ && better(found.after, best_.after))) {
      best_ = std::move(found);
      swept_ = now_swept;
      ++changes_;
    }
    return now_swept;
  }

  struct Entered {
    std::vector<CutEdge> edges;
    bool swept;
  };

  const Mechanism& given_;
  bool swept_;
  Recut& best_;
  std::vector<CutEdge> best_edges_;
  int changes_ = 0;
  std::vector<Entered> entered_;
};

/// J ignores lanes. For small mechanisms the trees one exchange away from the best enter too, where
/// the open equations might fit fewer lanes; a tree enters once, so that this ends. `rebuilt`:
/// rebuild() of a tree's edges.
template <class Rebuilt>
void try_neighbours(const SceneGraph& graph, bool planar, Rebuilt&& rebuilt, Contest& contest,
                    const Recut& best) {
  constexpr int most_bodies = 30, most_tried = 700;  // most_tried: trees times bodies
  if (graph.vertices() > most_bodies) return;
  int tried = 0;
  const auto one_better = [&] {
    const std::vector<CutEdge> from = contest.edges();  // a copy: the best may change below
    const Cycles around(graph.vertices(), from);
    for (std::size_t e = 0; e < from.size(); ++e) {
      if (from[e].in_tree || from[e].fixed) continue;
      for (const int f : around.cycle(static_cast<int>(e))) {
        if ((tried += graph.vertices()) > most_tried) return false;
        if (from[static_cast<std::size_t>(f)].fixed) continue;
        std::vector<CutEdge> edges = from;
        edges[e].in_tree = true;
        edges[static_cast<std::size_t>(f)].in_tree = false;
        Recut found;
        if (edges == graph.edges || contest.entered(edges) || rebuilt(edges, found) != none)
          continue;
        const int before = contest.changes();
        contest.enter(std::move(found), edges);
        if (contest.changes() != before) return true;
      }
    }
    return false;
  };
  while (best.after.open <= LoopPlan::most_slots &&
         lanes_for(best.after.open, planar) > lanes_for(1, planar) && one_better())
    continue;
}

}  // namespace

std::string in_words(const Recut& recut) {
  constexpr std::size_t most_named = 4;
  if (!recut.gains()) return "";
  if (recut.cut.empty())
    return !recut.children_reordered ? "trees on the ground in another order"
           : !recut.reordered        ? "children of bodies in another order"
                                     : "trees on the ground and children in another order";
  return "cut at " + reading::all_in_quotes(recut.cut, most_named) + ", with " +
         reading::all_in_quotes(recut.joined, most_named) + " in the tree";
}

Recut recut(const Mechanism& mechanism, const Start& start, const std::vector<std::string>& keep) {
  const RecutRestrictions said(mechanism.scene(), keep);
  Recut best;
  best.scene = mechanism.scene();
  best.before = best.after = cut_cost(mechanism);
  if (mechanism.m() == 0) return best;
  SceneGraph graph(mechanism, said);
  std::optional<BodyMotions> bodies;
  // Loops found to be no joints as their bodies stand are fixed, and the search is made once more.
  constexpr int most_searches = 50;
  int searches = 0;
  Contest contest(mechanism, graph.edges, best);
  contest.enter(Recut(best), graph.edges);
  const auto rebuilt = [&](const std::vector<CutEdge>& edges, Recut& found) {
    if (!bodies) bodies.emplace(mechanism, start);
    found.before = best.before;
    found.scene = mechanism.scene();
    return rebuild(mechanism, start, graph, edges, said, *bodies, found);
  };
  enum class From { scene, shallow, deep };
  for (const From from : {From::scene, From::shallow, From::deep})
    for (int obstacle = 0; obstacle >= 0 && searches < most_searches; ++searches) {
      std::vector<CutEdge> first = graph.edges;
      if (from != From::scene) {
        first = from == From::shallow ? shallow_tree(graph.vertices(), graph.edges)
                                      : deep_tree(graph.vertices(), graph.edges);
        const auto most = std::max(length_of_cycles(graph.vertices(), graph.edges, most_effort),
                                   long_cycles * static_cast<std::int64_t>(first.size()));
        if (length_of_cycles(graph.vertices(), first, most) > most) break;
      }
      Cycles cycles(graph.vertices(), std::move(first));
      const std::int64_t left = cycles.descend(most_effort);
      const std::vector<CutEdge> lowered = cycles.edges();
      cycles.balance(left);
      // Joints of a balanced tree may be too light for the sweeps.
      obstacle = none;
      for (const auto& edges : {cycles.edges(), lowered}) {
        if (edges == graph.edges) continue;
        std::optional<bool> now_swept = contest.entered(edges);
        if (!now_swept) {
          Recut found;
          obstacle = rebuilt(edges, found);
          if (obstacle >= 0) graph.edges[static_cast<std::size_t>(obstacle)].fixed = true;
          if (obstacle != none) break;
          now_swept = contest.enter(std::move(found), edges);
        }
        if (*now_swept || cycles.edges() == lowered) break;
      }
    }
  try_neighbours(graph, mechanism.plan().planar, rebuilt, contest, best);
  return best;
}

}  // namespace momenta
