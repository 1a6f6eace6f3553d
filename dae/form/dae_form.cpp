#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/loop/loop_weights.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/mechanism/tree_factor.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

constexpr double near_pivot = 1e-2;  // relative to the best: near a singular pose

/// Why there is no u of M u + prescribed part = p at (t, q); empty: there is one.
std::string without_rates(const std::string& form, const Mechanism& mechanism,
                          Evaluation<double>& e, double t, const double* q) {
  const std::string singular = mass_without_inverse(mechanism, e, t, q);
  if (singular.empty()) return "";
  return "'" + form + "' takes rates from M u = p, and " + singular +
         "; expected a form whose rates obey the " + loop_word(mechanism) + "s, as momentum-index2";
}

}  // namespace

DaeForm::DaeForm(std::string name, const Mechanism& mechanism, DaeLayout layout,
                 const FormOptions& options, const Start& start, Unknowns unknowns)
    : layout_(layout),
      mechanism_(mechanism),
      sizes_(mechanism, start),
      name_(std::move(name)),
      unknowns_(unknowns),
      start_(start),
      scale_(static_cast<std::size_t>(layout.size()), 1.0),
      plain_(mechanism, layout.size()),
      options_(options) {
  plain_.e->place(start.t, start.q.data());
  inertia_.resize(static_cast<std::size_t>(layout.nv));
  plain_.e->mass_diagonal(inertia_.data());
  if (momentum_like()) {
    gauge_ = options.gauge;
    if (gauge_.kind == Gauge::Kind::flip)
      throw std::invalid_argument("gauge flip is for symmetric methods; '" + name_ +
                                  "' is integrated as a DAE: expected none, leak or reset");
    if (gauge_.kind == Gauge::Kind::leak && gauge_.kappa == 0)
      gauge_.kappa = default_leak(mechanism, start);
  }
  std::copy(sizes_.q.begin(), sizes_.q.end(), scale_.begin());
  for (const int first : {layout_.x(), layout_.v()})
    std::copy(sizes_.u.begin(), sizes_.u.end(), scale_.begin() + first);
  if (unknowns != Unknowns::velocities)
    sizes_.of_momenta(*plain_.e, start, scale_.data() + layout_.x());
  softened_about_.assign(static_cast<std::size_t>(layout.m), 0.0);
  if (layout.m > 0) find_redundancy(start);
  for (int i = layout_.s(); i < layout_.size(); ++i)
    scale_[static_cast<std::size_t>(i)] = std::numeric_limits<double>::infinity();
}

void DaeForm::find_redundancy(const Start& start) {
  if (!mechanism_.solver().leaves_first()) {  // the loops have no pivots of their own
    plain_.e->place(start.t, start.q.data());
    if (loop_rank(mechanism_, *plain_.e, Judged::dependence).rank == layout_.m) return;
  } else if (!mechanism_.solver().by_sweeps()) {
    const auto kkt = make_dense_kkt(mechanism_);
    if (!kkt->factor(*plain_.e, start.t, start.q.data(), fade_evaluation) || kkt->faded() == 0)
      return;
  } else {
    const auto solver = make_loop_solver(mechanism_, *plain_.e);
    std::vector<double> rest(static_cast<std::size_t>(layout_.nv), 0.0), u(rest.size());
    if (!solver->free_velocity(start.t, start.q.data(), rest.data(), u.data())) return;
    if (solver->pivots().faded == 0) return;
    plain_.e->place(start.t, start.q.data());
  }
  epsilon_ = row_scales(mechanism_, *plain_.e);
  // ε fits the lightest bodies; its error in rows of the heaviest is not corrected. On σ it cannot
  // be much smaller: rounding in redundant rows, over ε, shortens steps.
  const double unweakened = momentum_like() ? masses_far_apart : 1e2;
  const double weaker = std::max(1.0, mechanism_.mass_spread() / unweakened);
  for (double& epsilon : epsilon_) epsilon *= std::pow(sizes_.rate, -layout_.below) * 1e-9 / weaker;
  double heaviest = 0;
  for (const double inertia : inertia_) heaviest = std::max(heaviest, inertia);
  softness_of_mu_ = 1e-3 * power_of_ten(heaviest > 0 ? heaviest : 1, 0.2512) *
                    std::pow(sizes_.rate, layout_.below - 1);
}

/// An untested x does not stop Newton's method either: rounding of q leaves ε/h in it, which grows
/// as the step shrinks, so that at tight tolerances no first step would be short enough.
double DaeForm::scale(int i) const {
  const bool is_rate = i >= layout_.x() && i < layout_.x() + layout_.nv;
  if (is_rate && !rate_is_tested()) return std::numeric_limits<double>::infinity();
  return scale_[static_cast<std::size_t>(i)];
}

