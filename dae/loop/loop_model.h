#pragma once
// Loops cast into one algebra: for every loop its two bodies, the points and axes it ties together,
// and which rows.
//
// Body A is the loop's child, B its parent; b_j are axes fixed in B, a_i axes fixed in A; D = x_A −
// x_B.
//   D_j    b_j · D                      point on a plane through x_B
//   O_ij   a_i · b_j − γ                two axes at a fixed angle, mostly a right one
//   L      (D · D − l²) / (2 l)         distance, in metres
//
//   point, spherical  D1 D2 D3          revolute about axis 3   D1 D2 D3, O31 O32
//   weld              D1 D2 D3, O12 O23 O31      prismatic along axis 3   D1 D2, O12 O23 O31
//   universal, axes b_3, a_1  D1 D2 D3, O13          cylindrical along axis 3   D1 D2, O31 O32
//   planar across axis 3      D3, O31 O32            distance                   L
// In a plane: point, spherical, revolute D1 D2; weld D1 D2 O12; prismatic D (across), O12; distance
// L.

#include <momenta/core/kernel/model.h>

#include <array>
#include <string>
#include <vector>

namespace momenta {

template <class Space>
struct LoopModel {
  using Vector = typename Space::template Vector<double>;

  struct Loop {
    int a = -1, b = -1;                    ///< bodies, −1: ground
    int row = 0, rows = 0;                 ///< place in Φ
    Vector at_a, at_b;                     ///< points, body axes
    std::array<Vector, 3> axis_a, axis_b;  ///< axes, body axes
    std::array<int, 3> points{};           ///< j of the D_j rows
    int n_points = 0;
    std::array<std::pair<int, int>, 3> axes{};  ///< (i, j) of the O_ij rows
    int n_axes = 0;
    double gamma = 0;    ///< universal: cosine of the angle between the two axes
    double length = 0;   ///< distance loops; then the only row
    double across2 = 0;  ///< squared distance across the plane of a planar scene
  };

  std::vector<Loop> loops;
  int rows = 0;  ///< m, size of Φ
};

/// One row of Φ by name: what a rank report or a failure message calls it.
struct RowName {
  std::string loop;
  std::string what;  ///< "point along axis 1", "axis 3 against axis 1", "distance"
};

LoopModel<Spatial> build_loops(const Scene& scene, const Tree& tree, const Model<Spatial>& model);
/// @throws SceneError when a loop's two sides lie apart across the plane.
LoopModel<Planar> build_loops(const Scene& scene, const Tree& tree, const Model<Planar>& model);

/// Why a loop leaves the plane with this basis; empty when all stay in it.
std::string loops_leave_plane(const Scene& scene, const Tree& tree, const Eigen::Matrix3d& basis);

std::vector<RowName> row_names(const Scene& scene, bool planar);

}  // namespace momenta
