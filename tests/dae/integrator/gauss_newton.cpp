// Newton's method for the stages of Gauss methods: ∂f/∂y by the equations that f solves, sparse,
// against the slow ways.
//
//   w − s ∂f/∂y w = r        ∂f/∂y w by central differences of f along w; s real and complex
//   stages                   by substitution, by a dense ∂f/∂y of differences, by the local matrix:
//                            the same steps to rounding, so order, energy and gauge stay as they are

#include <gtest/gtest.h>
#include <momenta/dae/form/ode_form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/ode_slopes.h>
#include <momenta/dae/run/run_form.h>

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/large_scenes.h"
#include "equations/linkages.h"
#include "equations/random_tree.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <complex>

namespace momenta::dae_gauss_newton {
namespace {

using namespace equations;
using equations::example;

enum class By { substitution, dense, local };

/// A form as a method of one kind sees it. Newton's method is asked for by one right-hand side that
/// fails, the second: the iteration by substitution has run away.
class Seen final : public OdeSystem {
 public:
  Seen(OdeForm& form, By by) : form_(form), by_(by) {}
  int size() const override { return form_.size(); }
  bool rhs(double t, const double* y, double* f) override {
    if (++calls_ == 2 && by_ != By::substitution) return fail("asked for");
    return form_.rhs(t, y, f) || fail(form_.failure());
  }
  bool after_step(double t, double* y, bool& changed) override {
    return form_.after_step(t, y, changed) || fail(form_.failure());
  }
  bool has_after_step() const override { return form_.has_after_step(); }
  void begin_step(double t, const double* y) override { form_.begin_step(t, y); }
  double scale(int i) const override { return form_.scale(i); }
  LocalJacobian* local() override { return by_ == By::local ? form_.local_jacobian() : nullptr; }

