#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/study/fit/constrained_search.h>
#include <momenta/dae/study/fit/fit.h>
#include <momenta/dae/study/fit/least_squares_search.h>
#include <momenta/dae/study/fit/starts.h>
#include <momenta/dae/study/fit/undetermined.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

SweptWay way_of(const FitRequest& request) {
  SweptWay way = request.way;
  way.sweep = request.sweep;
  return way;
}

class Search {
 public:
  Search(const ParametricMechanism& family, const WantedPoses& wanted, const FitRequest& request)
      : family_(family),
        request_(request),
        sizes_(sizes_of(family, request.parameters)),
        error_(family, request.sweep, wanted, sizes_),
        parts_(family, sizes_, way_of(request)),
        conditions_(request.keep, parts_) {
    result_.wanted = wanted;
    result_.parameters = request.parameters;
    result_.seed = request.seed;
    result_.own = family.own();
  }

  FitResult run() {
    const std::unique_ptr<Mechanism> own = family_.at(family_.own());
    result_.scene = own->scene().name;
    result_.swept = own->coordinate_columns()[static_cast<std::size_t>(
        coordinate_named(*own, request_.sweep).first)];
    VectorXd x, r;
    if (error_.start(family_.own(), x) && settle_places(x) && evaluate(x, r, nullptr)) {
      result_.before = errors_of(result_.wanted, error_.reached(), r);
      result_.reached_before = error_.reached();
    } else {
      result_.why_not_before = error_.why();
    }
    look_at_conditions_before();
    take_starts(
        family_, request_, result_,
        [this](int k, const VectorXd& from) -> std::optional<FitStart> {
          result_.stopped = request_.progress && !request_.progress(k, best_cost());
          if (result_.stopped) return std::nullopt;
          return search(from);
        },
        [](const FitStart& a, const FitStart& b) { return is_better(a, b, &FitStart::cost); });
    finish();
    return std::move(result_);
  }

 private:
  bool evaluate(const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    ++result_.evaluations;
    if (jacobian) ++result_.derivatives;
    const bool there_is = error_.evaluate(x, r, jacobian);
    if (!there_is) refused_ = error_.why();
    return there_is;
  }

  /// Moves free places to where the path is nearest, with parameters held.
  bool settle_places(VectorXd& x) {
    const Eigen::Index free = x.size() - family_.own().size();
    if (free == 0) return true;
    VectorXd places = x.tail(free), whole = x;
    const VectorXd most = VectorXd::Constant(free, INFINITY);
    const LeastSquaresEnd end = least_squares_search(
        [&](const VectorXd& at, VectorXd& r, MatrixXd* jacobian) {
          whole.tail(free) = at;
          MatrixXd all;
          if (!evaluate(whole, r, jacobian ? &all : nullptr)) return false;
          if (jacobian) *jacobian = all.rightCols(free);
          return true;
        },
        -most, most, VectorXd::Ones(free), request_.most_iterations, places);
    x.tail(free) = places;
    return end.began;
  }

  double best_cost() const {
    return has_best(result_) ? result_.starts[result_.best].cost : INFINITY;
  }

  void look_at_conditions_before() {
    if (conditions_.size() == 0) return;
    MotionValues values;
    result_.keep = conditions_.before(parts_.at(family_.own(), false, values) ? &values : nullptr);
  }

  /// Largest violation of a condition; infinite without a motion.
  double violation(const VectorXd& theta) {
    if (conditions_.size() == 0) return 0;
    MotionValues values;
    if (!parts_.at(theta, false, values)) {
      refused_ = parts_.why();
      return INFINITY;
    }
    return conditions_.violation(values);
  }

  FitStart search(const VectorXd& from) {
    FitStart start;
    start.from = from;
    refused_.clear();
    VectorXd x;
    if (!error_.start(from, x)) {
      start.why = error_.why();
      return start;
    }
    VectorXd least, most;
    const Eigen::Index n = from.size(), free = x.size() - n;
    bounds_of(request_.parameters, free, least, most);
    const VectorXd first = x;
    VectorXd sizes = VectorXd::Ones(x.size());  // 1 rad for angles
    sizes.head(n) = sizes_;
    const LeastSquaresEnd end =
        least_squares_search([this](const VectorXd& at, VectorXd& r,
                                    MatrixXd* jacobian) { return evaluate(at, r, jacobian); },
                             least, most, sizes, request_.most_iterations, x);
    start.iterations = end.iterations;
    if (!end.began) {
      start.why = refused_;
      return start;
    }
    start.cost = 0.5 * end.r.squaredNorm();
    start.cosine = end.cosine;
    constexpr double rounding = 1e-13;  // in r and its derivatives
    start.converged = start.cosine <= converged_cosine || end.step <= converged_step ||
                      end.r.norm() <= rounding * std::sqrt(static_cast<double>(end.r.size()));
    start.violation = violation(x.head(n));
    if (start.violation > kept_within && !keep(first, least, most, x, start)) return start;
    start.to = x.head(n);
    start.places = x.tail(free);
    if (!start.converged && start.why.empty())
      start.why = start.violation > kept_within
                      ? no_parameters_near
                      : why_no_minimum(request_, start.iterations, refused_);
    return start;
  }

