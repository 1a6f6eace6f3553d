#pragma once
// One step of the backward differentiation formula of order k = 1 … 5 on F(t, y, y') = 0, in its
// form of fixed leading coefficient: ω^P, of degree k, goes through the k + 1 newest values; the
// new y_n and ω^P at t_n − h, …, t_n − kh lie on a polynomial of degree k, whose rate at t_n is
//
//   y' = ω^P'(t_n) + (α/h) (y_n − ω^P(t_n)),   α = 1 + 1/2 + … + 1/k,   h = t_n − t_{n−1},
//
// so that Newton's matrix ∂F/∂y + (α/h) ∂F/∂y' depends on the present step alone. With
// a_i = h/(t_n − t_{n−i}) the local error is C (y_n − ω^P(t_n)), C = max(a_{k+1}, |a_{k+1} − α +
// Σ_{i ≤ k} a_i|).
//
// Where that fails its test, stiff components may be to blame. Of a transient of size a and time
// τ << h the past foresees y_n − ω^P = a h/τ. What implicit Euler leaves of a difference e,
//
//   J⁻¹ c ∂F/∂y' e = J⁻¹ (F(t, y, y' + c e) − F(t, y, y')) + O(e²),   c that of J,
//
// is e where h is short beside all times of F, and e τ/h in a component that decays, or swings, in
// τ: one such filter leaves a, and two leave a τ/h, which is what y_n itself has of the transient.
// So errors count as filtered, once, at the start and after a rejection twice, where that leaves
// less than a tenth; terms of other orders in proportion. Weights are those of y_{n−1}: ω^P may be
// as far off.
//
// Where F has a gauge (gauge_symmetry.h), all norms are of what moves, and gauge reset shifts the
// past before each step so that the newest σ is zero: the step is then the same, but for rounding,
// whatever constant was added to σ before. Newton stops at a fraction of the tolerance, on the rate
// at which its corrections shrink, or where they shrink no more and are within a tenth of the
// tolerance: rounding.
//
// Source: Brenan, Campbell, Petzold, Numerical Solution of Initial-Value Problems in
// Differential-Algebraic Equations, ch. 5; the filter: Shampine, Baca, Numer. Math. 43 (1984)
// 171-183; Hairer, Wanner, Solving Ordinary Differential Equations II, IV.8.

#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/integrator/past_values.h>

#include <array>
#include <vector>

namespace momenta {

class BdfStep {
 public:
  static constexpr int highest_order = 5;
  enum class Outcome { solved, not_converged, singular, not_evaluated, not_finite };

  /// Takes a system that has started.
  BdfStep(DaeSystem& system, double rtol, double atol);

  const char* linear_solver() const { return newton_.linear_solver(); }
  /// Forgets the past; y and y' at t, put into gauge σ = 0 where the gauge is reset.
  void begin(double t, double* y, double* ydot);
  PastValues& past() { return past_; }
  const PastValues& past() const { return past_; }

  /// A step is judged at a share of the tolerance; if it fails, by what the filters leave.
  struct Test {
    double share = 1;
    int filters = 1;
  };
  /// Solves for y at t1 > past().time(0), by `order` < past().count(), or 1 after begin(). Makes
  /// derivatives anew where `renew`, or where those at hand are of too different a step.
  Outcome attempt(double t1, int order, bool renew, Test test);
  bool derivatives_are_new() const { return renewed_; }
  /// Local error of the last attempt, over its tolerance.
  double error() const { return error_; }
  /// After an attempt: ‖h^(j+1) y^(j+1)‖ over the tolerance, from y[t_n, …, t_{n−j−1}]; j <
  /// past().count().
  double term(int j);
  /// Adds y_n and y'_n to the past.
  void accept();

  const std::vector<double>& y() const { return y_; }
  const std::vector<double>& ydot() const { return ydot_; }
  const Counters& counters() const { return counters_; }

 private:
  /// Newton stops at this fraction of the tolerance, as IDA does here (ida.cpp).
  static constexpr double newton_fraction = 0.03;
  static constexpr int most_corrections = 5;
  /// Corrections that shrink by less have converged, to rounding, or never will.
  static constexpr double slowest = 0.9, rounding = 0.1;
  /// Least contraction counted: a fresh matrix contracts faster than an old one.
  static constexpr double fastest = 0.02;
  /// Share left by a filter above which an error is not stiff.
  static constexpr double stiff = 0.1;
  /// Change of c up to which a matrix serves.
  static constexpr double most_change = 1.25;

  Outcome correct(double t1, double c);
  /// Norm of what `filters` filters leave of y_n − ω^P(t_n). Costs two evaluations of F, a solution
  /// and a norm; each further filter one evaluation and a solution.
  double left(int filters);
  double norm(const double* e);
  double by_component(const double* e) const;
  void weigh(double t, double share);

  DaeSystem& system_;
  GaugeSymmetry* gauge_;  ///< null: norms by component
  DaeNewton newton_;
  PastValues past_;
  double rtol_, atol_;
  std::size_t n_;
  std::vector<double> y_, ydot_, predicted_, change_, delta_, weight_, begin_ydot_, rate_, rest_;
  double t1_ = 0, h_ = 0, error_ = 0;
  std::array<double, highest_order + 2> terms_{};  ///< terms of the last attempt; −1: not yet known
  double left_ = 1;        ///< share of the last attempt's error that its filter left
  double term_ratio_ = 0;  ///< norm of what moves over that of q alone, in the last attempt
  double made_for_ = 0;    ///< c of the matrix; 0: none
  double contraction_ = 0;  ///< contraction of Newton's corrections with this matrix, as ρ/(1 − ρ)
  bool straight_ = false;  ///< the value one back stands for y' at the start
  bool renewed_ = false;
  Counters counters_;
};

}  // namespace momenta
