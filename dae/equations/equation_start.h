#pragma once
// What a file of equations is at its start: a consistent point, the differentiation index there by
// the derivative array, the structural index by the Σ-method, and whether the two go together.

#include <momenta/dae/equations/residual.h>
#include <momenta/dae/measure/consistent_point.h>
#include <momenta/dae/structure/sigma_method.h>

#include <string>
#include <vector>

namespace momenta {

/// The system Jacobian of the Σ-method at a point.
struct SystemJacobian {
  RankFound rank;          ///< of its rows and columns equilibrated
  double determinant = 0;  ///< as the equations are written
  /// Where it is singular: combinations of equations in which no highest derivative is left, by
  /// equation, largest entry 1.
  std::vector<Eigen::VectorXd> cancelling;
  bool regular(int n) const { return rank.rank == n; }
};

struct EquationStart {
  ConsistentPoint point;
  structure::Offsets offsets;
  std::vector<int> pantelides;  ///< differentiations of each equation
  SystemJacobian jacobian;      ///< at the point; of no meaning where there is none
  std::vector<int> index_of;    ///< of each variable, 1 to the index: how rough its errors are
  std::vector<char> appears;    ///< whether der() of it stands in an equation
  std::vector<int> part;        ///< of each variable: one number for those that hang together
  /// Whether the equations that give each variable have no freedom.
  std::vector<char> prescribed;
  double time_scale = 1;

  /// Whether structure gives the differentiation index.
  bool structure_holds() const {
    return point.why.empty() && offsets.index == point.found.index &&
           jacobian.regular(static_cast<int>(offsets.equation.size()));
  }
};

/// @throws SceneError where an equation is not finite at the guess. Cost of consistent_point().
EquationStart equation_start(const EquationFile& file);

/// How much unknowns may change on the way to a consistent start: 0 what is held; infinite what has
/// no derivative in the equations and is found from the rest.
Eigen::VectorXd start_scales(const EquationFile& file, const std::vector<char>& appears);

/// F of a file on curves; the file must outlive it.
CurveSystem curve_system(const EquationFile& file);

}  // namespace momenta
