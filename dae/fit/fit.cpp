#include <momenta/core/text/near_name.h>
#include <momenta/dae/dense/decompositions.h>
#include <momenta/dae/fit/fit.h>
#include <momenta/dae/fit/least_squares_search.h>
#include <momenta/dae/kinematics/coordinate_named.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <random>
#include <stdexcept>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What steps of differences, and of a start, are a part of.
double size_of(const FittedParameter& parameter, double own) {
  if (own != 0) return std::abs(own);
  if (parameter.range) return (*parameter.range)[1] - (*parameter.range)[0];
  return 1;
}

WantedErrors errors_of(const WantedPoses& wanted, const MatrixXd& reached, const VectorXd& r) {
  WantedErrors errors;
  errors.cost = 0.5 * r.squaredNorm();
  for (const bool angles : {false, true}) {
    double squares = 0, most = 0;
    long count = 0;
    for (Eigen::Index k = 0; k < wanted.values.cols(); ++k) {
      if ((wanted.quantities[static_cast<std::size_t>(k)].unit == "rad") != angles) continue;
      for (Eigen::Index i = 0; i < wanted.poses(); ++i) {
        const double off = reached(i, k) - wanted.values(i, k);
        if (std::isnan(wanted.values(i, k))) continue;
        squares += off * off;
        most = std::max(most, std::abs(off));
        ++count;
      }
    }
    if (count == 0) continue;
    (angles ? errors.angle_rms : errors.length_rms) =
        std::sqrt(squares / static_cast<double>(count));
    (angles ? errors.angle_most : errors.length_most) = most;
  }
  return errors;
}

class Search {
 public:
  Search(const ParametricMechanism& family, const WantedPoses& wanted, const FitRequest& request)
      : family_(family),
        request_(request),
        sizes_(sizes(family, request)),
        error_(family, request.sweep, wanted, sizes_),
        random_(request.seed) {
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
    for (int k = 0; k < request_.starts; ++k) {
      if (request_.progress && !request_.progress(k, best_cost_)) {
        result_.stopped = true;
        break;
      }
      search(k == 0 ? family_.own() : drawn());
    }
    if (!std::isfinite(best_cost_))
      throw SceneError(result_.starts.empty() ? "the search was stopped before its first start"
                                              : "no start is possible; the first is not, as " +
                                                    result_.starts.front().why);
    finish();
    return std::move(result_);
  }

 private:
  static VectorXd sizes(const ParametricMechanism& family, const FitRequest& request) {
    VectorXd sizes(family.own().size());
    for (Eigen::Index j = 0; j < sizes.size(); ++j)
      sizes[j] = size_of(request.parameters[static_cast<std::size_t>(j)], family.own()[j]);
    return sizes;
  }

  bool evaluate(const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    ++result_.evaluations;
    if (jacobian) ++result_.derivatives;
    const bool there_is = error_.evaluate(x, r, jacobian);
    if (!there_is) refused_ = error_.why();
    return there_is;
  }

