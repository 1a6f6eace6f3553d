#pragma once
// ∂f/∂y of y' = f(t, y) for Newton's methods, and their linear systems,
//
//   w − s ∂f/∂y w = r,      s real or complex.
//
// Where f and further unknowns x solve sparse equations F(t, (y, x), f) = 0 (OdeSystem::local) f is
// not differentiated itself. With G₀ = ∂F/∂(y, x, z) and G₁ = ∂F/∂f of their local matrix, z its
// further unknowns, δf = ∂f/∂y w is that of G₀ (w, δx, δz) + G₁ δf = 0; from s δf = w − r
//
//   (s G₀ + G₁) (w, δx, δz) = G₁ r,
//
// by KLU. Elsewhere G₀ = −∂f/∂y by forward differences and G₁ = 1, both dense.

#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/system.h>

#include <memory>
#include <string>
#include <vector>

namespace momenta {

class OdeSlopes {
 public:
  explicit OdeSlopes(OdeSystem& system)
      : system_(system), f_(static_cast<std::size_t>(system.size())) {}

  /// Evaluates at (t, y). `rate` [1/s], of the size of 1/s above, balances G₀ and G₁ in one
  /// evaluation. False: `cause` says why. Dense n + 1 right-hand sides, else O(entries).
  bool evaluate(double t, const double* y, double rate);
  const std::string& cause() const { return cause_; }
  long evaluations() const { return evaluations_; }  ///< evaluations of f

  int size() const { return system_.size(); }
  // After the first evaluate():
  int unknowns() const;                    ///< size of y, x and z
  const JacobianPattern& pattern() const;  ///< pattern of G₀ and G₁; empty: dense by columns
  int version() const;                     ///< version of the pattern, ascending
  const std::vector<double>& by_y() const { return by_y_; }        ///< G₀
  const std::vector<double>& by_rate() const { return by_rate_; }  ///< G₁

  /// Names in results.
  const char* linear_solver() const { return local_ ? "KLU, local" : "dense LU"; }
  const char* jacobian() const { return local_ ? "dual numbers" : "difference quotient"; }

 private:
  bool rates(double t, const double* y, std::vector<double>& f);
  bool of_equations(double t, const double* y, double rate);
  bool by_differences(double t, const double* y);

  OdeSystem& system_;
  bool asked_ = false;              ///< the system was asked for its local matrix
  LocalJacobian* local_ = nullptr;  ///< null: differences
  JacobianPattern dense_;
  std::vector<double> by_y_, by_rate_, f_, moved_, y_;
  std::string cause_;
  long evaluations_ = 0;
};

/// The system above at one s, real or complex.
template <class Scalar>  // double or std::complex<double>
class Resolvent {
 public:
  /// Factorises slopes as last evaluated; they must outlive it. False: singular or not finite.
  bool factor(const OdeSlopes& slopes, Scalar s);
  /// Turns r (n) into w. Allocates nothing.
  void solve(Scalar* r);

 private:
  const OdeSlopes* slopes_ = nullptr;
  int version_ = -1;  ///< version of the pattern in matrix_
  std::unique_ptr<NewtonMatrix<Scalar>> matrix_;
  std::vector<Scalar> work_;
};

}  // namespace momenta
