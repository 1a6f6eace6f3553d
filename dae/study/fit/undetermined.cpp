#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/study/fit/undetermined.h>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string undetermined_in_words(const std::vector<std::string>& all, MatrixXd by,
                                  const MatrixXd& along) {
  for (Index i = 0; i < along.cols(); ++i) {
    const double squares = along.col(i).squaredNorm();
    if (squares > 0) by -= along.col(i) * (along.col(i).transpose() * by) / squares;
  }
  constexpr double lost = 1e-8, takes_part = 0.01;
  const Eigen::JacobiSVD<MatrixXd> svd(by, Eigen::ComputeFullV);
  const VectorXd values = svd.singularValues();
  std::vector<std::string> names;
  Index freedoms = 0;
  VectorXd part = VectorXd::Zero(by.cols());
  for (Index i = 0; i < by.cols(); ++i)
    if (i >= values.size() || !(values[i] > lost * values[0])) {
      ++freedoms;
      part = part.cwiseMax(svd.matrixV().col(i).cwiseAbs());
    }
  for (Index j = 0; j < by.cols(); ++j)
    if (part[j] > takes_part) names.push_back(all[static_cast<std::size_t>(j)]);
  if (freedoms == 0) return "";
  return names.size() == 1
             ? "What is wanted does not depend on " + reading::all_in_quotes(names) + "."
             : "Parameters " + reading::all_in_quotes(names) + " can change together in " +
                   std::to_string(freedoms) + (freedoms == 1 ? " way" : " ways") +
                   " without a change of what is wanted, to first order: others are as good.";
}

}  // namespace momenta
