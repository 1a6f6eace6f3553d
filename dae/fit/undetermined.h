#pragma once
// Which parameters a fit leaves open: null vectors of ∂r/∂θ, once s_i follow as they may.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// One sentence that names them; empty: each matters by itself. `by`: ∂r/∂θ, columns in units of
/// the parameters' sizes; `along`: ∂r/∂s, no columns where s is given.
std::string undetermined_in_words(const std::vector<std::string>& names, Eigen::MatrixXd by,
                                  const Eigen::MatrixXd& along);

}  // namespace momenta
