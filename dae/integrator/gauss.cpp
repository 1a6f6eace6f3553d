// y' = f(t, y) by Gauss collocation with fixed steps: symmetric, and symplectic where f is
// Hamiltonian, as (7)-(8) is without dampers and drives: the energy error stays bounded over times
// exponential in 1/h. Orders 4 (s = 2) and 6 (s = 3).
//
// A step: stages to rounding, started from the last step's polynomial; y_new = y + h Σ b_j k_j with
// the rounding of the sum carried along; after_step. A gauge reset there is a translation p −=
// Φ_qᵀσ, which keeps dq∧dp on the tangents of Φ = const. Dense output between steps is the
// collocation polynomial, of order s; a sample is a step of its own from the last step's start.
// Looking on counts nothing and changes nothing. Source: Hairer, Lubich, Wanner, Geometric
// Numerical Integration, II.1, VI.4, VIII.5, VIII.6.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/gauss_stages.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/multistep_run.h>
#include <momenta/dae/integrator/output_cursor.h>

#include <stdexcept>

namespace momenta {
namespace {

template <int s>
class Gauss {
 public:
  Gauss(OdeSystem& system, double t0, const std::vector<double>& y0, double step)
      : system_(system),
        grid_(t0, step),
        stages_(system),
        look_(system),
        n_(y0.size()),
        y_(y0),
        start_(y0),
        new_(n_),
        rounding_(n_, 0.0),
        t0_(t0),
        t1_(t0) {}

  static const char* name() { return s == 2 ? "gauss4" : "gauss6"; }
  double* y() { return y_.data(); }
  double* ydot() { return nullptr; }

  bool step(double& t, double end, std::string& cause) {
    const double t1 = grid_.next(counters_.steps, end), h = grid_.length(t, t1);
    system_.begin_step(t, y_.data());
    guess(stages_, h, 1);
    if (!stages_.solve(t, h, y_.data())) {
      ++counters_.rejected;
      cause = stages_.cause + ", with a step of " + in_words(h) + " s";
      return false;
    }
    start_ = y_;
    for (std::size_t i = 0; i < n_; ++i) {
      // Kahan's sum: `rounding_` is the excess of y_.
      const double change = h * increment(stages_, i) - rounding_[i];
      new_[i] = y_[i] + change;
      rounding_[i] = (new_[i] - y_[i]) - change;
    }
    t0_ = t, t1_ = t1;
    y_ = new_;
    bool changed = false;
    if (system_.has_after_step() && !system_.after_step(t1, y_.data(), changed)) {
      cause = evaluation_cause(system_.failure());
      y_ = start_;
      return false;
    }
    for (std::size_t i = 0; i < n_; ++i)
      if (y_[i] != new_[i]) rounding_[i] = 0;
    if (!all_finite(y_.data(), n_)) {
      cause = "a value that is not a finite number came up";
      y_ = start_;
      return false;
    }
    ++counters_.steps;
    t = t1;
    return true;
  }

  bool at(double t, double* y, double*) {
    const double theta = (t - t0_) / (t1_ - t0_);
    for (std::size_t i = 0; i < n_; ++i) {
      double sum = 0;
      for (int j = 0; j < s; ++j)
        sum += stages_.tableau.weight(j, theta) * stages_.k[static_cast<std::size_t>(j) * n_ + i];
      y[i] = start_[i] + (t1_ - t0_) * sum;
    }
    return true;
  }

  bool sample(double t, double* y, double*) {
    if (std::abs(t - t1_) <= grid_.tolerance()) return std::copy(y_.begin(), y_.end(), y), true;
    if (std::abs(t - t0_) <= grid_.tolerance())
      return std::copy(start_.begin(), start_.end(), y), true;
    guess(look_, t - t0_, 0);
    if (!look_.solve(t0_, t - t0_, start_.data())) return false;
    for (std::size_t i = 0; i < n_; ++i) y[i] = start_[i] + (t - t0_) * increment(look_, i);
    return true;
  }

