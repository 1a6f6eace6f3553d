// The benchmark bicycle (Meijaard, Papadopoulos, Ruina and Schwab, Proc. R. Soc. A 463, 2007): its
// small motions about upright riding as published, and a run that follows them.

#include "equations/examples.h"
#include "equations/rolling.h"
#include "equations/runs.h"

#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/form/coordinate_motion.h>
#include <momenta/dae/study/modes_study.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <complex>

namespace momenta::dae_bicycle {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using equations::column;

/// Weave, capsize and castor of the benchmark bicycle against M, C₁, K₀, K₂ as published: M q̈ + v
/// C₁ q̇ + (g K₀ + v² K₂) q = 0, lean and steer (Meijaard et al. 2007, appendix).
TEST(Bicycle, BicycleOfTheLiterature) {
  Eigen::Matrix2d M, C, K0, K2;
  M << 80.81722, 2.31941332208709, 2.31941332208709, 0.29784188199686;
  C << 0, 33.86641391492494, -0.85035641456978, 1.68540397397560;
  K0 << -80.95, -2.59951685249872, -2.59951685249872, -0.80329488458618;
  K2 << 0, 76.59734589573222, 0, 2.65431523794604;
  const Scene scene = equations::example("bicycle");
  for (int v = 0; v <= 10; ++v) {
    SCOPED_TRACE(v);
    Eigen::Matrix4d system;
    system.topRows<2>() << Eigen::Matrix2d::Zero(), Eigen::Matrix2d::Identity();
    system.bottomRows<2>() << -M.inverse() * (9.81 * K0 + v * v * K2), -M.inverse() * v * C;
    const Eigen::Vector4cd expected =
        Eigen::EigenSolver<MatrixXd>(MatrixXd(system), false).eigenvalues();
    Scene at = scene;
    at.joints[0].velocity = {static_cast<double>(v), 0, 0, 0, 0, 0};
    const Mechanism mechanism(at);
    ModesRequest request;
    request.search = Search::steady;
    const ModesResult result = find_modes(mechanism, assemble(mechanism).start, request);
    EXPECT_EQ(result.steady->positions, 7);
    EXPECT_EQ(result.steady->rates, 3);
    EXPECT_EQ(result.steady->left_out, 5);
    for (const std::complex<double>& s : expected) {
      if (s.imag() < 0) continue;
      double nearest = HUGE_VAL;
      for (const Mode& mode : result.spectrum.modes)
        nearest = std::min(nearest, std::abs(mode.s - s));
      EXPECT_LE(nearest, 2e-12 * (1 + 10 * std::abs(s))) << s;
    }
  }
  // As printed for v = 5 m/s.
  const Mechanism mechanism(scene);
  ModesRequest request;
  request.search = Search::steady;
  const ModesResult result = find_modes(mechanism, assemble(mechanism).start, request);
  const std::array<std::complex<double>, 3> printed{
      {{-0.32286642900409, 0}, {-0.77534188219585, 4.46486771378823}, {-14.07838969279822, 0}}};
  for (const auto& s : printed) {
    double nearest = HUGE_VAL;
    for (const Mode& mode : result.spectrum.modes)
      nearest = std::min(nearest, std::abs(mode.s - s));
    EXPECT_LE(nearest, 2e-12 * (1 + std::abs(s)));
  }
}

/// A run that is disturbed decays as the eigenvalues say: capsize is the slowest at 5 m/s.
TEST(Bicycle, DisturbedBicycleFollowsItsEigenvalues) {
  Scene scene = equations::example("bicycle");
  const Start start = assemble(Mechanism(scene)).start;
  scene.held.clear();
  const Mechanism still(scene);
  ModesRequest request;
  request.search = Search::steady;
  const ModesResult result = find_modes(still, start, request);
  const Mode* capsize = nullptr;
  for (const Mode& mode : result.spectrum.modes)
    if (std::abs(mode.s + 0.32286642900409) < 1e-6) capsize = &mode;
  ASSERT_NE(capsize, nullptr);
  // Along the capsize mode: δ and δ̇.
  CoordinateMotion motion(still);
  const auto e = still.evaluation<double>();
  const double size = 1e-5 / capsize->shape.cwiseAbs().maxCoeff();
  const VectorXd delta = size * capsize->shape.real();
  VectorXd q(still.nq());
  e->place(0, start.q.data());
  motion.move(*e, start.q.data(), delta.data(), q.data());
  const MovingLinearisation l = linearise_moving(still, 0, start.q, start.u, start.lambda, delta);
  const VectorXd u = start.u + capsize->s.real() * delta - l.turning.col(0);
  const Start moved = assemble(still, 0, q, u).start;
  EXPECT_LE((moved.u - u).norm(), 1e-8);
  const RunResult later =
      run_form(still, moved,
               equations::kept(equations::adaptive("projected", "vern9", "none", 1e-13, 2, 2)));
  ASSERT_EQ(later.status, "done") << later.reason;
  EXPECT_NEAR(column(later, "S.q") / moved.q[7], std::exp(capsize->s.real() * 2), 1e-3);
}

}  // namespace
}  // namespace momenta::dae_bicycle
