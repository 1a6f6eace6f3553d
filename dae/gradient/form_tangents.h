#pragma once
// The derivative of a form's right-hand side and of its changes after steps, along directions Y_j =
// dy/dθ_j: a run of an explicit method carries dy/dθ along, stage by stage, and the result is the
// derivative of the run itself, errors included.
//
// On momenta, y = (q, p): (u, σ) solve F = 0 at every stage,
//
//   F = ( M u + Φ_qᵀσ − p,  Φ_q u + Φ_t + βΦ ),      ṗ = R(q, u, σ)                     (7), (8)
//
//   ( M    Φ_qᵀ ) ( du )   ( dp )
//   ( Φ_q  0    ) ( dσ ) = ( 0  ) − ( dF at constant u, σ, p ),      dṗ = dR
//
// On accelerations, y = (q, u), the same with (u̇, λ) and
//
//   F = ( M u̇ + b − Q + Φ_qᵀλ,  Φ̈ + 2αΦ̇ + β²Φ )                                                (3)
//
// dF and dR are those of row_derivatives.h. On momenta, sweeps that carry the mechanism need
// neither matrix nor rows (swept_tangent.h): with ∂F/∂θ = (r1, r2), ∂R/∂θ = r3 at constant q, u, σ,
//
//   Y' = f_y (dq, dp − r1) with r2 in the second row, + (0, r3)
//
// and for θ that change numbers of the tables alone r1, r2, r3 are those of table_tangents.h.
// After a step, in the order of the forms,
//
//   position   q ← q + H δ,  M δ + Φ_qᵀν = 0,  Φ_q δ = −Φ       differentiated as F is
//   velocity   u ← v,  M v + Φ_qᵀν = M u,  Φ_q v = −Φ_t         the same
//   reset      p ← M u;   flip   p ← M u − Φ_qᵀσ                with du, dσ of (7) there
//   quaternions to unit length
//
// The gains κ, α, β are held.

#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/gradient/row_derivatives.h>
#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/gradient/swept_tangent.h>
#include <momenta/dae/gradient/table_tangents.h>

namespace momenta {

class FormTangents {
 public:
  /// @pre the form is in differentiable_forms(). All must outlive it.
  FormTangents(const Mechanism& mechanism, const OdeForm& form,
               const std::vector<OtherParameter>& others);

  /// dẏ (size of y × directions) along Y, right after form.rhs(t, y, ydot). False where the matrix
  /// is singular.
  bool rates(double t, const double* y, const double* ydot, const Eigen::MatrixXd& Y,
             Eigen::MatrixXd& Ydot);
  /// du (nv × directions) of the last rates().
  const Eigen::MatrixXd& velocity() const { return du_; }
  /// u (nv) there.
  const Eigen::VectorXd& u() const { return u_; }
  /// Whether the sweeps are differentiated where no rows fade.
  bool swept() const { return swept_ != nullptr; }
  /// Rows and the matrix alone from now on.
  void by_rows() { swept_.reset(); }

  /// Y after form.after_step(t, …), which took `before` to `after`; Y is that of `before` on entry.
  bool after_step(double t, const double* before, const double* after, Eigen::MatrixXd& Y);

 private:
  bool place(double t, const Eigen::VectorXd& q);
  bool momentum(double t, const Eigen::VectorXd& q, const double* p, const Eigen::MatrixXd& dq,
                const Eigen::MatrixXd& dp, bool of_rates);
  bool sweep(double t, const Eigen::VectorXd& q, const double* p, const Eigen::MatrixXd& dq,
             const Eigen::MatrixXd& dp);
  bool correct_position(double t, Eigen::VectorXd& q, Eigen::MatrixXd& dq);
  bool correct_velocity(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                        const Eigen::MatrixXd& dq, Eigen::MatrixXd& du);
  void normalise(Eigen::VectorXd& q, Eigen::MatrixXd& dq) const;
  Eigen::MatrixXd joined(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                         const Eigen::MatrixXd& c) const;

  const Mechanism& mechanism_;
  const OdeForm& form_;
  RowDerivatives derivatives_;
  StageMatrix matrix_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<SweptTangent> swept_;    ///< null: by rows
  std::unique_ptr<TableTangents> tables_;  ///< null: by rows
  Eigen::Index nq_, nv_, m_;
  bool momenta_, projects_, repeats_;
  Gauge gauge_;
  double leak_, beta_, alpha_;  ///< β of (7); β² and 2α of (3): feedback_
  Eigen::VectorXd u_, sigma_;
  Eigen::MatrixXd du_, dsigma_;
  Eigen::MatrixXd explicit_;  ///< ∂/∂θ of the rows of (7) and, where asked for, (8)
  Eigen::MatrixXd dq_, dx_, dpdot_, along_p_, besides_;
  int faded_ = -1;  ///< redundant rows in the first stage
};

/// "momentum", …: forms whose runs can be differentiated.
const std::vector<std::string>& differentiable_forms();

}  // namespace momenta