DaeSystem::Weight DaeForm::weight(int i) const {
  const bool is_rate = i >= layout_.x() && i < layout_.x() + layout_.nv;
  if (!is_rate && !differential(i)) return {-1, 0};
  return {is_rate && !rate_is_tested() ? 1 : 0, scale_[static_cast<std::size_t>(i)]};
}

bool DaeForm::differential(int i) const {
  if (i < layout_.x()) return true;
  if (i < layout_.x() + layout_.nv) return rate_is_tested();
  return false;  // v beside p, and every multiplier
}

std::vector<double> DaeForm::initial(const Start& start) {
  std::vector<double> y(static_cast<std::size_t>(size()), 0.0);
  std::copy(start.q.begin(), start.q.end(), y.begin());
  std::copy(start.u.begin(), start.u.end(), y.begin() + layout_.v());
  double* multipliers = y.data() + layout_.s();
  if (!momentum_like())
    std::copy(start.lambda.begin(), start.lambda.end(), multipliers);
  else if (leak() > 0)
    for (int i = 0; i < layout_.m; ++i)
      multipliers[i] = start.lambda[i] / leak();  // σ(0) = λ(0)/κ: no transient
  if (unknowns_ == Unknowns::velocities) return y;
  plain_.e->place(start.t, start.q.data());
  plain_.e->move(start.u.data());
  plain_.e->momenta(momentum_like() ? multipliers : nullptr, y.data() + layout_.x());
  return y;
}

bool DaeForm::start(double t, double* y, double* ydot) {
  if (unknowns_ == Unknowns::momenta && layout_.m > 0)
    if (std::string none = without_rates(name_, mechanism_, *plain_.e, start_.t, start_.q.data());
        !none.empty())
      return fail(std::move(none));
  const auto y0 = initial(start_);
  std::copy(y0.begin(), y0.end(), y);
  std::copy_n(y + layout_.s(), softened_about_.size(), softened_about_.begin());
  complete(t, start_.u.data(), start_.udot.data(), start_.lambda.data(), y, ydot);
  for (int i = 0; i < size(); ++i)
    if (!std::isfinite(y[i]) || !std::isfinite(ydot[i])) return fail("the start is not finite");
  return true;
}

void DaeForm::complete(double t, const double* u, const double* udot, const double* lambda,
                       double* y, double* ydot) {
  std::fill(ydot, ydot + size(), 0.0);
  auto& e = *plain_.e;
  e.place(t, y);
  e.move(u);
  e.coordinate_rates(y, u, ydot);
  if (unknowns_ == Unknowns::impulses) {
    e.momenta(y + layout_.s(), plain_.b.data());
    e.momentum_rates(y, u, y + layout_.s(), leak(), ydot + layout_.x());
    for (int i = layout_.s(); i < layout_.s() + layout_.m; ++i)
      ydot[i] = lambda[i - layout_.s()] - leak() * y[i];  // σ̇ = λ − κσ
  }
  if (unknowns_ == Unknowns::momenta) {
    std::copy_n(lambda, layout_.m, y + layout_.s());
    e.momenta(nullptr, y + layout_.x());
    e.momentum_rates(y, u, nullptr, 0, ydot + layout_.x());
    e.constraint_forces(y + layout_.s(), plain_.b.data());
    for (int i = 0; i < layout_.nv; ++i)
      ydot[layout_.x() + i] -= plain_.b[static_cast<std::size_t>(i)];
  }
  if (unknowns_ == Unknowns::velocities) std::copy_n(lambda, layout_.m, y + layout_.s());
  if (unknowns_ == Unknowns::velocities || layout_.explicit_velocity) {
    std::copy_n(u, layout_.nv, y + layout_.v());
    std::copy_n(udot, layout_.nv, ydot + layout_.v());
  }
  if (layout_.position_multiplier) std::fill_n(y + layout_.mu(), layout_.m, 0.0);
}

/// Pivots count relative to the best so far: loops weak throughout make no singular pose. A
/// hundredth is a tenth of a radian away.
bool DaeForm::near_singular(double t, const double* y) {
  if (layout_.m == 0) return false;
  OdeRestart& d = ode_restart_;
  if (!d.solver) {
    d.solver = make_loop_solver(mechanism_, *plain_.e);
    d.friction = bearing_friction(mechanism_);
    d.always_faded = layout_.m;
    for (auto* v : {&d.u, &d.udot}) v->resize(static_cast<std::size_t>(layout_.nv));
    for (auto* v : {&d.sigma, &d.lambda}) v->assign(static_cast<std::size_t>(layout_.m), 0.0);
    if (!epsilon_.empty() && mechanism_.solver().leaves_first()) look_beside_start();
  }
  if (!find_pivots(t, y)) return false;
  const LoopSolver::Pivots pivots = d.solver->pivots();
  d.always_faded = std::min(d.always_faded, pivots.faded);
  const double weakest = pivots.faded > d.always_faded ? 0 : pivots.weakest;
  d.strongest = std::max(d.strongest, weakest);
  return weakest < near_pivot * d.strongest;
}

