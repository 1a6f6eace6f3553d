// Orders of the implicit methods: halving the step divides the error by 2^order.
//
//   gauss4, gauss6      Kepler's orbit, which closes after 2π: 4 and 6 at the steps' ends
//   radau5              the Cartesian pendulum (q, v; λ) by the constraint it keeps: on q, v, λ
//                       5, 5, 3 in index 2; at least 4, 3, 2 in index 3 (Hairer, Lubich, Roche)
//   rattle, energy-momentum, generalised-alpha, bayo-ledesma   four-bar and a flying rod with
//                       spherical joints, whose q' is not v: 2; a pivot that moves as prescribed

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include "equations/cartesian_pendulum.h"
#include "equations/ensemble.h"
#include "equations/linkages.h"
#include "equations/tolerance.h"

#include <cmath>
#include <filesystem>
#include <numbers>

namespace momenta::dae_order_implicit {
namespace {

using namespace equations;

double slope(double coarse, double fine, double halvings) {
  return std::log2(coarse / fine) / halvings;
}

class Orbit final : public OdeSystem {
 public:
  int size() const override { return 4; }
  bool rhs(double, const double* y, double* ydot) override {
    const double r2 = y[0] * y[0] + y[1] * y[1], r3 = r2 * std::sqrt(r2);
    ydot[0] = y[2], ydot[1] = y[3], ydot[2] = -y[0] / r3, ydot[3] = -y[1] / r3;
    return true;
  }
};

/// Of one orbit of eccentricity 0.3 in so many steps.
double orbit_error(int stages, int steps) {
  const std::vector<double> start{0.7, 0, 0, std::sqrt(1.3 / 0.7)};
  const double period = 2 * std::numbers::pi;
  Orbit orbit;
  IntegrationOptions options;
  options.step = period / steps;
  const auto run = integrate_gauss(stages, orbit, 0, start, {period}, options, {});
  EXPECT_TRUE(run.done) << run.reason;
  EXPECT_EQ(run.counters.steps, steps);
  double error = 0;
  for (std::size_t i = 0; i < 4; ++i)
    error = equations::larger(error, std::abs(run.y[i] - start[i]));
  return error;
}

TEST(ImplicitOrder, GaussAtTheEndsOfSteps) {
  EXPECT_NEAR(slope(orbit_error(2, 64), orbit_error(2, 256), 2), 4, 0.2);
  EXPECT_NEAR(slope(orbit_error(3, 32), orbit_error(3, 128), 2), 6, 0.3);
}

TEST(ImplicitOrder, GaussSamplesAreAsAccurateAsEnds) {
  // One coarse step, looked at inside: an error of order h^(2s+1), not h^(s+1).
  const std::vector<double> start{0.7, 0, 0, std::sqrt(1.3 / 0.7)};
  for (const int stages : {2, 3}) {
    const auto worst = [&](double h) {
      double error = 0;
      for (const double part : {0.3, 0.8}) {
        Orbit orbit, fine;
        IntegrationOptions options, tight;
        options.step = h;
        tight.rtol = tight.atol = 1e-14;
        std::vector<double> seen;
        Observer look;
        look.sample = [&](double, const double* y, const double*) {
          if (seen.empty()) seen.assign(y, y + 4);
          return true;
        };
        EXPECT_TRUE(integrate_gauss(stages, orbit, 0, start, {part * h, h}, options, look).done);
        const auto truth = integrate_explicit("dop853", fine, 0, start, {part * h}, tight, {});
        for (std::size_t i = 0; i < 4; ++i)
          error = equations::larger(error, std::abs(seen[i] - truth.y[i]));
      }
      return error;
    };
    EXPECT_NEAR(slope(worst(0.4), worst(0.1), 2), 2 * stages + 1, 0.7) << stages;
  }
}

struct Errors {
  double q, v, lambda;
};

Errors pendulum_errors(int index, int steps) {
  const double end = 1.5;
  CartesianPendulum system(index);
  IntegrationOptions options;
  options.rtol = options.atol = 1e-13;
  options.step = end / steps;
  const auto run = integrate_radau5(system, 0, {end}, options, {});
  EXPECT_TRUE(run.done) << run.reason;
  EXPECT_EQ(run.counters.steps, steps);
  const auto truth = CartesianPendulum::exact(end);
  const auto off = [&](std::size_t i) { return std::abs(run.y[i] - truth[i]); };
  return {std::max(off(0), off(1)), std::max(off(2), off(3)), off(4)};
}

TEST(ImplicitOrder, RadauOnThePendulumByIndex) {
  const Errors a = pendulum_errors(2, 32), b = pendulum_errors(2, 128);
  EXPECT_NEAR(slope(a.q, b.q, 2), 5, 0.3);
  EXPECT_NEAR(slope(a.v, b.v, 2), 5, 0.3);
  EXPECT_NEAR(slope(a.lambda, b.lambda, 2), 3, 0.3);
  const Errors c = pendulum_errors(3, 32), d = pendulum_errors(3, 128);
  EXPECT_GT(slope(c.q, d.q, 2), 3.8);
  EXPECT_GT(slope(c.v, d.v, 2), 2.8);
  EXPECT_GT(slope(c.lambda, d.lambda, 2), 1.9);
}

TEST(ImplicitOrder, MethodsOfSecondOrderOnMechanisms) {
  const std::filesystem::path examples = std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples";
  const Scene four_bar = read_scene(examples / "four_bar" / "scene.toml");
  const Scene driven = read_scene(examples / "driven" / "scene.toml");
  for (const Scene& scene : {four_bar, flying_rod(), driven}) {
    const Mechanism mechanism(scene);
    const Start start = equations::start_of(mechanism);
    const double end = 1;
    const auto momentum = make_form("momentum", mechanism, {}, start);
    IntegrationOptions tight;
    tight.rtol = tight.atol = 1e-13;
    const auto truth = integrate_explicit("dop853", *momentum->ode(), 0, momentum->initial(start),
                                          {end}, tight, {});
    ASSERT_TRUE(truth.done) << truth.reason;
    Snapshot exact;
    ASSERT_TRUE(momentum->read(end, truth.y.data(), nullptr, exact));
    const auto errors = [&](const std::string& method, int steps) {
      const bool canonical = method == "rattle" || method == "energy-momentum";
      const auto form =
          make_form(canonical ? "momentum" : "acceleration-index3", mechanism, {}, start);
      IntegrationOptions options;
      options.rtol = options.atol = 1e-10;
      options.step = end / steps;
      const auto run =
          method == "rattle"
              ? integrate_rattle(*form->ode(), 0, form->initial(start), {end}, options, {})
          : canonical
              ? integrate_energy_momentum(*form->ode(), 0, form->initial(start), {end}, options, {})
          : method == "bayo-ledesma"
              ? integrate_bayo_ledesma(*form->dae(), 0, {end}, options, {})
              : integrate_generalised_alpha(*form->dae(), 0, {end}, options, {});
      EXPECT_TRUE(run.done) << run.reason;
      Snapshot found;
      EXPECT_TRUE(form->read(end, run.y.data(), nullptr, found));
      return Errors{(found.q - exact.q).cwiseAbs().maxCoeff(),
                    (found.u - exact.u).cwiseAbs().maxCoeff(), 0};
    };
    for (const std::string method :
         {"rattle", "energy-momentum", "generalised-alpha", "bayo-ledesma"}) {
      if (method[0] != 'g' && method[0] != 'b' && mechanism.plan().drives) continue;
      const Errors coarse = errors(method, 100), fine = errors(method, 400);
      EXPECT_NEAR(slope(coarse.q, fine.q, 2), 2, 0.2) << scene.name << " " << method;
      EXPECT_NEAR(slope(coarse.v, fine.v, 2), 2, 0.2) << scene.name << " " << method;
    }
  }
}

}  // namespace
}  // namespace momenta::dae_order_implicit
