#include <momenta/core/scene/near_name.h>
#include <momenta/dae/cut/cycles.h>
#include <momenta/dae/cut/recut.h>
#include <momenta/dae/cut/relative_motion.h>
#include <momenta/dae/kkt/filtered_factor.h>
#include <momenta/dae/kkt/kkt.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

namespace momenta {
namespace {

constexpr std::int64_t most_effort = 20'000'000;
constexpr int long_cycles = 30;  ///< joints on a cycle of a shallow tree, in the mean

std::optional<JointKind> as_joint(LoopKind kind, bool planar) {
  switch (kind) {
    case LoopKind::point:
    case LoopKind::spherical:
      return planar ? JointKind::revolute : JointKind::spherical;
    case LoopKind::revolute:
      return JointKind::revolute;
    case LoopKind::weld:
      return JointKind::weld;
    case LoopKind::prismatic:
      return JointKind::prismatic;
    case LoopKind::universal:
      return JointKind::universal;
    case LoopKind::cylindrical:
      return JointKind::cylindrical;
    case LoopKind::planar:
      return JointKind::planar;
    case LoopKind::distance:
    case LoopKind::coupler:
      break;
  }
  return std::nullopt;
}

std::optional<LoopKind> as_loop(JointKind kind) {
  switch (kind) {
    case JointKind::revolute:
      return LoopKind::revolute;
    case JointKind::prismatic:
      return LoopKind::prismatic;
    case JointKind::cylindrical:
      return LoopKind::cylindrical;
    case JointKind::universal:
      return LoopKind::universal;
    case JointKind::spherical:
      return LoopKind::spherical;
    case JointKind::planar:
      return LoopKind::planar;
    case JointKind::weld:
      return LoopKind::weld;
    case JointKind::helical:
    case JointKind::free:
    case JointKind::user:
      break;
  }
  return std::nullopt;
}

/// Equations of a loop of the kind a joint has.
int rows_of(JointKind kind, bool planar) {
  return (planar ? 3 : 6) - rates_of(kind);
}

/// What the author says of coordinates of joints, by name, and of loops.
struct Sayings {
  std::set<std::string> of_coordinates;  ///< these joints stay joints
  std::set<std::string> driven_loops;
  std::set<std::string> kept;

  Sayings(const Scene& scene, const std::vector<std::string>& keep)
      : kept(keep.begin(), keep.end()) {
    for (const JointSpec& joint : scene.joints)
      if (joint.stiffness != 0 || joint.damping != 0) of_coordinates.insert(joint.name);
    for (const DriveSpec& drive : scene.drives)
      (drive.joint.empty() ? driven_loops.insert(drive.loop) : of_coordinates.insert(drive.joint));
    for (const ForceSpec& force : scene.forces)
      if (force.kind == "torque") of_coordinates.insert(force.joint);
    for (const LoopSpec& loop : scene.loops)
      of_coordinates.insert(loop.joints.begin(), loop.joints.end());
    of_coordinates.insert(scene.held.begin(), scene.held.end());
    std::set<std::string> known;
    for (const JointSpec& joint : scene.joints) known.insert(joint.name);
    for (const LoopSpec& loop : scene.loops) known.insert(loop.name);
    for (const std::string& name : keep)
      if (!known.contains(name))
        throw SceneError(scene.where({}) + "joint or loop " + reading::in_quotes(name) +
                         ", to be kept, is not in the scene");
  }
};

/// The motion of bodies at the start, by their names.
class BodyMotions {
 public:
  BodyMotions(const Mechanism& mechanism, const Start& start) {
    Scene open = mechanism.scene();
    open.loops.clear();
    open.markers.clear();
    std::erase_if(open.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
    // Of four points of a body, one from its origin along each axis, velocities give v and ω.
    for (const BodySpec& body : open.bodies)
      for (int i = 0; i < 4; ++i) {
        MarkerSpec marker;
        marker.name = body.name + " " + std::to_string(i);
        marker.body = body.name;
        if (i < 3) marker.point[i] = 1;
        open.markers.push_back(marker);
      }
    const Mechanism tree(open);
    const auto poses = OpenChain(open).poses(start.t, start.q);
    const auto e = tree.evaluation<double>();
    e->place(start.t, start.q.data());
    e->move(start.u.data());
    std::vector<double> values(6 * open.markers.size());
    e->markers(values.data());
    motion_["ground"] = {};
    for (std::size_t i = 0; i < open.bodies.size(); ++i) {
      const std::string& name = open.bodies[i].name;
      const auto velocity = [&](std::size_t point) {
        const double* at = values.data() + 6 * (4 * i + point) + 3;
        return Eigen::Vector3d(at[0], at[1], at[2]);
      };
      BodyMotion m;
      m.pose = poses[static_cast<std::size_t>(mechanism.tree().body(name))];
      m.v = velocity(3);
      Eigen::Vector3d omega = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d axis = m.pose.linear().col(k);
        omega += 0.5 * axis.cross(Eigen::Vector3d(velocity(static_cast<std::size_t>(k)) - m.v));
      }
      m.omega = omega;
      motion_[name] = m;
    }
  }
  const BodyMotion& of(const std::string& body) const { return motion_.at(body); }

