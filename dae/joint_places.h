#pragma once
// The joints of a mechanism by name, with the places of their numbers in q and u. A joint may be
// carried by several bodies of the tree that share its name; its numbers are theirs in tree order.
// For a Lagrangian: its coordinates.

#include <momenta/core/kernel/points.h>
#include <momenta/core/kernel/workspace.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/tree/tree.h>
#include <momenta/dae/mechanism.h>

#include <string>
#include <vector>

namespace momenta {

struct JointPlace {
  std::string name;
  std::vector<int> q;            ///< places in q
  std::vector<int> u;            ///< places in u, p and all that goes with them
  std::vector<int> quaternions;  ///< places in q where a quaternion w x y z starts
  std::vector<int> drives;       ///< indices into Tree::drives, by coordinate of the joint
  int body = -1;  ///< −1: none; the last body of the joint, the one the scene's joint carries
};

/// All joints, in tree order of their first bodies. O(bodies log joints).
std::vector<JointPlace> joint_places(const Mechanism& mechanism);

// Positions and velocities of markers in ground axes, for one algebra and any scalar.

template <class Space>
class MarkerPoints {
 public:
  MarkerPoints(const Scene& scene, const Tree& tree, const Model<Space>& model) {
    for (const auto& marker : scene.markers) {
      const int body = tree.body(marker.body);
      const Eigen::Vector3d at = tree.point(body, marker.point);
      double height = 0;
      if constexpr (Space::dimension == 3)
        height = body < 0 ? model.basis.col(2).dot(at)
                          : (model.frames[static_cast<std::size_t>(body)] * at).z();
      points_.push_back({body, model.point(body, at), height});
    }
  }

  /// Position [m] and velocity [m/s] of each marker. Needs poses and velocities.
  template <class S>
  void write(const Workspace<Space, S>& w, S* values) const {
    for (const Point& point : points_) {
      const auto x = point_position(w, point.body, point.at);
      const auto v = point_velocity(w, point.body, x);
      for (int i = 0; i < 3; ++i) {
        if constexpr (Space::dimension == 3) {
          const auto& basis = w.model->basis;
          values[i] = basis(i, 0) * x[0] + basis(i, 1) * x[1] + S(basis(i, 2) * point.height);
          values[3 + i] = basis(i, 0) * v[0] + basis(i, 1) * v[1];
        } else {
          values[i] = x[i];
          values[3 + i] = v[i];
        }
      }
      values += 6;
    }
  }

 private:
  struct Point {
    int body;
    typename Space::template Vector<double> at;
    double height;  ///< across the plane
  };
  std::vector<Point> points_;
};

/// Word of messages for a constraint.
inline const char* loop_word(const Mechanism& mechanism) {
  return mechanism.scene().lagrangian ? "constraint" : "loop";
}

}  // namespace momenta
