#include <momenta/core/scene/read_scene.h>
#include <momenta/core/tree/tree.h>

#include <map>

namespace momenta {
namespace {

/// A rotation that takes z to `axis` a: with z × a = (−a_y, a_x, 0) = k,
///   R = 1 + k~ + k~² / (1 + a_z).
/// Where a_z < 0 the sum 1 + a_z cancels: there the half turn about x is taken out first. The
/// identity when the axis is z already, so that planar scenes keep clean numbers.
Eigen::Matrix3d frame_with_z(const Eigen::Vector3d& axis) {
  Eigen::Vector3d a = axis.normalized();
  const bool flipped = a.z() < 0;
  if (flipped) a = {a.x(), -a.y(), -a.z()};
  const double x = a.x(), y = a.y(), s = 1 / (1 + a.z());
  Eigen::Matrix3d r;
  r << 1 - s * x * x, -s * x * y, x, -s * x * y, 1 - s * y * y, y, -x, -y, a.z();
  if (flipped) r.bottomRows<2>() = -r.bottomRows<2>();
  return r;
}

Eigen::Isometry3d isometry(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
  t.linear() = rotation;
  t.translation() = translation;
  return t;
}

/// Start values of one joint appended to q0 and u0; a quaternion without a start is the identity.
void append_start(const JointSpec& joint, const Tree::Body& body, Tree& tree) {
  for (int i = 0; i < body.nq; ++i) {
    const bool unit =
        (body.kind == JointKind::spherical && i == 0) || (body.kind == JointKind::free && i == 3);
    tree.q0[body.q + i] =
        joint.position.empty() ? (unit ? 1.0 : 0.0) : joint.position[static_cast<std::size_t>(i)];
  }
  for (int i = 0; i < body.nv; ++i)
    tree.u0[body.u + i] =
        joint.velocity.empty() ? 0.0 : joint.velocity[static_cast<std::size_t>(i)];
}

class TreeBuilder {
 public:
  explicit TreeBuilder(const Scene& scene) : scene_(scene) {
    for (const auto& body : scene.bodies) bodies_[body.name] = &body;
    for (const auto& joint : scene.joints) children_[joint.parent].push_back(&joint);
    tree_.name = scene.name;
    tree_.gravity = scene.gravity;
  }

  Tree build() {
    // Depth first with an explicit stack: chains of 100 000 bodies must not exhaust the call stack.
    struct Pending {
      const JointSpec* joint;
      int parent;
    };
    std::vector<Pending> stack;
    const auto push_children = [&](const std::string& body, int index) {
      const auto found = children_.find(body);
      if (found == children_.end()) return;
      for (auto it = found->second.rbegin(); it != found->second.rend(); ++it)
        stack.push_back({*it, index});
    };
    push_children("ground", -1);
    while (!stack.empty()) {
      const Pending next = stack.back();
      stack.pop_back();
      const int index = add(*next.joint, next.parent);
      push_children(next.joint->child, index);
    }
    tree_.q0.resize(tree_.nq);
    tree_.u0.resize(tree_.nv);
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k)
      append_start(*joints_[k], tree_.bodies[k], tree_);
    for (const auto& force : scene_.forces)
      if (force.kind == "torque")
        tree_.bodies[static_cast<std::size_t>(tree_.carried_by(force.joint))].torque += force.value;
    return std::move(tree_);
  }

 private:
  int add(const JointSpec& joint, int parent) {
    const BodySpec& spec = *bodies_.at(joint.child);
    Tree::Body b;
    b.name = spec.name;
    b.joint = joint.name;
    b.parent = parent;
    b.kind = joint.kind;
    b.nq = coordinates_of(joint.kind);
    b.nv = rates_of(joint.kind);
    for (const auto& drive : scene_.drives)
      if (drive.joint == joint.name) {
        b.drive = static_cast<int>(tree_.drives.size());
        tree_.drives.emplace_back(drive);
        refuse_forces(joint);
        b.nq = b.nv = 0;
      }
    b.q = tree_.nq;
    b.u = tree_.nv;
    tree_.nq += b.nq;
    tree_.nv += b.nv;

    const bool has_axis = joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
    const Eigen::Matrix3d z_along_axis =
        has_axis ? frame_with_z(joint.axis) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
    const Eigen::Isometry3d parent_axes =
        parent < 0 ? Eigen::Isometry3d::Identity()
                   : tree_.bodies[static_cast<std::size_t>(parent)].scene_axes;
    b.placement =
        parent_axes * isometry(joint.rotation.normalized().toRotationMatrix() * z_along_axis,
                               joint.origin_parent);
    b.scene_axes = isometry(z_along_axis, joint.origin_child).inverse();
    b.mass = spec.mass;
    b.com = b.scene_axes * spec.com;
    b.inertia = b.scene_axes.linear() * spec.inertia * b.scene_axes.linear().transpose();
    b.stiffness = joint.stiffness;
    b.rest = joint.rest;
    b.damping = joint.damping;
    tree_.bodies.push_back(std::move(b));
    joints_.push_back(&joint);
    return static_cast<int>(tree_.bodies.size()) - 1;
  }

  /// A driven joint moves as it is told; a force along it would change nothing but the drive.
  void refuse_forces(const JointSpec& joint) const {
    bool forced = joint.stiffness != 0 || joint.damping != 0;
    for (const auto& force : scene_.forces)
      forced |= force.kind == "torque" && force.joint == joint.name;
    if (forced)
      throw SceneError(
          scene_.where(joint.at) + "joint '" + joint.name +
          "' is driven, so a spring, damper or torque on it has no effect; expected none");
  }

  const Scene& scene_;
  Tree tree_;
  std::map<std::string, const BodySpec*> bodies_;
  std::map<std::string, std::vector<const JointSpec*>> children_;
  std::vector<const JointSpec*> joints_;
};

}  // namespace

Tree build_tree(const Scene& scene) {
  validate(scene);
  return TreeBuilder(scene).build();
}

int Tree::body(const std::string& scene_name) const {
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (bodies[k].name == scene_name) return static_cast<int>(k);
  return -1;
}

int Tree::carried_by(const std::string& joint_name) const {
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (bodies[k].joint == joint_name) return static_cast<int>(k);
  return -1;
}

std::vector<Eigen::Isometry3d> Tree::zero_poses() const {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(bodies.size());
  for (const Body& b : bodies)
    poses.push_back(b.parent < 0 ? b.placement
                                 : poses[static_cast<std::size_t>(b.parent)] * b.placement);
  return poses;
}

Eigen::Vector3d Tree::point(int body, const Eigen::Vector3d& scene_point) const {
  return body < 0
             ? scene_point
             : Eigen::Vector3d(bodies[static_cast<std::size_t>(body)].scene_axes * scene_point);
}

Eigen::Vector3d Tree::direction(int body, const Eigen::Vector3d& scene_direction) const {
  return body < 0 ? scene_direction
                  : Eigen::Vector3d(bodies[static_cast<std::size_t>(body)].scene_axes.linear() *
                                    scene_direction);
}

}  // namespace momenta
