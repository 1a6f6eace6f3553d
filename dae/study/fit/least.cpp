#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/least.h>
#include <momenta/dae/study/fit/starts.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class LeastSearch {
 public:
  LeastSearch(const ParametricMechanism& family, const LeastRequest& request)
      : family_(family),
        request_(request),
        sizes_(sizes_of(family, request.parameters)),
        parts_(parts()),
        functional_(MotionFormula::from_text(request.least), *parts_),
        bounded_(functional_),
        conditions_(request.keep, *parts_) {}

  LeastResult run() {
    const Scene scene = family_.scene(family_.own());
    result_.scene = scene.name;
    result_.parameters = request_.parameters;
    result_.least = request_.least;
    result_.run = !request_.way;
    result_.seed = request_.seed;
    result_.own = family_.own();
    look_before();
    take_starts(
        family_, request_, result_,
        [this](int k, const VectorXd& from) { return std::optional(search(k, from)); },
        [](const LeastStart& a, const LeastStart& b) {
          return is_better(a, b, &LeastStart::value);
        });
    finish();
    return std::move(result_);
  }

 private:
  std::unique_ptr<MotionParts> parts() {
    if (request_.way) {
      auto swept = std::make_unique<SweptParts>(family_, sizes_, *request_.way);
      swept_ = swept.get();
      return swept;
    }
    auto run = std::make_unique<RunParts>(family_, sizes_, request_.scene, request_.settings);
    run_ = run.get();
    return run;
  }

  bool motion(const VectorXd& theta, bool derivatives, MotionValues& values) {
    ++result_.evaluations;
    if (derivatives) ++result_.derivatives;
    if (parts_->at(theta, derivatives, values)) return true;
    refused_ = parts_->why();
    return false;
  }

  void look_before() {
    MotionValues values;
    const bool there_is = motion(family_.own(), false, values);
    if (there_is)
      result_.before = functional_.value(values);
    else
      result_.why_not_before = refused_;
    result_.keep = conditions_.before(there_is ? &values : nullptr);
    if (!swept_) return;
    result_.swept = swept_->swept();
    result_.places = swept_->places();
    std::size_t place = 0;
    const auto add_curve = [&](const MotionPart& part) {
      const auto same = [&](const LeastResult::Curve& c) { return c.formula == part.formula; };
      if (std::none_of(result_.curves.begin(), result_.curves.end(), same)) {
        result_.curves.push_back({part.formula, VectorXd(), VectorXd()});
        curves_.push_back(place);
      }
      ++place;
    };
    for (const MotionPart& part : functional_.parts()) add_curve(part);
    for (std::size_t i = 0; i < conditions_.size(); ++i)
      for (const MotionPart& part : conditions_.condition(i).gap.parts) add_curve(part);
    for (std::size_t k = 0; there_is && k < result_.curves.size(); ++k)
      result_.curves[k].before = swept_->curve(curves_[k]);
  }

  /// Unknowns: θ, τ of J, τ of the conditions. Rows: of conditions, of bounds of J, of equations.
  ConstrainedProblem problem() {
    ConstrainedProblem p;
    const Index n = family_.own().size(), of_j = bounded_.unknowns(), of_c = conditions_.unknowns(),
                rows = bounded_.rows(), kept_rows = conditions_.inequalities(),
                equal = conditions_.equalities();
    p.inequalities = static_cast<int>(kept_rows + rows);
    p.equalities = static_cast<int>(equal);
    p.at = [=, this](const VectorXd& x, double& f, VectorXd& all, VectorXd* df, MatrixXd* dall) {
      MotionValues values;
      if (!motion(x.head(n), df != nullptr, values)) return false;
      VectorXd by_theta, by_tau, kept;
      MatrixXd kept_by, bounds_by_theta, bounds_by_tau;
      const VectorXd tau = x.segment(n, of_j);
      f = bounded_.at(values, tau, df ? &by_theta : nullptr, df ? &by_tau : nullptr);
      conditions_.at(values, x.tail(of_c), kept, df ? &kept_by : nullptr);
      all.resize(kept.size() + rows);
      all << kept.head(kept_rows), VectorXd::Zero(rows), kept.tail(equal);
      bounded_.bounds(values, tau, all.segment(kept_rows, rows), df ? &bounds_by_theta : nullptr,
                      df ? &bounds_by_tau : nullptr);
      if (!df) return true;
      df->resize(x.size());
      *df << by_theta, by_tau, VectorXd::Zero(of_c);
      dall->setZero(all.size(), x.size());
      dall->topLeftCorner(kept_rows, n) = kept_by.topLeftCorner(kept_rows, n);
      dall->topRightCorner(kept_rows, of_c) = kept_by.topRightCorner(kept_rows, of_c);
      dall->bottomLeftCorner(equal, n) = kept_by.bottomLeftCorner(equal, n);
      dall->block(kept_rows, 0, rows, n) = bounds_by_theta;
      dall->block(kept_rows, n, rows, of_j) = bounds_by_tau;
      return true;
    };
    return p;
  }

  LeastStart search(int number, const VectorXd& from) {
    LeastStart start;
    start.from = from;
    refused_.clear();
    const double least_so_far =
        has_best(result_) ? result_.starts[result_.best].value : WantedErrors::none;
    const auto going = [&] {
      result_.stopped |= request_.progress && !request_.progress(number, least_so_far);
      return !result_.stopped;
    };
    if (run_) run_->limit().ask(going);
    MotionValues first;
    if (!motion(from, false, first)) {
      start.why = refused_;
      return start;
    }
    bounded_.choose(first);
    conditions_.count(first);
    const Index n = from.size(), of_j = bounded_.unknowns(), of_c = conditions_.unknowns(),
                more = of_j + of_c;
    VectorXd least, most, x(n + more), sizes(n + more);
    bounds_of(request_.parameters, more, least, most);
    x.head(n) = from;
    sizes.head(n) = sizes_;
    bounded_.start(first, x.segment(n, of_j), sizes.segment(n, of_j));
    conditions_.start(first, x.tail(of_c), sizes.tail(of_c));
    ConstrainedProblem p = problem();
    p.going = going;
    const ConstrainedEnd end =
        constrained_search(p, least, most, sizes, request_.most_iterations, x);
    if (run_) run_->limit().ask({});
    start.iterations = end.iterations;
    MotionValues last;
    if (!end.began || !motion(x.head(n), false, last)) {
      start.why = refused_.empty()
                      ? "a formula of the motion, or its derivative, has no finite value"
                      : refused_;
      return start;
    }
    start.to = x.head(n);
    start.value = functional_.value(last);
    start.slope = end.slope;
    start.violation = conditions_.violation(last);
    VectorXd of_rows(conditions_.inequalities() + conditions_.equalities());
    of_rows << end.multipliers.head(conditions_.inequalities()),
        end.multipliers.tail(conditions_.equalities());
    start.multipliers = conditions_.multipliers(of_rows);
    start.converged = end.kept && end.slope <= converged_slope;
    if (!start.converged)
      start.why = end.stopped ? "it was stopped"
                  : end.kept || end.iterations >= request_.most_iterations
                      ? why_no_minimum(request_, end.iterations, refused_)
                      : no_parameters_near;
    return start;
  }

  void finish() {
    const LeastStart& best = result_.starts[result_.best];
    result_.found = best.to;
    MotionValues values;
    if (!motion(result_.found, true, values)) throw SceneError(refused_);
    result_.after =
        functional_.at(values, functional_.rows(values), VectorXd(), &result_.gradient, nullptr);
    conditions_.take_after(values, best.multipliers, result_.keep);
    for (std::size_t k = 0; k < result_.curves.size(); ++k)
      result_.curves[k].after = swept_->curve(curves_[k]);
    if (run_) result_.remarks = run_->remarks();
  }

  const ParametricMechanism& family_;
  const LeastRequest& request_;
  VectorXd sizes_;
  SweptParts* swept_ = nullptr;
  RunParts* run_ = nullptr;
  std::unique_ptr<MotionParts> parts_;
  MotionFunction functional_;
  BoundedFunction bounded_;
  UserConstraints conditions_;
  std::vector<std::size_t> curves_;  ///< parts shown by result_.curves
  std::string refused_;              ///< why a step of this start was last taken back
  LeastResult result_;
};

}  // namespace

LeastResult least(const ParametricMechanism& family, const LeastRequest& request) {
  expect_starts(family, request.parameters, request.starts);
  return LeastSearch(family, request).run();
}

}  // namespace momenta
