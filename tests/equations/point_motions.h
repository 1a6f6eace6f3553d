#pragma once
// Where the markers of a mechanism are, how fast and how accelerated, from q, u and u̇, exactly: a
// marker's place in ground axes is Φ of a loop that ties it to the ground's origin, its velocity Φ̇,
// its acceleration Φ̈. No coordinate of any joint is in it: it is what two descriptions of one
// mechanism have in common.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>

namespace momenta::equations {

/// In turned ground axes, 3 × markers, in the order of the scene.
struct PointMotion {
  Eigen::Matrix3Xd place, velocity, acceleration;
};

class PointMotions {
 public:
  /// Markers on bodies, at least one.
  explicit PointMotions(const Mechanism& mechanism);
  /// `udot` null: none.
  PointMotion operator()(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                         const Eigen::VectorXd* udot);

 private:
  std::unique_ptr<Mechanism> tied_;
  std::unique_ptr<Evaluation<double>> e_;
};

/// Three markers on every body, off its axes, in place of those of the scene.
void mark_bodies(Scene& scene);
Scene marked(Scene scene);

}  // namespace momenta::equations
