#pragma once
// What the laws of half-explicit methods share: errors of fixed steps against the ODE form, and
// index 2 in a gauge that is changed at random.

#include "equations/ensemble.h"
#include "equations/parts.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/gauge_symmetry.h>
#include <momenta/dae/integrator/half_explicit.h>
#include <momenta/dae/integrator/integrators.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

namespace momenta::equations {

struct Errors {
  double q, x, multiplier;  ///< x: u or p
};

/// Largest errors at the quarters of a run of so many steps, a multiple of four, against a run of
/// another method at 1e-14 on the ODE form of the same unknowns, with the same gauge.
class Halving {
 public:
  Halving(const char* method, const Scene& scene, const std::string& form, double end,
          const char* gauge = "leak", const char* reference = "dop853")
      : method_(method), mechanism_(scene), start_(start_of(mechanism_)), form_(form), end_(end) {
    if (form == "momentum-index2") options_.gauge = parse_gauge(gauge);
    const auto ode = make_form(form == "momentum-index2" ? "momentum" : "acceleration", mechanism_,
                               options_, start_);
    IntegrationOptions tight;
    tight.rtol = tight.atol = 1e-14;
    Observer observer;
    observer.sample = [&](double t, const double* y, const double*) {
      Exact exact{t, {y, y + ode->ode()->size()}, {}};
      EXPECT_TRUE(ode->read(t, y, nullptr, exact.read));
      exact_.push_back(exact);
      return true;
    };
    // Each quarter from the start: samples of the reference would be dense output.
    for (int i = 1; i <= 4; ++i) {
      const auto truth = integrate_explicit(reference, *ode->ode(), 0, ode->initial(start_),
                                            {0.25 * i * end}, tight, observer);
      EXPECT_TRUE(truth.done) << truth.reason;
    }
  }
  /// `beyond`: the part of a further step in which the end, then looked at alone, lies.
  Errors with(int steps, double beyond = 0) const {
    const auto form = make_form(form_, mechanism_, options_, start_);
    const int nq = mechanism_.nq(), n = nq + mechanism_.nv();
    IntegrationOptions options;
    options.step = end_ / (steps + beyond);
    std::vector<double> times;
    for (const Exact& at : exact_)
      if (beyond == 0 || at.t == end_) times.push_back(at.t);
    if (beyond > 0) times.push_back(options.step * (steps + 1));
    Errors errors{0, 0, 0};
    Observer observer;
    observer.sample = [&](double t, const double* y, const double*) {
      for (const Exact& exact : exact_) {
        if (exact.t != t) continue;
        const auto largest = [&](int from, int to, const double* known, double& error) {
          for (int i = from; i < to; ++i) error = larger(error, std::abs(y[i] - *known++));
        };
        largest(0, nq, exact.y.data(), errors.q);
        largest(nq, n, exact.y.data() + nq, errors.x);
        largest(n, n + mechanism_.m(), exact.read.multipliers.data(), errors.multiplier);
      }
      return true;
    };
    const auto run = integrate(method_, *form->dae(), 0, times, options, observer);
    EXPECT_TRUE(run.done) << run.reason;
    EXPECT_EQ(run.counters.steps, steps + (beyond > 0));
    return errors;
  }

 private:
  struct Exact {
    double t;
    std::vector<double> y;
    Snapshot read;
  };
  std::string method_;
  Mechanism mechanism_;
  Start start_;
  std::string form_;
  double end_;
  FormOptions options_;
  std::vector<Exact> exact_;
};

inline Scene example_of(const char* name) {
  return read_scene(std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / name / "scene.toml");
}

/// The four-bar's crank turned by a prescribed motion, cut at the crank's hinge.
inline Scene driven_crank() {
  Scene scene = example_of("four_bar");
  scene.drives.push_back(polynomial("O", {1.5707963267948966, 4, 0.5}));
  scene.held.clear();
  return scene;
}

/// momentum-index2 whose p is put into another gauge after each step, by a constant of any size.
class InAnyGauge : public DaeSystem, public HalfExplicit, public GaugeSymmetry {
 public:
  InAnyGauge(DaeSystem& system, double size)
      : system_(system),
        parts_(dynamic_cast<HalfExplicit&>(system)),
        gauge_(dynamic_cast<GaugeSymmetry&>(system)),
        any_(-size, size),
        entries_(static_cast<std::size_t>(gauge_.direction_entries())),
        c_(static_cast<std::size_t>(gauge_.impulse_count())) {}

