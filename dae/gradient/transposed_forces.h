#pragma once
// The transposed derivatives of the applied forces Q(q, u, t), weights excluded: Q_qᵀ b and Q_uᵀ b.
// Springs, potentials and constant forces have them as derivatives along b, which ṗ includes.
// Dampers, friction, stops, couples, formulas have no potential. Forces of a joint by its own
// coordinate have diagonal ones: one evaluation. With others between points of bodies, the scalar
// bᵀQ is differentiated by each coordinate and rate, eight at a time.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace momenta {

class TransposedForces {
 public:
  /// The mechanism has no quaternions and must outlive it.
  explicit TransposedForces(const Mechanism& mechanism);
  bool any() const { return any_; }
  /// Whether some act at points of bodies: then Q has all forces, else those of joints.
  bool at_points() const { return at_points_; }
  /// Q_qᵀ b and Q_uᵀ b (nv each) of b (nv). @pre any(). O(bodies) with forces of joints alone, else
  /// O(nv bodies)
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
