#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/study/fit/identification.h>
#include <momenta/dae/study/fit/least_squares_search.h>
#include <momenta/dae/study/fit/starts.h>
#include <momenta/dae/study/fit/undetermined.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

class IdentificationSearch {
 public:
  IdentificationSearch(const ParametricMechanism& family, const MeasuredMotion& measured,
                       const IdentificationRequest& request)
      : family_(family),
        request_(request),
        sizes_(sizes_of(family, request.parameters)),
        error_(family, request.scene, request.settings, measured) {
    result_.scene = family.scene(family.own()).name;
    result_.parameters = request.parameters;
    result_.seed = request.seed;
    result_.own = family.own();
    result_.measured = measured;
    bounds_of(request.parameters, 0, least_, most_);
  }

  Identification run() {
    VectorXd r;
    error_.limit().ask(
        [&] { return !request_.progress || request_.progress(0, WantedErrors::none); });
    if (error_.evaluate(result_.own, r, nullptr)) {
      result_.cost_before = 0.5 * r.squaredNorm();
      result_.before = error_.reached();
    } else {
      result_.why_not_before = error_.why();
    }
    take_starts(
        family_, request_, result_,
        [this](int k, const VectorXd& from) { return std::optional(search(k, from)); },
        [](const FitStart& a, const FitStart& b) { return a.cost < b.cost; });
    finish();
    return std::move(result_);
  }

 private:
  /// Relative error of the run itself, below which r cannot come.
  double of_the_run() const {
    constexpr double rounding = 1e-13, of_tolerance = 10;
    return error_.settings().step > 0 ? rounding
                                      : std::max(rounding, of_tolerance * error_.settings().rtol);
  }

  FitStart search(int number, const VectorXd& from) {
    FitStart start;
    start.from = from;
    std::string refused;
    const double least_so_far =
        has_best(result_) ? result_.starts[result_.best].cost : WantedErrors::none;
    VectorXd x = from;
    const auto going_on = [&] {
      result_.stopped |= request_.progress && !request_.progress(number, least_so_far);
      return !result_.stopped;
    };
    error_.limit().ask(going_on);
    const LeastSquaresEnd end = least_squares_search(
        [&](const VectorXd& at, VectorXd& r, MatrixXd* jacobian) {
          if (!going_on()) return false;
          const bool there_is = error_.evaluate(at, r, jacobian);
          if (!there_is) refused = error_.why();
          return there_is;
        },
        least_, most_, sizes_, request_.most_iterations, x);
    error_.limit().ask({});
    start.iterations = end.iterations;
    if (!end.began) {
      start.why = result_.stopped ? "it was stopped" : refused;
      return start;
    }
    start.to = x;
    start.cost = 0.5 * end.r.squaredNorm();
    start.cosine = end.cosine;
    start.converged = !result_.stopped &&
                      (start.cosine <= converged_cosine ||
                       end.r.norm() <= of_the_run() * std::sqrt(static_cast<double>(end.r.size())));
    if (!start.converged)
      start.why =
          result_.stopped ? "it was stopped" : why_no_minimum(request_, start.iterations, refused);
    return start;
  }

  void finish() {
    result_.found = result_.starts[result_.best].to;
    VectorXd r;
    MatrixXd jacobian;
    if (!error_.evaluate(result_.found, r, &jacobian)) throw SceneError(error_.why());
    result_.after = error_.reached();
    result_.cost_after = 0.5 * r.squaredNorm();
    result_.settings = error_.settings();
    result_.runs = error_.runs();
    result_.remarks = error_.remarks();
    result_.undetermined = undetermined_in_words(family_.names(), jacobian * sizes_.asDiagonal(),
                                                 MatrixXd(r.size(), 0));
    take_deviations(r, jacobian);
  }

  /// The diagonal of s² (JᵀJ)⁻¹ of parameters that no bound holds, columns in units of their sizes.
  void take_deviations(const VectorXd& r, const MatrixXd& jacobian) {
    result_.deviations.setConstant(result_.found.size(), WantedErrors::none);
    std::vector<Index> free;
    for (Index j = 0; j < result_.found.size(); ++j)
      if (result_.found[j] > least_[j] && result_.found[j] < most_[j]) free.push_back(j);
    const auto n = static_cast<Index>(free.size());
    if (!result_.undetermined.empty() || n == 0 || r.size() <= n) return;
    const MatrixXd scaled = (jacobian * sizes_.asDiagonal())(Eigen::all, free);
    const MatrixXd inverse =
        Eigen::CompleteOrthogonalDecomposition<MatrixXd>(scaled).pseudoInverse();
    const double s = std::sqrt(r.squaredNorm() / static_cast<double>(r.size() - n));
    for (Index i = 0; i < n; ++i) {
      const Index j = free[static_cast<std::size_t>(i)];
      result_.deviations[j] = s * inverse.row(i).norm() * sizes_[j];
    }
  }

  const ParametricMechanism& family_;
  const IdentificationRequest& request_;
  VectorXd sizes_, least_, most_;
  MeasuredError error_;
  Identification result_;
};

}  // namespace

MatrixXd Identification::errors(const MatrixXd& values) const {
  MatrixXd all = MatrixXd::Zero(values.cols(), 2);
  for (Index k = 0; k < values.cols(); ++k) {
    Index count = 0;
    for (Index i = 0; i < values.rows(); ++i) {
      if (std::isnan(measured.values(i, k))) continue;
      const double off = values(i, k) - measured.values(i, k);
      all(k, 0) += off * off;
      all(k, 1) = std::max(all(k, 1), std::abs(off));
      ++count;
    }
    all(k, 0) = count > 0 ? std::sqrt(all(k, 0) / static_cast<double>(count)) : 0;
  }
  return all;
}

Identification identify(const ParametricMechanism& family, const MeasuredMotion& measured,
                        const IdentificationRequest& request) {
  expect_starts(family, request.parameters, request.starts);
  return IdentificationSearch(family, measured, request).run();
}

}  // namespace momenta