 private:
  OdeForm& form_;
  By by_;
  long calls_ = 0;
};

struct Asked {
  std::string form;
  FormOptions options;
};
FormOptions with_gauge(const char* gauge, double beta = 0) {
  FormOptions options;
  options.gauge = parse_gauge(gauge);
  options.beta = beta;
  return options;
}
std::vector<Asked> all_asked() {
  FormOptions gains;
  gains.baumgarte_alpha = 3, gains.baumgarte_beta = 5;
  return {{"momentum", with_gauge("none")},
          {"momentum", with_gauge("flip")},
          {"momentum", with_gauge("leak:3")},
          {"momentum", with_gauge("reset", 7)},
          {"acceleration", {}},
          {"projected", {}},
          {"baumgarte", gains},
          {"maximal-coordinates", gains}};
}

struct Made {
  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  Made(const Scene& scene, const Asked& asked)
      : mechanism(scene),
        start(equations::start_of(mechanism)),
        form(make_form(asked.form, mechanism, asked.options, start)) {}
  OdeForm& ode() { return dynamic_cast<OdeForm&>(*form); }
};

/// Largest component of w − s ∂f/∂y w − r over that of its terms, in units of Newton's norm.
template <class Scalar>
double left_over(OdeForm& form, double t, const std::vector<double>& y, Scalar s,
                 std::vector<Scalar> r) {
  Seen system(form, By::local);
  OdeSlopes slopes(system);
  EXPECT_TRUE(slopes.evaluate(t, y.data(), 10)) << slopes.cause();
  EXPECT_STREQ(slopes.jacobian(), "dual numbers");
  Resolvent<Scalar> resolvent;
  EXPECT_TRUE(resolvent.factor(slopes, s));
  std::vector<Scalar> w = r;
  resolvent.solve(w.data());
  const std::size_t n = y.size();
  const auto unit = [&](std::size_t i) { return form.scale(static_cast<int>(i)) + std::abs(y[i]); };
  double size = 0;
  for (std::size_t i = 0; i < n; ++i) size = std::max(size, std::abs(w[i]) / unit(i));
  const double d = 1e-5 / size;
  const auto along = [&](auto part) {
    std::vector<double> ahead = y, behind = y, f(n), g(n);
    for (std::size_t i = 0; i < n; ++i) ahead[i] += d * part(w[i]), behind[i] -= d * part(w[i]);
    EXPECT_TRUE(form.rhs(t, ahead.data(), f.data()));
    EXPECT_TRUE(form.rhs(t, behind.data(), g.data()));
    for (std::size_t i = 0; i < n; ++i) f[i] = (f[i] - g[i]) / (2 * d);
    return f;
  };
  const auto real = along([](Scalar x) { return std::real(x); }),
             imaginary = along([](Scalar x) { return std::imag(x); });
  double error = 0, terms = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Scalar slope = real[i];
    if constexpr (!std::is_same_v<Scalar, double>) slope += Scalar(0, imaginary[i]);
    error = equations::larger(error, std::abs(w[i] - s * slope - r[i]) / unit(i));
    terms = std::max({terms, std::abs(w[i]) / unit(i), std::abs(s * slope) / unit(i)});
  }
  return error / terms;
}

TEST(GaussNewton, SlopesAreThoseOfTheRightHandSide) {
  Scene pendulum;
  pendulum.gravity = {0, -9.81, 0};
  pendulum.bodies = {rod("upper"), rod("lower")};
  pendulum.joints = {hinge("A", "ground", "upper", {0, 0, 0}, -1),
                     hinge("B", "upper", "lower", {1, 0, 0}, 0.5)};
  for (const Scene& scene : {example("four_bar"), example("driven"), row_of_four_bars(4, 1.1, 1),
                             example("spatial_slider_crank"), crossed_bars(6), pendulum}) {
    for (const Asked& asked : all_asked()) {
      Made made(scene, asked);
      RandomTree random(3);
      std::vector<double> y = made.form->initial(made.start);
      const std::size_t n = y.size();
      std::vector<double> r(n);
      std::vector<std::complex<double>> c(n);
      for (std::size_t i = 0; i < n; ++i) {
        const double scale = made.ode().scale(static_cast<int>(i));
        y[i] += 0.1 * scale * random.uniform(-1, 1);
        r[i] = scale * random.uniform(-1, 1);
        c[i] = {scale * random.uniform(-1, 1), scale * random.uniform(-1, 1)};
      }
      EXPECT_LT(left_over(made.ode(), made.start.t, y, 0.07, r), 1e-6)
          << asked.form << " of " << scene.name;
      EXPECT_LT(left_over(made.ode(), made.start.t, y, std::complex<double>(0.05, 0.03), c), 1e-6)
          << asked.form << " of " << scene.name;
    }
  }
}

std::vector<double> steps(const Scene& scene, const Asked& asked, int stages, By by, double h) {
  Made made(scene, asked);
  Seen system(made.ode(), by);
  IntegrationOptions options;
  options.step = h;
  const auto run = integrate_gauss(stages, system, made.start.t, made.form->initial(made.start),
                                   {made.start.t + 20 * h}, options, {});
  EXPECT_TRUE(run.done) << run.reason;
  EXPECT_EQ(run.counters.jacobians > 0, by != By::substitution);
  EXPECT_EQ(run.linear_solver, by == By::local ? "KLU, local" : by == By::dense ? "dense LU" : "");
  EXPECT_EQ(run.jacobian, by == By::local   ? "dual numbers"
                          : by == By::dense ? "difference quotient"
                                            : "");
  return run.y;
}

TEST(GaussNewton, SameStepsHoweverStagesAreSolved) {
  for (const Scene& scene :
       {example("four_bar"), example("driven"), crossed_bars(6), flying_rod()}) {
    for (const Asked& asked : all_asked()) {
      for (const int stages : {2, 3}) {
        const auto plain = steps(scene, asked, stages, By::substitution, 0.01),
                   dense = steps(scene, asked, stages, By::dense, 0.01),
                   local = steps(scene, asked, stages, By::local, 0.01);
        for (std::size_t i = 0; i < plain.size(); ++i) {
          const double tolerance = 1e-11 * (1 + std::abs(plain[i]));
          EXPECT_NEAR(dense[i], plain[i], tolerance) << asked.form << " of " << scene.name;
          EXPECT_NEAR(local[i], plain[i], tolerance) << asked.form << " of " << scene.name;
        }
      }
    }
  }
}

TEST(GaussNewton, LargeStiffMechanismsByTheLocalMatrix) {
  Scene scene = row_of_four_bars(40, 1.1, 1);
  for (JointSpec& joint : scene.joints)
    if (joint.parent != "ground") joint.stiffness = 1e6, joint.rest = joint.position.at(0);
  for (const char* integrator : {"gauss4", "gauss6"}) {
    const Mechanism mechanism(scene);
    const RunResult run =
        run_form(mechanism, equations::start_of(mechanism),
                 equations::stepped("momentum", integrator, "flip", 0.01, 0.5, 50));
    ASSERT_EQ(run.status, "done") << run.reason;
    EXPECT_EQ(run.linear_solver, "KLU, local");
    EXPECT_EQ(run.jacobian, "dual numbers");
    EXPECT_LT(run.counters.evaluations, 50 * 60) << "a difference quotient takes 241 at once";
  }
}

}  // namespace
}  // namespace momenta::dae_gauss_newton