  /// Free places to where the path is nearest, for the parameters as they are.
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
        -most, most, request_.most_iterations, places);
    x.tail(free) = places;
    return end.began;
  }

  /// Between the bounds; the same numbers on every machine.
  VectorXd drawn() {
    VectorXd values(family_.own().size());
    for (Eigen::Index j = 0; j < values.size(); ++j) {
      const auto& [from, to] = *request_.parameters[static_cast<std::size_t>(j)].range;
      const double part = static_cast<double>(random_() >> 11) / 9007199254740992.0;
      values[j] = from + (to - from) * part;
    }
    return values;
  }

  void search(const VectorXd& from) {
    FitStart start;
    start.from = from;
    refused_.clear();
    VectorXd x;
    if (!error_.start(from, x)) {
      start.why = error_.why();
      result_.starts.push_back(start);
      return;
    }
    VectorXd least = VectorXd::Constant(x.size(), -INFINITY), most = -least;
    for (Eigen::Index j = 0; j < from.size(); ++j)
      if (const auto& range = request_.parameters[static_cast<std::size_t>(j)].range) {
        least[j] = (*range)[0];
        most[j] = (*range)[1];
      }
    const LeastSquaresEnd end =
        least_squares_search([this](const VectorXd& at, VectorXd& r,
                                    MatrixXd* jacobian) { return evaluate(at, r, jacobian); },
                             least, most, request_.most_iterations, x);
    start.iterations = end.iterations;
    if (!end.began) {
      start.why = refused_;
      result_.starts.push_back(start);
      return;
    }
    start.to = x.head(from.size());
    start.cost = 0.5 * end.r.squaredNorm();
    start.cosine = end.cosine;
    constexpr double rounding = 1e-13;  // of r, as of its derivatives
    start.converged = start.cosine <= converged_cosine ||
                      end.r.norm() <= rounding * std::sqrt(static_cast<double>(end.r.size()));
    if (!start.converged)
      start.why = end.iterations >= request_.most_iterations
                      ? "it came to no end within " + std::to_string(end.iterations) + " iterations"
                  : refused_.empty()
                      ? "steps became too short"
                      : "steps became too short; the last that was taken back: " + refused_;
    if (!(start.cost >= best_cost_)) {
      best_cost_ = start.cost;
      best_ = x;
      result_.best = result_.starts.size();
    }
    result_.starts.push_back(start);
  }

  void finish() {
    VectorXd r;
    MatrixXd jacobian;
    evaluate(best_, r, &jacobian);
    result_.found = best_.head(family_.own().size());
    result_.reached = error_.reached();
    result_.after = errors_of(result_.wanted, result_.reached, r);
    result_.places = error_.free() ? std::vector<double>(best_.data() + result_.found.size(),
                                                         best_.data() + best_.size())
                                   : result_.wanted.swept;
    name_undetermined(jacobian);
  }

  /// Null vectors of ∂r/∂θ, once s_i follow as they may.
  void name_undetermined(const MatrixXd& jacobian) {
    const Eigen::Index p = result_.found.size();
    MatrixXd by = jacobian.leftCols(p) * sizes_.asDiagonal();
    if (error_.free()) {
      const MatrixXd along = jacobian.rightCols(jacobian.cols() - p);
      for (Eigen::Index i = 0; i < along.cols(); ++i) {
        const double squares = along.col(i).squaredNorm();
        if (squares > 0) by -= along.col(i) * (along.col(i).transpose() * by) / squares;
      }
    }
    constexpr double lost = 1e-8, takes_part = 0.01;
    const Eigen::JacobiSVD<MatrixXd> svd(by, Eigen::ComputeFullV);
    const VectorXd values = svd.singularValues();
    std::vector<std::string> names;
    Eigen::Index freedoms = 0;
    VectorXd part = VectorXd::Zero(p);
    for (Eigen::Index i = 0; i < p; ++i)
      if (i >= values.size() || !(values[i] > lost * values[0])) {
        ++freedoms;
        part = part.cwiseMax(svd.matrixV().col(i).cwiseAbs());
      }
    for (Eigen::Index j = 0; j < p; ++j)
      if (part[j] > takes_part) names.push_back(family_.names()[static_cast<std::size_t>(j)]);
    if (freedoms == 0) return;
    result_.undetermined =
        names.size() == 1
            ? "What is wanted does not depend on " + reading::all_in_quotes(names) + "."
            : "Parameters " + reading::all_in_quotes(names) + " can change together in " +
                  std::to_string(freedoms) + (freedoms == 1 ? " way" : " ways") +
                  " without a change of what is wanted, to first order: others are as good.";
  }

  const ParametricMechanism& family_;
  const FitRequest& request_;
  VectorXd sizes_;
  WantedError error_;
  std::mt19937_64 random_;
  double best_cost_ = INFINITY;
  VectorXd best_;
  std::string refused_;  ///< why the last step of this start that was taken back was
  FitResult result_;
};

}  // namespace

FittedParameter FittedParameter::from_text(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument("--vary " + reading::in_quotes(text) + ": " + why);
  };
  FittedParameter parameter;
  const std::size_t equals = text.find('=');
  parameter.name = text.substr(0, equals);
  if (parameter.name.empty()) refuse("expected NAME or NAME=FROM:TO");
  if (equals == std::string::npos) return parameter;
  const std::string range = text.substr(equals + 1);
  const std::size_t colon = range.find(':');
  if (colon == std::string::npos) refuse("expected NAME or NAME=FROM:TO, as in crank=0.1:2");
  std::array<double, 2> ends{};
  for (int i = 0; i < 2; ++i) {
    const std::string end = i == 0 ? range.substr(0, colon) : range.substr(colon + 1);
    const auto [read, error] =
        std::from_chars(end.data(), end.data() + end.size(), ends[static_cast<std::size_t>(i)]);
    if (error != std::errc{} || read != end.data() + end.size() ||
        !std::isfinite(ends[static_cast<std::size_t>(i)]))
      refuse("found " + reading::in_quotes(end) + ", expected a number");
  }
  if (!(ends[0] < ends[1])) refuse("expected the smaller end first");
  parameter.range = ends;
  return parameter;
}

FitResult fit(const ParametricMechanism& family, const WantedPoses& wanted,
              const FitRequest& request) {
  if (request.parameters.empty()) throw std::invalid_argument("no parameter to vary is named");
  if (request.parameters.size() != family.names().size())
    throw std::invalid_argument("the parameters asked for are not those of the mechanism");
  if (request.starts < 1) throw std::invalid_argument("found no starts, expected one or more");
  for (std::size_t j = 0; j < request.parameters.size(); ++j) {
    const FittedParameter& p = request.parameters[j];
    const double own = family.own()[static_cast<Eigen::Index>(j)];
    if (!p.range && request.starts > 1)
      throw std::invalid_argument("parameter '" + p.name +
                                  "' has no range to draw starts from; expected " + p.name +
                                  "=FROM:TO");
    if (p.range && !(own >= (*p.range)[0] && own <= (*p.range)[1]))
      throw std::invalid_argument("parameter '" + p.name + "' is " + reading::digits(own) +
                                  " in the scene, outside its range from " +
                                  reading::digits((*p.range)[0]) + " to " +
                                  reading::digits((*p.range)[1]));
  }
  return Search(family, wanted, request).run();
}

}  // namespace momenta