bool DaeForm::find_pivots(double t, const double* q) {
  OdeRestart& d = ode_restart_;
  std::fill(d.udot.begin(), d.udot.end(), 0.0);
  return d.solver->free_velocity(t, q, d.udot.data(), d.u.data());
}

/// A row that is redundant everywhere has no pivot at a pose beside the start either; where the
/// start is a singular pose it has one.
void DaeForm::look_beside_start() {
  constexpr double aside = 0.2;  // [rad or lengths of the scene]
  OdeRestart& d = ode_restart_;
  const LoopUnits units(mechanism_);
  for (const Eigen::VectorXd& way : {start_.u, start_.udot}) {
    const double largest = way.cwiseQuotient(units.rates).cwiseAbs().maxCoeff();
    if (!(largest > 0)) continue;
    const Eigen::VectorXd step = way * (aside / largest);
    Eigen::VectorXd q = start_.q, qdot(layout_.nq);
    plain_.e->coordinate_rates(q.data(), step.data(), qdot.data());
    Eigen::VectorXd state = Eigen::VectorXd::Zero(layout_.nq + layout_.nv);  // at rest
    state.head(layout_.nq) = q + qdot;
    bool changed = false;
    if (!restart_form().after_step(start_.t, state.data(), changed)) return;  // closes the loops
    if (!find_pivots(start_.t, state.data())) return;
    const LoopSolver::Pivots beside = d.solver->pivots();
    if (beside.weakest < near_pivot) return;
    d.always_faded = beside.faded;
    d.strongest = beside.weakest;
    // Undamped soft rows swing at index 3. The run leaves the start as an ODE.
    if (beside.faded == 0) epsilon_.clear();
    return;
  }
}

OdeForm& DaeForm::restart_form() {
  std::unique_ptr<OdeForm>& form = ode_restart_.form;
  if (!form) {
    FormOptions options = options_;
    options.project = true;
    options.gauge = momentum_like() ? gauge_ : Gauge{Gauge::Kind::reset, 0};
    form = make_momentum(mechanism_, options, start_);
  }
  return *form;
}

OdeSystem* DaeForm::ode_restart(double t, const double* y, double* state) {
  OdeRestart& d = ode_restart_;
  restart_form();
  std::copy_n(y, layout_.nq + layout_.nv, state);
  if (momentum_like()) {
    d.form->centre_on(y + layout_.s());
    return d.form.get();
  }
  std::fill(d.sigma.begin(), d.sigma.end(), 0.0);
  d.form->centre_on(d.sigma.data());
  if (unknowns_ == Unknowns::velocities) {
    plain_.e->place(t, y);
    plain_.e->move(y + layout_.v());
    plain_.e->momenta(nullptr, state + layout_.nq);
  }
  return d.form.get();
}

bool DaeForm::rejoin(double t, const double* state, double* y, double* ydot) {
  OdeRestart& d = ode_restart_;
  const double* p = state + layout_.nq;
  const double* centre = momentum_like() ? y + layout_.s() : nullptr;
  if (!d.solver->momentum(t, state, p, centre, fade_evaluation, 0, d.u.data(), d.sigma.data(),
                          nullptr) ||
      (d.friction && !d.friction->at(t, state, d.u.data())))
    return fail("the state past a singular pose is not finite");
  d.solver->push(d.friction ? d.friction->forces() : nullptr);
  if (!d.solver->acceleration(t, state, d.u.data(), momentum_like() ? nullptr : y + layout_.s(), 0,
                              0, d.udot.data(), d.lambda.data()))
    return fail("the state past a singular pose is not finite");
  std::copy_n(state, layout_.nq + layout_.nv, y);
  if (momentum_like()) std::copy(d.sigma.begin(), d.sigma.end(), y + layout_.s());
  complete(t, d.u.data(), d.udot.data(), d.lambda.data(), y, ydot);
  return true;
}

bool DaeForm::residual(double t, const double* y, const double* ydot, double* r) {
  equations(plain_, t, y, ydot, r);
  regularise(y, r);
  for (int i = 0; i < size(); ++i)
    if (!std::isfinite(r[i])) {
      const std::string lost = plain_.e->lost_loop();
      return fail(lost.empty() ? "the residual is not finite" : lost);
    }
  return true;
}

void DaeForm::along(double t, const Jet* y, const Jet* ydot, Jet* r) {
  if (!jet_.e) jet_ = DaeScratch<Jet>(mechanism_, size());
  equations(jet_, t, y, ydot, r);
}

