// The local Newton matrix: what is left of it once its further unknowns are eliminated is J, and
// its entries grow like the mechanism, however deep the tree is.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/random_loops.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/integrator/local_newton.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <Eigen/LU>

namespace momenta::dae_local_jacobian {
namespace {

using namespace equations;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd dense(const JacobianPattern& pattern, const std::vector<double>& values) {
  const auto n = static_cast<Eigen::Index>(pattern.column_start.size()) - 1;
  MatrixXd a = MatrixXd::Zero(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (auto k = pattern.column_start[static_cast<std::size_t>(j)];
         k < pattern.column_start[static_cast<std::size_t>(j) + 1]; ++k)
      a(pattern.row[static_cast<std::size_t>(k)], j) = values[static_cast<std::size_t>(k)];
  return a;
}

/// J = A − B T⁻¹ C against columns of dual numbers, all forms, near the start and with other c.
void expect_same_matrix(const Mechanism& mechanism, const Start& start, unsigned seed) {
  for (const std::string& name : form_names()) {
    if (!is_dae_form(name)) continue;
    FormOptions options;
    options.gauge = {Gauge::Kind::leak, 1.7};
    const auto form = make_form(name, mechanism, options, start);
    auto& dae = dynamic_cast<DaeForm&>(*form);
    const auto n = static_cast<std::size_t>(dae.size());
    std::vector<double> y(n), ydot(n);
    ASSERT_TRUE(dae.start(start.t, y.data(), ydot.data()));
    RandomTree random(seed);
    for (double t : {start.t, start.t + 0.37}) {
      for (double& x : y) x += random.uniform(-0.3, 0.3);
      for (double& x : ydot) x += random.uniform(-1, 1);
      const double c = random.uniform(1, 10);
      const JacobianPattern& own = dae.pattern();
      std::vector<double> values(own.column_start.empty() ? n * n : own.row.size());
      ASSERT_TRUE(dae.jacobian(t, y.data(), ydot.data(), c, values.data()));
      const MatrixXd expected =
          own.column_start.empty()
              ? MatrixXd(Eigen::Map<MatrixXd>(values.data(), dae.size(), dae.size()))
              : dense(own, values);
      LocalJacobian& local = dae.local_jacobian();
      ASSERT_TRUE(local.evaluate(t, y.data(), ydot.data(), c));
      const MatrixXd whole = dense(local.pattern(), local.values());
      const Eigen::Index size = dae.size(), more = whole.rows() - size;
      MatrixXd found = whole.topLeftCorner(size, size);
      if (more > 0) {
        const MatrixXd t_block = whole.bottomRightCorner(more, more);
        EXPECT_TRUE(t_block.isLowerTriangular(0)) << name;
        EXPECT_TRUE(t_block.diagonal().isOnes(0)) << name;
        found -=
            whole.topRightCorner(size, more) * t_block.triangularView<Eigen::UnitLower>().solve(
                                                   MatrixXd(whole.bottomLeftCorner(more, size)));
      }
      EXPECT_LT(relative_error(found, expected), 1e-12) << name << " of " << mechanism.scene().name;
    }
  }
}

TEST(LocalJacobian, IsTheMatrixOfDualNumbers) {
  for (const char* name : {"four_bar", "andrews", "driven", "spatial_slider_crank"}) {
    const Mechanism mechanism(equations::example(name));
    expect_same_matrix(mechanism, equations::start_of(mechanism), 1);
  }
  for (const Scene& scene :
       {platform(6), crossed_bars(12), arch(15), row_of_four_bars(9, 1.1, 1)}) {
    const Mechanism mechanism(scene);
    expect_same_matrix(mechanism, equations::start_of(mechanism), 2);
  }
}

TEST(LocalJacobian, IsThatOfRandomMechanisms) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({.bodies = 5});
    scene.loops.push_back(random_loop(random, scene, loop_kinds[seed % loop_kinds.size()]));
    if (seed % 2 == 1) drive_loop(random, scene, scene.loops.back(), 1 + random.below(7), 0);
    if (const auto coupler = random_coupler(random, scene)) scene.loops.push_back(*coupler);
    const Mechanism mechanism(scene, {.algebra = Algebra::spatial});
    RandomTree anywhere(seed);
    const TreeState s = anywhere.state(mechanism.tree());
    expect_same_matrix(
        mechanism,
        {s.t, s.q, s.u, VectorXd::Zero(mechanism.nv()), VectorXd::Zero(mechanism.m()), {}}, seed);
  }
}

std::size_t entries(const Scene& scene, const std::string& name) {
  const Mechanism mechanism(scene);
  const auto form = make_form(name, mechanism, {}, equations::start_of(mechanism));
  auto& dae = dynamic_cast<DaeForm&>(*form);
  std::vector<double> y(static_cast<std::size_t>(dae.size())), ydot(y.size());
  EXPECT_TRUE(dae.start(0, y.data(), ydot.data()));
  EXPECT_TRUE(dae.local_jacobian().evaluate(0, y.data(), ydot.data(), 3));
  return dae.local_jacobian().values().size();
}

/// Twice the mechanism, twice the entries: not four times, as in J of a deep tree.
TEST(LocalJacobian, GrowsLikeTheMechanism) {
  for (const char* name : {"momentum-index2", "momentum-stabilised", "stabilised-index2"}) {
    for (const auto& make :
         {+[](int n) { return crossed_bars(n); }, +[](int n) { return arch(2 * n); },
          +[](int n) { return row_of_four_bars(n, 1.1, 1); }}) {
      const Scene scene = make(200);
      const auto one = static_cast<double>(entries(make(100), name)),
                 two = static_cast<double>(entries(scene, name));
      EXPECT_LT(two, 2.02 * one) << name << " of " << scene.name;
      EXPECT_LT(two, 400.0 * static_cast<double>(scene.bodies.size()))
          << name << " of " << scene.name;
    }
  }
}

/// Of a ladder they let entries grow as much as any others do, so they serve at other states and
/// steps; where one of them is lost others are chosen.
TEST(LocalJacobian, PivotsAreKept) {
  const Mechanism mechanism(crossed_bars(100));
  const auto form = make_form("momentum-index2", mechanism, {}, equations::start_of(mechanism));
  auto& dae = dynamic_cast<DaeForm&>(*form);
  std::vector<double> y(static_cast<std::size_t>(dae.size())), ydot(y.size());
  ASSERT_TRUE(dae.start(0, y.data(), ydot.data()));
  LocalJacobian& local = dae.local_jacobian();
  ASSERT_TRUE(local.evaluate(0, y.data(), ydot.data(), 1e5));
  const JacobianPattern pattern = local.pattern();
  const auto matrix = make_local_matrix(pattern);
  const std::size_t count = local.values().size(), n = pattern.column_start.size() - 1;
  std::vector<double> values = local.values();
  const auto solve = [&] {
    std::copy(values.begin(), values.end(), matrix->values());
    ASSERT_TRUE(matrix->factor());
    std::vector<double> x(n), b(n, 0.0), size(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) x[i] = b[i] = i % 3 == 0 ? 1.0 : -0.5;
    matrix->solve(x.data());
    for (std::size_t j = 0; j < n; ++j)
      for (auto k = static_cast<std::size_t>(pattern.column_start[j]);
           k < static_cast<std::size_t>(pattern.column_start[j + 1]); ++k) {
        const auto row = static_cast<std::size_t>(pattern.row[k]);
        b[row] -= values[k] * x[j];
        size[row] += std::abs(values[k] * x[j]);
      }
    for (std::size_t i = 0; i < n; ++i) EXPECT_LT(std::abs(b[i]), 1e-6 * (1 + size[i])) << i;
  };
  solve();
  EXPECT_EQ(matrix->choices(), 1);
  RandomTree random(4);
  for (const double c : {7e4, 3e5, 4e3}) {
    for (double& x : y) x += 1e-3 * random.uniform(-1, 1);
    ASSERT_TRUE(local.evaluate(0, y.data(), ydot.data(), c));
    ASSERT_EQ(local.values().size(), count);
    values = local.values();
    solve();
    EXPECT_EQ(matrix->choices(), 1) << c;
  }
  // Every entry of another size: what were pivots are now small beside others in their columns.
  for (double& x : values) x *= std::pow(10, random.uniform(-12, 0));
  std::copy(values.begin(), values.end(), matrix->values());
  EXPECT_TRUE(matrix->factor());
  EXPECT_EQ(matrix->choices(), 2);
}

/// IDA by the local matrix finds the motion that the sweeps find.
TEST(LocalJacobian, SameMotion) {
  const Mechanism mechanism(crossed_bars(90));
  const Start start = equations::start_of(mechanism);
  std::vector<double> ends[2];
  for (const bool dae : {false, true}) {
    const RunResult run = run_form(mechanism, start,
                                   equations::kept(equations::adaptive(
                                       dae ? "momentum-index2" : "momentum", dae ? "ida" : "dop853",
                                       "leak:3", dae ? 1e-9 : 1e-11, 0.02, 1)));
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_EQ(run.linear_solver, dae ? "KLU, local" : "");
    ends[dae] = run.trajectory.rows.back();
  }
  for (std::size_t i = 1; i <= static_cast<std::size_t>(mechanism.nq()); ++i)
    EXPECT_NEAR(ends[1][i], ends[0][i], 1e-7) << i;
}

}  // namespace
}  // namespace momenta::dae_local_jacobian
