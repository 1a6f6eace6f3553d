#pragma once
// Forces without potential in the transposed derivative, each along one coordinate, sum of
// coordinates or length s and dependent on it alone, Q = −F(s, ṡ) s_q: dampers, friction and stops
// of joints, springs and coordinate springs. With w = F_ṡ,
//
//   Q_u b = −w s_q (s_q·b)                                    is its own transpose
//   (Q_qᵀ − Q_q) b = −w ((s_q·b) s_qq u − (uᵀ s_qq b) s_q)    terms in F and F_s are symmetric
//
// Both are one sweep outward and one inward in dual numbers. Where q moves along u, rates b give
// ṡ = s_q·b + ε uᵀ s_qq b, and the tensions τ = w (s_q·b − ε uᵀ s_qq b) the generalised forces
// −τ s_q(q + ε u): the first as values, the second as derivatives. Along a joint s_qq = 0, and
// Q_u is diagonal; of dampers it is constant.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>

namespace momenta {

/// One object serves one thread; no call allocates.
class LineLosses {
 public:
  virtual ~LineLosses() = default;
  /// Whether the mechanism has such forces.
  virtual bool any() const = 0;
  /// Whether at() asks for q and u.
  virtual bool at_state() const = 0;
  /// by_u = Q_uᵀ b and skew = (Q_qᵀ − Q_q) b at (q, u), nv each, empty without at_state().
  /// O(bodies)
  virtual void at(const Eigen::VectorXd& q, const Eigen::VectorXd& u, const Eigen::VectorXd& b,
                  Eigen::VectorXd& skew, Eigen::VectorXd& by_u) = 0;
  /// dQ = Q_u du (nv each) at the last state. O(bodies)
  virtual void along_rates(const Eigen::VectorXd& du, Eigen::VectorXd& dQ) = 0;
};

/// Null where other forces have no potential (bushings, wrenches, formulas), or drives or user
/// joints move sums or lengths with time. The mechanism has no quaternions.
std::unique_ptr<LineLosses> make_line_losses(const Mechanism& mechanism);

}  // namespace momenta
