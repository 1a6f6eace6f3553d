#pragma once
// Higher pairs: one equation F(y) = 0 between two bodies, of how body A lies in a plane of body B,
//
//   y = (ξ, η, c, s),   ξ = b₁·D,  η = b₂·D,  c = a₁·b₁,  s = a₁·b₂,
//
// the measures D_j and O_ij of loop_model.h without their constants: the origin of A, and the first
// axis of A in axes of B. So R = (c −s; s c) turns A's components to B's, ∂R/∂c = 1, ∂R/∂s = J.
//
//   circle    a point of A on a circle of B:  F = (ξ² + η² − r²) / (2 r)
//   rolling   a circle of A rolls on the line of B along b₁, on the side of b₂, θ the angle of A:
//             F = r sin(θ + φ) = r (s cos φ + c sin φ),   φ = ξ/r − offset
//             which is zero through any number of turns and asks for no count of them
//   curve     a point of A on a curve p(β) of B: its distance, F = n(β)·e, e = (ξ, η) − p(β), n the
//             unit normal at the foot, where r = p'·e = 0
//   contact   outlines p_A(α), p_B(β) touch: the gap along their common normal, F = n(β)·g,
//             g = (ξ, η) + R p_A(α) − p_B(β), where r₁ = p_B'·g = 0 and r₂ = J p_B'·R p_A' = 0
//
// At the foot F does not change with α and β to first order: n'·e ∝ r = 0, n·R p_A' ∝ r₂ = 0. So
//
//   ∂F/∂y = (n₁, n₂, n·p_A, n·J p_A),
//   ∂²F/∂y² = its derivative by (α, β) · d(α, β)/dy,   d(α, β)/dy = −(∂r/∂(α, β))⁻¹ ∂r/∂y.
//
// α and β are found in doubles, and rounded to a grid of 2⁻²⁴ of their range, so that what follows
// is a function of y whatever the last place was. From there Newton's method goes on in the scalar
// S: with an error ε of the start, after k steps the derivative of order j is wrong by ε^(2ᵏ − j).
// Source of the last: Griewank and Walther, Evaluating Derivatives, section 15.3.

#include <momenta/core/scalar/local_dual.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/core/scene/plane_curve.h>

#include <array>
#include <cmath>
#include <type_traits>

namespace momenta {

/// F with its derivatives by y; of a pair that does not turn, by ξ and η alone.
template <class S>
struct PairTerms {
  S value{};
  std::array<S, 4> slope{};
  std::array<std::array<S, 4>, 4> bend{};  ///< symmetric

  /// Sets second derivatives, or all, to NaN.
  void lose(bool all) {
    const S none(std::nan(""));
    for (auto& row : bend) row.fill(none);
    if (!all) return;
    value = none;
    slope.fill(none);
  }
};

/// Where two curves touched last: the start of the next search.
struct PairPlace {
  enum class Lost {
    no,
    no_normal,  ///< no foot or common normal was found
    curvature   ///< at a centre of curvature, or the outlines curve alike: F has no second
                ///< derivative
  };
  bool known = false;
  double of_a = 0, of_b = 0;  ///< α, β
  Lost lost = Lost::no;
};

struct HigherPair {
  enum class Kind { circle, rolling, curve, contact };
  Kind kind = Kind::circle;
  double radius = 0;      ///< circle, rolling [m]
  double offset = 0;      ///< rolling [rad]
  PlaneCurve of_a, of_b;  ///< of_a: contact; of_b: curve and contact

  /// Whether F depends on c and s.
  bool turns() const { return kind == Kind::rolling || kind == Kind::contact; }
  /// Greatest distance of the touching points from the origins of A and B [m].
  double reach_a() const { return kind == Kind::rolling ? radius : of_a.reach(); }
  double reach_b() const { return kind == Kind::circle ? radius : of_b.reach(); }

  /// F and its derivatives at y; NaN where `place` is lost. No allocation. O(1) from the last
  /// place; else O(samples) for a curve, O(samples²) for a contact.
  template <class S>
  void evaluate(const std::array<S, 4>& y, PairPlace& place, PairTerms<S>& out) const {
    if constexpr (std::is_same_v<S, LocalDual>) {
      by_chain_rule(y, place, out);
    } else {
      switch (kind) {
        case Kind::circle:
          return circle(y, out);
        case Kind::rolling:
          return rolling(y, out);
        case Kind::curve:
        case Kind::contact:
          break;
      }
      locate({value_of(y[0]), value_of(y[1]), value_of(y[2]), value_of(y[3])}, place);
      if (kind == Kind::curve)
        curve(y, place, out);
      else
        contact(y, place, out);
      if (place.lost != PairPlace::Lost::no) out.lose(place.lost == PairPlace::Lost::no_normal);
    }
  }

  /// Finds α and β.
  void locate(const std::array<double, 4>& y, PairPlace& place) const;

 private:
  template <class S>
  using Pair = std::array<S, 2>;
  template <class S>
  static S dot(const Pair<S>& x, const Pair<S>& y) {
    return x[0] * y[0] + x[1] * y[1];
  }
  template <class S>
  static Pair<S> left(const Pair<S>& x) {
    return {-x[1], x[0]};
  }
  template <class S>
  static Pair<S> turned(const std::array<S, 4>& y, const Pair<S>& x) {
    return {y[2] * x[0] - y[3] * x[1], y[3] * x[0] + y[2] * x[1]};
  }

