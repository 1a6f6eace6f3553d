// RATTLE, generalised-α and bayo-ledesma by dense and by sparse matrices: the same motion, to what
// rounding makes of it.

#include <gtest/gtest.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/newton_matrix.h>
#include <momenta/dae/integrator/system.h>
#include <momenta/dae/run/run_form.h>

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/tolerance.h"

namespace momenta::dae_solver_sparse {
namespace {

using namespace equations;
using Eigen::VectorXd;

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    worst = equations::larger(worst, std::abs(a[i] - b[i]) / (1 + std::abs(a[i])));
  return worst;
}

std::vector<double> rattled(const Scene& scene, KktChoice kkt, Algebra algebra) {
  const Mechanism mechanism(scene, {.algebra = algebra, .kkt = kkt});
  const Start start = start_of(mechanism);
  const auto form = make_form("momentum", mechanism, {}, start);
  IntegrationOptions options;
  options.step = 0.01;
  const auto run =
      integrate_rattle(*form->ode(), 0, form->initial(start), {0.305, 0.6}, options, {});
  EXPECT_TRUE(run.done) << run.reason;
  return run.y;
}

TEST(SparseMatrices, OfRattle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, -1).normalized()));
  const Scene four_bar = equations::example("four_bar");
  // The second has redundant loops.
  for (const auto& [scene, algebra] : {std::pair(row_of_four_bars(12, 1.2, 1), Algebra::automatic),
                                       std::pair(turned(four_bar, turn), Algebra::spatial),
                                       std::pair(crossed_bars(8), Algebra::automatic)})
    EXPECT_LT(apart(rattled(scene, KktChoice::dense, algebra),
                    rattled(scene, KktChoice::sparse, algebra)),
              1e-10)
        << scene.name;
}

/// One step from the start, by the equations in the head of rattle.cpp, unknowns u_0, u_1, λ, with
/// M, Φ_q as whole matrices and Newton's method by differences.
TEST(SparseMatrices, RattleTakesTheStepOfItsEquations) {
  const double h = 0.02;
  const Mechanism mechanism(row_of_four_bars(5, 1.2, 1));
  const Start start = start_of(mechanism);
  const auto form = make_form("momentum", mechanism, {}, start);
  const std::vector<double> y0 = form->initial(start);
  IntegrationOptions options;
  options.step = h;
  const auto run = integrate_rattle(*form->ode(), 0, y0, {h}, options, {});
  ASSERT_TRUE(run.done) << run.reason;

  const Eigen::Index n = mechanism.nv(), m = mechanism.m();
  const auto e = mechanism.evaluation<double>();
  const VectorXd q0 = start.q, p0 = Eigen::Map<const VectorXd>(y0.data() + n, n);
  const auto mass = [&](const VectorXd& q, const VectorXd& u) {  // M(q) u
    VectorXd p(n);
    e->place(0, q.data());
    e->move(u.data());
    e->momenta(nullptr, p.data());
    return p;
  };
  const auto force = [&](const VectorXd& q, const VectorXd& u, const VectorXd& lambda) {
    VectorXd g(n), of_loops(n), p(n);
    e->place(0, q.data());
    e->constraint_forces(lambda.data(), of_loops.data());
    e->move(u.data());
    e->momenta(nullptr, p.data());
    e->momentum_rates(q.data(), u.data(), nullptr, 0, g.data());
    return VectorXd(g - of_loops);
  };
  const auto loops = [&](const VectorXd& q) {
    VectorXd phi(m);
    e->place(0, q.data());
    e->positions(phi.data());
    return phi;
  };
  const auto equations = [&](const VectorXd& x) {
    const VectorXd u0 = x.head(n), u1 = x.segment(n, n), lambda = x.tail(m);
    const VectorXd half = p0 + 0.5 * h * force(q0, u0, lambda), q1 = q0 + 0.5 * h * (u0 + u1);
    VectorXd r(2 * n + m);
    r << mass(q0, u0) - half, mass(q1, u1) - half, loops(q1) / h;
    return r;
  };
  VectorXd x(2 * n + m);
  x << start.u, start.u, start.lambda;
  for (int k = 0; k < 12; ++k) {
    const VectorXd r = equations(x);
    Eigen::MatrixXd jacobian(x.size(), x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      VectorXd ahead = x;
      ahead[i] += 1e-6;
      jacobian.col(i) = (equations(ahead) - r) / 1e-6;
    }
    x -= jacobian.fullPivLu().solve(r);
  }
  ASSERT_LT(equations(x).norm(), 1e-12);
  const VectorXd q1 = q0 + 0.5 * h * (x.head(n) + x.segment(n, n));
  EXPECT_LT((Eigen::Map<const VectorXd>(run.y.data(), n) - q1).norm(), 1e-12);
}