bool DaeForm::evaluate_columns(double t, const double* y, const double* ydot, double c,
                               const std::vector<int>& direction_of) {
  if (!dual_.e) dual_ = DaeScratch<Dual8>(mechanism_, size());
  for (int i = 0; i < size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    dual_.y[at] = Dual8(y[i]);
    dual_.ydot[at] = Dual8(ydot[i]);
    if (const int direction = direction_of[at]; direction >= 0) {
      dual_.y[at].b[static_cast<std::size_t>(direction)] = 1;
      dual_.ydot[at].b[static_cast<std::size_t>(direction)] = c;
    }
  }
  equations(dual_, t, dual_.y.data(), dual_.ydot.data(), dual_.r.data());
  regularise(dual_.y.data(), dual_.r.data());
  return true;
}

bool DaeForm::jacobian(double t, const double* y, const double* ydot, double c, double* values) {
  if (batches_.empty()) analyse_pattern();
  const auto n = static_cast<std::size_t>(size());
  bool finite = true;
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    evaluate_columns(t, y, ydot, c, batches_[batch]);
    for (std::size_t direction = 0; direction < groups_[batch].size(); ++direction)
      for (int column : groups_[batch][direction]) {
        if (pattern_.column_start.empty()) {
          for (std::size_t i = 0; i < n; ++i) {
            const double value = dual_.r[i].b[direction];
            finite &= std::isfinite(value);
            values[static_cast<std::size_t>(column) * n + i] = value;
          }
        } else {
          const auto at = static_cast<std::size_t>(column);
          for (auto k = static_cast<std::size_t>(pattern_.column_start[at]);
               k < static_cast<std::size_t>(pattern_.column_start[at + 1]); ++k) {
            const double value = dual_.r[static_cast<std::size_t>(pattern_.row[k])].b[direction];
            finite &= std::isfinite(value);
            values[k] = value;
          }
        }
      }
  }
  return finite || fail("the Jacobian is not finite");
}

bool DaeForm::read(double t, const double* y, const double*, Snapshot& out) {
  out.q = Eigen::Map<const Eigen::VectorXd>(y, layout_.nq);
  out.multipliers = Eigen::Map<const Eigen::VectorXd>(y + layout_.s(), layout_.m);
  out.u.resize(layout_.nv);
  if (unknowns_ == Unknowns::velocities) {
    std::copy_n(y + layout_.v(), layout_.nv, out.u.begin());
    return true;
  }
  if (unknowns_ == Unknowns::momenta && layout_.m > 0) return open_rates(t, y, out.u.data());
  // u from (7) at (q, p): the velocity that belongs to the state, whatever the integrator's last
  // Newton residual.
  auto& e = *plain_.e;
  if (layout_.m > 0 && mechanism_.solver().by_sweeps()) {
    if (!reader_) reader_ = make_loop_solver(mechanism_, e);
    reader_->stabilise(beta());
    Eigen::VectorXd unused(layout_.m);
    return reader_->momentum(t, y, y + layout_.x(), y + layout_.s(), fade_evaluation, 0,
                             out.u.data(), unused.data(), nullptr);
  }
  e.place(t, y);
  Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(y + layout_.x(), layout_.nv), g(layout_.m),
                  sigma(layout_.m);
  if (layout_.m == 0)
    return e.open_momentum_rates(t, y, y + layout_.x(), out.u.data(), plain_.b.data());
  g.setZero();
  if (mechanism_.plan().drives) {
    Eigen::VectorXd prescribed(layout_.nv);
    e.move(nullptr);
    e.momenta(nullptr, prescribed.data());
    r -= prescribed;
    e.velocities(g.data());
    g = -g;
  }
  if (beta() > 0) {
    Eigen::VectorXd phi(layout_.m);
    e.positions(phi.data());
    g -= beta() * phi;
  }
  if (!kkt_) kkt_ = make_kkt(mechanism_);
  return kkt_->factor(e, t, y, fade_evaluation) &&
         kkt_->solve(r.data(), g.data(), y + layout_.s(), out.u.data(), sigma.data());
}

bool DaeForm::open_rates(double t, const double* y, double* u) {
  auto& e = *plain_.e;
  const auto& pattern = mechanism_.kkt_pattern();
  std::vector<double> mass(pattern.mass.size());
  TreeFactor factor(pattern, layout_.nv);
  e.place(t, y);
  e.mass_entries(mass.data());
  if (factor.factor(mass) >= 0) return fail(without_rates(name_, mechanism_, e, t, y));
  e.move(nullptr);
  e.momenta(nullptr, u);  // the prescribed part
  for (int i = 0; i < layout_.nv; ++i) u[i] = y[layout_.x() + i] - u[i];
  factor.inward(u);
  for (int i = 0; i < layout_.nv; ++i) u[i] *= factor.inverse_pivots()[static_cast<std::size_t>(i)];
  factor.outward(u);
  return true;
}

}  // namespace momenta
