// The forms' right-hand sides from an assembled matrix: factorise at q, form the right-hand side by
// the staged sweeps, solve.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <algorithm>

namespace momenta {
namespace {

class AssembledSolver final : public LoopSolver {
 public:
  AssembledSolver(const Mechanism& mechanism, Evaluation<double>& e)
      : drives_(mechanism.plan().drives),
        by_klu_(!mechanism.solver().filters_pivots()),
        e_(e),
        kkt_(make_kkt(mechanism)),
        r_(static_cast<std::size_t>(mechanism.nv())),
        work_(r_.size()),
        g_(static_cast<std::size_t>(mechanism.m())),
        phi_(g_.size()),
        nu_(g_.size()) {}

  void soften(std::vector<double> compliance) override { compliance_ = std::move(compliance); }

  bool momentum(double t, const double* q, const double* p, const double* centre, double fade,
                double leak, double* u, double* sigma, double* pdot) override {
    if (!factor(t, q, fade)) return false;
    std::copy(p, p + r_.size(), r_.begin());
    std::fill(g_.begin(), g_.end(), 0.0);
    if (drives_) {  // r − prescribed part of M u, −Φ_t
      e_.move(nullptr);
      e_.momenta(nullptr, work_.data());
      for (std::size_t i = 0; i < r_.size(); ++i) r_[i] -= work_[i];
      e_.velocities(g_.data());
      for (double& g : g_) g = -g;
    }
    if (beta_ != 0) {
      e_.positions(phi_.data());
      for (std::size_t i = 0; i < g_.size(); ++i) g_[i] -= beta_ * phi_[i];
    }
    if (!kkt_->solve(r_.data(), g_.data(), centre, u, sigma)) return false;
    if (pdot) {
      e_.move(u);
      e_.momenta(sigma, work_.data());
      e_.momentum_rates(q, u, sigma, leak, pdot);
      if (pushed_)
        for (std::size_t i = 0; i < r_.size(); ++i) pdot[i] += pushed_[i];
      return all_finite(pdot, r_.size());
    }
    return true;
  }

  bool acceleration(double t, const double* q, const double* u, const double* centre, double alpha,
                    double beta, double* udot, double* lambda) override {
    if (!factor(t, q, fade_evaluation)) return false;
    e_.move(u);
    e_.joint_forces(q, u, nullptr, nullptr, r_.data());
    for (double& r : r_) r = -r;
    if (pushed_)
      for (std::size_t i = 0; i < r_.size(); ++i) r_[i] += pushed_[i];
    e_.accelerations(g_.data());
    for (double& g : g_) g = -g;
    if (alpha != 0 || beta != 0) {
      e_.velocities(nu_.data());
      e_.positions(phi_.data());
      for (std::size_t i = 0; i < g_.size(); ++i)
        g_[i] -= 2 * alpha * nu_[i] + beta * beta * phi_[i];
    }
    return kkt_->solve(r_.data(), g_.data(), centre, udot, lambda);
  }

  bool free_velocity(double t, const double* q, const double* p, double* u) override {
    if (!factor(t, q, fade_evaluation)) return false;
    std::fill(g_.begin(), g_.end(), 0.0);
    return kkt_->solve(p, g_.data(), nullptr, u, nu_.data());
  }

  bool position_correction(double t, const double* q, double* delta) override {
    if (!factor(t, q, fade_projection, false)) return false;
    e_.positions(phi_.data());
    for (double& phi : phi_) phi = -phi;
    std::fill(r_.begin(), r_.end(), 0.0);
    return kkt_->solve(r_.data(), phi_.data(), nullptr, delta, nu_.data());
  }

  const std::vector<int>& faded_rows() override {
    rows_ = kkt_->faded_rows();
    return rows_;
  }

  Pivots pivots() const override { return {kkt_->weakest(), kkt_->faded()}; }
  bool remembers() const override { return by_klu_; }

 private:
  bool factor(double t, const double* q, double fade, bool softens = true) {
    kkt_->soften(softens && !compliance_.empty() ? compliance_.data() : nullptr);
    ++solutions_;
    const bool ok = kkt_->factor(e_, t, q, fade);
    singular_joint_ = ok ? -1 : kkt_->singular_joint();
    return ok;
  }

  bool drives_, by_klu_;
  Evaluation<double>& e_;
  std::unique_ptr<Kkt> kkt_;
  std::vector<double> r_, work_, g_, phi_, nu_, compliance_;
  std::vector<int> rows_;
};

}  // namespace

std::unique_ptr<LoopSolver> make_assembled_solver(const Mechanism& mechanism,
                                                  Evaluation<double>& e) {
  return std::make_unique<AssembledSolver>(mechanism, e);
}

}  // namespace momenta
