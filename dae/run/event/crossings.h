#pragma once
// Zeros of a number g(t) along a run, step by step, g read off the integrator's dense output.
//
// On an interval g is taken at the Chebyshev points t_i = m − h cos(πi/8), i = 0 … 8. Their
// polynomial p has the coefficients
//
//   c_k = ¼ Σ" g(t_i) cos(πik/8)       (Σ": the first and the last term halved),
//
// and g is resolved where |c₇| + |c₈| ≤ 10⁻³ max |c_k|, k ≥ 1. Where it is not, the interval is
// halved, six times at most. Of a resolved interval p is then looked at in 33 places: g is
// evaluated where p changes its sign between two of them, and where |p| has a minimum below 2 % of
// its range, from which the minimum of |g| is searched: two roots next to each other are found by g
// beyond zero between them. Between neighbours of opposite signs the root is bracketed.
//
// Missed can be: two roots of an interval between whose nine points g turns back more often
// than p shows, or beyond the sixth halving. No crossings: zeros that g touches; the start
// of the run where it is zero there, to 10⁻¹² of its size; a pole, where |g| grows on both sides. A
// jump through zero is one. Where a correction after a step moves g through zero, the crossing is
// at the end of the step, and one that is moved back is told once. Source of the resolution by
// trailing coefficients: J. P. Boyd, Solving Transcendental Equations, SIAM 2014, chapters 2, 3.

#include <momenta/dae/integrator/memory.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace momenta {

/// A root of g, and whether g is positive after it.
struct Crossing {
  double t = 0;
  bool up = false;
};

/// Crossings of one number along one run.
class Crossings {
 public:
  static constexpr std::size_t points = 9;  ///< per interval
  using Values = std::array<double, points>;

  /// Roots are found to within `tolerance` [s] and the rounding of t.
  explicit Crossings(double tolerance) : tolerance_(tolerance) {}

  /// Point i of [t0, t1].
  static double point(double t0, double t1, std::size_t i);
  /// Adds the crossings of the step that was just taken, in their order. `at_points`: g at its
  /// points. A g that is not a number has no crossing there, nor across.
  void step(double t0, double t1, const Values& at_points, const std::function<double(double)>& g,
            std::vector<Crossing>& found);
  /// Begins anew at the next step, where g is zero and counts as coming from below: a g above zero
  /// at once is a crossing there.
  void restart_below_zero(double t) {
    restart();
    begun_ = at_zero_ = true;
    zero_ = t;
    sign_ = -1;
  }
  /// Sign of g where it was last nonzero; 0: not known.
  int sign() const { return sign_; }
  /// Begins anew at the next step, before which g had this sign: another sign at once is a crossing
  /// there.
  void restart_with(int sign) {
    restart();
    begun_ = sign != 0;
    sign_ = sign;
  }
  /// Begins anew at the next step, as at the start.
  void restart() { *this = Crossings(tolerance_); }
  /// Saves or restores what lasts from step to step.
  void carry(Memory& memory);

 private:
  struct Place {
    double t, g;
  };
  void interval(double t0, double t1, const Values& values, int halvings);
  void look_at(double t0, double t1, const Values& values);
  void take(double t, double g);
  void cross(double t0, double g0, double t1, double g1, bool up);
  /// Last zero of g between a place where it is zero and one where it is not.
  double end_of_zero(double zero, double after) const;
  /// The first place with a value on the way from `none`, where g has none, to `some`.
  Place first_value(double none, double some) const;
  /// The minimum of sign · g between two places, or the first place found beyond zero.
  Place lowest(double t0, double t1, double sign) const;

  double tolerance_;
  bool begun_ = false;
  int sign_ = 0;
  bool at_zero_ = false;       ///< g has been zero since
  double zero_ = 0;            ///< last place looked at, where g is zero
  std::optional<Place> last_;  ///< last place of this step where g was nonzero
  const std::function<double(double)>* g_ = nullptr;
  std::vector<Crossing>* found_ = nullptr;
  std::vector<Place> places_;
};

}  // namespace momenta