/// A form whose matrix is J, sparse or dense, whatever its size.
class Whole final : public DaeSystem, public SecondOrder {
 public:
  Whole(Form& form, bool is_dense)
      : dae_(*form.dae()), order_(dynamic_cast<SecondOrder&>(form)), is_dense_(is_dense) {}
  int size() const override { return dae_.size(); }
  bool residual(double t, const double* y, const double* ydot, double* r) override {
    return dae_.residual(t, y, ydot, r);
  }
  bool jacobian(double t, const double* y, const double* ydot, double c, double* values) override {
    if (!is_dense_) return dae_.jacobian(t, y, ydot, c, values);
    const JacobianPattern& given = dae_.pattern();
    std::vector<double> sparse(given.row.size());
    const auto n = static_cast<std::size_t>(size());
    std::fill_n(values, n * n, 0.0);
    if (!dae_.jacobian(t, y, ydot, c, sparse.data())) return false;
    for (std::size_t j = 0; j < n; ++j)
      for (auto k = static_cast<std::size_t>(given.column_start[j]);
           k < static_cast<std::size_t>(given.column_start[j + 1]); ++k)
        values[j * n + static_cast<std::size_t>(given.row[k])] = sparse[k];
    return true;
  }
  const JacobianPattern& pattern() const override { return is_dense_ ? none_ : dae_.pattern(); }
  bool start(double t, double* y, double* ydot) override { return dae_.start(t, y, ydot); }
  bool differential(int i) const override { return dae_.differential(i); }
  double scale(int i) const override { return dae_.scale(i); }
  Weight weight(int i) const override { return dae_.weight(i); }

  int coordinates() const override { return order_.coordinates(); }
  int rates() const override { return order_.rates(); }
  int multipliers() const override { return order_.multipliers(); }
  void coordinate_rates(const double* q, const double* v, double* qdot) override {
    order_.coordinate_rates(q, v, qdot);
  }
  void move(const double* q, const double* delta, double* moved) override {
    order_.move(q, delta, moved);
  }
  void constraints(double t, const double* q, double* phi) override {
    order_.constraints(t, q, phi);
  }
  void constraint_rates(double t, const double* q, const double* v, double* rate) override {
    order_.constraint_rates(t, q, v, rate);
  }
  void constraint_accelerations(double t, const double* q, const double* v, const double* vdot,
                                double* rate) override {
    order_.constraint_accelerations(t, q, v, vdot, rate);
  }
  const std::vector<double>& compliance() override { return order_.compliance(); }

 private:
  DaeSystem& dae_;
  SecondOrder& order_;
  bool is_dense_;
  JacobianPattern none_;
};

TEST(SparseMatrices, OfNewmarksFamily) {
  for (const Scene& scene : {row_of_four_bars(90, 1.2, 1), crossed_bars(85)}) {
    const Mechanism mechanism(scene);
    const Start start = start_of(mechanism);
    const auto form = make_form("acceleration-index3", mechanism, {}, start);
    ASSERT_NE(form->dae()->local(), nullptr);
    for (const auto& method : {integrate_generalised_alpha, integrate_bayo_ledesma}) {
      const auto run = [&](DaeSystem& system, const char* solver) {
        IntegrationOptions options;
        options.step = 0.005;
        options.rtol = options.atol = 1e-9;
        const auto result = method(system, 0, {0.0125, 0.03}, options, {});
        EXPECT_TRUE(result.done) << result.reason;
        EXPECT_EQ(result.linear_solver, solver);
        return result;
      };
      Whole sparse(*form, false), dense(*form, true);
      const auto local = run(*form->dae(), "KLU, local"), whole = run(sparse, "KLU");
      // λ of an index-3 form hangs on the last digits of q by 1/h².
      const auto motion = static_cast<std::ptrdiff_t>(mechanism.nq() + mechanism.nv());
      const auto motions = [&](const auto& y) {
        return std::vector<double>(y.begin(), y.begin() + motion);
      };
      EXPECT_LT(apart(motions(whole.y), motions(local.y)), 1e-11) << scene.name;
      EXPECT_LT(apart(whole.y, local.y), 1e-6) << scene.name;
      EXPECT_EQ(whole.counters.newton_iterations, local.counters.newton_iterations) << scene.name;
      const auto by_dense = run(dense, "dense LU");
      EXPECT_LT(apart(motions(by_dense.y), motions(local.y)), 1e-11) << scene.name;
      EXPECT_LT(apart(by_dense.y, local.y), 1e-6) << scene.name;
    }
  }
}

TEST(SparseMatrices, ConditionOfTheLocalOnesDoesNotGrowAsStepsShrink) {
  const Mechanism mechanism(row_of_four_bars(90, 1.2, 1));
  const Start start = start_of(mechanism);
  for (const double h : {1e-3, 1e-6}) {
    const auto form = make_form("acceleration-index3", mechanism, {}, start);
    IntegrationOptions options;
    options.rtol = options.atol = 1e-9;
    options.step = h;
    const auto run = integrate_generalised_alpha(*form->dae(), 0, {20 * h}, options, {});
    ASSERT_TRUE(run.done) << run.reason;
    EXPECT_LE(run.counters.newton_iterations, 4 * run.counters.steps) << h;
  }
}

}  // namespace
}  // namespace momenta::dae_solver_sparse
