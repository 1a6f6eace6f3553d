#pragma once
// Loops cast into one algebra: for every loop its two bodies, the points and axes it ties together,
// and which rows.
//
// Body A is the loop's child, B its parent; b_j are axes of B, a_i axes of A; D = x_A − x_B.
//   D_j    b_j · D                      point on a plane through x_B
//   O_ij   a_i · b_j − γ                two axes at a fixed angle, mostly a right one
//   L      (D · D − l²) / (2 l₀)        distance, in metres; l₀: l at the start
//   Q      Σ rᵢ qᵢ − c                  coordinates of joints; r₂ x² + r₃ x³ + r₄ x⁴ besides, x the
//                                      last of them, of couplers that are not linear
//   F      F(b_1·D, b_2·D, a_1·b_1, a_1·b_2)    higher pairs: higher_pair.h
//   E      any formula                 coordinates, positions of points, t: loop_equation.h
//   V      any formula                 linear in rates: loop_equation.h; nonholonomic
//   R      contact and slip of a wheel: rolling_wheel.h; the slip is nonholonomic
//
//   point, spherical  D1 D2 D3          revolute about axis 3   D1 D2 D3, O31 O32
//   weld              D1 D2 D3, O12 O23 O31      prismatic along axis 3   D1 D2, O12 O23 O31
//   universal, axes b_3, a_1  D1 D2 D3, O13          cylindrical along axis 3   D1 D2, O31 O32
//   planar across axis 3      D3, O31 O32            distance                   L
//   coupler                   Q                      equation                 E
//   velocity-equation         V                      rolling on a plane across axis 3   R1 R2 R3
//   slot on a line along axis 3  D1 D2
//   slot on a circle or spline across axis 3  D3, F  cam, rack across axis 3            F
// In a plane: point, spherical, revolute D1 D2; weld D1 D2 O12; prismatic D (across), O12; distance
// L; slot on a line D (across), on a circle L, on a spline F; cam, rack F. The D1 D2 of a plane
// that come alone, that no drive moves and whose bodies no third one carries are a tie: their b_j
// are the axes of the ground, so that Φ = x_A − x_B, and the impulse σ is the one on A at x_A and,
// negated, on B at x_B, whatever its axes. (A body that carried both would turn Φ, and be felt in
// it where the loop is open.)
//
// Drives make these functions of time: x_B and b_j move relative to B as prescribed, a_i relative
// to A, l and c change. A driven coordinate of a loop adds a row: a driven slide the D along it,
// with x_B shifted by its displacement; a driven angle θ the O12 about its axis, with the a_i
// turned back by θ, so that the row is sin of what the angle is off and as good at every θ. A
// driven universal or spherical loop leaves a hinge, or nothing: loop_choice.cpp.

#include <momenta/core/kernel/model.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

struct HigherPair;  // dae/mechanism/loop/higher_pair.h

/// A wheel of the child: a circle across its axle, thickened.
struct Wheel {
  double circle = 0;  ///< radius of the circle [m]
  double crown = 0;   ///< radius of the cross section [m]
};
template <class Space>
struct LoopEquation;  // dae/mechanism/loop/loop_equation.h

template <class Space>
struct LoopModel {
  using Vector = typename Space::template Vector<double>;
  /// Angular velocity: a vector in space, a number in the plane.
  using Angular = decltype(cross(Vector{}, Vector{}));

  /// One free coordinate of a coupler.
  struct Coupled {
    int body = 0;  ///< body of its joint
    int q = 0, u = 0;
    double ratio = 0;
    std::array<double, 3> powers{};  ///< r₂, r₃, r₄
    int curve = -1;                  ///< index among coordinates with `curves`; −1: none

