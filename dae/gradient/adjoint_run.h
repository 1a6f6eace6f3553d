#pragma once
// A recorded run backwards. A step y' = y + h Σ b_i k_i, k_i = f(t_i, y + h Σ a_ij k_j), has the
// transposed derivative
//
//   w_i = h b_i λ' + h Σ_{j>i} a_ji m_j,  m_i = f_yᵀ w_i,
//   λ = λ' + Σ m_i,  dJ/dθ += Σ f_θᵀ w_i                                                      (6)
//
// with stages from the last to the first, kept by the run or computed again from the start of the
// step; changes after the step come first. Where the first stage is the last of the step before,
// taken ahead of a correction of y, its m_1 goes there. With J = ∫ g dt by the stages, h b_i g_u
// joins the part of q in w_i, since dq̇ = du, and h b_i g_q the product. This is the derivative of
// the very steps: dJ/dθ = λ(0)ᵀ dy(0)/dθ + Σ. Source: Hager, Runge-Kutta methods in optimal control
// and the transformed adjoint system, Numer. Math. 87 (2000); Griewank, Walther, Evaluating
// Derivatives.

#include <momenta/dae/gradient/form_adjoint.h>
#include <momenta/dae/gradient/functional.h>
#include <momenta/dae/gradient/recorded_run.h>
#include <momenta/dae/integrator/butcher_tableau.h>

#include <functional>

namespace momenta {

class AdjointRun {
 public:
  /// A run of this form by this method with the functional g at the end or, `integral`, over it.
  /// All must outlive it.
  AdjointRun(OdeForm& form, FormAdjoint& adjoint, FunctionalSlopes& g, bool integral,
             const std::string& method, Eigen::Index parameters);

  /// J of the run, which ended at (t, y).
  double value() const { return value_; }
  /// dJ/dy(0), in the order of y.
  const Eigen::VectorXd& by_start() const { return lambda_; }
  /// dJ/dθ at constant y(0).
  const Eigen::VectorXd& by_parameters() const { return by_parameters_; }
  /// Products with f_yᵀ so far.
  long products() const { return products_; }

  /// Goes back from the end (t, y); `going(t)` after each step, false ends it. False without
  /// derivatives: failure().
  bool back(const RecordedRun& run, double t, const double* y,
            const std::function<bool(double)>& going);
  const std::string& failure() const { return failure_; }

 private:
  bool end(double t, const double* y);
  bool step(const RecordedRun& run, std::size_t i, const double* behind);
  bool stages_again(const RecordedRun::Step& step, const double* start, const double* first);
  bool after_step(double t, const Eigen::VectorXd& y, const double* behind);
  bool rhs(double t, const double* y, double* ydot, AdjointState& at);
  bool times_slopes(std::size_t stage);
  bool fail_at(double t, const std::string& why);

  OdeForm& form_;
  FormAdjoint& adjoint_;
  FunctionalSlopes& g_;
  bool integral_;
  ButcherTableau tableau_;
  double value_ = 0;
  long products_ = 0;
  std::string failure_;
  Eigen::VectorXd lambda_, by_parameters_, y_, w_, product_, by_q_, by_u_, by_theta_;
  Eigen::VectorXd ahead_;     ///< m_1 of the step behind, if it belongs to the end of this one
  Eigen::VectorXd u_behind_;  ///< u where the step behind begins; empty: not known
  Eigen::MatrixXd k_, m_;     ///< size of y × stages
  std::vector<AdjointState> stages_;  ///< stages of the step under way
};

}  // namespace momenta
