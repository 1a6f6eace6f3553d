// The loop over steps of the explicit integrators and the forms it calls take no memory: every call
// of the global operator new from the tenth step on is counted. The operators here are weak, so
// that another file of the same program may bring its own; the test then finds its counter still
// and skips, as it does where a sanitizer owns the heap.

#include "equations/ensemble.h"
#include "equations/examples.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <cstdlib>
#include <new>

#if !defined(__SANITIZE_ADDRESS__)

namespace {
long allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* p = alignment > alignof(std::max_align_t)
                ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                : std::malloc(size > 0 ? size : 1);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace

__attribute__((weak)) void* operator new(std::size_t size) {
  return counted(size, 0);
}
__attribute__((weak)) void* operator new[](std::size_t size) {
  return counted(size, 0);
}
__attribute__((weak)) void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
__attribute__((weak)) void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
__attribute__((weak)) void operator delete(void* p) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p, std::align_val_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
__attribute__((weak)) void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace momenta::dae_solver_allocation {
namespace {

/// One call of new that no compiler may leave out.
void touch_heap() {
  double* volatile p = new double[1000];
  delete[] p;
}

class Pendulums : public OdeSystem {
 public:
  int size() const override { return 14; }
  bool rhs(double, const double* y, double* ydot) override {
    for (int i = 0; i < 7; ++i) {
      ydot[i] = y[7 + i];
      ydot[7 + i] = -std::sin(y[i]);
    }
    return true;
  }
  bool has_after_step() const override { return true; }
  bool after_step(double, double*, bool& changed) override { return changed = true; }
};

TEST(Allocation, NoneAfterTheTenthStep) {
  const long before = allocations;
  touch_heap();
  if (allocations == before) GTEST_SKIP() << "another operator new is linked in";

  for (const char* method : {"rk4", "dp5", "dop853", "vern9"}) {
    Pendulums system;
    IntegrationOptions options;
    if (method[0] == 'r') options.step = 0.01;
    const std::vector<double> y0(14, 1.0);
    std::vector<double> times;
    for (int i = 1; i <= 400; ++i) times.push_back(0.0503 * i);
    long steps = 0, at_tenth = 0, at_last = 0;
    double between_sum = 0;
    Observer observer;
    observer.step = [&](double t0, double t1, const Interpolant& between) {
      double y[14];
      between(0.3 * t0 + 0.7 * t1, y);
      between_sum += y[0];
      if (++steps == 10) at_tenth = allocations;
      at_last = allocations;
      return true;
    };
    observer.sample = [&](double, const double* y, const double*) { return std::isfinite(y[0]); };
    const IntegrationResult r = integrate_explicit(method, system, 0, y0, times, options, observer);
    EXPECT_TRUE(r.done) << r.reason;
    EXPECT_GT(steps, 20);
    EXPECT_EQ(at_last, at_tenth) << method;
    EXPECT_TRUE(std::isfinite(between_sum));
  }
}

// Of the heap of C++; what Eigen takes by itself is not seen.
TEST(Allocation, NoneInStepsOfForms) {
  const long before = allocations;
  touch_heap();
  if (allocations == before) GTEST_SKIP() << "another operator new is linked in";

  const Mechanism mechanism(equations::example("four_bar"));
  const Start start = equations::start_of(mechanism);
  for (const std::string& name : form_names()) {
    if (is_dae_form(name)) continue;
    FormOptions options;
    options.gauge.kind = Gauge::Kind::reset;
    options.project = true;
    const auto form = make_form(name, mechanism, options, start);
    OdeSystem& ode = *form->ode();
    auto y = form->initial(start);
    std::vector<double> ydot(y.size());
    const auto step = [&] {
      bool changed = false;
      bool ok = ode.rhs(0, y.data(), ydot.data()) && ode.after_step(0, y.data(), changed);
      ode.begin_step(0, y.data());
      return ok;
    };
    ASSERT_TRUE(step() && step()) << name << ode.failure();
    const long at_second = allocations;
    for (int i = 0; i < 20; ++i) EXPECT_TRUE(step());
    EXPECT_EQ(allocations, at_second) << name;
  }
}

// Neither do steps of methods for DAEs, failed ones and changes of order included. Of the heap of
// C++; KLU's and LAPACK's are not seen.
TEST(Allocation, NoneInStepsOnDaes) {
  const long before = allocations;
  touch_heap();
  if (allocations == before) GTEST_SKIP() << "another operator new is linked in";

  const Mechanism mechanism(equations::example("four_bar"));
  const Start start = equations::start_of(mechanism);
  const struct {
    const char *method, *form, *gauge;
  } cases[] = {{"hem5", "acceleration-index2", "none"}, {"hem5", "momentum-index2", "leak"},
               {"hem5", "momentum-index2", "reset"},    {"hem8", "acceleration-index2", "none"},
               {"hem8", "momentum-index2", "leak"},     {"hem8", "momentum-index2", "reset"},
               {"bdf5", "momentum-index2", "reset"},    {"bdf5", "momentum-index2", "leak"},
               {"bdf5", "momentum-index1", "reset"},    {"bdf5", "stabilised-index2", "none"},
               {"bdf5", "acceleration-index2", "none"}};
  for (const auto& c : cases) {
    SCOPED_TRACE(std::string(c.method) + " " + c.form + " " + c.gauge);
    FormOptions form_options;
    form_options.gauge = parse_gauge(c.gauge);
    const auto form = make_form(c.form, mechanism, form_options, start);
    IntegrationOptions options;
    options.rtol = options.atol = 1e-7;
    long steps = 0, at_hundredth = 0, at_last = 0;
    Observer observer;
    observer.step = [&](double, double, const Interpolant&) {
      if (++steps == 100) at_hundredth = allocations;
      at_last = allocations;
      return true;
    };
    observer.sample = [&](double, const double* y, const double*) { return std::isfinite(y[0]); };
    std::vector<double> times;
    for (int i = 1; i <= 400; ++i) times.push_back(0.0253 * i);
    const IntegrationResult r = integrate(c.method, *form->dae(), 0, times, options, observer);
    EXPECT_TRUE(r.done) << r.reason;
    EXPECT_GT(steps, 120);
    EXPECT_EQ(at_last, at_hundredth);
  }
}

}  // namespace
}  // namespace momenta::dae_solver_allocation

#endif