 private:
  std::unordered_map<std::string, BodyMotion> motion_;
};

/// The joint that a loop would be; nothing where it is none or its bodies do not stand like that.
std::optional<JointSpec> joint_of(const LoopSpec& loop, const Mechanism& mechanism,
                                  const BodyMotions& bodies, double length) {
  const auto kind = as_joint(loop.kind, mechanism.plan().planar);
  if (!kind) return std::nullopt;
  JointSpec joint;
  joint.name = loop.name;
  joint.kind = *kind;
  joint.parent = loop.parent;
  joint.child = loop.child;
  joint.origin_parent = loop.origin_parent;
  joint.origin_child = loop.origin_child;
  joint.rotation = loop.rotation;
  joint.axis = loop.axis;
  joint.axis2 = loop.axis2;
  joint.direction = loop.direction;
  const BodyMotion &parent = bodies.of(loop.parent), &child = bodies.of(loop.child);
  if (*kind == JointKind::revolute && loop.kind != LoopKind::revolute)
    joint.axis = (parent.pose.linear() * loop.rotation.toRotationMatrix()).transpose() *
                 mechanism.plan().basis.col(2);
  const JointMotion m = joint_motion(joint, parent, child);
  // A hinge closes with its axes reversed as well; across the plane of a planar mechanism points
  // may lie apart.
  if (m.tilt > 1e-8 || m.shift > 1e-8 * length) return std::nullopt;
  joint.position = m.q;
  joint.velocity = m.u;
  return joint;
}

LoopSpec loop_of(const JointSpec& joint) {
  LoopSpec loop;
  loop.name = joint.name;
  loop.kind = *as_loop(joint.kind);
  loop.parent = joint.parent;
  loop.child = joint.child;
  loop.origin_parent = joint.origin_parent;
  loop.origin_child = joint.origin_child;
  loop.rotation = joint.rotation;
  loop.axis = joint.axis;
  loop.axis2 = joint.axis2;
  loop.direction = joint.direction;
  return loop;
}

/// The joints of the scene with the q and u of the start.
std::vector<JointSpec> joints_at(const Mechanism& mechanism, const Start& start) {
  std::vector<JointSpec> joints = mechanism.scene().joints;
  std::unordered_map<std::string, JointSpec*> by_name;
  for (JointSpec& joint : joints) {
    by_name[joint.name] = &joint;
    const auto nq = static_cast<std::size_t>(coordinates_of(joint)),
               nv = static_cast<std::size_t>(rates_of(joint));
    if (joint.position.empty()) {
      joint.position.assign(nq, 0.0);
      if (joint.kind == JointKind::spherical || joint.kind == JointKind::free)
        joint.position[nq - 4] = 1;
    }
    if (joint.velocity.empty()) joint.velocity.assign(nv, 0.0);
  }
  for (const Tree::Body& b : mechanism.tree().bodies) {
    JointSpec& joint = *by_name.at(b.joint);
    const auto first = static_cast<std::size_t>(b.parts > 1 ? b.coordinate : 0);
    for (int i = 0; i < b.nq; ++i)
      joint.position[first + static_cast<std::size_t>(i)] = start.q[b.q + i];
    for (int i = 0; i < b.nv; ++i)
      joint.velocity[first + static_cast<std::size_t>(i)] = start.u[b.u + i];
  }
  return joints;
}

/// Turns a joint round, with what is said of its coordinates; false where that would mean others.
bool turn_round(JointSpec& joint, Scene& scene, const Sayings& said, const BodyMotions& bodies) {
  if (!keeps_coordinates(joint.kind)) {
    if (said.of_coordinates.contains(joint.name)) return false;
    joint = turned_round(joint);
    const JointMotion m = joint_motion(joint, bodies.of(joint.parent), bodies.of(joint.child));
    joint.position = m.q;
    joint.velocity = m.u;
    scene.remarks.push_back("joint '" + joint.name +
                            "' is counted from its other body: its coordinates mean others");
    return true;
  }
  joint = turned_round(joint);
  if (joint.kind != JointKind::universal) return true;
  for (DriveSpec& drive : scene.drives)
    if (drive.joint == joint.name) drive.coordinate = 1 - drive.coordinate;
  for (LoopSpec& loop : scene.loops)
    for (std::size_t i = 0; i < loop.joints.size(); ++i)
      if (loop.joints[i] == joint.name) {
        loop.coordinates.resize(loop.joints.size());
        loop.coordinates[i] = 1 - loop.coordinates[i];
      }
  scene.remarks.push_back("joint '" + joint.name +
                          "' is counted from its other body: its two angles have changed places");
  return true;
}

/// The graph of a scene: its joints, then its loops that tie two bodies.
class SceneGraph {
 public:
  SceneGraph(const Mechanism& mechanism, const Sayings& said)
      : scene_(mechanism.scene()), planar_(mechanism.plan().planar) {
    vertex_["ground"] = 0;
    for (const BodySpec& body : scene_.bodies)
      vertex_.emplace(body.name, static_cast<int>(vertex_.size()));
    for (const JointSpec& joint : scene_.joints) {
      CutEdge& e = add(joint.parent, joint.child, true);
      const auto loop = as_loop(joint.kind);
      e.rows = rows_of(joint.kind, planar_);
      e.fixed = !loop || said.of_coordinates.contains(joint.name) || said.kept.contains(joint.name);
    }
    for (const LoopSpec& loop : scene_.loops) {
      loop_at_.push_back(-1);
      if (loop.kind == LoopKind::coupler || loop.parent == loop.child) continue;
      loop_at_.back() = static_cast<int>(edges.size());
      CutEdge& e = add(loop.parent, loop.child, false);
      const auto joint = as_joint(loop.kind, planar_);
      e.rows = joint ? rows_of(*joint, planar_) : 1;
      e.fixed = !joint || said.driven_loops.contains(loop.name) || said.kept.contains(loop.name);
    }
  }
  int vertices() const { return static_cast<int>(vertex_.size()); }
  int vertex(const std::string& body) const { return vertex_.at(body); }
  /// Edge of a loop of the scene, −1 of a coupler.
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

/// The scene with the tree of `edges`. Returns `none`, or the edge of a loop that is no joint as
/// its bodies stand, or `no_way` where a joint cannot be turned as that needs.
int rebuild(const Mechanism& mechanism, const Start& start, const SceneGraph& graph,
            const std::vector<CutEdge>& edges, const Sayings& said, const BodyMotions& bodies,
            Recut& result) {
  const Scene& given = mechanism.scene();
  const double length = length_of(given);
  Scene& scene = result.scene;
  const std::vector<JointSpec> joints = joints_at(mechanism, start);
  std::vector<JointSpec> new_joints;  // of loops, each in the place of a joint that was cut
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
  const auto in_words = [](const std::vector<std::string>& names) {
    std::string words;
    for (const std::string& name : names) words += (words.empty() ? "'" : ", '") + name + "'";
    return words;
  };
  scene.remarks.push_back("cut anew: loops in place of joints " + in_words(result.cut) +
                          ", joints in place of loops " + in_words(result.joined));
  return none;
}

/// Less work; or entries of M saved at next to no work: loops that close at the ground count there
/// once more.
bool better(const CutCost& a, const CutCost& b) {
  constexpr int most = LoopPlan::most_lanes;
  if ((a.open > most) != (b.open > most)) return a.open <= most;
  // the bodies' own equations are the same whatever is cut
  if (a.open > most) return a.factor_entries > 0 && 100 * a.factor_entries < 90 * b.factor_entries;
  const bool less_work = 100 * a.work < 98 * b.work, hardly_more = 100 * a.work < 105 * b.work;
  return less_work || (hardly_more && 4 * a.mass_entries < 3 * b.mass_entries);
}

}  // namespace

CutCost cut_cost(const Mechanism& mechanism) {
  CutCost cost;
  const Tree& tree = mechanism.tree();
  std::vector<int> depth;
  for (const Tree::Body& b : tree.bodies) {
    depth.push_back(b.parent < 0 ? 1 : 1 + depth[static_cast<std::size_t>(b.parent)]);
    cost.depth = std::max(cost.depth, depth.back());
    cost.mass_entries += depth.back();
  }
  const auto plan = [&](const auto& model) {
    return swept_loops(model, build_loops(mechanism.scene(), tree, model)).plan;
  };
  if (mechanism.m() == 0) return cost;
  const LoopPlan loops =
      mechanism.plan().planar
          ? plan(build_planar_model(tree, mechanism.scene(), mechanism.plan().basis))
          : plan(build_spatial_model(tree, mechanism.scene()));
  cost.open = loops.lanes;
  cost.work = loops.work;
  if (mechanism.kkt() == KktChoice::sparse && filters_pivots(mechanism))
    cost.factor_entries = FilteredFactor(mechanism).entries();
  return cost;
}

Recut recut(const Mechanism& mechanism, const Start& start, const std::vector<std::string>& keep) {
  const Sayings said(mechanism.scene(), keep);
  Recut best;
  best.scene = mechanism.scene();
  best.before = best.after = cut_cost(mechanism);
  if (mechanism.m() == 0) return best;
  SceneGraph graph(mechanism, said);
  std::optional<BodyMotions> bodies;
  // Loops found to be no joints as their bodies stand are fixed, and the search is made once more.
  constexpr int most_searches = 50;
  int searches = 0;
  for (const bool shallow : {false, true})
    for (int obstacle = 0; obstacle >= 0 && searches < most_searches; ++searches) {
      std::vector<CutEdge> first = graph.edges;
      if (shallow) {
        first = shallow_tree(graph.vertices(), first);
        const auto most = std::max(length_of_cycles(graph.vertices(), graph.edges, most_effort),
                                   long_cycles * static_cast<std::int64_t>(first.size()));
        if (length_of_cycles(graph.vertices(), first, most) > most) break;
      }
      Cycles cycles(graph.vertices(), std::move(first));
      cycles.balance(cycles.descend(most_effort));
      if (cycles.edges() == graph.edges) break;
      if (!bodies) bodies.emplace(mechanism, start);
      Recut found;
      found.before = best.before;
      found.scene = mechanism.scene();
      obstacle = rebuild(mechanism, start, graph, cycles.edges(), said, *bodies, found);
      if (obstacle >= 0) graph.edges[static_cast<std::size_t>(obstacle)].fixed = true;
      if (obstacle != none) continue;
      const Mechanism anew(found.scene);
      found.after = cut_cost(anew);
      const bool as_well_carried = anew.kkt() == mechanism.kkt() || anew.kkt() == KktChoice::sweeps;
      if (as_well_carried && better(found.after, best.after)) best = std::move(found);
    }
  return best;
}

}  // namespace momenta
