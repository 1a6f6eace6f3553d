#pragma once
// A scene as Simbody has it: the same bodies, joints, loops and weights.
//
// Joint frames: momenta's child frame is parallel to the child's axes and its motion is about
// `axis` in the joint frame; Simbody's are about z (pin), along x (slider), about x and then y
// (universal). So both frames of a joint are turned by A, with A z = axis, …: X_PF = (rotation A,
// origin_parent), X_BM = (A, origin_child), and the coordinates are the same numbers, but for the
// rates of balls and free bodies: momenta has them in child axes, Simbody in the parent's frame, R
// u. Then d(R ω)/dt = R ω̇ and d(R v)/dt = R (v̇ + ω × v).
//
// Loops: a point is Simbody's Ball, a revolute one that and two constant angles of 90°, a distance
// its Rod, a weld its Weld. Where the mechanism is planar a point is two planes through it, as
// Simbody would be told by somebody who knows, since a ball's third equation is redundant there.
//
// C++17 alone: Simbody 3.7 does not compile as C++20.

#include <momenta/core/scene/scene.h>

#include <Eigen/Core>
#include <memory>

namespace momenta::benchmark_models {

class SimbodySystem {
 public:
  /// @param planar whether it moves in a plane, across the axes of its loops.
  /// @throws std::runtime_error with one sentence: what of the scene is not translated
  explicit SimbodySystem(const Scene& scene, bool planar = false);
  ~SimbodySystem();

  /// Takes q and u of momenta.
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& u);
  /// From q and u anew to accelerations.
  void evaluate();
  /// u̇ of momenta [rad/s² or m/s²], from the last evaluation.
  Eigen::VectorXd accelerations() const;
  int rates() const;
  int equations() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> in_;
};

}  // namespace momenta::benchmark_models
