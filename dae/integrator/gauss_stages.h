#pragma once
// The stages of one Gauss step, solved to rounding:
//
//   Z_i = h Σ_j a_ij k_j,  k_j = f(t + c_j h, y + Z_j).
//
// Symplecticity and the absence of energy drift are those of the exact stages, so the iteration
// goes on until its corrections are rounding. Fixed-point iteration first: it contracts as h
// ‖∂f/∂y‖; where it does not, simplified Newton iteration (gauss_newton.h), from then on. ∂f/∂y is
// that in the middle of a step, at the y of its start, and is kept from step to step until the
// iteration does not converge with it. Source: Hairer, Lubich, Wanner, Geometric Numerical
// Integration, VIII.6.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/gauss_newton.h>
#include <momenta/dae/integrator/integration.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace momenta::gauss {

template <int s>
class Stages {
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  /// Corrections over the unknowns' sizes: nothing is left to gain at `reached`; once they stop
  /// shrinking, `rounding` is that of f.
  static constexpr double reached = 2 * epsilon, rounding = 1e-11;
  static constexpr int most_fixed_point = 50, most_newton = 30;

 public:
  explicit Stages(OdeSystem& system)
      : system_(system),
        n_(static_cast<std::size_t>(system.size())),
        scale_(n_),
        argument_(n_),
        change_(s * n_),
        newton(system, tableau),
        z(s * n_),
        k(s * n_) {
    for (std::size_t i = 0; i < n_; ++i) scale_[i] = system.scale(static_cast<int>(i));
  }

 private:
  OdeSystem& system_;
  std::size_t n_;
  std::vector<double> scale_, argument_, change_;

 public:
  Collocation<s> tableau;
  Newton<s> newton;
  std::vector<double> z, k;  ///< n values a stage: Z_i, a guess on entry, and k_i
  long evaluations = 0, newton_iterations = 0;  ///< f at stages; Newton's corrections
  std::string cause;

  bool solve(double t, double h, const double* y) {
    guess_ = z;
    if (!by_newton_) {
      const Sweep outcome = iterate(t, h, y, false);
      if (outcome != Sweep::no_contraction) return outcome == Sweep::converged;
      by_newton_ = true;
    }
    if (newton.known() && newton.factor(h)) {
      z = guess_;
      if (iterate(t, h, y, true) == Sweep::converged) return true;
    }
    z = guess_;
    if (!newton.differentiate(t, h, y)) return fail(newton.slopes().cause());
    if (!newton.factor(h)) return fail("the Newton matrix is singular");
    const Sweep outcome = iterate(t, h, y, true);
    if (outcome == Sweep::converged) return true;
    return fail(outcome == Sweep::failed ? cause : "the stages did not converge");
  }

 private:
  enum class Sweep { converged, no_contraction, failed };

  bool fail(std::string why) {
    cause = std::move(why);
    newton.forget();
    return false;
  }

  Sweep iterate(double t, double h, const double* y, bool by_newton) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double last = infinity, smallest = infinity;
    std::array<double, 4> before;  // sizes of the last corrections
    before.fill(infinity);
    const int most = by_newton ? most_newton : most_fixed_point;
    for (int count = 1; count <= most; ++count) {
      for (int j = 0; j < s; ++j) {
        const std::size_t base = at(j) * n_;
        for (std::size_t i = 0; i < n_; ++i) argument_[i] = y[i] + z[base + i];
        ++evaluations;
        // A diverging iteration may put a stage where f has no value.
        if (!system_.rhs(t + tableau.c[at(j)] * h, argument_.data(), k.data() + base)) {
          cause = system_.failure().empty() ? "an evaluation of the equations failed"
                                            : system_.failure();
          return by_newton ? Sweep::failed : Sweep::no_contraction;
        }
      }
      if (!all_finite(k.data(), k.size())) {
        cause = "a value that is not a finite number came up";
        return by_newton ? Sweep::failed : Sweep::no_contraction;
      }
      const double size = by_newton ? newton_correction(h, y) : fixed_point_correction(h, y);
      if (!std::isfinite(size)) return Sweep::no_contraction;
      if (size <= reached) return Sweep::converged;
      if (size >= last && size <= rounding) return Sweep::converged;
      // Large momenta in a free gauge make corrections grow before they shrink: a fall by four in
      // four iterations counts.
      smallest = std::min(smallest, size);
      double& old = before[static_cast<std::size_t>(count % 4)];
      if (size > rounding && (size > 1e3 * smallest || (count > 8 && size > 0.25 * old)))
        return Sweep::no_contraction;
      old = last = size;
    }
    return last <= rounding ? Sweep::converged : Sweep::no_contraction;
  }

  double size_of(double change, double y, std::size_t i) const {
    return std::abs(change) / (scale_[i] + std::abs(y));
  }

  double fixed_point_correction(double h, const double* y) {
    double size = 0;
    for (std::size_t i = 0; i < n_; ++i)
      for (int row = 0; row < s; ++row) {
        double sum = 0;
        for (int j = 0; j < s; ++j) sum += tableau.a[at(row)][at(j)] * k[at(j) * n_ + i];
        double& value = z[at(row) * n_ + i];
        size = std::max(size, size_of(h * sum - value, y[i], i));
        value = h * sum;
      }
    return size;
  }

  double newton_correction(double h, const double* y) {
    ++newton_iterations;
    for (std::size_t i = 0; i < n_; ++i)
      for (int row = 0; row < s; ++row) {
        double sum = 0;
        for (int j = 0; j < s; ++j) sum += tableau.a[at(row)][at(j)] * k[at(j) * n_ + i];
        change_[at(row) * n_ + i] = h * sum - z[at(row) * n_ + i];
      }
    newton.solve(change_.data());
    double size = 0;
    for (std::size_t place = 0; place < z.size(); ++place) {
      z[place] += change_[place];
      const double relative = size_of(change_[place], y[place % n_], place % n_);
      if (!(relative <= size)) size = relative;  // a NaN stays
    }
    return size;
  }

  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<double> guess_;
  bool by_newton_ = false;
};

}  // namespace momenta::gauss
