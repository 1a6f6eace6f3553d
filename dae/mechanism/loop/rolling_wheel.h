#pragma once
// A wheel of body A that rolls on a plane of body B. n = b_3 is the plane's normal, b_1, b_2 lie in
// it; a is the axle, x_A the wheel's centre; the wheel is the circle of radius r about x_A across
// a, thickened by ρ: a disc for ρ = 0, a sphere for r = 0.
//
// The circle's point nearest to the plane, and the point of contact P below it:
//
//   o = a·n,  m = n − o a,  s = |m| = √(1 − o²),     c = −r m/s − ρ n,   P = x_A + c
//
//   R1   Φ = n·(x_A − x_B) − r s − ρ                 contact, holonomic
//        Φ̇ = n·(v_A(P) − v_B(P)), v of the points of the bodies that are at P
//   R2   b_1·(v_A(P) − v_B(P)) = 0                   no slip, nonholonomic
//   R3   b_2·(v_A(P) − v_B(P)) = 0
//
// Ṗ, the velocity of the contact and of no point of a body, comes in where P runs along both
// bodies:
//
//   d/dt e·(v_A(P) − v_B(P)) = e·(a_A(P) − a_B(P) + ω_A × (Ṗ − v_A) − ω_B × (Ṗ − v_B))
//                              + (ω_B × e)·(v_A − v_B)
//   impulse on A: e σ at P, on B its negative;   N on A: (ω_B × e) σ at P and the couple Ṗ × e σ
//
// N = Ȧᵀσ of rows A(q) u, whether an A is some Φ_q or not: docs/theory/higher-pairs.md, section 4.
// The disc that lies flat, s = 0, touches along its circle, and has no such P.

#include <momenta/core/kernel/points.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

#include <array>

namespace momenta {

/// A wheel and its contact, in ground axes.
template <class S>
struct RollingWheel {
  using Vector = Vec3<S>;
  std::array<Vector, 3> along;                  ///< n, b_1, b_2, in the order of the rows
  Vector at{};                                  ///< P
  Vector v_a{}, v_b{}, w_a{}, w_b{}, moving{};  ///< velocities of both bodies at P, and Ṗ
  S gap{};                                      ///< Φ of R1

  /// b: axes of B.
  void place(const Wheel& wheel, const std::array<Vector, 3>& b, const Vector& axle,
             const Vector& centre, const Vector& apart) {
    using std::sqrt;
    along = {b[2], b[0], b[1]};
    a_ = axle;
    o_ = dot(axle, b[2]);
    s_ = S(1.0);
    m_ = Vector{};
    arm_ = S(-wheel.crown) * b[2];
    gap = dot(b[2], apart) - S(wheel.crown);
    if (wheel.circle > 0) {
      m_ = b[2] - o_ * axle;
      s_ = sqrt(dot(m_, m_));
      arm_ += (S(-wheel.circle) / s_) * m_;
      gap -= wheel.circle * s_;
    }
    at = centre + arm_;
  }
  /// u: velocity of the centre.
  void move(const Wheel& wheel, const Vector& u, const Vector& of_a, const Vector& of_b) {
    w_a = of_a;
    w_b = of_b;
    const Vector turning = cross(w_b, along[0]), axle = cross(w_a, a_);
    moving = u - wheel.crown * turning;
    if (wheel.circle == 0) return;
    const S rate = dot(axle, along[0]) + dot(a_, turning);
    const Vector leaning = turning - rate * a_ - o_ * axle;
    moving += (S(-wheel.circle) / s_) * (leaning + (o_ * rate / (s_ * s_)) * m_);
  }
  S rate(std::size_t row) const { return dot(along[row], v_a - v_b); }
  /// Second derivative of a row, from the accelerations of both bodies' points at P.
  S second(std::size_t row, const Vector& a_a, const Vector& a_b) const {
    return dot(along[row], a_a - a_b + cross(w_a, moving - v_a) - cross(w_b, moving - v_b)) +
           dot(cross(w_b, along[row]), v_a - v_b);
  }
  /// Whether there is one point of contact: less than 10⁻⁷ rad from flat it is rounding.
  bool touches(const Wheel& wheel) const {
    constexpr double flat = 1e-7;
    return 0 * value_of(dot(at, at)) == 0 && (wheel.circle == 0 || value_of(s_) > flat);
  }

 private:
  Vector a_{}, m_{}, arm_{};
  S o_{}, s_{};
};

}  // namespace momenta
