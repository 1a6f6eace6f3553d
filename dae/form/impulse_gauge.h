#pragma once
// The gauge symmetry of the DAE forms in q, p and σ, as methods use it: resets, shifts of past
// values, and the norm of what moves (dae/integrator/gauge_symmetry.h).

#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/natural_sizes.h>
#include <momenta/dae/integrator/gauge_symmetry.h>

#include <memory>
#include <vector>

namespace momenta {

class ImpulseGauge : public GaugeSymmetry {
 public:
  /// Keeps `natural` by reference.
  ImpulseGauge(const Mechanism& mechanism, const DaeLayout& layout, Gauge gauge,
               const NaturalSizes& natural);

  bool resets() const override { return rule_.kind == Gauge::Kind::reset && places_.m > 0; }
  int impulse_count() const override { return places_.m; }
  const double* impulses(const double* y) const override { return y + places_.s(); }
  int direction_entries() const override;
  void gauge_directions(double t, const double* y, double* entries) override;
  void shift(const double* entries, const double* c, double* y) const override;
  void reset(double t, double* y, double* ydot) override;
  void measure_at(double t, const double* y, const double* ydot, double rtol, double atol) override;
  double coordinate_squares(const double* e) override;
  double motion_squares(const double* e) override;

 private:
  struct Measure {
    explicit Measure(const Mechanism& mechanism);
    std::unique_ptr<Evaluation<double>> e;
    std::unique_ptr<LoopSolver> solver;  ///< null without loops
    double t = 0;
    std::vector<double> q, u, v, p, coordinate_weight, rate_weight;
  };
  Measure& measure();

  const Mechanism& of_;
  DaeLayout places_;
  Gauge rule_;
  const NaturalSizes& natural_;
  std::shared_ptr<Measure> measure_;
};

}  // namespace momenta
