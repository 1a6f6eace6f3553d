#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/joint_formula.h>
#include <momenta/core/scene/validate.h>

#include <map>

namespace momenta {
namespace {

/// A rotation that takes z to `axis` a: with z × a = (−a_y, a_x, 0) = k,
///   R = 1 + k~ + k~² / (1 + a_z).
/// Where a_z < 0 the sum 1 + a_z cancels: there a half turn about x is taken out first. The
/// identity for z, so that planar scenes keep clean numbers.
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

/// One joint of the tree: a joint of the scene, or one of a chain in its place.
struct Part {
  JointKind kind;
  int coordinate = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in the joint frame with all parts at zero
};

/// The chain of a joint. `driven`: all its coordinates, so that a spherical or free joint needs no
/// quaternion.
std::vector<Part> parts_of(const JointSpec& joint, bool driven) {
  using Kind = JointKind;
  const Eigen::Vector3d axis = joint.axis.normalized();
  switch (joint.kind) {
    case Kind::helical:  // without pitch it stays in a plane, as a revolute joint does
      return {{joint.pitch == 0 ? Kind::revolute : Kind::helical, 0, axis}};
    case Kind::cylindrical:
      return {{Kind::prismatic, 0, axis}, {Kind::revolute, 1, axis}};
    case Kind::universal: {
      const bool given = joint.axis2 != Eigen::Vector3d::Zero();
      return {{Kind::revolute, 0, axis},
              {Kind::revolute, 1, given ? joint.axis2.normalized() : perpendicular_to(axis)}};
    }
    case Kind::planar: {
      const bool given = joint.direction != Eigen::Vector3d::Zero();
      const Eigen::Vector3d first =
          given ? (joint.direction - joint.direction.dot(axis) * axis).normalized()
                : perpendicular_to(axis);
      return {{Kind::prismatic, 0, first},
              {Kind::prismatic, 1, axis.cross(first)},
              {Kind::revolute, 2, axis}};
    }
    case Kind::spherical:
    case Kind::free: {
      if (!driven) break;
      std::vector<Part> parts;
      const bool slides = joint.kind == Kind::free;
      for (int i = 0; slides && i < 3; ++i)
        parts.push_back({Kind::prismatic, i, Eigen::Vector3d::Unit(i)});
      for (int i = 2; i >= 0; --i)  // Rz(yaw) Ry(pitch) Rx(roll)
        parts.push_back({Kind::revolute, i + (slides ? 3 : 0), Eigen::Vector3d::Unit(i)});
      return parts;
    }
    default:
      break;
  }
  return {{joint.kind, 0, axis}};
}

/// Start values of one joint appended to q0 and u0; a quaternion without a start is the identity.
void append_start(const JointSpec& joint, const Tree::Body& body, Tree& tree) {
  const auto first = static_cast<std::size_t>(body.coordinate);
  for (int i = 0; i < body.nq; ++i) {
    const bool unit =
        (body.kind == JointKind::spherical && i == 0) || (body.kind == JointKind::free && i == 3);
    tree.q0[body.q + i] = joint.position.empty()
                              ? (unit ? 1.0 : 0.0)
                              : joint.position[first + static_cast<std::size_t>(i)];
  }
  for (int i = 0; i < body.nv; ++i)
    tree.u0[body.u + i] =
        joint.velocity.empty() ? 0.0 : joint.velocity[first + static_cast<std::size_t>(i)];
}

class TreeBuilder {
 public:
  explicit TreeBuilder(const Scene& scene) : scene_(scene) {
    for (const auto& body : scene.bodies) bodies_[body.name] = &body;
    for (const auto& joint : scene.joints) children_[joint.parent].push_back(&joint);
    for (const auto& drive : scene.drives)
      if (!drive.joint.empty()) drives_[drive.joint].push_back(&drive);
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
    for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
      append_start(*joints_[k], tree_.bodies[k], tree_);
      if (!tree_.carries_scene_body(static_cast<int>(k))) continue;
      tree_.body_places.emplace(tree_.bodies[k].name, static_cast<int>(k));
      tree_.joint_places.emplace(tree_.bodies[k].joint, static_cast<int>(k));
    }
    for (const auto& force : scene_.forces)
      if (force.kind == "torque")
        tree_.bodies[static_cast<std::size_t>(tree_.carried_by(force.joint))].torque += force.value;
    return std::move(tree_);
  }

