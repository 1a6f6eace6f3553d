#include <ceres/ceres.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/study/fit/least_squares_search.h>

#include <cmath>
#include <vector>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Cost with a block per unknown, so that each can be held.
class Cost final : public ceres::CostFunction {
 public:
  Cost(const Residuals& residuals, Eigen::Index count, Eigen::Index unknowns)
      : residuals_(residuals), unknowns_(unknowns) {
    set_num_residuals(static_cast<int>(count));
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(unknowns), 1);
  }
  bool Evaluate(const double* const* parameters, double* r, double** jacobians) const override {
    VectorXd x(unknowns_), value;
    for (Eigen::Index j = 0; j < unknowns_; ++j) x[j] = *parameters[j];
    MatrixXd jacobian;
    if (!residuals_(x, value, jacobians ? &jacobian : nullptr)) return false;
    Eigen::Map<VectorXd>(r, value.size()) = value;
    for (Eigen::Index j = 0; jacobians && j < unknowns_; ++j)
      if (jacobians[j]) Eigen::Map<VectorXd>(jacobians[j], value.size()) = jacobian.col(j);
    return true;
  }

 private:
  const Residuals& residuals_;
  Eigen::Index unknowns_;
};

/// One search with the unknowns of `held` fixed; its iterations.
int search(const Residuals& residuals, Eigen::Index count, const VectorXd& least,
           const VectorXd& most, const std::vector<bool>& held, int most_iterations, VectorXd& x) {
  ceres::Problem problem;
  std::vector<double*> blocks;
  for (double& value : x) blocks.push_back(&value);
  problem.AddResidualBlock(new Cost(residuals, count, x.size()), nullptr, blocks);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    double* const block = blocks[static_cast<std::size_t>(j)];
    if (std::isfinite(least[j])) problem.SetParameterLowerBound(block, 0, least[j]);
    if (std::isfinite(most[j])) problem.SetParameterUpperBound(block, 0, most[j]);
    if (held[static_cast<std::size_t>(j)]) problem.SetParameterBlockConstant(block);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = most_iterations;
  // To rounding: an evaluation is good to about 1e-13.
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-16;
  options.parameter_tolerance = 1e-13;
  // Steps to where there is no mechanism are halved as often as it takes.
  options.max_num_consecutive_invalid_steps = 40;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return std::max(0, static_cast<int>(summary.iterations.size()) - 1);
}

/// Finds the unknowns that a bound holds, and cosine and step of the others.
void look(const VectorXd& x, const MatrixXd& jacobian, const VectorXd& least, const VectorXd& most,
          const VectorXd& sizes, LeastSquaresEnd& end, std::vector<bool>& held) {
  const VectorXd& r = end.r;
  MatrixXd scaled = jacobian * sizes.asDiagonal();
  end.cosine = 0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double slope = jacobian.col(j).dot(r), size = jacobian.col(j).norm() * r.norm();
    const bool stays = (x[j] <= least[j] && slope > 0) || (x[j] >= most[j] && slope < 0);
    held[static_cast<std::size_t>(j)] = stays;
    if (size > 0 && !stays) end.cosine = std::max(end.cosine, std::abs(slope) / size);
    if (stays) scaled.col(j).setZero();
  }
  const VectorXd step = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(scaled).solve(r);
  end.step = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
}

}  // namespace

LeastSquaresEnd least_squares_search(const Residuals& residuals, const VectorXd& least,
                                     const VectorXd& most, const VectorXd& sizes,
                                     int most_iterations, VectorXd& x) {
  LeastSquaresEnd end;
  MatrixXd jacobian;
  if (!residuals(x, end.r, &jacobian)) return end;
  end.began = true;
  std::vector<bool> held(static_cast<std::size_t>(x.size()), false);
  look(x, jacobian, least, most, sizes, end, held);
  std::fill(held.begin(), held.end(), false);
  for (double before = INFINITY; end.iterations < most_iterations;) {
    VectorXd next = x, r;
    end.iterations += std::max(1, search(residuals, end.r.size(), least, most, held,
                                         most_iterations - end.iterations, next));
    if (!residuals(next, r, &jacobian) || !(r.squaredNorm() <= end.r.squaredNorm())) break;
    x = next;
    end.r = r;
    look(x, jacobian, least, most, sizes, end, held);
    constexpr double less = 1 - 1e-12;
    if (end.cosine <= 1e-3 * converged_cosine || !(r.squaredNorm() < less * before)) break;
    before = r.squaredNorm();
  }
  return end;
}

}  // namespace momenta
