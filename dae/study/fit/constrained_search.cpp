#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/study/fit/constrained_search.h>
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Tolerance of conditions in the method: little is gained by breaking them.
constexpr double kept_to = 0.01 * kept_within;

/// f and conditions at the last point, in unknowns z = x/size.
class Scaled {
 public:
  Scaled(const ConstrainedProblem& problem, const VectorXd& sizes)
      : problem_(problem), sizes_(sizes) {}

  bool at(const VectorXd& z, bool gradients) {
    // A point without gradients counts as none.
    if (std::find(without_.begin(), without_.end(), z) != without_.end()) return false;
    if (has_ && z == z_ && (has_gradients_ || !gradients)) return there_is_;
    z_ = z;
    has_ = true;
    has_gradients_ = gradients;
    if (gradients) ++iterations_;
    const VectorXd x = z.cwiseProduct(sizes_);
    there_is_ =
        problem_.at(x, f, conditions, gradients ? &df : nullptr, gradients ? &by : nullptr) &&
        std::isfinite(f) && conditions.allFinite();
    if (there_is_ && gradients) {
      df = df.cwiseProduct(sizes_);
      by = by * sizes_.asDiagonal();
      there_is_ = df.allFinite() && by.allFinite();
    }
    if (gradients && there_is_) note(z);
    if (gradients && !there_is_) without_.push_back(z);
    return there_is_;
  }
  /// Largest violation, `in_sizes`: over the sizes of conditions.
  double violation(bool in_sizes) const {
    double most = 0;
    for (Index k = 0; k < conditions.size(); ++k) {
      const double by_how_much =
          k < problem_.inequalities ? conditions[k] : std::abs(conditions[k]);
      most = std::max(most, in_sizes ? by_how_much / sizes_of_conditions[k] : by_how_much);
    }
    return most;
  }
  /// Best point with gradients so far: least f among those that keep the conditions, else the
  /// nearest to them.
  const VectorXd& best() const { return best_; }
  std::size_t without_gradients() const { return without_.size(); }
  const ConstrainedProblem& problem() const { return problem_; }
  int iterations() const { return iterations_; }

  double f = 0;
  VectorXd conditions, df;
  MatrixXd by;
  double f_size = 1;             ///< divisor of f that makes its gradient about 1
  VectorXd sizes_of_conditions;  ///< their change with z where the search began, 1 at least
  bool stopped = false;
  nlopt_opt method = nullptr;

 private:
  void note(const VectorXd& z) {
    if (sizes_of_conditions.size() != conditions.size())
      sizes_of_conditions = by.rowwise().norm().cwiseMax(1.0);
    const double off = violation(true);
    const bool keeps = off <= kept_to, kept = best_off_ <= kept_to;
    if (best_.size() > 0 && !(keeps == kept ? (keeps ? f <= best_f_ : off < best_off_) : keeps))
      return;
    best_ = z;
    best_f_ = f;
    best_off_ = off;
  }

  const ConstrainedProblem& problem_;
  const VectorXd& sizes_;
  VectorXd z_, best_;
  double best_f_ = 0, best_off_ = 0;
  std::vector<VectorXd> without_;
  bool has_ = false, has_gradients_ = false, there_is_ = false;
  int iterations_ = 0;
};

double value(unsigned n, const double* z, double* gradient, void* data) {
  Scaled& p = *static_cast<Scaled*>(data);
  if (gradient && p.problem().going && !p.problem().going()) p.stopped = true;
  if (p.stopped) nlopt_force_stop(p.method);
  const bool there_is = !p.stopped && p.at(Eigen::Map<const VectorXd>(z, n), gradient != nullptr);
  if (gradient) {
    Eigen::Map<VectorXd> to(gradient, n);
    if (there_is)
      to = p.df / p.f_size;
    else
      to.setZero();
  }
  return there_is ? p.f / p.f_size : HUGE_VAL;
}

void rows(Scaled& p, Index first, unsigned m, double* result, unsigned n, const double* z,
          double* gradient) {
  const bool there_is = p.at(Eigen::Map<const VectorXd>(z, n), gradient != nullptr);
  for (unsigned k = 0; k < m; ++k) {
    const Index row = first + k;
    const double size = there_is ? p.sizes_of_conditions[row] : 1;
    result[k] = there_is ? p.conditions[row] / size : 0;
    for (unsigned j = 0; gradient && j < n; ++j)
      gradient[k * n + j] = there_is ? p.by(row, j) / size : 0;
  }
}
void inequalities(unsigned m, double* result, unsigned n, const double* z, double* gradient,
                  void* data) {
  rows(*static_cast<Scaled*>(data), 0, m, result, n, z, gradient);
}
void equalities(unsigned m, double* result, unsigned n, const double* z, double* gradient,
                void* data) {
  Scaled& p = *static_cast<Scaled*>(data);
  rows(p, p.problem().inequalities, m, result, n, z, gradient);
}