  bool meet(double t, double* y) override { return parts_.meet(t, y); }

  /// Called where a step ends, and the method finds σ + c by itself.
  void normalise(double* y) override {
    parts_.normalise(y);
    for (double& c : c_) c = any_(chance_);
    gauge_.gauge_directions(0, y, entries_.data());
    gauge_.shift(entries_.data(), c_.data(), y);
  }

  int size() const override { return system_.size(); }
  bool residual(double t, const double* y, const double* ydot, double* r) override {
    return system_.residual(t, y, ydot, r);
  }
  bool jacobian(double t, const double* y, const double* ydot, double c, double* v) override {
    return system_.jacobian(t, y, ydot, c, v);
  }
  const JacobianPattern& pattern() const override { return system_.pattern(); }
  bool start(double t, double* y, double* ydot) override { return system_.start(t, y, ydot); }
  bool differential(int i) const override { return system_.differential(i); }
  double scale(int i) const override { return system_.scale(i); }
  int differential_unknowns() const override { return parts_.differential_unknowns(); }
  int multipliers() const override { return parts_.multipliers(); }
  bool consistent(double t, const double* y, double* z, double* f) override {
    return parts_.consistent(t, y, z, f);
  }
  bool advance(double t, const double* y, double t_next, const double* base, double w, bool exact,
               double* z, double* f) override {
    return parts_.advance(t, y, t_next, base, w, exact, z, f);
  }
  std::string dependent(double t, const double* y) override { return parts_.dependent(t, y); }
  Pivots pivots() const override { return parts_.pivots(); }
  const std::string& half_explicit_failure() const override {
    return parts_.half_explicit_failure();
  }
  bool resets() const override { return gauge_.resets(); }
  int impulse_count() const override { return gauge_.impulse_count(); }
  const double* impulses(const double* y) const override { return gauge_.impulses(y); }
  int direction_entries() const override { return gauge_.direction_entries(); }
  void gauge_directions(double t, const double* y, double* entries) override {
    gauge_.gauge_directions(t, y, entries);
  }
  void shift(const double* entries, const double* c, double* y) const override {
    gauge_.shift(entries, c, y);
  }
  void reset(double t, double* y, double* ydot) override { gauge_.reset(t, y, ydot); }
  void measure_at(double t, const double* y, const double* ydot, double rtol,
                  double atol) override {
    gauge_.measure_at(t, y, ydot, rtol, atol);
  }
  double coordinate_squares(const double* e) override { return gauge_.coordinate_squares(e); }
  double motion_squares(const double* e) override { return gauge_.motion_squares(e); }

 private:
  DaeSystem& system_;
  HalfExplicit& parts_;
  GaugeSymmetry& gauge_;
  std::mt19937 chance_{7};
  std::uniform_real_distribution<double> any_;
  std::vector<double> entries_, c_;
};

/// With a reset a step is the same, but for rounding, whatever constant was added to σ before it:
/// the four-bar over a second in steps of `step` [s], Andrews' squeezer over a hundredth of one in
/// steps of a hundredth.
inline void expect_the_same_motion_in_every_gauge(const char* method, double step) {
  for (const char* name : {"four_bar", "andrews"}) {
    SCOPED_TRACE(name);
    const bool fast = name[0] == 'a';
    const Mechanism mechanism(example_of(name));
    const Start start = start_of(mechanism);
    const auto run = [&](double size) {
      FormOptions options;
      options.gauge = parse_gauge("reset");
      const auto form = make_form("momentum-index2", mechanism, options, start);
      InAnyGauge shifted(*form->dae(), size);
      IntegrationOptions fixed;
      fixed.step = fast ? 0.01 * step : step;
      const auto result = integrate(method, shifted, 0, {fast ? 0.01 : 1.0}, fixed, {});
      EXPECT_TRUE(result.done) << result.reason;
      return result.y;
    };
    // Impulses of the loops over the whole run are as large.
    const auto still = run(0), moved = run(fast ? 1 : 10);
    for (std::size_t i = 0; i < static_cast<std::size_t>(mechanism.nq()); ++i)
      EXPECT_NEAR(still[i], moved[i], 1e-11) << i;
  }
}

}  // namespace momenta::equations
