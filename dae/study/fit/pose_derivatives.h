#pragma once
// How poses, and what is wanted of them, depend on the parameters θ of the scene and on the place s
// of the swept coordinate. The pose q(θ, s) solves
//
//   F(q; θ, s) = ( D⁻¹ Φ(q; θ) ) = 0,    y = y(q; θ) a coordinate, or a position of a marker;
//                (  c(q) − s   )
//
// by the implicit function theorem, with u for the change of q, q̇ = H u,
//
//   F_q u_j = −∂F/∂θ_j,      dy/dθ_j = y_q u_j + ∂y/∂θ_j
//   F_q u_s = (0, 1),        dy/ds   = y_q u_s
//
// F_q and y_q are those of the sweeps, exact. Partial derivatives by θ at the same q are central
// differences of mechanisms of other θ (core/scalar/sixth_order.h): no pose is solved for again,
// no iteration ends differently. Redundant rows of F are solved together by a QR
// decomposition, as they agree. Where F_q loses rank (dead points, change points) there are no
// derivatives.
// Source: Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, ch. 3.

#include <momenta/dae/study/fit/parametric_mechanism.h>
#include <momenta/dae/study/fit/wanted_poses.h>

#include <vector>

namespace momenta {

/// y of one pose [rad or m], in the order of the quantities. Places the evaluation at q; `markers`:
/// count in the scene.
Eigen::VectorXd quantities_at(Evaluation<double>& e, const Eigen::VectorXd& q,
                              const std::vector<WantedPoses::Quantity>& quantities, int markers);

class PoseDerivatives {
 public:
  /// `sizes` of the parameters, > 0, scale h. The family must outlive it.
  PoseDerivatives(const ParametricMechanism& family, Eigen::VectorXd sizes,
                  std::vector<WantedPoses::Quantity> quantities);

  /// For each pose q, at `values` with their `mechanism`, a matrix quantities × (parameters + 1),
  /// by θ and, last, by s; `rate`: place of the swept coordinate in u. False where F_q loses rank:
  /// `lost` is then the pose. @throws SceneError if a mechanism within 3h fails
  /// Cost: six mechanisms a parameter, and for each pose their Φ and one QR decomposition of F_q
  bool at(const Eigen::VectorXd& values, const Mechanism& mechanism, int rate,
          const std::vector<Eigen::VectorXd>& poses, std::vector<Eigen::MatrixXd>& derivatives,
          std::size_t& lost) const;

 private:
  const ParametricMechanism& family_;
  Eigen::VectorXd sizes_;
  std::vector<WantedPoses::Quantity> quantities_;
};

}  // namespace momenta