/// (a) by least squares over conditions that hold as equalities, those with λ < 0 left out.
double slope(const Scaled& p, const VectorXd& z, const VectorXd& least, const VectorXd& most,
             VectorXd& multipliers) {
  constexpr double near = 1e-7, at_bound = 1e-9;
  struct Row {
    Index condition = -1;
    VectorXd gradient;
    bool free = false;
  };
  std::vector<Row> active;
  for (Index k = 0; k < p.conditions.size(); ++k) {
    const bool equation = k >= p.problem().inequalities;
    if (equation || p.conditions[k] >= -near * p.sizes_of_conditions[k])
      active.push_back({k, p.by.row(k).transpose(), equation});
  }
  for (Index j = 0; j < z.size(); ++j) {
    if (z[j] <= least[j] + at_bound) active.push_back({-1, -VectorXd::Unit(z.size(), j), false});
    if (z[j] >= most[j] - at_bound) active.push_back({-1, VectorXd::Unit(z.size(), j), false});
  }
  for (;;) {
    multipliers.setZero(p.conditions.size());
    if (active.empty()) return p.df.norm();
    MatrixXd gradients(z.size(), static_cast<Index>(active.size()));
    for (std::size_t i = 0; i < active.size(); ++i)
      gradients.col(static_cast<Index>(i)) = active[i].gradient;
    const VectorXd lambda = gradients.completeOrthogonalDecomposition().solve(-p.df);
    Index worst = -1;
    for (Index i = 0; i < lambda.size(); ++i)
      if (!active[static_cast<std::size_t>(i)].free && lambda[i] < 0 &&
          (worst < 0 || lambda[i] < lambda[worst]))
        worst = i;
    if (worst < 0) {
      for (std::size_t i = 0; i < active.size(); ++i)
        if (active[i].condition >= 0)
          multipliers[active[i].condition] = lambda[static_cast<Index>(i)];
      return (p.df + gradients * lambda).norm();
    }
    active.erase(active.begin() + worst);
  }
}

/// One search; false if NLopt has no memory or rejects the problem.
bool search(Scaled& p, const VectorXd& least, const VectorXd& most, int most_evaluations,
            VectorXd& z) {
  const auto n = static_cast<unsigned>(z.size());
  const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> method(nlopt_create(NLOPT_LD_SLSQP, n),
                                                                 nlopt_destroy);
  p.method = method.get();
  if (!p.method) return false;
  nlopt_set_min_objective(p.method, value, &p);
  nlopt_set_lower_bounds(p.method, least.data());
  nlopt_set_upper_bounds(p.method, most.data());
  const std::vector<double> within(static_cast<std::size_t>(p.conditions.size()), kept_to);
  const auto m = static_cast<unsigned>(p.problem().inequalities),
             e = static_cast<unsigned>(p.problem().equalities);
  if (m > 0) nlopt_add_inequality_mconstraint(p.method, m, inequalities, &p, within.data());
  if (e > 0) nlopt_add_equality_mconstraint(p.method, e, equalities, &p, within.data());
  nlopt_set_xtol_rel(p.method, 1e-14);
  nlopt_set_maxeval(p.method, most_evaluations);
  double f = 0;
  const nlopt_result how = nlopt_optimize(p.method, z.data(), &f);
  return how > 0 || how == NLOPT_ROUNDOFF_LIMITED || how == NLOPT_FORCED_STOP ||
         how == NLOPT_FAILURE;
}

}  // namespace

ConstrainedEnd constrained_search(const ConstrainedProblem& problem, const VectorXd& least,
                                  const VectorXd& most, const VectorXd& sizes, int most_iterations,
                                  VectorXd& x) {
  ConstrainedEnd end;
  Scaled p(problem, sizes);
  const VectorXd low = least.cwiseQuotient(sizes), high = most.cwiseQuotient(sizes);
  VectorXd z = x.cwiseQuotient(sizes).cwiseMax(low).cwiseMin(high);
  if (!p.at(z, true)) return end;
  end.began = true;
  const double first_gradient = p.df.norm(), first_size = std::max(std::abs(p.f), first_gradient);
  p.f_size = first_size > 0 ? first_size : 1;
  const auto measure = [&] {
    end.f = p.f;
    end.conditions = p.conditions;
    end.violation = p.violation(false);
    end.kept = p.violation(true) <= kept_within;
    const double size = std::max({std::abs(p.f), 1e-3 * p.df.norm(), 1e-3 * first_gradient}),
                 left = slope(p, z, low, high, end.multipliers);
    end.slope = left > 0 ? left / size : 0;
  };
  measure();
  // One search without gain at a minimum, or four elsewhere, end the loop. Each shortens the next
  // one's steps by scaling f down.
  constexpr std::size_t most_without = 50;
  constexpr double shorter = 10;
  const auto given_up = [&](int gained_nothing) {
    return gained_nothing >= (end.kept && end.slope <= converged_slope ? 1 : 4);
  };
  for (int gained_nothing = 0; !given_up(gained_nothing) && !end.stopped &&
                               p.iterations() < most_iterations &&
                               p.without_gradients() < most_without;) {
    const double f = p.f, off = p.violation(true);
    const std::size_t without = p.without_gradients();
    VectorXd next = z;
    // Line searches may take several evaluations a gradient.
    if (!search(p, low, high, 4 * (most_iterations - p.iterations()), next)) break;
    end.stopped = p.stopped;
    p.at(next, true);
    z = p.best();
    p.at(z, true);
    measure();
    const bool gained = p.violation(true) < 0.5 * off || std::abs(p.f - f) > 1e-13 * std::abs(f) ||
                        p.without_gradients() > without;
    gained_nothing = gained ? 0 : gained_nothing + 1;
    if (!gained) p.f_size *= shorter;
  }
  x = z.cwiseProduct(sizes).cwiseMax(least).cwiseMin(most);
  end.iterations = p.iterations();
  return end;
}

}  // namespace momenta
