#pragma once
// The transposed derivatives of the applied forces Q(q, u, t), weights excluded: Q_qᵀ b and Q_uᵀ b.
// Of springs, potentials and constant forces they are derivatives along b, and those are left to
// ṗ. Dampers, friction, stops, couples, formulas have no potential. Those of a joint by its own
// coordinate are diagonal: one evaluation. With others between points of bodies, the scalar bᵀQ is
// differentiated by each coordinate and rate, eight at a time.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

class TransposedForces {
 public:
  /// The mechanism has no quaternions and must outlive it.
  explicit TransposedForces(const Mechanism& mechanism);
  /// Whether there are forces without potential.
  bool any() const { return any_; }
  /// Whether there are some at points of bodies: then Q are all forces, else those of joints.
  bool at_points() const { return at_points_; }
  /// Of b (nv): Q_qᵀ b and Q_uᵀ b (nv each). @pre any(). O(bodies) with forces of joints alone,
  /// else O(nv bodies)
  void transposed(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                  const Eigen::VectorXd& b, Eigen::VectorXd& by_q, Eigen::VectorXd& by_u);
  /// dQ (nv) along dq, du (nv each). @pre any(). O(bodies)
  void along(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
             const Eigen::VectorXd& dq, const Eigen::VectorXd& du, Eigen::VectorXd& dQ);

 private:
  void still(const Eigen::VectorXd& q, const Eigen::VectorXd& u);

  bool any_ = false, at_points_ = false;
  std::unique_ptr<Evaluation<Dual8>> e_;
  std::vector<Dual8> x_, tau_;
};

}  // namespace momenta
