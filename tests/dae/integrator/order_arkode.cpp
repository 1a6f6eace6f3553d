// ARKODE's explicit Runge-Kutta as a second opinion: the same tableau on the same fixed steps must
// give the same numbers, and at a tight tolerance both must reach the same end.

#include <arkode/arkode_erkstep.h>
#include <gtest/gtest.h>
#include <momenta/dae/integrator/integration.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <cmath>
#include <vector>

namespace momenta::dae_order_arkode {
namespace {

/// Planar Kepler orbit of eccentricity 0.3 in a field that turns slowly with time: nonlinear and
/// non-autonomous.
void field(double t, const double* y, double* ydot) {
  const double r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * std::sqrt(r2);
  ydot[0] = y[2];
  ydot[1] = y[3];
  ydot[2] = -y[0] / r3 + 0.01 * std::cos(t);
  ydot[3] = -y[1] / r3 + 0.01 * std::sin(t);
}

class Orbit final : public OdeSystem {
 public:
  int size() const override { return 4; }
  bool rhs(double t, const double* y, double* ydot) override {
    field(t, y, ydot);
    return true;
  }
};

const std::vector<double> start{0.7, 0, 0, std::sqrt(1.3 / 0.7)};

int arkode_field(realtype t, N_Vector y, N_Vector ydot, void*) {
  field(t, N_VGetArrayPointer(y), N_VGetArrayPointer(ydot));
  return 0;
}

/// A post-processing step, even an empty one, makes the library forget its last stage, which for
/// tableaux with c = 1 that are not FSAL it would otherwise take for the first stage of the next
/// step.
int keep(realtype, N_Vector, void*) {
  return 0;
}

std::vector<double> arkode(double step, double tolerance, double end) {
  SUNContext context = nullptr;
  EXPECT_EQ(SUNContext_Create(nullptr, &context), 0);
  N_Vector y = N_VNew_Serial(4, context);
  std::copy(start.begin(), start.end(), N_VGetArrayPointer(y));
  void* memory = ERKStepCreate(arkode_field, 0, y, context);
  EXPECT_EQ(ERKStepSetTableNum(memory, ARKODE_DORMAND_PRINCE_7_4_5), ARK_SUCCESS);
  EXPECT_EQ(ERKStepSetPostprocessStepFn(memory, keep), ARK_SUCCESS);
  EXPECT_EQ(ERKStepSStolerances(memory, tolerance, tolerance), ARK_SUCCESS);
  EXPECT_EQ(ERKStepSetMaxNumSteps(memory, 1000000), ARK_SUCCESS);
  if (step > 0) {
    EXPECT_EQ(ERKStepSetFixedStep(memory, step), ARK_SUCCESS);
  }
  EXPECT_EQ(ERKStepSetStopTime(memory, end), ARK_SUCCESS);
  realtype t = 0;
  EXPECT_GE(ERKStepEvolve(memory, end, y, &t, ARK_NORMAL), 0);
  std::vector<double> result(N_VGetArrayPointer(y), N_VGetArrayPointer(y) + 4);
  ERKStepFree(&memory);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return result;
}

std::vector<double> own(const std::string& method, double step, double tolerance, double end) {
  Orbit orbit;
  IntegrationOptions options;
  options.step = step;
  options.rtol = options.atol = tolerance;
  const auto result = integrate_explicit(method, orbit, 0, start, {end}, options, {});
  EXPECT_TRUE(result.done) << result.reason;
  return result.y;
}

TEST(ExplicitAgainstArkode, SameTableauOnSameStepsGivesTheSameNumbers) {
  const double step = 1.0 / 64, end = 4;  // steps that add up without rounding
  const auto a = arkode(step, 1e-6, end), b = own("dp5", step, 1e-6, end);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(a[i], b[i], 256 * 1e-15 * 10) << i;  // 256 steps of rounding
}

TEST(ExplicitAgainstArkode, TightTolerancesMeet) {
  const double promise = 1e-12, end = 10;
  const auto a = arkode(0, promise, end);
  for (const char* method : {"dp5", "dop853", "vern9"}) {
    const auto b = own(method, 0, promise, end);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(a[i], b[i], 1000 * promise) << method << " " << i;
  }
}

}  // namespace
}  // namespace momenta::dae_order_arkode
