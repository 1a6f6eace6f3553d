#pragma once
// Positions and velocities of markers in ground axes, for one algebra and any scalar.

#include <momenta/core/kernel/points.h>
#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/kernel/workspace.h>
#include <momenta/core/scene/scene.h>

#include <vector>

namespace momenta {

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

}  // namespace momenta