  const OdeSlopes& slopes() const { return stages_.newton.slopes(); }
  Counters counters() const {
    Counters c = counters_;
    c.evaluations = stages_.evaluations + slopes().evaluations();
    c.jacobians = stages_.newton.jacobians;
    c.factorizations = stages_.newton.factorizations;
    c.newton_iterations = stages_.newton_iterations;
    return c;
  }

 private:
  /// Σ b_j k_j of component i.
  static double increment(const gauss::Stages<s>& stages, std::size_t i) {
    double sum = 0;
    for (int j = 0; j < s; ++j) {
      const auto at = static_cast<std::size_t>(j);
      sum += stages.tableau.b[at] * stages.k[at * stages.z.size() / s + i];
    }
    return sum;
  }

  /// Guesses stages of a step of length h from the last one's end (`from` 1) or start (0), by its
  /// polynomial; zero before the first step.
  void guess(gauss::Stages<s>& stages, double h, double from) {
    const double last = t1_ - t0_;
    const auto& tableau = stages_.tableau;
    for (int row = 0; row < s; ++row) {
      double* z = stages.z.data() + static_cast<std::size_t>(row) * n_;
      std::fill(z, z + n_, 0.0);
      if (last == 0) continue;
      const double theta = from + tableau.c[static_cast<std::size_t>(row)] * h / last;
      for (int j = 0; j < s; ++j) {
        const double weight = last * (tableau.weight(j, theta) - tableau.weight(j, from));
        const double* k = stages_.k.data() + static_cast<std::size_t>(j) * n_;
        for (std::size_t i = 0; i < n_; ++i) z[i] += weight * k[i];
      }
    }
  }

  OdeSystem& system_;
  FixedGrid grid_;
  gauss::Stages<s> stages_, look_;
  std::size_t n_;
  std::vector<double> y_, start_, new_, rounding_;
  double t0_, t1_;  ///< the last step [s]
  Counters counters_;
};

template <int s>
IntegrationResult run(OdeSystem& system, double t0, const std::vector<double>& y0,
                      const std::vector<double>& output_times, const IntegrationOptions& options,
                      const Observer& observer) {
  Gauss<s> method(system, t0, y0, options.step);
  IntegrationResult result;
  MultistepRun<Gauss<s>>(method, system.size(), t0, output_times, options, observer).run(result);
  result.counters = method.counters();
  if (result.counters.jacobians > 0) {
    result.linear_solver = method.slopes().linear_solver();
    result.jacobian = method.slopes().jacobian();
  }
  return result;
}

}  // namespace

IntegrationResult integrate_gauss(int stages, OdeSystem& system, double t0,
                                  const std::vector<double>& y0,
                                  const std::vector<double>& output_times,
                                  const IntegrationOptions& options, const Observer& observer) {
  if (stages != 2 && stages != 3)
    throw std::invalid_argument("Gauss methods of 2 and 3 stages are known");
  if (y0.size() != static_cast<std::size_t>(system.size()))
    throw std::invalid_argument("the start state must have the size of the system");
  if (!(options.step > 0) || !std::isfinite(options.step))
    throw std::invalid_argument(std::string(stages == 2 ? "gauss4" : "gauss6") +
                                " has no error estimate and needs a fixed step > 0");
  return stages == 2 ? run<2>(system, t0, y0, output_times, options, observer)
                     : run<3>(system, t0, y0, output_times, options, observer);
}

namespace {

template <int stages>
IntegrationResult integrate(OdeSystem& system, double t0, const std::vector<double>& y0,
                            const std::vector<double>& output_times,
                            const IntegrationOptions& options, const Observer& observer) {
  return integrate_gauss(stages, system, t0, y0, output_times, options, observer);
}

}  // namespace

Integrator gauss4_integrator() {
  return {.name = "gauss4",
          .projects = true,
          .method = "Gauss collocation, 2 stages, order 4",
          .ode_run = integrate<2>};
}

Integrator gauss6_integrator() {
  return {.name = "gauss6",
          .projects = true,
          .method = "Gauss collocation, 3 stages, order 6",
          .ode_run = integrate<3>};
}

}  // namespace momenta
