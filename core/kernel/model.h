#pragma once
// A tree in one algebra: canonical constants of edges, inertias in canonical frames, applied
// forces, gravity. Built once, shared by all evaluations, immutable.

#include <momenta/core/expression/expression.h>
#include <momenta/core/kernel/joint_stop.h>
#include <momenta/core/kernel/planar.h>
#include <momenta/core/kernel/spatial.h>
#include <momenta/core/kernel/tree/tree.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

class UserFormula;  // core/kernel/user_motion.h

template <class Space>
struct Model {
  using Vector = typename Space::template Vector<double>;

  struct Body {
    JointKind kind = JointKind::revolute;
    int parent = -1;
    int drive = -1;
    int q = 0, nq = 0, u = 0, nv = 0;
    typename Space::EdgeConstants edge;
    double theta0 = 0, d0 = 0;  ///< joint screw at position zero [rad], [m]
    double pitch = 0;           ///< helical joints [m/rad]
    typename Space::template RigidInertia<double> inertia;
    double subtree_mass = 0;  ///< mass of the body and all it carries [kg]
    double stiffness = 0, rest = 0, damping = 0, torque = 0;
    double friction = 0, friction_rate = 1;  ///< joint_force() in sweeps.h
    bool is_curved = false;                  ///< force not linear: friction, stops
    int sprung = -1;  ///< place in Workspace::sprung of joints under a spring or signal
    double rotor =
        0;  ///< inertia on the joint's rate, on all three of a ball: rotor.h [kg m² or kg]
    bool has_rotor() const { return rotor != 0; }
    bool has_force() const {
      return nv == 1 && (stiffness != 0 || damping != 0 || torque != 0 || is_curved);
    }
    const UserFormula* law = nullptr;  ///< formula of a user joint, one of `laws`
    int user = -1;                     ///< place in `laws`
    JointStop stop;
  };
  /// Spring-damper between two points; offset2: squared distance across the plane of a planar
  /// scene.
  struct Spring {
    int parent = -1, child = -1;
    Vector at_parent, at_child;
    double offset2 = 0, stiffness = 0, damping = 0, rest = 0;
    double band = 0;  ///< dead_band.h
    JointStop stop;   ///< stop of its length
    bool limited = false;
  };
  /// bushing.h; offset2 as in Spring. rest_axes, in space alone: child axes without couple, in the
  /// parent's frame.
  struct Bushing {
    int parent = -1, child = -1;
    Vector at_parent, at_child;
    std::array<Vector, 3> rest_axes;
    double offset2 = 0, stiffness = 0, damping = 0, rotational_stiffness = 0,
           rotational_damping = 0;
    JointStop stop;  ///< stop at the largest angle |θ|
  };
  /// coordinate_spring.h
  struct CoordinateSpring {
    struct Term {
      int body = 0;   ///< body on the joint
      int place = 0;  ///< place in Workspace::sprung
      double ratio = 0;
    };
    std::vector<Term> terms;
    double stiffness = 0, damping = 0, rest = 0;
    double band = 0;  ///< dead_band.h
    JointStop stop;   ///< stop of the sum
  };
  /// Constant wrench. `torque` in space; in a plane only its normal component `normal_torque`.
  struct Wrench {
    int body = 0;
    Vector at, force, torque;
    double normal_torque = 0;
    bool in_body_axes = false;
  };

  /// A signal of signals.h, by `of`:
  ///   - sum: of `terms`
  ///   - point: at_child of the body `ends.child`, along the direction `along`, `across` more
  ///   - distance: of the two points of `ends`
  ///   - turn: of the body `ends.child`, about `along`, in a plane `across` about its normal
  struct Signal {
    enum class Of { time, sum, point, distance, turn };
    Of of = Of::time;
    bool is_rate = false;
    std::vector<typename CoordinateSpring::Term> terms;
    Spring ends;
    Vector along{};
    double across = 0;
    bool in_body_axes = false;  ///< `along`; else ground axes
  };
  /// formula_force.h: forces factor · y along signals, from the formula's outputs y.
  struct FormulaForce {
    struct Act {
      int output = 0;
      double factor = 1;
      int signal = 0;
    };
    Expression formula;       ///< outputs of a potential: V and its derivatives
    std::vector<int> inputs;  ///< signals, in the order of the variables
    std::vector<Act> acts;
    bool is_potential = false;
    int by_time = -1;  ///< the output ∂V/∂t; −1: none
    int force = 0;     ///< index of the scene's force
    std::string key;   ///< key of the formula in it
  };

  std::vector<Body> bodies;
  std::vector<Spring> springs;
  std::vector<Bushing> bushings;
  std::vector<CoordinateSpring> coordinate_springs;
  int sprung = 0;  ///< joints under coordinate springs and signals
  std::vector<Signal> signals;
  std::vector<FormulaForce> formula_forces;
  std::vector<Wrench> wrenches;
  std::vector<MotionLaw> drives;
  std::vector<std::shared_ptr<const JointFormula>> laws;
  Vector gravity;
  int nq = 0, nv = 0;
  bool has_gravity = false, has_joint_forces = false, has_rotors = false;
  bool has_corners = false;  ///< springs between points have dead bands or stops

  bool has_body_forces() const {
    return !springs.empty() || !wrenches.empty() || !bushings.empty() || has_forces_apart();
  }
  /// Whether some forces are unfit for the sweeps of packs and of loops.
  bool has_forces_apart() const {
    return !coordinate_springs.empty() || !formula_forces.empty() || has_corners;
  }

  /// A point given in the tree's body frame (−1: ground axes), in this model's frame of the body.
  Vector point(int body, const Eigen::Vector3d& tree_point) const;
  Vector direction(int body, const Eigen::Vector3d& tree_direction) const;
  /// Per body: the tree's frame in this model's frame. Planar: at zero configuration, in the
  /// plane's basis.
  std::vector<Eigen::Isometry3d> frames;
  Eigen::Matrix3d basis =
      Eigen::Matrix3d::Identity();  ///< planar: columns e1, e2, normal in ground axes
};
template <>
Vec3<double> Model<Spatial>::point(int, const Eigen::Vector3d&) const;
template <>
Vec3<double> Model<Spatial>::direction(int, const Eigen::Vector3d&) const;
template <>
Vec2<double> Model<Planar>::point(int, const Eigen::Vector3d&) const;
template <>
Vec2<double> Model<Planar>::direction(int, const Eigen::Vector3d&) const;

/// The plane of a scene, from its joint axes; empty with the reason in `why` when the scene is not
/// planar. Loops are judged by their owner.
struct PlaneFinding {
  std::optional<Eigen::Matrix3d> basis;
  std::string why;
};
PlaneFinding find_plane(const Tree& tree, const Scene& scene);

Model<Spatial> build_spatial_model(const Tree& tree, const Scene& scene);
Model<Planar> build_planar_model(const Tree& tree, const Scene& scene,
                                 const Eigen::Matrix3d& basis);

}  // namespace momenta
