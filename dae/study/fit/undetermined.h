#pragma once
// Parameters that a fit leaves open: null vectors of ∂r/∂θ while s_i follow freely.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta {

/// One sentence that names these parameters; empty: each matters by itself. `by`: ∂r/∂θ, columns in
/// units of the parameters' sizes; `along`: ∂r/∂s, no columns where s is given.
std::string undetermined_in_words(const std::vector<std::string>& names, Eigen::MatrixXd by,
                                  const Eigen::MatrixXd& along);

}  // namespace momenta
