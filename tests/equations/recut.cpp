#include "equations/recut.h"

#include "equations/dense_lagrangian.h"
#include "equations/parts.h"

#include <algorithm>
#include <map>
#include <set>

namespace momenta::equations {

JointSpec other_way_round(const JointSpec& j) {
  JointSpec r = j;
  std::swap(r.parent, r.child);
  std::swap(r.origin_parent, r.origin_child);
  r.rotation = j.rotation.conjugate();
  r.axis = -(j.rotation * j.axis);
  return r;
}

Scene recut(const Scene& scene, const Tree& tree, const Eigen::VectorXd& q, const std::string& cut,
            const std::string& closed) {
  const auto poses = DenseLagrangian(scene, tree).poses(0, q);
  std::map<std::string, Eigen::Quaterniond> axes{{"ground", Eigen::Quaterniond::Identity()}};
  for (std::size_t k = 0; k < poses.size(); ++k)
    axes[scene.bodies[k].name] = Eigen::Quaterniond(poses[k].linear());

  Scene s = scene;
  s.joints.clear();
  s.loops.clear();
  std::vector<JointSpec> edges;
  for (const LoopSpec& l : scene.loops) {
    if (l.name != closed) {
      s.loops.push_back(l);
      continue;
    }
    JointSpec j =
        make_joint(JointKind::revolute, l.name, l.parent, l.child, l.origin_parent, l.axis);
    j.origin_child = l.origin_child;
    j.rotation = l.rotation;
    edges.push_back(j);
  }
  for (const JointSpec& j : scene.joints) {
    if (j.name != cut) {
      edges.push_back(j);
      continue;
    }
    LoopSpec l =
        make_loop(LoopKind::revolute, j.name, j.parent, j.child, j.origin_parent, j.origin_child);
    l.rotation = j.rotation;
    l.axis = j.axis;
    s.loops.push_back(l);
    for (DriveSpec& drive : s.drives)
      if (drive.joint == cut) std::swap(drive.joint, drive.loop);
  }
  std::set<std::string> reached{"ground"};
  while (!edges.empty()) {
    const auto next = std::find_if(edges.begin(), edges.end(), [&](const JointSpec& j) {
      return reached.contains(j.parent) || reached.contains(j.child);
    });
    if (next == edges.end()) break;
    JointSpec j = reached.contains(next->parent) ? *next : other_way_round(*next);
    edges.erase(next);
    const Eigen::AngleAxisd turn((axes[j.parent] * j.rotation).conjugate() * axes[j.child]);
    j.position = {turn.angle() * (turn.axis().dot(j.axis) < 0 ? -1 : 1)};
    reached.insert(j.child);
    s.joints.push_back(j);
  }
  s.held.clear();
  return s;
}

}  // namespace momenta::equations
