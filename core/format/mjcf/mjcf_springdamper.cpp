// `springdamper` of a joint: a time constant τ and a damping ratio ζ. From them MuJoCo makes
//
//   k = I/(τ² ζ²),  c = 2 I/τ,   I = n / Σ (M⁻¹)_ii
//
// over the n rates of the joint, M with armatures and without constraints, at qpos0. M is assembled
// here from the bodies: with J_b the columns of the joints between body b and the ground, in axes
// of the ground and about its centre of mass,
//
//   M = Σ_b J_bᵀ diag(m 1, I_c) J_b + diag(armatures)
//
// O(bodies · depth²), and O(rates³) for its inverse: small beside a run.

#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <Eigen/Cholesky>

namespace momenta::reading {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// One rate: an axis through a point, about or along which it moves the bodies on its joint.
struct Rate {
  Vector3d axis, point;
  bool turns = true;
};
/// A joint, with the way from it to the ground.
struct Way {
  const JointSpec* joint = nullptr;
  MjcfFrame child;  ///< axes of the body it carries, at qpos0
  int first = 0, count = 0;
  int parent = -1;
};

class MassMatrix {
 public:
  explicit MassMatrix(const Scene& scene) {
    for (const JointSpec& j : scene.joints) carriers_[j.child] = &j;
    for (const JointSpec& j : scene.joints) place(j);
    MatrixXd m = MatrixXd::Zero(size(), size());
    for (const BodySpec& b : scene.bodies) add(b, m);
    for (const Way& way : ways_)
      if (!way.joint->rotor_inertia.empty())
        m.diagonal().segment(way.first, way.count).array() += way.joint->rotor_inertia.front();
    const Eigen::LDLT<MatrixXd> factors(m);
    positive_ = factors.info() == Eigen::Success && (factors.vectorD().array() > 0).all();
    if (positive_) inverse_ = factors.solve(MatrixXd::Identity(size(), size()));
  }

  bool positive() const { return positive_; }
  /// n / Σ (M⁻¹)_ii of a joint. @pre positive()
  double mean(const std::string& joint) const {
    for (const Way& way : ways_)
      if (way.joint->name == joint)
        return way.count / inverse_.diagonal().segment(way.first, way.count).sum();
    return 0;
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(rates_.size()); }

  /// Adds the way to the body of a joint; its parents' first, one after the other.
  int place(const JointSpec& last) {
    std::vector<const JointSpec*> pending{&last};
    while (!places_.contains(pending.back()->parent) && pending.back()->parent != "ground")
      pending.push_back(carriers_.at(pending.back()->parent));
    for (; !pending.empty(); pending.pop_back())
      if (!places_.contains(pending.back()->child)) place_next(*pending.back());
    return places_.at(last.child);
  }
  void place_next(const JointSpec& j) {
    Way way;
    way.joint = &j;
    MjcfFrame parent;
    if (j.parent != "ground") {
      way.parent = places_.at(j.parent);
      parent = ways_[static_cast<std::size_t>(way.parent)].child;
    }
    MjcfFrame moved;  // at qpos0 only free joints are not at zero
    if (j.kind == JointKind::free) {
      const std::vector<double>& x = j.position;
      moved = {{x[0], x[1], x[2]}, Eigen::Quaterniond(x[3], x[4], x[5], x[6])};
    }
    const MjcfFrame frame = parent * MjcfFrame{j.origin_parent, j.rotation};
    way.child = frame * moved * MjcfFrame{-j.origin_child, Eigen::Quaterniond::Identity()};
    way.first = static_cast<int>(rates_.size());
    way.count = rates_of(j.kind);
    const Vector3d at = (frame * moved).at;
    if (way.count == 1) {
      rates_.push_back({frame.turn * j.axis, at, j.kind == JointKind::revolute});
    } else {
      for (int i = 0; i < way.count; ++i)
        rates_.push_back({Vector3d::Unit(i % 3), at, way.count == 3 || i >= 3});
    }
    places_[j.child] = static_cast<int>(ways_.size());
    ways_.push_back(way);
  }

  void add(const BodySpec& b, MatrixXd& m) const {
    if (b.mass == 0 && b.inertia.isZero(0)) return;
    const int own = places_.at(b.name);
    const MjcfFrame& frame = ways_[static_cast<std::size_t>(own)].child;
    const Vector3d com = frame * b.com;
    const Matrix3d turn = frame.turn.toRotationMatrix();
    const Matrix3d inertia = turn * b.inertia * turn.transpose();
    std::vector<Eigen::Index> columns;
    std::vector<Vector3d> linear, angular;
    for (int k = own; k >= 0; k = ways_[static_cast<std::size_t>(k)].parent) {
      const Way& way = ways_[static_cast<std::size_t>(k)];
      for (int i = 0; i < way.count; ++i) {
        const Rate& r = rates_[static_cast<std::size_t>(way.first + i)];
        columns.push_back(way.first + i);
        linear.push_back(r.turns ? Vector3d(r.axis.cross(com - r.point)) : r.axis);
        angular.push_back(r.turns ? r.axis : Vector3d(Vector3d::Zero()));
      }
    }
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t j = 0; j < columns.size(); ++j)
        m(columns[i], columns[j]) +=
            b.mass * linear[i].dot(linear[j]) + angular[i].dot(inertia * angular[j]);
  }

  std::map<std::string, const JointSpec*> carriers_;  // by child
  std::map<std::string, int> places_;                 // ways by body
  std::vector<Way> ways_;
  std::vector<Rate> rates_;
  MatrixXd inverse_;
  bool positive_ = false;
};

}  // namespace

void settle_spring_dampers(MjcfModel& model) {
  if (model.spring_dampers.empty()) return;
  const MassMatrix matrix(model.scene);
  for (const MjcfModel::SpringDamper& s : model.spring_dampers) {
    for (JointSpec& joint : model.scene.joints) {
      if (joint.name != s.joint) continue;
      if (!matrix.positive())
        throw SceneError(model.scene.where(joint.at) + "joint " + in_quotes(s.joint) +
                         ": springdamper needs a positive definite mass matrix at qpos0, expected "
                         "inertia along every joint");
      const double inertia = matrix.mean(s.joint);
      const double stiffness =
          model.springs
              ? inertia / (s.time_constant * s.time_constant * s.damping_ratio * s.damping_ratio)
              : 0;
      const double damping = model.dampers ? 2 * inertia / s.time_constant : 0;
      if (has_one_coordinate(joint.kind)) {
        joint.stiffness = stiffness;
        joint.damping = damping;
        continue;
      }
      // replaces the bushing made from the attributes stiffness and damping
      std::erase_if(model.scene.forces, [&](const ForceSpec& f) {
        return f.kind == "bushing" && f.parent == joint.parent && f.child == joint.child;
      });
      add_spring_and_damper(joint, stiffness, damping, model);
    }
  }
}

}  // namespace momenta::reading
