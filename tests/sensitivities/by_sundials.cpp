// Gradients of runs against sensitivities by CVODES and IDAS, which know nothing of steps and
// stages of this project: of y' = f(t, y; θ) forward, s' = f_y s + f_θ, and backward, w' = −f_yᵀ w
// with dJ/dθ = w(0)·y_θ(0) + ∫ w·f_θ dt; of F(t, y, y'; θ) = 0 of index 2 forward, F_y s + F_y' s'
// + F_θ = 0. f_θ, F_θ and y_θ(0) are differences of order 4 of mechanisms made at other θ, products
// with f_y and F_y too, so that no derivative of this project takes part.
//
// A program of its own: CVODES and IDAS define what CVODE and IDA do, and stand before them.

#include "equations/gradient_runs.h"

#include <cvodes/cvodes.h>
#include <gtest/gtest.h>
#include <idas/idas.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/sundials_handles.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <array>
#include <memory>

namespace momenta::by_sundials {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using sundials::check;

constexpr double end = 0.5;          // [s]
constexpr double part = 1e-3;        // of θ, the step of its differences: h⁴ and ε/h alike
constexpr double small_step = 1e-3;  // of the state, in norm, likewise
constexpr double tolerance = 1e-11;  // of the integrators
constexpr double agreement = 2e-8;   // of the gradients, of their largest part
const std::vector<std::string> theta{"crank", "coupler", "mass", "k", "g"};

/// df/dx of order 4 from f at −2h, −h, h, 2h.
template <class F>
VectorXd slope(const F& f, double h) {
  return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h);
}

/// A form of the four-bar at other parameters.
struct Bar {
  Bar(const std::string& form_name, const std::vector<Setting>& settings)
      : mechanism(equations::of_text(equations::four_bar).scene(settings),
                  equations::of_text(equations::four_bar).options),
        start(assemble(mechanism).start) {
    FormOptions options;
    options.gauge.kind = Gauge::Kind::none;
    form = make_form(form_name, mechanism, options, start);
    y = form->initial(start);
    if (form->is_dae()) {
      ydot.resize(y.size());
      EXPECT_TRUE(form->dae()->start(0, y.data(), ydot.data())) << form->dae()->failure();
    } else {
      form->ode()->begin_step(0, y.data());
    }
  }
  VectorXd rates(double t, const VectorXd& at) {
    VectorXd f(at.size());
    EXPECT_TRUE(form->ode()->rhs(t, at.data(), f.data())) << form->ode()->failure();
    return f;
  }
  VectorXd residual(double t, const VectorXd& at, const VectorXd& change) {
    VectorXd f(at.size());
    EXPECT_TRUE(form->dae()->residual(t, at.data(), change.data(), f.data()));
    return f;
  }
  VectorXd state() const { return Map<const VectorXd>(y.data(), static_cast<Index>(y.size())); }
  VectorXd change() const {
    return Map<const VectorXd>(ydot.data(), static_cast<Index>(ydot.size()));
  }

  Mechanism mechanism;
  Start start;
  std::unique_ptr<Form> form;
  std::vector<double> y, ydot;
};

/// The form at θ, and at four places beside it along each θ.
class Problem {
 public:
  explicit Problem(const std::string& form) : bar_(form, {}) {
    const Scene scene = equations::of_text(equations::four_bar).scene();
    for (const std::string& name : theta) {
      double value = 0;
      for (const ParameterSpec& p : scene.parameters)
        if (p.name == name) value = p.value;
      steps_.push_back(part * value);
      auto& beside = beside_.emplace_back();
      for (const int i : {-2, -1, 1, 2})
        beside.push_back(
            std::make_unique<Bar>(form, std::vector<Setting>{{name, value + i * steps_.back()}}));
    }
    place_ = static_cast<Index>(
        bar_.mechanism.tree()
            .bodies[static_cast<std::size_t>(bar_.mechanism.tree().body("rocker"))]
            .q);
  }
  Bar& bar() { return bar_; }
  Index size() { return static_cast<Index>(bar_.y.size()); }
  Index place() const { return place_; }  ///< of C.q

  /// The derivative by θ_i of what `of` computes of a bar.
  template <class Of>
  VectorXd by(std::size_t i, const Of& of) {
    const auto at = [&](double x) -> VectorXd {
      const int step = static_cast<int>(std::lround(x / steps_[i]));
      return of(*beside_[i][static_cast<std::size_t>(step < 0 ? step + 2 : step + 1)]);
    };
    return slope(at, steps_[i]);
  }
  /// f_y v.
  VectorXd along(double t, const VectorXd& y, const VectorXd& v) {
    if (v.norm() == 0) return VectorXd::Zero(v.size());
    const VectorXd way = v / v.norm();
    return v.norm() *
           slope([&](double x) -> VectorXd { return bar_.rates(t, y + x * way); }, small_step);
  }
  /// F_y v + F_y' w.
  VectorXd along(double t, const VectorXd& y, const VectorXd& ydot, const VectorXd& v,
                 const VectorXd& w) {
    const double size = std::hypot(v.norm(), w.norm());
    if (size == 0) return VectorXd::Zero(v.size());
    return size * slope(
                      [&](double x) -> VectorXd {
                        return bar_.residual(t, y + x / size * v, ydot + x / size * w);
                      },
                      small_step);
  }

