// The forms' right-hand sides from the sweeps that carry loops. Springs between points of bodies
// and wrenches go with them in a plane; in space they take a sweep of their own, where a scene has
// some.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

class SweepSolver final : public LoopSolver {
 public:
  SweepSolver(const Mechanism& mechanism, Evaluation<double>& e)
      : mechanism_(mechanism),
        e_(e),
        sweeps_(mechanism.solver().sweeps()),
        carried_(mechanism.has_body_forces() && mechanism.plan().planar &&
                 !mechanism.has_forces_apart()),
        apart_(mechanism.has_body_forces() && !carried_),
        has_tau_(apart_ || mechanism.has_joint_forces()),
        zero_(static_cast<std::size_t>(mechanism.nv())),
        tau_(zero_.size()),
        nu_(static_cast<std::size_t>(mechanism.m())) {
    rows_.reserve(nu_.size());
    for (const auto& b : mechanism.tree().bodies) place_of_body_.push_back(b.nv > 0 ? b.u : -1);
  }

  /// A compliance by row needs the rows of the loops as the scene pairs them.
  void soften(std::vector<double> compliance) override {
    compliance_ = std::move(compliance);
    if (mechanism_.solver().pairs_anew()) sweeps_ = mechanism_.solver().sweeps_as_given();
  }

  bool momentum(double t, const double* q, const double* p, const double* centre, double fade,
                double leak, double* u, double* sigma, double* pdot) override {
    RightSide<double> right = of_rows(centre, fade);
    right.positions = beta_;
    right.leak = leak;
    right.rates = pdot != nullptr;
    right.body_forces = carried_ && pdot;
    of_momentum_ = true;
    const bool ok = noted(sweeps_->momentum(t, q, p, right, u, sigma, pdot));
    if (sweeps_->weak_looped_branch())
      return by_matrix().momentum(t, q, p, centre, fade, leak, u, sigma, pdot);
    if (!ok) return false;
    if (pdot && apart_) {
      e_.body_forces(t, q, u, tau_.data());
      for (std::size_t i = 0; i < tau_.size(); ++i) pdot[i] += tau_[i];
    }
    if (pdot && pushed_)
      for (std::size_t i = 0; i < tau_.size(); ++i) pdot[i] += pushed_[i];
    return all_finite(u, zero_.size()) && all_finite(sigma, nu_.size()) &&
           (!pdot || all_finite(pdot, zero_.size()));
  }

  bool acceleration(double t, const double* q, const double* u, const double* centre, double alpha,
                    double beta, double* udot, double* lambda) override {
    RightSide<double> right = of_rows(centre, fade_evaluation);
    right.alpha = alpha;
    right.beta = beta;
    right.body_forces = carried_;
    if (has_tau_) e_.applied_forces(t, q, u, tau_.data(), apart_);
    const double* tau = has_tau_ ? tau_.data() : pushed_ ? pushed_ : zero_.data();
    if (has_tau_ && pushed_)
      for (std::size_t i = 0; i < tau_.size(); ++i) tau_[i] += pushed_[i];
    of_momentum_ = false;
    const bool ok = noted(sweeps_->acceleration(t, q, u, tau, right, udot, lambda));
    if (sweeps_->weak_looped_branch())
      return by_matrix().acceleration(t, q, u, centre, alpha, beta, udot, lambda);
    if (!ok) return false;
    return all_finite(udot, zero_.size()) && all_finite(lambda, nu_.size());
  }

  bool free_velocity(double t, const double* q, const double* p, double* u) override {
    RightSide<double> right;
    right.fade = fade_beside(fade_evaluation, mechanism_.masses_apart());
    right.drives = false;
    of_momentum_ = true;
    const bool ok = noted(sweeps_->momentum(t, q, p, right, u, nu_.data(), nullptr));
    if (sweeps_->weak_looped_branch()) return by_matrix().free_velocity(t, q, p, u);
    if (!ok) return false;
    return all_finite(u, zero_.size());
  }

  bool position_correction(double t, const double* q, double* delta) override {
    RightSide<double> right;
    right.fade = fade_projection;
    right.drives = false;
    right.positions = 1;
    of_momentum_ = true;
    const bool ok = noted(sweeps_->momentum(t, q, zero_.data(), right, delta, nu_.data(), nullptr));
    if (sweeps_->weak_looped_branch()) return by_matrix().position_correction(t, q, delta);
    if (!ok) return false;
    return all_finite(delta, zero_.size());
  }

  const std::vector<int>& faded_rows() override {
    rows_.clear();
    if (!compliance_.empty()) return rows_;
    rows_.resize(nu_.size());
    rows_.resize(sweeps_->faded_rows(rows_.data(), of_momentum_));
    return rows_;
  }

  Pivots pivots() const override {
    const LoopedSweeps::Pivots p = sweeps_->pivots(of_momentum_);
    return {p.weakest * fade_evaluation, compliance_.empty() ? p.faded : 0};
  }
  bool remembers() const override { return matrix_ && matrix_->remembers(); }

 private:
  RightSide<double> of_rows(const double* centre, double fade) const {
    RightSide<double> right;
    right.centre = centre;
    if (compliance_.empty())
      right.fade = fade_beside(fade, mechanism_.masses_apart());
    else
      right.compliance = compliance_.data();
    return right;
  }

  /// Solver for poses where a folded branch loses rank: its loops cannot close by themselves, and
  /// the body they fold into may seem to have no inertia.
  LoopSolver& by_matrix() {
    if (!matrix_) {
      matrix_ = make_assembled_solver(mechanism_, e_);
      matrix_->stabilise(beta_);
      if (!compliance_.empty()) matrix_->soften(compliance_);
    }
    matrix_->push(pushed_);
    return *matrix_;
  }

  bool noted(bool ok) {
    ++solutions_;
    singular_joint_ = -1;
    if (!ok && !sweeps_->weak_looped_branch())
      singular_joint_ = place_of_body_[static_cast<std::size_t>(sweeps_->singular_joint())];
    return ok;
  }

  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  std::unique_ptr<LoopSolver> matrix_;
  std::unique_ptr<LoopedSweeps> sweeps_;
  bool carried_, apart_;  ///< forces at points of bodies: by these sweeps, or by one of their own
  bool has_tau_;
  std::vector<double> zero_, tau_, nu_, compliance_;
  std::vector<int> rows_, place_of_body_;
  bool of_momentum_ = true;
};

}  // namespace

std::unique_ptr<LoopSolver> make_sweep_solver(const Mechanism& mechanism, Evaluation<double>& e) {
  return std::make_unique<SweepSolver>(mechanism, e);
}

}  // namespace momenta
