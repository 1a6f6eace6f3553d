#pragma once
// The start of a file of equations: a consistent point, the differentiation index there by the
// derivative array, the structural index by the Σ-method, and whether the two agree.

#include <momenta/dae/algebra/structure/sigma_method.h>
#include <momenta/dae/analysis/equations/residual.h>
#include <momenta/dae/run/measure/consistent_point.h>

#include <string>
#include <vector>

namespace momenta {

/// The system Jacobian of the Σ-method at a point.
struct SystemJacobian {
  RankFound rank;          ///< with rows and columns equilibrated
  double determinant = 0;  ///< with the equations as written
  /// If singular: combinations without highest derivatives, by equation, largest entry 1.
  std::vector<Eigen::VectorXd> cancelling;
  bool regular(int n) const { return rank.rank == n; }
};

struct EquationStart {
  ConsistentPoint point;
  structure::Offsets offsets;
  std::vector<int> pantelides;  ///< differentiations of each equation
  SystemJacobian jacobian;      ///< at the point; meaningless without one
  std::vector<int> index_of;    ///< by variable, 1 to the index of the system
  std::vector<char> appears;    ///< by variable: der() of it is in an equation
  std::vector<int> part;        ///< by variable: number of its connected part
  /// By variable: the equations that determine it have no freedom.
  std::vector<char> prescribed;
  double time_scale = 1;

  /// Whether structure gives the differentiation index.
  bool structure_holds() const {
    return point.why.empty() && offsets.index == point.found.index &&
           jacobian.regular(static_cast<int>(offsets.equation.size()));
  }
};

/// @throws SceneError where an equation is not finite at the guess. Cost: consistent_point().
EquationStart equation_start(const EquationFile& file);

/// Allowed change of unknowns towards a consistent start: 0 if held; infinite without a derivative
/// in the equations.
Eigen::VectorXd start_scales(const EquationFile& file, const std::vector<char>& appears);

/// F of a file on curves; the file must outlive it.
CurveSystem curve_system(const EquationFile& file);

}  // namespace momenta