 private:
  Bar bar_;
  std::vector<double> steps_;
  std::vector<std::vector<std::unique_ptr<Bar>>> beside_;
  Index place_ = 0;
};

Map<VectorXd> numbers(N_Vector v) {
  return {N_VGetArrayPointer(v), static_cast<Index>(N_VGetLength(v))};
}

/// dC.q(end)/dθ by this project.
VectorXd gradient_of(GradientMode mode) {
  GradientRequest request = equations::asked("C.q", theta, "momentum", "none", end, 0);
  request.settings.integrator = "dop853";
  request.settings.rtol = request.settings.atol = 1e-13;
  request.mode = mode;
  const GradientResult result = gradient(equations::of_text(equations::four_bar), request);
  EXPECT_EQ(result.adjoint, mode == GradientMode::adjoint);
  return result.gradient;
}

void expect_gradient(const VectorXd& found, GradientMode mode, double within = agreement) {
  const VectorXd expected = gradient_of(mode);
  EXPECT_GT(expected.cwiseAbs().minCoeff(), 1e-4);
  for (Index i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(found[i], expected[i], within * expected.cwiseAbs().maxCoeff())
        << theta[static_cast<std::size_t>(i)];
}

/// CVODE with what both directions share.
class Cvodes {
 public:
  explicit Cvodes(Problem& problem)
      : problem_(problem),
        y_(static_cast<int>(problem.size()), context_),
        matrix_(SUNDenseMatrix(problem.size(), problem.size(), context_)),
        solver_(SUNLinSol_Dense(y_, matrix_.get(), context_)),
        memory_(sundials::require(CVodeCreate(CV_BDF, context_)), {CVodeFree}) {
    numbers(y_) = problem.bar().state();
    check(CVodeInit(memory_.get(), rates, 0, y_), "CVodeInit");
    check(CVodeSetUserData(memory_.get(), &problem_), "CVodeSetUserData");
    check(CVodeSStolerances(memory_.get(), tolerance, tolerance), "CVodeSStolerances");
    check(CVodeSetLinearSolver(memory_.get(), solver_.get(), matrix_.get()), "linear solver");
    check(CVodeSetMaxNumSteps(memory_.get(), 100'000), "CVodeSetMaxNumSteps");
  }
  static int rates(double t, N_Vector y, N_Vector ydot, void* problem) {
    numbers(ydot) = static_cast<Problem*>(problem)->bar().rates(t, numbers(y));
    return 0;
  }
  const sundials::Context& context() const { return context_; }
  N_Vector y() { return y_; }
  void* get() { return memory_.get(); }

 private:
  Problem& problem_;
  sundials::Context context_;
  sundials::Vector y_;
  sundials::Matrix matrix_;
  sundials::LinearSolver solver_;
  sundials::Integrator memory_;
};

/// One vector for each θ.
class Vectors {
 public:
  Vectors(Index size, const sundials::Context& context) {
    for (std::size_t i = 0; i < theta.size(); ++i)
      all_.push_back(std::make_unique<sundials::Vector>(static_cast<int>(size), context));
    for (auto& one : all_) pointers_.push_back(*one);
  }
  N_Vector* data() { return pointers_.data(); }
  Map<VectorXd> operator[](std::size_t i) { return numbers(pointers_[i]); }

 private:
  std::vector<std::unique_ptr<sundials::Vector>> all_;
  std::vector<N_Vector> pointers_;
};

TEST(SensitivitiesBySundials, ForwardOfTheOrdinaryEquationsAreTheGradient) {
  Problem problem("momentum");
  Cvodes cvodes(problem);
  Vectors s(problem.size(), cvodes.context());
  for (std::size_t i = 0; i < theta.size(); ++i)
    s[i] = problem.by(i, [](Bar& bar) { return bar.state(); });
  const CVSensRhs1Fn sensitivity_rates = [](int, double t, N_Vector y, N_Vector, int i, N_Vector v,
                                            N_Vector vdot, void* given, N_Vector, N_Vector) {
    Problem& p = *static_cast<Problem*>(given);
    const VectorXd at = numbers(y);
    numbers(vdot) = p.along(t, at, numbers(v)) +
                    p.by(static_cast<std::size_t>(i), [&](Bar& bar) { return bar.rates(t, at); });
    return 0;
  };
  check(CVodeSensInit1(cvodes.get(), static_cast<int>(theta.size()), CV_STAGGERED,
                       sensitivity_rates, s.data()),
        "CVodeSensInit1");
  std::vector<double> absolute(theta.size(), tolerance);
  check(CVodeSensSStolerances(cvodes.get(), tolerance, absolute.data()), "CVodeSensSStolerances");
  check(CVodeSetSensErrCon(cvodes.get(), SUNTRUE), "CVodeSetSensErrCon");
  double t = 0;
  check(CVodeSetStopTime(cvodes.get(), end), "CVodeSetStopTime");
  ASSERT_GE(CVode(cvodes.get(), end, cvodes.y(), &t, CV_NORMAL), 0);
  check(CVodeGetSens(cvodes.get(), &t, s.data()), "CVodeGetSens");
  VectorXd found(static_cast<Index>(theta.size()));
  for (std::size_t i = 0; i < theta.size(); ++i)
    found[static_cast<Index>(i)] = s[i][problem.place()];
  expect_gradient(found, GradientMode::forward);
}

TEST(SensitivitiesBySundials, BackwardOfTheOrdinaryEquationsAreTheAdjointsGradient) {
  Problem problem("momentum");
  Cvodes cvodes(problem);
  check(CVodeAdjInit(cvodes.get(), 100, CV_POLYNOMIAL), "CVodeAdjInit");
  double t = 0;
  int checkpoints = 0;
  check(CVodeSetStopTime(cvodes.get(), end), "CVodeSetStopTime");
  ASSERT_GE(CVodeF(cvodes.get(), end, cvodes.y(), &t, CV_NORMAL, &checkpoints), 0);

  const Index size = problem.size();
  sundials::Vector w(static_cast<int>(size), cvodes.context());
  sundials::Vector sums(static_cast<int>(theta.size()), cvodes.context());
  w[static_cast<int>(problem.place())] = 1;
  int which = 0;
  check(CVodeCreateB(cvodes.get(), CV_BDF, &which), "CVodeCreateB");
  const CVRhsFnB back = [](double time, N_Vector y, N_Vector v, N_Vector vdot, void* given) {
    Problem& p = *static_cast<Problem*>(given);
    const VectorXd at = numbers(y);
    for (Index k = 0; k < p.size(); ++k)
      numbers(vdot)[k] = -numbers(v).dot(p.along(time, at, VectorXd::Unit(p.size(), k)));
    return 0;
  };
  const CVQuadRhsFnB sum = [](double time, N_Vector y, N_Vector v, N_Vector rate, void* given) {
    Problem& p = *static_cast<Problem*>(given);
    const VectorXd at = numbers(y);
    for (std::size_t i = 0; i < theta.size(); ++i)
      numbers(rate)[static_cast<Index>(i)] =
          -numbers(v).dot(p.by(i, [&](Bar& bar) { return bar.rates(time, at); }));
    return 0;
  };
  check(CVodeInitB(cvodes.get(), which, back, end, w), "CVodeInitB");
  check(CVodeSetUserDataB(cvodes.get(), which, &problem), "CVodeSetUserDataB");
  check(CVodeSStolerancesB(cvodes.get(), which, tolerance, tolerance), "CVodeSStolerancesB");
  check(CVodeSetMaxNumStepsB(cvodes.get(), which, 100'000), "CVodeSetMaxNumStepsB");
  const sundials::Matrix matrix(SUNDenseMatrix(size, size, cvodes.context()));
  const sundials::LinearSolver solver(SUNLinSol_Dense(w, matrix.get(), cvodes.context()));
  check(CVodeSetLinearSolverB(cvodes.get(), which, solver.get(), matrix.get()), "linear solver");
  check(CVodeQuadInitB(cvodes.get(), which, sum, sums), "CVodeQuadInitB");
  check(CVodeQuadSStolerancesB(cvodes.get(), which, tolerance, tolerance), "quadrature");
  check(CVodeSetQuadErrConB(cvodes.get(), which, SUNTRUE), "CVodeSetQuadErrConB");
  ASSERT_GE(CVodeB(cvodes.get(), 0, CV_NORMAL), 0);
  check(CVodeGetB(cvodes.get(), which, &t, w), "CVodeGetB");
  check(CVodeGetQuadB(cvodes.get(), which, &t, sums), "CVodeGetQuadB");
  VectorXd found = numbers(sums);
  for (std::size_t i = 0; i < theta.size(); ++i)
    found[static_cast<Index>(i)] +=
        numbers(w).dot(problem.by(i, [](Bar& bar) { return bar.state(); }));
  expect_gradient(found, GradientMode::adjoint);
}

TEST(SensitivitiesBySundials, ForwardOfTheDifferentialAlgebraicEquationsAreTheGradient) {
  Problem problem("momentum-index2");
  const sundials::Context context;
  const Index size = problem.size();
  DaeSystem& dae = *problem.bar().form->dae();
  sundials::Vector y(static_cast<int>(size), context), ydot(static_cast<int>(size), context),
      differential(static_cast<int>(size), context), absolute(static_cast<int>(size), context);
  numbers(y) = problem.bar().state(), numbers(ydot) = problem.bar().change();
  // Multipliers stay out of both tests, as in this project's runs: ε/h is their noise at first.
  constexpr double of_index2 = 1e-9;
  for (int i = 0; i < static_cast<int>(size); ++i) {
    differential[i] = dae.differential(i) ? 1 : 0;
    absolute[i] = of_index2 * dae.scale(i);
  }
  const sundials::Integrator ida(sundials::require(IDACreate(context)), {IDAFree});
  const IDAResFn residual = [](double t, N_Vector at, N_Vector change, N_Vector r, void* given) {
    numbers(r) = static_cast<Problem*>(given)->bar().residual(t, numbers(at), numbers(change));
    return 0;
  };
  const IDALsJacFn jacobian = [](double t, double c, N_Vector at, N_Vector change, N_Vector,
                                 SUNMatrix matrix, void* given, N_Vector, N_Vector, N_Vector) {
    Problem& p = *static_cast<Problem*>(given);
    for (Index k = 0; k < p.size(); ++k)
      Map<VectorXd>(SUNDenseMatrix_Column(matrix, k), p.size()) =
          p.along(t, numbers(at), numbers(change), VectorXd::Unit(p.size(), k),
                  c * VectorXd::Unit(p.size(), k));
    return 0;
  };
  check(IDAInit(ida.get(), residual, 0, y, ydot), "IDAInit");
  check(IDASetUserData(ida.get(), &problem), "IDASetUserData");
  check(IDASVtolerances(ida.get(), of_index2, absolute), "IDASVtolerances");
  check(IDASetId(ida.get(), differential), "IDASetId");
  check(IDASetSuppressAlg(ida.get(), SUNTRUE), "IDASetSuppressAlg");
  const sundials::Matrix matrix(SUNDenseMatrix(size, size, context));
  const sundials::LinearSolver solver(SUNLinSol_Dense(y, matrix.get(), context));
  check(IDASetLinearSolver(ida.get(), solver.get(), matrix.get()), "IDASetLinearSolver");
  check(IDASetJacFn(ida.get(), jacobian), "IDASetJacFn");
  check(IDASetMaxNumSteps(ida.get(), 100'000), "IDASetMaxNumSteps");
  check(IDASetInitStep(ida.get(), 1e-4 * end), "IDASetInitStep");

  Vectors s(size, context), sdot(size, context);
  for (std::size_t i = 0; i < theta.size(); ++i) {
    s[i] = problem.by(i, [](Bar& bar) { return bar.state(); });
    sdot[i] = problem.by(i, [](Bar& bar) { return bar.change(); });
  }
  const IDASensResFn sensitivity = [](int count, double t, N_Vector at, N_Vector change, N_Vector,
                                      N_Vector* v, N_Vector* vdot, N_Vector* r, void* given,
                                      N_Vector, N_Vector, N_Vector) {
    Problem& p = *static_cast<Problem*>(given);
    const VectorXd state = numbers(at), rate = numbers(change);
    for (int i = 0; i < count; ++i)
      numbers(r[i]) =
          p.along(t, state, rate, numbers(v[i]), numbers(vdot[i])) +
          p.by(static_cast<std::size_t>(i), [&](Bar& bar) { return bar.residual(t, state, rate); });
    return 0;
  };
  check(IDASensInit(ida.get(), static_cast<int>(theta.size()), IDA_STAGGERED, sensitivity, s.data(),
                    sdot.data()),
        "IDASensInit");
  std::vector<N_Vector> absolute_of_all(theta.size(), absolute);
  check(IDASensSVtolerances(ida.get(), of_index2, absolute_of_all.data()), "IDASensSVtolerances");
  double t = 0;
  check(IDASetStopTime(ida.get(), end), "IDASetStopTime");
  ASSERT_GE(IDASolve(ida.get(), end, &t, y, ydot, IDA_NORMAL), 0);
  check(IDAGetSens(ida.get(), &t, s.data()), "IDAGetSens");
  VectorXd found(static_cast<Index>(theta.size()));
  for (std::size_t i = 0; i < theta.size(); ++i)
    found[static_cast<Index>(i)] = s[i][problem.place()];
  expect_gradient(found, GradientMode::forward, 1e-6);
}

}  // namespace
}  // namespace momenta::by_sundials
