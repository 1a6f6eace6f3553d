#pragma once
// The stages of one Gauss step, solved to rounding:
//
//   Z_i = h Σ_j a_ij k_j,  k_j = f(t + c_j h, y + Z_j).
//
// Symplecticity and the absence of energy drift are those of the exact stages, so the iteration
// goes on until its corrections are rounding. Fixed-point iteration first: it contracts as h
// ‖∂f/∂y‖; where it does not, simplified Newton iteration with ∂f/∂y by differences, kept from step
// to step. Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, VIII.6.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/solver/gauss_nodes.h>
#include <momenta/dae/solver/integration.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace momenta::gauss {

template <int s>
class Stages {
  static constexpr double epsilon = std::numeric_limits<double>::epsilon();
  /// Corrections over the unknowns' sizes: here nothing is left to gain; and, once they stop
  /// shrinking, this much is rounding of f.
  static constexpr double reached = 2 * epsilon, rounding = 1e-11;
  static constexpr int most_fixed_point = 50, most_newton = 30;

 public:
  explicit Stages(OdeSystem& system)
      : system_(system),
        n_(static_cast<std::size_t>(system.size())),
        scale_(n_),
        argument_(n_),
        probe_(n_),
        z(s * n_),
        k(s * n_) {
    for (std::size_t i = 0; i < n_; ++i) scale_[i] = system.scale(static_cast<int>(i));
  }

 private:
  OdeSystem& system_;
  std::size_t n_;
  std::vector<double> scale_, argument_, probe_;

 public:
  Collocation<s> tableau;
  std::vector<double> z, k;  ///< Z_i, a guess on entry, and k_i: n values a stage
  long evaluations = 0, jacobians = 0, factorizations = 0, newton_iterations = 0;
  std::string cause;  ///< of a failure

  bool solve(double t, double h, const double* y) {
    if (!newton_) {
      guess_ = z;
      const Sweep outcome = iterate(t, h, y, false);
      if (outcome != Sweep::no_contraction) return outcome == Sweep::converged;
      z = guess_;
      newton_ = true;
      factored_for_ = 0;
    }
    guess_ = z;
    if (factored_for_ == h) {
      const Sweep outcome = iterate(t, h, y, true);
      if (outcome == Sweep::converged) return true;
      z = guess_;
    }
    if (!factor(t, h, y)) return false;
    const Sweep outcome = iterate(t, h, y, true);
    if (outcome == Sweep::no_contraction) cause = "the stages did not converge";
    if (outcome != Sweep::converged) factored_for_ = 0;
    return outcome == Sweep::converged;
  }

 private:
  enum class Sweep { converged, no_contraction, failed };

  /// Iterations until corrections are rounding.
  Sweep iterate(double t, double h, const double* y, bool newton) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double last = infinity, smallest = infinity;
    std::array<double, 4> before;  // sizes of the last corrections
    before.fill(infinity);
    const int most = newton ? most_newton : most_fixed_point;
    for (int count = 1; count <= most; ++count) {
      for (int j = 0; j < s; ++j) {
        const std::size_t base = at(j) * n_;
        for (std::size_t i = 0; i < n_; ++i) argument_[i] = y[i] + z[base + i];
        ++evaluations;
        // A stage far off, of an iteration that runs away, may be where f cannot be had.
        if (!system_.rhs(t + tableau.c[at(j)] * h, argument_.data(), k.data() + base)) {
          cause = system_.failure().empty() ? "an evaluation of the equations failed"
                                            : system_.failure();
          return newton ? Sweep::failed : Sweep::no_contraction;
        }
      }
      if (!all_finite(k.data(), k.size())) {
        cause = "a value that is not a finite number came up";
        return newton ? Sweep::failed : Sweep::no_contraction;
      }
      const double size = newton ? newton_correction(h, y) : fixed_point_correction(h, y);
      if (!std::isfinite(size)) return Sweep::no_contraction;
      if (size <= reached) return Sweep::converged;
      if (size >= last && size <= rounding) return Sweep::converged;
      // Large momenta in a free gauge make corrections grow before they shrink: it is a fall by
      // four in four iterations that counts.
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

  /// (I − h A ⊗ ∂f/∂y) ΔZ = h A k − Z.
  double newton_correction(double h, const double* y) {
    ++newton_iterations;
    for (std::size_t i = 0; i < n_; ++i)
      for (int row = 0; row < s; ++row) {
        double sum = 0;
        for (int j = 0; j < s; ++j) sum += tableau.a[at(row)][at(j)] * k[at(j) * n_ + i];
        const auto place = at(row) * n_ + i;
        right_[static_cast<Eigen::Index>(place)] = h * sum - z[place];
      }
    change_.noalias() = lu_.permutationP() * right_;
    lu_.matrixLU().template triangularView<Eigen::UnitLower>().solveInPlace(change_);
    lu_.matrixLU().template triangularView<Eigen::Upper>().solveInPlace(change_);
    double size = 0;
    for (std::size_t place = 0; place < z.size(); ++place) {
      const double change = change_[static_cast<Eigen::Index>(place)];
      z[place] += change;
      const double relative = size_of(change, y[place % n_], place % n_);
      if (!(relative <= size)) size = relative;  // a NaN stays
    }
    return size;
  }

  /// ∂f/∂y in the middle of the step, by forward differences, and I − h A ⊗ ∂f/∂y.
  bool factor(double t, double h, const double* y) {
    const auto n = static_cast<Eigen::Index>(n_);
    ++jacobians;
    ++factorizations;
    std::vector<double> centre(y, y + n_), f(n_);
    const double middle = t + 0.5 * h;
    const auto evaluate = [&](std::vector<double>& out) {
      ++evaluations;
      if (system_.rhs(middle, centre.data(), out.data())) return true;
      cause = system_.failure();
      return false;
    };
    if (!evaluate(f)) return false;
    Eigen::MatrixXd jacobian(n, n);
    for (std::size_t column = 0; column < n_; ++column) {
      const double kept = centre[column];
      centre[column] += std::sqrt(epsilon) * (scale_[column] + std::abs(kept));
      const double step = centre[column] - kept;
      if (!evaluate(probe_)) return false;
      for (std::size_t i = 0; i < n_; ++i)
        jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(column)) =
            (probe_[i] - f[i]) / step;
      centre[column] = kept;
    }
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(s * n, s * n);
    for (int row = 0; row < s; ++row)
      for (int column = 0; column < s; ++column)
        matrix.block(row * n, column * n, n, n) -= h * tableau.a[at(row)][at(column)] * jacobian;
    lu_.compute(matrix);
    right_.resize(s * n);
    change_.resize(s * n);
    factored_for_ = h;
    return true;
  }

  static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<double> guess_;
  bool newton_ = false;
  double factored_for_ = 0;  ///< step of the factorised matrix
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::VectorXd right_, change_;
};

}  // namespace momenta::gauss
