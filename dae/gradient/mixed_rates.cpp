#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/gradient/mixed_rates.h>

#include <cmath>

namespace momenta {

namespace {

template <class Space>
class KineticRatesOf final : public KineticRates {
 public:
  explicit KineticRatesOf(Model<Space> model)
      : model_(std::move(model)), sweep_(make_kinetic_sweep(model_)) {}

  void along(double t, const double* q, const double* u, const double* v, double* rates,
             double* momenta) override {
    sweep_->along(t, q, u, v, rates, momenta);
  }

 private:
  Model<Space> model_;
  std::unique_ptr<KineticSweep> sweep_;
};

}  // namespace

std::unique_ptr<KineticRates> make_kinetic_rates(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar)
    return std::make_unique<KineticRatesOf<Planar>>(
        build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return std::make_unique<KineticRatesOf<Spatial>>(build_spatial_model(tree, mechanism.scene()));
}

using Eigen::Index;
using Eigen::VectorXd;

namespace {

std::size_t at(Index i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

MixedRates::MixedRates(const Mechanism& mechanism, double alpha, double beta, bool forces,
                       bool at_points)
    : by_q(VectorXd::Zero(mechanism.nv())),
      by_u(by_q),
      mechanism_(mechanism),
      rows_{{RowPlaces(mechanism)}, forces, at_points},
      alpha_(alpha),
      beta_(beta),
      driven_(mechanism.plan().drives),
      x_(at(2 * rows_.nv + rows_.m)),
      out_(at(2 * rows_.nv)),
      mu_(at(rows_.m)),
      force_(at(rows_.nv)),
      force_rate_(rows_.nv),
      loop_force_(rows_.nv) {
  if (mechanism.scene().lagrangian || mechanism.plan().quasi_velocities || driven_) return;
  const Tree& tree = mechanism.tree();
  swept_ = mechanism.plan().planar
               ? made(mechanism,
                      build_planar_model(tree, mechanism.scene(), mechanism.plan().basis), !forces)
               : made(mechanism, build_spatial_model(tree, mechanism.scene()), !forces);
}

template <class Space>
struct MixedRates::SweptOf final : Swept {
  SweptOf(const Mechanism& mechanism, Model<Space> built)
      : model(std::move(built)), loops(build_loops(mechanism.scene(), mechanism.tree(), model)) {}
  Model<Space> model;
  LoopModel<Space> loops;
};

template <class Space>
std::unique_ptr<MixedRates::Swept> MixedRates::made(const Mechanism& mechanism, Model<Space> model,
                                                    bool joint_forces) {
  auto swept = std::make_unique<SweptOf<Space>>(mechanism, std::move(model));
  if (!mixed_sweep_fits(swept->model, swept->loops)) return nullptr;
  swept->sweep = make_mixed_sweep(swept->model, swept->loops, joint_forces);
  return swept;
}

double MixedRates::reach(const At& at, const VectorXd& nu) {
  const double size = nu.size() > 0 ? nu.cwiseAbs().maxCoeff() : 0;
  if (size == 0) return 1;
  const double motion =
      std::max(at.u.cwiseAbs().maxCoeff(), std::sqrt(at.udot.cwiseAbs().maxCoeff()));
  return (motion > 0 ? motion : 1) / size;
}

void MixedRates::operator()(const At& at, const VectorXd& nu, const VectorXd& mu) {
  if (driven_)
    by_series(at, nu, mu);
  else if (swept_)
    sweep(at, nu, mu);
  else
    polarised(at, nu, mu);
}

void MixedRates::sweep(const At& x, const VectorXd& nu, const VectorXd& mu) {
  (*swept_->sweep)({x.t, x.q.data(), x.u.data(), x.udot.data(), x.lambda.data(), nu.data(),
                    mu.data(), reach(x, nu)},
                   {by_q.data(), by_u.data(), loop_force_.data(), force_rate_.data()});
  if (alpha_ != 0 || beta_ != 0) feed_back(loop_force_, force_rate_);
}

/// Adds 2α Φ̇_qᵀμ + β² Φ_qᵀμ and 2α Φ_qᵀμ, from Φ_qᵀμ and its rate along the motion.
void MixedRates::feed_back(const VectorXd& force, const VectorXd& rate) {
  by_q += 2 * alpha_ * rate + beta_ * beta_ * force;
  by_u += 2 * alpha_ * force;
}

void MixedRates::polarised(const At& x, const VectorXd& nu, const VectorXd& mu) {
  const Index n = rows_.nv, m = rows_.m;
  rows_.t = x.t;
  if (!dual_) dual_ = mechanism_.evaluation<Dual8>();
  const double s = reach(x, nu);
  const auto evaluate = [&] {
    rows_(static_cast<EquationRows<Dual8>&>(*dual_), x_.data(), out_.data());
  };
  by_q.setZero();
  by_u.setZero();
  for (const double sign : {1.0, -1.0}) {
    for (Index i = 0; i < n; ++i) {
      Dual8 &q = x_[at(i)], &u = x_[at(n + i)];
      q = Dual8(x.q[i]);
      q.b[0] = x.u[i];
      u = Dual8(x.u[i] + sign * s * nu[i]);
      u.b[0] = x.udot[i];
    }
    for (Index i = 0; i < m; ++i) {
      Dual8& sigma = x_[at(2 * n + i)];
      sigma = Dual8(sign * s * mu[i]);
      sigma.b[0] = x.lambda[i];
    }
    evaluate();
    const double half = sign / (2 * s);
    for (Index i = 0; i < n; ++i) {
      const Dual8 &P = out_[at(i)], &R = out_[at(n + i)];
      by_q[i] += half * R.b[0];
      by_u[i] += half * (P.b[0] + R.a);
    }
  }
  // At (u, 0): along (ν, 0, 0), and the rate of Φ_qᵀμ along the motion.
  for (Index i = 0; i < n; ++i) {
    Dual8 &q = x_[at(i)], &u = x_[at(n + i)];
    q = Dual8(x.q[i]);
    q.b[0] = nu[i];
    q.b[1] = x.u[i];
    u = Dual8(x.u[i]);
  }
  for (Index i = 0; i < m; ++i) x_[at(2 * n + i)] = Dual8(0.0);
  evaluate();
  for (Index i = 0; i < n; ++i) {
    by_q[i] -= out_[at(n + i)].b[0];
    by_u[i] -= out_[at(i)].b[0];
  }
  if (m == 0 || (alpha_ == 0 && beta_ == 0)) return;
  for (Index i = 0; i < m; ++i) mu_[at(i)] = Dual8(mu[i]);
  dual_->place(x.t, x_.data());
  dual_->constraint_forces(mu_.data(), force_.data());
  force_rate_.resize(n);
  loop_force_.resize(n);
  for (Index i = 0; i < n; ++i) {
    loop_force_[i] = force_[at(i)].a;
    force_rate_[i] = force_[at(i)].b[1];
  }
  feed_back(loop_force_, force_rate_);
}

void MixedRates::by_series(const At& x, const VectorXd& nu, const VectorXd& mu) {
  const Index n = rows_.nv, m = rows_.m;
  rows_.t = x.t;
  if (!series_) series_ = mechanism_.evaluation<Jet>();
  std::vector<Jet> y(at(2 * n + m)), out(at(2 * n));
  for (Index i = 0; i < n; ++i) {
    Jet &q = y[at(i)], &u = y[at(n + i)];
    q.a.c[0] = x.q[i];
    q.a.c[1] = x.u[i];
    q.b[1].c[0] = nu[i];
    u.a.c[0] = x.u[i];
    u.a.c[1] = x.udot[i];
    u.b[0].c[0] = nu[i];
  }
  for (Index i = 0; i < m; ++i) {
    Jet& sigma = y[at(2 * n + i)];
    sigma.a.c[1] = x.lambda[i];
    sigma.b[0].c[0] = mu[i];
  }
  EquationRows<Jet>& e = *series_;
  rows_(e, y.data(), out.data());
  for (Index i = 0; i < n; ++i) {
    const Jet &P = out[at(i)], &R = out[at(n + i)];
    by_q[i] = R.b[0].c[1] - R.b[1].c[0];
    by_u[i] = P.b[0].c[1] + R.b[0].c[0] - P.b[1].c[0];
  }
  if (m == 0 || (alpha_ == 0 && beta_ == 0)) return;
  const std::vector<Jet> along(mu.begin(), mu.end());
  e.place(x.t, y.data());
  e.constraint_forces(along.data(), out.data());
  force_rate_.resize(n);
  loop_force_.resize(n);
  for (Index i = 0; i < n; ++i) {
    loop_force_[i] = out[at(i)].a.c[0];
    force_rate_[i] = out[at(i)].a.c[1];
  }
  feed_back(loop_force_, force_rate_);
}

}  // namespace momenta
