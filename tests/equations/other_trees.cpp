#include "equations/other_trees.h"

#include <momenta/dae/analysis/linear/pose_motion.h>
#include <momenta/dae/study/extremes.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/interchange.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <array>
#include <map>
#include <set>

namespace momenta::equations {
namespace {

Start start_of_scene(const Mechanism& mechanism) {
  Start start;
  start.q = mechanism.tree().q0;
  start.u = mechanism.tree().u0;
  return start;
}

/// Turns joints to point away from the ground; false where one cannot be.
bool point_away(Scene& scene, const RecutRestrictions& said, const BodyMotions& bodies) {
  std::set<std::string> reached{"ground"};
  std::vector<JointSpec> rest = scene.joints;
  while (!rest.empty()) {
    const auto next = std::find_if(rest.begin(), rest.end(), [&](const JointSpec& j) {
      return reached.contains(j.parent) || reached.contains(j.child);
    });
    if (next == rest.end()) return false;
    JointSpec& joint = *std::find_if(scene.joints.begin(), scene.joints.end(),
                                     [&](const JointSpec& j) { return j.name == next->name; });
    rest.erase(next);
    if (!reached.contains(joint.parent) && !turn_round(joint, scene, said, bodies)) return false;
    reached.insert(joint.child);
  }
  return true;
}

/// Vertices of a graph in groups: which are joined already.
class Groups {
 public:
  /// False where they were joined before.
  bool join(const std::string& a, const std::string& b) {
    const std::string of_a = group(a), of_b = group(b);
    if (of_a == of_b) return false;
    above_[of_a] = of_b;
    return true;
  }

 private:
  std::string group(const std::string& v) const {
    const auto at = above_.find(v);
    return at == above_.end() ? v : group(at->second);
  }
  std::map<std::string, std::string> above_;
};

void turn_room(RandomTree& random, Description& d) {
  for (const DriveSpec& drive : d.scene.drives)
    if (!drive.origin.empty()) return;
  const Eigen::Quaterniond turn = random.turn();
  d.scene = turned(d.scene, turn);
  d.room = turn * d.room;
}

struct Way {
  const char* name;
  void (*write)(RandomTree&, Description&);
};
template <void (*change)(RandomTree&, Scene&)>
void of_scene(RandomTree& random, Description& d) {
  change(random, d.scene);
}
constexpr std::array ways{
    Way{"permuted", of_scene<permute>},
    Way{"other frames", of_scene<move_frames>},
    Way{"axes flipped", of_scene<flip_axes>},
    Way{"loops turned round", of_scene<turn_loops_round>},
    Way{"bodies split", of_scene<split_bodies>},
    Way{"a base", of_scene<add_base>},
    Way{"rotors as wheels", of_scene<turn_rotors_into_wheels>},
    Way{"gears rewritten", of_scene<rewrite_gears>},
    Way{"cut elsewhere", of_scene<cut_elsewhere>},
    Way{"rooted elsewhere", of_scene<root_elsewhere>},
    Way{"room turned", turn_room},
};

void apply(const Way& way, RandomTree& random, Description& d) {
  way.write(random, d);
  d.how += (d.how.empty() ? "" : ", ") + std::string(way.name);
}

}  // namespace

Scene at_start(const Scene& scene) {
  const Mechanism mechanism(scene);
  Start start = assemble(mechanism, Assembled::rates).start;
  PoseMotion poses(mechanism);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(mechanism.nv());
  Eigen::VectorXd q = start.q;
  if (mechanism.m() > 0 && poses.move(start.t, start.q, rest, q)) start.q = q;
  start.u = assemble(mechanism, start.t, start.q, start.u, Assembled::rates).start.u;
  Scene s = scene;
  s.joints = joints_at(mechanism, start);
  return s;
}

void cut_elsewhere(RandomTree& random, Scene& scene) {
  const Mechanism mechanism(scene);
  const Start start = start_of_scene(mechanism);
  const RecutRestrictions said(scene, {});
  const BodyMotions bodies(mechanism, start);
  const double length = length_of(scene);
  struct Edge {
    JointSpec joint;
    std::optional<LoopSpec> loop;  ///< none of a joint that stays one
  };
  std::vector<Edge> edges;
  Scene anew = scene;
  anew.joints.clear();
  anew.loops.clear();
  Groups groups;
  for (const JointSpec& joint : joints_at(mechanism, start)) {
    if (as_loop(joint.kind, mechanism.plan().planar) && !said.of_coordinates.contains(joint.name)) {
      edges.push_back({joint, loop_of(joint)});
      continue;
    }
    groups.join(joint.parent, joint.child);
    anew.joints.push_back(joint);
  }
  for (const LoopSpec& loop : scene.loops) {
    std::optional<JointSpec> joint;
    if (loop.kind != LoopKind::coupler && !said.driven_loops.contains(loop.name))
      joint = joint_of(loop, mechanism, bodies, length);
    if (joint)
      edges.push_back({*joint, loop});
    else
      anew.loops.push_back(loop);
  }
  while (!edges.empty()) {
    const auto any = edges.begin() + random.below(static_cast<int>(edges.size()));
    if (groups.join(any->joint.parent, any->joint.child))
      anew.joints.push_back(any->joint);
    else
      anew.loops.push_back(*any->loop);
    edges.erase(any);
  }
  if (!point_away(anew, said, bodies)) return;
  anew.remarks = scene.remarks;
  scene = std::move(anew);
}

void root_elsewhere(RandomTree& random, Scene& scene) {
  const Mechanism mechanism(scene);
  const RecutRestrictions said(scene, {});
  const BodyMotions bodies(mechanism, start_of_scene(mechanism));
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const JointSpec& flying = scene.joints[i];
    if (flying.kind != JointKind::free || said.of_coordinates.contains(flying.name)) continue;
    std::set<std::string> carried{flying.child};
    for (std::size_t found = 0; found != carried.size();) {
      found = carried.size();
      for (const JointSpec& j : scene.joints)
        if (carried.contains(j.parent)) carried.insert(j.child);
    }
    Scene anew = scene;
    JointSpec& joint = anew.joints[i];
    joint.child = *std::next(carried.begin(), random.below(static_cast<int>(carried.size())));
    joint.origin_child = random.vector(0.5);
    const JointMotion m = joint_motion(joint, bodies.of(joint.parent), bodies.of(joint.child));
    joint.position = m.q;
    joint.velocity = m.u;
    if (!point_away(anew, said, bodies)) continue;
    anew.remarks = scene.remarks;
    scene = std::move(anew);
  }
}

int ways_of_writing() {
  return static_cast<int>(ways.size());
}

const char* name_of_way(int way) {
  return ways.at(static_cast<std::size_t>(way)).name;
}

Description description(const Scene& scene, int way, unsigned seed) {
  RandomTree random(seed);
  Description d;
  d.scene = scene;
  apply(ways.at(static_cast<std::size_t>(way)), random, d);
  return d;
}

Description description(const Scene& scene, unsigned seed) {
  RandomTree random(seed);
  Description d;
  d.scene = scene;
  std::vector<const Way*> left;
  for (const Way& way : ways) left.push_back(&way);
  while (!left.empty()) {
    const auto any = left.begin() + random.below(static_cast<int>(left.size()));
    if (random.chance(0.6)) apply(**any, random, d);
    left.erase(any);
  }
  return d;
}

}  // namespace momenta::equations
