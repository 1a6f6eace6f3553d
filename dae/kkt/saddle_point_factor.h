#pragma once
// (7) factorised with every joint before the loops that hold it, the pivots of σ filtered: the
// matrix of the joints' equations (factor/filtered_factor.h), or in deep trees that of the bodies'
// (body_matrix.h) by fronts (factor/body_fronts.h).

#include <momenta/dae/mechanism/mechanism.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace momenta {

class SaddlePointFactor {
 public:
  virtual ~SaddlePointFactor() = default;

  /// Factorises at (t, q), where `e` is placed. `compliance`: E (m), with which no row fades; null:
  /// 0. `fade`: how weak a pivot may be relative to its group's scale. False where a pivot of u, at
  /// place singular_joint(), is not positive or a number is not finite. No allocation.
  virtual bool factor(Evaluation<double>& e, double t, const double* q, const double* compliance,
                      double fade) = 0;
  virtual void solve(double* x) = 0;  ///< x (nv + m) ← A⁻¹ x
  /// Pivot w of each row (m) in the last factor(), and where it fades; 0: it does not.
  virtual const std::vector<double>& pivots() const = 0;
  virtual const std::vector<double>& fading() const = 0;
  /// Values of Φ_q there, in the order of Mechanism::constraint_pattern().
  virtual const double* constraint() = 0;
  virtual int singular_joint() const = 0;
};

std::unique_ptr<SaddlePointFactor> joint_matrix(const Mechanism& mechanism);
std::unique_ptr<SaddlePointFactor> front_matrix(const Mechanism& mechanism);
/// The one of them that solved_by_bodies() asks for.
std::unique_ptr<SaddlePointFactor> saddle_point_factor(const Mechanism& mechanism);

// Error of eliminating every joint before the loops that hold it. Where a joint moves next to no
// mass m, a row of its loop has a pivot of 1/m, and the rows that close after it have what the
// product of that one leaves,
//
//   w' = W_kk − W_ki f(w_i) W_ik:
//
// rounding of w' is ε of the larger, and the filter's τ (front.h) is a share of the mobility along
// the row, the light joint's. Both make the impulse of the row, and by it Φ_q v, off by
//
//   ε s/w' + (τ/w')⁴,         s = Σ M_j⁻¹|C_n|².
//
// How much that is depends on the light joint's place, so it is measured. A motion v₀ is put onto
// the loops, M v + Φ_qᵀσ = M v₀, Φ_q v = 0, and the error of each row taken relative to its terms:
//
//   ω = max |M (v − v₀) + Φ_qᵀσ|_i / (M_ii (|v_i| + |v₀_i|) + Σ|Φ_ki σ_k|),
//           |Φ_q v|_k / Σ|Φ_ki|(|v_i| + |v₀_i|).
//
// To ω the solution is that of a mechanism whose numbers differ by as much. A row that is
// redundant, or lost at a singular pose, holds with the others and has no part in ω. Next to such a
// pose rows fade by half, whatever the masses are: so the least ω of three poses counts, the closed
// start and two that motions lead to from there. ω at a pose is the largest of a few motions, as
// roundings of one may cancel. Source: Oettli, Prager, Numer. Math. 6 (1964) 405.

/// The ω that a run at the tightest tolerances of use does not notice.
inline constexpr double most_elimination_error = 1e-9;

/// v (nv) and σ (m) of M v + Φ_qᵀσ = p, Φ_q v = −βΦ at q, drives at rest. False: not solved; none:
/// solved by other means.
using LeavesFirst = std::function<std::optional<bool>(const double* q, const double* p, double beta,
                                                      double fade, double* v, double* sigma)>;

/// ω, of the first pose where it is small enough; infinite where there is no solution. A few
/// solutions and O(bodies + length of all loops).
double elimination_error(const Mechanism& mechanism, Evaluation<double>& e,
                         const LeavesFirst& solve);

}  // namespace momenta
