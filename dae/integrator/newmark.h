#pragma once
// Base of the methods of Newmark's family, on equations of index 3 in q, v; λ, fixed steps:
//
//   q_{n+1} = q_n ∘ exp(h v_n + h² ((½ − β) a_n + β a_{n+1}))
//   v_{n+1} = v_n + h ((1 − γ) a_n + γ a_{n+1})
//   (1 − α_m) a_{n+1} + α_m a_n = (1 − α_f) v̇_{n+1} + α_f v̇_n,   M v̇ + Φ_qᵀλ = Q and Φ = 0 at n + 1
//
// Newton's unknowns are v̇ and λ. With κ = (1 − α_f)/(1 − α_m), δv = hγκ δv̇ and δq = E h²βκ δv̇ the
// matrix is that of the system, ∂F/∂y + ∂F/∂y' diag(c), c = γ/(βh) in the columns of q and 1/(hγκ)
// in those of v. Its kinematic rows are kept and met exactly. Rows of (1a) times h², kinematic rows
// times h, unknowns (δq, h δv, h² δλ): its condition does not grow as h shrinks.
// Φ holds to the Newton tolerance, 10⁻³ of the run's. Of large systems the local matrix is taken
// (system.h), whose further unknowns have no scale.
//
// With a penalty, −β ε stands in place of the zero block, ε = 1/(penalty × effective mass) by row
// of Φ: the step on q is that with Φ_qᵀαΦ_q added to the matrix and αΦ to λ, α = 1/(h²βε), and λ
// grows by α (Φ + Φ_q δq). With projections v and v̇ are then put onto Φ̇ = 0 and Φ̈ = 0 by the same
// matrix: P w + Φ_qᵀν = 0, Φ_q w = −Φ̇ (−Φ̈), P = M + hγ ∂F/∂v + h²β ∂F/∂q at κ = 1.
// Scaling: Bottasso, Bauchau, Cardona, SIAM J. Sci. Comput. 29 (2007) 397-414.

#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/output_cursor.h>
#include <momenta/dae/integrator/system.h>
#include <momenta/dae/integrator/weighted_norm.h>

namespace momenta {

struct NewmarkRule {
  double m = 0, f = 0, gamma = 0.5, beta = 0.25;  ///< α_m, α_f, γ, β; the trapezoidal rule as given
  bool augmented = false;                         ///< with penalty and projections
  double kappa() const { return (1 - f) / (1 - m); }
};

/// A method for MultistepRun.
class Newmark {
 public:
  Newmark(const char* name, const NewmarkRule& rule, DaeSystem& system, SecondOrder& order,
          double t0, const IntegrationOptions& options);

  const char* name() const { return name_; }
  const char* linear_solver() const {
    return local_ != nullptr ? "KLU, local" : linear_solver_name(pattern_);
  }
  double* y() { return now_.y.data(); }
  double* ydot() { return now_.ydot.data(); }
  const Counters& counters() const { return counters_; }

  bool start();
  bool step(double& t, double end, std::string& cause);
  /// Hermite's cubic for q and v; λ along a line.
  bool at(double t, double* y, double*);
  /// Takes the step from the last one's start to an output time; the cubic where that does not
  /// converge.
  bool sample(double t, double* y, double* ydot);

 private:
  /// q, v, v̇, λ, a at one time.
  struct State {
    std::vector<double> y, ydot, a;
  };
  /// The Newton matrix, the version of the local pattern in it, and its step; 0: none yet.
  struct Factored {
    std::unique_ptr<NewtonMatrix<double>> matrix;
    int version = 0;
    double step = 0;
  };

  const JacobianPattern& given() const;
  void lay_out_matrix();
  bool take_local(double t, const State& next, double c_q, double c_v, Factored& matrix);
  bool solve(double t, double h, State& next, Factored& matrix, Counters& counters);
  void guess(State& next);
  void place(double h, State& next);
  void place_rates(State& next);
  bool differentiate(double t, double h, State& next, Factored& matrix, Counters& counters);
  bool correct(double t, double h, State& next, NewtonMatrix<double>& matrix, Counters& counters);
  bool project(double t, State& next, NewtonMatrix<double>& matrix);
  bool evaluation_failed();
  /// b (n) ← the part of A⁻¹ ( b; 0 ) in y.
  void solve_with(NewtonMatrix<double>& matrix, double* b);
  double row_scale(std::size_t row, double h) const {
    return row < nq_ ? h : (row < nq_ + nv_ ? h * h : 1);
  }
  double column_scale(std::size_t column, double h) const {
    return column < nq_ ? 1 : (column < nq_ + nv_ ? h : (column < n_ ? h * h : 1));
  }

  const char* name_;
  NewmarkRule rule_;
  DaeSystem& system_;
  SecondOrder& order_;
  LocalOfSecondOrder* local_;  ///< null: J itself
  FixedGrid grid_;
  WeightedNorm norm_;
  std::size_t nq_, nv_, n_;
  State old_, now_, look_;
  std::vector<double> residual_, correction_, delta_, by_y_, by_rate_;
  std::vector<double> rate_factors_, padded_;  ///< with local_
  int version_ = 0;                            ///< version of the local pattern laid out
  JacobianPattern pattern_;            ///< the system's, with the diagonal of λ where augmented
  std::vector<std::size_t> place_of_;  ///< places of the system's entries in the matrix
  std::vector<std::size_t> diagonal_;  ///< places of the diagonal of λ
  Factored run_matrix_, look_matrix_;
  double t0_, t1_;  ///< the last step [s]
  std::string cause_;
  Counters counters_;
};

/// Runs the method from the system's own start. @throws std::invalid_argument with a sentence for a
/// system that is not of second order, or a step or tolerance that is not positive.
IntegrationResult integrate_newmark(const char* name, const NewmarkRule& rule, DaeSystem& system,
                                    double t0, const std::vector<double>& output_times,
                                    const IntegrationOptions& options, const Observer& observer);

}  // namespace momenta
