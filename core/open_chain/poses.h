#pragma once
// Poses and velocities of the bodies of an open chain, for pictures and measures of mechanisms,
// whose loops are left out.

#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/scene.h>

#include <memory>
#include <vector>

namespace momenta {

/// Motion of a body, in the scene's frame of it and ground axes.
struct BodyMotion {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< [m]
  Eigen::Vector3d v = Eigen::Vector3d::Zero();             ///< velocity of its origin [m/s]
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();         ///< [rad/s]
};

/// Owns its model and workspace; one object serves one thread.
class Poses {
 public:
  /// The tree of a mechanism, made of `scene`. O(bodies)
  Poses(const Tree& tree, const Scene& scene);
  ~Poses();
  Poses(const Poses&) = delete;
  Poses& operator=(const Poses&) = delete;

  /// Frame of each body of the tree in ground axes [m] at (t, q), q of nq numbers. O(bodies).
  std::vector<Eigen::Isometry3d> operator()(double t, const double* q);

  /// Takes the state (t, q, u), q of nq and u of nv numbers. O(bodies)
  void move(double t, const double* q, const double* u);
  /// The motion of a body of the tree (Tree::body()). @pre move()
  BodyMotion motion(int body) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace momenta
