#pragma once
// The transposed derivatives of the applied forces Q(q, u, t), weights excluded: Q_qᵀ b and Q_uᵀ b.
// Dampers, friction, stops, couples, formulas have no potential, so these are no derivatives along
// directions. Those of a joint by its own coordinate are diagonal: one evaluation. With springs,
// dampers, wrenches and formulas at points of bodies, the scalar bᵀQ is differentiated by each
// coordinate and rate, eight at a time.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

class TransposedForces {
 public:
  /// The mechanism has no quaternions and must outlive it.
  explicit TransposedForces(const Mechanism& mechanism);
  /// Whether there are forces beside weights.
  bool any() const { return any_; }
  /// Whether there are some at points of bodies.
  bool at_points() const { return at_points_; }
  /// Of b (nv): Q_qᵀ b and Q_uᵀ b (nv each). @pre any(). O(bodies) with forces of joints alone,
  /// else O(nv bodies)
  void transposed(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                  const Eigen::VectorXd& b, Eigen::VectorXd& by_q, Eigen::VectorXd& by_u);

 private:
  bool any_, at_points_;
  std::unique_ptr<Evaluation<Dual8>> e_;
  std::vector<Dual8> x_, tau_;
};

}  // namespace momenta