  /// Searches with conditions, from `first`.
  bool keep(const VectorXd& first, const VectorXd& least, const VectorXd& most, VectorXd& x,
            FitStart& start) {
    const Eigen::Index n = start.from.size();
    MotionValues values;
    x = first;
    if (!parts_.at(x.head(n), true, values)) {
      start.why = parts_.why();
      return false;
    }
    conditions_.count(values);
    const Eigen::Index whole = x.size(), more = conditions_.unknowns(), all = whole + more;
    VectorXd sizes = VectorXd::Ones(all), low(all), high(all);  // 1 rad for angles
    sizes.head(n) = sizes_;
    low << least, VectorXd::Constant(more, -INFINITY);
    high << most, VectorXd::Constant(more, INFINITY);
    x.conservativeResize(all);
    conditions_.start(values, x.tail(more), sizes.tail(more));
    ConstrainedProblem problem;
    problem.inequalities = conditions_.inequalities();
    problem.equalities = conditions_.equalities();
    problem.at = [&](const VectorXd& at, double& f, VectorXd& rows, VectorXd* df, MatrixXd* by) {
      VectorXd r;
      MatrixXd jacobian, of_theta;
      if (!evaluate(at.head(whole), r, df ? &jacobian : nullptr)) return false;
      if (!parts_.at(at.head(n), df != nullptr, values)) {
        refused_ = parts_.why();
        return false;
      }
      f = 0.5 * r.squaredNorm();
      conditions_.at(values, at.tail(more), rows, df ? &of_theta : nullptr);
      if (df) {
        df->setZero(all);
        df->head(whole) = jacobian.transpose() * r;
        by->setZero(rows.size(), all);
        by->leftCols(n) = of_theta.leftCols(n);
        by->rightCols(more) = of_theta.rightCols(more);
      }
      return true;
    };
    const ConstrainedEnd end =
        constrained_search(problem, low, high, sizes, request_.most_iterations, x);
    x.conservativeResize(whole);
    start.iterations += end.iterations;
    if (!end.began) {
      start.why = refused_;
      return false;
    }
    start.cost = end.f;
    start.slope = end.slope;
    start.violation = violation(x.head(n));
    start.multipliers = conditions_.multipliers(end.multipliers);
    start.converged = end.kept && end.slope <= converged_slope;
    return true;
  }

  void finish() {
    VectorXd r;
    MatrixXd jacobian;
    const FitStart& best = result_.starts[result_.best];
    VectorXd x(best.to.size() + best.places.size());
    x << best.to, best.places;
    evaluate(x, r, &jacobian);
    result_.found = best.to;
    result_.reached = error_.reached();
    result_.after = errors_of(result_.wanted, result_.reached, r);
    result_.places = error_.free() ? std::vector<double>(best.places.begin(), best.places.end())
                                   : result_.wanted.swept;
    MotionValues values;
    if (conditions_.size() > 0 && parts_.at(best.to, false, values))
      conditions_.take_after(values, best.multipliers, result_.keep);
    const Eigen::Index n = best.to.size();
    result_.undetermined =
        undetermined_in_words(family_.names(), jacobian.leftCols(n) * sizes_.asDiagonal(),
                              jacobian.rightCols(error_.free() ? jacobian.cols() - n : 0));
  }

  const ParametricMechanism& family_;
  const FitRequest& request_;
  VectorXd sizes_;
  WantedError error_;
  SweptParts parts_;
  UserConstraints conditions_;
  std::string refused_;  ///< why a step of this start was last taken back
  FitResult result_;
};

}  // namespace

FitResult fit(const ParametricMechanism& family, const WantedPoses& wanted,
              const FitRequest& request) {
  expect_starts(family, request.parameters, request.starts);
  return Search(family, wanted, request).run();
}

}  // namespace momenta