  /// Steps of Newton's method from the grid: errors ε^(2ᵏ − j) below rounding.
  template <class S>
  static constexpr int steps_of() {
    if constexpr (std::is_same_v<S, double> || std::is_same_v<S, Dual8> ||
                  std::is_same_v<S, Dual<double, 4>>)
      return 2;
    else
      return 4;
  }

  template <class S>
  void circle(const std::array<S, 4>& y, PairTerms<S>& out) const {
    const double per = 1 / radius;
    out.value = (y[0] * y[0] + y[1] * y[1]) * (0.5 * per) - 0.5 * radius;
    out.slope = {per * y[0], per * y[1], S(0.0), S(0.0)};
    out.bend[0][0] = out.bend[1][1] = S(per);
  }

  template <class S>
  void rolling(const std::array<S, 4>& y, PairTerms<S>& out) const {
    using std::cos, std::sin;
    const S angle = y[0] * (1 / radius) - offset, cosine = cos(angle), sine = sin(angle);
    const S across = y[3] * cosine + y[2] * sine;
    out.value = radius * across;
    out.slope = {y[2] * cosine - y[3] * sine, S(0.0), radius * sine, radius * cosine};
    out.bend[0][0] = (-1 / radius) * across;
    out.bend[0][2] = out.bend[2][0] = cosine;
    out.bend[0][3] = out.bend[3][0] = -sine;
  }

  /// Left normal n and dn/ds.
  template <class S>
  static void normal(const PlaneCurvePoint<S>& at, Pair<S>& n, Pair<S>& rate) {
    using std::sqrt;
    const S per = S(1.0) / sqrt(dot(at.d, at.d));
    const Pair<S> t{per * at.d[0], per * at.d[1]};
    const S along = dot(t, at.dd);
    n = left(t);
    rate = left(Pair<S>{per * (at.dd[0] - along * t[0]), per * (at.dd[1] - along * t[1])});
  }

  template <class S>
  void curve(const std::array<S, 4>& y, const PairPlace& place, PairTerms<S>& out) const {
    S s(place.of_b);
    PlaneCurvePoint<S> b;
    S slope;
    Pair<S> e;
    for (int k = 0;; ++k) {
      b = of_b.at(s);
      e = {y[0] - b.p[0], y[1] - b.p[1]};
      slope = dot(b.dd, e) - dot(b.d, b.d);
      if (k == steps_of<S>()) break;
      s -= dot(b.d, e) / slope;
    }
    Pair<S> n, rate;
    normal(b, n, rate);
    out.value = dot(n, e);
    out.slope = {n[0], n[1], S(0.0), S(0.0)};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j) out.bend[i][j] = -rate[i] * b.d[j] / slope;
  }

  template <class S>
  void contact(const std::array<S, 4>& y, const PairPlace& place, PairTerms<S>& out) const {
    S s_a(place.of_a), s_b(place.of_b);
    PlaneCurvePoint<S> a, b;
    Pair<S> g;
    S r11, r12, r21, r22, per;
    for (int k = 0;; ++k) {
      a = of_a.at(s_a);
      b = of_b.at(s_b);
      const Pair<S> p = turned(y, a.p), d = turned(y, a.d), dd = turned(y, a.dd);
      g = {y[0] + p[0] - b.p[0], y[1] + p[1] - b.p[1]};
      r11 = dot(b.d, d);
      r12 = dot(b.dd, g) - dot(b.d, b.d);
      r21 = dot(left(b.d), dd);
      r22 = dot(left(b.dd), d);
      per = S(1.0) / (r11 * r22 - r12 * r21);
      if (k == steps_of<S>()) break;
      const S r1 = dot(b.d, g), r2 = dot(left(b.d), d);
      s_a -= per * (r22 * r1 - r12 * r2);
      s_b -= per * (r11 * r2 - r21 * r1);
    }
    Pair<S> n, rate;
    normal(b, n, rate);
    const S side(of_b.outward());
    for (std::size_t i = 0; i < 2; ++i) {
      n[i] = side * n[i];
      rate[i] = side * rate[i];
    }
    out.value = dot(n, g);
    out.slope = {n[0], n[1], dot(n, a.p), dot(n, left(a.p))};
    const std::array<S, 4> by_a{S(0.0), S(0.0), dot(n, a.d), dot(n, left(a.d))};
    const std::array<S, 4> by_b{rate[0], rate[1], dot(rate, a.p), dot(rate, left(a.p))};
    const std::array<S, 4> r1{b.d[0], b.d[1], dot(b.d, a.p), dot(b.d, left(a.p))};
    const std::array<S, 4> r2{S(0.0), S(0.0), dot(left(b.d), a.d), dot(b.d, a.d)};
    for (std::size_t j = 0; j < 4; ++j) {
      const S da = -per * (r22 * r1[j] - r12 * r2[j]), db = -per * (r11 * r2[j] - r21 * r1[j]);
      for (std::size_t i = 0; i < 4; ++i) out.bend[i][j] = by_a[i] * da + by_b[i] * db;
    }
  }

  /// In dual numbers of y, then by the chain rule: on the same unknowns whatever the values, as
  /// sparse duals have to.
  void by_chain_rule(const std::array<LocalDual, 4>& y, PairPlace& place,
                     PairTerms<LocalDual>& out) const;
};

}  // namespace momenta
