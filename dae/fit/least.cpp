#include <momenta/core/text/near_name.h>
#include <momenta/dae/fit/least.h>
#include <momenta/dae/fit/start_record.h>
#include <momenta/dae/study/journal.h>

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
    DrawnStarts starts(family_, request_.parameters, request_.seed);
    for (int k = 0; k < request_.starts && !result_.stopped; ++k) {
      const VectorXd from = starts.next();
      const std::string key = "start " + std::to_string(k);
      std::optional<LeastStart> start = recalled<LeastStart>(request_.journal, key, from);
      if (!start) {
        start = search(k, from);
        if (request_.journal && !result_.stopped)
          request_.journal->add(key, record_of_start(*start));
      }
      if (start->to.size() > 0 && (!has_best_ || is_better(*start, result_.starts[result_.best]))) {
        has_best_ = true;
        result_.best = result_.starts.size();
      }
      result_.starts.push_back(std::move(*start));
    }
    if (!has_best_)
      throw SceneError(result_.starts.front().to.size() == 0
                           ? "no start is possible; the first is not, as " +
                                 result_.starts.front().why
                           : "the search was stopped before its first start");
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

  static bool is_better(const LeastStart& a, const LeastStart& b) {
    const bool a_keeps = a.violation <= kept_within, b_keeps = b.violation <= kept_within;
    if (a_keeps != b_keeps) return a_keeps;
    return a_keeps ? a.value < b.value : a.violation < b.violation;
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
    const std::vector<double> room =
        there_is ? conditions_.room(values)
                 : std::vector<double>(conditions_.size(), WantedErrors::none);
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      KeptCondition& c = result_.keep.emplace_back();
      c.text = conditions_.condition(i).text;
      c.equal = conditions_.condition(i).equal;
      c.before = room[i];
    }
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

  /// J with an unknown in the place of each extreme that it grows with, which bounds it.
  ConstrainedProblem problem(const std::vector<std::size_t>& bounded, const MotionValues& first) {
    ConstrainedProblem p;
    conditions_.count(first);
    int rows = 0;
    for (const std::size_t k : bounded)
      rows += static_cast<int>(first.parts[functional_.places()[k]].size());
    p.inequalities = conditions_.inequalities() + rows;
    p.equalities = conditions_.equalities();
    p.at = [this, bounded, rows](const VectorXd& x, double& f, VectorXd& all, VectorXd* df,
                                 MatrixXd* dall) {
      const Index n = family_.own().size(), more = static_cast<Index>(bounded.size());
      MotionValues values;
      if (!motion(x.head(n), df != nullptr, values)) return false;
      VectorXd taken = VectorXd::Constant(static_cast<Index>(functional_.parts().size()), NAN),
               by_theta, by_parts, kept;
      MatrixXd kept_by;
      for (Index k = 0; k < more; ++k)
        taken[static_cast<Index>(bounded[static_cast<std::size_t>(k)])] = x[n + k];
      f = functional_.at(values, functional_.rows(values), taken, df ? &by_theta : nullptr,
                         df ? &by_parts : nullptr);
      conditions_.at(values, kept, df ? &kept_by : nullptr);
      all.resize(kept.size() + rows);
      const Index first_bound = conditions_.inequalities(), equal = conditions_.equalities();
      all.head(first_bound) = kept.head(first_bound);
      all.tail(equal) = kept.tail(equal);
      if (df) {
        df->resize(n + more);
        df->head(n) = by_theta;
        dall->setZero(all.size(), n + more);
        dall->topLeftCorner(first_bound, n) = kept_by.topRows(first_bound);
        dall->bottomLeftCorner(equal, n) = kept_by.bottomRows(equal);
      }
      Index row = first_bound;
      for (Index k = 0; k < more; ++k) {
        const std::size_t part = bounded[static_cast<std::size_t>(k)],
                          place = functional_.places()[part];
        const double sign = functional_.parts()[part].kind == MotionPart::Kind::most ? 1 : -1;
        const VectorXd& g = values.parts[place];
        all.segment(row, g.size()) = sign * (g.array() - x[n + k]);
        if (df) {
          (*df)[n + k] = by_parts[static_cast<Index>(part)];
          dall->block(row, 0, g.size(), n) = sign * values.parts_by[place];
          dall->block(row, n + k, g.size(), 1).setConstant(-sign);
        }
        row += g.size();
      }
      return true;
    };
    return p;
  }

  LeastStart search(int number, const VectorXd& from) {
    LeastStart start;
    start.from = from;
    refused_.clear();
    const double least_so_far = has_best_ ? result_.starts[result_.best].value : WantedErrors::none;
    const auto going = [&] {
      result_.stopped |= request_.progress && !request_.progress(number, least_so_far);
      return !result_.stopped;
    };
    MotionValues first;
    if (!motion(from, false, first)) {
      start.why = refused_;
      return start;
    }
    const std::vector<std::size_t> bounded = functional_.bounded(first);
    const Index n = from.size(), more = static_cast<Index>(bounded.size());
    VectorXd least, most, x(n + more), sizes(n + more);
    bounds_of(request_.parameters, least, most);
    least.conservativeResize(n + more);
    most.conservativeResize(n + more);
    least.tail(more).setConstant(-INFINITY);
    most.tail(more).setConstant(INFINITY);
    x.head(n) = from;
    sizes.head(n) = sizes_;
    const std::vector<Index> rows = functional_.rows(first);
    for (Index k = 0; k < more; ++k) {
      const std::size_t part = bounded[static_cast<std::size_t>(k)];
      const VectorXd& g = first.parts[functional_.places()[part]];
      x[n + k] = g[rows[part]];
      const double size = g.cwiseAbs().maxCoeff();
      sizes[n + k] = size > 0 ? size : 1;
    }
    ConstrainedProblem p = problem(bounded, first);
    p.going = going;
    const ConstrainedEnd end =
        constrained_search(p, least, most, sizes, request_.most_iterations, x);
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
    VectorXd kept;
    conditions_.at(last, kept, nullptr);
    start.violation = 0;
    for (Index i = 0; i < kept.size(); ++i)
      start.violation =
          std::max(start.violation, i < conditions_.inequalities() ? kept[i] : std::abs(kept[i]));
    VectorXd of_rows(kept.size());
    of_rows << end.multipliers.head(conditions_.inequalities()),
        end.multipliers.tail(conditions_.equalities());
    start.multipliers = conditions_.multipliers(of_rows);
    start.converged = end.kept && end.slope <= converged_slope;
    if (!start.converged)
      start.why = end.stopped ? "it was stopped"
                  : end.iterations >= request_.most_iterations
                      ? "it came to no end within " + std::to_string(end.iterations) + " iterations"
                  : !end.kept ? "no parameters near it keep the conditions"
                  : refused_.empty()
                      ? "steps became too short"
                      : "steps became too short; the last that was taken back: " + refused_;
    return start;
  }

  void finish() {
    const LeastStart& best = result_.starts[result_.best];
    result_.found = best.to;
    MotionValues values;
    if (!motion(result_.found, true, values)) throw SceneError(refused_);
    result_.after =
        functional_.at(values, functional_.rows(values), VectorXd(), &result_.gradient, nullptr);
    const std::vector<double> room = conditions_.room(values);
    for (std::size_t i = 0; i < conditions_.size(); ++i) {
      result_.keep[i].after = room[i];
      result_.keep[i].multiplier = i < best.multipliers.size() ? best.multipliers[i] : 0;
    }
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
  KeptConditions conditions_;
  std::vector<std::size_t> curves_;  ///< parts of which result_.curves are
  bool has_best_ = false;
  std::string refused_;  ///< why the last step of this start that was taken back was
  LeastResult result_;
};

}  // namespace

LeastResult least(const ParametricMechanism& family, const LeastRequest& request) {
  expect_starts(family, request.parameters, request.starts);
  return LeastSearch(family, request).run();
}

}  // namespace momenta
