#pragma once
// The nonlinear system of radau5_stages.h by Newton's method with derivatives of each stage, in one
// matrix of 3n rows,
//
//   δ_ij ∂F/∂y|_i + (A⁻¹)_ij / h ∂F/∂y'|_i,
//
// for equations whose structure is not regular (structured_system.h): the simplified iteration need
// not converge on them, however short the step. What it misses of ∂F/∂y' at the stages, of order h,
// comes c times with c/h: with a + η t b = f, a' + η t b' + (1 + η) b = g it contracts by
// 2η/(1 + η), whatever h is.

#include <momenta/dae/solver/radau5_stages.h>

namespace momenta::radau5 {

class WholeStages {
 public:
  explicit WholeStages(DaeSystem& system);

  /// As Stages::solve(); `rate_scale` as in Stages::differentiate().
  Outcome solve(double t, double h, double rate_scale, const double* y, const WeightedNorm& norm,
                double fraction, StageValues& z);

  long evaluations = 0, iterations = 0, jacobians = 0;

 private:
  bool differentiate(double t, double h, double rate_scale, const double* y, const StageValues& z);
  static JacobianPattern pattern_of(const JacobianPattern& one, long n);
  void place(double h, const double* y, const StageValues& z, std::size_t i);

  DaeSystem& system_;
  std::size_t n_;
  Eigen::Matrix3d inverse_;
  JacobianPattern pattern_;
  std::unique_ptr<NewtonMatrix<double>> matrix_;
  std::vector<double> by_y_, by_rate_, argument_, rate_, r_;
};

}  // namespace momenta::radau5
