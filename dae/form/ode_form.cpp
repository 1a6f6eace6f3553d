#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/form/solved_equations.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace momenta {
namespace {

/// Entries of a dense matrix solved in the time of one of a local matrix, whose factors fill in.
constexpr double dense_entries = 3;

}  // namespace

OdeForm::OdeForm(std::string name, const Mechanism& mechanism, const FormOptions& options,
                 const Start& start)
    : name_(std::move(name)),
      mechanism_(mechanism),
      options_(options),
      e_(mechanism.evaluation<double>()),
      sizes_(mechanism, start),
      scale_(sizes_.q) {
  const auto nv = static_cast<std::size_t>(mechanism.nv()),
             m = static_cast<std::size_t>(mechanism.m());
  always_faded_ = mechanism.m();
  if (has_loops()) solver_ = make_loop_solver(mechanism, *e_);
  friction_ = bearing_friction(mechanism);
  u_.resize(nv);
  delta_.resize(nv);
  work_.resize(nv);
  multipliers_.assign(m, 0.0);
  centre_.assign(m, 0.0);
  correction_.assign(static_cast<std::size_t>(mechanism.nq()), 0.0);
  scale_.insert(scale_.end(), sizes_.u.begin(), sizes_.u.end());
}

void OdeForm::solves(std::function<std::unique_ptr<Form>()> equations) {
  solved_ = std::make_unique<SolvedEquations>(std::move(equations), multipliers_);
}

LocalJacobian* OdeForm::local() {
  if (!solved_) return nullptr;
  const double dense = static_cast<double>(size()) * size();
  const auto entries = static_cast<double>(solved_->pattern().row.size());
  return dense_entries * entries < dense ? solved_.get() : nullptr;
}

bool OdeForm::fail_at(double t, const std::string& why) {
  char text[64];
  std::snprintf(text, sizeof text, "at t = %.9g s: ", t);
  return fail(text + why);
}

bool OdeForm::solver_failed(double t, const double* q, const std::string& what) {
  for (int i = 0; i < mechanism_.nq(); ++i)
    if (!std::isfinite(q[i])) return fail_at(t, "a joint coordinate is not finite");
  e_->place(t, q);
  if (const std::string lost = e_->lost_loop(); !lost.empty()) return fail_at(t, lost);
  if (solver_->singular_joint() >= 0)
    return fail_at(t, no_inertia(mechanism_, solver_->singular_joint(), t, q, solves_itself_));
  return fail_at(t, what + " is not finite");
}

void OdeForm::begin_step(double, const double*) {
  handling_ = SingularityHandling::none;
}

void OdeForm::set_observing(bool looking) {
  const long solutions = solver_ ? solver_->solutions() : 0;
  if (looking && looking_++ == 0) {
    before_looking_ = solutions;
    kept_ = multipliers_;
  }
  if (!looking && --looking_ == 0) {
    looked_ += solutions - before_looking_;
    multipliers_ = kept_;  // restores what faded rows keep
  }
}

void OdeForm::carry(Memory& memory) {
  memory(multipliers_), memory(centre_), memory(handling_), memory(weakest_at_best_);
  memory(always_faded_), memory(weak_evaluations_);
  long solutions = factorizations();
  memory(solutions);
  if (solver_ && memory.reads()) looked_ = solver_->solutions() - solutions;
  if (watched_) memory(*watched_);
}

void OdeForm::note_pivots() {
  if (looking_ > 0) return;
  const LoopSolver::Pivots pivots = solver_->pivots();
  always_faded_ = std::min(always_faded_, pivots.faded);
  weakest_at_best_ = std::max(weakest_at_best_, pivots.weakest);
  if (pivots.weakest < near || pivots.faded > always_faded_)
    handling_ = SingularityHandling::position;
  else if (pivots.weakest < approaching_ * weakest_at_best_)
    handling_ = std::max(handling_, SingularityHandling::norm);
  if (!watched_) return;
  weak_evaluations_ += pivots.faded > redundant_;
  for (const int row : solver_->faded_rows()) ++(*watched_)[static_cast<std::size_t>(row)];
}

double OdeForm::mean_square(const double* q, const double* e, const double* u, const double* v,
                            double rtol, double atol) const {
  double sum = 0;
  const auto add = [&](double error, double value, double scale) {
    const double x = error / (atol * scale + rtol * std::abs(value));
    sum += x * x;
  };
  for (std::size_t i = 0; i < sizes_.q.size(); ++i) add(e[i], q[i], sizes_.q[i]);
  for (std::size_t i = 0; i < sizes_.u.size(); ++i) add(v[i], u[i], sizes_.u[i]);
  return sum / size();
}

bool OdeForm::solve_correction(double t, const double* q) {
  return solver_->position_correction(t, q, delta_.data()) ||
         solver_failed(t, q, "the position correction");
}

void OdeForm::take_correction(double* q) {
  // q ← q + q̇(δ): exact for one-dof joints, to second order for quaternions.
  coordinate_rates(q, delta_.data(), correction_.data());
  for (std::size_t i = 0; i < correction_.size(); ++i) q[i] += correction_[i];
}

void OdeForm::normalise(double* q) const {
  if (!mechanism_.plan().quasi_velocities) return;
  for (const auto& b : mechanism_.tree().bodies) {
    if (!b.has_quaternion()) continue;
    double* quaternion = q + b.q + (b.nq - 4);
    double norm = 0;
    for (int i = 0; i < 4; ++i) norm += quaternion[i] * quaternion[i];
    norm = std::sqrt(norm);
    for (int i = 0; i < 4; ++i) quaternion[i] /= norm;
  }
}

}  // namespace momenta
