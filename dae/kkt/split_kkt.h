#pragma once
// The system of half-explicit stages: forces act where the stage is, the constraint is met where it
// leads,
//
//   ( M(q)     Φ_q(q)ᵀ ) ( x )   ( r )
//   ( Φ_q(q̄)  −ε      ) ( s ) = ( g − ε s_0 )
//
// No symmetry is left, so it is one LU: dense up to 60 unknowns, KLU above. ε, of redundant loops
// alone, keeps it regular; s_0, the multiplier of the stage before, keeps what ε costs small.

#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <array>
#include <memory>
#include <vector>

namespace momenta {

class SplitKkt {
 public:
  /// `compliance`: ε by row (m), or empty for none.
  SplitKkt(const Mechanism& mechanism, std::vector<double> compliance);

  /// Takes M and Φ_qᵀ at the place of `e`.
  void act_at(Evaluation<double>& e);
  /// Takes Φ_q at the place of `e`.
  void meet_at(Evaluation<double>& e);
  /// Φ_q(q̄) x (m).
  void rates(const double* x, double* result) const;
  /// False where the matrix is singular or not finite. O((nv + m)³) dense, O(fill) sparse.
  bool factor();
  /// x (nv), s (m) of r (nv; null: zero), g (m).
  void solve(const double* r, const double* g, double* x, double* s);
  /// g += factor · ε s (m).
  void add_compliance(double factor, const double* s, double* g) const;

 private:
  const KktPattern& entries_;
  std::size_t nv_, m_;
  std::vector<double> compliance_, mass_, constraint_, right_;
  JacobianPattern pattern_;
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  /// Places among the matrix's values: of M's two triangles, of Φ_q in its two blocks, of −ε.
  std::vector<std::array<std::size_t, 2>> mass_at_, constraint_at_;
  std::vector<std::size_t> compliance_at_;
};

}  // namespace momenta
