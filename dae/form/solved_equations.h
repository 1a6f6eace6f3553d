#pragma once
// The equations that an ODE form's f solves, of a DAE form of index 1 in the same q and p, or q and
// u, with its multipliers as unknowns,
//
//   F(t, (q, p, σ), (q̇, ṗ)) = 0      or      F(t, (q, u, λ), (q̇, u̇)) = 0.
//
// ∂f/∂y, M and Φ_q eliminated, is full; the matrix of F is local (local_rows.h).

#include <momenta/dae/form/dae_form.h>

#include <functional>

namespace momenta {

/// @see OdeSystem::local
class SolvedEquations final : public LocalJacobian {
 public:
  using Maker = std::function<std::unique_ptr<Form>()>;
  /// `make`: makes the DaeForm at first use; `multipliers`, of the last right-hand side: kept by
  /// reference.
  SolvedEquations(Maker make, const std::vector<double>& multipliers)
      : make_(std::move(make)), multipliers_(multipliers) {}

  bool evaluate(double t, const double* y, const double* f, double c) override;
  /// Before the first evaluation: the pattern at the start.
  const JacobianPattern& pattern() const override;
  const std::vector<double>& values() const override { return form_->local_jacobian().values(); }
  int version() const override { return form_->local_jacobian().version(); }

 private:
  void make() const;

  Maker make_;
  const std::vector<double>& multipliers_;
  mutable std::unique_ptr<DaeForm> form_;  ///< null until asked for
  mutable std::vector<double> y_, ydot_;   ///< with multipliers
};

}  // namespace momenta