 private:
  /// Adds the parts of a joint. @return the index of the last, which carries the scene's body
  int add(const JointSpec& joint, int parent) {
    const auto found = drives_.find(joint.name);
    const std::vector<const DriveSpec*> none;
    const auto& drives = found == drives_.end() ? none : found->second;
    if (!drives.empty()) refuse_forces(joint);
    const std::vector<Part> parts = parts_of(joint, !drives.empty());

    Eigen::Matrix3d z_before = Eigen::Matrix3d::Identity();  // joint axes seen from the part before
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Part& part = parts[i];
      Tree::Body b;
      b.joint = joint.name;
      b.part = static_cast<int>(i);
      b.parts = static_cast<int>(parts.size());
      b.coordinate = part.coordinate;
      b.parent = parent;
      b.kind = part.kind;
      const bool user = part.kind == JointKind::user;
      b.nq = user ? coordinates_of(joint) : coordinates_of(part.kind);
      b.nv = user ? rates_of(joint) : rates_of(part.kind);
      b.law = joint.law;
      for (const DriveSpec* drive : drives)
        if (drive->coordinate == part.coordinate) {
          b.drive = static_cast<int>(tree_.drives.size());
          tree_.drives.emplace_back(*drive);
          b.nq = b.nv = 0;
        }
      b.q = tree_.nq;
      b.u = tree_.nv;
      tree_.nq += b.nq;
      tree_.nv += b.nv;

      const Eigen::Matrix3d z_along_axis =
          b.kind == JointKind::weld || user || coordinates_of(b.kind) > 1
              ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
              : frame_with_z(part.axis);
      if (i == 0) {
        const Eigen::Isometry3d parent_axes =
            parent < 0 ? Eigen::Isometry3d::Identity()
                       : tree_.bodies[static_cast<std::size_t>(parent)].scene_axes;
        b.placement =
            parent_axes * isometry(joint.rotation.normalized().toRotationMatrix() * z_along_axis,
                                   joint.origin_parent);
      } else {
        b.placement = isometry(z_before.transpose() * z_along_axis, Eigen::Vector3d::Zero());
      }
      z_before = z_along_axis;
      b.pitch = b.kind == JointKind::helical ? joint.pitch : 0;
      b.stiffness = joint.stiffness;
      b.rest = joint.rest;
      b.damping = joint.damping;
      b.friction = joint.friction;
      b.friction_rate = joint.friction_rate;
      if (has_stops(joint)) {
        b.least = (*joint.limits)[0];
        b.largest = (*joint.limits)[1];
        b.stop_stiffness = joint.stop_stiffness;
        b.stop_damping = joint.stop_damping;
        b.stop_width = joint.stop_width;
      }
      if ((b.nv == 1 || b.nv == 3) && !joint.rotor_inertia.empty())
        b.rotor = joint.rotor_inertia[static_cast<std::size_t>(part.coordinate)];

      const bool last = i + 1 == parts.size();
      b.scene_axes =
          isometry(z_along_axis, last ? joint.origin_child : Eigen::Vector3d(0, 0, 0)).inverse();
      b.com.setZero();
      b.inertia.setZero();
      if (last) {
        const BodySpec& spec = *bodies_.at(joint.child);
        b.name = spec.name;
        b.mass = spec.mass;
        b.com = b.scene_axes * spec.com;
        b.inertia = b.scene_axes.linear() * spec.inertia * b.scene_axes.linear().transpose();
      }
      parent = static_cast<int>(tree_.bodies.size());
      tree_.bodies.push_back(std::move(b));
      joints_.push_back(&joint);
    }
    return parent;
  }

  /// A force along a driven joint would change nothing but the drive.
  void refuse_forces(const JointSpec& joint) const {
    bool forced = joint.stiffness != 0 || joint.damping != 0 || joint.friction != 0 ||
                  joint.bearing || has_stops(joint);
    for (const auto& force : scene_.forces)
      forced |= force.kind == "torque" && force.joint == joint.name;
    if (forced)
      throw SceneError(scene_.where(joint.at) + "joint '" + joint.name +
                       "' is driven, so a spring, damper, friction, bearing, stop or torque on it "
                       "has no effect; "
                       "expected none");
  }

  const Scene& scene_;
  Tree tree_;
  std::map<std::string, const BodySpec*> bodies_;
  std::map<std::string, std::vector<const JointSpec*>> children_;
  std::map<std::string, std::vector<const DriveSpec*>> drives_;
  std::vector<const JointSpec*> joints_;
};

Tree without_bodies(const Scene& scene) {
  const auto& coordinates = scene.lagrangian->coordinates;
  Tree tree;
  tree.name = scene.name;
  tree.nq = tree.nv = static_cast<int>(coordinates.size());
  tree.q0.resize(tree.nq);
  tree.u0.resize(tree.nv);
  for (int i = 0; i < tree.nq; ++i) {
    tree.q0[i] = coordinates[static_cast<std::size_t>(i)].position;
    tree.u0[i] = coordinates[static_cast<std::size_t>(i)].velocity;
  }
  return tree;
}

}  // namespace

Tree build_tree(const Scene& scene) {
  validate(scene);
  return build_valid_tree(scene);
}

Tree build_valid_tree(const Scene& scene) {
  return scene.lagrangian ? without_bodies(scene) : TreeBuilder(scene).build();
}

int Tree::body(const std::string& scene_name) const {
  const auto found = body_places.find(scene_name);
  return found == body_places.end() ? -1 : found->second;
}

int Tree::carried_by(const std::string& joint_name) const {
  const auto found = joint_places.find(joint_name);
  return found == joint_places.end() ? -1 : found->second;
}

int Tree::part_of(const std::string& joint_name, int coordinate) const {
  const int last = carried_by(joint_name);
  for (int k = first_part(last); k < last; ++k)
    if (bodies[static_cast<std::size_t>(k)].coordinate == coordinate) return k;
  return last;
}

std::string Tree::joint_in_words(int k) const {
  const Body& b = bodies[static_cast<std::size_t>(k)];
  const std::string joint = "joint '" + b.joint + "'";
  return b.parts == 1 ? joint : "coordinate " + std::to_string(b.coordinate) + " of " + joint;
}

bool Tree::Body::is_length(int i) const {
  if (law) return law->is_length(i);
  return nv == 6 ? i < 3 : nv == 1 && kind == JointKind::prismatic;
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
