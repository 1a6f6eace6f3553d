#include <momenta/dae/gradient/functional_slopes.h>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FunctionalSlopes::FunctionalSlopes(const std::string& formula, const Mechanism& mechanism,
                                   const std::vector<RunVariable>& variables,
                                   const std::vector<OtherParameter>& others)
    : n_(mechanism.nv()),
      none_(2 * static_cast<std::size_t>(n_)),
      along_q_(MatrixXd::Zero(n_, 2 * n_)),
      along_u_(MatrixXd::Zero(n_, 2 * n_)),
      still_(MatrixXd::Zero(n_, static_cast<Index>(variables.size()))),
      of_state_(formula, mechanism, {}, none_),
      of_parameters_(formula, mechanism, variables, others) {
  along_q_.leftCols(n_).setIdentity();
  along_u_.rightCols(n_).setIdentity();
}

double FunctionalSlopes::at(double t, const VectorXd& q, const VectorXd& u, VectorXd& by_q,
                            VectorXd& by_u, VectorXd& by_parameters) {
  of_parameters_(t, q, u, still_, still_, by_parameters);
  const double value = of_state_(t, q, u, along_q_, along_u_, slopes_);
  by_q = slopes_.head(n_);
  by_u = slopes_.tail(n_);
  return value;
}

}  // namespace momenta
