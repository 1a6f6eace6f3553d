#pragma once
// (7) factorised with every joint before the loops that hold it, the pivots of σ filtered: the
// matrix of the joints' equations (factor/filtered_matrix.h), or in deep trees that of the bodies'
// (body_matrix.h) by fronts (factor/body_fronts.h).

#include <momenta/dae/mechanism.h>

#include <memory>
#include <vector>

namespace momenta {

class LeavesFirstMatrix {
 public:
  virtual ~LeavesFirstMatrix() = default;

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

std::unique_ptr<LeavesFirstMatrix> joint_matrix(const Mechanism& mechanism);
std::unique_ptr<LeavesFirstMatrix> front_matrix(const Mechanism& mechanism);
/// The matrix that Mechanism::solved_by_bodies() asks for.
std::unique_ptr<LeavesFirstMatrix> leaves_first_matrix(const Mechanism& mechanism);

}  // namespace momenta