    template <class S>
    S value(const S& x) const {
      if (curve < 0) return ratio * x;
      return x * (ratio + x * (powers[0] + x * (powers[1] + powers[2] * x)));
    }
    /// dΦ/dx,
    template <class S>
    S slope(const S& x) const {
      return ratio + x * (2 * powers[0] + x * (3 * powers[1] + (4 * powers[2]) * x));
    }
    /// d²Φ/dx²
    template <class S>
    S bend(const S& x) const {
      return 2 * powers[0] + x * (6 * powers[1] + (12 * powers[2]) * x);
    }
  };
  struct Loop {
    int a = -1, b = -1;                    ///< bodies, −1: ground, as both of a coupler
    int row = 0, rows = 0;                 ///< place in Φ
    Vector at_a, at_b;                     ///< points, body axes
    std::array<Vector, 3> axis_a, axis_b;  ///< axes, body axes
    std::array<int, 3> points{};           ///< j of the D_j rows
    int n_points = 0;
    std::array<std::pair<int, int>, 3> axes{};  ///< (i, j) of the O_ij rows
    int n_axes = 0;
    double gamma = 0;             ///< universal: cosine of the angle between the two axes
    bool is_tie = false;          ///< D1 D2 along axes of the ground
    double per_length = 0;        ///< distance: 1/l₀; then L is the only row
    double given = 0;             ///< l or c
    double across2 = 0;           ///< squared distance across the plane of a planar scene
    std::vector<Coupled> joints;  ///< coupler: then Q is the only row
    int pair = -1;                ///< place in `pairs`; then F follows the rows of points
    int equation = -1;            ///< place in `equations`; `joints` are its coordinates
    int wheel = -1;               ///< place in `wheels`; then its rows are the only ones
    int motion = -1;              ///< place in `motions`; −1: nothing is prescribed
    double least_scale = 0;       ///< rows of points: Mechanism::least_scales()

    /// Body whose axes the b_j are.
    int axes_of_b() const { return is_tie ? -1 : b; }
    bool is_distance() const { return per_length > 0; }
    bool is_equation() const { return equation >= 0; }
    /// No two bodies: a coupler or an equation.
    bool is_coupler() const { return !joints.empty() || is_equation(); }
    bool is_pair() const { return pair >= 0; }
    bool is_wheel() const { return wheel >= 0; }
    /// Rows of the first unit: points, a distance, a coupling, a higher pair. Those of axes follow.
    int first_rows() const {
      if (is_wheel()) return rows;
      if (is_distance() || is_coupler()) return 1;
      return pair < 0 ? n_points : n_points + 1;
    }
  };

  /// Prescribed motion of one loop, and its values at one time.
  struct Motion {
    struct Translation {
      MotionLaw law;
      Vector along;  ///< x_B moves by f along, axes of B
    };
    struct Turn {
      MotionLaw law;
      Angular axis;  ///< the axes are turned by f about it, axes of the body
    };
    std::vector<Translation> translations;
    std::vector<Turn> turns_a, turns_b;                 ///< R = R₁(f₁) R₂(f₂) …
    std::vector<std::pair<double, MotionLaw>> numbers;  ///< l or c is given + Σ factor · f
    // The loop with every f zero.
    Vector at_b{};
    std::array<Vector, 3> axis_a{}, axis_b{};
    double given = 0;

    // Rates relative to the bodies, in their axes, at the time of LoopsInTime.
    Vector v{}, a{};                                                       ///< motion of x_B
    Angular turning_a{}, turning_a_rate{}, turning_b{}, turning_b_rate{};  ///< a_i and b_j
    double given_rate = 0, given_second = 0;
  };

  std::vector<Loop> loops;
  std::vector<Motion> motions;
  std::vector<std::shared_ptr<const HigherPair>> pairs;
  std::vector<std::shared_ptr<const LoopEquation<Space>>> equations;
  std::vector<Wheel> wheels;  ///< in space alone
  int rows = 0;               ///< m, size of Φ
  int curves = 0;             ///< coordinates whose column of Φ_q changes
  /// Whether all rows are of the kinds that sweeps carry.
  bool swept() const { return curves == 0 && pairs.empty() && equations.empty() && wheels.empty(); }
  /// Whether each row is one of velocities without a row of positions behind it.
  std::vector<bool> nonholonomic() const;
};

LoopModel<Spatial> build_loops(const Scene& scene, const Tree& tree, const Model<Spatial>& model);
/// @throws SceneError when a loop's two sides lie apart across the plane.
LoopModel<Planar> build_loops(const Scene& scene, const Tree& tree, const Model<Planar>& model);

/// Why a loop leaves the plane with this basis; empty when all stay in it.
std::string loops_leave_plane(const Scene& scene, const Tree& tree, const Eigen::Matrix3d& basis);

}  // namespace momenta
